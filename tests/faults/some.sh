#!/bin/sh
# some.sh - a few failures of each kind in each command (every.c); all of them are `make faults`. Allocations that fail in
# branches of one process (branch.h) are judged like those that fail in processes of their own.
# shellcheck disable=SC2154
build=$(pwd)
data=$(cd "${srcdir:-.}" && pwd)
[ -s tests/faults/fail.so ] && [ -x tests/faults/every ] || exit 77
# what the program is built with
mimdsim=${MIMDSIM:-$build/mimdsim}
"$mimdsim" --version | grep -q sanitizers && exit 77
every() { tests/faults/every "$mimdsim" "$build/tests/faults/fail.so" "$data" "$@"; }
alone=$(every --each --kind malloc --most 8 plot) && beside=$(every --branches --each --kind malloc --most 8 plot) || exit 1
if [ "$alone" != "$beside" ]; then
    printf '%s\nin branches:\n%s\n' "$alone" "$beside"
    # without the right to mount there are none
    case $beside in *'not in branches'*) ;; *) exit 1 ;; esac
fi
every --most "${MOST:-5}" run more campaign query plot report verify merge || exit 1
# These take longer: a full disk, and memory that their libraries do not get.
every --most 2 --kind write load stability accuracy || exit 1
every --most 3 --kind malloc stability accuracy || exit 1
every --most 4 --kind map stability

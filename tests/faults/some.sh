#!/bin/sh
# some.sh - a few failures of each kind in each command (every.c); all of them are `make faults`.
# shellcheck disable=SC2154
build=$(pwd)
data=$(cd "${srcdir:-.}" && pwd)
[ -s tests/faults/fail.so ] && [ -x tests/faults/every ] || exit 77
# what the program is built with
mimdsim=${MIMDSIM:-$build/mimdsim}
"$mimdsim" --version | grep -q sanitizers && exit 77
exec tests/faults/every "$mimdsim" "$build/tests/faults/fail.so" "$data" --most "${MOST:-5}"

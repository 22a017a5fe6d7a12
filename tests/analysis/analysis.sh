#!/bin/bash
# analysis.sh - nothing that cppcheck finds in src/, and nothing that gcc's -fanalyzer finds in the rooms that read files of
# strangers, but what findings.txt excuses with a reason. An excuse that is not needed any more is a finding, too.
#
# cppcheck looks at everything in 10 s of processor time. -fanalyzer follows single paths, which finds more and takes
# longer: 20 s for these rooms, minutes for all, most of them for the numerics.
set -euo pipefail
export LC_ALL=C
source=${MIMDSIM_SRCDIR:-$(cd "$(dirname "$0")/../.." && pwd)} build=${MIMDSIM_BUILDDIR:-$PWD}
excuses=$source/tests/analysis/findings.txt
cd "$source"
found=$(mktemp)
planted=$(mktemp --suffix=.c)
trap 'rm -f "$found" "$planted"' EXIT
# Faults of each tool's kind, which must be found: silence about src/ says something then.
printf '%s\n' '#include <stdlib.h>' 'int f(int n);' 'int f(int n)' '{' '    int a[2] = {n, n}, *p = malloc(sizeof *p);' \
    '    if (p == NULL) return 0;' '    free(p);' '    return *p + a[2];' '}' >"$planted"
folders=(-Isrc -Iinclude -I"$build" -I"$build/src" -D_GNU_SOURCE '-DMIMDSIM_DATADIR="d"' '-DMIMDSIM_SRCDIR="s"'
    '-DMIMDSIM_INCLUDEDIR="i"' '-DMIMDSIM_PKGLIBDIR="l"')

# Findings as "TOOL ID FILE", whatever their line.
if command -v cppcheck >/dev/null; then
    cppcheck -q -j2 --enable=warning,performance,portability --std=c11 --library=gnu --max-configs=1 -D__GNUC__=12 \
        -D__x86_64__ "${folders[@]}" --suppress=missingIncludeSystem --template='@{id} {file}:{line}: {message}' src "$planted" 2>&1 |
        sed -n 's/^@/cppcheck /p' >>"$found"
else echo 'no cppcheck: skipped' >&2; fi
if gcc -fanalyzer -x c -S -o /dev/null - </dev/null 2>/dev/null; then
    ls src/{base,io,model,plan,schedule,loader,store,lab}/*.c src/machine/topology*.c src/app/published.c \
        src/study/netcheck*.c "$planted" |
        xargs -P2 -I{} gcc -fanalyzer -std=gnu17 -O1 "${folders[@]}" -S -o /dev/null {} 2>&1 |
        sed -n 's/^\([^ :]*:[0-9]*\):[0-9]*: warning: \(.*\) \[\(CWE[^]]*\] \[\)*-Wanalyzer-\([a-z-]*\)\]$/gcc \4 \1: \2/p' >>"$found"
else echo 'no gcc with -fanalyzer: skipped' >&2; fi

status=0
# seen TOOL ID: whether it told of the planted fault, where it is there at all.
seen() {
    grep -q "^$1 $2 $planted:" "$found" && return
    echo "$1 does not see a planted fault ($2)"
    status=1
}
! command -v cppcheck >/dev/null || seen cppcheck arrayIndexOutOfBounds
! gcc -fanalyzer -x c -S -o /dev/null - </dev/null 2>/dev/null || seen gcc use-after-free
while read -r tool id place message; do
    file=${place%%:*}
    grep -q "^$tool $id $file " "$excuses" && continue
    echo "$place $message [$tool $id]"
    status=1
done < <(grep -vF " $planted:" "$found" | sort -u)
while read -r tool id file reason; do
    [ "$tool" = '#' ] && continue
    grep -q "^$tool $id $file:" "$found" && continue
    ! grep -q "^$tool " "$found" && continue # that tool is not here
    echo "findings.txt: no finding needs '$tool $id $file' any more"
    status=1
done <"$excuses"
exit $status

#!/bin/bash
# coverage.sh - how much of each file that reads input the harnesses reach: lines and branches, over the committed corpus
# and what a campaign has found. `make fuzz-coverage` starts it.
#
#     coverage.sh BUILD [HARNESS...]
set -euo pipefail
build=$(cd "$1" && pwd)
shift
source=$(cd "$(dirname "$0")/../.." && pwd)
profdata=$(command -v llvm-profdata || command -v llvm-profdata-14) cov=$(command -v llvm-cov || command -v llvm-cov-14)
[ -e "$build/coverage/config.status" ] || {
    mkdir -p "$build/coverage"
    (cd "$build/coverage" && "$source/configure" CC="${FUZZ_CC:-clang}" \
        CFLAGS='-O1 -g -fprofile-instr-generate -fcoverage-mapping' >configure.out 2>&1)
}
harnesses=${*:-$(sed -n 's/^fuzz_tests += tests\/fuzz\/fuzz_//p' "$source/tests/fuzz/local.am")}
make -C "$build/coverage" -s all >/dev/null 2>&1 || make -C "$build/coverage" -s all
make -C "$build/coverage" -s $(printf 'tests/fuzz/fuzz_%s ' $harnesses)
cd "$build/coverage"

# The files that read what strangers write.
files='src/base/units.c src/io/*.c src/plan/*.c src/spec/field*.c src/model/urdf*.c src/model/vector*.c
       src/schedule/goal_*.c src/schedule/schedule*.c src/machine/topology*.c src/study/netcheck*.c src/app/published.c
       src/store/store.c src/store/store_query.c src/store/merge.c src/report/trace*.c src/study/audit*.c
       src/loader/elf_*.c src/loader/image.c src/loader/relocate.c src/loader/symbols.c src/loader/libraries.c
       src/mpi/*.c'
objects=
for name in $harnesses; do
    extra=
    [ ! -d "$build/fuzz/found/$name" ] || extra=$build/fuzz/found/$name
    LLVM_PROFILE_FILE=$name.profraw timeout 900 tests/fuzz/fuzz_"$name" "$source/tests/fuzz/corpus/$name" $extra || true
    objects="$objects ${objects:+-object} tests/fuzz/fuzz_$name"
done
"$profdata" merge -sparse *.profraw -o all.profdata
(cd "$source" && ls $files) >sources
echo 'file lines branches'
"$cov" report $objects -instr-profile=all.profdata 2>/dev/null | sed 's|^.*/src/|src/|' |
    awk 'NR == FNR { wanted[$1]; next } $1 in wanted { print $1, $10, $13 }' sources -

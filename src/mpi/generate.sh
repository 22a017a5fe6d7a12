#!/bin/sh
# generate.sh - the files of the tree that repeat functions.txt: `generate.sh` tells which are out of date (status 1),
# `generate.sh --write` brings them up to date. Others are made when building (local.am).
cd "$(dirname "$0")/../.." || exit 1
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
make() { "${AWK:-awk}" -v want="$1" -f src/mpi/generate.awk src/mpi/functions.txt; }
make prototypes >"$out/mpi_functions.h"
make table >"$out/mpi_table.h"
"${AWK:-awk}" -f src/mpi/fortran.awk include/mimdsim/mpi.h >"$out/mpif.h"
# what stands above the first generated chapter of the list is written by hand
{ sed '/^## Start and end/,$d' docs/mpi.md; make list | sed '1{/^$/d}'; } >"$out/mpi.md"
state=0
for file in include/mimdsim/mpi_functions.h include/mimdsim/mpi_table.h include/mimdsim/mpif.h docs/mpi.md; do
    made=$out/${file##*/}
    cmp -s "$made" "$file" && continue
    if [ "${1-}" = --write ]; then cp "$made" "$file"; else echo "$file is not what src/mpi says"; state=1; fi
done
exit $state

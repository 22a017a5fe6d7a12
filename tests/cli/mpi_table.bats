#!/usr/bin/env bats
# MPI's headers and the list of its functions are what the table of functions says.

setup() { cd "$MIMDSIM_SRCDIR" || return 1; }

@test "headers and docs/mpi.md repeat the table of MPI's functions" {
    run sh src/mpi/generate.sh
    [ "$output" = "" ]
    [ "$status" -eq 0 ]
}

@test "mpi.h compiles as C and C++ without warnings" {
    printf '#include <mpi.h>\nint main(void) { return MPI_Wtime == PMPI_Wtime; }\n' >"$BATS_TEST_TMPDIR/a.c"
    run $CC -std=c99 -pedantic -Wall -Wextra -Werror -fsyntax-only -Iinclude/mimdsim "$BATS_TEST_TMPDIR/a.c"
    [ "$output" = "" ]
    if command -v g++ >/dev/null; then
        run g++ -Wall -Wextra -Werror -fsyntax-only -Iinclude/mimdsim -x c++ "$BATS_TEST_TMPDIR/a.c"
        [ "$output" = "" ]
    fi
}

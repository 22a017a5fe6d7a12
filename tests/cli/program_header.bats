#!/usr/bin/env bats
# program_header.bats - mimdsim/program.h compiles by itself and in programs, in every C and C++ in use.

load helper

header=$MIMDSIM_SRCDIR/include/mimdsim/program.h

# in_header: the program that the header's opening comment shows.
in_header() { sed -n '/^ \*     #include/,/\.tolerance/s/^ \*     \{0,1\}//p' "$header" | sed 's/^ \*$//'; }

# accepts COMPILER... FILE: it compiles without a word.
accepts() {
    works "$@" -Wall -Wextra -Werror -I"$MIMDSIM_SRCDIR/include" -c -o out.o
    stderr_is_empty
}

@test "the example in the header compiles as C" {
    in_header >sum.c
    grep -q 'PROGRAM(' sum.c
    for standard in c99 c11 c17 gnu17; do accepts ${CC:-cc} -std=$standard -pedantic sum.c; done
}

@test "the example in the header compiles as C++" {
    command -v c++ >compiler || skip "no C++ compiler"
    in_header >sum.cc
    for standard in c++11 c++17 c++20; do
        accepts c++ -std=$standard -Wno-missing-field-initializers sum.cc
    done
}

@test "a parameter of another type than its kind is told by the compiler" {
    in_header | sed 's/static int64_t n = 1000/static int n = 1000/' >sum.c
    fails_with 1 ${CC:-cc} -Werror -I"$MIMDSIM_SRCDIR/include" -c sum.c
    stderr_says "pointer type mismatch"
}

@test "a ring all-reduce with check and serial code fits in 40 lines" {
    [ "$(wc -l <"$MIMDSIM_SRCDIR/examples/ring-allreduce.c")" -le 40 ]
    for file in "$MIMDSIM_SRCDIR"/examples/*.c; do accepts ${CC:-cc} -std=gnu17 -pedantic "$file"; done
}

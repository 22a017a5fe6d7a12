#!/usr/bin/env bats
# mpirun.bats - programs with main: their lines, arguments and exit statuses; the same in scenarios.

load helper
load programs.bash

# A program that tells who it is, and ends with the status of its first argument on rank 1.
tells='#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
int main(int argc, char **argv)
{
    int me, p;
    double t = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &p);
    MPI_Barrier(MPI_COMM_WORLD);
    t = MPI_Wtime();
    printf("rank %d of %d: %d arguments, %s\n", me, p, argc - 1, argc > 2 ? argv[2] : "none");
    if (argc > 3 && me == 1) MPI_Abort(MPI_COMM_WORLD, 9);
    MPI_Finalize();
    return argc > 1 && me == 1 ? atoi(argv[1]) : t < 0;
}'

# compiled NAME: NAME.c of standard input, compiled; skips where there is no gcc.
compiled() {
    command -v gcc >there || skip "no gcc"
    cat >"$1.c"
    works mimdsim cc -O2 -g -o "$1" "$1.c"
}

@test "lines of all ranks, with their rank before them where that is wanted" {
    compiled tells <<<"$tells"
    works mimdsim mpirun -n 3 ./tells
    [ "$(sort <<<"$output")" = $'rank 0 of 3: 0 arguments, none\nrank 1 of 3: 0 arguments, none\nrank 2 of 3: 0 arguments, none' ]
    stderr_says "3 ranks on t3e-300: "
    works mimdsim mpirun -q -l -n 2 -m paragon --level loggp ./tells
    stdout_says "[1] rank 1 of 2"
    stderr_is_empty
    [ ! -e mimdsim.db ]
}

@test "arguments reach the program as they were given" {
    compiled tells <<<"$tells"
    works mimdsim mpirun -n 2 ./tells 0 "two words, and 'a quote'"
    stdout_says "rank 1 of 2: 2 arguments, two words, and 'a quote'"
    works mimdsim mpirun -n 2 ./tells 0 -n
    stdout_says "2 arguments, -n"
    works mimdsim mpirun -n 2 ./tells '[0,0]' '[1,2]'
    stdout_says "2 arguments, [1,2]"
}

@test "the exit status is the program's, or that of MPI_Abort" {
    compiled tells <<<"$tells"
    fails_with 5 mimdsim mpirun -n 2 ./tells 5
    stderr_says "rank 1"
    stderr_says "ended with exit status 5"
    fails_with 9 mimdsim mpirun -n 2 ./tells 0 x abort
    stderr_says "called MPI_Abort with code 9"
}

@test "an image executed by itself runs on one virtual processor, without a word of ours" {
    compiled tells <<<"$tells"
    works ./tells
    stdout_is "rank 0 of 1: 0 arguments, none"
    stderr_is_empty
}

@test "source is compiled first; what does not compile is told as the compiler says it" {
    command -v gcc >there || skip "no gcc"
    printf '%s\n' "$tells" >tells.c
    works mimdsim mpirun -n 2 tells.c
    stdout_says "rank 1 of 2"
    printf 'int main(void) { return x; }\n' >bad.c
    fails_with 65 mimdsim mpirun bad.c
    stderr_says "bad.c:1:"
    stderr_says "bad.c: the program does not compile"
}

@test "in a scenario: arguments are swept, an exit status that is not 0 makes the run failed" {
    compiled tells <<<"$tells"
    printf '%s\n' 'schema_version: 1' 'question: who?' 'program: tells' 'machine: [t3e-300, paragon]' 'ranks: [2, 3]' \
        'program.arguments: ["0 one", "4 two"]' >who.yaml
    fails_with 1 mimdsim run who.yaml
    [ "$(grep -c ' ok$' <<<"$output")" -eq 4 ]
    [ "$(grep -c ' failed$' <<<"$output")" -eq 4 ]
    stderr_says "ended with exit status 4"
    works mimdsim query mimdsim.db "SELECT count(DISTINCT text) FROM program_line WHERE text LIKE '%2 arguments, one'"
    [ "${lines[1]//[ ]/}" = 5 ]
    works mimdsim timeline who.yaml --set ranks=2
}

@test "computing that the program states is its cost where that is asked for" {
    compiled states <<'PROGRAM'
#include <mimdsim/compute.h>
#include <mpi.h>
#include <stdio.h>
int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    const double t = MPI_Wtime();
    mimdsim_compute(1e9, 0);
    printf("%d\n", MPI_Wtime() - t > 1);
    MPI_Finalize();
    return 0;
}
PROGRAM
    works mimdsim mpirun ./states
    stdout_is 0
    works mimdsim mpirun --set program.cost=author ./states
    stdout_is 1
}

@test "mistakes on the command line are told" {
    fails_with 64 mimdsim mpirun
    fails_with 66 mimdsim mpirun -n 2 ./nothere
    compiled tells <<<"$tells"
    fails_with 65 mimdsim mpirun -n many ./tells
    fails_with 64 mimdsim mpirun -n 2,3 ./tells
    fails_with 78 mimdsim mpirun -n 100000 -m t3e-300 ./tells
    stderr_says "has 128 processors"
}

@test "a crash in main is told with rank and line, after the lines written before it" {
    compiled crash <<'PROGRAM'
#include <mpi.h>
#include <stdio.h>
int main(int argc, char **argv)
{
    int me;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    printf("before %d\n", me);
    fflush(stdout);
    if (me == 1) *(volatile int *)16 = me;
    MPI_Finalize();
    return 0;
}
PROGRAM
    fails_with 1 mimdsim mpirun -n 2 ./crash
    stderr_says "rank 1 in main (crash.c:10): segmentation fault"
    stdout_says "before 1"
}

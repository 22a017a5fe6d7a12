#!/usr/bin/env bats
# crashes.bats - what goes wrong in programs of people's own, through the real program: told by rank, function and line.

load helper

# made NAME.c|NAME.cc: the source of standard input, compiled; skips where there is no compiler.
made() {
    local verb=cc
    case $1 in *.cc) verb=c++; command -v g++ >there || skip "no g++" ;; *) command -v gcc >there || skip "no gcc" ;; esac
    cat >"$1"
    works mimdsim $verb -O1 -g -fno-inline -o "${1%.*}" "$1"
}

@test "crashes are told by rank, function and line" {
    made crash.c <<'END'
#include <mpi.h>
#include <stdlib.h>
static volatile int zero;
static int *volatile nowhere;
static void write_there(void) { *nowhere = 7; }
static int deep(int n)
{
    volatile char block[100000];
    block[n] = 1;
    return deep(n + 1) + block[n];
}
int main(int argc, char **argv)
{
    int me;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Barrier(MPI_COMM_WORLD);
    if (me == 2 && argv[1][0] == 'n') write_there();
    if (me == 2 && argv[1][0] == 'd') return 1000 / zero;
    if (me == 2 && argv[1][0] == 's') return deep(0);
    if (me == 2 && argv[1][0] == 'l') for (;;) zero = 0;
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Finalize();
    return 0;
}
END
    works mimdsim mpirun -n 4 ./crash x
    run --separate-stderr mimdsim mpirun -n 4 ./crash n
    [ "$status" -ne 0 ]
    stderr_says "rank 2 in write_there (crash.c:5): segmentation fault at address 0x0 after "
    run --separate-stderr mimdsim mpirun -n 4 ./crash d
    stderr_says "rank 2 in main (crash.c:19): whole-number division by zero"
    run --separate-stderr mimdsim mpirun -n 4 ./crash s
    stderr_says "rank 2 in deep (crash.c:"
    stderr_says "stack overflow"
    run --separate-stderr mimdsim mpirun --limit 0.5 -n 4 ./crash l
    stderr_says "rank 2 in main (crash.c:21): still busy after 0.5 s of processor time"
}

@test "a stack that is too small is told with its rank, its size and what makes it larger, of very many ranks, too" {
    ! sanitized || skip "sanitizers need more than small stacks"
    cat >deep.c <<'END'
#include <mimdsim/program.h>
static volatile int n;
static int64_t depth = 1;
static int __attribute__((noinline)) f(int64_t k)
{
    volatile char b[1024];
    for (int i = 0; i < 1024; i += 64) b[i] = (char)k;
    n = b[64];
    return k > 1 ? f(k - 1) + b[0] : 0;
}
static void run(struct comm *c)
{
    double x = 1;
    if (comm_rank(c) == comm_size(c) - 1) f(depth);
    if (comm_rank(c) == 0) comm_publish(c, 0, 0, 1, &x);
}
static void serial(struct comm *c) { double x = 1; comm_publish(c, 0, 0, 1, &x); }
PROGRAM(.title = "deep", .parameter = {PROGRAM_WHOLE(depth, 1, 1e9, "levels")}, .output = {"x"}, .run = run,
        .serial = {{"one", serial}}, .tolerance = 1, .stack_bytes = 8192);
END
    deep() { mimdsim run deep.c -o t.db --quiet --set machine.topology.dims='[32, 32, 32]' "$@"; }
    works deep --set depth=2 --set ranks=2
    run --separate-stderr deep --set depth=8 --set ranks=2
    [ "$status" -ne 0 ]
    stderr_says "rank 1 in f (deep.c:"
    stderr_says "stack overflow (address 0x"
    stderr_says "of a stack of 8 KiB, which .stack_bytes of a kernel makes larger"
    # where the system does not give every one of so many a guard page, it is told after the run
    works deep --set depth=2 --set ranks=20001
    for depth in 8 30; do
        run --separate-stderr deep --set depth=$depth --set ranks=20001
        [ "$status" -ne 0 ]
        [[ $stderr == *"rank 20000 "*"stack overflow"*" stack of 8 KiB"*".stack_bytes"* ]] || { show; return 1; }
    done
    sql_is t.db "SELECT count(*) FROM run WHERE status = 'failed'" 3
}

@test "an exception that nobody catches ends the run, one that is caught does not" {
    made throws.cc <<'END'
#include <iostream>
#include <stdexcept>
static int careful(int n) { if (n > 1) throw std::runtime_error("too much"); return n; }
int main(int argc, char **)
{
    try { careful(argc + 1); } catch (const std::exception &e) { std::cout << "caught " << e.what() << std::endl; }
    return argc > 1 ? careful(argc) : 0;
}
END
    works mimdsim mpirun -q -n 2 ./throws
    stdout_is $'caught too much\ncaught too much'
    run --separate-stderr mimdsim mpirun -n 2 ./throws now
    [ "$status" -ne 0 ]
    stderr_says "what():  too much"
    stderr_says "careful(int) (throws.cc:3): calls abort()"
}

@test "a worker process ends with the process that started it" {
    made loop.c <<<'int main(void) { for (volatile int x = 0;;) x = 1; }'
    mimdsim mpirun -q -n 2 ./loop 3>&- &
    sleep 1
    local worker shell=$! parent
    parent=$(cat "/proc/$shell/task/$shell/children")
    parent=${parent%% *}
    worker=$(cat "/proc/$parent/task/$parent/children")
    worker=${worker%% *}
    kill -0 "$worker"
    kill -9 "$parent"
    for i in 1 2 3 4 5 6 7 8 9 10; do
        readlink "/proc/$worker/exe" >there || return 0 # nobody there, or only its status
        sleep 0.2
    done
    kill -9 "$worker"
    return 1
}

@test "gnuplot ends with the program that wants its picture" {
    works mimdsim run pingpong-machines --set machine=t3e-300 -q -o r.db
    printf '#!/bin/sh\necho $$ >%s/drawing\nexec sleep 60\n' "$PWD" >slow-gnuplot
    chmod +x slow-gnuplot
    local signal i drawing
    for signal in TERM KILL; do
        rm -f drawing
        MIMDSIM_GNUPLOT=$PWD/slow-gnuplot "$MIMDSIM" plot r.db pingpong 3>&- &
        for ((i = 0; i < 100; i++)); do [ ! -s drawing ] || break; sleep 0.1; done
        drawing=$(cat drawing)
        kill -0 "$drawing"
        kill -"$signal" $!
        for ((i = 0; i < 20; i++)); do
            readlink "/proc/$drawing/exe" >there || continue 2 # nobody there, or only its status
            sleep 0.1
        done
        kill -9 "$drawing"
        return 1
    done
}

@test "one rank under a debugger, which knows its variables" {
    command -v gdb >there || skip "no gdb"
    made look.c <<'END'
#include <mpi.h>
static int seen;
int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &seen);
    seen = 100 + seen;
    MPI_Finalize();
    return 0;
}
END
    run --separate-stderr mimdsim mpirun -q -n 4 --debug 2 ./look <<<$'break look.c:8\ncontinue\nprint seen\nkill\nquit'
    stdout_says '$1 = 102'
    fails_with 64 mimdsim mpirun -n 4 --debug two ./look
    stderr_says "--debug: expected the number of a rank"
}

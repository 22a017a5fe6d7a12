# stacks.bats - a built-in program whose rank needs more than its stack says so by name: in the command's own process, in a
# worker of a campaign, on several threads, and of very many ranks.
load helper

# The ranks of this one use more than a page: numbers of quadruple precision.
small() { mimdsim run speedup-t3e -o t.db --quiet --set level=loggp --set kernel.precision=quad "$@"; }

@test "in the command's own process: kernel, rank, size of the stack and what to set; nothing is half-written" {
    export MIMDSIM_STACK='4 KiB'
    fails_with 70 small --set n=8 --jobs 1
    stderr_says "mimdsim: kernel dynamics, rank "
    stderr_says " of 8: stack overflow: it has used more than its stack of 4 KiB"
    stderr_says "the environment variable MIMDSIM_STACK (such as '256 KiB') gives every rank more"
    [ ! -e t.db ] || sql_is t.db "PRAGMA integrity_check" ok
    export MIMDSIM_STACK='512 KiB'
    works small --set n=8 --jobs 1
    sql_is t.db "SELECT count(*) FROM run WHERE status = 'ok'" 1
}

@test "in a worker the run fails with the same words, and the others go on" {
    export MIMDSIM_STACK='4 KiB'
    fails_with 1 small --set n=8,16 --jobs 2
    sql_is t.db "SELECT count(*) FROM run WHERE status = 'failed' AND text LIKE
        'kernel dynamics, rank % of %: stack overflow: it has used more than its stack of 4 KiB; %MIMDSIM_STACK%'" 2
    unset MIMDSIM_STACK
    works small --set n=8,16 --jobs 2
    sql_is t.db "SELECT count(*) FROM run WHERE status = 'ok'" 2
}

@test "several threads tell it as well, and so do very many ranks" {
    export MIMDSIM_STACK='4 KiB'
    fails_with 70 small --set n=4096 --set machine.topology.dims='[16, 16, 16]' --threads 2 --jobs 1
    stderr_says " of 4096: stack overflow"
    fails_with 70 small --set n=65536 --set machine.topology.dims='[64, 32, 32]' --jobs 1
    stderr_says " of 65536: stack overflow"
}

# Two built-in jobs, of which the second needs more than a page of stack.
several() {
    printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'machine.topology.dims: [8, 4]' 'level: loggp' 'jobs:' \
        '  - {name: light, kernel: barrier, ranks: 4}' \
        '  - {name: deep, kernel: {name: dynamics, precision: quad}, n: 8, ranks: 8}' "$@" >s.yaml
    mimdsim run s.yaml -o t.db --quiet --jobs "$jobs"
}

@test "of several jobs the one whose stack is not enough is told by its name" {
    export MIMDSIM_STACK='4 KiB'
    jobs=1 fails_with 70 several
    stderr_says "mimdsim: job 'deep', kernel dynamics, rank "
    stderr_says " of 8: stack overflow: it has used more than its stack of 4 KiB"
    jobs=2 fails_with 1 several
    sql_is t.db "SELECT count(*) FROM run WHERE status = 'failed' AND text LIKE
        'job ''deep'', kernel dynamics, rank % of 8: stack overflow: it has used more than its stack of 4 KiB; %'" 2
    MIMDSIM_STACK='256 KiB' jobs=2 works several
    sql_is t.db "SELECT count(*) FROM run WHERE status = 'ok'" 2
}

@test "beside a program of one's own, too, whose faults stay its own" {
    command -v gcc >there || skip 'no gcc'
    cat >bad.c <<'C'
#include <mimdsim/program.h>
static int *volatile nowhere;
static void run(struct comm *c)
{
    comm_barrier(c);
    if (comm_rank(c) == 1) *nowhere = 1;
}
PROGRAM(.title = "writes nowhere", .run = run, .stack_bytes = 16384);
C
    sed 's/ \*nowhere = 1/ comm_publish(c, 0, 0, 0, NULL)/' bad.c >good.c
    jobs=2 fails_with 1 several '  - {name: own, program: bad.c, ranks: 4}' '  - {name: fine, program: good.c, ranks: 4}'
    sql_is t.db "SELECT count(*) FROM run WHERE status = 'failed' AND text LIKE
        'job ''own'', rank 1 in run (bad.c:6): segmentation fault at address 0x0 %'" 4
}

@test "the size of a stack acts on no result" {
    works small --set n=16 --jobs 1 -o one.db
    MIMDSIM_STACK='1 MiB' works small --set n=16 --jobs 1 -o two.db
    [ "$(sql one.db 'SELECT config_hash, digest, makespan_ps FROM run')" = \
      "$(sql two.db 'SELECT config_hash, digest, makespan_ps FROM run')" ]
}

@test "a size that is none is refused with the variable's name" {
    for bad in 64 '64 MB/s' '4095 B' '2 GiB' 'much' '-1 KiB'; do
        MIMDSIM_STACK=$bad run --separate-stderr small --set n=8 --jobs 1 -o bad.db
        [ "$status" -ne 0 ] || { echo "$bad"; return 1; }
        stderr_says "MIMDSIM_STACK is '$bad'"
    done
}

@test "a rank of inverse dynamics works in the page of its stack: 12,288 more take less than 7,800 bytes each" {
    sanitized && skip 'sanitizers make stacks deeper'
    for dims in '16, 16, 16' '32, 32, 16'; do
        works mimdsim run speedup-t3e -o memory.db --quiet --set level=loggp --set kernel=inverse --jobs 1 --threads 1 \
            --set n=$((${dims//, / * })) --set machine.topology.dims="[$dims]"
    done
    sql memory.db "SELECT P, host_peak_bytes FROM run"
    sql_is memory.db "SELECT (max(host_peak_bytes) - min(host_peak_bytes)) / 12288 < 7800 FROM run" 1
}

@test "open chains of the program as it is linked need no more than a page, of which bytes are left" {
    printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'model: {generator: serial-chain}' 'ranks: n' 'sweep:' '  level: [link]' \
        '  n: [64]' '  kernel.formulation: [paper, direct]' '  kernel.solver: [pcr-symmetric, cr, thomas, cr-pcr, pcr]' \
        '  model.joint: [revolute, mixed, helical]' '  kernel.name: [inverse, dynamics]' >deep.yaml
    works mimdsim run deep.yaml -o t.db --quiet
    sql_is t.db "SELECT count(*) FROM run WHERE status = 'ok'" 60
    # Whole pages: a build whose stacks have guards.
    if [ "$(sqlite3 t.db 'SELECT max(stack_peak_bytes % 4096) FROM run')" -gt 0 ]; then
        sql_is t.db "SELECT count(*) FROM run WHERE stack_peak_bytes > 4096 - 128" 0
        sql_is t.db "SELECT max(stack_peak_bytes) <= 2880 FROM run WHERE kernel = 'dynamics'" 1
    fi
}

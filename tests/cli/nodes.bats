#!/usr/bin/env bats
# nodes.bats - what computing costs on nodes with caches and a shared memory, and what a network engine takes from ranks.

load helper

# work.c: each rank states a million flops and eight million bytes.
stated() {
    cat >work.c <<'C'
#include <mimdsim/program.h>
static void run(struct comm *c) { comm_compute(c, 1e6, 8e6); }
static void serial(struct comm *c) { comm_compute(c, 1e6, 8e6); }
PROGRAM(.run = run, .serial = {{"once", serial}}, .cost = MIMDSIM_COST_AUTHOR);
C
}

# time_is DB NANOSECONDS: of its only run.
time_is() { sql_is "$1" "SELECT CAST(round(makespan_ps / 1000.0) AS INTEGER) FROM run" "$2"; }

@test "stated flops and bytes on four processors of one memory, by hand" {
    if ! command -v gcc >/dev/null; then skip; fi
    stated
    roofline='--set machine.node.model=roofline --set program.working_set=1GiB'
    # by rates: 1e6 / 55e6 s and 8e6 / 200e6 s, whoever else computes
    works mimdsim run work.c -m quad-ppro --set ranks=4 -o rates.db --quiet
    time_is rates.db 58181818
    # alone 8e6 / 95e6 s; four have 160 MB/s together; two 80 MB/s each
    works mimdsim run work.c -m quad-ppro --set ranks=1 $roofline -o one.db --quiet
    time_is one.db 84210526
    works mimdsim run work.c -m quad-ppro --set ranks=2 $roofline -o two.db --quiet
    time_is two.db 100000000
    works mimdsim run work.c -m quad-ppro --set ranks=4 $roofline -o four.db --quiet
    time_is four.db 200000000
    # its serial code has the memory for itself
    sql_is four.db "SELECT time_ps / 1000 FROM baseline WHERE name = 'once'" 84210526
    # 600 MB/s from the second cache; the first has no stated bandwidth
    works mimdsim run work.c -m quad-ppro --set ranks=4 $roofline --set program.working_set='100 KiB' -o l2.db --quiet
    time_is l2.db 18181818
    works mimdsim run work.c -m quad-ppro --set ranks=4 $roofline --set program.working_set='100 KiB' \
        --set machine.node.l2.bandwidth='100 MB/s' -o slow.db --quiet
    time_is slow.db 80000000
}

@test "compiled loops take the bandwidth of the level that holds their working set" {
    if ! command -v gcc >/dev/null; then skip; fi
    cat >sum.c <<'C'
#include <mimdsim/program.h>
static volatile double x[100000];
static void run(struct comm *c)
{
    double sum = 0;
    (void)c;
    for (int i = 0; i < 100000; i++) sum += x[i];
    comm_publish(c, 0, 0, 1, &sum);
}
PROGRAM(.run = run, .output = {"sum"});
C
    works mimdsim run sum.c -m quad-ppro --set ranks=1 --set machine.node.model=roofline \
        --set program.working_set='0 B,800 kB' -o sum.db --quiet
    # 800 kB at 95 MB/s are 8.42 ms; in the first cache some instructions of 5 ns each
    sql_is sum.db "SELECT count(*), max(makespan_ps) / 1e9 BETWEEN 8.42 AND 8.5, min(makespan_ps) / 1e9 BETWEEN 1 AND 6 FROM run" '2|1|1'
}

@test "numbers of caches do nothing by rates, and are then no part of what a run is" {
    works mimdsim run speedup-t3e -m origin2000 --set n=4 --set level=loggp -o a.db --quiet
    works mimdsim run speedup-t3e -m origin2000 --set n=4 --set level=loggp --set machine.node.l2.size='1 MiB' \
        --set machine.node.memory.bandwidth='1 MB/s' -o a.db --quiet
    sql_is a.db "SELECT count(*) FROM run" 1
    works mimdsim explain speedup-t3e -m origin2000 --set n=4 --set machine.node.l2.size='1 MiB'
    stdout_says "unused: machine.node.l2.size: node.model 'rates' knows neither caches nor memories"
    stdout_says 'computing: each operation at its price; left out: caches'
    works mimdsim run speedup-t3e -m origin2000 --set n=4 --set level=loggp --set machine.node.l2.size='1 MiB' \
        --set machine.node.model=roofline -o a.db --quiet
    sql_is a.db "SELECT count(*), count(DISTINCT config_hash) FROM run" '2|2'
    works mimdsim check a.db --again 2
}

@test "explain tells where data lie and who shares the way to them" {
    works mimdsim explain speedup-t3e -m quad-ppro --set n=4 --set machine.node.model=roofline --set machine.node.l1.size='64 B' \
        --set machine.node.l2.size='0 B'
    stdout_says 'in the memory, which 4 ranks share: 40 MB/s for each, which decides below 1.38 flop/B'
    works mimdsim explain speedup-t3e -m quad-ppro --set n=4 --set machine.node.model=roofline --json
    json_is_valid
    [[ $output == *'"computing": "roofline: '* ]]
    # a machine that states nothing of it has nothing to be told
    works mimdsim explain speedup-t3e -m ideal --set n=4
    [[ $output != *computing:* ]]
}

@test "why knows the memory where it decides" {
    works mimdsim why speedup-t3e -m quad-ppro --set n=64 --set ranks=4 --set level=loggp --set machine.node.model=roofline \
        --set machine.node.l1.size='64 B' --set machine.node.l2.size='0 B' --brief -o w.db
    stdout_says 'node.memory.shared'
    [[ $output != *node.memory.bandwidth* ]]
}

@test "a model without a memory, unknown words and impossible numbers are refused" {
    fails_with 65 mimdsim run fig6 --set machine.node.model=rooflin -o a.db
    stderr_says "did you mean 'roofline'?"
    fails_with 65 mimdsim run fig6 --set machine.node.model=fast -o a.db
    stderr_says "expected one of rates, roofline"
    fails_with 65 mimdsim run fig6 --set machine.node.l2.processors=0 -o a.db
    stderr_says 'machine.node.l2.processors'
    fails_with 65 mimdsim run fig6 --set machine.node.memory.bandwidth='-1 MB/s' -o a.db
    fails_with 65 mimdsim run fig6 --set machine.node.l1.size=32 -o a.db
    stderr_says 'unit'
    fails_with 65 mimdsim run fig6 --set machine.node.memroy.bandwidth='1 MB/s' -o a.db
    stderr_says "machine.node.memory.bandwidth"
    fails_with 65 mimdsim run fig6 --set program.working_set='-1 B' -o a.db
    fails_with 65 mimdsim run fig6 --set machine.software.offload=nothing -o a.db
    stderr_says 'expected'
    fails_with 78 mimdsim run speedup-t3e -m ideal --set n=4 --set machine.node.model=roofline -o b.db --quiet
    stderr_says '--set: machine.node.model is roofline'
    stderr_says 'give machine.node.memory.bandwidth'
    fails_with 78 mimdsim run speedup-t3e -m origin2000 --set n=4 --set machine.software.offload=copies -o c.db --quiet
    stderr_says 'expected handshakes or none'
    nothing_left_behind
    # with a point that can run, the others are rows
    fails_with 1 mimdsim run speedup-t3e -m ideal --set n=4 --set machine.node.model=rates,roofline -o d.db --quiet
    sql_is d.db "SELECT DISTINCT status FROM run WHERE text LIKE '%give machine.node.memory.bandwidth%'" failed
    sql_is d.db "SELECT status, count(*) FROM run GROUP BY 1" $'failed|2\nok|2'
}

@test "an engine overlaps hand-shakes with computing, and its absence does not change small messages" {
    works mimdsim run shift -m t3e-300 --set ranks=8 --set kernel.message='1 KiB' --set level=loggp \
        --set machine.software.offload=handshakes,none -o small.db --quiet
    sql_is small.db "SELECT count(*) > 2 FROM run" 1
    sql_is small.db "SELECT count(*) FROM (SELECT count(DISTINCT digest) AS d, count(*) AS many FROM run
        GROUP BY replace(config_text, 'offload = none', 'offload = handshakes') HAVING d <> 1 OR many <> 2)" 0
    works mimdsim run "$MIMDSIM_SRCDIR/examples/stencil.yaml" --set machine=t3e-300 --set n=1024 --set ranks=4 --set steps=3 --set overlap=false \
        --set machine.software.offload=handshakes,none,copies -o large.db --quiet
    sql_is large.db "SELECT (SELECT makespan_ps FROM run WHERE config_text LIKE '%offload = none%') >
        (SELECT makespan_ps FROM run WHERE config_text LIKE '%offload = handshakes%') AND
        (SELECT makespan_ps FROM run WHERE config_text LIKE '%offload = handshakes%') >
        (SELECT makespan_ps FROM run WHERE config_text LIKE '%offload = copies%')" 1
}

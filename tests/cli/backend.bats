#!/usr/bin/env bats
# backend.bats - programs on this computer for real, with Open MPI and with MPICH: answers, rows, refusals. No times are
# compared: the computer may be busy.

load helper
load programs
load mpi_job

sql() { sqlite3 -readonly "$1" "$2"; } # as in helper

scenario() {
    printf '%s\n' 'schema_version: 1' 'question: For real?' 'machine: [t3e-300, paragon]' \
        'model: {generator: serial-chain}' 'ranks: 2' 'level: [loggp, link]' \
        'sweep: {kernel: [dynamics, inverse], n: [2, 40]}' >t.yaml
}

# Two machines and two levels are no other tasks: four rows. The answer is the simulated one, bit by bit.
is_run() {
    needs "$1"
    scenario
    works start "$1" 2 "$MIMDSIM" run t.yaml --backend mpi --samples 3 --limit 1 -o r.db
    stdout_says 'same bits'
    sql_is r.db "SELECT count(*), count(DISTINCT task_hash), sum(same_bits), sum(repeatable), min(status), min(checks) > 0,
        min(P), sum(difference) FROM real_run" '4|4|4|4|ok|1|2|0.0'
    sql_is r.db "SELECT count(*) FROM real_run WHERE NOT (0 < min_s AND min_s <= lower_s AND lower_s <= median_s
        AND median_s <= upper_s AND upper_s <= max_s AND disturbed <= samples AND worst_error <= worst_tolerance)" 0
    sql_is r.db "SELECT count(*) FROM real_run r WHERE samples <> (SELECT count(*) FROM real_sample s
        WHERE s.real_id = r.real_id) OR disturbed <> (SELECT sum(disturbed) FROM real_sample s
        WHERE s.real_id = r.real_id)" 0
    # Stages of means add up to no more than the longest run, and the last is waiting.
    sql_is r.db "SELECT count(*) FROM real_run r WHERE (SELECT sum(min_s) FROM real_stage s WHERE s.real_id = r.real_id)
        > max_s * 1.001" 0
    sql_is r.db "SELECT count(*) FROM real_stage WHERE name = 'end'" 4
    # What was simulated is not touched, and a second measurement is another row.
    works start "$1" 2 "$MIMDSIM" run t.yaml --backend mpi --samples 1 --limit 0.1 -o r.db --set n=2 -q --json
    json_is_valid
    json_is '$[1].run.P' 2
    json_is '$[0].stages[0].name' Pre-processing
    sql_is r.db 'SELECT count(*), (SELECT count(*) FROM run) FROM real_run' '6|0'
}

@test "built-in programs run on Open MPI with the simulated answers" { is_run openmpi; }
@test "built-in programs run on MPICH with the simulated answers" { is_run mpich; }

# Everything of comm_match.h, and every kind of message; x = 1 when all of it is right.
matching() {
    program matching <<'C'
static void need(struct comm *c, int ok, int line) { if (!ok) comm_fail(c, "line %d", line); }
#define NEED(ok) need(c, ok, __LINE__)
static void zero(struct comm *c)
{
    struct comm_request r[2] = {{0}}, *list[2] = {&r[0], &r[1]}, seen = {0};
    int64_t big[20000], small = 0;
    comm_irecv_matching(c, COMM_ANY_SOURCE, 0x10, 0x10, &small, 8, &r[0]);
    comm_irecv(c, 1, 3, big, sizeof big, &r[1]);
    NEED(comm_wait_any(c, 2, list) >= 0);
    NEED(comm_wait_any(c, 2, list) >= 0);
    NEED(comm_wait_any(c, 2, list) == -1);
    NEED(r[0].tag == 0x1f && r[0].source == 1 && small == 5 && big[19999] == 19999);
    comm_probe(c, COMM_ANY_SOURCE, 0, 0, &seen);
    NEED(seen.tag == 7 && seen.bytes == 16);
    comm_irecv_matching(c, 1, 7, -1, big, 8, &r[0]);
    comm_wait(c, &r[0]);
    NEED(r[0].truncated && r[0].bytes == 16);
    comm_irecv_matching(c, 1, 99, -1, &small, 8, &r[0]);
    NEED(comm_cancel(c, &r[0]) == 1);
}
static void one(struct comm *c)
{
    struct comm_request r = {0};
    int64_t big[20000], small = 5, pair[2] = {1, 2};
    for (int i = 0; i < 20000; i++) big[i] = i;
    comm_isend(c, 0, 3, big, sizeof big, &r);
    big[19999] = 0;
    comm_issend(c, 0, 0x1f, &small, 8, &r);
    while (!comm_test(c, &r)) continue;
    comm_send(c, 0, 7, pair, sizeof pair);
}
static void run(struct comm *c)
{
    double x = 1;
    if (comm_rank(c) == 0) zero(c);
    if (comm_rank(c) == 1) one(c);
    comm_barrier(c);
    comm_allreduce(c, COMM_MIN, &x, 1);
    if (comm_rank(c) == 0) comm_publish(c, 0, 0, 1, &x);
}
C
    sed -i 's/\.run = run/.run = run, .wildcards = 1/' matching.c
    image matching
}

own_programs() {
    needs "$1"
    matching
    works start "$1" 2 "$MIMDSIM" run matching.so --set ranks=2 --backend mpi --samples 3 --limit 1
    for one in stencil sample-sort; do
        cp "$MIMDSIM_SRCDIR/examples/$one.c" .
        works start "$1" 2 "$MIMDSIM" run $one.c --set ranks=2 --backend mpi --samples 2 --limit 1
        stdout_says 'same bits'
    done
    sql_is mimdsim.db "SELECT count(*), sum(status = 'ok'), sum(same_bits) FROM real_run" '3|3|3'
    sql_is mimdsim.db "SELECT group_concat(name) FROM (SELECT s.name FROM real_stage s JOIN real_run r USING (real_id)
        WHERE program = 'stencil' ORDER BY stage)" 'neighbours,compute,end'
}

@test "people's own kernels run on Open MPI, with wildcards, tests and probes" { own_programs openmpi; }
@test "people's own kernels run on MPICH, with wildcards, tests and probes" { own_programs mpich; }

@test "a program that deadlocks or fails simulated is not run for real" {
    needs mpich
    program stuck <<'C'
static void run(struct comm *c)
{
    double x;
    comm_recv(c, (comm_rank(c) + 1) % comm_size(c), 1, &x, 8);
}
C
    image stuck
    fails_with 70 start mpich 2 "$MIMDSIM" run stuck.so --set ranks=2 --backend mpi
    stderr_says 'simulated, so not run for real'
    sql_is mimdsim.db "SELECT status, samples, median_s IS NULL FROM real_run" 'deadlock|0|1'
    program broken <<'C'
static void run(struct comm *c) { if (comm_rank(c) == 1) comm_fail(c, "no more"); }
C
    image broken
    fails_with 1 start mpich 2 "$MIMDSIM" run broken.so --set ranks=2 --backend mpi -o f.db
    stderr_says 'no more'
    sql_is f.db "SELECT status FROM real_run" failed
}

# What only a real run does wrong: the time is real, so a program that asks for it gives another answer.
@test "an answer that depends on the time is told, and a wrong one is invalid" {
    needs mpich
    program clock <<'C'
static void run(struct comm *c)
{
    for (volatile int64_t i = 0; i < 200000; i++) continue;
    const double x = comm_time(c) > 1e-6 ? 1.01 : 1;
    if (comm_rank(c) == 0) comm_publish(c, 0, 0, 1, &x);
}
C
    image clock
    fails_with 1 start mpich 2 "$MIMDSIM" run clock.so --set ranks=2 --set program.cost=author --backend mpi --samples 1
    stderr_says 'differs from one by'
    sql_is mimdsim.db "SELECT status, same_bits, difference > 0.001, worst_error > worst_tolerance FROM real_run" \
        'invalid|0|1|1'
}

@test "what --backend does not take is refused, by all processes alike" {
    scenario
    fails_with 64 mimdsim run t.yaml --backend pvm
    stderr_is "mimdsim: --backend 'pvm': expected mpi"
    needs mpich
    for samples in 0 x 2501; do
        fails_with 64 start mpich 2 "$MIMDSIM" run t.yaml --backend mpi --samples $samples
        stderr_says "--samples '$samples': expected a number from 1 to 2500"
    done
    fails_with 78 start mpich 3 "$MIMDSIM" run t.yaml --backend mpi
    stderr_is 'mimdsim: no run of this scenario has as many ranks as the job has processes: 2 ranks, 3 processes; start mpirun -n 2, or choose --set ranks=3'
    fails_with 66 start mpich 2 "$MIMDSIM" run none.yaml --backend mpi
    echo 'send 8b from 0 to 1' >s.goal
    printf '%s\n' 'num_ranks 2' 'rank 0 { l1: send 8b to 1 tag 1 }' 'rank 1 { l1: recv 8b from 0 tag 1 }' >s.goal
    fails_with 78 start mpich 2 "$MIMDSIM" run s.goal --backend mpi --allow-programs
    stderr_says 'which mimdsim record times'
    rm -f t.yaml s.goal compiler mimdsim.db
    nothing_left_behind
}

@test "more ranks than processors give right answers, and it is said" {
    needs mpich
    scenario
    many=$(($(nproc) + 1))
    works start mpich $many "$MIMDSIM" run t.yaml --backend mpi --samples 1 --limit 0.1 --set ranks=$many --set n=40 \
        --set kernel=inverse
    stderr_says 'answers are right, times say little'
    sql_is mimdsim.db "SELECT oversubscribed, same_bits, P = processors + 1 FROM real_run" '1|1|1'
}

@test "real runs are merged, and older databases get their tables" {
    needs mpich
    scenario
    for k in 1 2; do
        works start mpich 1 "$MIMDSIM" run t.yaml --backend mpi --samples 1 --set ranks=1 --set n=2 -o $k.db
    done
    works mimdsim merge all.db 1.db 2.db
    sql_is all.db "SELECT count(*) FROM real_run" 4
    sql_is all.db "SELECT count(*) FROM real_sample WHERE real_id NOT IN (SELECT real_id FROM real_run)" 0
    works mimdsim merge all.db 1.db
    sql_is all.db "SELECT count(*) FROM real_run" 4
    sqlite3 old.db <"$MIMDSIM_SRCDIR/tests/data/store/version-5.sql"
    works start mpich 1 "$MIMDSIM" run t.yaml --backend mpi --samples 1 --set ranks=1 --set n=2 -o old.db
    sql_is old.db "SELECT (SELECT count(*) FROM run) > 0, count(*) FROM real_run" '1|2'
}

@test "a build without that MPI says so" {
    cp "$MIMDSIM" lonely
    export MIMDSIM_DATA
    scenario
    PMI_RANK=0 fails_with 69 ./lonely run t.yaml --backend mpi
    stderr_says 'built without MPICH'
    fails_with 69 ./lonely run t.yaml --backend mpi
    stderr_says 'built without MPI;'
    works ./lonely run t.yaml -q
}

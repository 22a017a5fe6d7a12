#!/usr/bin/env bats
# programs.bats - programs of one's own as images: run, compared with their serial code, swept, stored; what fails is a
# row, and the campaign goes on.

load helper
load programs.bash

good='static void run(struct comm *c)
{
    double x = comm_rank(c) == 0;
    comm_allreduce(c, COMM_SUM, &x, 1);
    if (comm_rank(c) == 0) comm_publish(c, 0, 0, 1, &x);
}'

@test "an image runs, is compared with its serial code, and stored with its parameters" {
    program good <<<"$good"
    image good
    works mimdsim run ./good.so --set n=7 --set ranks=1,3
    [ "$(grep -c ' ok$' <<<"$output")" -eq 2 ]
    # the serial code counts no work: there is no speedup to tell
    [[ $output != *speedup_vs* ]]
    works mimdsim query mimdsim.db "SELECT max(time_ps) FROM baseline"
    [ "${lines[1]//[ ]/}" = 0 ]
    works mimdsim query mimdsim.db "SELECT DISTINCT kernel, n, (SELECT value FROM v_setting v WHERE v.run_id = r.id
        AND v.key = 'program.n') AS own FROM run r"
    [[ ${lines[1]} =~ ^good\ +7\ +7$ ]]
    works mimdsim query mimdsim.db "SELECT count(*) FROM error_check WHERE quantity = 'x' AND reference = 'one' AND passed"
    [ "${lines[1]//[ ]/}" = 2 ]
    works mimdsim query mimdsim.db "SELECT group_concat(name, ', ') FROM baseline WHERE run_id = 1 ORDER BY ordinal"
    [ "${lines[1]}" = "one, fastest serial, parallel code on one processor" ]
}

@test "the same program elsewhere is the same run, another one is not" {
    program good <<<"$good"
    image good
    works mimdsim run ./good.so --set ranks=2
    mkdir there && cp good.so there/good.so
    works mimdsim run there/good.so --set ranks=2
    works mimdsim query mimdsim.db "SELECT count(*) FROM run"
    [ "${lines[1]//[ ]/}" = 1 ]
    printf 'x' >>there/good.so
    works mimdsim run there/good.so --set ranks=2
    works mimdsim query mimdsim.db "SELECT count(*) FROM run"
    [ "${lines[1]//[ ]/}" = 2 ]
}

@test "parameters are swept, checked against the declaration, and misspellings told" {
    program good <<<"$good"
    image good
    works mimdsim run ./good.so --set n=3,5 --set ranks=2
    [ "$(grep -c ' ok$' <<<"$output")" -eq 2 ]
    fails_with 65 mimdsim run ./good.so --set n=0
    stderr_says "--set: program.n: '0'"
    stderr_says "numbers of program good"
    fails_with 65 mimdsim run ./good.so --set n=101
    fails_with 65 mimdsim run ./good.so --set n=many
    stderr_says "not a whole number"
    fails_with 65 mimdsim run ./good.so --set program.nn=3
    stderr_says "did you mean 'n'?"
}

@test "the digest and all times are the same with any number of workers" {
    program good <<<"$good"
    image good
    works mimdsim run ./good.so -o one.db -j 1
    one=$output
    works mimdsim run ./good.so -o four.db -j 4
    stdout_is "$one"
}

# failing NAME TEXT...: the runs of NAME.so at 2 and 4 ranks; each TEXT is said, and both are stored.
failing() {
    local name=$1
    shift
    image "$name"
    run --separate-stderr -- mimdsim run "./$name.so" --set ranks=2,4
    for text in "$@"; do stderr_says "$text"; done
    works mimdsim query mimdsim.db "SELECT count(*) FROM run WHERE kernel = '$name'"
    [ "${lines[1]//[ ]/}" = 2 ]
}

@test "a wrong answer makes the run invalid with its error, and the others go on" {
    program wrong <<<'static void run(struct comm *c)
{
    double x = comm_size(c) > 2 ? 1.5 : 1;
    if (comm_rank(c) == 0) comm_publish(c, 0, 0, 1, &x);
}'
    failing wrong "x differs from one by 0.5 (relative), more than 1e-12"
    works mimdsim query mimdsim.db "SELECT group_concat(status) FROM (SELECT status FROM run ORDER BY P)"
    [ "${lines[1]}" = "ok,invalid" ]
    fails_with 1 mimdsim run ./wrong.so --set ranks=4
}

@test "a result that is not complete, or too long, makes the run invalid" {
    program gap <<<'static void run(struct comm *c)
{
    double x[3] = {1, 1, 1};
    if (comm_rank(c) == 0) comm_publish(c, 0, 2, 1, x);
}'
    failing gap "x: no rank published its element 0"
    program long <<<'static void run(struct comm *c)
{
    double x[3] = {1, 1, 1};
    if (comm_rank(c) == 0) comm_publish(c, 0, 0, 3, x);
}'
    failing long "x: the ranks published 3 numbers, 'one' 1"
}

@test "wrong calls fail with rank, line and what was expected" {
    program calls <<<'static void run(struct comm *c)
{
    double x = 1;
    if (comm_rank(c) == 1 && comm_size(c) == 2)
        comm_send(c, 99, 0, &x, 8);
    if (comm_rank(c) == 1)
        comm_stage(c, 5);
}'
    failing calls "rank 1 in program at 0 s (calls.c:5): names rank 99; expected 0 to 1" \
        "(calls.c:7): names stage 5; the program declares 0" "2 of 2 runs failed"
    program twice <<<'static void run(struct comm *c) { double x = 1; comm_publish(c, 0, 0, 1, &x); }'
    failing twice "publishes element 0 of a result again, 'x'"
    program sizes <<<'static void run(struct comm *c)
{
    double x[2] = {1, 1};
    if (comm_rank(c) == 0) comm_send(c, 1, 3, x, 16);
    if (comm_rank(c) == 1) comm_recv(c, 0, 3, x, 8);
}'
    failing sizes "exactly 8 bytes" "16 bytes"
    program asks <<<'static void run(struct comm *c) { if (comm_rank(c) == 1) comm_fail(c, "n is %d", 3); }'
    failing asks "(asks.c:1): n is 3"
}

@test "a deadlock is told with rank and line" {
    program waits <<<'static void run(struct comm *c)
{
    double x;
    if (comm_rank(c) == 1)
        comm_recv(c, 0, 7, &x, 8);
}'
    failing waits "deadlock: rank 1 in program waits to receive 8 bytes, tag 7, from rank 0 (waits.c:5)"
}

@test "a program that forks, reads stdin, exits or aborts fails by name" {
    program forks <<<'static void run(struct comm *c) { if (comm_rank(c) == 1) fork(); }'
    failing forks "rank 1" "forks.c:1" "calls fork()"
    program reads <<<'static void run(struct comm *c) { if (comm_rank(c) == 1) getchar(); }'
    failing reads "rank 1" "reads standard input"
    program exits <<<'static void run(struct comm *c) { if (comm_rank(c) == 1) exit(3); }'
    failing exits "rank 1" "called exit(3) before its end"
    program aborts <<<'static void run(struct comm *c) { if (comm_rank(c) == 1) abort(); }'
    failing aborts "rank 1" "aborts.c:1" "calls abort()"
}

@test "a crash, a stack overflow and an endless loop fail with rank and line, and the others go on" {
    program crashes <<<'static void run(struct comm *c)
{
    double x = 1;
    if (comm_rank(c) == 3)
        *(volatile int *)8 = 1;
    if (comm_rank(c) == 0) comm_publish(c, 0, 0, 1, &x);
}'
    failing crashes "rank 3 in run (crashes.c:5): segmentation fault at address 0x8" "1 of 2 runs failed"
    program deep <<<'static int f(volatile int k)
{
    volatile char b[4096];
    b[0] = (char)k;
    return f(k + 1) + b[0];
}
static void run(struct comm *c) { if (comm_rank(c) == 1) f(0); }'
    failing deep "rank 1 in f (deep.c:" "stack overflow"
    program loops <<<'static void run(struct comm *c)
{
    if (comm_rank(c) == 1)
        for (;;) *(volatile int64_t *)&n += 1;
}'
    image loops
    fails_with 1 mimdsim run ./loops.so --set ranks=2 --limit 0.5
    stderr_says "rank 1 in run (loops.c:4): still busy after 0.5 s"
    works mimdsim query mimdsim.db "SELECT status FROM run WHERE kernel = 'loops'"
    [ "${lines[1]}" = failed ]
    fails_with 64 mimdsim run ./loops.so --limit never
    stderr_says "--limit: 'never' is not a number of seconds"
}

@test "a program that starts threads, or divides by zero, fails by name" {
    program threads <<<'#include <pthread.h>
static void *f(void *x) { return x; }
static void run(struct comm *c) { pthread_t t; if (comm_rank(c) == 1) pthread_create(&t, NULL, f, NULL); }'
    failing threads "rank 1" "threads.c:3" "pthread_create()"
    program divides <<<'static void run(struct comm *c) { volatile int z = comm_rank(c) - 1; z = 100 / z; }'
    failing divides "rank 1 in run (divides.c:1)" "division by zero"
}

@test "what ranks write is kept with the run, also what they wrote before they failed" {
    program writes <<<'static void run(struct comm *c)
{
    double x = 1;
    printf("rank %d\nof %d", comm_rank(c), comm_size(c));
    fprintf(stderr, "said\n");
    if (comm_rank(c) == 1) comm_fail(c, "enough");
    if (comm_rank(c) == 0) comm_publish(c, 0, 0, 1, &x);
}'
    image writes
    fails_with 1 mimdsim run ./writes.so --set ranks=2
    [[ $output != *"of 2"* ]]
    works mimdsim query mimdsim.db "SELECT group_concat(rank || stream || text, '|') FROM (SELECT * FROM program_line
        ORDER BY rank, stream, line)"
    [ "${lines[1]}" = "01rank 0|01of 2|02said|11rank 1|11of 2|12said" ]
}

@test "a file that is no program, or declares nothing sound, is refused" {
    printf 'no program' >text.so
    fails_with 65 mimdsim run ./text.so
    stderr_says "text.so"
    program good <<<"$good"
    sed 's/PROGRAM_WHOLE(n, 1, 100/PROGRAM_WHOLE(n, 11, 100/' good.c >range.c
    image range
    fails_with 65 mimdsim run ./range.so
    stderr_says "parameter 'n' of the program: its variable is initialised with 10"
    sed 's/, \.run = run//' good.c | sed 's/.run = run,//' >norun.c
    image norun
    fails_with 65 mimdsim run ./norun.so
    stderr_says "the program declares no function .run"
    fails_with 66 mimdsim run ./missing.so
}

@test "a database with such runs agrees with itself; they cannot be made again from their row alone" {
    program good <<<"$good"
    image good
    works mimdsim run ./good.so --set ranks=1,2
    works mimdsim check mimdsim.db
    works mimdsim check mimdsim.db --again all
    stdout_says "2 cannot be made from their row alone"
}

@test "explain tells of a program without running it, check validates it" {
    program good <<<"$good"
    image good
    works mimdsim explain ./good.so
    stdout_says "a test"
    stdout_says "the program declares no estimate"
    [ ! -e mimdsim.db ]
    works mimdsim check ./good.so
}

@test "a stranger's scenario loads nothing from outside its folder" {
    program good <<<"$good"
    image good
    mkdir theirs
    printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'ranks: 2' 'program: ../good.so' >theirs/s.yaml
    fails_with 65 mimdsim run theirs/s.yaml
    stderr_says "theirs/s.yaml:4: program '../good.so' lies outside the scenario's folder"
    stderr_says "--allow-programs"
    works mimdsim run theirs/s.yaml --allow-programs
    ln -s ../good.so theirs/link.so
    sed -i 's|\.\./good.so|link.so|' theirs/s.yaml
    fails_with 65 mimdsim run theirs/s.yaml
    cp good.so theirs/inside.so
    sed -i 's|link.so|inside.so|' theirs/s.yaml
    works mimdsim run theirs/s.yaml
}

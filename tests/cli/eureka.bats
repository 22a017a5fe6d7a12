#!/usr/bin/env bats
# eureka.bats - searches that end when one rank has found: by the network's eureka, which interrupts, and by asking.

load helper

# find.c: rank r's steps take (r + 1) ms on the T3E; rank `finder` finds after `steps` of them, others give up after `limit`.
setup_file() {
    cat >"$BATS_FILE_TMPDIR/find.c" <<'END'
#include <mimdsim/program.h>
static int64_t finder = 2, second = -1, steps = 3, limit = 100, noisy;
static void run(struct comm *c)
{
    const int me = comm_rank(c), p = comm_size(c);
    for (int again = 0; again < 2; again++) {
        int ended = 0, done = 0;
        comm_search_begin(c);
        const int64_t begin = comm_now_ps(c);
        while (ended == 0) {
            enum comm_search_state state = COMM_SEARCH_EXHAUSTED;
            if (done < limit) {
                comm_compute(c, 55000.0 * (me + 1), 0);
                if (noisy && me == 3) comm_send(c, 3, 1, NULL, 0);
                done++;
                if (done == steps && (me == finder || me == second)) state = COMM_SEARCH_FOUND;
                else state = COMM_SEARCH_GOES_ON;
            }
            ended = comm_search(c, state);
        }
        if (noisy && me == 3)
            for (int i = 0; i < done; i++) comm_recv(c, 3, 1, NULL, 0);
        const double out[] = {(double)(comm_now_ps(c) - begin) / 1e6, ended, done};
        if (again == 0) comm_publish(c, 0, 3 * me, 3, out);
        if (me == p - 1 && again == 1) comm_publish(c, 1, 0, 1, out);
    }
}
static void check(struct comm *c)
{
    int64_t n;
    const double *x = comm_output(c, 0, &n);
    for (int64_t i = 0; i < n; i += 3) comm_error(c, "end", x[i + 1] < 0 ? 0.25 : 0);
    if (n > 0 && x[1] < 3)
        comm_fail(c, "%g %g %g | %g %g %g | %g %g %g | %g %g %g | again %g", x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7],
                  x[8], x[9], x[10], x[11], comm_output(c, 1, &n)[0]);
}
PROGRAM(.title = "a search", .parameter = {PROGRAM_WHOLE(finder, -1, 99, ""), PROGRAM_WHOLE(second, -1, 99, ""), PROGRAM_WHOLE(steps, 1, 99, ""),
        PROGRAM_WHOLE(limit, 1, 999, ""), PROGRAM_WHOLE(noisy, 0, 1, "")},
        .output = {"ends", "again"}, .run = run, .check = check, .wildcards = 1, .cost = MIMDSIM_COST_AUTHOR, .tolerance = 0.5);
END
}

# told OPTION...: what each of four ranks saw (microseconds, answer, steps), and how long the same search took again
told() {
    run --separate-stderr -- mimdsim run "$BATS_FILE_TMPDIR/find.c" --set ranks=4 -o s.db --force --quiet "$@"
    [[ $stderr =~ :\ ([0-9.]+\ [-0-9]+\ [0-9]+\ \|.*again\ [0-9.e+]+) ]] || { show; return 1; }
    echo "${BASH_REMATCH[1]}"
}

@test "the first to find interrupts all others, at one time" {
    # rank 2 finds after 9 ms; the signal takes 8 us; the others are in their 10th, 5th and 3rd step
    [ "$(told -m t3e-300-eureka)" = '9008 1 10 | 9008 1 5 | 9008 2 3 | 9008 1 3 | again 9008' ]
    # what takes longer than the step of another does not count: rank 3 would have found after 12 ms
    [ "$(told -m t3e-300-eureka --set second=3)" = '9008 1 10 | 9008 1 5 | 9008 2 3 | 9008 1 3 | again 9008' ]
    # the fastest of two finders is the first, whoever it is
    [ "$(told -m t3e-300-eureka --set second=0)" = '3008 2 3 | 3008 1 2 | 3008 1 2 | 3008 1 1 | again 3008' ]
}

@test "who has nothing left waits for the others, and all of them for nobody" {
    [ "$(told -m t3e-300-eureka --set finder=-1 --set limit=2)" = '8008 -1 2 | 8008 -1 2 | 8008 -1 2 | 8008 -1 2 | again 8008' ]
    # ranks that have given up are called as well
    [ "$(told -m t3e-300-eureka --set finder=2 --set limit=3)" = '9008 1 3 | 9008 1 3 | 9008 2 3 | 9008 1 3 | again 9008' ]
}

@test "a step that sent messages is not taken back" {
    run told -m t3e-300-eureka --set noisy=1
    [[ $output == '9008 1 10 | 9008 1 5 | 9008 2 3 | 12'* ]] || { echo "$output"; return 1; }
}

@test "without an eureka the ranks ask each other after each step, with the same answers" {
    # three rounds of the slowest step, and an allreduce behind each
    run told -m t3e-300
    [[ $output =~ ^(12[0-9.]+)\ 1\ 3\ \|\ [0-9.]+\ 1\ 3\ \|\ [0-9.]+\ 2\ 3\ \|\ [0-9.]+\ 1\ 3\ \| ]] || { echo "$output"; return 1; }
    run told -m t3e-300 --set finder=-1 --set limit=2
    [[ $output =~ ^8[0-9.]+\ -1\ 2 ]] || { echo "$output"; return 1; }
}

@test "times are those of one path; timelines end at the signal" {
    sed 's/x\[1\] < 3/0/' "$BATS_FILE_TMPDIR/find.c" >find.c
    works mimdsim run find.c -m t3e-300-eureka --set ranks=4 --set record.spans=true -o t.db --quiet
    sql_is t.db "SELECT makespan_ps FROM run" 18032000000
    # interrupted ranks have computed until the signal, and no longer; the finder has waited for it
    sql_is t.db "SELECT group_concat((compute_ps / 1000000) || '+' || (wait_ps / 1000000), ' ') FROM (SELECT * FROM rank_stage ORDER BY rank)" \
        '18016+16 18016+16 18000+32 18016+16'
    # spans of a rank follow each other without gaps or overlaps
    sql_is t.db "SELECT count(*) FROM (SELECT rank, begin_ps, lag(end_ps) OVER (PARTITION BY rank ORDER BY begin_ps, end_ps) AS before
        FROM span) WHERE begin_ps < before" 0
    sql_is t.db "SELECT sum(end_ps - begin_ps) FROM span WHERE kind = 'compute' AND rank = 0" 18016000000
    works mimdsim check t.db --again all
    works mimdsim why find.c -m t3e-300-eureka --set ranks=4 --quiet
    stdout_says '18.03 ms'
    stdout_says 'follows 0 messages'
}

@test "searches that cannot be are told" {
    sed 's/x\[1\] < 3/0/; s/[.]wildcards = 1, //' "$BATS_FILE_TMPDIR/find.c" >plain.c
    fails_with 1 mimdsim run plain.c -m t3e-300-eureka --set ranks=2 -o s.db --quiet
    stderr_says "a search in a program that has promised to do without looks at the clock (a kernel in one file declares .wildcards = 1)"
    sed 's/while (ended == 0)/while (ended == 0 \&\& me > 0)/; s/again < 2/again < 1/' "$BATS_FILE_TMPDIR/find.c" >late.c
    fails_with 70 mimdsim run late.c -m t3e-300-eureka --set ranks=3 --set finder=-1 --set limit=2 -o s.db --quiet
    stderr_says "waits for the end of a search (late.c:19)"
    sed 's/ended = comm_search(c, state)/ended = comm_search(c, (enum comm_search_state)7)/' "$BATS_FILE_TMPDIR/find.c" >odd.c
    fails_with 1 mimdsim run odd.c -m t3e-300 --set ranks=2 -o s.db --quiet
    stderr_says "says 7 in a search, which is no enum comm_search_state"
    fails_with 65 mimdsim run odd.c -m t3e-300-eureka --set machine.network.collective.kinds=eurekka -o s.db --quiet
    stderr_says "expected 'eureka'"
}

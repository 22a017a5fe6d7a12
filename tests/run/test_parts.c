/* test_parts.c - what a campaign is made of: results as bytes, what is left out by its bits, runs
 * that somebody deals out, refusals, and what is said when somebody ends it. */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/arena.h"
#include "base/random.h"
#include "plan/plan.h"
#include "program/program.h"
#include "run/interrupt.h"
#include "run/omission.h"
#include "run/result_parts.h"
#include "run/run.h"

#include "../support/last_words.h"

/* Random bytes in all arrays of a result; every second time some are missing. */
static void draw_result(struct random *r, struct run_result *out, struct arena *a)
{
    memset(out, 0, sizeof *out);
    out->nrank = 1 + (int)random_below(r, 5);
    out->nstage = (int)random_below(r, 4);
    out->makespan_ps = (int64_t)random_u64(r);
    out->nspan = (int)random_below(r, 4);
    out->nlink = (int)random_below(r, 4);
    out->nsaid = (int)random_below(r, 9);
    out->npath = (int)random_below(r, 3);
    out->nslack = (int)random_below(r, 3);
    bool all = random_below(r, 2);
    const size_t rows = (size_t)(out->nrank * out->nstage);
    /* counts say how long each is, but for two that may not be there */
    out->finish_ps = all ? arena_take(a, (size_t)out->nrank * sizeof *out->finish_ps) : NULL;
    out->rank_slack = all ? arena_take(a, rows * sizeof *out->rank_slack + 1) : NULL;
    const struct result_parts p = result_parts(out);
    for (int i = 0; i < RESULT_PARTS; i++) {
        if (p.bytes[i] == 0) continue;
        unsigned char *bytes = arena_take(a, p.bytes[i]);
        for (size_t k = 0; k < p.bytes[i]; k++) bytes[k] = (unsigned char)random_below(r, 256);
        *p.array[i] = bytes;
    }
}

static void results_travel_as_bytes(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct random r = random_make(2, 0, 0);
    for (int round = 0; round < 200; round++) {
        struct run_result given, back;
        size_t bytes;
        int number = -1;
        draw_result(&r, &given, a);
        char *block = result_pack(round, &given, &bytes);
        assert_true(result_unpack(block, bytes, &number, &back, a));
        assert_int_equal(number, round);
        assert_int_equal(back.makespan_ps, given.makespan_ps);
        struct result_parts p = result_parts(&given), q = result_parts(&back);
        for (int i = 0; i < RESULT_PARTS; i++) {
            assert_int_equal(p.bytes[i], q.bytes[i]);
            if (p.bytes[i] == 0) assert_null(*q.array[i]);
            else {
                assert_ptr_not_equal(*p.array[i], *q.array[i]);
                assert_memory_equal(*p.array[i], *q.array[i], p.bytes[i]);
            }
        }
        /* a block that is cut, or longer, is none: copies of just that size, for sanitizers */
        for (int k = 0; k < 4; k++) {
            const size_t cut = k == 0 ? bytes - 1 : (size_t)random_below(&r, bytes);
            char *part = malloc(cut + 1);
            assert_non_null(part);
            memcpy(part, block, cut);
            assert_false(result_unpack(part, cut, &number, &back, a));
            free(part);
        }
        block = realloc(block, bytes + 1);
        assert_non_null(block);
        block[bytes] = 0;
        assert_false(result_unpack(block, bytes + 1, &number, &back, a));
        free(block);
    }
    arena_destroy(a);
}

static void bits_put_back_what_is_left_out(void **state)
{
    (void)state;
    static struct run_spec spec;
    memset(&spec, 0, sizeof spec);
    spec.machine.network.level = LEVEL_AUTO;
    assert_int_equal(omission_machine(&spec, 0).network.level, LEVEL_AUTO);
    struct record_spec record = omission_record(&spec, 0);
    assert_false(record.spans || record.links);
    assert_int_equal(omission_machine(&spec, KEEP_CONTENTION).network.level, LEVEL_PACKET);
    assert_int_equal(spec.machine.network.level, LEVEL_AUTO); /* a copy */
    spec.machine.network.level = LEVEL_LOGGP;                 /* of level auto alone */
    assert_int_equal(omission_machine(&spec, KEEP_CONTENTION).network.level, LEVEL_LOGGP);
    record = omission_record(&spec, KEEP_SPANS);
    assert_true(record.spans && !record.links);
    record = omission_record(&spec, KEEP_LINKS);
    assert_true(record.links && !record.spans);
    spec.record.spans = true;
    assert_true(omission_record(&spec, 0).spans);
}

/* A program of one rank whose largest message is as long as its context says. */
static int64_t promised;
static int64_t promise(const void *job)
{
    (void)job;
    return promised;
}

static int list(struct program_run *r, struct omission *out)
{
    memset(out, 0, RUN_MAX_OMISSIONS * sizeof *out);
    return omission_listing(r, out);
}

static void what_the_simulator_leaves_out_is_listed(void **state)
{
    (void)state;
    static struct omission out[RUN_MAX_OMISSIONS];
    static struct program_run r;
    static const struct program_type type = {.name = "none"};
    struct rank_program rank = {.largest_message = promise};
    r = (struct program_run){.type = &type, .rank = &rank};
    r.spec.machine.network.level = LEVEL_LOGGP;
    r.spec.machine.software.eager_bytes = 100;
    promised = 100;
    assert_int_equal(omission_largest_message(&r), 100);
    assert_int_equal(list(&r, out), 2);
    assert_string_equal(out[0].what, "timeline");
    assert_int_equal(out[0].keep, KEEP_SPANS);
    assert_int_equal(out[1].keep, KEEP_LINKS);
    /* messages that are eager in order, by the promise or by the machine */
    r.spec.machine.network.level = LEVEL_LINK;
    assert_int_equal(list(&r, out), 3);
    assert_string_equal(out[0].why, "eager sends are in order");
    assert_int_equal(out[0].keep, KEEP_START_EVENTS);
    promised = 101;
    assert_int_equal(list(&r, out), 2);
    promised = -1; /* nothing is promised */
    assert_int_equal(list(&r, out), 2);
    r.spec.machine.software.eager_bytes = -1;
    assert_int_equal(list(&r, out), 3);
    assert_string_equal(out[0].why, "the machine sends every message at once, in order");
    assert_int_equal(out[0].keep, 0);
    r.spec.machine.network.level = LEVEL_AUTO;
    assert_int_equal(list(&r, out), 4);
    assert_int_equal(out[1].keep, KEEP_CONTENTION);
    /* what is asked for or put back is not left out */
    r.spec.record.spans = r.spec.record.links = true;
    r.order.keep = KEEP_CONTENTION | KEEP_START_EVENTS;
    assert_int_equal(list(&r, out), 1);
    promised = 7;
    assert_int_equal(omission_largest_message(&r), -1);
}

/* ---- runs that are dealt out ---- */

struct deal {
    int order[8], n, at, later, attended, got;
    bool stop, fail;
    int64_t makespan_ps[8];
    int rank[8];
};

static int next_run(void *context)
{
    struct deal *d = context;
    if (d->later > 0) return d->later--, RUN_LATER;
    return d->at < d->n ? d->order[d->at++] : RUN_NO_MORE;
}

static bool attend(void *context, bool *active, struct err *e)
{
    struct deal *d = context;
    d->attended++;
    *active = false;
    return !d->fail || err_set(e, ERR_IO, "somebody is gone");
}

static bool keep(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct deal *d = context;
    d->rank[d->got] = spec->nrank;
    d->makespan_ps[d->got++] = r->makespan_ps;
    return !d->stop;
}

static void dealt_runs_are_made_each_once(void **state)
{
    (void)state;
    struct plan p;
    struct err e;
    err_clear(&e);
    if (!plan_read(&p, MIMDSIM_SRCDIR "/scenarios/speedup-t3e.yaml", NULL, &e))
        fail_msg("%s", e.text);
    struct deal d = {.order = {3, 0, 2}, .n = 3, .later = 2};
    const struct run_dealer dealer = {next_run, attend, keep, &d};
    assert_true(run_stream(p.run, NULL, p.nrun, 2, &dealer, &e));
    assert_int_equal(d.got, 3);
    assert_true(d.attended > 0);
    int seen = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) seen += d.rank[i] == p.run[d.order[k]].nrank;
    assert_int_equal(seen, 3);
    for (int i = 0; i < 3; i++) assert_true(d.makespan_ps[i] > 0);
    /* nothing to do; an error of who attends; and whoever takes results may stop */
    d = (struct deal){0};
    assert_true(run_stream(p.run, NULL, p.nrun, 2, &dealer, &e));
    assert_int_equal(d.got, 0);
    d = (struct deal){.order = {0}, .n = 1, .fail = true};
    assert_false(run_stream(p.run, NULL, p.nrun, 1, &dealer, &e));
    assert_int_equal(e.kind, ERR_IO);
    plan_free(&p);
}

static void a_refusal_keeps_its_reason(void **state)
{
    (void)state;
    struct err e;
    err_clear(&e);
    err_set(&e, ERR_CONFIG, "more ranks than bodies");
    const struct run_result r = run_refused(&e);
    assert_int_equal(r.status, RUN_FAILED);
    assert_int_equal(r.refusal, ERR_CONFIG);
    assert_non_null(strstr(r.text, "more ranks than bodies"));
    assert_true(r.nrank == 0 && r.stage == NULL && r.nspan == 0);
}

/* ---- Ctrl-C ---- */

enum how { HEARD, ENDED, NOTHING_TO_DO, SECOND, IGNORED };
enum { SINGLE = 8 /* beside one of these: of a single run */ };

/* What the child does until it is ended; it lives on, with status 7, where the signal is ignored.
 */
static _Noreturn void live(int number, enum how how)
{
    struct interrupt x, second;
    const bool single = how & SINGLE;
    how &= ~SINGLE;
    signal(number, how == IGNORED ? SIG_IGN : SIG_DFL);
    if (single) interrupt_begin_single(&x);
    else interrupt_begin(&x, "runs.db", how == NOTHING_TO_DO ? 0 : 5);
    atomic_store(&x.stored, 3);
    if (how == ENDED) interrupt_end(&x);
    if (how == SECOND) interrupt_begin(&second, NULL, 9);
    if (how == SECOND && second.on) _exit(8);
    /* to the process: a signal of one thread alone would wait for ever */
    kill(getpid(), number);
    if (how != IGNORED) sleep(20);
    _exit(7);
}

static int its_number;
static enum how its_state;
static void live_as_told(void) { live(its_number, its_state); }

/* A child that gets `number` in the state `how`: how it ends, and what it has said. */
static int child(int number, enum how how, char *said, size_t size)
{
    its_number = number;
    its_state = how;
    return words_of(live_as_told, said, size);
}

static void whoever_ends_a_campaign_is_told_that_rows_stay(void **state)
{
    (void)state;
    static const int numbers[] = {SIGINT, SIGTERM};
    char said[400];
    for (int i = 0; i < 2; i++) {
        const int number = numbers[i];
        int status = child(number, HEARD, said, sizeof said);
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == number);
        assert_non_null(strstr(said, "what is stored stays"));
        assert_non_null(strstr(said, "3 of 5 runs were made, into runs.db"));
        status = child(number, SECOND, said, sizeof said); /* the first one knows most */
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == number);
        assert_non_null(strstr(said, "3 of 5 runs were made, into runs.db"));
        status = child(number, ENDED, said, sizeof said); /* as it was before */
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == number);
        assert_string_equal(said, "");
        status = child(number, NOTHING_TO_DO, said, sizeof said);
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == number);
        assert_string_equal(said, "");
        status = child(number, IGNORED, said, sizeof said); /* under nohup */
        assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 7);
        assert_string_equal(said, "");
    }
}

static void whoever_ends_a_single_run_is_told_once(void **state)
{
    (void)state;
    static const int numbers[] = {SIGINT, SIGTERM};
    static const char line[] = "\nmimdsim: interrupted: what is stored stays, and the same command "
                               "goes on from there\n";
    char said[400];
    for (int i = 0; i < 2; i++) {
        const int number = numbers[i];
        int status = child(number, SINGLE | HEARD, said, sizeof said);
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == number);
        assert_string_equal(said, line);
        status = child(number, SINGLE | SECOND, said, sizeof said); /* no second line */
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == number);
        assert_string_equal(said, line);
        status = child(number, SINGLE | ENDED, said, sizeof said);
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == number);
        assert_string_equal(said, "");
        status = child(number, SINGLE | IGNORED, said, sizeof said);
        assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 7);
        assert_string_equal(said, "");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_travel_as_bytes),
        cmocka_unit_test(bits_put_back_what_is_left_out),
        cmocka_unit_test(what_the_simulator_leaves_out_is_listed),
        cmocka_unit_test(dealt_runs_are_made_each_once),
        cmocka_unit_test(a_refusal_keeps_its_reason),
        cmocka_unit_test(whoever_ends_a_campaign_is_told_that_rows_stay),
        cmocka_unit_test(whoever_ends_a_single_run_is_told_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

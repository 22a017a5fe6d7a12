/* test_campaign.c - many runs on worker processes: the same rows whatever their number, and a death
 * is told. */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/text.h"
#include "plan/plan.h"
#include "run/run.h"

enum { MOST_RUNS = 32 };

struct rows {
    int n, last;                         /* stop after `last` rows; 0: never */
    enum { NOBODY, ALL, THE_LAST } dies; /* which workers are killed at the first row */
    uint64_t digest[MOST_RUNS], stages[MOST_RUNS];
    int64_t makespan_ps[MOST_RUNS], finish_ps[MOST_RUNS], busy_ps[MOST_RUNS];
    int nrank[MOST_RUNS];
    /* runs that could not be made or lost their worker; the last one's kind and text */
    int failed, refusal;
    char text[256];
};

/* FNV-1a over the bytes of an array. */
static uint64_t hash(const void *data, size_t n)
{
    uint64_t h = 14695981039346656037u;
    for (const unsigned char *p = data; n--; p++) h = (h ^ *p) * 1099511628211u;
    return h;
}

/* Kill all our children, or the one started last, which has by then told its answer and waits for
 * an order. */
static void kill_workers(bool all)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/self/task/%d/children", (int)getpid());
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    int pid = 0;
    for (int next; fscanf(f, "%d", &next) == 1; pid = next)
        if (all) kill(next, SIGKILL);
    fclose(f);
    if (all) return;
    siginfo_t how;
    usleep(50000);
    kill(pid, SIGKILL);
    assert_int_equal(waitid(P_PID, (id_t)pid, &how, WEXITED | WNOWAIT), 0);
}

static bool keep(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct rows *k = context;
    int i = k->n++;
    assert_true(i < MOST_RUNS);
    assert_int_equal(spec->nrank, r->nrank);
    if (r->status == RUN_FAILED) {
        k->failed++;
        k->refusal = r->refusal;
        text_copy(k->text, sizeof k->text, r->text);
        return true;
    }
    k->digest[i] = r->digest;
    k->makespan_ps[i] = r->makespan_ps;
    k->nrank[i] = r->nrank;
    k->stages[i] = hash(r->stage, (size_t)(r->nrank * r->nstage) * sizeof *r->stage);
    k->finish_ps[i] = r->finish_ps[r->nrank - 1];
    for (int l = 0; l < r->nlink; l++) k->busy_ps[i] += r->link[l].busy_ps;
    if (k->dies != NOBODY && i == 0) kill_workers(k->dies == ALL);
    return k->n != k->last;
}

static struct plan speedup(void)
{
    struct plan p;
    struct err e;
    err_clear(&e);
    if (!plan_read(&p, MIMDSIM_SRCDIR "/scenarios/speedup-t3e.yaml", NULL, &e))
        fail_msg("%s", e.text);
    assert_int_equal(p.nrun, 28);
    return p;
}

static struct rows campaign(const struct plan *p, const bool *skip, int workers)
{
    struct rows rows = {0};
    struct err e;
    err_clear(&e);
    if (!run_campaign(p->run, NULL, p->nrun, skip, workers, true, keep, &rows, &e))
        fail_msg("%s", e.text);
    return rows;
}

static void rows_do_not_depend_on_the_number_of_workers(void **unused)
{
    (void)unused;
    struct plan p = speedup();
    struct rows one = campaign(&p, NULL, 1);
    assert_int_equal(one.n, p.nrun);
    for (int i = 0; i < p.nrun; i++) assert_int_equal(one.nrank[i], p.run[i].nrank);
    assert_true(one.busy_ps[0] > 0); /* links are recorded and travel with the result */
    for (int workers = 2; workers <= 3; workers++) {
        struct rows many = campaign(&p, NULL, workers);
        assert_memory_equal(&many, &one, sizeof one);
    }
    plan_free(&p);
}

static void what_is_skipped_is_not_run_and_the_rest_keeps_its_order(void **unused)
{
    (void)unused;
    struct plan p = speedup();
    struct rows all = campaign(&p, NULL, 1);
    bool skip[MOST_RUNS] = {[0] = true, [5] = true, [6] = true, [27] = true};
    for (int workers = 1; workers <= 3; workers += 2) {
        struct rows some = campaign(&p, skip, workers);
        assert_int_equal(some.n, 24);
        for (int i = 0, k = 0; i < 28; i++)
            if (!skip[i]) assert_true(some.digest[k++] == all.digest[i]);
    }
    memset(skip, true, sizeof skip);
    assert_int_equal(campaign(&p, skip, 3).n, 0);
    plan_free(&p);
}

/* Copies of the plan's runs, which the caller may change, in the plan's place. */
static struct run_spec *own_runs(struct plan *p)
{
    struct run_spec *run = TAKE(p->arena, p->nrun, struct run_spec);
    memcpy(run, p->run, (size_t)p->nrun * sizeof *run);
    p->run = run;
    return run;
}

static void who_takes_the_rows_may_stop(void **unused)
{
    (void)unused;
    struct plan p = speedup();
    for (int workers = 1; workers <= 3; workers++) {
        struct rows rows = {.last = 4};
        struct err e;
        err_clear(&e);
        assert_false(run_campaign(p.run, NULL, p.nrun, NULL, workers, true, keep, &rows, &e));
        assert_int_equal(rows.n, 4);
    }
    plan_free(&p);
}

static void a_run_that_cannot_be_made_fails_and_the_others_go_on(void **unused)
{
    (void)unused;
    struct plan p = speedup();
    struct run_spec *run = own_runs(&p);
    run[6].nrank = run[6].model.nbody + 1;
    for (int workers = 1; workers <= 3; workers++) {
        struct rows rows = {0};
        struct err e;
        err_clear(&e);
        if (!run_campaign(p.run, NULL, p.nrun, NULL, workers, true, keep, &rows, &e))
            fail_msg("%s", e.text);
        assert_int_equal(rows.n, p.nrun);
        assert_int_equal(rows.failed, 1);
        assert_int_equal(rows.refusal, ERR_CONFIG);
        assert_int_equal(rows.nrank[6], 0); /* it, and no other */
        assert_int_equal(rows.nrank[7], p.run[7].nrank);
    }
    plan_free(&p);
}

static void a_worker_that_dies_costs_its_run_alone(void **unused)
{
    (void)unused;
    struct plan p = speedup();
    struct run_spec *run = own_runs(&p);
    /* so long that the first row is there while others still run */
    for (int i = 2; i < p.nrun; i++) {
        run[i] = run[13];
        run[i].machine.network.level = LEVEL_FLIT;
    }
    for (int workers = 2; workers <= 4; workers++) {
        for (int dies = ALL; dies <= THE_LAST; dies++) {
            struct rows rows = {.dies = dies};
            struct err e;
            err_clear(&e);
            if (!run_campaign(p.run, NULL, p.nrun, NULL, workers, true, keep, &rows, &e))
                fail_msg("%s", e.text);
            assert_int_equal(rows.n, p.nrun);
            assert_true(rows.failed >= 1 && rows.failed <= (dies == ALL ? workers : 1));
            assert_int_equal(rows.refusal, ERR_INTERNAL);
            assert_non_null(strstr(rows.text, "its worker process was killed by signal 9"));
        }
    }
    plan_free(&p);
}

/* What is the same in a run whether its scene was shared or made for it alone. */
struct shared {
    int n;
    struct run_result row[MOST_RUNS];
};

static bool keep_whole(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct shared *s = context;
    (void)spec;
    assert_true(s->n < MOST_RUNS);
    s->row[s->n++] = *r;
    return true;
}

static void sharing_scenes_changes_no_number(void **unused)
{
    (void)unused;
    static const char *const set[] = {"n=24"};
    struct plan p;
    struct err e;
    err_clear(&e);
    struct plan_options o = {.nset = 1, .set = set};
    if (!plan_read(&p, MIMDSIM_SRCDIR "/scenarios/fig7.yaml", &o, &e)) fail_msg("%s", e.text);
    int n = p.nrun < MOST_RUNS ? p.nrun : MOST_RUNS;
    struct shared with = {0}, without = {0};
    assert_true(n > 4 && run_campaign(p.run, NULL, n, NULL, 1, true, keep_whole, &with, &e));
    struct run_order order[MOST_RUNS];
    for (int i = 0; i < n; i++) order[i] = (struct run_order){.keep = KEEP_SCENES};
    assert_true(run_campaign(p.run, order, n, NULL, 1, true, keep_whole, &without, &e));
    for (int i = 0; i < n; i++) {
        const struct run_result *x = &with.row[i], *y = &without.row[i];
        assert_true(x->status == y->status && x->digest == y->digest &&
                    x->makespan_ps == y->makespan_ps);
        assert_true(x->nerror == y->nerror && x->nbaseline == y->nbaseline && x->nerror > 0 &&
                    x->nbaseline > 3);
        for (int k = 0; k < x->nerror; k++)
            assert_true(x->error[k].relative == y->error[k].relative);
        for (int k = 0; k < x->nbaseline; k++)
            assert_true(x->baseline[k].time_ps == y->baseline[k].time_ps);
    }
    plan_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_do_not_depend_on_the_number_of_workers),
        cmocka_unit_test(what_is_skipped_is_not_run_and_the_rest_keeps_its_order),
        cmocka_unit_test(who_takes_the_rows_may_stop),
        cmocka_unit_test(a_run_that_cannot_be_made_fails_and_the_others_go_on),
        cmocka_unit_test(a_worker_that_dies_costs_its_run_alone),
        cmocka_unit_test(sharing_scenes_changes_no_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_divided.c - dynamics of a chain of which each process of a job makes a part: process 0 has
 * what one process has, and a wrong answer of any of them is found. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <pthread.h>
#include <string.h>

#include "base/random.h"
#include "kernel/dynamics_program.h"
#include "measure/rank_sums.h"
#include "plan/plan.h"
#include "run/run.h"

#include "../support/thread_hosts.h"

enum { MOST_SETTINGS = 12, MOST_BODIES = 700, NOBODY = -1 };

/* The only run of the benchmark scenario with these settings, "key=value", ended by NULL. */
static struct run_spec spec_with(struct plan *p, const char *const *setting)
{
    struct plan_options o = {.set = setting};
    struct err e;
    err_clear(&e);
    while (setting[o.nset]) o.nset++;
    if (!plan_read(p, MIMDSIM_SRCDIR "/scenarios/speedup-t3e.yaml", &o, &e)) fail_msg("%s", e.text);
    return p->run[0];
}

/* --- a program that one of the ranks gets wrong --- */

static _Thread_local const struct rank_program *right;
static _Thread_local int wrong_rank, wrong_output;

static void run_wrong(struct comm *c, const void *job_, void *workspace)
{
    const struct kernel_job *job = job_;
    right->run(c, job, workspace);
    const double nonsense = 1e3;
    if (comm_rank(c) == wrong_rank)
        comm_publish(c, wrong_output, kernel_block(job->model->nbody, job->nrank, wrong_rank), 1,
                     &nonsense);
}

struct process {
    pthread_t thread;
    struct hosts hosts;
    const struct run_spec *spec;
    int wrong, number, output; /* what is looked at, and what the wrong rank publishes */
    bool sums, loses; /* a second run follows, before which process 0 gives its part away */
    struct arena *arena;
    struct run_result r;
    double answer[MOST_BODIES], reference[MOST_BODIES];
    int first, end, own_bodies; /* bodies of which records are there */
    bool divided;
};

static int64_t price_ps(const void *context, const struct work *w)
{
    (void)context;
    return (int64_t)(w->flop + 7 * w->div + 11 * w->trig + 13 * w->call + 17 * w->sqrt);
}

/* As run_sharing, but for the wrong rank. */
static void execute_once(struct process *p, struct run_cache *cache, int number)
{
    struct run_order order = {.hosts = p->hosts.size > 0 ? &p->hosts : NULL,
                              .job_run = number, .sums = p->sums};
    struct arena *own = arena_create(), *scratch = arena_create();
    struct program_run run;
    struct err e;
    err_clear(&e);
    if (!run_open(p->spec, &order, cache, own, &run, &e)) fail_msg("%s", e.text);
    struct rank_program wrong = *run.rank;
    right = run.rank;
    wrong_rank = p->wrong;
    wrong_output = p->output;
    wrong.run = run_wrong;
    if (p->wrong != NOBODY) run.rank = &wrong;
    p->divided = run.divided;
    const struct model *m = dynamics_run_of(&run)->job.model;
    p->own_bodies = 0;
    for (int i = 0; i < m->nbody; i++) p->own_bodies += m->body[i].mass > 0;
    if (!run_attempts(&run, cache, p->arena, &p->r, &e)) fail_msg("%s", e.text);
    const struct work_price price = {price_ps, NULL};
    if (p->hosts.rank == 0 || run.divided) {
        run.type->check(&run, scratch, &p->r);
        run.type->baselines(&run, &price, scratch, &p->r);
    }
    const struct scene *s = dynamics_run_of(&run)->scene;
    const struct serial_answer *reference =
        p->output == OUTPUT_TAU ? &s->inverse : &s->forward[FORWARD_ABA];
    p->first = m->first, p->end = m->end;
    for (int i = m->first; i < m->end && p->r.nerror > 0; i++) {
        p->answer[i] = program_output(&run, p->output)[i];
        p->reference[i] = reference->x[i];
    }
    run_close(&run);
    arena_destroy(scratch);
    arena_destroy(own);
}

/* Process 0 makes a run alone whose scene leaves no room for others, as it does when ranks fail. */
static void lose_part(const struct run_spec *spec, struct run_cache *cache)
{
    struct run_spec large = *spec;
    struct run_order alone = {0};
    struct arena *own = arena_create();
    struct program_run run;
    struct err e;
    err_clear(&e);
    large.nrank = 1;
    large.model.nbody = (1 << 17) + 1;
    if (!run_open(&large, &alone, cache, own, &run, &e)) fail_msg("%s", e.text);
    run_close(&run);
    arena_destroy(own);
}

static void *execute(void *argument)
{
    struct process *p = argument;
    struct run_cache *cache = run_cache_create();
    thread_hosts_join(p->hosts.rank);
    p->arena = arena_create();
    execute_once(p, cache, p->number);
    if (p->loses) {
        if (p->hosts.rank == 0) lose_part(p->spec, cache);
        memset(&p->r, 0, sizeof p->r);
        execute_once(p, cache, p->number + 1);
    }
    run_cache_destroy(cache);
    return NULL;
}

/* The result of process 0 of `size`, 0: of one without a job. */
static struct process *job(const struct run_spec *spec, int size, int wrong, bool sums, bool loses)
{
    static struct process p[THREAD_HOSTS];
    static int number;
    thread_hosts_begin();
    memset(p, 0, sizeof p);
    number += 2;
    for (int i = 0; i < (size > 0 ? size : 1); i++) {
        p[i] = (struct process){.hosts = {i, size, &thread_hosts},
                                .spec = spec,
                                .wrong = wrong,
                                .number = number,
                                .output = kernel_spec_has(&spec->kernel, PROGRAM_FORWARD)
                                              ? OUTPUT_QDD
                                              : OUTPUT_TAU,
                                .sums = sums,
                                .loses = loses};
        assert_int_equal(pthread_create(&p[i].thread, NULL, execute, &p[i]), 0);
    }
    for (int i = 0; i < (size > 0 ? size : 1); i++) {
        pthread_join(p[i].thread, NULL);
        assert_int_equal(p[i].divided, size > 1);
        /* neighbours are there, and one more for its axis */
        if (size > 1)
            assert_true(p[i].own_bodies <= (spec->nrank / size + spec->nrank / 8 + 1) *
                                               (spec->model.nbody / spec->nrank + 1) + 4);
    }
    assert_int_equal(thread_hosts_end(), 0);
    return p;
}

static void end(struct process *p)
{
    for (int i = 0; i < THREAD_HOSTS; i++) arena_destroy(p[i].arena);
}

static void same_checks(const struct run_result *a, const struct run_result *b)
{
    assert_int_equal(a->status, b->status);
    assert_string_equal(a->text, b->text);
    assert_int_equal(a->nerror, b->nerror);
    assert_memory_equal(&a->residual, &b->residual, sizeof(double));
    assert_memory_equal(&a->condition, &b->condition, sizeof(double));
    assert_int_equal(a->inner_added, b->inner_added);
    assert_int_equal(a->outer_added, b->outer_added);
    assert_int_equal(a->twice_added, b->twice_added);
    assert_int_equal(a->nbaseline, b->nbaseline);
    for (int i = 0; i < a->nbaseline; i++) {
        assert_string_equal(a->baseline[i].name, b->baseline[i].name);
        assert_int_equal(a->baseline[i].time_ps, b->baseline[i].time_ps);
    }
    for (int i = 0; i < a->nerror; i++) {
        assert_string_equal(a->error[i].quantity, b->error[i].quantity);
        assert_string_equal(a->error[i].reference, b->error[i].reference);
        assert_memory_equal(&a->error[i].relative, &b->error[i].relative, sizeof(double));
        assert_memory_equal(&a->error[i].tolerance, &b->error[i].tolerance, sizeof(double));
    }
}

static void every_number_of_processes(const char *const *setting)
{
    struct plan plan;
    const struct run_spec spec = spec_with(&plan, setting);
    const int wrong[] = {NOBODY, 0, spec.nrank / 2, spec.nrank - 1};
    for (int k = 0; k < 4; k++) {
        struct process *p = job(&spec, 0, wrong[k], false, false);
        const struct run_result one = p[0].r;
        assert_int_equal(one.status, wrong[k] == NOBODY ? RUN_OK : RUN_INVALID);
        assert_true(one.nerror > 0);
        struct arena *arena = p[0].arena;
        static double answer[MOST_BODIES], reference[MOST_BODIES];
        memcpy(answer, p[0].answer, sizeof answer);
        memcpy(reference, p[0].reference, sizeof reference);
        for (int size = 2; size <= 5; size++) {
            struct process *q = job(&spec, size, wrong[k], size % 2, false);
            for (int i = 0; i < size; i++)
                for (int b = q[i].first; b < q[i].end; b++) {
                    assert_true(q[i].answer[b] == answer[b]);
                    assert_true(q[i].reference[b] == reference[b]);
                }
            same_checks(&one, &q[0].r);
            assert_int_equal(one.digest, q[0].r.digest);
            assert_int_equal(one.makespan_ps, q[0].r.makespan_ps);
            end(q);
        }
        arena_destroy(arena);
    }
    plan_free(&plan);
}

#define SETTINGS(...)                                                                              \
    ((const char *const[MOST_SETTINGS]){"kernel=inverse", "level=loggp", __VA_ARGS__, NULL})

static void a_chain_is_checked_in_parts(void **state)
{
    (void)state;
    every_number_of_processes(SETTINGS("n=128"));
    /* Large messages would shake hands, in the order of time. */
    every_number_of_processes(
        SETTINGS("n=131", "ranks=64", "machine.software.eager.limit=unlimited"));
    every_number_of_processes(SETTINGS("n=64", "model.inertia=random", "model.external_force=3 N"));
    every_number_of_processes(SETTINGS("n=64", "model.rate=0 rad/s", "kernel.precision=float"));
    every_number_of_processes(SETTINGS("n=64", "model.base=moving",
                                       "model.base_acceleration.angular=[1, 2, 3] rad/s^2"));
}

#define FORWARD(...)                                                                               \
    ((const char *const[MOST_SETTINGS]){"level=loggp", "ranks=64", "n=600",                        \
                                        "machine.software.eager.limit=unlimited", __VA_ARGS__,     \
                                        NULL})

static void forward_dynamics_is_checked_in_parts(void **state)
{
    (void)state;
    every_number_of_processes(FORWARD("kernel=forward"));
    every_number_of_processes(FORWARD("kernel=dynamics", "model.inertia=random"));
    every_number_of_processes(FORWARD("kernel=forward", "kernel.formulation=paper"));
}

static int any(struct random *r, int n) { return (int)random_below(r, (uint64_t)n); }

/* Scene and settings number `number`, in place of those of *s. */
static void draw(int number, struct run_spec *s)
{
    static const char *const names[] = {"forward", "dynamics"};
    struct random r = random_make(51, (uint64_t)number, 1);
    struct model_spec *m = &s->model;
    struct kernel_spec *k = &s->kernel;
    m->nbody = 513 + any(&r, MOST_BODIES - 513);
    s->nrank = 5 + any(&r, 124);
    m->inertia = any(&r, 2) ? INERTIA_RANDOM : INERTIA_UNIFORM;
    if (any(&r, 3) == 0) m->rate = 0;
    if (any(&r, 3) == 0) m->external_force = 2;
    if (any(&r, 3) == 0) m->stiffness = 3, m->damping = 0.1;
    if (any(&r, 3) == 0) m->base = BASE_MOVING;
    for (int i = 0; i < 6 && m->base == BASE_MOVING; i++)
        m->base_acceleration[i] = random_normal(&r);
    snprintf(k->name, sizeof k->name, "%s", names[any(&r, 2)]);
    k->formulation = (enum formulation)any(&r, 2);
    k->solver = (enum solver)any(&r, 6);
    k->part_solver = (enum part_solver)any(&r, 2);
    k->precision = any(&r, 4) > 0 ? PRECISION_DOUBLE : (enum precision)any(&r, 3);
    k->composites_incoming = any(&r, 2);
    k->inner_refinements = k->solver == SOLVER_PCR ? 0 : any(&r, 2);
    k->outer_refinements = k->solver == SOLVER_PCR ? 0 : any(&r, 2);
    k->refinement = any(&r, 2) ? REFINEMENT_AS_NEEDED : REFINEMENT_AS_GIVEN;
    if (any(&r, 2)) m->mass_ratio = 1e6, m->inertia = INERTIA_RANDOM;
    if (k->formulation == FORMULATION_DIRECT && k->solver != SOLVER_PCR && any(&r, 3) == 0)
        k->residual = RESIDUAL_TWICE;
}

static void any_forward_dynamics_is_the_same_in_parts(void **state)
{
    (void)state;
    enum { RUNS = 24 };
    struct plan plan;
    const struct run_spec given = spec_with(&plan, FORWARD("kernel=forward"));
    int invalid = 0, refined = 0;
    for (int number = 0; number < RUNS; number++) {
        struct run_spec spec = given;
        draw(number, &spec);
        struct process *p = job(&spec, 0, NOBODY, false, false);
        const struct run_result one = p[0].r;
        struct arena *arena = p[0].arena;
        struct process *q = job(&spec, 2 + number % 4, NOBODY, number % 2, false);
        same_checks(&one, &q[0].r);
        assert_int_equal(one.digest, q[0].r.digest);
        assert_int_equal(one.makespan_ps, q[0].r.makespan_ps);
        invalid += one.status == RUN_INVALID;
        refined += one.inner_added + one.outer_added > 0 || one.twice_added;
        end(q);
        arena_destroy(arena);
    }
    printf("%d invalid, %d refined\n", invalid, refined);
    /* Of some the answers are poor, and some are made again with refinements. */
    assert_true(invalid > 0 && invalid < RUNS / 2 && refined > 0);
    plan_free(&plan);
}

static void a_part_that_was_given_away_is_made_again_by_all(void **state)
{
    (void)state;
    struct plan plan;
    const struct run_spec spec = spec_with(&plan, SETTINGS("n=64"));
    struct process *p = job(&spec, 0, NOBODY, false, false);
    const struct run_result one = p[0].r;
    struct arena *arena = p[0].arena;
    struct process *q = job(&spec, 3, NOBODY, false, true);
    same_checks(&one, &q[0].r);
    assert_int_equal(one.digest, q[0].r.digest);
    end(q);
    arena_destroy(arena);
    plan_free(&plan);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_chain_is_checked_in_parts),
        cmocka_unit_test(forward_dynamics_is_checked_in_parts),
        cmocka_unit_test(any_forward_dynamics_is_the_same_in_parts),
        cmocka_unit_test(a_part_that_was_given_away_is_made_again_by_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_omission.c - leaving out what a scene does not need changes no result beyond the omission's
 * class. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "kernel/dynamics_program.h"
#include "run/launch.h"
#include "run/omission.h"
#include "run/run.h"
#include "study/trial.h"

enum { SCENES = 260, MOST_NUMBERS = 400 };

/* Everything that a run answers. */
struct answer {
    int n;
    double x[MOST_NUMBERS]; /* tau, qdd, q and qd at the end, loop forces */
    int part[6];            /* where each of them begins */
    int64_t makespan_ps;
    uint64_t flops;
    int64_t finish_ps[64];
    int nrank;
};

static void append(struct answer *v, int part, const double *x, int n)
{
    v->part[part] = v->n;
    assert_true(v->n + n <= MOST_NUMBERS);
    for (int i = 0; x && i < n; i++) v->x[v->n++] = x[i];
    v->part[part + 1] = v->n;
}

/* One of the words, each as likely as the others. */
static int any(struct random *r, int n) { return (int)random_below(r, (uint64_t)n); }
static bool often(struct random *r, int one_in) { return any(r, one_in) != 0; }

static void draw_model(struct random *r, struct model_spec *m)
{
    static const enum model_generator kinds[] = {
        MODEL_SERIAL_CHAIN, MODEL_SERIAL_CHAIN, MODEL_SERIAL_CHAIN, MODEL_COMB,    MODEL_STAR,
        MODEL_RANDOM_TREE,  MODEL_DENDRIMER,    MODEL_RING,         MODEL_FOUR_BAR};
    static const enum model_joint joints[] = {JOINT_REVOLUTE,  JOINT_REVOLUTE,    JOINT_PRISMATIC,
                                              JOINT_SPHERICAL, JOINT_CYLINDRICAL, JOINT_MIXED};
    *m = (struct model_spec){.generator = kinds[any(r, 9)],
                             .nbody = 1 + any(r, 13),
                             .joint = joints[any(r, 6)],
                             .base = (enum model_base)any(r, 3),
                             .inertia = INERTIA_RANDOM,
                             .pose = POSE_RANDOM,
                             .axes = AXES_TWISTED,
                             .length = 1,
                             .radius = 0.05,
                             .mass = 1,
                             .mass_ratio = 4,
                             .torque = 1,
                             .branch = 2,
                             .seed = random_u64(r) >> 40};
    if (m->generator == MODEL_FOUR_BAR) m->nbody = 3;
    if (m->generator == MODEL_RING) {
        m->nbody += 3;
        m->joint = JOINT_REVOLUTE;
    }
    if (m->generator == MODEL_FOUR_BAR || m->generator == MODEL_RING) m->base = BASE_FIXED;
    if (often(r, 2)) m->gravity[2] = -9.81, m->gravity[0] = 1;
    if (!often(r, 3)) m->rate = 1;
    if (!often(r, 4)) m->external_force = 2;
    if (!often(r, 4)) m->stiffness = 3, m->damping = 0.1;
    for (int i = any(r, 2) * 3; i < 6; i++) m->base_acceleration[i] = random_normal(r);
}

static void draw_kernel(struct random *r, const struct model_spec *m, struct kernel_spec *k)
{
    static const char *const names[] = {"inverse", "forward", "dynamics"};
    const bool chain = m->generator == MODEL_SERIAL_CHAIN;
    *k = (struct kernel_spec){.formulation = (enum formulation)any(r, 2),
                              .solver = (enum solver)any(r, 6),
                              .part_solver = (enum part_solver)any(r, 2),
                              .operators = chain && !often(r,
                              4) ? OPERATORS_DENSE : OPERATORS_STRUCTURED,
                              .precision = often(r, 4) ? PRECISION_DOUBLE : (enum precision)any(r,
                              3),
                              .partition = (enum partition_rule)any(r, 2),
                              .composites_incoming = often(r, 3),
                              .hybrid_levels = 1,
                              .inner_refinements = often(r, 3) ? 0 : 1,
                              .outer_refinements = often(r, 3) ? 0 : 1,
                              .steps = often(r, 6) ? 0 : 2,
                              .step_size = 1e-3,
                              .step = (enum step_rule)any(r, 3)};
    snprintf(k->name, sizeof k->name, "%s", names[any(r, 3)]);
    if (k->solver == SOLVER_PCR) k->inner_refinements = k->outer_refinements = 0;
}

/* Scene number `number` of a stream that is the same on every host. */
static struct run_spec draw(int number)
{
    static const enum network_level levels[] = {LEVEL_LOGGP, LEVEL_LOGGP, LEVEL_LINK, LEVEL_PACKET,
                                                LEVEL_AUTO};
    struct random r = random_make(20, (uint64_t)number, 1);
    struct run_spec s = {0};
    draw_model(&r, &s.model);
    /* planar, unless something else leaves the plane */
    if (number % 3 == 0) s.model.axes = AXES_PARALLEL;
    draw_kernel(&r, &s.model, &s.kernel);
    if (s.kernel.formulation == FORMULATION_DIRECT && number % 4 == 0)
        s.kernel.step = STEP_LINEARLY_IMPLICIT;
    if (s.kernel.formulation == FORMULATION_DIRECT && number % 5 == 0 &&
        s.model.generator == MODEL_SERIAL_CHAIN)
        s.kernel.residual = RESIDUAL_TWICE;
    s.nrank = 1 + any(&r, s.model.nbody);
    s.machine = trial_machine(s.nrank);
    s.machine.network.level = levels[any(&r, 5)];
    s.machine.software.eager_bytes = 2048; /* longer messages ask first */
    s.machine.network.packet_bytes = 256;
    s.machine.network.flit_bytes = 8;
    s.machine.network.buffer_flits = 64;
    return s;
}

static void keep_answer(const struct program_run *r, const struct run_result *result,
                        struct answer *v)
{
    *v = (struct answer){.nrank = r->spec.nrank, .makespan_ps = result->makespan_ps};
    for (int i = 0; i < result->nrank * result->nstage; i++) v->flops += result->stage[i].work.flop;
    for (int k = OUTPUT_TAU; k <= OUTPUT_LAMBDA; k++)
        append(v, k, r->output[k].x, (int)r->output[k].n);
    memcpy(v->finish_ps, result->finish_ps, (size_t)r->spec.nrank * sizeof(int64_t));
}

/* answer_of: the spec's run with what `keep` puts back; false: the kernel does not do such scenes.
 * `left_out` (may be NULL): what it leaves out. */
static bool answer_of(const struct run_spec *spec, unsigned keep, struct arena *a, struct answer *v,
                      struct omission *left_out, int *n)
{
    const struct run_order order = {.keep = keep};
    struct err e = {0};
    struct run_cache *cache = run_cache_create();
    struct program_run r;
    struct run_result *result = TAKE(a, 1, struct run_result);
    const bool done = run_open(spec, &order, cache, a, &r, &e) && r.type->prepare(&r, a, &e);
    if (done) {
        if (left_out) *n = omission_listing(&r, left_out);
        const struct machine_spec machine = omission_machine(spec, keep);
        const struct record_spec record = omission_record(spec, keep);
        if (!launch_run(&r, &machine, &record, 1, omission_largest_message(&r), NULL, a, NULL, a,
                        result, &e))
            fail_msg("%s", e.text);
        assert_int_equal(result->status, RUN_OK);
        keep_answer(&r, result, v);
    }
    run_cache_destroy(cache);
    return done;
}

/* change: largest difference of two answers, each quantity relative to its largest number; 0: all
 * numbers are equal, a NaN to a NaN. */
static double change(const struct answer *a, const struct answer *b)
{
    double worst = a->n == b->n ? 0 : INFINITY;
    for (int part = 0; part < 5 && a->n == b->n; part++) {
        double scale = 0, difference = 0;
        for (int i = a->part[part]; i < a->part[part + 1]; i++) {
            if (a->x[i] == b->x[i] || (isnan(a->x[i]) && isnan(b->x[i]))) continue;
            if (isnan(a->x[i]) || isnan(b->x[i])) return INFINITY;
            difference = fmax(difference, fabs(a->x[i] - b->x[i]));
        }
        for (int i = a->part[part]; i < a->part[part + 1]; i++) scale = fmax(scale, fabs(a->x[i]));
        if (difference > 0) worst = fmax(worst, scale > 0 ? difference / scale : difference);
    }
    return worst;
}

static void describe(const struct run_spec *s, char *text, size_t size)
{
    snprintf(
        text, size,
        "%s, generator %d, n %d, P %d, joint %d, formulation %d, solver %d, precision %d, steps %d",
        s->kernel.name, s->model.generator, s->model.nbody, s->nrank, s->model.joint,
        s->kernel.formulation, s->kernel.solver, s->kernel.precision, s->kernel.steps);
}

/* What only the simulator and the references leave out: no simulated time may change. What makes
 * another program or another tree of it may take more or less; all others never do more, nor take
 * longer where messages cannot get in each other's way; where they can, those that leave earlier
 * may meet others: 1 %. */
enum {
    ON_THE_HOST = KEEP_START_EVENTS | KEEP_SPANS | KEEP_LINKS | KEEP_BASELINE | KEEP_CONTENTION |
                  KEEP_GENERAL | KEEP_SCENES,
    ANOTHER_PROGRAM = KEEP_BRANCHES | KEEP_FIXED
};

/* held_against: the answer with something put back against the one without. */
static void held_against(int number, const struct run_spec *spec, const struct answer *lean,
                         const struct answer *full, const char *what, double bound,
                         unsigned put_back)
{
    char text[300];
    const double c = change(lean, full);
    const bool same_times = (put_back & ~(unsigned)ON_THE_HOST) == 0,
               less = !(put_back & ANOTHER_PROGRAM);
    describe(spec, text, sizeof text);
    if (c > bound)
        fail_msg("scene %d: %s: changed by %g, more than %g (%s)", number, what, c, bound, text);
    if (less && lean->flops > full->flops)
        fail_msg("scene %d: %s is more work (%s)", number, what, text);
    const double slack = spec->machine.network.level == LEVEL_LOGGP ? 0 : 0.01;
    if (less && (double)lean->makespan_ps > (1 + slack) * (double)full->makespan_ps)
        fail_msg("scene %d: %s makes it slower: %lld, not %lld (%s)", number, what,
                 (long long)lean->makespan_ps, (long long)full->makespan_ps, text);
    if (same_times &&
        memcmp(lean->finish_ps, full->finish_ps, (size_t)lean->nrank * sizeof(int64_t)) != 0)
        fail_msg("scene %d: %s: other times (%s)", number, what, text);
}

/* How many scenes had each omission, and in how many putting it back took work or time. */
struct tally {
    unsigned keep;
    char what[48];
    int scenes, acts;
};

static struct tally *count(struct tally *t, const struct omission *o)
{
    while (t->scenes > 0 && strcmp(t->what, o->what) != 0) t++;
    memcpy(t->what, o->what, sizeof t->what);
    t->keep = o->keep;
    t->scenes++;
    return t;
}

static int try_scene(int number, struct tally *tally)
{
    struct omission left_out[RUN_MAX_OMISSIONS];
    struct answer lean, full;
    struct run_spec spec = draw(number);
    struct arena *a = arena_create();
    int n = 0;
    double bounds = 0;
    unsigned put_back = 0;
    const bool does = answer_of(&spec, 0, a, &lean, left_out, &n);
    for (int i = 0; does && i < n; i++) {
        struct tally *t = count(tally, &left_out[i]);
        bounds += left_out[i].bound;
        put_back |= left_out[i].keep;
        if (left_out[i].keep == 0) continue;
        if (!answer_of(&spec, left_out[i].keep, a, &full, NULL, NULL))
            fail_msg("scene %d: refused with %s", number, left_out[i].what);
        held_against(number, &spec, &lean, &full, left_out[i].what, left_out[i].bound,
                     left_out[i].keep);
        t->acts += full.flops != lean.flops || full.makespan_ps != lean.makespan_ps;
    }
    if (does && !answer_of(&spec, KEEP_ALL, a, &full, NULL, NULL))
        fail_msg("scene %d: refused with all of them", number);
    if (does) held_against(number, &spec, &lean, &full, "all of them", bounds, put_back);
    arena_destroy(a);
    return does;
}

static void no_omission_changes_a_result_beyond_its_class(void **state)
{
    (void)state;
    struct tally tally[RUN_MAX_OMISSIONS + 1] = {0};
    int scenes = 0;
    for (int number = 0; number < SCENES; number++) scenes += try_scene(number, tally);
    assert_true(scenes >= 200);
    static const unsigned rare[] = {KEEP_EXTERNAL,     KEEP_VELOCITY,   KEEP_BASE,   KEEP_BIAS,
                                    KEEP_START_EVENTS, KEEP_CONTENTION, KEEP_FIXED,  KEEP_GENERAL,
                                    KEEP_BRANCHES,     KEEP_TURN,       KEEP_SPATIAL};
    for (size_t i = 0; i < sizeof rare / sizeof *rare; i++) {
        int found = 0, acts = 0;
        for (const struct tally *t = tally; t->scenes > 0; t++) {
            found += t->keep == rare[i] ? t->scenes : 0;
            acts += t->keep == rare[i] ? t->acts : 0;
        }
        if (found < 8) fail_msg("keep bit %u: only %d scenes", rare[i], found);
        if (acts == 0 && !(rare[i] & ON_THE_HOST)) fail_msg("keep bit %u: never put back", rare[i]);
    }
}

static void a_changed_digit_is_seen(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct run_spec spec = draw(0);
    struct answer v, w;
    for (int number = 1; !answer_of(&spec, 0, a, &v, NULL, NULL); number++) spec = draw(number);
    w = v;
    assert_true(change(&v, &w) == 0);
    for (int i = 0; i < v.n; i++) {
        w.x[i] = nextafter(v.x[i], INFINITY);
        assert_true(change(&v, &w) > 0);
        w.x[i] = NAN;
        assert_true(change(&v, &w) == INFINITY);
        w.x[i] = v.x[i];
    }
    w.n--;
    assert_true(change(&v, &w) == INFINITY);
    arena_destroy(a);
}

/* A moving scene whose velocity terms are dropped all the same must not pass for the same. */
static void a_wrong_omission_is_seen(void **state)
{
    (void)state;
    for (int number = 0, found = 0; found < 20; number++) {
        struct run_spec spec = draw(number), rest = spec;
        struct arena *a = arena_create();
        struct answer v, w;
        rest.model.rate = 0;
        if (spec.model.rate > 0 && spec.model.nbody > 2 && spec.model.joint == JOINT_REVOLUTE &&
            answer_of(&spec, 0, a, &v, NULL, NULL) && answer_of(&rest, 0, a, &w, NULL, NULL)) {
            assert_true(change(&v, &w) > 1e-9);
            found++;
        }
        arena_destroy(a);
    }
}

static const struct baseline *baseline_of(const struct run_result *r, const char *name)
{
    for (int i = 0; i < r->nbaseline; i++)
        if (strcmp(r->baseline[i].name, name) == 0) return &r->baseline[i];
    return NULL;
}

/* record.baselines = needed: the fastest is the same, and what is missing was slower. */
static void serial_codes_left_out_are_never_the_fastest(void **state)
{
    (void)state;
    static const struct run_order order = {.keep = KEEP_BASELINE};
    int left_out = 0;
    for (int number = 0; number < 120; number++) {
        struct run_cache *cache = run_cache_create();
        struct arena *a = arena_create();
        struct run_spec spec = draw(number);
        struct run_result all, needed;
        struct err e = {0};
        snprintf(spec.kernel.name, sizeof spec.kernel.name, "forward");
        spec.kernel.steps = 0;
        spec.machine.network.level = LEVEL_LOGGP;
        if (spec.model.generator < MODEL_RING) spec.model.nbody = 1 + number;
        if (number % 2) spec.model.joint = JOINT_REVOLUTE;
        if (run_one(&spec, a, &all, &e)) {
            spec.record.baselines = BASELINES_NEEDED;
            assert_true(run_one(&spec, a, &needed, &e));
            const struct baseline *fastest = baseline_of(&needed, "fastest serial");
            assert_non_null(fastest);
            assert_int_equal(fastest->time_ps, baseline_of(&all, "fastest serial")->time_ps);
            for (int i = 0; i < all.nbaseline; i++) {
                const struct baseline *b = &all.baseline[i], *same = baseline_of(&needed, b->name);
                assert_true(same ? same->time_ps == b->time_ps : b->time_ps > fastest->time_ps);
                left_out += same == NULL;
            }
            assert_true(run_sharing(&spec, &order, cache, a, &needed, &e));
            assert_int_equal(needed.nbaseline, all.nbaseline);
        }
        run_cache_destroy(cache);
        arena_destroy(a);
    }
    assert_true(left_out > 40);
}

/* Of long chains the serial constraint force algorithm is counted: executed, it costs the same. */
static void work_that_is_counted_is_the_work_that_is_done(void **state)
{
    (void)state;
    static const struct run_order order = {.keep = KEEP_BASELINE};
    int same = 0;
    for (int number = 0; number < 24; number++) {
        struct run_cache *cache = run_cache_create();
        struct arena *a = arena_create();
        struct run_spec spec = draw(number);
        struct run_result counted, done;
        struct err e = {0};
        snprintf(spec.kernel.name, sizeof spec.kernel.name, number % 2 ? "forward" : "dynamics");
        spec.kernel.steps = 0;
        spec.kernel.algebra = ALGEBRA_SPATIAL;
        spec.machine.network.level = LEVEL_LOGGP;
        spec.machine.node.div_cycles = 7, spec.machine.node.sqrt_cycles = 11;
        spec.machine.node.trig_cycles = 13, spec.machine.node.call_time = 17e-9;
        spec.model.generator = MODEL_SERIAL_CHAIN;
        spec.model.joint = JOINT_REVOLUTE;
        spec.model.nbody = 513 + number;
        if (spec.model.base == BASE_FLOATING) spec.model.base = BASE_FIXED;
        if (!run_one(&spec, a, &counted, &e) || !run_sharing(&spec, &order, cache, a, &done, &e))
            fail_msg("%s", e.text);
        for (int i = 0; i < counted.nbaseline; i++) {
            const struct baseline *b = &counted.baseline[i];
            if (!strstr(b->name, "cfa")) continue;
            assert_int_equal(b->time_ps, baseline_of(&done, b->name)->time_ps);
            same++;
        }
        run_cache_destroy(cache);
        arena_destroy(a);
    }
    assert_int_equal(same, 48);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_omission_changes_a_result_beyond_its_class),
        cmocka_unit_test(a_changed_digit_is_seen),
        cmocka_unit_test(a_wrong_omission_is_seen),
        cmocka_unit_test(serial_codes_left_out_are_never_the_fastest),
        cmocka_unit_test(work_that_is_counted_is_the_work_that_is_done),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

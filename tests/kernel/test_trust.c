/* test_trust.c - whether an answer may be believed: residuals and conditions of all ranks, what is
 * tried next, what is told, and how far answers may be from references. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "base/arena.h"
#include "kernel/dynamics_program.h"
#include "kernel/references.h"
#include "kernel/trust.h"
#include "model/model.h"
#include "spec/field.h"

enum { RANKS = 3 };

/* A run of forward dynamics on three ranks whose outputs are given; NULL: it has none such. */
static struct program_run *make_run(const double *residual, const double *scale,
                                    const double *condition)
{
    struct program_run *r = arena_take(arena, sizeof *r);
    struct dynamics_run *own = arena_take(arena, sizeof *own);
    const double *given[] = {residual, scale, condition};
    const int output[] = {OUTPUT_RESIDUAL, OUTPUT_RESIDUAL_SCALE, OUTPUT_CONDITION};
    memset(r, 0, sizeof *r);
    memset(own, 0, sizeof *own);
    r->spec.nrank = RANKS;
    r->spec.kernel.refinement = REFINEMENT_AS_GIVEN;
    r->spec.model.nbody = 10;
    r->own = own;
    own->job.spec = &r->spec;
    program_want(r, OUTPUT_QDD, 1, arena);
    for (int i = 0; i < 3; i++) {
        if (given[i] == NULL) continue;
        program_want(r, output[i], RANKS, arena);
        memcpy(program_output(r, output[i]), given[i], RANKS * sizeof(double));
    }
    return r;
}

static void the_worst_rank_counts(void **state)
{
    (void)state;
    static const struct {
        double residual[RANKS], scale[RANKS], worst;
        bool scaled;
    } cases[] = {
        {{1e-9, 3e-9, 2e-9}, {0}, 3e-9, false},
        {{0, 0, 0}, {0}, 0, false},
        {{1e-9, NAN, 1}, {0}, NAN, false},
        /* 1e-9 x 10, 0.5 x 1e-12, 4e-9 x 5: the last, over the largest scale */
        {{1e-9, 0.5, 4e-9}, {10, 1e-12, 5}, 2e-9, true},
        {{1, 1, 1}, {0, 0, 0}, 0, true},
        {{1, 2, NAN}, {1, 1, 0}, NAN, true},
        {{1, 2, 3}, {1, NAN, 1}, NAN, true},
        {{1, INFINITY, 3}, {1, 1, 1}, INFINITY, true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct program_run *r =
            make_run(cases[i].residual, cases[i].scaled ? cases[i].scale : NULL, cases[i].residual);
        const double found = trust_residual(r);
        if (isnan(found) != isnan(cases[i].worst) ||
            (!isnan(found) && !(fabs(found - cases[i].worst) <= 1e-14 * cases[i].worst) &&
             found != cases[i].worst))
            fail_msg("case %zu: %g, not %g", i, found, cases[i].worst);
    }
    const double condition[] = {3, 1e5, 7}, wrong[] = {3, NAN, 7}, some[] = {1, 1, 1};
    assert_true(trust_condition(make_run(some, NULL, condition)) == 1e5);
    assert_true(isnan(trust_condition(make_run(some, NULL, wrong))));
    assert_true(trust_condition(make_run(some, NULL, NULL)) == 0);
}

/* Residual and condition of a run by its settings "key=value;..", its status, and what is told. */
static const struct {
    struct kernel_spec k;
    double residual, condition;
    const char *remedy; /* NULL: it may be believed */
} verdicts[] = {
    {{.formulation = FORMULATION_DIRECT}, 1e-4, 1, NULL},
    {{.formulation = FORMULATION_DIRECT}, 1.1e-4, 1, "kernel.inner_refinements: 1"},
    {{.formulation = FORMULATION_PAPER}, 2.9e-3, 1, NULL},
    {{.formulation = FORMULATION_PAPER}, 3.1e-3, 1, "kernel.formulation: direct"},
    {{.formulation = FORMULATION_DIRECT, .precision = PRECISION_FLOAT}, 0.1, 1, NULL},
    {{.formulation = FORMULATION_DIRECT, .precision = PRECISION_FLOAT},
     0.11,
     1,
     "kernel.inner_refinements: 1"},
    /* from 0.1 / eps on the last pivots have hardly a digit */
    {{.formulation = FORMULATION_DIRECT}, 0, 4.4e14, NULL},
    {{.formulation = FORMULATION_DIRECT}, 0, 4.6e14, "kernel.inner_refinements: 1"},
    {{.formulation = FORMULATION_DIRECT, .precision = PRECISION_FLOAT}, 0, 8e5, NULL},
    {{.formulation = FORMULATION_DIRECT, .precision = PRECISION_FLOAT},
     0,
     9e5,
     "kernel.inner_refinements"},
    {{.formulation = FORMULATION_DIRECT, .precision = PRECISION_QUAD}, 0, 1e30, NULL},
    {{.formulation = FORMULATION_DIRECT, .residual = RESIDUAL_TWICE}, 0, 1e30, NULL},
    {{.formulation = FORMULATION_DIRECT}, NAN, 1, "residual is no number"},
    {{.formulation = FORMULATION_DIRECT}, 0, NAN, "kernel.inner_refinements"},
    /* what has been tried is not named again */
    {{.formulation = FORMULATION_DIRECT, .inner_refinements = 1},
     1,
     1,
     "kernel.outer_refinements: 1"},
    {{.formulation = FORMULATION_DIRECT, .inner_refinements = 1, .outer_refinements = 1},
     1,
     1,
     "kernel.solver: cr"},
    {{.formulation = FORMULATION_DIRECT,
      .inner_refinements = 1,
      .outer_refinements = 1,
      .solver = SOLVER_CR},
     1,
     1,
     "kernel.residual: twice"},
    {{.formulation = FORMULATION_DIRECT,
      .inner_refinements = 1,
      .outer_refinements = 1,
      .solver = SOLVER_CR,
      .residual = RESIDUAL_TWICE},
     1,
     1,
     "more kernel.inner_refinements"},
    {{.formulation = FORMULATION_DIRECT, .solver = SOLVER_PCR}, 1, 1, "kernel.solver: cr"},
};

static void verdicts_name_a_remedy(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof verdicts / sizeof *verdicts; i++) {
        const double residual[] = {0, verdicts[i].residual, 0},
                     condition[] = {1, 1, verdicts[i].condition};
        struct program_run *r = make_run(residual, NULL, condition);
        struct run_result out = {.status = RUN_OK};
        r->spec.kernel = verdicts[i].k;
        r->spec.kernel.refinement = REFINEMENT_AS_GIVEN;
        struct model m = {.nbody = 10, .is_chain = true};
        dynamics_run_of(r)->job.model = &m;
        trust_check(r, &out);
        if (verdicts[i].remedy == NULL) {
            if (out.status != RUN_OK) fail_msg("case %zu: %s", i, out.text);
        } else {
            assert_int_equal(out.status, RUN_INVALID);
            if (strstr(out.text, verdicts[i].remedy) == NULL) fail_msg("case %zu: %s", i, out.text);
        }
        assert_true(isnan(verdicts[i].residual) ? isnan(out.residual)
                                                : out.residual == verdicts[i].residual);
    }
    /* inverse dynamics has no residual, and no verdict */
    struct program_run *r = make_run(NULL, NULL, NULL);
    struct run_result out = {.status = RUN_OK, .residual = 3};
    trust_check(r, &out);
    assert_true(isnan(out.residual) && out.status == RUN_OK);
}

/* A tree has inner refinements but in linearly implicit steps, no solver that could be changed, and
 * no residuals in twice the digits. */
static void remedies_of_trees(void **state)
{
    (void)state;
    static const struct {
        struct kernel_spec k;
        const char *remedy;
    } row[] = {
        {{.formulation = FORMULATION_PAPER}, "try kernel.formulation: direct"},
        {{.formulation = FORMULATION_DIRECT}, "try kernel.inner_refinements: 1"},
        {{.formulation = FORMULATION_DIRECT, .solver = SOLVER_PCR},
         "try kernel.inner_refinements: 1"},
        {{.formulation = FORMULATION_DIRECT, .steps = 1, .step = STEP_LINEARLY_IMPLICIT},
         "try kernel.outer_refinements: 1"},
        {{.formulation = FORMULATION_DIRECT, .steps = 1, .step = STEP_RK4},
         "try kernel.inner_refinements: 1"},
        {{.formulation = FORMULATION_DIRECT, .inner_refinements = 2},
         "try kernel.outer_refinements: 1"},
        {{.formulation = FORMULATION_DIRECT,
          .inner_refinements = 1,
          .outer_refinements = 1,
          .solver = SOLVER_PCR},
         "try a higher kernel.precision"},
        {{.formulation = FORMULATION_DIRECT, .refinement = REFINEMENT_AS_NEEDED},
         "try a higher kernel.precision"},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const double residual[] = {0, 1, 0}, condition[] = {1, 1, 1};
        struct program_run *r = make_run(residual, NULL, condition);
        struct run_result out = {.status = RUN_OK};
        const struct model m = {.nbody = 10};
        const enum refinement_rule rule = row[i].k.refinement;
        r->spec.kernel = row[i].k;
        r->spec.kernel.refinement = i == 7 ? rule : REFINEMENT_AS_GIVEN;
        r->spec.model.generator = MODEL_STAR;
        dynamics_run_of(r)->job.model = &m;
        trust_check(r, &out);
        assert_int_equal(out.status, RUN_INVALID);
        if (strstr(out.text, row[i].remedy) == NULL) fail_msg("case %zu: %s", i, out.text);
    }
}

/* The settings after each further attempt with a residual that is too much. */
struct course {
    int inner, outer;
    enum residual_rule residual;
};
static const struct {
    enum formulation formulation;
    bool chain, implicit;
    int n;
    struct course course[6];
} attempts[] = {
    {FORMULATION_DIRECT,
     true,
     false,
     4,
     {{1, 0, 0}, {1, 1, 0}, {4, 1, RESIDUAL_TWICE}, {20, 1, RESIDUAL_TWICE}}},
    {FORMULATION_PAPER, true, false, 3, {{1, 0, 0}, {1, 1, 0}, {1, 4, 0}}},
    {FORMULATION_DIRECT, false, false, 3, {{1, 0, 0}, {1, 1, 0}, {1, 4, 0}}},
    {FORMULATION_DIRECT, false, true, 2, {{0, 1, 0}, {0, 4, 0}}}, /* no inner ones there */
    {FORMULATION_DIRECT,
     true,
     true,
     4,
     {{1, 0, 0}, {1, 1, 0}, {4, 1, RESIDUAL_TWICE}, {20, 1, RESIDUAL_TWICE}}},
};

/* All of the model is computed. */
static const struct job_omit nothing;

static void refinements_are_tried_in_their_order(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof attempts / sizeof *attempts; i++) {
        struct run_spec spec = {.nrank = 2};
        const struct model m = {.nbody = 10, .is_chain = attempts[i].chain};
        const struct run_result poor = {.residual = 1}, good = {.residual = 1e-11},
                                none = {.residual = NAN};
        spec.kernel.formulation = attempts[i].formulation;
        spec.kernel.refinement = REFINEMENT_AS_NEEDED;
        spec.kernel.steps = attempts[i].implicit;
        spec.kernel.step = STEP_LINEARLY_IMPLICIT;
        spec.model.generator = attempts[i].chain ? MODEL_SERIAL_CHAIN : MODEL_COMB;
        for (int k = 0; k <= attempts[i].n; k++) {
            const struct run_spec before = spec;
            assert_false(trust_refine(&spec, &m, &nothing, &good));
            assert_memory_equal(&spec, &before, sizeof spec);
            const bool more = trust_refine(&spec, &m, &nothing, k % 2 ? &none : &poor);
            if (more != (k < attempts[i].n)) fail_msg("case %zu: %d attempts", i, k);
            if (!more) {
                assert_memory_equal(&spec, &before, sizeof spec);
                break;
            }
            const struct course *c = &attempts[i].course[k];
            if (spec.kernel.inner_refinements != c->inner ||
                spec.kernel.outer_refinements != c->outer || spec.kernel.residual != c->residual)
                fail_msg("case %zu attempt %d: %d inner, %d outer", i, k,
                         spec.kernel.inner_refinements, spec.kernel.outer_refinements);
        }
    }
}

static void settings_may_forbid_refinements(void **state)
{
    (void)state;
    struct run_spec spec = {.nrank = 2};
    const struct model chain = {.nbody = 10, .is_chain = true};
    const struct run_result poor = {.residual = 1};
    spec.kernel.formulation = FORMULATION_DIRECT;
    spec.kernel.refinement = REFINEMENT_AS_GIVEN;
    assert_false(trust_refine(&spec, &chain, &nothing, &poor));
    spec.kernel.refinement = REFINEMENT_AS_NEEDED;
    spec.kernel.solver = SOLVER_PCR; /* keeps no factors */
    assert_false(trust_refine(&spec, &chain, &nothing, &poor));
    spec.model.generator = MODEL_STAR; /* but trees use no solver */
    const struct model star = {.nbody = 10};
    assert_true(trust_refine(&spec, &star, &nothing, &poor));
    /* more than was asked for is kept */
    spec = (struct run_spec){.nrank = 2};
    spec.kernel.formulation = FORMULATION_DIRECT;
    spec.kernel.inner_refinements = 7, spec.kernel.outer_refinements = 2;
    assert_true(trust_refine(&spec, &chain, &nothing, &poor));
    assert_int_equal(spec.kernel.inner_refinements, 7);
    assert_int_equal(spec.kernel.residual, RESIDUAL_TWICE);
    assert_true(trust_refine(&spec, &chain, &nothing, &poor));
    assert_int_equal(spec.kernel.inner_refinements, 20);
    assert_false(trust_refine(&spec, &chain, &nothing, &poor));
    /* residuals in twice the digits need no outer refinement */
    spec.kernel.inner_refinements = 4, spec.kernel.outer_refinements = 0;
    assert_true(trust_refine(&spec, &chain, &nothing, &poor));
    assert_true(spec.kernel.inner_refinements == 20 && spec.kernel.outer_refinements == 0);
}

/* n^2 beyond a hundred bodies (forces: n), the digits of the precision, and no trust above 1e-2. */
static void tolerances_grow_with_the_bodies(void **state)
{
    (void)state;
    static const struct {
        enum formulation formulation;
        enum precision precision;
        int n;
        double forward, inverse;
    } cases[] = {
        {FORMULATION_DIRECT, PRECISION_DOUBLE, 1, 1e-10, 1e-11},
        {FORMULATION_DIRECT, PRECISION_DOUBLE, 100, 1e-10, 1e-11},
        {FORMULATION_DIRECT, PRECISION_DOUBLE, 1000, 1e-8, 1e-10},
        {FORMULATION_PAPER, PRECISION_DOUBLE, 100, 1e-8, 1e-11},
        {FORMULATION_PAPER, PRECISION_DOUBLE, 1000, 1e-6, 1e-10},
        {FORMULATION_PAPER, PRECISION_DOUBLE, 10000000, 1e-2, 1e-6},
        {FORMULATION_PAPER, PRECISION_FLOAT, 10, 1e-2, 0x1p29 * 1e-11},
        {FORMULATION_DIRECT, PRECISION_QUAD, 10, 1e-10, 1e-11},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct kernel_spec k = {.formulation = cases[i].formulation,
                                      .precision = cases[i].precision};
        const double forward = references_tolerance(&k, cases[i].n),
                     inverse = references_tolerance_inverse(&k, cases[i].n);
        if (!(fabs(forward / cases[i].forward - 1) < 1e-12) ||
            !(fabs(inverse / cases[i].inverse - 1) < 1e-12))
            fail_msg("case %zu: %g %g", i, forward, inverse);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_worst_rank_counts),
        cmocka_unit_test(verdicts_name_a_remedy),
        cmocka_unit_test(remedies_of_trees),
        cmocka_unit_test(refinements_are_tried_in_their_order),
        cmocka_unit_test(settings_may_forbid_refinements),
        cmocka_unit_test(tolerances_grow_with_the_bodies),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}

/* test_explain_search.c - searches for the smallest change on claims made by hand, whose answers
 * follow by arithmetic; variants and grades. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "app/explain_search.h"
#include "base/random.h"

/* ---- a world of points that are judged by formulas: in the place of explain_points.c */

enum { AXES = 3, MOST_POINTS = 20000 };

/* Claim i holds where weight[i] . u >= bound[i]; its margin is the difference. */
struct world {
    struct explain_subject subject;
    struct explain_space space;
    struct claim_rule rule[2];
    double weight[2][AXES], bound[2];
    bool told;    /* margins are told */
    double ridge; /* > 0: claim 0 holds within so far of its bound alone */
    int n, batches;
    struct explain_point *point[MOST_POINTS];
};

static struct world world;

/* Everything that a search may look at is what explain_make was asked for. */
const struct explain_point *explain_known(const struct explain_subject *s, enum operators operators,
                                          const double *u)
{
    assert_ptr_equal(s, &world.subject);
    for (int i = 0; i < world.n; i++)
        if (world.point[i]->operators == operators &&
            memcmp(world.point[i]->u, u, AXES * sizeof *u) == 0)
            return world.point[i];
    return NULL;
}

static double margin_of(int i, const double *u)
{
    double sum = -world.bound[i];
    for (int k = 0; k < AXES; k++) sum += world.weight[i][k] * u[k];
    return world.ridge > 0 && i == 0 ? world.ridge - fabs(sum) : sum;
}

bool explain_make(struct explain_bench *b, const struct explain_request *request, int n)
{
    assert_true(n <= 512);
    world.batches += n > 0;
    for (int i = 0; i < n; i++) {
        const struct explain_request *q = &request[i];
        double snapped[EXPLAIN_MOST_AXES];
        memcpy(snapped, q->u, sizeof snapped);
        explain_space_snap(&world.space, snapped);
        for (int k = 0; k < AXES; k++) {
            /* what is asked for lies in the box, on values that can be printed */
            assert_true(fabs(q->u[k] - snapped[k]) < 0.006);
            assert_true(q->u[k] >= world.space.axis[k].least - 0.006);
            assert_true(q->u[k] <= world.space.axis[k].most + 0.006);
        }
        assert_null(explain_known(q->subject, q->operators, q->u)); /* and never twice */
        assert_true(world.n < MOST_POINTS);
        struct explain_point *p = TAKE(arena, 1, struct explain_point);
        p->operators = q->operators;
        memcpy(p->u, q->u, sizeof p->u);
        p->nverdict = world.subject.nrule;
        p->verdict = TAKE(arena, p->nverdict, struct explain_verdict);
        for (int k = 0; k < p->nverdict; k++) {
            const double margin = margin_of(k, q->u);
            p->verdict[k] = (struct explain_verdict){.rule = k,
                                                     .variant = world.rule[k].designated,
                                                     .value = 10 * margin,
                                                     .margin = world.told ? margin : NAN,
                                                     .holds = margin >= 0,
                                                     .told = true};
        }
        world.point[world.n++] = p;
        b->made++;
    }
    return true;
}

/* Three rates that may change by a factor of ten either way. */
static void make_world(int nrule)
{
    memset(&world, 0, sizeof world);
    world.told = true;
    world.space = (struct explain_space){.machine = "hand", .n = AXES};
    for (int k = 0; k < AXES; k++) {
        struct explain_axis *x = &world.space.axis[k];
        x->words = "it is", x->after = "", x->map = EXPLAIN_FACTOR, x->nkey = 1;
        x->nominal[0] = 50e6, x->least = -2.3026, x->most = 2.3026;
    }
    world.subject = (struct explain_subject){.name = "C", .nrule = nrule, .space = world.space};
    for (int i = 0; i < nrule; i++) {
        world.rule[i].designated = "structured";
        world.subject.rule[i] = &world.rule[i];
    }
}

static struct explain_search begin(uint64_t seed)
{
    return (struct explain_search){
        .goal = {.subject = &world.subject, .own = true, .seed = seed, .starts = 4, .steps = 60}};
}

static void search(struct explain_search *s, int n)
{
    static const struct common quiet = {.quiet = true};
    struct err e;
    err_clear(&e);
    struct explain_bench b = {.common = &quiet, .arena = arena, .e = &e};
    assert_true(explain_search_all(&b, s, n));
    for (int i = 0; i < n; i++) assert_true(s[i].done);
}

/* What a search says of its best point is so. */
static void sound(const struct explain_search *s)
{
    const double *u = s->best.u;
    bool holds = true;
    double sum = 0;
    for (int i = 0; i < world.subject.nrule; i++) holds = holds && margin_of(i, u) >= 0;
    for (int k = 0; k < AXES; k++) sum += fabs(u[k]);
    assert_true(s->best.any);
    assert_true(s->best.grade.holds == holds);
    assert_true(fabs(s->best.grade.distance - sum) < 1e-12);
}

/* ---- tests of searches */

/* Of all u with w . u >= c the one with the least sum |u| changes the heaviest axis alone. */
static void the_smallest_change_is_along_the_heaviest_axis(void **state)
{
    (void)state;
    struct random r = random_make(31, 0, 0);
    for (int round = 0; round < 12; round++) {
        make_world(1);
        double heaviest = 0;
        int axis = 0;
        for (int k = 0; k < AXES; k++) {
            world.weight[0][k] = random_uniform(&r, -1, 1);
            if (fabs(world.weight[0][k]) > heaviest) heaviest = fabs(world.weight[0][k]), axis = k;
        }
        world.bound[0] = random_uniform(&r, 0.1, 2) * heaviest;
        const double least = world.bound[0] / heaviest;
        struct explain_search s = begin(5);
        search(&s, 1);
        sound(&s);
        assert_true(s.best.grade.holds);
        assert_true(s.best.grade.distance >= least - 0.006);
        assert_true(s.best.grade.distance <= 1.02 * least + 0.04);
        /* one axis alone does as well, and which one is known */
        assert_true(s.single.any && s.single.grade.holds);
        assert_true(s.single.u[axis] != 0);
        for (int k = 0; k < AXES; k++) {
            assert_true(k == axis || s.single.u[k] == 0);
            const double end = 2.3026 * fabs(world.weight[0][k]);
            assert_true(fabs(s.swing[k] - end) < 0.01 && fabs(s.gain[k] - end) < 0.01);
            assert_true(s.end[k] * world.weight[0][k] > 0);
        }
        assert_true(fabs(s.nominal + world.bound[0]) < 1e-12);
    }
}

/* Two claims of which each needs its own axis: no axis alone will do, both together do. */
static void claims_together_need_both_changes(void **state)
{
    (void)state;
    static const double bound[][2] = {{0.5, 1}, {1.5, 0.25}, {2, 2}};
    for (size_t i = 0; i < sizeof bound / sizeof *bound; i++) {
        make_world(2);
        world.weight[0][0] = 1, world.weight[1][2] = -1;
        world.bound[0] = bound[i][0], world.bound[1] = bound[i][1];
        struct explain_search s = begin(7);
        search(&s, 1);
        sound(&s);
        const double least = bound[i][0] + bound[i][1];
        assert_true(s.best.grade.holds && !s.single.any);
        assert_true(s.best.grade.distance >= least - 0.01);
        assert_true(s.best.grade.distance <= 1.03 * least + 0.06);
        assert_true(s.best.u[0] > 0 && s.best.u[2] < 0 && s.best.u[1] == 0);
    }
}

static void what_holds_as_it_is_needs_no_change(void **state)
{
    (void)state;
    make_world(1);
    world.weight[0][1] = 1, world.bound[0] = -0.2;
    struct explain_search s = begin(1);
    search(&s, 1);
    sound(&s);
    assert_true(s.best.grade.holds && s.best.grade.distance == 0);
    assert_true(s.nominal == 0.2);
}

/* The margin cannot become 0 within the box: the nearest point to it is a corner. */
static void what_holds_nowhere_ends_at_the_best_margin(void **state)
{
    (void)state;
    make_world(1);
    world.weight[0][0] = 1, world.weight[0][1] = -1, world.bound[0] = 10;
    struct explain_search s = begin(1);
    search(&s, 1);
    sound(&s);
    assert_false(s.best.grade.holds);
    assert_false(s.single.any);
    assert_true(s.best.grade.margin > 4.605 - 10 - 0.3 && s.best.grade.margin <= 4.61 - 10 + 0.02);
    /* nothing changes anything: the nominal point is as good as any */
    make_world(1);
    world.bound[0] = 1;
    s = begin(1);
    search(&s, 1);
    assert_false(s.best.grade.holds);
    assert_true(s.best.grade.margin == -1);
    for (int k = 0; k < AXES; k++) assert_true(s.gain[k] == 0 && s.swing[k] == 0);
}

/* Without margins there is nothing to climb; the search ends all the same, and finds what an axis
 * alone does. */
static void margins_that_are_not_told_end_a_search(void **state)
{
    (void)state;
    make_world(1);
    world.told = false;
    world.weight[0][0] = 1, world.bound[0] = 1;
    struct explain_search s = begin(1);
    search(&s, 1);
    sound(&s);
    assert_true(s.best.grade.holds && fabs(s.best.grade.distance - 1) < 0.03);
    assert_true(isnan(s.nominal));
}

/* A claim with two bounds holds in a narrow band, and fails at the end of the axis. */
static void a_band_between_nothing_and_the_end_is_found(void **state)
{
    (void)state;
    static const double at[] = {0.3, 0.7, 1.1, 1.9};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        make_world(1);
        world.weight[0][1] = -1, world.bound[0] = at[i], world.ridge = 0.1;
        struct explain_search s = begin(3);
        search(&s, 1);
        sound(&s);
        if (!s.best.grade.holds) fail_msg("nothing at %g", at[i]);
        assert_true(s.best.u[1] < 0);
        assert_true(fabs(s.best.grade.distance - (at[i] - 0.1)) < 0.05);
        /* by this axis alone, where it begins to hold; what lies in the outer half is passed over
         * where the margin at the end is the better one, and found by the simplex */
        if (at[i] > 1.5) continue;
        assert_true(s.single.any && s.single.grade.holds);
        assert_true(fabs(s.single.u[1] + at[i] - 0.1) < 0.05);
    }
}

/* A simplex of one step from a start that changes too much: what is not needed goes. */
static void changes_that_are_not_needed_are_taken_back(void **state)
{
    (void)state;
    make_world(2);
    world.weight[0][0] = 1, world.weight[1][2] = -1;
    world.bound[0] = 0.5, world.bound[1] = 1;
    struct explain_search s = begin(7);
    s.goal.starts = s.goal.nfrom = s.goal.steps = 1;
    s.goal.from[0][0] = 2, s.goal.from[0][1] = 1.5, s.goal.from[0][2] = -2.2;
    search(&s, 1);
    sound(&s);
    assert_true(s.best.grade.holds && s.best.u[1] == 0);
    assert_true(s.best.grade.distance >= 1.49 && s.best.grade.distance <= 1.56);
    /* three axes that do the same, of which one alone is not enough */
    make_world(1);
    for (int k = 0; k < AXES; k++) world.weight[0][k] = 1;
    world.bound[0] = 3;
    s = begin(7);
    s.goal.starts = s.goal.nfrom = s.goal.steps = 1;
    for (int k = 0; k < AXES; k++) s.goal.from[0][k] = 1.2;
    search(&s, 1);
    sound(&s);
    assert_true(s.best.grade.holds && s.best.grade.distance < 3.05);
}

/* An axis that is slow to simulate is tried in thirds beside the best of the others. */
static void dear_axes_are_tried_beside_the_best_of_the_others(void **state)
{
    (void)state;
    make_world(2);
    world.space.axis[2].dear = world.subject.space.axis[2].dear = true;
    world.weight[0][0] = 1, world.weight[1][2] = 1;
    world.bound[0] = 1, world.bound[1] = 0.7;
    struct explain_search s = begin(7);
    search(&s, 1);
    sound(&s);
    assert_true(s.best.grade.holds);
    assert_true(fabs(s.best.grade.distance - 1.7) < 0.06);
    int values = 0; /* of the dear axis in points that change another one, too */
    for (int i = 0; i < world.n; i++)
        values += world.point[i]->u[2] != 0 && world.point[i]->u[0] != 0;
    assert_in_range(values, 3, 60);
}

static bool same(const struct explain_best *a, const struct explain_best *b)
{
    return a->any == b->any && memcmp(a->u, b->u, sizeof a->u) == 0 &&
           a->grade.holds == b->grade.holds && a->grade.margin == b->grade.margin;
}

/* Begun anew with all points known it makes none and answers the same; so it does beside others. */
static void searches_depend_on_their_points_alone(void **state)
{
    (void)state;
    make_world(2);
    for (int k = 0; k < AXES; k++) world.weight[0][k] = 0.3 + 0.2 * k, world.weight[1][k] = 1 - k;
    world.bound[0] = 0.8, world.bound[1] = 0.6;
    struct explain_search first = begin(11), again = begin(11);
    search(&first, 1);
    sound(&first);
    const int made = world.n;
    search(&again, 1);
    assert_int_equal(world.n, made);
    assert_true(same(&first.best, &again.best) && same(&first.single, &again.single));
    /* side by side, from nothing */
    for (int order = 0; order < 2; order++) {
        world.n = 0;
        struct explain_search both[2] = {begin(order ? 11 : 12), begin(order ? 12 : 11)};
        search(both, 2);
        assert_true(same(&first.best, &both[order ? 0 : 1].best));
    }
}

/* Operators that are not the claim's own count as a factor of 2; points of theirs are others. */
static void other_operators_cost_a_factor_of_two(void **state)
{
    (void)state;
    make_world(1);
    world.weight[0][0] = 1, world.bound[0] = 1;
    struct explain_search s = begin(1);
    s.goal.operators = OPERATORS_DENSE;
    world.rule[0].designated = "dense";
    search(&s, 1);
    sound(&s); /* dense is its own */
    const struct explain_goal other = {
        .subject = &world.subject, .own = true, .operators = OPERATORS_STRUCTURED};
    const double u[EXPLAIN_MOST_AXES] = {1};
    struct explain_verdict v = {
        .rule = 0, .variant = "structured", .value = 3, .margin = 0.5, .holds = true, .told = true};
    const struct explain_point p = {.nverdict = 1, .verdict = &v};
    const struct explain_grade g = explain_grade_point(&other, &p, u);
    assert_true(g.holds && g.margin == 0.5 && g.value == 3 && g.rule == 0 && g.baseline == NULL);
    assert_true(fabs(g.distance - (1 + log(2))) < 1e-12);
    v.told = false; /* what cannot be told does not hold */
    assert_false(explain_grade_point(&other, &p, u).holds);
    v.told = true, v.variant = "dense"; /* what was not judged does not either */
    assert_false(explain_grade_point(&other, &p, u).holds);
    assert_true(isnan(explain_grade_point(&other, &p, u).margin));
}

/* ---- grades and words */

/* Two claims, one that names a baseline: the worst counts, and the best baseline. */
static void the_worst_claim_with_the_best_baseline_counts(void **state)
{
    (void)state;
    struct claim_rule rule[2] = {{.designated = "rnea+aba, structured"}, {.designated = "any"}};
    struct explain_subject subject = {.nrule = 2, .rule = {&rule[0], &rule[1]}};
    struct explain_goal g = {.subject = &subject, .own = false};
    struct explain_verdict v[] = {
        {0, "rnea+aba, structured", 1, -0.4, false, true},
        {0, "fastest serial, structured", 2, -0.1, false, true},
        {0, "rnea+crba, structured", 3, 0.2, true, true},
        {0, "rnea+cfa-paper, structured", 3, 0.9, true, true},
        {1, "any", 4, 0.3, true, true},
    };
    const double u[EXPLAIN_MOST_AXES] = {0};
    const struct explain_point p = {.nverdict = 5, .verdict = v};
    struct explain_grade grade = explain_grade_point(&g, &p, u);
    assert_true(grade.holds && grade.baseline != NULL);
    assert_string_equal(grade.baseline, "rnea+crba"); /* the first of those that are as near */
    assert_true(fabs(grade.distance - log(2)) < 1e-12);
    assert_true(grade.rule == 0 && grade.margin == 0.2 && grade.value == 3);
    g.own = true; /* its own baseline alone */
    grade = explain_grade_point(&g, &p, u);
    assert_true(!grade.holds && grade.baseline == NULL && grade.margin == -0.4);
    assert_true(grade.distance == 0 && grade.value == 1);
    g.own = false, v[0].holds = true, v[0].margin = 0.01; /* what holds unchanged goes first */
    grade = explain_grade_point(&g, &p, u);
    assert_true(grade.holds && grade.baseline == NULL && grade.distance == 0);
    v[4].holds = false, v[4].margin = -2; /* the other claim fails with any of them */
    grade = explain_grade_point(&g, &p, u);
    assert_true(!grade.holds && grade.rule == 1 && grade.margin == -2 && grade.baseline == NULL);
}

/* A strict order in which whatever holds comes first and an unknown margin last. */
static void better_is_an_order(void **state)
{
    (void)state;
    struct random r = random_make(9, 1, 2);
    struct explain_grade x[3];
    for (int round = 0; round < 4000; round++) {
        for (int i = 0; i < 3; i++) {
            x[i] = (struct explain_grade){.holds = random_below(&r, 2),
                                          .distance = (double)random_below(&r, 3),
                                          .margin = (double)random_below(&r, 3) - 1};
            if (random_below(&r, 4) == 0) x[i].margin = NAN;
        }
        assert_false(explain_better(&x[0], &x[0]));
        assert_false(explain_better(&x[0], &x[1]) && explain_better(&x[1], &x[0]));
        if (explain_better(&x[0], &x[1]) && explain_better(&x[1], &x[2]))
            assert_true(explain_better(&x[0], &x[2]));
        if (x[0].holds && !x[1].holds) assert_true(explain_better(&x[0], &x[1]));
        if (x[0].holds && x[1].holds)
            assert_true(explain_better(&x[0], &x[1]) == (x[0].distance < x[1].distance));
        if (!x[0].holds && !x[1].holds && isnan(x[1].margin))
            assert_true(explain_better(&x[0], &x[1]) == !isnan(x[0].margin));
    }
}

static void variants_have_their_words_exchanged(void **state)
{
    static const struct {
        const char *designated, *baseline; /* that it names */
        int own;                           /* 1 structured, 2 dense, 3 both */
        const char *with, *of_crba;        /* dense, its own; structured, rnea+crba */
    } row[] = {
        {"fastest serial, structured", "fastest serial", 1, "fastest serial, dense",
         "rnea+crba, structured"},
        {"fastest serial", "fastest serial", 3, "fastest serial", "rnea+crba"},
        {"rnea+aba, dense", "rnea+aba", 2, "rnea+aba, dense", "rnea+crba, structured"},
        {"rnea+cfa-paper, n = 64, dense", "rnea+cfa-paper", 2, "rnea+cfa-paper, n = 64, dense",
         "rnea+crba, n = 64, structured"},
        {"rnea+cfa-direct structured", "rnea+cfa-direct", 1, "rnea+cfa-direct dense",
         "rnea+crba structured"},
        {"parallel code on one processor", "parallel code on one processor", 3,
         "parallel code on one processor", "rnea+crba"},
        {"dense", NULL, 2, "dense", "structured"},
        {"n = 64, structured", NULL, 1, "n = 64, dense", "n = 64, structured"},
        {"rnea+abacus", NULL, 3, "rnea+abacus", "rnea+abacus"},
        {"dense n", NULL, 3, "dense n", "dense n"},
        {"", NULL, 3, "", ""},
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const struct claim_rule rule = {.designated = row[i].designated};
        const char *const found = explain_baseline_of(&rule);
        if (row[i].baseline == NULL) assert_null(found);
        else assert_string_equal(found, row[i].baseline);
        assert_true(explain_own_operators(&rule, OPERATORS_STRUCTURED) == (row[i].own & 1));
        assert_true(explain_own_operators(&rule, OPERATORS_DENSE) == (row[i].own >> 1));
        struct text a = {0}, b = {0};
        text_add(&a, "%s", ""), text_add(&b, "%s", "");
        explain_variant(&rule, NULL, OPERATORS_DENSE, &a);
        explain_variant(&rule, "rnea+crba", OPERATORS_STRUCTURED, &b);
        assert_string_equal(a.s, row[i].with);
        assert_string_equal(b.s, row[i].of_crba);
        text_free(&a), text_free(&b);
    }
    for (int i = 0; i < EXPLAIN_BASELINES; i++) {
        const struct claim_rule rule = {.designated = explain_baseline(i)};
        assert_ptr_equal(explain_baseline_of(&rule), explain_baseline(i));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_smallest_change_is_along_the_heaviest_axis),
        cmocka_unit_test(claims_together_need_both_changes),
        cmocka_unit_test(what_holds_as_it_is_needs_no_change),
        cmocka_unit_test(what_holds_nowhere_ends_at_the_best_margin),
        cmocka_unit_test(margins_that_are_not_told_end_a_search),
        cmocka_unit_test(a_band_between_nothing_and_the_end_is_found),
        cmocka_unit_test(changes_that_are_not_needed_are_taken_back),
        cmocka_unit_test(dear_axes_are_tried_beside_the_best_of_the_others),
        cmocka_unit_test(searches_depend_on_their_points_alone),
        cmocka_unit_test(other_operators_cost_a_factor_of_two),
        cmocka_unit_test(the_worst_claim_with_the_best_baseline_counts),
        cmocka_unit_test(better_is_an_order),
        cmocka_unit_test(variants_have_their_words_exchanged),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}

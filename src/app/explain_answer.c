/* explain_answer.c - confirming, sentences, maps; see explain_answer.h.
 *
 * An answer is a sentence that a reader of the paper can check: which parameter, which value,
 * how far from nominal, and whether the published range contains it. */
#include "app/explain_answer.h"

#include <math.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"
#include "base/units.h"

/* --- confirming ------------------------------------------------------------------------------- */

/* The answer tried with the runs of the study: `asked` is false when the claim names no command. */
struct confirmed {
    bool asked, agrees; /* agrees: the study's own runs say that it holds */
    int nrun;
};

/* The study's own runs at the answer. A search uses fewer points than the study, so its boundary
 * may lie a little beside: where the study says no, move away from the nominal point by 2 % at a
 * time. */
static bool confirm(struct explain_bench *b, struct explain_search *s, struct confirmed *c)
{
    /* up to 12 % further */
    enum { MOVES = 6 };
    double u[EXPLAIN_MOST_AXES];
    *c = (struct confirmed){0};
    for (int k = 0; !c->agrees && k <= MOVES; k++) {
        struct explain_point p;
        for (int i = 0; i < EXPLAIN_MOST_AXES; i++) u[i] = s->best.u[i] * (1 + 0.02 * k);
        explain_space_snap(&s->goal.subject->space, u);
        if (!explain_confirm(b, s->goal.subject, s->goal.operators, u, &p, &c->nrun)) return false;
        /* No runs: there is nothing to confirm with. */
        if (c->nrun == 0) return true;
        c->asked = true;
        struct explain_grade g = explain_grade_point(&s->goal, &p, u);
        c->agrees = g.holds;
        /* The confirmed point is the answer. */
        if (g.holds) {
            s->best.grade = g;
            memcpy(s->best.u, u, sizeof u);
        }
    }
    return true;
}

/* --- sentences -------------------------------------------------------------------------------- */

/* How many parameters differ from their nominal values. */
static int changes(const struct explain_search *s, const double *u)
{
    int n = 0;
    for (int i = 0; i < s->goal.subject->space.n; i++) n += u[i] != 0;
    return n;
}

/* "the code runs at 20 Mflop/s, ... and ...": the changes in words. */
static void add_changes(const struct explain_search *s, const double *u, bool brief, struct text *t)
{
    const struct explain_space *space = &s->goal.subject->space;
    int n = changes(s, u), told = 0;
    for (int i = 0; i < space->n; i++) {
        if (u[i] == 0) continue;
        text_add(t, "%s", told == 0 ? "" : told == n - 1 ? " and " : ", ");
        explain_space_phrase(space, u, i, brief, t);
        told++;
    }
    if (n == 0) text_add(t, "nothing else is changed");
}

/* The value of the claim at the answer, in its own unit. */
static void add_value(const struct explain_search *s, struct text *t)
{
    const struct claim_rule *rule = s->goal.subject->rule[s->best.grade.rule];
    if (isnan(s->best.grade.value)) text_add(t, "no value");
    else text_add(t, "%.4g", s->best.grade.value);
    text_add(t, " (%s)", rule->unit);
}

/* "in all, a factor of 6.1": of a single change its own factor says it. */
static void add_total(const struct explain_search *s, struct text *t)
{
    double factor = exp(explain_space_distance(&s->goal.subject->space, s->best.u));
    if (changes(s, s->best.u) > 1) text_add(t, ", all factors together %.3g", factor);
}

/* What one parameter can do alone, where the answer needs several. */
static void add_single(const struct explain_search *s, struct text *t)
{
    if (changes(s, s->best.u) < 2) return;
    if (!s->single.any) {
        text_add(t, " Within the search space no single parameter is sufficient.");
        return;
    }
    text_add(t, " One parameter is sufficient if ");
    add_changes(s, s->single.u, false, t);
    text_add(t, ".");
}

/* A claim for which a point was found. */
static void add_holds(const struct explain_search *s, const char *variant,
                      const struct confirmed *c, struct text *t)
{
    text_add(t, "%s holds for '%s' if ", s->goal.subject->name, variant);
    add_changes(s, s->best.u, !s->best.grade.holds, t);
    add_total(s, t);
    text_add(t, "; it then has ");
    add_value(s, t);
    if (c->asked && c->agrees) text_add(t, ", which %d full runs at that point confirm", c->nrun);
    else if (c->asked) text_add(t, ", but %d full runs at that point contradict this", c->nrun);
    text_add(t, ".");
    add_single(s, t);
}

/* How thorough the search was: what not finding means depends on it. */
static void add_tried(const struct explain_search *s, struct text *t)
{
    text_add(t, "%d points", s->goal.subject->npoint);
    if (s->goal.starts)
        text_add(t, " (each parameter alone to the ends of its range, and a simplex search from "
                    "several starts)");
}

/* A claim without such a point: the nearest one, and that this is no proof. */
static void add_not_found(const struct explain_search *s, const char *variant, struct text *t)
{
    text_add(t, "%s: no point was found at which it holds, among ", s->goal.subject->name);
    add_tried(s, t);
    text_add(t, "; this search is not a proof. The nearest, for '%s', has ", variant);
    add_value(s, t);
    text_add(t, ", if ");
    add_changes(s, s->best.u, !s->best.grade.holds, t);
    text_add(t, ".");
}

/* A claim with a proof that it cannot hold. The search tries to refute the proof. */
static void add_never(const struct explain_search *s, const char *never, struct text *t)
{
    text_add(t, "%s cannot hold for any values of the parameters: %s. ", s->goal.subject->name,
             never);
    if (s->best.grade.holds)
        text_add(t, "But it holds, if "), add_changes(s, s->best.u, !s->best.grade.holds, t),
            text_add(t, ": the reason is wrong.");
    else text_add(t, "None of %d points contradicts this.", s->goal.subject->npoint);
}

/* --- rows ------------------------------------------------------------------------------------- */

/* One row of table explain_answer, with the sentence as it will be printed. */
static bool keep(struct explain_bench *b, const struct explain_search *s, const char *goal,
                 const char *verdict, const char *variant, const struct confirmed *c,
                 const char *sentence)
{
    static const char *const name[] = {"subject",   "goal",     "verdict", "variant", "operators",
                                       "settings",  "distance", "value",   "margin",  "points",
                                       "confirmed", "study",    "sentence"};
    struct text settings = {0};
    const struct explain_grade *g = &s->best.grade;
    explain_space_settings(&s->goal.subject->space, s->best.u, &settings);
    const struct store_value value[] = {
        store_text(s->goal.subject->name),
        store_text(goal),
        store_text(verdict),
        store_text(variant),
        store_text(s->goal.operators == OPERATORS_DENSE ? "dense" : "structured"),
        store_text(settings.s ? settings.s : ""),
        /* NULL: no distance of something that was not found */
        g->holds ? store_real(g->distance) : store_null(),
        store_real(g->value),
        store_real(g->margin),
        store_int(s->goal.subject->npoint),
        c->asked ? store_int(c->agrees) : store_null(),
        c->asked ? store_int(c->nrun) : store_null(),
        store_text(sentence)};
    bool ok = store_insert(b->store, "explain_answer", 13, name, value, b->e);
    text_free(&settings);
    return ok;
}

/* goal: "own" or "any" (baseline and operators). */
bool explain_answer(struct explain_bench *b, struct explain_search *s, const char *goal,
                    const char *never)
{
    struct confirmed c = {0};
    struct text variant = {0}, sentence = {0};
    bool ok = !s->best.grade.holds || confirm(b, s, &c);
    explain_variant(s->goal.subject->rule[0], s->best.grade.baseline, s->goal.operators, &variant);
    if (never) add_never(s, never, &sentence);
    else if (s->best.grade.holds) add_holds(s, variant.s, &c, &sentence);
    else add_not_found(s, variant.s, &sentence);
    /* A point that holds refutes the proof, so `holds` wins. */
    const char *verdict = s->best.grade.holds ? "holds" : never ? "never" : "not found";
    ok = ok && keep(b, s, goal, verdict, variant.s, &c, sentence.s);
    text_free(&variant);
    text_free(&sentence);
    return ok;
}

/* "C1, C2 and C7" */
static void add_ids(const struct explain_subject *s, struct text *t)
{
    for (int i = 0; i < s->nrule; i++)
        text_add(t, "%s%s", i == 0 ? "" : i == s->nrule - 1 ? " and " : ", ", s->rule[i]->id);
}

/* All claims that can hold alone, at one point. `without`: those that cannot. */
bool explain_answer_together(struct explain_bench *b, struct explain_search *s, const char *without)
{
    struct confirmed c = {0};
    struct text t = {0}, variant = {0};
    if (without)
        text_add(&t, "No point was found at which all claims hold, as there is none for %s alone. ",
                 without);
    /* No claim can hold alone: there is nothing to ask for together. */
    if (!s) {
        text_free(&t);
        return true;
    }
    bool ok = !s->best.grade.holds || confirm(b, s, &c);
    /* The variant in words: baseline and operators. */
    const char *baseline = s->best.grade.baseline;
    text_add(&variant, "%s%s", baseline ? baseline : "fastest serial",
             s->goal.operators == OPERATORS_DENSE ? ", dense" : ", structured");
    text_add(&t, without ? "The others, " : "All, ");
    add_ids(s->goal.subject, &t);
    /* Where they hold together, and whether the study confirms it. */
    if (s->best.grade.holds) {
        text_add(&t, ", hold together for '%s' if ", variant.s);
        add_changes(s, s->best.u, !s->best.grade.holds, &t);
        add_total(s, &t);
        if (c.asked)
            text_add(&t,
                     c.agrees ? ", which %d full runs at that point confirm"
                              : ", but %d full runs at that point contradict this",
                     c.nrun);
    } else {
        text_add(&t, ", were not found to hold together at any of %d points; at the nearest, for "
                     "'%s', %s fails with ",
                 s->goal.subject->npoint, variant.s, s->goal.subject->rule[s->best.grade.rule]->id);
        add_value(s, &t);
        text_add(&t, ", if ");
        add_changes(s, s->best.u, !s->best.grade.holds, &t);
    }
    text_add(&t, ".");
    ok = ok && keep(b, s, "any", s->best.grade.holds ? "holds" : "not found", variant.s, &c, t.s);
    text_free(&t);
    text_free(&variant);
    return ok;
}

/* --- maps ------------------------------------------------------------------------------------- */

/* The two axes of a map: those that change most in the answer, then those that bring the claim
 * nearest alone. */
static void two_axes(const struct explain_search *s, int axis[2])
{
    int n = s->goal.subject->space.n;
    axis[0] = axis[1] = -1;
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < n; i++) {
            int w = axis[k];
            if (k == 1 && i == axis[0]) continue;
            bool more = w < 0 || fabs(s->best.u[i]) > fabs(s->best.u[w]) ||
                        (fabs(s->best.u[i]) == fabs(s->best.u[w]) && s->gain[i] > s->gain[w]);
            if (more) axis[k] = i;
        }
}

/* A number of an axis as the map has it: a factor, or the value itself where the nominal value
 * is 0. */
static double shown(const struct explain_space *space, const double *u, int i)
{
    /* axes that go both ways are factors */
    bool factor = space->axis[i].least < 0;
    return factor ? exp(u[i]) : explain_space_value(space, u, i, 0);
}

/* "node.flop_rate over nominal (55 Mflop/s)": without commas, at which a cell of a CSV ends for
 * gnuplot. */
static void axis_label(const struct explain_space *space, int i, struct text *t)
{
    const struct explain_axis *a = &space->axis[i];
    char number[64];
    units_print(a->nominal[0], a->field[0]->unit, number, sizeof number);
    text_add(t, "%s", a->key[0]);
    if (a->map == EXPLAIN_FACTOR) text_add(t, " over nominal (%s)", number);
    if (a->map == EXPLAIN_RELATIVE) text_add(t, " over %s", space->axis[0].key[0]);
}

/* What is the same in all cells of a map. */
struct map_frame {
    int axis[2]; /* across, up */
    struct text label[2], variant; /* of the axes; of what was judged */
};

/* A published bound of an axis as it is drawn, over the nominal value; NULL when there is none. */
static struct store_value bound(const struct explain_axis *a, double value)
{
    bool known = a->map == EXPLAIN_FACTOR && a->high[0] > a->low[0];
    return known ? store_real(value / a->nominal[0]) : store_null();
}

/* One cell: where it is, how the axes are called, what to mark, and the point that was judged. */
static bool keep_cell(struct explain_bench *b, const struct explain_search *s,
                      const struct map_frame *f, int i, int j, const double *u)
{
    static const char *const name[] = {"subject",  "i",        "j",       "x_key",     "y_key",
                                       "x_label",  "y_label",  "x",       "y",         "x_low",
                                       "x_high",   "y_low",    "y_high",  "x_nominal", "y_nominal",
                                       "x_answer", "y_answer", "variant", "point_id"};
    /* the nominal point */
    static const double nothing[EXPLAIN_MOST_AXES] = {0};
    const struct explain_space *space = &s->goal.subject->space;
    const struct explain_point *p = explain_known(s->goal.subject, s->goal.operators, u);
    const struct explain_axis *x = &space->axis[f->axis[0]], *y = &space->axis[f->axis[1]];
    /* every point of the map was made before */
    CHECK(p);
    const struct store_value value[] = {store_text(s->goal.subject->name),
                                        store_int(i),
                                        store_int(j),
                                        store_text(x->key[0]),
                                        store_text(y->key[0]),
                                        store_text(f->label[0].s),
                                        store_text(f->label[1].s),
                                        store_real(shown(space, u, f->axis[0])),
                                        store_real(shown(space, u, f->axis[1])),
                                        bound(x, x->low[0]),
                                        bound(x, x->high[0]),
                                        bound(y, y->low[0]),
                                        bound(y, y->high[0]),
                                        store_real(shown(space, nothing, f->axis[0])),
                                        store_real(shown(space, nothing, f->axis[1])),
                                        store_real(shown(space, s->best.u, f->axis[0])),
                                        store_real(shown(space, s->best.u, f->axis[1])),
                                        store_text(f->variant.s),
                                        store_int(p->id)};
    return store_insert(b->store, "explain_map", 19, name, value, b->e);
}

/* Cells along each side. */
enum { MAP = 11, DEAR_MAP = 6 }; /* factors 1/10 .. 10 in steps of 1.6 and of 2.5 */

/* Points along each axis of a map: fewer where they take long to simulate. */
static int map_size(const struct explain_search *s, const int *axis)
{
    const struct explain_space *space = &s->goal.subject->space;
    bool dear = space->axis[axis[0]].dear || space->axis[axis[1]].dear;
    for (int i = 0; i < space->n; i++) dear = dear || (space->axis[i].dear && s->best.u[i] != 0);
    return dear ? DEAR_MAP : MAP;
}

/* The point in row j and column i of the map: the answer, but for the two axes. */
static void map_point(const struct explain_search *s, const int *axis, int i, int j, double *u)
{
    const struct explain_space *space = &s->goal.subject->space;
    const int at[2] = {i, j};
    memcpy(u, s->best.u, EXPLAIN_MOST_AXES * sizeof *u);
    for (int k = 0; k < 2; k++) {
        const struct explain_axis *a = &space->axis[axis[k]];
        /* Even steps of u are even factors. */
        u[axis[k]] = a->least + (a->most - a->least) * at[k] / (map_size(s, axis) - 1);
    }
    explain_space_snap(space, u);
}

/* The points of a map that are not known yet, each once: snapping makes neighbours equal. */
static int missing_points(const struct explain_search *s, const int *axis,
                          struct explain_request *request)
{
    int n = 0, size = map_size(s, axis);
    for (int k = 0; k < size * size; k++) {
        struct explain_request *q = &request[n];
        *q = (struct explain_request){.subject = s->goal.subject, .operators = s->goal.operators};
        map_point(s, axis, k % size, k / size, q->u);
        bool known = explain_known(s->goal.subject, s->goal.operators, q->u) != NULL;
        for (int i = 0; i < n && !known; i++) known = memcmp(request[i].u, q->u, sizeof q->u) == 0;
        n += !known;
    }
    return n;
}

/* A map is stored whole. */
static bool keep_map(struct explain_bench *b, const struct explain_search *s,
                     const struct map_frame *f)
{
    double u[EXPLAIN_MOST_AXES];
    bool ok = store_begin(b->store, b->e);
    if (!ok) return false;
    int size = map_size(s, f->axis);
    for (int k = 0; ok && k < size * size; k++) {
        map_point(s, f->axis, k % size, k / size, u);
        ok = keep_cell(b, s, f, k % size, k / size, u);
    }
    if (ok) return store_commit(b->store, b->e);
    store_rollback(b->store);
    return false;
}

/* Only of two parameters or more. */
bool explain_map(struct explain_bench *b, const struct explain_search *s)
{
    struct explain_request request[MAP * MAP + 1];
    struct map_frame f = {0};
    if (s->goal.subject->space.n < 2) return true;
    two_axes(s, f.axis);
    for (int k = 0; k < 2; k++) axis_label(&s->goal.subject->space, f.axis[k], &f.label[k]);
    explain_variant(s->goal.subject->rule[0], s->best.grade.baseline, s->goal.operators,
                    &f.variant);
    bool ok = explain_make(b, request, missing_points(s, f.axis, request)) && keep_map(b, s, &f);
    for (int k = 0; k < 2; k++) text_free(&f.label[k]);
    text_free(&f.variant);
    return ok;
}

/* verify.c - one reference vector: read it, run what applies, judge every row and the case. */
#include "study/verify.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/progress.h"
#include "base/text.h"
#include "dynamics/system.h"
#include "model/lump.h"
#include "model/vector_check.h"
#include "model/vector_model.h"
#include "model/vector_perturb.h"
#include "study/trial.h"
#include "study/verify_rows.h"

struct verify_row *verify_row_add(struct verify_case *v, const char *algorithm, const char *quantity)
{
    struct verify_report *r = v->report;
    if (r->nrow == r->row_room) {
        int room = r->row_room > 0 ? 2 * r->row_room : 32;
        struct verify_row *larger = TAKE(r->arena, room, struct verify_row);
        if (r->nrow > 0) memcpy(larger, r->row, (size_t)r->nrow * sizeof *larger);
        r->row = larger;
        r->row_room = room;
    }
    struct verify_row *row = &r->row[r->nrow++];
    text_copy(row->algorithm, sizeof row->algorithm, algorithm);
    text_copy(row->quantity, sizeof row->quantity, quantity);
    return row;
}

void verify_row_skip(struct verify_case *v, const char *algorithm, const char *quantity, const char *why)
{
    struct verify_row *row = verify_row_add(v, algorithm, quantity);
    row->verdict = VERIFY_NOT_APPLICABLE;
    text_copy(row->note, sizeof row->note, why);
}

bool verify_loops_skip(struct verify_case *v, const char *algorithm)
{
    char why[96];
    int nrow = v->vector->nrow, redundant = v->answers.redundant;
    if (redundant == 0) return false;
    snprintf(why, sizeof why, "redundant loops (rank %d of %d): lambda is not unique", nrow - redundant, nrow);
    verify_row_skip(v, algorithm, "lambda", why);
    return true;
}

double verify_tolerance_inverse(const struct verify_options *o)
{
    return o->tolerance_inverse > 0 ? o->tolerance_inverse : o->precision == PRECISION_FLOAT ? 1e-4 : 1e-12;
}

double verify_tolerance_forward(const struct verify_options *o)
{
    return o->tolerance_forward > 0 ? o->tolerance_forward : o->precision == PRECISION_FLOAT ? 1e-3 : 1e-10;
}

void verify_row_judge(const struct verify_case *v, struct verify_row *row, enum verify_quantity k, const double *y,
                      double tolerance)
{
    const struct verify_answers *x = &v->answers;
    row->tolerance = tolerance;
    row->error = y ? verify_answers_error(x, k, y) : INFINITY;
    row->plain = y ? verify_answers_plain(x, k, y) : INFINITY;
    row->verdict = row->error <= tolerance ? VERIFY_PASS : VERIFY_FAIL;
    if (!y) text_copy(row->note, sizeof row->note, "breaks down");
    if (row->verdict != VERIFY_PASS || verify_answers_tells(x, k, tolerance)) return;
    row->verdict = VERIFY_NOT_APPLICABLE;
    text_copy(row->note, sizeof row->note, "the inputs' rounding alone decides this answer");
}

bool verify_row_refuted(const struct verify_case *v, struct verify_row *row, enum verify_quantity k)
{
    const struct verify_answers *x = &v->answers;
    bool exact = x->forward || (k != VERIFY_QDD_FD && k != VERIFY_LAMBDA);
    if (exact && verify_answers_error(x, k, x->exact + x->at[k]) <= row->tolerance) return false;
    char before[sizeof row->note];
    text_copy(before, sizeof before, row->note);
    snprintf(row->note, sizeof row->note, "%.80s%s%s", before, before[0] ? "; " : "",
             exact ? "quad precision contradicts the file too" : "articulated bodies break down in quad precision");
    return true;
}

void verify_row_explain(struct verify_row *row, double quad, bool sane)
{
    char before[sizeof row->note];
    bool mended = quad <= row->tolerance;
    row->verdict = mended ? VERIFY_ROUNDING : sane ? VERIFY_ALGORITHM_FAILS : VERIFY_FAIL;
    row->quad = quad;
    text_copy(before, sizeof before, row->note);
    snprintf(row->note, sizeof row->note, "%.80s%sin quad precision %.1e%s", before, before[0] ? "; " : "", quad,
             mended || sane ? "" : "; wrong about an even scene too");
}

bool verify_unfit_body(const struct model *m, char *why, int size)
{
    if (m->has_phi) return false;
    for (int i = 0; i < m->nbody; i++) {
        const struct body_def *b = &m->body[i];
        double trace = b->inertia[0] + b->inertia[3] + b->inertia[5];
        if (b->mass > 0 && trace > 0) continue;
        snprintf(why, (size_t)size, "%s body %d ('%s')", b->mass > 0 ? "point mass in" : "massless", i, b->name);
        return true;
    }
    snprintf(why, (size_t)size, "a body's inertia has no inverse");
    return true;
}

/* --- the verdict ----------------------------------------------------------------------------------------------- */

/* Does some row of this row's quantity pass? Only asked of quantities that have an applicable row. */
static bool quantity_passes(const struct verify_report *r, const char *quantity)
{
    for (int i = 0; i < r->nrow; i++)
        if (r->row[i].verdict == VERIFY_PASS && strcmp(r->row[i].quantity, quantity) == 0) return true;
    return false;
}

/* What to use instead of an algorithm that fails: the same kind of program in double precision, then in quad, then any
 * serial one; the last of equals, as rows stand from the simplest form to the most robust. */
static const struct verify_row *remedy_of(const struct verify_report *r, const struct verify_row *failed)
{
    const struct verify_row *best = NULL;
    int best_rank = 0;
    for (int i = 0; i < r->nrow; i++) {
        const struct verify_row *x = &r->row[i];
        bool pass = x->verdict == VERIFY_PASS, same = x->parallel == failed->parallel;
        int rank = strcmp(x->quantity, failed->quantity) != 0 ? 0
                   : pass && same                             ? 3
                   : x->verdict == VERIFY_ROUNDING && same    ? 2
                   : pass                                     ? 1
                                                              : 0;
        if (rank > 0 && rank >= best_rank) best = x, best_rank = rank;
    }
    return best;
}

static void remedies_name(struct verify_report *r)
{
    for (int i = 0; i < r->nrow; i++) {
        struct verify_row *row = &r->row[i];
        if (row->verdict != VERIFY_ALGORITHM_FAILS) continue;
        const struct verify_row *x = remedy_of(r, row);
        if (x) snprintf(row->remedy, sizeof row->remedy, "%s%s", x->algorithm,
                        x->verdict == VERIFY_ROUNDING ? " in quad precision" : "");
    }
}

static void conclude(struct verify_report *r)
{
    r->passed = true;
    remedies_name(r);
    for (int i = 0; i < r->nrow && r->passed; i++) {
        const struct verify_row *row = &r->row[i];
        bool excused = row->verdict == VERIFY_ROUNDING || row->verdict == VERIFY_ALGORITHM_FAILS;
        if (row->verdict == VERIFY_FAIL) {
            r->passed = false;
            snprintf(r->text, sizeof r->text, "%s: %s is wrong by %.1e", row->algorithm, row->quantity, row->error);
        } else if (excused && !quantity_passes(r, row->quantity)) {
            r->passed = false;
            snprintf(r->text, sizeof r->text, "no algorithm gives %s within the tolerance", row->quantity);
        }
    }
    if (r->nrow == 0) {
        r->passed = false;
        snprintf(r->text, sizeof r->text, "nothing to compare");
    }
}

static void report_begin(struct verify_report *r, const struct vector_case *c, struct arena *a)
{
    *r = (struct verify_report){.path = arena_text(a, c->path), .name = arena_text(a, c->name),
                                .group = arena_text(a, c->group), .nbody = c->nbody, .nu = c->nv, .nrow_loop = c->nrow,
                                .floor_id = c->floor_id, .floor_fd = c->floor_fd, .peer_id = c->peer_id.error,
                                .peer_fd = c->peer_fd.error, .arena = a};
    r->peer_id_name = arena_text(a, c->peer_id.name ? c->peer_id.name : "");
    r->peer_fd_name = arena_text(a, c->peer_fd.name ? c->peer_fd.name : "");
}

/* Constraint forces need every body's inertia: bodies on fixed joints are lumped when that helps. */
static bool lump(struct verify_case *v, struct err *e)
{
    v->lumped = v->model;
    v->lumped_state = v->state;
    if (v->model->has_phi) return true;
    struct lumped lumped;
    if (!lump_fixed(v->model, true, v->arena, &lumped, e)) return false;
    if (!lumped.model || lumped.model->nbody == v->model->nbody) return true;
    v->lumped = lumped.model;
    v->lumped_state = lump_state(&lumped, v->model, v->state, v->arena);
    return true;
}

bool verify_even(struct verify_case *v, struct err *e)
{
    if (v->even) return true;
    struct verify_case *x = TAKE(v->arena, 1, struct verify_case);
    struct work w = {0};
    *x = *v;
    x->vector = vector_even(v->vector, v->arena);
    struct model *m = vector_model(x->vector, v->arena, e);
    if (!m) return false;
    system_prepare(m);
    x->model = m;
    x->state = vector_state(x->vector, m, v->arena);
    double *qdd = TAKE(v->arena, m->nu + 1, double);
    x->answers.exact = qdd;
    x->answers.forward = dynamics_type_of(PRECISION_QUAD)->forward(m, x->state, FORWARD_ABA, v->arena, qdd, NULL, NULL,
                                                                   &w);
    if (!lump(x, e)) return false;
    v->even = x;
    return true;
}

bool verify_even_right(const struct verify_case *v, const double *qdd)
{
    const struct verify_answers *x = &v->even->answers;
    return x->forward && trial_error(qdd, x->exact, v->vector->nv) <= 1e-8;
}

static bool rows_make(struct verify_case *v, struct err *e)
{
    if (v->vector->ninstant > 0) return verify_trajectory(v, e);
    return verify_answers_make(&v->answers, v->vector, v->model, v->state, v->arena, e) && verify_serial(v, e) &&
           verify_urdf(v, e) && (!v->options->parallel || verify_parallel(v, e));
}

bool verify_file(const char *path, const struct verify_options *o, struct arena *a, struct verify_report *r,
                 struct err *e)
{
    double begin = host_seconds();
    struct arena *own = arena_create();
    struct vector_case c;
    struct verify_case v = {.vector = &c, .options = o, .report = r, .arena = own};
    struct model *m = vector_read(path, &c, own, e) && vector_complete(&c, e) ? vector_model(&c, own, e) : NULL;
    bool good = (v.model = m) != NULL;
    if (good) {
        system_prepare(m);
        v.state = vector_state(&c, v.model, own);
        report_begin(r, &c, a);
        good = lump(&v, e) && rows_make(&v, e);
    }
    if (good) conclude(r);
    arena_destroy(own);
    r->host_s = host_seconds() - begin;
    return good;
}

/* verify.c - one reference vector: read it, run what applies, judge every row and the case.
 *
 * A row is the error of one algorithm in one quantity. Above its tolerance it is not simply
 * wrong: the same algorithm in quad precision tells rounding from a wrong formula, and the same
 * scene with even masses tells a wrong formula from a scene that the algorithm cannot do. Only
 * the last step, the case, is pass or fail. */
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

/* --- the verdict ------------------------------------------------------------------------------ */

/* Does some row of this row's quantity pass? Only asked of quantities that have an applicable
 * row. */
static bool quantity_passes(const struct verify_report *r, const char *quantity)
{
    for (int i = 0; i < r->nrow; i++)
        if (r->row[i].verdict == VERIFY_PASS && strcmp(r->row[i].quantity, quantity) == 0)
            return true;
    return false;
}

/* What to use instead of an algorithm that fails: the same kind of program in double precision,
 * then in quad, then any serial one; the last of equals, as rows stand from the simplest form to
 * the most robust. */
static const struct verify_row *remedy_of(const struct verify_report *r,
                                          const struct verify_row *failed)
{
    const struct verify_row *best = NULL;
    int best_rank = 0;
    for (int i = 0; i < r->nrow; i++) {
        const struct verify_row *x = &r->row[i];
        bool pass = x->verdict == VERIFY_PASS, same = x->parallel == failed->parallel;
        /* 3: passes and is of the same kind; 2: right in quad precision; 1: passes */
        int rank = strcmp(x->quantity, failed->quantity) != 0 ? 0
                   : pass && same                             ? 3
                   : x->verdict == VERIFY_ROUNDING && same    ? 2
                   : pass                                     ? 1
                                                              : 0;
        if (rank > 0 && rank >= best_rank) best = x, best_rank = rank;
    }
    return best;
}

/* Advice for each row whose algorithm fails on the case. */
static void remedies_name(struct verify_report *r)
{
    for (int i = 0; i < r->nrow; i++) {
        struct verify_row *row = &r->row[i];
        /* Rounding needs no advice: higher precision is the obvious one. */
        if (row->verdict != VERIFY_ALGORITHM_FAILS) continue;
        const struct verify_row *x = remedy_of(r, row);
        if (x) snprintf(row->remedy, sizeof row->remedy, "%s%s", x->algorithm,
                        x->verdict == VERIFY_ROUNDING ? " in quad precision" : "");
    }
}

/* The case passes when no row fails, and when each quantity has at least one algorithm that
 * gives it: a failure that rounding or the algorithm explains is excused only then. */
static void conclude(struct verify_report *r)
{
    r->passed = true;
    remedies_name(r);
    for (int i = 0; i < r->nrow && r->passed; i++) {
        const struct verify_row *row = &r->row[i];
        /* A wrong answer fails the case at once; an excused one only if nothing else gives the
         * quantity. */
        bool excused = row->verdict == VERIFY_ROUNDING || row->verdict == VERIFY_ALGORITHM_FAILS;
        if (row->verdict == VERIFY_FAIL) {
            r->passed = false;
            snprintf(r->text, sizeof r->text, "%s: %s is wrong by %.1e", row->algorithm,
                     row->quantity, row->error);
        } else if (excused && !quantity_passes(r, row->quantity)) {
            r->passed = false;
            snprintf(r->text, sizeof r->text, "no algorithm gives %s within the tolerance",
                     row->quantity);
        }
    }
    /* A file without any answer must not pass. */
    if (r->nrow == 0) {
        r->passed = false;
        snprintf(r->text, sizeof r->text, "nothing to compare");
    }
}

/* What the report keeps of the file: copies, as the file's arena ends with verify_file. */
static void report_begin(struct verify_report *r, const struct vector_case *c, struct arena *a)
{
    *r = (struct verify_report){.path = arena_text(a, c->path),
                                .name = arena_text(a, c->name),
                                .group = arena_text(a, c->group),
                                .nbody = c->nbody,
                                .nu = c->nv,
                                .nrow_loop = c->nrow,
                                .floor_id = c->floor_id,
                                .floor_fd = c->floor_fd,
                                .peer_id = c->peer_id.error,
                                .peer_fd = c->peer_fd.error,
                                .arena = a};
    r->peer_id_name = arena_text(a, c->peer_id.name ? c->peer_id.name : "");
    r->peer_fd_name = arena_text(a, c->peer_fd.name ? c->peer_fd.name : "");
}

/* A file with instants is a motion; any other is one state. */
static bool rows_make(struct verify_case *v, struct err *e)
{
    /* Answers first: rows are judged by their scales. */
    if (v->vector->ninstant > 0) return verify_trajectory(v, e);
    return verify_answers_make(&v->answers, v->vector, v->model, v->state, v->arena, e) &&
           verify_serial(v, e) && verify_urdf(v, e) &&
           (!v->options->parallel || verify_parallel(v, e));
}

/* Everything of the case lives in `own`, the rows in `a`: thousands of files can be verified in
 * turn. */
bool verify_file(const char *path, const struct verify_options *o, struct arena *a,
                 struct verify_report *r, struct err *e)
{
    double begin = host_seconds();
    struct arena *own = arena_create();
    struct vector_case c;
    struct verify_case v = {.vector = &c, .options = o, .report = r, .arena = own};
    /* Read, complete (what the file may leave out), then as a model of this program. */
    struct model *m =
        vector_read(path, &c, own, e) && vector_complete(&c, e) ? vector_model(&c, own, e) : NULL;
    bool good = (v.model = m) != NULL;
    if (good) {
        system_prepare(m);
        v.state = vector_state(&c, v.model, own);
        report_begin(r, &c, a);
        good = verify_lump(&v, e) && rows_make(&v, e);
    }
    if (good) conclude(r);
    arena_destroy(own);
    r->host_s = host_seconds() - begin;
    return good;
}

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
            snprintf(r->text, sizeof r->text, "%s: %s is wrong by %.1e", row->algorithm,
                     row->quantity, row->error);
        } else if (excused && !quantity_passes(r, row->quantity)) {
            r->passed = false;
            snprintf(r->text, sizeof r->text, "no algorithm gives %s within the tolerance",
                     row->quantity);
        }
    }
    if (r->nrow == 0) {
        r->passed = false;
        snprintf(r->text, sizeof r->text, "nothing to compare");
    }
}

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

static bool rows_make(struct verify_case *v, struct err *e)
{
    if (v->vector->ninstant > 0) return verify_trajectory(v, e);
    return verify_answers_make(&v->answers, v->vector, v->model, v->state, v->arena, e) &&
           verify_serial(v, e) && verify_urdf(v, e) &&
           (!v->options->parallel || verify_parallel(v, e));
}

bool verify_file(const char *path, const struct verify_options *o, struct arena *a,
                 struct verify_report *r, struct err *e)
{
    double begin = host_seconds();
    struct arena *own = arena_create();
    struct vector_case c;
    struct verify_case v = {.vector = &c, .options = o, .report = r, .arena = own};
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

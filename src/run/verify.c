/* verify.c - one reference vector: read it, run what applies, judge every row and the case. */
#include "run/verify.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/progress.h"
#include "base/text.h"
#include "dynamics/system.h"
#include "model/lump.h"
#include "model/vector_model.h"
#include "run/verify_rows.h"

double verify_error(const double *x, const double *ref, int n)
{
    double difference = 0, scale = 0;
    for (int i = 0; i < n; i++) {
        if (!isfinite(x[i])) return INFINITY;
        difference = fmax(difference, fabs(x[i] - ref[i]));
        scale = fmax(scale, fabs(ref[i]));
    }
    return scale > 0 ? difference / scale : difference;
}

double verify_largest(const double *x, int n)
{
    double largest = 0;
    for (int i = 0; i < n; i++) largest = fmax(largest, fabs(x[i]));
    return largest;
}

double verify_error_beside(const double *x, const double *ref, int n, double scale)
{
    const double own = verify_largest(ref, n), error = verify_error(x, ref, n);
    return own > 0 && own < 1e-3 * scale ? error * own / (1e-3 * scale)
           : own == 0 && scale > 0       ? error / (1e-3 * scale)
                                         : error;
}

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

/* What is asked for unless the user says otherwise: not better than ten roundings of the inputs or the best library. */
static double attainable(double asked, double floor, double peer)
{
    if (isfinite(floor)) asked = fmax(asked, 10 * floor);
    return isfinite(peer) ? fmax(asked, peer) : asked;
}

double verify_tolerance_inverse(const struct verify_case *v)
{
    double given = v->options->tolerance_inverse;
    return given > 0 ? given : attainable(1e-12, v->vector->floor_id, v->vector->peer_id.error);
}

double verify_tolerance_forward(const struct verify_case *v)
{
    double given = v->options->tolerance_forward;
    return given > 0 ? given : attainable(1e-10, v->vector->floor_fd, v->vector->peer_fd.error);
}

double verify_tolerance_robust(const struct verify_case *v)
{
    const double few_roundings = 2e-15;
    bool lenient = v->options->tolerance_forward > 0 || v->options->precision == PRECISION_FLOAT;
    if (lenient || strcmp(v->vector->group, "extreme") != 0) return verify_tolerance_forward(v);
    return attainable(few_roundings, v->vector->floor_fd, v->vector->peer_fd.error);
}

bool verify_error_vanishes(double error, double quad)
{
    return isfinite(quad) && quad <= fmax(1e-13, 1e-6 * error);
}

bool verify_error_scales(double error, double single)
{
    const double unit = 0x1p-29, slack = 100;
    return error <= slack * unit * single;
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

static void conclude(struct verify_report *r)
{
    r->passed = true;
    for (int i = 0; i < r->nrow && r->passed; i++) {
        const struct verify_row *row = &r->row[i];
        if (row->verdict == VERIFY_FAIL) {
            r->passed = false;
            snprintf(r->text, sizeof r->text, "%s: %s is wrong by %.1e", row->algorithm, row->quantity, row->error);
        } else if (row->verdict == VERIFY_ROUNDING && !quantity_passes(r, row->quantity)) {
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

bool verify_file(const char *path, const struct verify_options *o, struct arena *a, struct verify_report *r,
                 struct err *e)
{
    double begin = host_seconds();
    struct arena *own = arena_create();
    struct vector_case c;
    struct verify_case v = {.vector = &c, .options = o, .report = r, .arena = own};
    struct model *model = vector_read(path, &c, own, e) ? vector_model(&c, own, e) : NULL;
    bool good = (v.model = model) != NULL;
    if (good) {
        system_prepare(model);
        v.state = vector_state(&c, v.model, own);
        report_begin(r, &c, a);
        good = lump(&v, e);
    }
    if (good && c.ninstant > 0) {
        verify_trajectory(&v);
    } else if (good) {
        verify_serial(&v);
        good = !o->parallel || verify_parallel(&v, e);
    }
    if (good) conclude(r);
    arena_destroy(own);
    r->host_s = host_seconds() - begin;
    return good;
}

/* model.c - building a model body by body, with the checks that keep impossible bodies out. */
#include "model/model.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"
#include "linalg/eigen.h"
#include "model/model_part.h"

/* SI until somebody says otherwise. */
struct model *model_begin(struct arena *a, const char *file)
{
    struct model *m = TAKE(a, 1, struct model);
    m->arena = a;
    m->file = file;
    m->metre = m->kilogram = m->second = 1;
    return m;
}

/* What is wrong with body `name`, at its line. */
static bool refuse(const struct model *m, const char *kind, const char *name, int line,
                   struct err *e, const char *why)
{
    /* Line 0 is that of generated bodies: they stand in no file. */
    return err_set_at(e, ERR_DATA, m->file ? m->file : "", line, "%s '%s': %s", kind, name, why);
}

/* Not left to readers: models also come from code. */
static bool all_finite(const double *x, int n)
{
    for (int i = 0; i < n; i++)
        if (!isfinite(x[i])) return false;
    return true;
}

/* The largest component: no square overflows. */
static double norm(const double *x, int n)
{
    double s = 0;
    for (int i = 0; i < n; i++) s = fmax(s, fabs(x[i]));
    return s;
}

/* A zero quaternion is the identity. */
static void complete_frame(struct frame *f)
{
    if (norm(f->quat, 4) == 0) f->quat[3] = 1;
}

static bool frame_finite(const struct frame *f)
{
    return all_finite(f->quat, 4) && all_finite(f->p, 3);
}

/* Relative to both lengths, which are free; 1e-9 forgives the rounding of printed axes. */
static bool orthogonal(const double *x, const double *y)
{
    double dot = x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    double xx = x[0] * x[0] + x[1] * x[1] + x[2] * x[2],
           yy = y[0] * y[0] + y[1] * y[1] + y[2] * y[2];
    return fabs(dot) <= 1e-9 * sqrt(xx) * sqrt(yy);
}

/* Why the joint of `b` cannot be; NULL when it can. */
static const char *joint_fault(const struct body_def *b)
{
    /* Traits say which axes a type needs (spec/joint_list.h). */
    if (b->joint >= JOINT_MIXED) return "unknown joint type";
    if (!all_finite(b->axis, 3) || !all_finite(b->axis2, 3) || !isfinite(b->pitch))
        return "axis or pitch not finite";
    if (joint_has(b->joint, JOINT_AXIS) && norm(b->axis, 3) == 0)
        return "its joint needs an axis that is not zero";
    if (joint_has(b->joint, JOINT_TWO_AXES) &&
        (norm(b->axis2, 3) == 0 || !orthogonal(b->axis, b->axis2)))
        return "its joint needs two orthogonal axes (use two revolute joints otherwise)";
    if (joint_has(b->joint, JOINT_NORMAL) && !orthogonal(b->axis, b->axis2))
        return "the direction of x must lie in the joint's plane";
    if (!isfinite(b->stiffness) || !isfinite(b->rest) || !isfinite(b->damping))
        return "spring or damper not finite";
    if ((b->stiffness != 0 || b->damping != 0) && joint_nu(b->joint) != 1)
        return "springs and dampers act on joints of one degree of freedom only";
    return NULL;
}

/* Parents first: every sweep of the algorithms relies on it, and so no tree has a cycle. */
bool model_reserve(struct model *m, int n, int here, struct err *e)
{
    /* With the bodies go their five index tables (model_finish). */
    const size_t bytes = size_product((size_t)here, sizeof(struct body_def) + 5 * sizeof(int));
    char what[64];
    snprintf(what, sizeof what, "a model of %d bodies", n);
    if (!size_in_memory(bytes, m->file ? m->file : "", 0, what, e)) return false;
    m->body_room = n;
    m->body = TAKE_FULL(m->arena, n, struct body_def, here == n);
    return true;
}

int model_add_body(struct model *m, const struct body_def *def, struct err *e)
{
    const char *fault = joint_fault(def);
    if (!fault && (def->parent < -1 || def->parent >= m->nbody))
        fault = "its parent must come before it";
    if (!fault && !frame_finite(&def->placement)) fault = "placement not finite";
    if (fault) {
        refuse(m, "body", def->name, def->line, e, fault);
        return -1;
    }
    /* Doubled when full: readers do not know the number beforehand. */
    if (m->nbody == m->body_room) {
        m->body_room = m->body_room ? 2 * m->body_room : 64;
        /* The old array stays in the arena: at most as much again is lost. */
        struct body_def *more = TAKE(m->arena, m->body_room, struct body_def);
        if (m->nbody) memcpy(more, m->body, (size_t)m->nbody * sizeof *more);
        m->body = more;
    }
    m->body[m->nbody] = *def;
    complete_frame(&m->body[m->nbody].placement);
    return m->nbody++;
}

/* Why the loop cannot be; NULL when it can. */
static const char *loop_fault(const struct model *m, const struct loop_def *l)
{
    if (l->body_a < -1 || l->body_a >= m->nbody || l->body_b < -1 || l->body_b >= m->nbody)
        return "its bodies must come before it";
    /* Within one body nothing moves: its rows would hold nothing but rounding. */
    if (l->body_a == l->body_b) return "it must join two different bodies";
    if (!frame_finite(&l->frame_a) || !frame_finite(&l->frame_b)) return "frame not finite";
    /* By rows. Redundant ones are fine (physics 7.4), but a zero one is a mistake of the file. */
    if (l->nrow < 0 || l->nrow > 6) return "it must have 1 to 6 rows";
    if (l->nrow > 0 && !all_finite(&l->row[0][0], 6 * l->nrow)) return "row not finite";
    for (int i = 0; i < l->nrow; i++)
        if (norm(l->row[i], 6) == 0) return "a row is zero";
    /* By a joint: W must have columns to constrain with (physics 1.3). */
    if (l->nrow == 0 && (l->joint >= JOINT_MIXED || joint_nu(l->joint) == 6))
        return "its joint constrains nothing";
    if (l->nrow == 0 && joint_has(l->joint, JOINT_IN_TREES))
        return "a joint of its type cannot close a loop";
    if (!isfinite(l->alpha) || !isfinite(l->beta) || l->alpha < 0 || l->beta < 0)
        return "stabilisation must be finite and not negative";
    return NULL;
}

/* Bodies on both sides must be there already. */
int model_add_loop(struct model *m, const struct loop_def *def, struct err *e)
{
    const char *fault = loop_fault(m, def);
    if (fault) {
        refuse(m, "loop", def->name, def->line, e, fault);
        return -1;
    }
    if (m->nloop == m->loop_room) {
        m->loop_room = m->loop_room ? 2 * m->loop_room : 8;
        struct loop_def *more = TAKE(m->arena, m->loop_room, struct loop_def);
        if (m->nloop) memcpy(more, m->loop, (size_t)m->nloop * sizeof *more);
        m->loop = more;
    }
    m->loop[m->nloop] = *def;
    complete_frame(&m->loop[m->nloop].frame_a);
    complete_frame(&m->loop[m->nloop].frame_b);
    return m->nloop++;
}

/* Principal moments of inertia, ascending. */
static void principal_moments(const double *inertia, double *w)
{
    double a[9] = {inertia[0], inertia[1], inertia[2], inertia[1], inertia[3],
                   inertia[4], inertia[2], inertia[4], inertia[5]};
    /* Scaled to 1, so that tiny and huge units work alike. */
    double scale = norm(a, 9);
    for (int i = 0; scale > 0 && i < 9; i++) a[i] /= scale;
    struct work uncounted = {0};
    eigen_symmetric(3, a, NULL, w, &uncounted);
    /* Three numbers: sorted by hand. */
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2 - i; j++)
            if (w[j] > w[j + 1]) {
                double t = w[j];
                w[j] = w[j + 1], w[j + 1] = t;
            }
    for (int i = 0; i < 3; i++) w[i] *= scale;
}

/* Whether the body has an inverse inertia, as far as doubles can tell. */
static bool invertible(const struct body_def *b)
{
    /* A smallest moment below 1e-15 of the largest is rounding, and (1.8) would divide by it. */
    double w[3];
    principal_moments(b->inertia, w);
    return b->mass > 0 && w[0] > 1e-15 * w[2];
}

static bool body_check(const struct model *m, const struct body_def *b, bool allow_nonphysical,
                       struct err *e)
{
    if (!isfinite(b->mass) || !all_finite(b->com, 3) || !all_finite(b->inertia, 6))
        return refuse(m, "body", b->name, b->line, e,
                      "mass, centre of mass or inertia is not finite");
    /* Finite numbers are all that algorithms need in order not to crash. */
    if (allow_nonphysical) return true;
    double w[3];
    principal_moments(b->inertia, w);
    const char *file = m->file ? m->file : "";
    if (b->mass <= 0)
        return err_set_at(e, ERR_DATA, file, b->line, "body '%s': mass %g, must be positive",
                          b->name, b->mass);
    if (w[0] <= 0)
        return err_set_at(e, ERR_DATA, file, b->line,
                          "body '%s': inertia not positive definite (principal moments %g, %g, "
                          "%g)", b->name, w[0],
                          w[1], w[2]);
    /* Moments of inertia are sums of two second moments each: none exceeds the other two. */
    if (w[0] + w[1] < w[2] * (1 - 1e-9))
        return err_set_at(e, ERR_DATA, file, b->line,
                          "body '%s': inertia violates the triangle inequality (principal moments "
                          "%g + %g < %g)",
                          b->name, w[0], w[1], w[2]);
    return true;
}

/* Children in ascending order, by counting. */
static void index_children(struct model *m)
{
    m->child_at = TAKE(m->arena, m->nbody + 2, int);
    m->child = TAKE(m->arena, m->nbody, int);
    /* The counts stand one place late, so that after the sums at[i] is where list i begins. Filling
     * moves it to the end, where list i + 1 begins: child_at is right without a third pass. */
    int *at = m->child_at + 1; /* at[i] becomes the end of i's list while filling */
    for (int i = 0; i < m->nbody; i++)
        if (m->body[i].parent >= 0) at[m->body[i].parent + 1]++;
    for (int i = 1; i <= m->nbody; i++) at[i] += at[i - 1];
    for (int i = 0; i < m->nbody; i++)
        if (m->body[i].parent >= 0) m->child[at[m->body[i].parent]++] = i;
}

/* A part of a chain of revolute joints: a coordinate and a child for each body. */
static void index_part(struct model *m)
{
    m->q_at = m->u_at = TAKE(m->arena, m->nbody + 1, int);
    m->row_at = TAKE(m->arena, 1, int);
    for (int i = model_known_first(m); i <= model_known_end(m); i++) m->q_at[i] = i;
    m->is_chain = m->has_phi = true;
    for (int i = m->first; i < m->end; i++) m->has_phi = m->has_phi && invertible(&m->body[i]);
    m->nq = m->nu = m->q_at[m->nbody] = m->nbody;
}

/* Where each body's numbers begin, and what kind of system it is. */
static void index_coordinates(struct model *m)
{
    m->q_at = TAKE(m->arena, m->nbody + 1, int);
    m->u_at = TAKE(m->arena, m->nbody + 1, int);
    m->row_at = TAKE(m->arena, m->nloop + 1, int);
    /* Properties of the whole: chains and constraint forces have programs of their own. */
    m->is_chain = m->has_phi = true;
    for (int i = 0; i < m->nbody; i++) {
        const struct body_def *b = &m->body[i];
        m->q_at[i + 1] = m->q_at[i] + joint_nq(b->joint);
        m->u_at[i + 1] = m->u_at[i] + joint_nu(b->joint);
        m->is_chain = m->is_chain && b->parent == i - 1;
        /* One body without Phi rules out constraint forces for the whole system. */
        m->has_phi = m->has_phi && invertible(b);
    }
    for (int l = 0; l < m->nloop; l++)
        /* Rows as given, or the 6 - d columns of the joint's W (physics 1.3). */
        m->row_at[l + 1] =
            m->row_at[l] + (m->loop[l].nrow ? m->loop[l].nrow : 6 - joint_nu(m->loop[l].joint));
    m->nq = m->q_at[m->nbody];
    m->nu = m->u_at[m->nbody];
    m->nrow = m->row_at[m->nloop];
}

/* From here on the model is only read; room dynamics adds its constants once (system_prepare). */
bool model_finish(struct model *m, bool allow_nonphysical, struct err *e)
{
    if (m->nbody > MODEL_MAX_BODIES || m->nloop > MODEL_MAX_BODIES)
        return err_set_at(e, ERR_DATA, m->file ? m->file : "", 0, "more than %d bodies or loops",
                          MODEL_MAX_BODIES);
    if (m->nbody == 0)
        return err_set_at(e, ERR_DATA, m->file ? m->file : "", 0, "the model has no body");
    const bool part = m->end > 0;
    if (!part) m->end = m->nbody;
    for (int i = m->first; i < m->end; i++)
        if (!body_check(m, &m->body[i], allow_nonphysical, e)) return false;
    if (part) {
        index_part(m);
    } else {
        index_children(m);
        index_coordinates(m);
    }
    /* Their matrix is dense. */
    if (m->nrow > MODEL_MAX_ROWS)
        return err_set_at(e, ERR_DATA, m->file ? m->file : "", 0,
                          "the loops have %d rows together; at most %d: their matrix would take "
                          "%.3g GB", m->nrow,
                          MODEL_MAX_ROWS, (double)m->nrow * m->nrow * sizeof(double) / 1e9);
    m->constants = NULL;
    return true;
}

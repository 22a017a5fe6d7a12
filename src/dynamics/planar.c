/* planar.c - the search for a common normal, always in quad precision; see planar.h. */
#undef REAL_BITS
#define REAL_BITS 128
#include "dynamics/planar.h"

#include <string.h>

#include "dynamics/body.h"
#include "dynamics/planar_frame.h"
#include "linalg/vec3.h"

/* Angles by which rounding of a file's numbers may tilt axes. */
static quad tolerance_of(enum precision p) { return p == PRECISION_QUAD ? 1e-30Q : 1e-12Q; }

/* Of a frame alone: no body, no turning. */
static void rotation_of(const struct frame *f, quad *r)
{
    quad p[3];
    frame_constants_make(NULL, -1, f, r, p);
}

/* A body's axis in the base's frame, all joints at zero. */
static void axis_in_base(const struct model *m, int i, quad *x)
{
    quad r[9];
    direction_unit(m->body[i].axis, x);
    /* From joint frame to joint frame up to the base: at q = 0 a body's frame is its joint's. */
    for (; i >= 0; i = m->body[i].parent) {
        rotation_of(&m->body[i].placement, r);
        mat3_mul_vec(x, r, x);
    }
}

/* Those whose axis has to be the normal. */
static bool turns(enum model_joint joint)
{
    return joint_plane(joint) == PLANE_TURNS || joint_plane(joint) == PLANE_MOVES;
}

static bool slides(enum model_joint joint) { return joint_plane(joint) == PLANE_SLIDES; }

/* The first axis of a turn; or orthogonal to the first two slides that are not parallel; or to the
 * only one there is. */
static void first_normal(const struct model *m, quad *n)
{
    quad slide[3], other[3];
    int first = -1;
    /* The first axis that turns decides for all others. */
    for (int i = 0; i < m->nbody; i++)
        if (turns(m->body[i].joint)) {
            axis_in_base(m, i, n);
            return;
        }
    vec3_set(n, 0, 0, 1);
    for (int i = 0; i < m->nbody; i++) {
        if (!slides(m->body[i].joint)) continue;
        /* One slide alone leaves a choice: any normal orthogonal to it. */
        if (first < 0) {
            first = i;
            axis_in_base(m, i, slide);
            direction_any_orthogonal(slide, n);
            continue;
        }
        axis_in_base(m, i, other);
        vec3_cross(other, slide, other);
        /* Parallel slides say nothing new. */
        if (!(vec3_norm(other) > 1e-6Q)) continue;
        vec3_scale(n, 1 / vec3_norm(other), other);
        return;
    }
}

/* Whether bodies i and j hang in the same way on parents with the same normal. */
static bool same(const struct model *m, int i, int j, const quad *normal)
{
    const struct body_def *a = &m->body[i], *b = &m->body[j];
    return a->joint == b->joint && memcmp(a->axis, b->axis, sizeof a->axis) == 0 &&
           memcmp(a->placement.quat, b->placement.quat, sizeof a->placement.quat) == 0 &&
           memcmp(normal + 3 * (a->parent + 1), normal + 3 * (b->parent + 1), 3 * sizeof *normal) ==
               0;
}

/* The joint's own axis is the normal from here on, so that no tilt adds up. False: it is not. */
static bool settle(const struct body_def *b, quad tolerance, quad *n)
{
    quad axis[3], tilt[3];
    if (joint_plane(b->joint) == PLANE_STAYS) return true;
    direction_unit(b->axis, axis);
    if (slides(b->joint)) {
        if (!(fabsq(vec3_dot(axis, n)) <= tolerance)) return false;
        /* A slide fixes no normal: the present one, made exactly orthogonal to its axis. */
        direction_orthonormalise(n, axis);
        return true;
    }
    /* The sine of the angle between axis and normal. */
    vec3_cross(tilt, axis, n);
    if (!turns(b->joint) || !(vec3_norm(tilt) <= tolerance)) return false;
    /* An axis against the normal is as good: the joint is flipped then (planar_body.c). */
    vec3_scale(n, vec3_dot(axis, n) < 0 ? -1 : 1, axis);
    return true;
}

quad *planar_normals(const struct model *m, quad tolerance, struct arena *a, struct err *e)
{
    quad *normal = TAKE(a, size_product(3, m->nbody + 1), quad), r[9];
    first_normal(m, normal);
    for (int i = 0; i < m->nbody; i++) {
        const struct body_def *b = &m->body[i];
        quad *n = normal + 3 * (i + 1);
        /* Chains of equal links: no need to turn the same normal again. */
        if (i > 0 && same(m, i, i - 1, normal)) {
            vec3_copy(n, n - 3);
            continue;
        }
        rotation_of(&b->placement, r);
        mat3_mul_vec_transposed(n, r, normal + 3 * (b->parent + 1));
        if (settle(b, tolerance, n)) continue;
        /* The first body that leaves the plane is named. */
        err_set(e, ERR_CONFIG, "the scene is not planar: the %s joint of '%s' leaves the plane",
                joint_name(b->joint), b->name);
        return NULL;
    }
    return normal;
}

/* Whether the two frames of every loop see the same normal, and its constraints are rows or stay
 * unit vectors. */
static bool planar_loops(const struct model *m, const quad *normal, quad tolerance, struct err *e)
{
    for (int l = 0; l < m->nloop; l++) {
        const struct loop_def *def = &m->loop[l];
        quad a[3], b[3];
        /* Both sides of the loop must see the same plane. */
        planar_normal_in(&def->frame_a, normal + 3 * (def->body_a + 1), a);
        planar_normal_in(&def->frame_b, normal + 3 * (def->body_b + 1), b);
        vec3_sub(a, b);
        const bool known = def->nrow > 0 || planar_loop_direction(def->joint, 0) >= 0;
        if (!known || !(vec3_norm(a) <= tolerance))
            return err_set(e, ERR_CONFIG, "the scene is not planar: loop '%s' leaves the plane",
                           def->name);
    }
    return true;
}

/* Bodies, then loops, then the base's own motion. */
bool planar_scene(const struct model *m, const struct state *s, enum precision precision,
                  struct err *e)
{
    struct arena *scratch = arena_create();
    const quad tolerance = tolerance_of(precision),
               *normal = planar_normals(m, tolerance, scratch, e);
    bool planar = normal && planar_loops(m, normal, tolerance, e);
    /* A base that turns about any other direction tilts the plane. */
    if (planar && s) {
        quad turn[3], out[3];
        for (int i = 0; i < 3; i++) turn[i] = s->base_acceleration[i];
        vec3_cross(out, turn, normal);
        planar = vec3_norm(out) <= tolerance * vec3_norm(turn);
        if (!planar)
            err_set(e, ERR_CONFIG, "the scene is not planar: its base rotates out of the plane");
    }
    arena_destroy(scratch);
    return planar;
}

/* x where the joint has a direction of its own, else anywhere in the plane. */
void planar_frame(const struct model *m, int i, const quad *normal, quad *rows)
{
    quad *x = rows + 3, *y = rows + 6;
    vec3_copy(rows, normal);
    direction_any_orthogonal(normal, x);
    if (i >= 0 && slides(m->body[i].joint)) {
        direction_unit(m->body[i].axis, x);
        direction_orthonormalise(x, normal);
    } else if (i >= 0 && joint_plane(m->body[i].joint) == PLANE_MOVES) {
        struct body_constants c;
        /* x as the joint in space has it, so that its two displacements mean the same. */
        body_constants_place(m, i, &c);
        for (int k = 0; k < 3; k++) x[k] = c.user[3 * k];
        direction_orthonormalise(x, normal);
    }
    vec3_cross(y, normal, x);
}

void planar_placement(const quad *outer, const quad *inner, const struct frame *f, quad *x)
{
    quad r[9], p[3], axis[3];
    frame_constants_make(NULL, -1, f, r, p);
    /* The angle between the two x axes; their normals agree to the tolerance. */
    mat3_mul_vec(axis, r, inner + 3);
    const quad c = vec3_dot(outer + 3, axis), s = vec3_dot(outer + 6, axis),
               length = sqrtq(c * c + s * s);
    /* A tilt within the tolerance shortens the projection: made unit again. */
    x[0] = c / length, x[1] = s / length;
    /* The shift along the normal is lost on purpose: nothing in the plane depends on it. */
    x[2] = vec3_dot(outer + 3, p), x[3] = vec3_dot(outer + 6, p);
}

void planar_normal_in(const struct frame *f, const quad *outer, quad *normal)
{
    quad r[9];
    rotation_of(f, r);
    mat3_mul_vec_transposed(normal, r, outer);
}

/* Moving constraints have no direction to name. */
int planar_loop_direction(enum model_joint joint, int k)
{
    /* a loop's constraints are W of its joint: what follows H's columns */
    const signed char *pick = joint_pick(joint);
    const int column = joint_nu(joint) + k;
    return pick && column < 6 ? pick[column] : -1;
}

/* state.c - seeded configurations, motions and loads. */
#include <math.h>
#include <string.h>

#include "model/model.h"
#include "model/pose.h"

#define PI 3.14159265358979323846

/* Zero is a pose of every joint but for quaternions, whose w is then 1: no rotation. */
struct state *state_take(const struct model *m, struct arena *a)
{
    struct state *s = TAKE(a, 1, struct state);
    s->q = TAKE(a, m->nq, double);
    s->qd = TAKE(a, m->nu, double);
    s->qdd = TAKE(a, m->nu, double);
    s->tau = TAKE(a, m->nu, double);
    for (int i = m->first; i < m->end; i++) {
        const int quaternion = joint_quaternion(m->body[i].joint);
        if (quaternion >= 0) s->q[m->q_at[i] + quaternion + 3] = 1;
    }
    return s;
}

/* Six numbers a body, only where some body carries a load. */
double *state_fext_need(struct state *s, const struct model *m, struct arena *a)
{
    if (!s->fext) s->fext = TAKE(a, size_product(6, m->nbody), double);
    return s->fext;
}

/* x (nu) = normal numbers, scaled by `angular` or `linear` as each component is. */
static void scatter(const struct model *m, uint64_t seed, enum pose_stream stream, double angular,
                    double linear, double *x)
{
    for (int i = m->first; i < m->end; i++) {
        /* A stream for each body and purpose: what one body draws shifts no other's numbers. */
        struct random r = random_make(seed, stream, (uint64_t)i);
        enum model_joint joint = m->body[i].joint;
        for (int k = 0; k < joint_nu(joint); k++)
            x[m->u_at[i] + k] = random_normal(&r) * (joint_is_linear(joint, k) ? linear : angular);
    }
}

/* [force; moment] as in model.h. A moment is as large as the force at the end of a link. */
static void scatter_wrenches(const struct model *m, const struct model_spec *spec, double force,
                             double length, double *fext)
{
    for (int i = m->first; i < m->end; i++) {
        struct random r = random_make(spec->seed, STREAM_FORCE, (uint64_t)i);
        for (int k = 0; k < 6; k++)
            fext[6 * i + k] = random_normal(&r) * force * (k < 3 ? 1 : length);
    }
}

/* The parallelogram's consistent pose and motion. */
static void pose_four_bar(const struct model_spec *spec, struct state *s)
{
    /* Any angle would do; the cut joint's coordinate follows from it. */
    const double angle = 1.1;
    /* The coupler stays parallel to the ground, so it turns back by the crank's angle; the
     * rocker runs against the crank. The rates follow from the same lines. */
    s->q[0] = angle, s->q[1] = -angle, s->q[2] = angle - PI;
    s->qd[0] = spec->rate, s->qd[1] = -spec->rate, s->qd[2] = spec->rate;
}

/* Settings are in SI, the state in the model's units. */
struct state *state_generate(const struct model *m, const struct model_spec *spec, struct arena *a)
{
    struct state *s = state_take(m, a);
    /* Lengths and times in the model's units; the links of a polymer count as one angstrom. */
    double length = spec->generator == MODEL_POLYMER ? 1 : spec->length / m->metre,
           rate = spec->rate * m->second;
    double force = m->kilogram * m->metre / (m->second * m->second), torque = force * m->metre;
    /* A ring closes at q = 0, a four-bar in a pose of its own: drawn ones would open both. */
    bool closed = spec->generator == MODEL_RING || spec->generator == MODEL_FOUR_BAR;
    if (!closed)
        for (int i = m->first; i < m->end; i++)
            pose_coordinates(spec, m->body[i].joint, i, length, s->q + m->q_at[i]);
    /* What slides has rates a link's length times those of what turns. Accelerations are of the
     * size of the velocity terms, rate^2, so that neither hides the other. */
    scatter(m, spec->seed, STREAM_RATE, rate, rate * length, s->qd);
    if (spec->generator == MODEL_FOUR_BAR) pose_four_bar(spec, s);
    scatter(m, spec->seed, STREAM_ACCELERATION, rate * rate, rate * rate * length, s->qdd);
    /* The force of a slide does as much at a link's length as the torque of a turn. */
    scatter(m, spec->seed, STREAM_TORQUE, spec->torque / torque, spec->torque / (torque * length),
            s->tau);
    if (spec->external_force > 0)
        scatter_wrenches(m, spec, spec->external_force / force, length, state_fext_need(s, m, a));
    /* Prescribed motion of the base, without gravity, which the model has. */
    if (spec->base == BASE_MOVING) {
        for (int k = 0; k < 3; k++) {
            s->base_acceleration[k] = spec->base_acceleration[k] * m->second * m->second;
            s->base_acceleration[3 + k] =
                spec->base_acceleration[3 + k] * m->second * m->second / m->metre;
        }
    }
    return s;
}

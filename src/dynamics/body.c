/* body.c - a body's constants in this precision: rounding of body_constants, external wrenches,
 * springs. */
#include "dynamics/body.h"

#include <string.h>

#include "dynamics/body_constants.h"
#include "model/model_part.h"

/* One rounding a number: what quad precision holds is exact as far as double is concerned. */
static void round_to(real *y, const quad *x, int n)
{
    for (int i = 0; i < n; i++) y[i] = REAL(x[i]);
}

/* Inertia about both points: the bias force of a distant origin is computed about the centre of
 * mass. */
static const struct body_mass *make_mass(const struct model *m, int i, struct arena *a)
{
    struct body_constants c;
    struct body_mass *b = TAKE(a, 1, struct body_mass);
    body_constants_inertia(m, i, &c);
    b->inertia.m = REAL(m->body[i].mass);
    round_to(b->s, c.s, 3);
    round_to(b->jc, c.jc, 6);
    round_to(b->inertia.ms, c.ms, 3);
    round_to(b->inertia.j, c.j, 6);
    round_to(b->phi.a, c.phi_a, 6);
    round_to(b->phi.b, c.phi_b, 9);
    round_to(b->phi.c, c.phi_c, 6);
    return b;
}

/* Frames, own axes, pitch, spring. On entry *b has the details of the body before, or NULL: they
 * stay where they are the same to the bit. */
static void make_frames(const struct model *m, int i, struct body *b, struct arena *a)
{
    struct body_constants c;
    struct body_details own;
    body_constants_place(m, i, &c);
    /* Only some bodies are turned: the others' wrenches are taken as they are. */
    b->turned = c.turned;
    round_to(b->tree.r, c.tree_r, 9);
    round_to(b->tree.p, c.tree_p, 3);
    round_to(own.user, c.user, 9);
    round_to(own.slide, c.slide, 9);
    round_to(&own.unit, &c.unit, 1);
    own.pitch = REAL(m->body[i].pitch);
    b->has_spring = joint_springs(m, i, &own.spring);
    /* The rate of a helical joint is u = q' / unit; unit is 1 for all others. */
    own.spring.rate_stiffness *= own.unit;
    if (b->details && memcmp(b->details, &own, sizeof own) == 0) return;
    struct body_details *details = TAKE(a, 1, struct body_details);
    *details = own;
    b->details = details;
}

/* Whether bodies i and j have the same inertia, in frames turned alike; whether all else is the
 * same, too. */
static bool same_inertia(const struct model *m, int i, int j)
{
    return bodies_alike(m, i, j) && bodies_weigh_alike(m, i, j);
}
static bool same_frames(const struct model *m, int i, int j)
{
    return bodies_alike(m, i, j) && bodies_alike(m, m->body[i].parent, m->body[j].parent) &&
           bodies_hang_alike(m, i, j);
}

/* Chains have thousands of equal links: the constants of a body are those of its predecessor where
 * nothing differs. */
const struct body *bodies_make(const struct model *m, struct arena *a)
{
    if (REAL_BITS == 64 && REAL_LANES == 1 && m->constants) return m->constants;
    struct body *b = TAKE_FULL(a, m->nbody, struct body, model_whole(m));
    const int first = model_known_first(m), end = model_known_end(m);
    for (int i = first; i < end; i++) {
        if (i > first) b[i] = b[i - 1];
        if (i == first || !same_inertia(m, i - 1, i)) b[i].mass = make_mass(m, i, a);
        if (i == first || !same_frames(m, i - 1, i)) make_frames(m, i, &b[i], a);
        body_seat(m, i, &b[i]);
    }
    return b;
}

/* Gravity is an acceleration of the base (physics 1.6). */
void base_motion(const struct model *m, const struct state *s, real *a)
{
    for (int i = 0; i < 6; i++)
        a[i] = REAL(s->base_acceleration[i]) - REAL(i < 3 ? 0 : m->gravity[i - 3]);
}

/* For codes that multiply the inertia out of its factors (kernel/chain.c, forward_exact.c). */
void body_inertia_factors(const struct body *b, real *shift, real *about)
{
    static const signed char at[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    const real *s = b->mass->s;
    /* [U, s~; 0, U] and diag(Jc, m U): the inertia about the origin as a product */
    for (int i = 0; i < 6; i++) shift[7 * i] = REAL(1);
    shift[4] = -s[2], shift[5] = s[1], shift[9] = s[2];
    shift[11] = -s[0], shift[15] = -s[1], shift[16] = s[0];
    for (int i = 0; i < 9; i++) about[6 * (i / 3) + i % 3] = b->mass->jc[at[i]];
    for (int i = 3; i < 6; i++) about[7 * i] = b->mass->inertia.m;
}

/* The wrench acts at the user's origin, which is also the internal one. */
void body_load(const struct body *b, const double *fext, real *f)
{
    /* users give [force; moment], here the moment comes first */
    screw_zero(f);
    if (!fext) return;
    for (int i = 0; i < 3; i++) f[i] = REAL(fext[3 + i]), f[3 + i] = REAL(fext[i]);
    /* and in user axes */
    if (!b->turned) return;
    mat3_mul_vec_transposed(f, b->details->user, f);
    mat3_mul_vec_transposed(f + 3, b->details->user, f + 3);
}

/* rnea_revolute.c - inverse dynamics of all-revolute systems: 216 flops a body besides sine and
 * cosine. */
#include "dynamics/dynamics_table.h"
#include "dynamics/revolute.h"
#include "linalg/angle.h"

/* Motion of a body as its children need it. */
struct motion {
    real w[3], al[3]; /* angular velocity and acceleration */
    real a[3];        /* acceleration of the origin */
    real k[9];        /* al~ + w~ w~ */
};

/* What the inward sweep needs. */
struct load {
    real r[9];        /* body -> parent */
    real n[3], f[3];  /* moment and force that the joint transmits */
};

/* k = al~ + w~ w~. */
enum { SPIN_FLOP = 15 };
/* K = w'~ + w~ w~: what a point at s accelerates by, K s. */
static inline void spin_matrix(struct motion *c)
{
    const real *w = c->w, *al = c->al;
    real *k = c->k;
    real xx = w[0] * w[0], yy = w[1] * w[1], zz = w[2] * w[2];
    real xy = w[0] * w[1], xz = w[0] * w[2], yz = w[1] * w[2];
    k[0] = -(yy + zz), k[1] = xy - al[2], k[2] = xz + al[1];
    k[3] = xy + al[2], k[4] = -(xx + zz), k[5] = yz - al[0];
    k[6] = xz - al[1], k[7] = yz + al[0], k[8] = -(xx + yy);
}

/* w, al, a of body c from its parent's p: the joint adds z u and z ud + w* x z u. */
enum { CARRY_FLOP = 2 * MAT3_VEC_FLOP + 18 + 1 + 5 + MAT3_VEC_FLOP + SPIN_FLOP };
static inline void carry(const struct revolute *b, const real *r, real u, real ud,
                         const struct motion *p, struct motion *c)
{
    const real *t = b->t, *k = p->k;
    real g[3], w[3], al[3];
    mat3_mul_vec_transposed(w, r, p->w);
    mat3_mul_vec_transposed(al, r, p->al);
    /* The origin accelerates as a point of the parent: a + K t, in parent axes. */
    for (int i = 0; i < 3; i++)
        g[i] = p->a[i] + (k[3 * i] * t[0] + k[3 * i + 1] * t[1] + k[3 * i + 2] * t[2]);
    /* (1.9) with H = z: the angular part of b is w* x z u; the linear one is in K t. */
    vec3_set(c->w, w[0], w[1], w[2] + u);
    vec3_set(c->al, al[0] + w[1] * u, al[1] - w[0] * u, al[2] + ud);
    mat3_mul_vec_transposed(c->a, r, g);
    spin_matrix(c);
}

/* f = m (a + K s), n = skew part of K S + s x f. */
enum { NEWTON_EULER_FLOP = 21 + 33 + VEC3_CROSS_ADD_FLOP };
static inline void newton_euler(const struct revolute *b, const struct motion *c, real *f, real *n)
{
    const real *s = b->s, *S = b->second, *k = c->k;
    for (int i = 0; i < 3; i++)
        f[i] = b->m * (c->a[i] + (k[3 * i] * s[0] + k[3 * i + 1] * s[1] + k[3 * i + 2] * s[2]));
    /* The moment of K r r^T dm over the body, summed by its second moments S about the centre:
     * the same as J w' + w x J w, and K is there already. */
    n[0] = (k[6] * S[1] + k[7] * S[3] + k[8] * S[4]) - (k[3] * S[2] + k[4] * S[4] + k[5] * S[5]);
    n[1] = (k[0] * S[2] + k[1] * S[4] + k[2] * S[5]) - (k[6] * S[0] + k[7] * S[1] + k[8] * S[2]);
    n[2] = (k[3] * S[0] + k[4] * S[1] + k[5] * S[2]) - (k[0] * S[1] + k[1] * S[3] + k[2] * S[4]);
    vec3_cross_add(n, s, f);
}

/* carry and newton_euler at rest: al and a alone, with al~ for K. */
enum {
    CARRY_AT_REST_FLOP = MAT3_VEC_FLOP + 1 + VEC3_CROSS_ADD_FLOP + MAT3_VEC_FLOP,
    NEWTON_EULER_AT_REST_FLOP = VEC3_CROSS_ADD_FLOP + VEC3_SCALE_FLOP + 21 + VEC3_CROSS_ADD_FLOP
};
/* Nothing turns: only accelerations are carried. */
static inline void carry_at_rest(const struct revolute *b, const real *r, real ud,
                                 const struct motion *p, struct motion *c)
{
    real g[3];
    mat3_mul_vec_transposed(c->al, r, p->al);
    c->al[2] += ud;
    vec3_copy(g, p->a);
    vec3_cross_add(g, p->al, b->t);
    mat3_mul_vec_transposed(c->a, r, g);
}

/* Nor are there centripetal terms. */
static inline void newton_euler_at_rest(const struct revolute *b, const struct motion *c, real *f,
                                        real *n)
{
    const real *s = b->s, *S = b->second, *al = c->al;
    real g[3];
    vec3_copy(g, c->a);
    vec3_cross_add(g, al, s);
    vec3_scale(f, b->m, g);
    n[0] = (al[0] * S[3] - al[1] * S[1]) - (al[2] * S[2] - al[0] * S[5]);
    n[1] = (al[1] * S[5] - al[2] * S[4]) - (al[0] * S[1] - al[1] * S[0]);
    n[2] = (al[2] * S[0] - al[0] * S[2]) - (al[1] * S[4] - al[2] * S[3]);
    vec3_cross_add(n, s, f);
}

/* f, n of the parent += r f, r n + t x r f. */
enum { HAND_DOWN_FLOP = 2 * MAT3_VEC_FLOP + 2 * VEC3_ADD_FLOP + VEC3_CROSS_ADD_FLOP };
static inline void hand_down(const struct revolute *b, const struct load *c, struct load *p)
{
    real f[3], n[3];
    mat3_mul_vec(f, c->r, c->f);
    mat3_mul_vec(n, c->r, c->n);
    vec3_add(p->f, f);
    vec3_cross_add(n, b->t, f);
    vec3_add(p->n, n);
}

/* Where the sweeps of a chain or tree lay their records: arrays over all bodies, of which those of
 * a part are touched. */
struct sweep {
    real *sine, *cosine;
    struct load *load;
    struct motion *motion;
    unsigned slots;
};

static struct sweep sweep_of(const struct dynamics *d)
{
    const int n = d->nbody;
    struct sweep s = {.sine = d->scratch, .cosine = d->scratch + n};
    s.load = (struct load *)(s.cosine + n);
    s.motion = (struct motion *)(s.load + n);
    /* a chain needs only the last body's motion: two slots */
    s.slots = d->model->is_chain ? 1u : ~0u;
    return s;
}

/* The base has no velocity, only an acceleration with -g in it (physics 1.6). */
static struct motion base_of(const struct dynamics *d, bool at_rest)
{
    struct motion base = {{0}, {0}, {0}, {0}};
    vec3_copy(base.al, d->base);
    vec3_copy(base.a, d->base + 3);
    if (!at_rest) mat3_skew(base.k, base.al);
    return base;
}

/* All angles in one loop that compilers turn into vectors. */
static void angles(const struct dynamics *d, const struct sweep *s, const real *q)
{
    const int first = d->model->first, n = d->model->end - first;
    angle_sincos_batch(n, q + first, s->sine + first, s->cosine + first);
}

/* Base to tip; `before`: of the base, or of the body before a part. Called with a constant
 * `at_rest`, so that each case is compiled alone. */
static inline void sweep_up(struct dynamics *d, const struct sweep *s, bool at_rest,
                            const struct motion *before, const real *u, const real *ud)
{
    const int first = d->model->first, end = d->model->end;
    for (int i = first; i < end; i++) {
        const struct revolute *b = &d->revolute[i];
        const struct motion *p =
            b->parent < first ? before : &s->motion[(unsigned)b->parent & s->slots];
        struct motion *c = &s->motion[(unsigned)i & s->slots];
        struct load *load = &s->load[i];
        mat3_turn_z(load->r, b->e, s->sine[i], s->cosine[i]);
        if (at_rest) {
            carry_at_rest(b, load->r, ud[i], p, c);
            newton_euler_at_rest(b, c, load->f, load->n);
        } else {
            carry(b, load->r, u[i], ud[i], p, c);
            newton_euler(b, c, load->f, load->n);
        }
        if (d->load) {
            vec3_sub(load->n, d->load + 6 * i);
            vec3_sub(load->f, d->load + 6 * i + 3);
        }
    }
}

/* (2.4), (2.5): tip to base; the joint takes the moment about its z. */
static inline void sweep_down(const struct dynamics *d, const struct sweep *s, real *tau)
{
    const int first = d->model->first;
    for (int i = d->model->end - 1; i >= first; i--) {
        const struct revolute *b = &d->revolute[i];
        tau[i] = s->load[i].n[2];
        if (b->parent >= first) hand_down(b, &s->load[i], &s->load[b->parent]);
    }
}

/* Two cases compiled apart, at rest and in motion. */
static void up(struct dynamics *d, const struct sweep *s, const struct motion *before,
               const real *u, const real *ud)
{
    if (d->at_rest) sweep_up(d, s, true, before, u, ud);
    else sweep_up(d, s, false, before, u, ud);
}

static void count(const struct dynamics *d, struct work *w)
{
    const int body = d->at_rest ? MAT3_TURN_FLOP + CARRY_AT_REST_FLOP + NEWTON_EULER_AT_REST_FLOP
                                : MAT3_TURN_FLOP + CARRY_FLOP + NEWTON_EULER_FLOP;
    const int load = d->load ? SCREW_ADD_FLOP : 0;
    revolute_count(d, (struct revolute_cost){.body = body + load, .child = HAND_DOWN_FLOP}, w);
}

void rnea_revolute(struct dynamics *d, const real *q, const real *u, const real *ud, real *tau,
                   struct work *w)
{
    const struct sweep s = sweep_of(d);
    const struct motion base = base_of(d, d->at_rest);
    angles(d, &s, q);
    up(d, &s, &base, u, ud);
    sweep_down(d, &s, tau);
    count(d, w);
}

/* --- a part of a chain ------------------------------------------------------------------------ */

/* What crosses an end, as doubles: a motion, and the force and moment of a load. */
enum { MOTION_NUMBERS = sizeof(struct motion) / sizeof(real), LOAD_NUMBERS = 6 };

static bool take_motion(const struct part_ends *ends, struct motion *m)
{
    double x[MOTION_NUMBERS];
    real *to = (real *)m;
    if (!ends->take(ends->context, false, x, MOTION_NUMBERS)) return false;
    for (int k = 0; k < MOTION_NUMBERS; k++) to[k] = (real)x[k];
    return true;
}

static bool give_motion(const struct part_ends *ends, const struct motion *m)
{
    double x[MOTION_NUMBERS];
    const real *from = (const real *)m;
    for (int k = 0; k < MOTION_NUMBERS; k++) x[k] = (double)from[k];
    return ends->give(ends->context, true, x, MOTION_NUMBERS);
}

/* What hand_down adds to a body in another part. */
static bool give_load(const struct part_ends *ends, const struct revolute *b, const struct load *c)
{
    real part[LOAD_NUMBERS];
    double x[LOAD_NUMBERS];
    mat3_mul_vec(part, c->r, c->f);
    mat3_mul_vec(part + 3, c->r, c->n);
    vec3_cross_add(part + 3, b->t, part);
    for (int k = 0; k < LOAD_NUMBERS; k++) x[k] = (double)part[k];
    return ends->give(ends->context, false, x, LOAD_NUMBERS);
}

static bool take_load(const struct part_ends *ends, struct load *p)
{
    double x[LOAD_NUMBERS];
    if (!ends->take(ends->context, true, x, LOAD_NUMBERS)) return false;
    for (int k = 0; k < 3; k++) {
        p->f[k] += (real)x[k];
        p->n[k] += (real)x[3 + k];
    }
    return true;
}

bool rnea_revolute_part(struct dynamics *d, const real *q, const real *u, const real *ud,
                        const struct part_ends *ends, real *tau, struct work *w)
{
    const struct model *m = d->model;
    const struct sweep s = sweep_of(d);
    const int last = m->end - 1;
    struct motion before = base_of(d, d->at_rest);
    angles(d, &s, q); /* while the others are not yet here */
    if (m->first > 0 && !take_motion(ends, &before)) return false;
    up(d, &s, &before, u, ud);
    if (m->end < m->nbody && !(give_motion(ends, &s.motion[(unsigned)last & s.slots]) &&
                               take_load(ends, &s.load[last])))
        return false;
    sweep_down(d, &s, tau);
    count(d, w);
    return m->first == 0 || give_load(ends, &d->revolute[m->first], &s.load[m->first]);
}

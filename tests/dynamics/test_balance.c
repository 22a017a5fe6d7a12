/* test_balance.c - motion and forces against what they mean: differences in time, Newton's and
 * Euler's laws body by body in the world, energy, and the equations of closed chains themselves. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "dynamics/dynamics_table.h"
#include "dynamics/integrate.h"
#include "dynamics/loops.h"
#include "dynamics/system.h"
#include "scene.h"

static const struct dynamics_type *exact(void) { return dynamics_type_of(PRECISION_DOUBLE); }

/* ---- vectors of the test's own ---- */

static void cross(double *x, const double *a, const double *b)
{
    const double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]};
    memcpy(x, c, sizeof c);
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* x = R a, R row-major. */
static void turn(double *x, const double *r, const double *a)
{
    const double c[3] = {dot(r, a), dot(r + 3, a), dot(r + 6, a)};
    memcpy(x, c, sizeof c);
}

/* x = R^T a */
static void turn_back(double *x, const double *r, const double *a)
{
    double c[3];
    for (int k = 0; k < 3; k++) c[k] = r[k] * a[0] + r[3 + k] * a[1] + r[6 + k] * a[2];
    memcpy(x, c, sizeof c);
}

/* x += f a */
static void add(double *x, double f, const double *a)
{
    for (int k = 0; k < 3; k++) x[k] += f * a[k];
}

/* A symmetric matrix, packed as in body_def, in body axes, times a vector in world axes. */
static void inertia_times(double *x, const double *r, const double *j, const double *a)
{
    double b[3];
    turn_back(b, r, a);
    const double c[3] = {j[0] * b[0] + j[1] * b[1] + j[2] * b[2],
                         j[1] * b[0] + j[3] * b[1] + j[4] * b[2],
                         j[2] * b[0] + j[4] * b[1] + j[5] * b[2]};
    turn(x, r, c);
}

/* What dynamics_type.kinematics gives for a body. */
struct pose {
    double r[9], p[3], v[3], w[3], a[3], alpha[3];
};
_Static_assert(sizeof(struct pose) == POSE_NUMBERS * sizeof(double), "as the table says");

static struct pose *poses_of(struct scene *s, const struct state *state)
{
    struct pose *pose = TAKE(s->a, s->model->nbody, struct pose);
    exact()->kinematics(s->model, state, s->a, &pose[0].r[0]);
    return pose;
}

/* Centre of mass, its velocity and acceleration, in the world. */
static void centre(const struct body_def *b, const struct pose *x, double *c, double *v, double *a)
{
    double s[3], t[3];
    turn(s, x->r, b->com);
    memcpy(c, x->p, sizeof s);
    add(c, 1, s);
    cross(t, x->w, s);
    memcpy(v, x->v, sizeof s);
    add(v, 1, t);
    cross(t, x->w, t);
    memcpy(a, x->a, sizeof s);
    add(a, 1, t);
    cross(t, x->alpha, s);
    add(a, 1, t);
}

/* Trees of every joint type on fixed and floating bases; the state has its accelerations. */
static void on_trees(void (*law)(struct scene *), double external)
{
    for (int joint = JOINT_REVOLUTE; joint <= JOINT_MIXED; joint++)
        for (uint64_t k = 1; k <= 4; k++) {
            struct model_spec spec = spec_random(k % 2 ? MODEL_RANDOM_TREE : MODEL_SERIAL_CHAIN,
                                                 4 + (int)k, (enum model_joint)joint, 10 * k);
            spec.base = k > 2 ? BASE_FLOATING : BASE_FIXED;
            spec.external_force = external;
            struct scene s = scene_of(&spec);
            assert_true(exact()->forward(s.model, s.state, FORWARD_ABA, s.a, s.state->qdd, NULL,
                                         NULL, NULL));
            law(&s);
            scene_end(&s);
        }
}

/* ---- differences in time ---- */

/* Poses at time t of the motion. */
static struct pose *poses_at(struct scene *s, double t)
{
    const struct model *m = s->model;
    struct state *x = state_take(m, s->a);
    memcpy(x->q, s->state->q, (size_t)m->nq * sizeof(double));
    memcpy(x->qd, s->state->qd, (size_t)m->nu * sizeof(double));
    memcpy(x->tau, s->state->tau, (size_t)m->nu * sizeof(double));
    assert_true(exact()->advance(m, x, STEP_RK4, t, 1, s->a, NULL));
    return poses_of(s, x);
}

/* Central differences over 2 h and over h, extrapolated: error of order h^4. */
static double slope(double low2, double low, double high, double high2, double h)
{
    return (8 * (high - low) - (high2 - low2)) / (12 * h);
}

static void velocities_are_slopes(struct scene *s)
{
    const double h = 1e-4;
    const struct pose *now = poses_of(s, s->state), *l2 = poses_at(s, -2 * h), *l = poses_at(s, -h),
                      *u = poses_at(s, h), *u2 = poses_at(s, 2 * h);
    for (int i = 0; i < s->model->nbody; i++) {
        const struct pose *x = &now[i];
        double rate = 1, size = 1;
        for (int k = 0; k < 3; k++) {
            rate = fmax(rate, fmax(fabs(x->v[k]), fabs(x->w[k])));
            size = fmax(size, fmax(fabs(x->a[k]), fabs(x->alpha[k])));
        }
        for (int k = 0; k < 3; k++) {
            /* place -> velocity -> acceleration; angular velocity -> angular acceleration */
            assert_true(fabs(slope(l2[i].p[k], l[i].p[k], u[i].p[k], u2[i].p[k], h) - x->v[k]) <
                        1e-7 * size * rate);
            assert_true(fabs(slope(l2[i].v[k], l[i].v[k], u[i].v[k], u2[i].v[k], h) - x->a[k]) <
                        1e-6 * size * rate);
            assert_true(fabs(slope(l2[i].w[k], l[i].w[k], u[i].w[k], u2[i].w[k], h) - x->alpha[k]) <
                        1e-6 * size * rate);
        }
        /* R' = w x R, column by column */
        for (int c = 0; c < 3; c++) {
            const double column[3] = {x->r[c], x->r[3 + c], x->r[6 + c]};
            double moved[3];
            cross(moved, x->w, column);
            for (int k = 0; k < 3; k++) {
                const int at = 3 * k + c;
                assert_true(fabs(slope(l2[i].r[at], l[i].r[at], u[i].r[at], u2[i].r[at], h) -
                                 moved[k]) < 1e-7 * size * rate);
            }
        }
    }
}

static void motion_is_the_slope_of_place(void **state)
{
    (void)state;
    on_trees(velocities_are_slopes, 0);
}

/* ---- Newton and Euler ---- */

/* The force on each body by its parent, and its moment about the world's origin, that the motion
 * asks for: (nbody x 6). */
static double *needed(struct scene *s, const struct pose *pose)
{
    const struct model *m = s->model;
    double *f = TAKE(s->a, 6 * m->nbody, double);
    for (int i = 6 * m->nbody - 1; i >= 0; i--) f[i] = 0;
    for (int i = m->nbody - 1; i >= 0; i--) {
        const struct body_def *b = &m->body[i];
        const struct pose *x = &pose[i];
        double c[3], v[3], a[3], spin[3], t[3], *own = f + 6 * i;
        centre(b, x, c, v, a);
        add(a, -1, m->gravity);
        /* m (a - g), and its moment; J alpha + w x J w */
        add(own, b->mass, a);
        cross(t, c, a);
        add(own + 3, b->mass, t);
        inertia_times(t, x->r, b->inertia, x->alpha);
        add(own + 3, 1, t);
        inertia_times(spin, x->r, b->inertia, x->w);
        cross(t, x->w, spin);
        add(own + 3, 1, t);
        if (s->state->fext != NULL) {
            double force[3], moment[3];
            turn(force, x->r, s->state->fext + 6 * i);
            turn(moment, x->r, s->state->fext + 6 * i + 3);
            add(own, -1, force);
            add(own + 3, -1, moment);
            cross(t, x->p, force);
            add(own + 3, -1, t);
        }
        for (int k = 0; b->parent >= 0 && k < 6; k++) f[6 * b->parent + k] += own[k];
    }
    return f;
}

static void wrenches_are_needed(struct scene *s)
{
    const struct model *m = s->model;
    const struct pose *pose = poses_of(s, s->state);
    const double *f = needed(s, pose);
    double *is = TAKE(s->a, 6 * m->nbody, double), *wanted = TAKE(s->a, 6 * m->nbody, double),
           *tau = TAKE(s->a, m->nu, double);
    exact()->wrenches(m, s->state, s->a, is);
    exact()->inverse(m, s->state, s->a, tau, NULL);
    double most = 0;
    for (int i = 0; i < m->nbody; i++) {
        double moment[3], t[3];
        memcpy(moment, f + 6 * i + 3, sizeof moment);
        cross(t, pose[i].p, f + 6 * i);
        add(moment, -1, t);
        turn_back(wanted + 6 * i, pose[i].r, f + 6 * i);
        turn_back(wanted + 6 * i + 3, pose[i].r, moment);
        /* the joint's power: of its force in the motion relative to the parent */
        static const struct pose ground = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
        const struct pose *x = &pose[i],
                          *p = m->body[i].parent >= 0 ? &pose[m->body[i].parent] : &ground;
        double v[3], w[3], arm[3];
        memcpy(v, x->v, sizeof v);
        memcpy(w, x->w, sizeof w);
        memcpy(arm, x->p, sizeof arm);
        add(arm, -1, p->p);
        cross(t, p->w, arm);
        add(v, -1, p->v);
        add(v, -1, t);
        add(w, -1, p->w);
        double power = dot(f + 6 * i, v) + dot(moment, w), scale = 0;
        for (int k = 0; k < 3; k++) scale += fabs(f[6 * i + k] * v[k]) + fabs(moment[k] * w[k]);
        for (int k = m->u_at[i]; k < m->u_at[i + 1]; k++) {
            power -= tau[k] * s->state->qd[k];
            scale += fabs(tau[k] * s->state->qd[k]);
        }
        assert_true(fabs(power) <= 1e-10 * fmax(scale, 1));
        for (int k = 0; k < 6; k++) most = fmax(most, fabs(wanted[6 * i + k]));
    }
    for (int k = 0; k < 6 * m->nbody; k++) assert_true(fabs(is[k] - wanted[k]) <= 1e-10 * most);
}

static void joints_transmit_what_bodies_below_need(void **state)
{
    (void)state;
    on_trees(wrenches_are_needed, 2);
}

/* ---- energy and momentum ---- */

static void sums_over_bodies(struct scene *s)
{
    const struct model *m = s->model;
    const struct pose *pose = poses_of(s, s->state);
    struct dynamics_totals t;
    exact()->totals(m, s->state, s->a, &t);
    double kinetic = 0, potential = 0, mass = 0, linear[3] = {0}, angular[3] = {0}, com[3] = {0};
    for (int i = 0; i < m->nbody; i++) {
        const struct body_def *b = &m->body[i];
        double c[3], v[3], a[3], spin[3], x[3];
        centre(b, &pose[i], c, v, a);
        inertia_times(spin, pose[i].r, b->inertia, pose[i].w);
        kinetic += 0.5 * (b->mass * dot(v, v) + dot(pose[i].w, spin));
        potential -= b->mass * dot(m->gravity, c);
        cross(x, c, v);
        add(linear, b->mass, v);
        add(angular, b->mass, x);
        add(angular, 1, spin);
        add(com, b->mass, c);
        mass += b->mass;
        /* springs act where a joint has one degree */
        const double stretch =
            m->u_at[i + 1] - m->u_at[i] == 1 ? s->state->q[m->q_at[i]] - b->rest : 0;
        potential += 0.5 * b->stiffness * stretch * stretch;
    }
    assert_true(fabs(t.kinetic - kinetic) <= 1e-12 * kinetic);
    assert_true(fabs(t.potential - potential) <= 1e-11 * (fabs(potential) + mass));
    assert_true(fabs(t.mass - mass) <= 1e-14 * mass);
    for (int k = 0; k < 3; k++) com[k] /= mass;
    assert_true(relative_error(3, t.com, com) < 1e-12);
    assert_true(relative_error(3, t.linear, linear) < 1e-11);
    assert_true(relative_error(3, t.angular, angular) < 1e-11);
}

static void totals_are_sums_over_bodies(void **state)
{
    (void)state;
    on_trees(sums_over_bodies, 0);
}

/* Springs take up energy and give it back, dampers take it away: dE/dt = tau . u - c u^2. */
static void springs_keep_energy_and_dampers_take_it(void **state)
{
    (void)state;
    static const enum model_joint joint[] = {JOINT_REVOLUTE, JOINT_PRISMATIC, JOINT_HELICAL};
    for (int j = 0; j < 3; j++)
        for (uint64_t seed = 1; seed <= 3; seed++) {
            struct model_spec spec = spec_random(MODEL_RANDOM_TREE, 6, joint[j], seed);
            spec.external_force = 0, spec.stiffness = 40, spec.damping = 0.7;
            struct scene s = scene_of(&spec);
            const struct model *m = s.model;
            const double h = 1e-4;
            double energy[4], power = 0, scale = 0;
            for (int k = 0; k < m->nbody; k++) m->body[k].rest = 0.3 * k;
            for (int k = 0; k < 4; k++) {
                static const int at[] = {-2, -1, 1, 2};
                struct state *x = state_take(m, s.a);
                memcpy(x->q, s.state->q, (size_t)m->nq * sizeof(double));
                memcpy(x->qd, s.state->qd, (size_t)m->nu * sizeof(double));
                memcpy(x->tau, s.state->tau, (size_t)m->nu * sizeof(double));
                assert_true(exact()->advance(m, x, STEP_RK4, at[k] * h, 1, s.a, NULL));
                struct dynamics_totals t;
                dynamics_type_of(PRECISION_QUAD)->totals(m, x, s.a, &t);
                energy[k] = t.kinetic + t.potential;
                scale = fmax(scale, fabs(t.kinetic) + fabs(t.potential));
            }
            for (int k = 0; k < m->nu; k++)
                power += (s.state->tau[k] - m->body[k].damping * s.state->qd[k]) * s.state->qd[k];
            assert_true(m->body[1].stiffness > 0 && m->body[1].damping > 0);
            assert_true(fabs(slope(energy[0], energy[1], energy[2], energy[3], h) - power) <
                        1e-7 * scale);
            scene_end(&s);
        }
}

/* ---- the base ---- */

/* A tree on a base that accelerates needs what it needs on a free body, at rest, with the same
 * acceleration; with linear acceleration alone that is gravity the other way. */
static void an_accelerated_base_is_a_body_that_moves(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        struct model_spec spec = spec_random(MODEL_RANDOM_TREE, 7, JOINT_MIXED, seed);
        struct scene s = scene_of(&spec);
        const struct model *m = s.model;
        struct err e;
        err_clear(&e);
        struct model *on = model_begin(s.a, NULL);
        struct body_def base = {.name = "base",
                                .parent = -1,
                                .joint = JOINT_FLOATING,
                                .mass = 3,
                                .com = {0.1, 0.2, 0.3},
                                .inertia = {1, 0, 0, 1, 0, 1}};
        assert_int_equal(model_add_body(on, &base, &e), 0);
        for (int i = 0; i < m->nbody; i++) {
            struct body_def b = m->body[i];
            b.parent++;
            assert_true(model_add_body(on, &b, &e) >= 0);
        }
        memcpy(on->gravity, m->gravity, sizeof on->gravity);
        assert_true(model_finish(on, false, &e));
        struct state *x = state_take(on, s.a);
        memcpy(x->q + 7, s.state->q, (size_t)m->nq * sizeof(double));
        memcpy(x->qd + 6, s.state->qd, (size_t)m->nu * sizeof(double));
        memcpy(x->qdd + 6, s.state->qdd, (size_t)m->nu * sizeof(double));
        memcpy(state_fext_need(x, on, s.a) + 6, s.state->fext,
               (size_t)m->nbody * 6 * sizeof(double));
        for (int k = 0; k < 3; k++) {
            s.state->base_acceleration[k] = seed > 1 ? 0.7 * (k + 1) : 0;
            s.state->base_acceleration[3 + k] = 2 - 1.5 * k;
            x->qdd[k] = s.state->base_acceleration[3 + k];
            x->qdd[3 + k] = s.state->base_acceleration[k];
        }
        double *tau = TAKE(s.a, on->nu, double), *wanted = TAKE(s.a, on->nu, double);
        exact()->inverse(on, x, s.a, wanted, NULL);
        exact()->inverse(m, s.state, s.a, tau, NULL);
        assert_true(relative_error(m->nu, tau, wanted + 6) < 1e-12);
        if (seed == 1) {
            add(s.model->gravity, -1, s.state->base_acceleration + 3);
            memset(s.state->base_acceleration, 0, sizeof s.state->base_acceleration);
            exact()->inverse(m, s.state, s.a, tau, NULL);
            assert_true(relative_error(m->nu, tau, wanted + 6) < 1e-12);
        }
        scene_end(&s);
    }
}

/* ---- closed chains ---- */

/* Two loops between bodies of a tree: by a joint and by rows, or both by rows. */
static struct scene closed_tree(enum model_joint joint, uint64_t seed)
{
    struct model_spec spec = spec_random(MODEL_RANDOM_TREE, 9, JOINT_MIXED, seed);
    struct scene s = {.a = arena_create()};
    struct err e;
    err_clear(&e);
    struct model *tree = model_build(&spec, s.a, &e), *m = model_begin(s.a, NULL);
    for (int i = 0; i < tree->nbody; i++) assert_true(model_add_body(m, &tree->body[i], &e) >= 0);
    struct loop_def l = {.name = "joint",
                         .body_a = -1,
                         .body_b = 8,
                         .joint = joint,
                         .alpha = seed % 2 ? 3 : 0,
                         .beta = seed % 2 ? 5 : 0};
    l.frame_a = (struct frame){{0.1, 0.2, -0.3, 0.9}, {0.3, 0.1, 0.2}};
    l.frame_b = (struct frame){{-0.4, 0.1, 0.5, 0.6}, {0.5, -0.1, 0.1}};
    assert_true(model_add_loop(m, &l, &e) >= 0);
    l.body_a = 2, l.body_b = 7, l.nrow = 2;
    memcpy(l.row, (double[6][6]){{1, 0.5, 0, 0.2, 0, 0}, {0, 0.3, -1, 0, 0.7, 0.4}}, sizeof l.row);
    assert_true(model_add_loop(m, &l, &e) >= 0);
    memcpy(m->gravity, spec.gravity, sizeof spec.gravity);
    if (!model_finish(m, false, &e)) fail_msg("%s", e.text);
    s.model = m;
    s.state = state_make(m, &spec, s.a);
    return s;
}

/* J (nrow x nu): the loops' velocities at unit rates, one after the other. */
static double *jacobian(struct scene *s, struct dynamics *d)
{
    const int n = s->model->nu, r = s->model->nrow;
    double *j = TAKE(s->a, n * r, double), *u = TAKE(s->a, n, double), *rho = TAKE(s->a, r, double);
    for (int k = 0; k < n; k++) {
        for (int i = 0; i < n; i++) u[i] = i == k;
        loop_drift(d, s->state->q, u, NULL, rho);
        for (int i = 0; i < r; i++) j[i * n + k] = rho[i];
    }
    return j;
}

/* M u' + xi = tau + J^T lambda, with M and xi of the open chain; and S = J M^-1 J^T. */
static void closed_chains_obey_their_equations(void **state)
{
    (void)state;
    static const enum model_joint joint[] = {JOINT_REVOLUTE, JOINT_SPHERICAL, JOINT_PRISMATIC,
                                             JOINT_PLANAR, JOINT_CYLINDRICAL};
    for (uint64_t k = 0; k < 10; k++) {
        struct scene s = closed_tree(joint[k % 5], k + 1);
        const struct model *m = s.model;
        const int n = m->nu, r = m->nrow;
        struct dynamics *d = dynamics_take(m, s.a);
        dynamics_load(d, s.state);
        const double *j = jacobian(&s, d);
        double *mass = TAKE(s.a, n * n, double), *xi = TAKE(s.a, n, double),
               *ud = TAKE(s.a, n, double), *lambda = TAKE(s.a, r, double),
               *x = TAKE(s.a, n * r, double), *sm = TAKE(s.a, r * r, double);
        struct work w = {0};
        crba(d, s.state->q, mass, &w);
        rnea(d, s.state->q, s.state->qd, d->zero, xi, &w);
        for (int method = FORWARD_ABA; method < FORWARD_METHODS; method++) {
            assert_true(exact()->forward(m, s.state, (enum forward_method)method, s.a, ud, lambda,
                                         NULL, NULL));
            for (int i = 0; i < n; i++) {
                double left = xi[i] - s.state->tau[i], scale = fabs(xi[i]);
                for (int c = 0; c < n; c++)
                    left += mass[i * n + c] * ud[c], scale += fabs(mass[i * n + c] * ud[c]);
                for (int c = 0; c < r; c++)
                    left -= j[c * n + i] * lambda[c], scale += fabs(j[c * n + i] * lambda[c]);
                assert_true(fabs(left) <= 1e-7 * scale);
            }
        }
        struct loops l;
        dynamics_place(d, s.state->q);
        dynamics_velocities(d, s.state->qd);
        loops_take(d, &l, &w);
        assert_int_equal(l.nrow, r);
        assert_true(loops_respond(d, &l, x, (size_t)n, sm, &w));
        for (int a = 0; a < r; a++) {
            /* M x_a = J^T e_a */
            for (int i = 0; i < n; i++) {
                double left = -j[a * n + i], scale = fabs(left);
                for (int c = 0; c < n; c++)
                    left += mass[i * n + c] * x[a * n + c],
                        scale += fabs(mass[i * n + c] * x[a * n + c]);
                assert_true(fabs(left) <= 1e-9 * fmax(scale, 1));
            }
            for (int b = 0; b < r; b++) {
                double sum = 0, scale = 1;
                for (int c = 0; c < n; c++)
                    sum += j[b * n + c] * x[a * n + c], scale += fabs(j[b * n + c] * x[a * n + c]);
                assert_true(fabs(sm[a * r + b] - sum) <= 1e-10 * scale);
                assert_true(sm[a * r + b] == sm[b * r + a]);
            }
        }
        scene_end(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(motion_is_the_slope_of_place),
        cmocka_unit_test(joints_transmit_what_bodies_below_need),
        cmocka_unit_test(totals_are_sums_over_bodies),
        cmocka_unit_test(springs_keep_energy_and_dampers_take_it),
        cmocka_unit_test(an_accelerated_base_is_a_body_that_moves),
        cmocka_unit_test(closed_chains_obey_their_equations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

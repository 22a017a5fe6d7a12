/* stability_scene.c - the suite's scenes: chains, trees and loops made extreme in one way each. */
#include "study/stability_scene.h"

#include <math.h>
#include <string.h>

#include "base/random.h"
#include "dynamics/system.h"
#include "model/pose.h"

/* What is not said: unit rods on revolute joints under gravity, joint rates and forces of order
 * one. Poses: straight in a plane, coiled in space, straight with twisted axes; and a short chain
 * of stiff springs. */
#define CHAIN(n) .nbody = (n)
#define COIL(n) .nbody = (n), .pose = POSE_COILED, .axes = AXES_TWISTED
#define TWIST(n) .nbody = (n), .pose = POSE_STRAIGHT, .axes = AXES_TWISTED
#define STIFF(k, c) COIL(4), .stiffness = (k), .damping = (c)

/* Each scene is extreme in one way: masses, lengths and units, poses, sizes, rates, points,
 * forces, bases and joints, trees, loops, denormal numbers, springs. */
static const struct stability_scene scenes[] = {
    {.name = "mass even", .spec = {COIL(64)}},
    {.name = "mass heavy tip 1e6", .spec = {COIL(64)}, .spread = SPREAD_HEAVY_TIP, .ratio = 1e6},
    {.name = "mass heavy tip 1e12", .spec = {COIL(64)}, .spread = SPREAD_HEAVY_TIP, .ratio = 1e12},
    {.name = "mass light tip 1e6", .spec = {COIL(64)}, .spread = SPREAD_LIGHT_TIP, .ratio = 1e6},
    {.name = "mass light tip 1e12", .spec = {COIL(64)}, .spread = SPREAD_LIGHT_TIP, .ratio = 1e12},
    {.name = "mass graded up 1e6", .spec = {COIL(64)}, .spread = SPREAD_UP, .ratio = 1e6},
    {.name = "mass graded down 1e6", .spec = {COIL(64)}, .spread = SPREAD_DOWN, .ratio = 1e6},
    {.name = "mass graded up 1e12", .spec = {COIL(64)}, .spread = SPREAD_UP, .ratio = 1e12},
    {.name = "mass graded down 1e12", .spec = {COIL(64)}, .spread = SPREAD_DOWN, .ratio = 1e12},
    {.name = "mass random 1e6", .spec = {COIL(64)}, .spread = SPREAD_RANDOM, .ratio = 1e6},
    {.name = "mass random 1e12", .spec = {COIL(64)}, .spread = SPREAD_RANDOM, .ratio = 1e12},
    {.name = "mass alternating 1e2",
     .spec = {COIL(64)},
     .spread = SPREAD_ALTERNATING,
     .ratio = 1e2},
    {.name = "mass alternating 1e6",
     .spec = {COIL(64)},
     .spread = SPREAD_ALTERNATING,
     .ratio = 1e6},
    {.name = "mass alternating 1e8",
     .spec = {COIL(64)},
     .spread = SPREAD_ALTERNATING,
     .ratio = 1e8},
    {.name = "mass alternating 1e12",
     .spec = {COIL(64)},
     .spread = SPREAD_ALTERNATING,
     .ratio = 1e12},
    {.name = "mass light base 1e12",
     .spec = {COIL(64)},
     .spread = SPREAD_LIGHT_BASE,
     .ratio = 1e12},
    /* units: nothing may depend on metres and kilograms */
    {.name = "length 1e-10 m", .spec = {COIL(64), .length = 1e-10, .radius = 5e-12}},
    {.name = "length 1e3 m", .spec = {COIL(64), .length = 1e3, .radius = 50}},
    {.name = "molecular SI",
     .spec = {COIL(64), .length = 1.5e-10, .radius = 1e-11, .mass = 2.3e-26}},
    {.name = "molecular amu",
     .spec = {COIL(64), .generator = MODEL_POLYMER, .torque = 1e-21, .rate = 1e11}},
    /* poses in which columns of the mass matrix become alike */
    {.name = "pose straight planar", .spec = {CHAIN(64)}},
    {.name = "pose nearly straight", .spec = {CHAIN(64)}, .nudge = 1e-8},
    {.name = "pose straight twisted", .spec = {TWIST(64)}},
    {.name = "pose folded", .spec = {CHAIN(64), .pose = POSE_FOLDED}},
    {.name = "pose nearly folded", .spec = {CHAIN(64), .pose = POSE_FOLDED}, .nudge = 1e-8},
    /* sizes, with odd ones, as cyclic reduction halves them */
    {.name = "n 1", .spec = {COIL(1)}},
    {.name = "n 2", .spec = {COIL(2)}},
    {.name = "n 3", .spec = {COIL(3)}},
    {.name = "n 45", .spec = {COIL(45)}},
    {.name = "n 127", .spec = {COIL(127)}},
    {.name = "n 1024", .spec = {COIL(1024)}},
    {.name = "n 1024 twisted", .spec = {TWIST(1024)}},
    {.name = "n 1024 planar", .spec = {CHAIN(1024)}},
    {.name = "n 4096", .spec = {COIL(4096)}},
    {.name = "n 4096 twisted", .spec = {TWIST(4096)}},
    {.name = "n 4096 torsion",
     .spec = {COIL(4096), .generator = MODEL_POLYMER, .torque = 1e-21, .rate = 1e11}},
    {.name = "n 65536", .spec = {COIL(65536)}},
    /* forces that differ by many orders, and inertias near zero */
    {.name = "rates 1e3 rad/s", .spec = {COIL(64), .rate = 1e3}},
    {.name = "rates 1e6 rad/s", .spec = {COIL(64), .rate = 1e6}},
    {.name = "slender rods", .spec = {COIL(64), .radius = 1e-6}},
    {.name = "nearly points", .spec = {COIL(64)}, .point = 1e-12},
    {.name = "torques 1e12 N m", .spec = {COIL(64), .torque = 1e12}},
    {.name = "nearly points 1e-6", .spec = {COIL(64)}, .point = 1e-6},
    {.name = "zero gravity at rest", .spec = {COIL(64)}, .weightless = true, .at_rest = true},
    {.name = "zero gravity", .spec = {COIL(64)}, .weightless = true},
    /* bases, joints and trees */
    {.name = "free-floating", .spec = {COIL(64), .base = BASE_FLOATING}},
    {.name = "free-floating 1e6",
     .spec = {COIL(64), .base = BASE_FLOATING, .inertia = INERTIA_RANDOM, .mass_ratio = 1e6}},
    {.name = "spherical joints", .spec = {COIL(64), .joint = JOINT_SPHERICAL}},
    {.name = "star of 64", .spec = {COIL(64), .generator = MODEL_STAR}},
    {.name = "comb of 64", .spec = {COIL(64), .generator = MODEL_COMB, .branch = 4}},
    {.name = "dendrimer of 127", .spec = {COIL(127), .generator = MODEL_DENDRIMER, .branch = 2}},
    {.name = "star of 1024", .spec = {COIL(1024), .generator = MODEL_STAR}},
    {.name = "dendrimer of 1023", .spec = {COIL(1023), .generator = MODEL_DENDRIMER, .branch = 2}},
    {.name = "random tree 1e6",
     .spec = {COIL(64), .generator = MODEL_RANDOM_TREE, .inertia = INERTIA_RANDOM,
              .mass_ratio = 1e6}},
    /* loops: singular, nearly singular, redundant */
    {.name = "four-bar at its singularity",
     .spec = {CHAIN(3), .generator = MODEL_FOUR_BAR, .gravity = {0, -9.81, 0}}},
    {.name = "four-bar near 1e-3",
     .spec = {CHAIN(3), .generator = MODEL_FOUR_BAR, .gravity = {0, -9.81, 0}},
     .nudge = 1e-3},
    {.name = "four-bar near 1e-6",
     .spec = {CHAIN(3), .generator = MODEL_FOUR_BAR, .gravity = {0, -9.81, 0}},
     .nudge = 1e-6},
    {.name = "redundant ring of 5",
     .spec = {CHAIN(5), .generator = MODEL_RING, .gravity = {0, -9.81, 0}}},
    {.name = "redundant ring of 63",
     .spec = {CHAIN(63), .generator = MODEL_RING, .gravity = {0, -9.81, 0}}},
    /* numbers at the lower end of double */
    {.name = "denormal masses 1e-308", .spec = {COIL(16), .mass = 1e-308, .torque = 1e-308}},
    {.name = "denormal torques",
     .spec = {COIL(16), .torque = 1e-310},
     .weightless = true,
     .at_rest = true},
    /* stiff springs: frequencies of sqrt(stiffness / inertia) */
    {.name = "springs 1e2 undamped", .spec = {STIFF(1e2, 0)}, .moves = true},
    {.name = "springs 1e4 undamped", .spec = {STIFF(1e4, 0)}, .moves = true},
    {.name = "springs 1e6 undamped", .spec = {STIFF(1e6, 0)}, .moves = true},
    {.name = "springs 1e8 undamped", .spec = {STIFF(1e8, 0)}, .moves = true},
    {.name = "springs 1e8 in 64 joints", .spec = {COIL(64), .stiffness = 1e8}},
    {.name = "springs 1e2 damped", .spec = {STIFF(1e2, 1)}, .moves = true},
    {.name = "springs 1e4 damped", .spec = {STIFF(1e4, 1e2)}, .moves = true},
    {.name = "springs 1e6 damped", .spec = {STIFF(1e6, 1e4)}, .moves = true},
    {.name = "springs 1e8 damped", .spec = {STIFF(1e8, 1e6)}, .moves = true},
};

const struct stability_scene *scene_list(int *n)
{
    *n = (int)(sizeof scenes / sizeof *scenes);
    return scenes;
}

/* Mass of body i of n over the generated one; c->ratio is that of the largest to the smallest. */
static double mass_factor(const struct stability_scene *c, int i, int n)
{
    struct random r = random_make(1, STREAM_INERTIA, (uint64_t)i);
    switch (c->spread) {
    case SPREAD_HEAVY_TIP: return i == n - 1 ? c->ratio : 1;
    case SPREAD_LIGHT_TIP: return i == n - 1 ? 1 / c->ratio : 1;
    case SPREAD_LIGHT_BASE: return i == 0 ? 1 / c->ratio : 1;
    case SPREAD_UP: return pow(c->ratio, (double)i / (n - 1) - 1); /* the heaviest weighs 1 */
    case SPREAD_DOWN: return pow(c->ratio, -(double)i / (n - 1));
    case SPREAD_RANDOM: return pow(c->ratio, random_uniform(&r, -0.5, 0.5));
    case SPREAD_ALTERNATING:
        return i % 2 ? 1 : 1 / c->ratio; /* the tip heavy, or its acceleration hides all others */
    case SPREAD_EVEN: break;
    }
    return 1;
}

/* The generated model with its masses and inertias changed; the model itself when nothing is to
 * change. A new model with the same joints; kinematic loops do not occur in the scenes that are
 * reshaped. */
static struct model *reshape(const struct stability_scene *c, struct model *m, struct arena *a,
                             struct err *e)
{
    double point = c->point > 0 ? c->point : 1;
    /* Nothing to change: the generator's model, with its loops. */
    if (c->spread == SPREAD_EVEN && point == 1) return m;
    struct model *x = model_begin(a, NULL);
    memcpy(x->gravity, m->gravity, sizeof x->gravity);
    x->metre = m->metre, x->kilogram = m->kilogram, x->second = m->second;
    for (int i = 0; i < m->nbody; i++) {
        struct body_def b = m->body[i];
        double f = mass_factor(c, i, m->nbody);
        /* Mass and inertia by the same factor; `point` shrinks the inertia alone. */
        b.mass *= f;
        for (int k = 0; k < 6; k++) b.inertia[k] *= f * point;
        if (model_add_body(x, &b, e) < 0) return NULL;
    }
    return model_finish(x, false, e) ? x : NULL;
}

/* The spec with what its scene does not say: rods of 1 m and 1 kg on revolute joints, gravity
 * along -z (planar loops say theirs), torques and rates of order one. */
static struct model_spec complete(const struct stability_scene *c)
{
    struct model_spec x = c->spec;
    if (c->complete) return x;
    if (x.joint == JOINT_FIXED) x.joint = JOINT_REVOLUTE;
    if (x.length == 0) x.length = 1;
    if (x.radius == 0) x.radius = 0.05;
    if (x.mass == 0) x.mass = 1;
    if (x.mass_ratio == 0) x.mass_ratio = 1;
    if (x.torque == 0) x.torque = 1;
    if (x.rate == 0 && !c->at_rest) x.rate = 1;
    if (x.gravity[1] == 0 && !c->weightless) x.gravity[2] = -9.81;
    x.seed = 1;
    return x;
}

/* Model, then reshaped masses, then state, then the pose moved. */
bool scene_build(const struct stability_scene *c, struct arena *a, struct model **m,
                 struct state **s, struct err *e)
{
    struct model_spec spec = complete(c);
    *m = model_build(&spec, a, e);
    if (*m) *m = reshape(c, *m, a, e);
    if (!*m) return false;
    /* Spatial inertias and their inverses follow from the changed masses. */
    system_prepare(*m);
    *s = state_make(*m, &spec, a);
    for (int i = 0; i < (*m)->nq && c->nudge != 0; i++) (*s)->q[i] += i % 2 ? -c->nudge : c->nudge;
    /* springs pull from where the pose would be anyway: give them something to do */
    for (int i = 0; i < (*m)->nq && c->moves; i++) (*s)->q[i] += 0.01 * (1 + i % 3);
    return true;
}

/* generator.c - rods, trees of rods, rings, the four-bar linkage and polymer chains. */
#include "model/generator.h"

#include <math.h>
#include <stdio.h>

#include "linalg/angle.h"
#include "model/model_part.h"
#include "model/pose.h"

#define PI 3.14159265358979323846

/* Parent of body i in the tree that the generator names. */
static int parent_of(const struct model_spec *spec, int i, struct random *r)
{
    /* A parent always has the smaller number, so that sweeps need no order of their own. */
    int branch = spec->branch > 0 ? spec->branch : 2;
    /* The first body hangs at the base in every tree. */
    if (i == 0) return -1;
    switch (spec->generator) {
    /* Bodies 0, b, 2b, ... are the spine; those between are teeth on the spine body before them. */
    case MODEL_COMB: return i % branch == 0 ? i - branch : i - i % branch;
    case MODEL_STAR: return 0;
    case MODEL_DENDRIMER: return (i - 1) / branch;
    case MODEL_RANDOM_TREE: return (int)random_below(r, (uint64_t)i);
    default: return i - 1;
    }
}

/* Drawn after the parent and from the same stream: the order of the two calls is part of what a
 * seed means. A floating base is the joint of body 0, whatever the others are. */
static enum model_joint joint_of(const struct model_spec *spec, int i, struct random *r)
{
    if (i == 0 && spec->base == BASE_FLOATING) return JOINT_FLOATING;
    return spec->joint == JOINT_MIXED ? (enum model_joint)random_below(r, JOINT_MIXED)
                                      : spec->joint;
}

/* A uniform rod along x from the origin. */
static void rod(struct body_def *b, double length, double radius, double mass)
{
    /* A solid cylinder: m r^2 / 2 about its axis, m (l^2 / 12 + r^2 / 4) across it. */
    b->mass = mass;
    b->com[0] = 0.5 * length;
    b->inertia[0] = 0.5 * mass * radius * radius;
    b->inertia[3] = b->inertia[5] = mass * (length * length / 12 + radius * radius / 4);
}

/* A body of random shape about the rod's size: second moments along random axes, so that it is
 * always physical. */
static void random_body(const struct model_spec *spec, int i, struct body_def *b)
{
    struct random r = random_make(spec->seed, STREAM_INERTIA, (uint64_t)i);
    double length = spec->length, moment[3][3] = {{0}}, trace = 0;
    b->mass = spec->mass * pow(spec->mass_ratio, random_uniform(&r, -0.5, 0.5));
    b->com[0] = length * random_uniform(&r, 0.3, 0.7);
    for (int k = 1; k < 3; k++) b->com[k] = 0.1 * length * random_uniform(&r, -1, 1);
    /* Second moments M of mass, a sum of outer products. Each vector leans to an axis of its
     * own, so that the three are seldom near a plane. */
    for (int k = 0; k < 3; k++) { /* sum of outer products of three random vectors */
        double x[3];
        for (int j = 0; j < 3; j++) x[j] = 0.3 * length * random_uniform(&r, -1, 1);
        x[k] += 0.2 * length;
        for (int j = 0; j < 9; j++) moment[j / 3][j % 3] += b->mass * x[j / 3] * x[j % 3];
    }
    /* J = tr(M) U - M keeps the triangle inequality for every such M: no draw is thrown away. */
    for (int k = 0; k < 3; k++) trace += moment[k][k];
    b->inertia[0] = trace - moment[0][0], b->inertia[3] = trace - moment[1][1],
    b->inertia[5] = trace - moment[2][2];
    b->inertia[1] = -moment[0][1], b->inertia[2] = -moment[0][2], b->inertia[4] = -moment[1][2];
}

/* Axes of the joint types: z, x, or x and y. */
static void axes_of(struct body_def *b)
{
    b->axis[joint_has(b->joint, JOINT_ALONG_X) ? 0 : 2] = 1;
    if (joint_has(b->joint, JOINT_TWO_AXES)) b->axis2[1] = 1;
}

/* Twisted axes: about the rod for chains, any rotation where bodies branch. */
static void placement_of(const struct model_spec *spec, struct body_def *b, struct random *r)
{
    /* The joint frame sits at the end of the parent's rod. */
    b->placement.quat[3] = 1;
    b->placement.p[0] = b->parent >= 0 ? spec->length : 0;
    if (spec->axes != AXES_TWISTED) return;
    if (spec->generator == MODEL_SERIAL_CHAIN) {
        /* Half of any turn about x. The rods of a straight pose stay in one line. */
        angle_sincos(random_uniform(r, -0.5 * PI, 0.5 * PI), &b->placement.quat[0],
                     &b->placement.quat[3]);
    } else {
        pose_quaternion(r, b->placement.quat);
    }
}

/* Springs rest where the scene starts: the stream is that of the pose (state.c). */
static void springs_of(const struct model *m, const struct model_spec *spec, int i, double length,
                       struct body_def *b)
{
    if (joint_nu(b->joint) != 1 || (spec->stiffness == 0 && spec->damping == 0)) return;
    /* From SI to the model's own units: stiffness is kg m^2 / s^2 a radian, and kg / s^2 where the
     * joint slides; a damping is one times s. */
    const bool slides = joint_is_linear(b->joint, 0);
    const double area = slides ? 1 : m->metre * m->metre,
                 unit = m->kilogram * area / (m->second * m->second);
    b->stiffness = spec->stiffness / unit;
    b->damping = spec->damping / (unit * m->second);
    pose_coordinates(spec, b->joint, i, length, &b->rest);
}

/* Generated bodies have no names of their own; messages need one. */
static void name_body(struct body_def *b, int i)
{
    snprintf(b->name, sizeof b->name, "body %d", i);
}

/* Chains, combs, stars, trees: they differ in the parent alone. Bodies up to end - 1. */
static bool add_rods(struct model *m, const struct model_spec *spec, int end, struct err *e)
{
    for (int i = m->nbody; i < end; i++) {
        /* A stream for each body, so that n bodies are the first n of n + 1. */
        struct random r = random_make(spec->seed, STREAM_SHAPE, (uint64_t)i);
        struct body_def b = {.parent = parent_of(spec, i, &r)};
        b.joint = joint_of(spec, i, &r);
        name_body(&b, i);
        axes_of(&b);
        /* A tenth of a link for each radian: turn and advance are of like size. */
        b.pitch = joint_has(b.joint, JOINT_PITCH) ? 0.1 * spec->length : 0;
        placement_of(spec, &b, &r);
        if (spec->inertia == INERTIA_RANDOM)
            random_body(spec, i, &b);
        else
            rod(&b, spec->length, spec->radius, spec->mass);
        springs_of(m, spec, i, spec->length, &b);
        if (model_add_body(m, &b, e) < 0) return false;
    }
    return true;
}

/* Quaternion of a turn about z. */
static void turn_z(double *quat, double angle)
{
    quat[0] = quat[1] = 0;
    angle_sincos(0.5 * angle, &quat[2], &quat[3]);
}

/* The joint that closes rings: as the others, revolute where those would leave nothing to close. */
static enum model_joint closing_joint(const struct model_spec *spec)
{
    bool fine = spec->joint < JOINT_MIXED && joint_has(spec->joint, JOINT_CLOSES_RINGS);
    return fine ? spec->joint : JOINT_REVOLUTE;
}

/* Sides of a regular polygon, closed at q = 0 whatever the joints: n bodies and the base, or n
 * bodies of which the first floats. */
static bool add_ring(struct model *m, const struct model_spec *spec, struct err *e)
{
    /* With a floating base the ring is all bodies, else the base is one of its sides. */
    bool floating = spec->base == BASE_FLOATING;
    int n = spec->nbody, sides = floating ? n : n + 1;
    double turn = 2 * PI / sides, length = spec->length;
    if (sides < 3) return err_set(e, ERR_CONFIG, "a ring needs at least 3 sides, here %d", sides);
    for (int i = 0; i < n; i++) {
        struct random r = random_make(spec->seed, STREAM_SHAPE, (uint64_t)i);
        struct body_def b = {.parent = i - 1, .joint = joint_of(spec, i, &r)};
        name_body(&b, i);
        axes_of(&b);
        /* Every side is turned by 2 pi / sides against the one before it. */
        turn_z(b.placement.quat, i == 0 && floating ? 0 : turn);
        /* the base's own side runs from 0 to length */
        b.placement.p[0] = i == 0 && floating ? 0 : length;
        if (spec->inertia == INERTIA_RANDOM)
            random_body(spec, i, &b);
        else
            rod(&b, length, spec->radius, spec->mass);
        if (model_add_body(m, &b, e) < 0) return false;
    }
    /* The tip of the last side, turned on once more, is the start of the first: at q = 0 the two
     * frames are the same, and the cut joint is at its zero, too. */
    struct loop_def loop = {.name = "closure", .body_a = floating ? 0 : -1, .body_b = n - 1};
    loop.joint = closing_joint(spec);
    loop.alpha = loop.beta = spec->stabilisation * m->second; /* a rate, in own units */
    loop.frame_b.p[0] = length;
    turn_z(loop.frame_b.quat, turn);
    return model_add_loop(m, &loop, e) >= 0;
}

/* Parallelogram: ground 1.5, crank 1, coupler 1.5, rocker 1 lengths; the cut joint is a
 * revolute. */
static bool add_four_bar(struct model *m, const struct model_spec *spec, struct err *e)
{
    static const double part[3] = {1, 1.5, 1};
    for (int i = 0; i < 3; i++) {
        /* Opposite sides are equal: the coupler stays parallel to the ground, so that a pose
         * which closes the loop is known without solving for it (pose_four_bar). */
        double length = part[i] * spec->length;
        struct body_def b = {.parent = i - 1, .joint = JOINT_REVOLUTE};
        name_body(&b, i);
        axes_of(&b);
        b.placement.p[0] = i > 0 ? part[i - 1] * spec->length : 0;
        rod(&b, length, spec->radius, part[i] * spec->mass);
        if (model_add_body(m, &b, e) < 0) return false;
    }
    struct loop_def loop = {.name = "closure", .body_a = -1, .body_b = 2, .joint = JOINT_REVOLUTE};
    loop.alpha = loop.beta = spec->stabilisation * m->second; /* a rate, in own units */
    /* The rocker's tip is pinned to the far end of the ground. */
    loop.frame_a.p[0] = 1.5 * spec->length;
    loop.frame_b.p[0] = spec->length;
    return model_add_loop(m, &loop, e) >= 0;
}

/* CH2 in its joint frame: carbon at the origin, two hydrogens; amu and angstrom. */
static void methylene(struct body_def *b)
{
    static const double atom[3][4] = {
        {12.011, 0, 0, 0}, {1.008, 0.89, 0.36, 0.52}, {1.008, -0.89, 0.36, 0.52}};
    /* Mass and centre first: the moments are about the centre. */
    for (int k = 0; k < 3; k++) b->mass += atom[k][0];
    for (int k = 0; k < 9; k++) b->com[k % 3] += atom[k / 3][0] * atom[k / 3][1 + k % 3] / b->mass;
    for (int k = 0; k < 3; k++) {
        double mass = atom[k][0], x = atom[k][1] - b->com[0], y = atom[k][2] - b->com[1],
               z = atom[k][3] - b->com[2];
        b->inertia[0] += mass * (y * y + z * z), b->inertia[3] += mass * (x * x + z * z);
        b->inertia[5] += mass * (x * x + y * y);
        b->inertia[1] -= mass * x * y, b->inertia[2] -= mass * x * z, b->inertia[4] -= mass * y * z;
    }
}

/* Backbone with bond length 1.53 A and tetrahedral angles; every bond is a torsion joint. */
static bool add_polymer(struct model *m, const struct model_spec *spec, struct err *e)
{
    /* Bonds meet at 109.47 degrees: consecutive axes differ by the rest of a half turn. */
    const double tilt = (180 - 109.47) * PI / 180, bond = 1.53;
    m->metre = 1e-10, m->kilogram = 1.66053906660e-27, m->second = 1e-12;
    for (int i = 0; i < spec->nbody; i++) {
        struct body_def b = {.parent = i - 1, .joint = JOINT_REVOLUTE};
        if (i == 0 && spec->base == BASE_FLOATING) b.joint = JOINT_FLOATING;
        name_body(&b, i);
        axes_of(&b);
        double sine, cosine;
        /* A turn about x by the tilt, then one bond along the new z: the carbon lies on the axis of
         * its own torsion joint. */
        angle_sincos(0.5 * tilt, &b.placement.quat[0], &b.placement.quat[3]);
        angle_sincos(tilt, &sine, &cosine);
        b.placement.p[1] = -bond * sine, b.placement.p[2] = bond * cosine;
        methylene(&b);
        springs_of(m, spec, i, bond, &b);
        if (model_add_body(m, &b, e) < 0) return false;
    }
    return true;
}

static bool is_usual(double x) { return x >= 1e-6 && x <= 1e6; }

/* Units of links far from a metre or a kilogram: powers of two near the links' own, and the time in
 * which the given torques (or gravity) turn one about. Products of masses and lengths then stay
 * within any precision, and no number is rounded by it. */
static struct model_spec in_own_units(const struct model_spec *spec, struct model *m)
{
    struct model_spec x = *spec;
    if (spec->generator == MODEL_POLYMER || (is_usual(spec->length) && is_usual(spec->mass)))
        return x;
    const double *g = spec->gravity, gravity = fabs(g[0]) + fabs(g[1]) + fabs(g[2]);
    /* Exponents of two: numbers change theirs and keep all digits. */
    const int metre = ilogb(spec->length), kilogram = ilogb(spec->mass);
    /* t^2 = m l^2 / torque, or l / g where no torque acts; without either, seconds do. */
    int square = 0; /* of the unit of time */
    if (spec->torque > 0) square = kilogram + 2 * metre - ilogb(spec->torque);
    else if (gravity > 0) square = metre - ilogb(gravity);
    m->metre = ldexp(1, metre), m->kilogram = ldexp(1, kilogram), m->second = ldexp(1, square / 2);
    x.length = ldexp(spec->length, -metre), x.radius = ldexp(spec->radius, -metre);
    x.mass = ldexp(spec->mass, -kilogram);
    return x;
}

static void set_gravity(struct model *m, const struct model_spec *spec)
{
    for (int k = 0; k < 3; k++) m->gravity[k] = spec->gravity[k] * m->second * m->second / m->metre;
}

struct model *generator_model(const struct model_spec *spec, struct arena *a, struct err *e)
{
    struct model *m = model_begin(a, NULL);
    const struct model_spec x = in_own_units(spec, m);
    /* Of 10^8 bodies none is made before all are known to fit. */
    if (!model_reserve(m, spec->nbody, spec->nbody, e)) return NULL;
    bool good;
    switch (spec->generator) {
    case MODEL_RING: good = add_ring(m, &x, e); break;
    case MODEL_FOUR_BAR: good = add_four_bar(m, &x, e); break;
    case MODEL_POLYMER: good = add_polymer(m, &x, e); break;
    default: good = add_rods(m, &x, x.nbody, e);
    }
    /* Only now are the units known: polymers have set theirs. */
    set_gravity(m, spec);
    return good && model_finish(m, false, e) ? m : NULL;
}

/* The frame of a body on the base's side is turned by its own axis: its record is there, too. Pages
 * of the others' records are never touched. */
struct model *generator_part(const struct model_spec *spec, int first, int end, struct arena *a,
                             struct err *e)
{
    struct model *m = model_begin(a, NULL);
    const struct model_spec x = in_own_units(spec, m);
    if (!model_reserve(m, spec->nbody, end - first, e)) return NULL;
    m->first = first;
    m->end = end;
    m->nbody = spec->nbody;
    const int known_end = model_known_end(m);
    m->nbody = first > 2 ? first - 2 : 0;
    if (!add_rods(m, &x, known_end, e)) return NULL;
    m->nbody = spec->nbody;
    set_gravity(m, spec);
    return model_finish(m, false, e) ? m : NULL;
}

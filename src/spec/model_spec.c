/* model_spec.c - the settings of a multibody scene.
 *
 * A generator makes n bodies in a shape; joints, inertias, pose and loads are drawn from the seed:
 *
 *     serial-chain, polymer            every body hangs on the one before
 *     comb, star, random-tree, dendrimer   trees: the parents follow a rule, or the seed
 *     ring, four-bar                   closed chains, cut open at one joint (physics 7.1)
 *
 * URDF files give bodies and joints, vector files also the state and the loads. What the file
 * gives, the settings cannot: these rows are idle then, and say why. */
#include "spec/model_spec.h"

#include <string.h>

#include "spec/spec_fields.h"

#define AT(member) .offset = offsetof(struct model_spec, member)

/* Words of enums, in the order of their values (model_spec.h). */
static const char *const generators[] = {"serial-chain", "comb",   "star",     "random-tree",
                                         "dendrimer",    "ring",   "four-bar", "polymer",
                                         "urdf",         "vector", NULL};
static const char *const joints[] = {
#define WORD(constant, word, stem, coordinates, plane, traits) word,
    JOINT_LIST(WORD)
#undef WORD
    "mixed", NULL};
static const char *const bases[] = {"fixed", "moving", "floating", NULL};
static const char *const inertias[] = {"uniform", "random", NULL};
static const char *const poses[] = {"straight", "folded", "coiled", "random", NULL};
static const char *const axes[] = {"parallel", "twisted", NULL};

static bool from_file(const struct run_spec *r)
{
    return r->model.generator == MODEL_URDF || r->model.generator == MODEL_VECTOR;
}

/* Why a setting cannot act, as a clause for messages; NULL when it acts. The checks build on each
 * other: the first reason that holds is told. */
static const char *idle_without_model(const struct run_spec *r)
{
    if (r->kernel.own) return "only built-in programs have a model";
    return kernel_spec_needs_model(&r->kernel) ? NULL
                                               : "this kernel only sends messages and has no model";
}

/* Numbers and shapes of bodies that a file gives. */
static const char *idle_from_file(const struct run_spec *r)
{
    const char *why = idle_without_model(r);
    if (why != NULL) return why;
    return from_file(r) ? "the model's file says it" : NULL;
}

/* A URDF file has no state and no gravity; a vector file has both. */
static const char *idle_from_vector(const struct run_spec *r)
{
    const char *why = idle_without_model(r);
    if (why != NULL) return why;
    return r->model.generator == MODEL_VECTOR ? "the vector file says it" : NULL;
}

/* Generators that make any number of bodies. */
static const char *idle_unless_any_length(const struct run_spec *r)
{
    const char *why = idle_from_file(r);
    if (why != NULL) return why;
    return r->model.generator == MODEL_FOUR_BAR ? "a four-bar has three moving bodies" : NULL;
}

/* Joints, axes and inertias that the generator can choose. */
static const char *idle_unless_general(const struct run_spec *r)
{
    const char *why = idle_unless_any_length(r);
    if (why != NULL) return r->model.generator == MODEL_FOUR_BAR ? "a four-bar fixes it" : why;
    return r->model.generator == MODEL_POLYMER ? "a polymer fixes it" : NULL;
}

/* Springs would pull a closed chain out of the pose that closes it. */
static const char *idle_in_a_loop(const struct run_spec *r)
{
    const char *why = idle_from_file(r);
    if (why != NULL) return why;
    const bool loop = r->model.generator == MODEL_RING || r->model.generator == MODEL_FOUR_BAR;
    return loop ? "rings and four-bars are generated without springs" : NULL;
}

/* Axes of a ring are parallel, or it could not close. */
static const char *idle_in_a_ring(const struct run_spec *r)
{
    const char *why = idle_unless_general(r);
    if (why != NULL) return why;
    return r->model.generator == MODEL_RING ? "a ring fixes it" : NULL;
}

/* The pose of a closed chain follows from the closure. */
static const char *idle_when_closed(const struct run_spec *r)
{
    const char *why = idle_from_vector(r);
    if (why != NULL) return why;
    bool closed = r->model.generator == MODEL_RING || r->model.generator == MODEL_FOUR_BAR;
    return closed ? "a closed chain has the pose that closes it" : NULL;
}

/* Measures of rods. */
static const char *idle_unless_rods(const struct run_spec *r)
{
    const char *why = idle_from_file(r);
    if (why != NULL) return why;
    return r->model.generator == MODEL_POLYMER ? "a polymer has atoms, not rods" : NULL;
}

static const char *idle_unless_file(const struct run_spec *r)
{
    const char *why = idle_without_model(r);
    if (why != NULL) return why;
    return from_file(r) ? NULL : "model.generator makes the model without a file";
}

/* Number of children: only where the generator asks for it. */
static const char *idle_unless_branching(const struct run_spec *r)
{
    const char *why = idle_without_model(r);
    if (why != NULL) return why;
    bool branches = r->model.generator == MODEL_COMB || r->model.generator == MODEL_DENDRIMER;
    return branches ? NULL : "only a comb and a dendrimer have it";
}

/* Loops to stabilise (physics 7.5): the generators that close a chain. */
static const char *idle_unless_closed(const struct run_spec *r)
{
    const char *why = idle_without_model(r);
    if (why != NULL) return why;
    bool closed = r->model.generator == MODEL_RING || r->model.generator == MODEL_FOUR_BAR;
    return closed ? NULL : "only a ring and a four-bar linkage have loops to stabilise";
}

/* Ratio of masses of seeded random bodies. */
static const char *idle_unless_random(const struct run_spec *r)
{
    const char *why = idle_unless_general(r);
    if (why != NULL) return why;
    return r->model.inertia == INERTIA_RANDOM ? NULL : "model.inertia is not 'random'";
}

/* A base with a given acceleration (physics 1.6). */
static const char *idle_unless_moving(const struct run_spec *r)
{
    const char *why = idle_without_model(r);
    if (why != NULL) return why;
    return r->model.base == BASE_MOVING ? NULL : "model.base is not 'moving'";
}

/* Inverse dynamics computes the forces: none are given. */
static const char *idle_unless_forward(const struct run_spec *r)
{
    const char *why = idle_from_vector(r);
    if (why != NULL) return why;
    return kernel_spec_has(&r->kernel, PROGRAM_FORWARD)
               ? NULL
               : "inverse dynamics finds the forces itself";
}

/* One row a setting. Bounds keep the mechanics representable in double precision, from molecules
 * (1e-30 kg, 1e-12 m) to space structures. */
static const struct field fields[] = {
    /* Which bodies, and what connects them. */
    {.key = "generator", .kind = FIELD_CHOICE, AT(generator), .choice = generators,
     .fallback = "serial-chain",
     .idle = idle_without_model, .doc = "kind of system, or the kind of file that describes it"},
    {.key = "n", .kind = FIELD_INT, AT(nbody), .min = 1, .max = 1 << 27, .fallback = "16",
     .idle = idle_unless_any_length, .doc = "number of bodies"},
    /* The joint types of physics 1.3, or a mixture drawn from the seed. */
    {.key = "joint", .kind = FIELD_CHOICE, AT(joint), .choice = joints, .fallback = "revolute",
     .idle = idle_unless_general, .doc = "joint of every body"},
    /* A floating base adds a joint of six freedoms in front (physics 4.4). */
    {.key = "base", .kind = FIELD_CHOICE, AT(base), .choice = bases, .fallback = "fixed",
     .idle = idle_from_vector,
     .doc = "what the first body is attached to"},
    /* Uniform: all bodies equal; random: sizes and masses from the seed. */
    {.key = "inertia", .kind = FIELD_CHOICE, AT(inertia), .choice = inertias, .fallback = "uniform",
     .idle = idle_unless_general, .doc = "equal bodies, or seeded random ones"},
    /* Where the joints stand, and how their axes lie. */
    {.key = "pose", .kind = FIELD_CHOICE, AT(pose), .choice = poses, .fallback = "random",
     .idle = idle_when_closed,
     .doc = "joint positions"},
    {.key = "axes", .kind = FIELD_CHOICE, AT(axes), .choice = axes, .fallback = "twisted",
     .idle = idle_in_a_ring,
     .doc = "joint axes: all parallel, or each rotated relative to the previous one"},
    /* Measures of equal rods; random bodies vary about them. */
    {.key = "length", .kind = FIELD_REAL, .unit = UNIT_LENGTH, AT(length), .min = 1e-12, .max = 1e6,
     .fallback = "1 m", .idle = idle_unless_rods, .doc = "of a link"},
    {.key = "radius", .kind = FIELD_REAL, .unit = UNIT_LENGTH, AT(radius), .min = 1e-13, .max = 1e6,
     .fallback = "0.05 m", .idle = idle_unless_rods, .doc = "of a link"},
    {.key = "mass", .kind = FIELD_REAL, .unit = UNIT_MASS, AT(mass), .min = 1e-30, .max = 1e12,
     .fallback = "1 kg",
     .idle = idle_unless_rods, .doc = "of a link"},
    /* For stiff and badly scaled cases (physics 8.3). */
    {.key = "mass_ratio", .kind = FIELD_REAL, AT(mass_ratio), .min = 1, .max = 1e15,
     .fallback = "1",
     .idle = idle_unless_random, .doc = "largest over smallest mass of random bodies"},
    /* What acts: gravity enters as an acceleration of the base (physics 1.6). */
    {.key = "gravity", .kind = FIELD_REALS, .unit = UNIT_ACCELERATION, AT(gravity), .capacity = 3,
     .at_least = 3,
     .min = -1e6, .max = 1e6, .fallback = "[0, 0, -9.81] m/s^2", .idle = idle_from_vector,
     .doc = "in the base frame"},
    /* A base that is moved from outside (physics 1.6); a floating one moves by itself. */
    {.key = "base_acceleration.angular", .kind = FIELD_REALS, .unit = UNIT_ANGULAR_ACCELERATION,
     AT(base_acceleration), .capacity = 3, .at_least = 3, .min = -1e9, .max = 1e9,
     .fallback = "[0, 0, 0] rad/s^2",
     .idle = idle_unless_moving, .doc = "of a moving base"},
    {.key = "base_acceleration.linear", .kind = FIELD_REALS, .unit = UNIT_ACCELERATION,
     .offset = offsetof(struct model_spec, base_acceleration) + 3 * sizeof(double), .capacity = 3,
     .at_least = 3,
     .min = -1e9, .max = 1e9, .fallback = "[0, 0, 0] m/s^2", .idle = idle_unless_moving,
     .doc = "of a moving base"},
    /* State and loads: scales of seeded random numbers. */
    {.key = "rate", .kind = FIELD_REAL, .unit = UNIT_ANGULAR_RATE, AT(rate), .min = 0, .max = 1e9,
     .fallback = "1 rad/s", .idle = idle_from_vector,
     .doc = "scale of the seeded random joint rates"},
    {.key = "torque", .kind = FIELD_REAL, .unit = UNIT_TORQUE, AT(torque), .min = 0, .max = 1e15,
     .fallback = "1 N m", .idle = idle_unless_forward,
     .doc = "scale of the seeded random joint forces"},
    /* One wrench a body, subtracted from its load (physics 1.6). */
    {.key = "external_force", .kind = FIELD_REAL, .unit = UNIT_FORCE, AT(external_force), .min = 0,
     .max = 1e15,
     .fallback = "0 N", .idle = idle_from_vector,
     .doc = "scale of seeded random wrenches on every body, 0: none"},
    /* Springs and dampers, also for linearly implicit steps (physics 9.0). */
    {.key = "stiffness", .kind = FIELD_REAL, .unit = UNIT_STIFFNESS, AT(stiffness), .min = 0,
     .max = 1e15,
     .fallback = "0 N m/rad", .idle = idle_in_a_loop,
     .doc = "stiffness of joint springs towards the first pose (the same number in N/m where "
     "a joint slides), 0: none"},
    {.key = "damping", .kind = FIELD_REAL, .unit = UNIT_DAMPING, AT(damping), .min = 0, .max = 1e15,
     .fallback = "0 N m s/rad", .idle = idle_in_a_loop,
     .doc = "damping of the joints (the same number in N s/m where a joint slides), 0: none"},
    /* Baumgarte's alpha = beta (physics 7.2, 7.5): Runge-Kutta 4 needs alpha h below about 2.8.
     * With the projection of physics 7.5 it would not be needed. */
    {.key = "stabilisation", .kind = FIELD_REAL, .unit = UNIT_ANGULAR_RATE, AT(stabilisation),
     .min = 0, .max = 1e9,
     .fallback = "0 rad/s", .idle = idle_unless_closed,
     .doc = "closed loops: alpha = beta of Baumgarte's method, at most about one over the step "
            "size; 0: none"},
    /* Comb and dendrimer. */
    {.key = "branch", .kind = FIELD_INT, AT(branch), .min = 1, .max = 1 << 20, .fallback = "2",
     .idle = idle_unless_branching, .doc = "comb, dendrimer: number of children per body"},
    /* One seed for all: the same model on every host and for every number of ranks. */
    {.key = "seed", .kind = FIELD_SEED, AT(seed), .fallback = "1", .idle = idle_from_vector,
     .doc = "seed of everything random in the model"},
    /* Models from files. */
    {.key = "path", .kind = FIELD_TEXT, AT(path), .capacity = 256, .fallback = "",
     .idle = idle_unless_file,
     .doc = "URDF or vector file, relative to the scenario"},
};

/* The prefix and the place of the struct in run_spec; everything else is the rows'. */
const struct field_table model_table = {
    .prefix = "model", .doc = "the multibody scene", .offset = offsetof(struct run_spec, model),
    .size = sizeof(struct model_spec), .nfield = (int)(sizeof fields / sizeof *fields),
    .field = fields,
};

/* model_spec.h - which multibody system, in which pose, with which loads: the scene that a kernel
 * works on. */
#ifndef SPEC_MODEL_SPEC_H
#define SPEC_MODEL_SPEC_H

#include <stdbool.h>
#include <stdint.h>

#include "spec/joint_list.h"

enum model_generator {
    MODEL_SERIAL_CHAIN,
    MODEL_COMB,
    MODEL_STAR,
    MODEL_RANDOM_TREE,
    MODEL_DENDRIMER,
    MODEL_RING,
    MODEL_FOUR_BAR,
    MODEL_POLYMER,
    MODEL_URDF,
    MODEL_VECTOR
};
enum model_joint {
#define CONSTANT(constant, word, stem, coordinates, plane, traits) constant,
    JOINT_LIST(CONSTANT)
#undef CONSTANT
    JOINT_MIXED /* every body's type is drawn among the others */
};
enum model_base { BASE_FIXED, BASE_MOVING, BASE_FLOATING };
enum model_inertia { INERTIA_UNIFORM, INERTIA_RANDOM };
enum model_pose { POSE_STRAIGHT, POSE_FOLDED, POSE_COILED, POSE_RANDOM };
enum model_axes { AXES_PARALLEL, AXES_TWISTED };

struct model_spec {
    enum model_generator generator;
    int nbody;                /* n, >= 1; URDF, vector: taken from the file */
    enum model_joint joint;   /* of every body but a floating base */
    enum model_base base;
    enum model_inertia inertia;
    enum model_pose pose;
    enum model_axes axes;
    double length;            /* of a link [m] */
    double radius;            /* of a link [m] */
    double mass;              /* of a link [kg] */
    double mass_ratio;        /* largest over smallest mass of random or graded inertias, >= 1 */
    double gravity[3];        /* in the base frame [m/s^2] */
    double base_acceleration[6]; /* moving base: angular, linear [rad/s^2, m/s^2] */
    double rate;              /* scale of the random joint rates [rad/s] */
    double torque;            /* scale of the random joint forces [N m] */
    double external_force;    /* scale of random external wrenches on every body [N]; 0: none */
    /* joint springs to the initial pose [N m/rad], [N m s/rad]; 0: none */
    double stiffness, damping;
    double stabilisation;     /* loops: alpha = beta of Baumgarte's method [1/s]; 0: none */
    int branch;               /* comb, dendrimer: children per node */
    uint64_t seed;
    char path[256];           /* URDF or vector file */
};

#endif

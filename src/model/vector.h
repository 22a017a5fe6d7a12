/* vector.h - reference vectors: a multibody system, a state, and answers computed by others with 77
 * digits.
 *
 * The format is dynref-1 (JSON, SI units); tests/data/vectors/README.md states its conventions.
 * What is read here is kept as written: spatial vectors linear first, quaternions [x, y, z, w],
 * bodies in their own frames. vector_model.h makes a model and a state of it. */
#ifndef MODEL_VECTOR_H
#define MODEL_VECTOR_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"

struct node;

enum vector_joint {
    VECTOR_FIXED,     /* nq 0, nv 0 */
    VECTOR_REVOLUTE,  /* nq 1, nv 1 */
    VECTOR_PRISMATIC, /* nq 1, nv 1 */
    VECTOR_SPHERICAL, /* nq 4: quaternion body to joint frame; nv 3: angular velocity, body axes */
    VECTOR_FLOATING   /* nq 7: position, quaternion; nv 6: linear, angular velocity, body axes */
};

/* x_outer = R x_inner + p. */
struct vector_frame {
    double p[3];
    double quat[4]; /* [x, y, z, w], the exact rotation once normalised */
    double R[9];    /* its rounding, row-major */
};

struct vector_body {
    int parent;                    /* -1: the world */
    enum vector_joint joint;
    double axis[3];                /* revolute, prismatic: off unit length by a rounding at most */
    struct vector_frame placement; /* joint frame in the parent's body frame */
    double mass, com[3];
    double inertia[6];             /* about the centre of mass: xx xy xz yy yz zz */
    const char *name;              /* link, "" when the file names none */
    int line;                      /* in the file */
    int q, v;                      /* where its coordinates begin in the stacked vectors */
};

/* row . [a_b - a_a; alpha_b - alpha_a] = 0 in the axes of frame a, accelerations of the loop
 * points. */
struct vector_loop {
    int body_a, body_b;            /* -1: the world */
    struct vector_frame frame_a, frame_b;
    int nrow;                      /* 1 .. 6 */
    double row[6][6];              /* [linear; angular] */
    int line;
};

/* A body's motion in world axes, for qdd and without gravity. */
struct vector_pose {
    int body;
    double R[9], p[3], v[3], w[3], a[3], alpha[3];
};

struct vector_instant {
    double time;
    const double *q, *qd;
    double energy[3];              /* kinetic, potential with springs, total */
    double linear[3], angular[3];  /* momentum, the angular one about the world's origin */
    /* (nq + nv) q and qd as written with 45 digits, NULL: the file has none */
    const double *digits;
    double accuracy;               /* bound of the reference's own error */
    double sensitivity;            /* growth of an initial error until now */
};

/* The best of several independent libraries in double precision, NAN when there is none. */
struct vector_peer {
    double error;                  /* max |x - ref| / max |ref| */
    const char *name;
};

/* Arrays are borrowed from the arena of vector_read; answers that the file does not hold are NULL
 * or NAN. */
struct vector_case {
    const char *path, *name, *group, *urdf;
    int urdf_line;                 /* where the URDF file is named */
    const struct node *declared;   /* the list 'answers', NULL: the file promises all */
    int nbody, nq, nv, nrow;       /* nrow: loop rows altogether */
    double gravity[3];
    struct vector_body *body;
    int nloop;
    struct vector_loop *loop;
    const double *q, *qd, *qdd, *tau;
    /* (nbody x 6) wrench [f; n] on the body, body axes, at its origin */
    const double *external;
    const double *spring, *spring_q0, *damping; /* (nv) */

    const double *tau_id, *qdd_fd, *bias, *gravity_torque, *lambda;
    const double *mass_matrix;     /* (nv x nv) */
    /* (nbody x 6) [f; n] from the parent on the body, body axes, at its origin */
    const double *joint_wrench;
    double kinetic, potential, linear[3], angular[3], com_world[3], total_mass;
    bool has_energy, has_momentum, has_com;
    int npose;
    struct vector_pose *pose;
    /* change of the exact answers when inputs are rounded, as the file says */
    double floor_id, floor_fd;
    struct vector_peer peer_id, peer_fd;

    int ninstant;                  /* trajectories only */
    struct vector_instant *instant;
};

/* vector_read: read a dynref-1 file into *c, all memory from `a`.
 *
 *   Returns false with ERR_NO_INPUT, ERR_IO or ERR_DATA (file and line): syntax, a missing field, a
 * wrong count, an unknown joint type, a parent that does not come before its child, a number that
 * is not finite, a key that is not the format's, a rotation that is not its quaternion's. Bodies
 * need not be physical: some reference robots are not. */
bool vector_read(const char *path, struct vector_case *c, struct arena *a, struct err *e);

/* vector_joint_name: "revolute", ... ; vector_joint_nq, vector_joint_nv: its coordinates and
 * degrees of freedom. */
const char *vector_joint_name(enum vector_joint joint);
int vector_joint_nq(enum vector_joint joint);
int vector_joint_nv(enum vector_joint joint);

#endif

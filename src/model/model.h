/* model.h - a multibody system as its user describes it: bodies, joints, loops; and its state.
 *
 * Bodies are numbered parents first. All vectors over joints (q, u, u', tau) are stacked in body
 * order, in the conventions of spec/joint_list.h, which are those of reference files and robots,
 * and every algorithm takes and gives them so; tau is conjugate to u.
 *
 * Units: the model's own, coherent; the factors to SI are in the model. */
#ifndef MODEL_MODEL_H
#define MODEL_MODEL_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "spec/model_spec.h"

/* A frame fixed in another one: x_outer = R(quat) x_inner + p. quat = x y z w, not zero, normalised
 * where used. */
struct frame {
    double quat[4];
    double p[3];
};

/* One body with the joint that carries it, everything in the body's own frame at q = 0 = joint
 * frame. */
struct body_def {
    char name[64];
    int parent;              /* -1: the base */
    enum model_joint joint;
    double axis[3];  /* revolute, prismatic, helical, cylindrical: the axis; universal: the first,
                        fixed in the joint frame; planar, point-plane: the plane's normal; slot:
                        its direction */
    double axis2[3]; /* universal: the second axis, orthogonal to the first; planar, point-plane:
                        the direction of x in the plane (0: any) */
    double pitch;            /* helical: advance per radian */
    struct frame placement;  /* of the joint frame in the parent's body frame */
    double mass;
    double com[3];           /* centre of mass from the body's origin */
    /* about the centre of mass: Ixx Ixy Ixz Iyy Iyz Izz (tensor entries) */
    double inertia[6];
    /* joint spring, one-degree joints: tau -= stiffness (q - rest) + damping u */
    double stiffness, rest, damping;
    int line;                /* where the body stands in its file; 0: nowhere */
};

/* A joint that closes a loop: between frame a on body a and frame b on body b (-1: the base). */
struct loop_def {
    char name[64];
    int body_a, body_b;
    struct frame frame_a, frame_b;
    int nrow;                /* > 0: given by rows; 0: by joint */
    double row[6][6];        /* rows [linear; angular] in the axes of frame a:
                                row . [a_b - a_a; alpha_b - alpha_a] = 0 for the frames' origins */
    /* joint free motion between the frames, z (slot: x, point-plane: z normal) as axis */
    enum model_joint joint;
    /* stabilisation: J u' + g'' + 2 alpha J u + beta^2 g = 0 [1/s]; 0: none */
    double alpha, beta;
    int line;
};

struct model {
    int nbody, nq, nu, nloop;
    int first, end; /* bodies that are here: all, but of a part; counts are of the whole */
    int nrow;                /* constraints of all loops together */
    struct body_def *body;   /* (nbody) */
    struct loop_def *loop;   /* (nloop) */
    int *q_at, *u_at;        /* (nbody + 1) first coordinate, first velocity of each body */
    int *row_at;             /* (nloop + 1) first constraint of each loop */
    /* children of i: child[child_at[i]] .. child[child_at[i + 1] - 1], ascending */
    int *child_at, *child;
    bool is_chain;           /* parent(i) = i - 1 for all i */
    /* every body has an invertible inertia: the constraint force algorithm applies */
    bool has_phi;
    bool general_joints;     /* serial codes are not to use that all joints are revolute */
    /* room dynamics: what system_prepare computed of the bodies; NULL: nothing yet */
    const void *constants;
    double gravity[3];       /* in the base frame */
    double metre, kilogram, second; /* one model unit of each in SI */
    const char *file;        /* where the model comes from, for messages; NULL: generated */
    struct arena *arena;     /* borrowed */
    int body_room, loop_room;/* while building */
};

/* The configuration, motion and loads of a model. Arrays in user order, see the top. */
struct state {
    double *q;               /* (nq) */
    double *qd;              /* (nu) u */
    double *qdd;             /* (nu) given accelerations, for inverse dynamics */
    /* (nu) given joint forces, for forward dynamics; springs come on top */
    double *tau;
    /* (nbody x 6) [force; moment about the origin] on each body, user's body axes; or NULL */
    double *fext;
    /* prescribed motion of the base: [angular; linear], without gravity */
    double base_acceleration[6];
    bool others_move; /* of a part of a model: some rate of a body that is not here is not zero */
    /* all rates are zero, and serial forward and inverse dynamics may leave their terms out */
    bool at_rest;
};

/* The largest models. Serial dynamics of closed chains keeps a dense matrix of the loops' rows, 8
 * GiB at this limit. */
enum { MODEL_MAX_BODIES = 1 << 27, MODEL_MAX_ROWS = 32768 };

/* model_begin: an empty model in `a`; gravity 0, units SI. `file` (may be NULL) is quoted in
 * messages. */
struct model *model_begin(struct arena *a, const char *file);

/* model_reserve: room for `n` bodies. False with ERR_CONFIG when `here` of them do not fit. */
bool model_reserve(struct model *m, int n, int here, struct err *e);

/* model_add_body: append *def (copied). Returns its index; -1 with *e set when parent, axis or
 * placement make no sense. A zero `placement.quat` means the identity. */
int model_add_body(struct model *m, const struct body_def *def, struct err *e);

/* model_add_loop: append *def (copied). Returns its index; -1 with *e set. */
int model_add_loop(struct model *m, const struct loop_def *def, struct err *e);

/* model_finish: check the bodies and build the index tables; the model is read-only afterwards.
 *
 *   allow_nonphysical  accept massless bodies and inertias that no body has (reference files
 * contain some); numbers must be finite all the same
 *
 *   Returns false with ERR_DATA naming the body and its line: not finite, mass <= 0, inertia not
 * positive definite, triangle inequality violated (1e-9 relative slack for rounding in files), no
 * body at all, more than the limits. */
bool model_finish(struct model *m, bool allow_nonphysical, struct err *e);

/* model_build: the system that `spec` asks for, generated or from its file. NULL with *e set. */
struct model *model_build(const struct model_spec *spec, struct arena *a, struct err *e);

/* model_all_revolute: whether the joints of all bodies that are here are revolute. */
bool model_all_revolute(const struct model *m);

/* state_take: a state of m with zeros, identity quaternions and no external forces. */
struct state *state_take(const struct model *m, struct arena *a);

/* state_given: the pose, rates, torques and external forces that `spec` asks for; seeded, the same
 * on every host. Rates of closed chains need not be consistent with the loops yet
 * (dynamics/system.h makes them so). NULL only when a vector file can no longer be read. */
struct state *state_given(const struct model *m, const struct model_spec *spec, struct arena *a);

/* state_generate: state_given of all but vector files. */
struct state *state_generate(const struct model *m, const struct model_spec *spec, struct arena *a);

/* state_fext_need: the state's fext array, taken (zero) when there was none. */
double *state_fext_need(struct state *s, const struct model *m, struct arena *a);

/* joint_nq, joint_nu: numbers of coordinates and velocities of a joint type. joint_name: as in
 * scenario files. joint_coordinates, joint_plane, joint_has: the columns of spec/joint_list.h. */
int joint_nq(enum model_joint joint);
int joint_nu(enum model_joint joint);
const char *joint_name(enum model_joint joint);
const char *joint_coordinates(enum model_joint joint);
enum joint_plane joint_plane(enum model_joint joint);
bool joint_has(enum model_joint joint, enum joint_trait trait);

/* joint_quaternion: which coordinate is the first of its quaternion; -1: it has none. */
int joint_quaternion(enum model_joint joint);

/* joint_is_linear: whether component k of its velocity is linear, not angular. */
bool joint_is_linear(enum model_joint joint, int k);

#endif

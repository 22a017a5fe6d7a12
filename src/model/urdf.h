/* urdf.h - robots described by URDF files: links with inertias, joined to a tree.
 *
 * Units of the format are SI. What matters for dynamics is read; geometry is skipped; what would
 * matter and is not supported (mimic, transmission, friction, ...) is listed as a warning with its
 * line. Links are bodies in the order of a depth-first walk from the root, children in the order of
 * the file's joints. */
#ifndef MODEL_URDF_H
#define MODEL_URDF_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"

enum urdf_kind {
    URDF_FIXED,
    URDF_REVOLUTE,
    URDF_CONTINUOUS,
    URDF_PRISMATIC,
    URDF_FLOATING,
    URDF_PLANAR,
    URDF_KINDS
};

struct urdf_link {
    const char *name;
    int line;
    bool has_inertial;
    int inertial_line;    /* of <inertial>; the link's without one */
    double mass;          /* [kg] */
    double com[3];        /* in link axes, from the link's origin [m] */
    double quat[4];       /* [x, y, z, w] of the inertial frame in link axes */
    /* about the centre of mass in inertial axes: xx xy xz yy yz zz [kg m^2] */
    double inertia[6];
    int joint;            /* that carries it, -1: the root */
};

struct urdf_joint {
    const char *name;
    int line;
    enum urdf_kind kind;
    int parent, child;    /* links */
    double p[3], quat[4]; /* joint frame in the parent link's axes [m], [x, y, z, w] */
    double axis[3];       /* unit; planar: normal of the plane */
    bool has_limit;
    double lower, upper;  /* [rad] or [m]; -/+ INFINITY without a limit */
    double effort, velocity; /* [N m] or [N], [rad/s] or [m/s]; INFINITY without a limit */
    double damping;       /* [N m s/rad] or [N s/m] */
};

struct urdf_warning {
    int line;
    const char *text;
};

/* Arrays are borrowed from the arena of urdf_read. */
struct urdf_robot {
    const char *path, *name;
    int nlink, njoint, nwarning;
    struct urdf_link *link;       /* order of the file */
    struct urdf_joint *joint;     /* order of the file */
    struct urdf_warning *warning; /* in order of line */
    int *order;                   /* (nlink) links, depth first; order[0] is the root */
};

/* urdf_read: read the robot of a URDF file, all memory from `a`.
 *
 *   Returns false with ERR_NO_INPUT, ERR_IO or ERR_DATA (file and line): XML errors, names missing,
 * repeated or unknown (with the nearest known one), joint type unknown, numbers malformed or not
 * finite, an axis of length zero, a link with two parents, several roots, a cycle, more than 64 MB.
 * Whether the inertias are possible is asked later. */
bool urdf_read(const char *path, struct urdf_robot *robot, struct arena *a, struct err *e);

/* urdf_kind_name: "fixed", "revolute", ... */
const char *urdf_kind_name(enum urdf_kind kind);

#endif

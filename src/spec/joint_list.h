/* joint_list.h - the joint types, one line each: all that rooms above need to know of one.
 *
 * A new joint type is a line here and a file joint_STEM.c in room dynamics that defines
 * `joint_STEM` (dynamics/joint_motion.h). Columns of X: constant, word in files, stem, coordinates,
 * what it does in the plane of a planar scene, traits. The comment says what q and u are.
 *
 * Coordinates, in their order: a letter each, which gives the numbers of q and of u:
 *   a  an angle; u has its rate, or an angular rate proportional to it
 *   d  a displacement; u has a linear velocity
 *   q  a quaternion x y z w, turning body into joint-frame components, of any length but zero; u
 * has the angular velocity relative to the parent in body axes (3)
 *
 * Joint type `mixed` draws among all types: one more changes the scenes that it makes. */
#ifndef SPEC_JOINT_LIST_H
#define SPEC_JOINT_LIST_H

#define JOINT_LIST(X)                                                                              \
    /* no coordinates */                                                                           \
    X(JOINT_FIXED, "fixed", fixed, "", PLANE_STAYS, 0)                                             \
    /* q: angle; u: rate */                                                                        \
    X(JOINT_REVOLUTE, "revolute", revolute, "a", PLANE_TURNS, JOINT_AXIS)                          \
    /* q: displacement; u: rate */                                                                 \
    X(JOINT_PRISMATIC, "prismatic", prismatic, "d", PLANE_SLIDES, JOINT_AXIS)                      \
    /* q: angle; u: s * rate, s = sqrt(1 + pitch^2), so that the axis has unit length */           \
    X(JOINT_HELICAL, "helical", helical, "a", PLANE_LEAVES,                                        \
      JOINT_AXIS | JOINT_PITCH | JOINT_IN_TREES)                                                   \
    /* q: angle, displacement; u: rates */                                                         \
    X(JOINT_CYLINDRICAL, "cylindrical", cylindrical, "ad", PLANE_LEAVES,                           \
      JOINT_AXIS | JOINT_CLOSES_RINGS)                                                             \
    /* q: angle 1, angle 2; u: rates */                                                            \
    X(JOINT_UNIVERSAL, "universal", universal, "aa", PLANE_LEAVES,                                 \
      JOINT_AXIS | JOINT_ALONG_X | JOINT_TWO_AXES | JOINT_IN_TREES)                                \
    /* q: quaternion; u: angular velocity */                                                       \
    X(JOINT_SPHERICAL, "spherical", spherical, "q", PLANE_LEAVES, JOINT_CLOSES_RINGS)              \
    /* q: angle, x, y; u: angular rate, then velocity of the origin in body axes x, y */           \
    X(JOINT_PLANAR, "planar", planar, "add", PLANE_MOVES,                                          \
      JOINT_AXIS | JOINT_NORMAL | JOINT_CLOSES_RINGS)                                              \
    /* q: quaternion, x; u: angular velocity, rate of x */                                         \
    X(JOINT_SLOT, "slot", slot, "qd", PLANE_LEAVES, JOINT_AXIS | JOINT_ALONG_X | JOINT_AS_IT_LIES) \
    /* q: quaternion, x, y; u: angular velocity, rates of x, y */                                  \
    X(JOINT_POINT_PLANE, "point-plane", point_plane, "qdd", PLANE_LEAVES,                          \
      JOINT_AXIS | JOINT_NORMAL | JOINT_AS_IT_LIES)                                                \
    /* q: p (3), quaternion; u: velocity of the origin in body axes (3), angular velocity */       \
    X(JOINT_FLOATING, "floating", floating, "dddq", PLANE_LEAVES, 0)

/* What a joint type has besides its coordinates. */
enum joint_trait {
    JOINT_AXIS = 1,        /* an axis, not zero: z of the joint's own axes unless it is along x */
    JOINT_ALONG_X = 2,     /* the axis is x of the joint's own axes */
    JOINT_TWO_AXES = 4,    /* a second axis orthogonal to the first */
    JOINT_NORMAL = 8,      /* the axis is a normal; the second one, if any, directs x */
    JOINT_AS_IT_LIES = 16, /* the body's frame is not turned to the axis: body.slide has the axes */
    JOINT_PITCH = 32,      /* an advance per radian */
    JOINT_IN_TREES = 64,   /* cannot close a loop */
    JOINT_CLOSES_RINGS = 128 /* closes rings whose other joints are of its type */
};

/* What a joint type does in the plane of a planar scene: nothing; turns about the normal; slides
 * along a line of it; turns and slides anywhere. All others leave the plane. */
enum joint_plane { PLANE_LEAVES, PLANE_STAYS, PLANE_TURNS, PLANE_SLIDES, PLANE_MOVES };

#endif

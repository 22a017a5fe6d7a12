/* pose.c - where the joints of generated scenes stand. */
#include "model/pose.h"

#include <math.h>

#define PI 3.14159265358979323846

void pose_quaternion(struct random *r, double *quat)
{
    double length = 0;
    for (int i = 0; i < 4; i++) {
        quat[i] = random_normal(r);
        length += quat[i] * quat[i];
    }
    for (int i = 0; i < 4; i++) quat[i] /= sqrt(length);
}

/* First rotational coordinate: straight 0, folded pi from the second body on, otherwise anywhere. */
static double pose_angle(const struct model_spec *spec, int i, struct random *r)
{
    if (spec->pose == POSE_STRAIGHT) return 0;
    if (spec->pose == POSE_FOLDED) return i == 0 ? 0 : PI;
    return random_uniform(r, -PI, PI);
}

static void pose_rotation(const struct model_spec *spec, int i, struct random *r, double *quat)
{
    quat[0] = quat[1] = quat[2] = 0, quat[3] = 1;
    if (spec->pose == POSE_FOLDED && i > 0)
        quat[2] = 1, quat[3] = 0;
    else if (spec->pose == POSE_COILED || spec->pose == POSE_RANDOM)
        pose_quaternion(r, quat);
}

static void pose_shift(const struct model_spec *spec, struct random *r, int n, double length, double *x)
{
    for (int k = 0; k < n; k++) x[k] = spec->pose == POSE_RANDOM ? random_uniform(r, -length, length) : 0;
}

void pose_coordinates(const struct model_spec *spec, enum model_joint joint, int i, double length, double *q)
{
    struct random r = random_make(spec->seed, STREAM_POSE, (uint64_t)i);
    switch (joint) {
    case JOINT_FIXED:
    case JOINT_MIXED: break;
    case JOINT_REVOLUTE:
    case JOINT_HELICAL: q[0] = pose_angle(spec, i, &r); break;
    case JOINT_PRISMATIC: pose_shift(spec, &r, 1, length, q); break;
    case JOINT_CYLINDRICAL:
        q[0] = pose_angle(spec, i, &r);
        pose_shift(spec, &r, 1, length, q + 1);
        break;
    case JOINT_UNIVERSAL:
        q[0] = pose_angle(spec, i, &r);
        q[1] = spec->pose == POSE_FOLDED ? 0 : pose_angle(spec, i, &r);
        break;
    case JOINT_PLANAR:
        q[0] = pose_angle(spec, i, &r);
        pose_shift(spec, &r, 2, length, q + 1);
        break;
    case JOINT_SPHERICAL:
    case JOINT_SLOT:
    case JOINT_POINT_PLANE:
        pose_rotation(spec, i, &r, q);
        pose_shift(spec, &r, joint_nq(joint) - 4, length, q + 4);
        break;
    case JOINT_FLOATING:
        pose_shift(spec, &r, 3, length, q);
        pose_rotation(spec, i, &r, q + 3);
        break;
    }
}

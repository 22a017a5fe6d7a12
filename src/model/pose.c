/* pose.c - where the joints of generated scenes stand. */
#include "model/pose.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Normal numbers, normalised: uniform on the sphere of quaternions, and so over the rotations. */
void pose_quaternion(struct random *r, double *quat)
{
    double length = 0;
    for (int i = 0; i < 4; i++) {
        quat[i] = random_normal(r);
        length += quat[i] * quat[i];
    }
    for (int i = 0; i < 4; i++) quat[i] /= sqrt(length);
}

/* Poses do not depend on how bodies are distributed: every body has a random stream of its own.
 *
 * First rotational coordinate: straight 0, folded pi from the second body on, otherwise
 * anywhere. */
static double pose_angle(const struct model_spec *spec, int i, struct random *r)
{
    if (spec->pose == POSE_STRAIGHT) return 0;
    if (spec->pose == POSE_FOLDED) return i == 0 ? 0 : PI;
    return random_uniform(r, -PI, PI);
}

/* Likewise for a joint with all rotations: folded is half a turn about z. */
static void pose_rotation(const struct model_spec *spec, int i, struct random *r, double *quat)
{
    /* Straight poses keep this identity. */
    quat[0] = quat[1] = quat[2] = 0, quat[3] = 1;
    if (spec->pose == POSE_FOLDED && i > 0)
        quat[2] = 1, quat[3] = 0;
    else if (spec->pose == POSE_COILED || spec->pose == POSE_RANDOM)
        pose_quaternion(r, quat);
}

/* Displacements are drawn in random poses alone. */
static double pose_shift(const struct model_spec *spec, struct random *r, double length)
{
    return spec->pose == POSE_RANDOM ? random_uniform(r, -length, length) : 0;
}

void pose_coordinates(const struct model_spec *spec, enum model_joint joint, int i, double length,
                      double *q)
{
    struct random r = random_make(spec->seed, STREAM_POSE, (uint64_t)i);
    bool turned = false;
    /* the numbers are drawn in the order of the coordinates, so that a type's letters are all that
     * decides them */
    for (const char *c = joint_coordinates(joint); *c; c++) {
        if (*c == 'q') {
            pose_rotation(spec, i, &r, q);
            q += 4;
        } else if (*c == 'd') {
            *q++ = pose_shift(spec, &r, length);
        } else { /* one turn of pi folds a body back; a second one would unfold it */
            *q++ = turned && spec->pose == POSE_FOLDED ? 0 : pose_angle(spec, i, &r);
            turned = true;
        }
    }
}

/* pose.h - seeded poses and streams that model generators and states share: the same spec gives the
 * same numbers. */
#ifndef MODEL_POSE_H
#define MODEL_POSE_H

#include "base/random.h"
#include "model/model.h"

/* The purposes of the random streams of a generated scene; the third key is the body. */
enum pose_stream {
    STREAM_SHAPE = 1,
    STREAM_INERTIA,
    STREAM_POSE,
    STREAM_RATE,
    STREAM_TORQUE,
    STREAM_FORCE,
    STREAM_ACCELERATION
};

/* pose_coordinates: q (nq of the joint) of body i in the pose that `spec` asks for; lengths in
 * units of `length`. */
void pose_coordinates(const struct model_spec *spec, enum model_joint joint, int i, double length,
                      double *q);

/* pose_quaternion: a uniformly distributed rotation, x y z w. */
void pose_quaternion(struct random *r, double *quat);

#endif

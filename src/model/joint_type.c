/* joint_type.c - what every joint type is called and how many coordinates and velocities it has (model.h). */
#include "model/model.h"

static const struct {
    const char *name;
    int nq, nu;
} joint_table[] = {
    [JOINT_FIXED] = {"fixed", 0, 0},           [JOINT_REVOLUTE] = {"revolute", 1, 1},
    [JOINT_PRISMATIC] = {"prismatic", 1, 1},   [JOINT_HELICAL] = {"helical", 1, 1},
    [JOINT_CYLINDRICAL] = {"cylindrical", 2, 2}, [JOINT_UNIVERSAL] = {"universal", 2, 2},
    [JOINT_SPHERICAL] = {"spherical", 4, 3},   [JOINT_PLANAR] = {"planar", 3, 3},
    [JOINT_SLOT] = {"slot", 5, 4},             [JOINT_POINT_PLANE] = {"point-plane", 6, 5},
    [JOINT_FLOATING] = {"floating", 7, 6},
};

int joint_nq(enum model_joint joint) { return joint_table[joint].nq; }
int joint_nu(enum model_joint joint) { return joint_table[joint].nu; }
const char *joint_name(enum model_joint joint) { return joint_table[joint].name; }

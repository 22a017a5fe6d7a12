/* joint_type.c - what every joint type is called and what follows from the letters of its
 * coordinates (model.h). */
#include <string.h>

#include "model/model.h"

/* The columns of JOINT_LIST that are facts of a type, not names of its code: a row a type, in the
 * order of the constants. */
static const struct {
    const char *name, *coordinates;
    enum joint_plane plane;
    int traits;
} joint_table[] = {
#define ROW(constant, word, stem, coordinates, plane, traits) {word, coordinates, plane, traits},
    JOINT_LIST(ROW)
#undef ROW
};

/* A quaternion takes four numbers of q and three of u, every other letter one of each. */
static int count(enum model_joint joint, int quaternion)
{
    int n = 0;
    for (const char *c = joint_table[joint].coordinates; *c; c++) n += *c == 'q' ? quaternion : 1;
    return n;
}

/* The row's columns, each by its name. */
int joint_nq(enum model_joint joint) { return count(joint, 4); }
int joint_nu(enum model_joint joint) { return count(joint, 3); }
const char *joint_name(enum model_joint joint) { return joint_table[joint].name; }
const char *joint_coordinates(enum model_joint joint) { return joint_table[joint].coordinates; }
enum joint_plane joint_plane(enum model_joint joint) { return joint_table[joint].plane; }
bool joint_has(enum model_joint joint, enum joint_trait trait)
{
    return joint_table[joint].traits & trait;
}

int joint_quaternion(enum model_joint joint)
{
    /* no type has more than one, and what stands before it is one number a letter */
    const char *all = joint_table[joint].coordinates, *found = strchr(all, 'q');
    return found ? (int)(found - all) : -1;
}

bool joint_is_linear(enum model_joint joint, int k)
{
    const char *c = joint_table[joint].coordinates;
    /* find the letter that k belongs to; a quaternion's three velocities are angular */
    for (; *c; c++) {
        const int n = *c == 'q' ? 3 : 1;
        if (k < n) break;
        k -= n;
    }
    return *c == 'd';
}

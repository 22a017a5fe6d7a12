/* urdf_tree.h - from the names that joints give to a tree of links. */
#ifndef MODEL_URDF_TREE_H
#define MODEL_URDF_TREE_H

#include "model/urdf.h"

struct urdf_name {
    const char *name; /* NULL: not given */
    int line;
};

/* The links that a joint names, before they are looked up. */
struct urdf_names {
    struct urdf_name parent, child;
};

/* urdf_tree: look up `names` (njoint), and fill each joint's parent and child, each link's joint,
 * and the order. Returns false with ERR_DATA as urdf_read. */
bool urdf_tree(struct urdf_robot *robot, const struct urdf_names *names, struct arena *a,
               struct err *e);

#endif

/* urdf_tree.c - from names to a tree: unknown and repeated names, two parents, two roots and cycles
 * are refused. */
#include "model/urdf_tree.h"

#include <stdlib.h>
#include <string.h>

#include "base/text.h"

/* What the steps share; the ends of joints are names until joints_resolve. */
struct maker {
    struct urdf_robot *robot;
    const struct urdf_names *names;
    struct arena *a;
    struct err *e;
};

/* A name with its place: sorted once, found by halving. */
struct named {
    const char *name;
    int line, index;
};

/* Equal names stay in the file's order, so that the second one is blamed. */
static int named_compare(const void *x, const void *y)
{
    const struct named *a = x, *b = y;
    int order = strcmp(a->name, b->name);
    return order != 0 ? order : (a->index > b->index) - (a->index < b->index);
}

/* Sort by name; a name used twice is an error at its second use. */
static bool names_sort(struct maker *m, struct named *named, int n, const char *what)
{
    /* n log n: files with ten thousand links are read at once. */
    qsort(named, (size_t)n, sizeof *named, named_compare);
    for (int i = 1; i < n; i++)
        if (strcmp(named[i - 1].name, named[i].name) == 0)
            return err_set_at(m->e, ERR_DATA, m->robot->path, named[i].line,
                              "a second %s '%.100s'; the first is on line "
                              "%d", what, named[i].name, named[i - 1].line);
    return true;
}

/* The index of the link that a joint names; the nearest name if there is none. */
static bool link_find(struct maker *m, const struct named *named, const struct urdf_joint *joint,
                      const struct urdf_name *end, const char *tag, int *index)
{
    const struct urdf_robot *robot = m->robot;
    /* A joint may lack an end altogether. */
    if (!end->name)
        return err_set_at(m->e, ERR_DATA, robot->path, joint->line, "joint '%.100s' has no <%s>",
                          joint->name, tag);
    /* By halving: a search through all links for each joint would take their square. */
    int lo = 0, hi = robot->nlink;
    while (lo < hi) {
        int mid = (lo + hi) / 2, order = strcmp(named[mid].name, end->name);
        if (order == 0) {
            *index = named[mid].index;
            return true;
        }
        if (order < 0)
            lo = mid + 1;
        else
            hi = mid;
    }
    /* Only for the message: a file is refused once. */
    const char **names = TAKE(m->a, robot->nlink, const char *);
    for (int i = 0; i < robot->nlink; i++) names[i] = named[i].name;
    return err_set_at(m->e, ERR_DATA, robot->path, end->line,
                      "joint '%.100s': there is no link '%.100s'%s", joint->name, end->name,
                      text_hint(end->name, names, robot->nlink, "").s);
}

/* Names become indices, and each link learns which joint carries it. */
static bool joints_resolve(struct maker *m, const struct named *named)
{
    struct urdf_robot *robot = m->robot;
    /* In the file's order, so that the first mistake is reported. */
    for (int j = 0; j < robot->njoint; j++) {
        struct urdf_joint *joint = &robot->joint[j];
        if (!link_find(m, named, joint, &m->names[j].parent, "parent", &joint->parent) ||
            !link_find(m, named, joint, &m->names[j].child, "child", &joint->child))
            return false;
        struct urdf_link *child = &robot->link[joint->child];
        /* Two parents would be a loop, which URDF cannot say. */
        if (child->joint >= 0)
            return err_set_at(m->e, ERR_DATA, robot->path, joint->line,
                              "link '%.100s' has two parents: joints '%.100s' and '%.100s'; loops "
                              "are not URDF",
                              child->name, robot->joint[child->joint].name, joint->name);
        child->joint = j;
    }
    return true;
}

/* The one link that nothing carries. Without any, the joints lead round. */
static bool root_find(struct maker *m, int *root)
{
    const struct urdf_robot *robot = m->robot;
    *root = -1;
    for (int i = 0; i < robot->nlink; i++) {
        if (robot->link[i].joint >= 0) continue;
        /* A second one: the robot is in two pieces. */
        if (*root >= 0)
            return err_set_at(m->e, ERR_DATA, robot->path, robot->link[i].line,
                              "two roots: no joint carries link '%.100s', nor '%.100s' on line "
                              "%d", robot->link[i].name,
                              robot->link[*root].name, robot->link[*root].line);
        *root = i;
    }
    return *root >= 0 || err_set_at(m->e, ERR_DATA, robot->path, robot->link[0].line,
                                    "every link is carried by a joint: the joints form a cycle "
                                    "through '%.100s'",
                                    robot->link[0].name);
}

/* Depth first with first-child and next-sibling lists; what is not reached hangs on a cycle. */
static bool order_walk(struct maker *m, int root)
{
    struct urdf_robot *robot = m->robot;
    int *first = TAKE(m->a, robot->nlink, int), *next = TAKE(m->a, robot->nlink, int),
        *stack = TAKE(m->a, robot->nlink, int);
    /* A cycle beside the tree has no root of its own: only the walk finds it. */
    bool *reached = TAKE(m->a, robot->nlink, bool);
    int n = 0, top = 0;
    robot->order = TAKE(m->a, robot->nlink, int);
    for (int i = 0; i < robot->nlink; i++) first[i] = next[i] = -1;
    /* the file's last child comes first, so that the stack gives the first */
    for (int j = 0; j < robot->njoint; j++) {
        next[robot->joint[j].child] = first[robot->joint[j].parent];
        first[robot->joint[j].parent] = robot->joint[j].child;
    }
    /* No recursion: a long chain would overflow the program's stack. This one never holds more
     * than all links, since each has one carrier. */
    stack[top++] = root;
    while (top > 0) {
        int i = stack[--top];
        reached[i] = true;
        robot->order[n++] = i;
        for (int c = first[i]; c >= 0; c = next[c]) stack[top++] = c;
    }
    for (int i = 0; i < robot->nlink; i++)
        /* Each link has one parent, so what is not reached hangs on itself. */
        if (!reached[i])
            return err_set_at(m->e, ERR_DATA, robot->path, robot->link[i].line,
                              "link '%.100s' is not connected to the root '%.100s': its joints "
                              "form a cycle",
                              robot->link[i].name, robot->link[root].name);
    return true;
}

/* Names, ends, root, order: each step relies on the one before. */
bool urdf_tree(struct urdf_robot *robot, const struct urdf_names *names, struct arena *a,
               struct err *e)
{
    struct maker maker = {robot, names, a, e}, *m = &maker;
    if (robot->nlink == 0)
        return err_set_at(m->e, ERR_DATA, robot->path, 0, "the robot has no links");
    /* Two sorted lists: links are looked up, joints only compared. */
    struct named *links = TAKE(m->a, robot->nlink, struct named),
                 *joints = TAKE(m->a, robot->njoint, struct named);
    for (int i = 0; i < robot->nlink; i++)
        links[i] = (struct named){robot->link[i].name, robot->link[i].line, i};
    for (int j = 0; j < robot->njoint; j++)
        joints[j] = (struct named){robot->joint[j].name, robot->joint[j].line, j};
    int root;
    return names_sort(m, links, robot->nlink, "link") &&
           names_sort(m, joints, robot->njoint, "joint") && joints_resolve(m, links) &&
           root_find(m, &root) && order_walk(m, root);
}

/* vector_check.c - what a reference vector must and must not hold; see the header. */
#include "model/vector_check.h"

#include <math.h>
#include <string.h>

#include "base/text.h"

/* --- known keys ------------------------------------------------------------------------------- */

/* Every key of the format, read or not: what is not here is a mistake. */
static const char *const file_keys[] = {
    "format", "name", "group", "note", "comment", "source", "seed", "answers", "urdf", "gravity",
    "nq", "nv", "bodies",
    "loops", "q", "qd", "qdd", "tau", "f_ext", "joint_spring", "joint_spring_q0", "joint_damping",
    "tau_id", "qdd_fd",
    "lambda", "bias", "gravity_torque", "M", "energy", "momentum", "com_world", "total_mass", "fk",
    "joint_wrench_id",
    "input_rounding_floor", "peers", "loop_position_residual", "loop_velocity_residual",
    "trajectory",
    "states_45_digits", NULL};
static const char *const body_keys[] = {"parent",      "joint",     "placement",  "mass", "com",
                                        "inertia_com", "link_name", "joint_name", NULL};
static const char *const joint_keys[] = {"type", "axis", NULL};
static const char *const frame_keys[] = {"p", "quat", "R", NULL};
static const char *const loop_keys[] = {"body_a", "body_b", "frame_a", "frame_b", "rows", NULL};
static const char *const energy_keys[] = {"kinetic", "potential", "total", NULL};
static const char *const momentum_keys[] = {"linear", "angular_about_world_origin", NULL};
static const char *const pose_keys[] = {"body", "R", "p", "v", "w", "a", "alpha", NULL};
static const char *const floor_keys[] = {"tau_id", "qdd_fd", NULL};
static const char *const trajectory_keys[] = {"method",
                                              "times",
                                              "states",
                                              "verified_accuracy_max_abs_diff",
                                              "sensitivity_to_initial_state",
                                              "relative_energy_drift_of_reference",
                                              NULL};
static const char *const state_keys[] = {"q", "qd", "energy", "momentum", NULL};

/* Up to the NULL at the end. */
static int count(const char *const *name)
{
    int n = 0;
    while (name[n]) n++;
    return n;
}

struct checker {
    const char *path;
    struct err *e;
};

/* Every key of `map` is among `known`; a map that is missing or of another kind is for its reader
 * to refuse. */
static bool known(const struct checker *c, const struct node *map, const char *const *name)
{
    if (!map || map->kind != NODE_MAP) return true;
    for (const struct node *x = map->child; x; x = x->next) {
        /* A handful of names: no need to sort them. */
        int k = 0;
        while (name[k] && strcmp(name[k], x->key) != 0) k++;
        if (name[k]) continue;
        /* Misspelled answers would otherwise be answers that nobody checks. */
        return err_set_at(c->e, ERR_DATA, c->path, x->line, "unknown key '%.80s'%s", x->key,
                          text_hint(x->key, name, count(name), "").s);
    }
    return true;
}

/* A missing list is for its reader to refuse: here it has no entries. */
static bool bodies_known(const struct checker *c, const struct node *list)
{
    for (const struct node *x = list ? list->child : NULL; x; x = x->next)
        if (!known(c, x, body_keys) || !known(c, document_find(x, "joint"), joint_keys) ||
            !known(c, document_find(x, "placement"), frame_keys))
            return false;
    return true;
}

/* As bodies_known: frames have keys of their own. */
static bool loops_known(const struct checker *c, const struct node *list)
{
    for (const struct node *x = list ? list->child : NULL; x; x = x->next)
        if (!known(c, x, loop_keys) || !known(c, document_find(x, "frame_a"), frame_keys) ||
            !known(c, document_find(x, "frame_b"), frame_keys))
            return false;
    return true;
}

/* The same keys in the file and in each state of a trajectory. */
static bool totals_known(const struct checker *c, const struct node *map)
{
    return known(c, document_find(map, "energy"), energy_keys) &&
           known(c, document_find(map, "momentum"), momentum_keys);
}

/* A state has totals of its own, as a file has at its top. */
static bool trajectory_known(const struct checker *c, const struct node *map)
{
    const struct node *states = document_find(map, "states");
    for (const struct node *x = states ? states->child : NULL; x; x = x->next)
        if (!known(c, x, state_keys) || !totals_known(c, x)) return false;
    return known(c, map, trajectory_keys);
}

/* The list 'answers' names keys of the file. */
static bool answers_known(const struct checker *c, const struct node *list)
{
    for (const struct node *x = list ? list->child : NULL; x; x = x->next) {
        /* A made-up mapping with that key, for the same message. */
        struct node key = {.kind = NODE_MAP,
                           .child = &(struct node){.line = x->line, .key = x->text ? x->text : ""}};
        if (!known(c, &key, file_keys)) return false;
    }
    return true;
}

/* What other libraries reached ('peers') is not looked into: free text. */
bool vector_check_keys(const struct node *root, const char *path, struct err *e)
{
    const struct checker c = {path, e};
    const struct node *fk = document_find(root, "fk");
    for (const struct node *x = fk ? fk->child : NULL; x; x = x->next)
        if (!known(&c, x, pose_keys)) return false;
    return known(&c, root, file_keys) && answers_known(&c, document_find(root, "answers")) &&
           bodies_known(&c, document_find(root, "bodies")) &&
           loops_known(&c, document_find(root, "loops")) && totals_known(&c, root) &&
           known(&c, document_find(root, "input_rounding_floor"), floor_keys) &&
           trajectory_known(&c, document_find(root, "trajectory"));
}

/* --- what is given twice ---------------------------------------------------------------------- */

/* R is there for readers without quaternions; both must be the same rotation. */
bool vector_check_frame(const struct vector_frame *f, const struct node *at, const char *path,
                        struct err *e)
{
    const double x = f->quat[0], y = f->quat[1], z = f->quat[2], w = f->quat[3];
    /* s = 2 / |quat|^2 normalises, since the quaternion is off by rounding. R is rounded once,
     * and the formula adds a few roundings of its own: hence `few`. */
    const double s = 2 / (x * x + y * y + z * z + w * w), few = 1e-15;
    const double R[9] = {1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w),
                         s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w),
                         s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)};
    for (int k = 0; k < 9; k++) {
        /* Both in as many digits as tell doubles apart: six would often look the same. */
        char is[32], turned[32];
        if (fabs(R[k] - f->R[k]) <= few) continue;
        text_real(is, f->R[k]);
        text_real(turned, R[k]);
        return err_set_at(e, ERR_DATA, path, at->line,
                          "number %d of 'R' is %s, but 'quat' turns it into %s", k + 1, is, turned);
    }
    return true;
}

/* --- what is missing -------------------------------------------------------------------------- */

/* Does the file say that it has other answers than all, and not this one? */
static bool left_out(const struct vector_case *c, const char *key)
{
    if (!c->declared) return false;
    /* The list names what the file does have. */
    for (const struct node *x = c->declared->child; x; x = x->next)
        if (x->kind == NODE_TEXT && strcmp(x->text, key) == 0) return false;
    return true;
}

/* A missing answer must be said, so that no check disappears silently. */
bool vector_complete(const struct vector_case *c, struct err *e)
{
    /* The sizes up to which the format promises M and the joint wrenches (README of the data). */
    enum { FULL_MATRIX = 24, FULL_WRENCHES = 64 };
    /* Trajectories have states instead of answers at one instant. */
    const bool still = c->ninstant == 0;
    const struct { const char *key; bool needed, given; } answer[] = {
        {"tau_id", still, c->tau_id != NULL},
        {"qdd_fd", still, c->qdd_fd != NULL},
        {"lambda", still && c->nrow > 0, c->lambda != NULL},
        {"bias", still, c->bias != NULL},
        {"gravity_torque", still, c->gravity_torque != NULL},
        {"M", still && c->nv <= FULL_MATRIX, c->mass_matrix != NULL},
        {"energy", still, c->has_energy},
        {"momentum", still, c->has_momentum},
        {"com_world", still, c->has_com},
        {"fk", still, c->npose > 0},
        {"joint_wrench_id", still && c->nbody <= FULL_WRENCHES, c->joint_wrench != NULL},
    };
    enum { ANSWERS = sizeof answer / sizeof *answer };
    for (int k = 0; k < ANSWERS; k++) {
        bool absent = left_out(c, answer[k].key);
        /* A list 'answers' must be the truth both ways: all that it names, and nothing else. */
        if (answer[k].given && absent)
            return err_set_at(e, ERR_DATA, c->path, c->declared->line,
                              "'%s' is given, but not in the list 'answers'", answer[k].key);
        /* A list decides alone; without one the format's promise does. */
        if (answer[k].given || (c->declared ? absent : !answer[k].needed)) continue;
        return err_set_at(e, ERR_DATA, c->path, c->declared ? c->declared->line : 1,
                          "the answer '%s' is missing; a file without it lists what it has in "
                          "'answers'",
                          answer[k].key);
    }
    return true;
}

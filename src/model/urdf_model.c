/* urdf_model.c - models made from URDF robots: links become bodies, unless they are fixed to
 * another one. */
#include "model/urdf_model.h"

#include <string.h>

#include "base/text.h"
#include "model/lump.h"

/* Continuous joints are revolute ones without limits, and limits do not act here. */
static enum model_joint joint_from(enum urdf_kind kind)
{
    switch (kind) {
    case URDF_REVOLUTE:
    case URDF_CONTINUOUS: return JOINT_REVOLUTE;
    case URDF_PRISMATIC: return JOINT_PRISMATIC;
    case URDF_FLOATING: return JOINT_FLOATING;
    case URDF_PLANAR: return JOINT_PLANAR;
    default: return JOINT_FIXED;
    }
}

/* Link axes from inertial axes: J_link = R J R^T, as a lump of one part. */
static void inertia_from(const struct urdf_link *link, struct body_def *def)
{
    /* URDF gives inertia in axes of its own, turned against the link's, about the centre of
     * mass: so no shift comes in. */
    struct frame f;
    memcpy(f.quat, link->quat, sizeof f.quat);
    memset(f.p, 0, sizeof f.p);
    frame_normalise(&f);
    double column[3][3], full[3][3];
    const double *j = link->inertia;
    const double rows[3][3] = {{j[0], j[1], j[2]}, {j[1], j[3], j[4]}, {j[2], j[4], j[5]}};
    for (int k = 0; k < 3; k++) frame_turn(&f, rows[k], column[k]);      /* column[k] = R J e_k */
    for (int i = 0; i < 3; i++) {
        const double row[3] = {column[0][i], column[1][i], column[2][i]}; /* row i of R J */
        /* (R J R^T)^T, symmetric */
        frame_turn(&f, row, full[i]);
    }
    const double out[6] = {full[0][0], (full[0][1] + full[1][0]) / 2, (full[0][2] + full[2][0]) / 2,
                           full[1][1], (full[1][2] + full[2][1]) / 2, full[2][2]};
    /* Bits as in the file where nothing has to be turned. */
    bool turned = link->quat[0] != 0 || link->quat[1] != 0 || link->quat[2] != 0;
    memcpy(def->inertia, turned ? out : j, sizeof out);
}

/* A link and the joint that carries it are one body here. */
static struct body_def body_from(const struct urdf_robot *robot, int link_index)
{
    const struct urdf_link *link = &robot->link[link_index];
    struct body_def def = {
        .mass = link->mass, .line = link->inertial_line, .placement = {.quat = {0, 0, 0, 1}}};
    text_copy(def.name, sizeof def.name, link->name);
    memcpy(def.com, link->com, sizeof def.com);
    inertia_from(link, &def);
    /* The root has no joint; a floating one gets it from the caller. */
    if (link->joint < 0) return def;
    const struct urdf_joint *joint = &robot->joint[link->joint];
    def.joint = joint_from(joint->kind);
    memcpy(def.axis, joint->axis, sizeof def.axis);
    memcpy(def.placement.p, joint->p, sizeof joint->p);
    memcpy(def.placement.quat, joint->quat, sizeof joint->quat);
    if (joint_nu(def.joint) == 1) def.damping = joint->damping;
    return def;
}

/* A link that has mass or inertia must be one that a body can have; one that has neither must not
 * have to move alone. */
static bool link_check(const struct urdf_robot *robot, int i, const struct urdf_options *o,
                       struct arena *a, struct err *e)
{
    const struct urdf_link *link = &robot->link[i];
    /* Frames of tools and sensors: no mass, no inertia. */
    bool frame_only = link->mass == 0;
    for (int k = 0; k < 6; k++) frame_only = frame_only && link->inertia[k] == 0;
    if (link->mass < 0)
        return err_set_at(e, ERR_DATA, robot->path, link->inertial_line,
                          "link '%.100s' has negative mass %g kg", link->name, link->mass);
    bool is_base = link->joint < 0 && !o->floating;
    if (o->allow_nonphysical || (frame_only && (is_base || !o->keep_fixed))) return true;
    /* Only where every link is to be a body (keep_fixed): without mass it cannot be one. */
    if (!link->has_inertial)
        return err_set_at(e, ERR_DATA, robot->path, link->line,
                          "link '%.100s' has no <inertial>: a body needs mass", link->name);
    /* Each link by itself, as a model of one body: once fixed links are merged, a bad inertia
     * may hide in a good sum, and its line is lost. */
    struct arena_mark mark = arena_mark(a);
    struct model *alone = model_begin(a, robot->path);
    struct body_def def = body_from(robot, i);
    def.parent = -1;
    bool good = model_add_body(alone, &def, e) >= 0 && model_finish(alone, false, e);
    arena_release(a, mark);
    return good;
}

/* A body for every link; the root is body 0 of a floating robot and no body of a fixed one.
 * In the order of the tree: parents first. */
static struct model *every_link(const struct urdf_robot *robot, const struct urdf_options *o,
                                bool allow, struct arena *a, struct err *e)
{
    struct model *m = model_begin(a, robot->path);
    /* Links by their number in the file, bodies by that in the tree. */
    int *body = TAKE(a, robot->nlink, int);
    memcpy(m->gravity, o->gravity, sizeof m->gravity);
    for (int k = 0; k < robot->nlink; k++) {
        int i = robot->order[k];
        const struct urdf_link *link = &robot->link[i];
        if (!link_check(robot, i, o, a, e)) return NULL;
        struct body_def def = body_from(robot, i);
        body[i] = -1;
        /* The root of a fixed robot is the base itself. */
        if (k == 0 && !o->floating) continue;
        def.parent = k == 0 ? -1 : body[robot->joint[link->joint].parent];
        if (k == 0) def.joint = JOINT_FLOATING;
        body[i] = model_add_body(m, &def, e);
        if (body[i] < 0) return NULL;
    }
    if (m->nbody == 0) {
        err_set_at(e, ERR_DATA, robot->path, 0, "the robot is a single fixed link: nothing moves");
        return NULL;
    }
    return model_finish(m, allow, e) ? m : NULL;
}

/* Frames on fixed joints would fail the check for mass, so it is put off until they are lumped. */
struct model *urdf_model(const struct urdf_robot *robot, const struct urdf_options *o,
                         struct arena *a, struct err *e)
{
    struct lumped lumped;
    struct model *m = every_link(robot, o, o->allow_nonphysical || !o->keep_fixed, a, e);
    if (!m || o->keep_fixed) return m;
    if (!lump_fixed(m, o->allow_nonphysical, a, &lumped, e)) return NULL;
    if (!lumped.model)
        err_set_at(e, ERR_DATA, robot->path, 0, "all joints are fixed: nothing moves");
    return lumped.model;
}

/* As a scenario asks for it: base and gravity are settings. */
struct model *urdf_model_build(const struct model_spec *spec, struct arena *a, struct err *e)
{
    struct urdf_robot robot;
    struct urdf_options o = {.floating = spec->base == BASE_FLOATING};
    memcpy(o.gravity, spec->gravity, sizeof o.gravity);
    return urdf_read(spec->path, &robot, a, e) ? urdf_model(&robot, &o, a, e) : NULL;
}

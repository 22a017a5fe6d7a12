/* urdf.c - reading URDF with expat: elements into links and joints.
 *
 * A stack of open elements says where we are; only the dozen elements that matter for dynamics have
 * a reader. A tag or attribute that looks like a misspelling of one of them is an error, since
 * skipping it would change the robot. */
#include "model/urdf.h"

#include <expat.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "model/urdf_tree.h"

enum { MAX_DEPTH = 64, MAX_BYTES = 64 * 1024 * 1024 };

static const char *const kind_name[URDF_KINDS] = {"fixed",     "revolute", "continuous",
                                                  "prismatic", "floating", "planar"};

const char *urdf_kind_name(enum urdf_kind kind) { return kind_name[kind]; }

/* Where a tag stands decides what it means: <origin> of a link's inertia or of a joint. */
enum where { IN_FILE, IN_ROBOT, IN_LINK, IN_INERTIAL, IN_JOINT, IN_LEAF, IN_SKIPPED };

struct reader {
    XML_Parser parser;
    struct arena *a;
    struct err *e;
    struct urdf_robot *robot;
    struct urdf_names *names;         /* one per joint */
    int link_capacity, joint_capacity, warning_capacity;
    enum where where[MAX_DEPTH];
    int depth;
    bool has_mass, has_inertia;       /* of the <inertial> being read */
};

/* The line of the tag that expat reports at the moment. */
static int line_now(const struct reader *r) { return (int)XML_GetCurrentLineNumber(r->parser); }

/* Record an error at the present line and stop. */
static void refuse(struct reader *r, const char *text)
{
    err_set_at(r->e, ERR_DATA, r->robot->path, line_now(r), "%s", text);
    XML_StopParser(r->parser, XML_FALSE);
}

/* The first mistake stops the reader; expat may still report a few tags. Long names are cut: the
 * line says where. */
#define REFUSE(r, ...)                                                                             \
    do {                                                                                           \
        char refuse_text[512];                                                                     \
        snprintf(refuse_text, sizeof refuse_text, __VA_ARGS__);                                    \
        refuse((r), refuse_text);                                                                  \
    } while (0)

/* Room for one more element in an array of the arena, doubled when full. */
static void *grown(struct arena *a, void *array, int count, int *capacity, size_t size)
{
    if (count < *capacity) return array;
    *capacity = *capacity > 0 ? 2 * *capacity : 32;
    void *larger = arena_take(a, (size_t)*capacity * size);
    if (count > 0) memcpy(larger, array, (size_t)count * size);
    return larger;
}

/* What is left out changes the robot: users are told, the file is read all the same. */
static void warn(struct reader *r, const char *text)
{
    struct urdf_robot *robot = r->robot;
    robot->warning =
        grown(r->a, robot->warning, robot->nwarning, &r->warning_capacity, sizeof *robot->warning);
    robot->warning[robot->nwarning++] = (struct urdf_warning){line_now(r), arena_text(r->a, text)};
}

#define WARN(r, ...)                                                                               \
    do {                                                                                           \
        char warn_text[256];                                                                       \
        snprintf(warn_text, sizeof warn_text, __VA_ARGS__);                                        \
        warn((r), warn_text);                                                                      \
    } while (0)

/* --- attributes ------------------------------------------------------------------------------- */

/* expat gives names and values in turns. */
static const char *attribute(const char **attributes, const char *name)
{
    for (int i = 0; attributes[i]; i += 2)
        if (strcmp(attributes[i], name) == 0) return attributes[i + 1];
    return NULL;
}

/* Exactly n finite numbers separated by blanks. */
static bool numbers_parse(struct reader *r, const char *tag, const char *name, const char *s,
                          double *x, int n)
{
    const char *at = s;
    for (int i = 0; i < n; i++) {
        /* No locale is ever set: a decimal point is a point. */
        char *end;
        x[i] = strtod(at, &end);
        /* xacro files look like URDF until their first expression. */
        if (end == at || !isfinite(x[i])) {
            REFUSE(r, "<%s> %s=\"%.60s\": %d finite number%s expected%s", tag, name, s, n,
                   n > 1 ? "s" : "", strstr(s, "${") ? "; expand xacro first" : "");
            return false;
        }
        at = end;
    }
    if (at[strspn(at, " \t\r\n")] != 0)
        REFUSE(r, "<%s> %s=\"%.60s\": text after the last number", tag, name, s);
    return r->e->kind == ERR_NONE;
}

/* Numbers of an attribute that may be left out; x then keeps its value. */
static bool numbers_maybe(struct reader *r, const char *tag, const char **attributes,
                          const char *name, double *x, int n)
{
    const char *s = attribute(attributes, name);
    return !s || numbers_parse(r, tag, name, s, x, n);
}

/* Required: URDF has no default for it. */
static bool number_need(struct reader *r, const char *tag, const char **attributes,
                        const char *name, double *x)
{
    const char *s = attribute(attributes, name);
    if (!s) REFUSE(r, "<%s> without %s=", tag, name);
    return s && numbers_parse(r, tag, name, s, x, 1);
}

/* Names outlive the parser. */
static const char *name_need(struct reader *r, const char *tag, const char **attributes,
                             const char *name)
{
    const char *s = attribute(attributes, name);
    if (s && s[0]) return arena_text(r->a, s);
    REFUSE(r, "<%s> without a %s", tag, name);
    return NULL;
}

/* --- elements --------------------------------------------------------------------------------- */

/* Elements belong to the link or joint that was opened last. */
static struct urdf_link *link_now(struct reader *r) { return &r->robot->link[r->robot->nlink - 1]; }
static struct urdf_joint *joint_now(struct reader *r)
{
    return &r->robot->joint[r->robot->njoint - 1];
}

/* Rotations about the fixed x, y, z axes in this order. */
static void quat_from_rpy(const double rpy[3], double quat[4])
{
    /* Quaternion of Rz(yaw) Ry(pitch) Rx(roll) by half angles. */
    double cr = cos(rpy[0] / 2), sr = sin(rpy[0] / 2), cp = cos(rpy[1] / 2), sp = sin(rpy[1] / 2);
    double cy = cos(rpy[2] / 2), sy = sin(rpy[2] / 2);
    quat[0] = sr * cp * cy - cr * sp * sy;
    quat[1] = cr * sp * cy + sr * cp * sy;
    quat[2] = cr * cp * sy - sr * sp * cy;
    quat[3] = cr * cp * cy + sr * sp * sy;
}

/* Both parts may be left out. */
static void origin_read(struct reader *r, const char **attributes, double p[3], double quat[4])
{
    double rpy[3] = {0, 0, 0};
    if (numbers_maybe(r, "origin", attributes, "xyz", p, 3) &&
        numbers_maybe(r, "origin", attributes, "rpy", rpy, 3))
        quat_from_rpy(rpy, quat);
}

/* A link without <inertial> is a frame; its own line stands for the missing one. */
static void link_read(struct reader *r, const char **attributes)
{
    struct urdf_robot *robot = r->robot;
    const char *name = name_need(r, "link", attributes, "name");
    if (!name) return;
    robot->link = grown(r->a, robot->link, robot->nlink, &r->link_capacity, sizeof *robot->link);
    robot->link[robot->nlink++] = (struct urdf_link){
        .name = name, .line = line_now(r), .inertial_line = line_now(r), .quat = {0, 0, 0, 1},
        .joint = -1};
}

/* Mass and inertia may come in any order; which of them came is asked at the end (on_end). */
static void inertial_read(struct reader *r, const char **attributes)
{
    (void)attributes;
    struct urdf_link *link = link_now(r);
    if (link->has_inertial) REFUSE(r, "link '%.100s' has a second <inertial>", link->name);
    link->has_inertial = true;
    link->inertial_line = line_now(r);
    r->has_mass = r->has_inertia = false;
}

/* A negative mass is refused later, with the link's name. */
static void mass_read(struct reader *r, const char **attributes)
{
    r->has_mass = number_need(r, "mass", attributes, "value", &link_now(r)->mass);
}

/* Six numbers about the centre of mass, in the axes of <origin>. Entries off the diagonal have
 * the tensor's sign, as in body_def. */
static void inertia_read(struct reader *r, const char **attributes)
{
    static const char *const name[6] = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
    for (int i = 0; i < 6; i++)
        if (!number_need(r, "inertia", attributes, name[i], &link_now(r)->inertia[i])) return;
    r->has_inertia = true;
}

/* Of <inertial>: place and axes of the inertia. */
static void link_origin_read(struct reader *r, const char **attributes)
{
    origin_read(r, attributes, link_now(r)->com, link_now(r)->quat);
}

/* On failure *kind is the last type tried; nobody reads it. */
static bool kind_read(struct reader *r, const char *joint, const char *type, enum urdf_kind *kind)
{
    for (int k = 0; k < URDF_KINDS; k++) {
        *kind = (enum urdf_kind)k;
        if (strcmp(type, kind_name[k]) == 0) return true;
    }
    /* Types of other formats, such as "hinge", have no near name: then all are listed. */
    static const char all[] = "; known: fixed, revolute, continuous, prismatic, floating, planar";
    REFUSE(r, "joint '%.100s' has unknown type '%.60s'%s", joint, type,
           text_hint(type, kind_name, URDF_KINDS, all).s);
    return false;
}

/* Ends are names until all links are known. */
static void joint_read(struct reader *r, const char **attributes)
{
    struct urdf_robot *robot = r->robot;
    const char *name = name_need(r, "joint", attributes, "name");
    const char *type = name ? name_need(r, "joint", attributes, "type") : NULL;
    enum urdf_kind kind;
    if (!type || !kind_read(r, name, type, &kind)) return;
    /* Two arrays grow together: the first must not move the common capacity. */
    int capacity = r->joint_capacity;
    r->names = grown(r->a, r->names, robot->njoint, &capacity, sizeof *r->names);
    robot->joint =
        grown(r->a, robot->joint, robot->njoint, &r->joint_capacity, sizeof *robot->joint);
    r->names[robot->njoint] = (struct urdf_names){{NULL, 0}, {NULL, 0}};
    robot->joint[robot->njoint++] = (struct urdf_joint){.name = name,
                                                        .line = line_now(r),
                                                        .kind = kind,
                                                        .axis = {1, 0, 0},
                                                        .quat = {0, 0, 0, 1},
                                                        .lower = -INFINITY,
                                                        .upper = INFINITY,
                                                        .effort = INFINITY,
                                                        .velocity = INFINITY};
}

/* Of a joint: its frame in the parent link. */
static void joint_origin_read(struct reader *r, const char **attributes)
{
    origin_read(r, attributes, joint_now(r)->p, joint_now(r)->quat);
}

/* Once each: of two parents the last would win in silence. */
static void end_read(struct reader *r, const char **attributes, const char *tag,
                     struct urdf_name *end)
{
    if (end->name) REFUSE(r, "joint '%.100s' has a second <%s>", joint_now(r)->name, tag);
    *end = (struct urdf_name){name_need(r, tag, attributes, "link"), line_now(r)};
}

/* Only a name: the link may stand later in the file (urdf_tree.h). */
static void parent_read(struct reader *r, const char **attributes)
{
    end_read(r, attributes, "parent", &r->names[r->robot->njoint - 1].parent);
}

/* As parent_read: a link may stand after the joint that names it. */
static void child_read(struct reader *r, const char **attributes)
{
    end_read(r, attributes, "child", &r->names[r->robot->njoint - 1].child);
}

/* URDF's default is x. Given axes are made unit by hypot: no square overflows or vanishes. */
static void axis_read(struct reader *r, const char **attributes)
{
    struct urdf_joint *joint = joint_now(r);
    double x[3] = {1, 0, 0};
    if (!numbers_maybe(r, "axis", attributes, "xyz", x, 3)) return;
    double length = hypot(hypot(x[0], x[1]), x[2]);
    /* Fixed and floating joints have none. */
    bool needed = joint->kind != URDF_FIXED && joint->kind != URDF_FLOATING;
    if (needed && !(length > 1e-100))
        REFUSE(r, "the axis of joint '%.100s' has length zero", joint->name);
    for (int i = 0; i < 3 && length > 0; i++) joint->axis[i] = x[i] / length;
}

/* Kept, but no joint stops there. URDF takes 0 for a bound that is left out beside the other. */
static void limit_read(struct reader *r, const char **attributes)
{
    struct urdf_joint *joint = joint_now(r);
    bool sliding = joint->kind == URDF_REVOLUTE || joint->kind == URDF_PRISMATIC;
    bool range = attribute(attributes, "lower") || attribute(attributes, "upper");
    double lower = 0, upper = 0;
    if (!numbers_maybe(r, "limit", attributes, "lower", &lower, 1) ||
        !numbers_maybe(r, "limit", attributes, "upper", &upper, 1) ||
        !numbers_maybe(r, "limit", attributes, "effort", &joint->effort, 1) ||
        !numbers_maybe(r, "limit", attributes, "velocity", &joint->velocity, 1))
        return;
    /* Continuous joints give effort and velocity alone. */
    if (!sliding || !range) return;
    if (lower > upper)
        REFUSE(r, "joint '%.100s': lower limit %g above upper limit %g", joint->name, lower, upper);
    joint->has_limit = true;
    joint->lower = lower;
    joint->upper = upper;
}

/* Viscous damping acts, dry friction does not. */
static void dynamics_read(struct reader *r, const char **attributes)
{
    struct urdf_joint *joint = joint_now(r);
    double friction = 0;
    if (!numbers_maybe(r, "dynamics", attributes, "damping", &joint->damping, 1) ||
        !numbers_maybe(r, "dynamics", attributes, "friction", &friction, 1))
        return;
    if (joint->damping < 0)
        REFUSE(r, "joint '%.100s' has negative damping %g", joint->name, joint->damping);
    if (friction != 0)
        WARN(r, "joint '%.100s': dry friction is not supported; ignored", joint->name);
}

/* It would be a constraint between coordinates, which models do not have. */
static void mimic_read(struct reader *r, const char **attributes)
{
    const char *other = attribute(attributes, "joint");
    WARN(r, "joint '%.80s' mimics '%.80s': not supported; it moves on its own", joint_now(r)->name,
         other ? other : "?");
}

/* The elements that are known in each place: with a reader, skipped, or skipped with a warning. */
struct element {
    const char *tag;
    enum where in, opens;
    void (*read)(struct reader *r, const char **attributes);
    bool matters;                   /* skipped, but would change the motion: warn */
    const char *attribute[8];       /* known ones, for misspellings; none: not checked */
};

/* Place, then tag: the same tag has several rows. */
static const struct element element_table[] = {
    {"link", IN_ROBOT, IN_LINK, link_read, false, {"name", "type"}},
    {"joint", IN_ROBOT, IN_JOINT, joint_read, false, {"name", "type"}},
    {"material", IN_ROBOT, IN_SKIPPED, NULL, false, {0}},
    {"transmission", IN_ROBOT, IN_SKIPPED, NULL, true, {0}},
    {"gazebo", IN_ROBOT, IN_SKIPPED, NULL, true, {0}},
    {"sensor", IN_ROBOT, IN_SKIPPED, NULL, false, {0}},
    {"inertial", IN_LINK, IN_INERTIAL, inertial_read, false, {0}},
    {"visual", IN_LINK, IN_SKIPPED, NULL, false, {0}},
    {"collision", IN_LINK, IN_SKIPPED, NULL, false, {0}},
    {"origin", IN_INERTIAL, IN_LEAF, link_origin_read, false, {"xyz", "rpy"}},
    {"mass", IN_INERTIAL, IN_LEAF, mass_read, false, {"value"}},
    {"inertia", IN_INERTIAL, IN_LEAF, inertia_read, false, {"ixx", "ixy", "ixz", "iyy", "iyz",
     "izz"}},
    {"origin", IN_JOINT, IN_LEAF, joint_origin_read, false, {"xyz", "rpy"}},
    {"parent", IN_JOINT, IN_LEAF, parent_read, false, {"link"}},
    {"child", IN_JOINT, IN_LEAF, child_read, false, {"link"}},
    {"axis", IN_JOINT, IN_LEAF, axis_read, false, {"xyz"}},
    {"limit", IN_JOINT, IN_LEAF, limit_read, false, {"lower", "upper", "effort", "velocity"}},
    {"dynamics", IN_JOINT, IN_LEAF, dynamics_read, false, {"damping", "friction"}},
    {"mimic", IN_JOINT, IN_LEAF, mimic_read, false, {0}},
    {"safety_controller", IN_JOINT, IN_SKIPPED, NULL, true, {0}},
    {"calibration", IN_JOINT, IN_SKIPPED, NULL, false, {0}},
};
enum { ELEMENTS = sizeof element_table / sizeof *element_table };

/* A misspelled attribute would be a missing one. */
static void attributes_check(struct reader *r, const struct element *element,
                             const char **attributes)
{
    int known = 0;
    while (known < 8 && element->attribute[known]) known++;
    for (int i = 0; known > 0 && attributes[i]; i += 2) {
        bool found = false;
        for (int k = 0; k < known; k++)
            found = found || strcmp(attributes[i], element->attribute[k]) == 0;
        /* What is like a known name is a mistake, what is like none an extension. */
        const char *nearest = found ? NULL : text_nearest(attributes[i], element->attribute, known);
        if (nearest)
            REFUSE(r, "<%s> has an unknown attribute '%.60s'; did you mean '%s'?", element->tag,
                   attributes[i], nearest);
        else if (!found)
            WARN(r, "<%s>: unknown attribute '%.60s' ignored", element->tag, attributes[i]);
    }
}

/* Extensions of other programs are skipped, misspellings refused. */
static enum where element_unknown(struct reader *r, const char *tag, enum where in)
{
    /* Only the tags of this place: <origin> under <link> is as wrong as an unknown one. */
    const char *known[ELEMENTS];
    int n = 0;
    for (int i = 0; i < ELEMENTS; i++)
        if (element_table[i].in == in) known[n++] = element_table[i].tag;
    const char *nearest = text_nearest(tag, known, n);
    if (nearest)
        REFUSE(r, "unknown element <%.60s>; did you mean <%s>?", tag, nearest);
    else if (in != IN_LEAF)
        WARN(r, "unknown element <%.60s> ignored", tag);
    return IN_SKIPPED;
}

/* Attributes are checked first: after a refusal the reader would only add a second message. */
static enum where element_read(struct reader *r, const char *tag, enum where in,
                               const char **attributes)
{
    for (int i = 0; i < ELEMENTS; i++) {
        const struct element *element = &element_table[i];
        if (element->in != in || strcmp(element->tag, tag) != 0) continue;
        attributes_check(r, element, attributes);
        if (element->matters) WARN(r, "<%s> is not supported; ignored", tag);
        if (element->read && r->e->kind == ERR_NONE) element->read(r, attributes);
        return element->opens;
    }
    return element_unknown(r, tag, in);
}

/* A stack instead of recursion, since expat calls us. Below a skipped element all is skipped. */
static void XMLCALL on_start(void *context, const char *tag, const char **attributes)
{
    struct reader *r = context;
    if (r->e->kind != ERR_NONE) return;
    /* The stack is of fixed size; what is read lies at most four elements deep. */
    if (r->depth == MAX_DEPTH) {
        REFUSE(r, "nested deeper than %d elements", MAX_DEPTH);
        return;
    }
    enum where in = r->depth > 0 ? r->where[r->depth - 1] : IN_FILE, opens = IN_SKIPPED;
    /* Only <robot> makes a file URDF. */
    if (in == IN_FILE) {
        if (strcmp(tag, "robot") != 0)
            REFUSE(r, "not a URDF file: its root is <%.60s>, not <robot>", tag);
        const char *name = attribute(attributes, "name");
        r->robot->name = arena_text(r->a, name ? name : "");
        opens = IN_ROBOT;
    } else if (in != IN_SKIPPED) {
        opens = element_read(r, tag, in, attributes);
    }
    /* Also what is skipped is counted, so that its end is found. */
    r->where[r->depth++] = opens;
}

/* What an element lacks is known when it closes. */
static void XMLCALL on_end(void *context, const char *tag)
{
    struct reader *r = context;
    (void)tag;
    if (r->e->kind != ERR_NONE) return;
    enum where closed = r->where[--r->depth];
    if (closed == IN_INERTIAL && !r->has_mass)
        REFUSE(r, "link '%.100s': <inertial> without <mass>", link_now(r)->name);
    if (closed == IN_INERTIAL && !r->has_inertia)
        REFUSE(r, "link '%.100s': <inertial> without <inertia>", link_now(r)->name);
}

/* --- the file --------------------------------------------------------------------------------- */

/* In one piece: files are small. */
static bool xml_parse(struct reader *r, const struct text *text)
{
    XML_SetUserData(r->parser, r);
    XML_SetElementHandler(r->parser, on_start, on_end);
    /* Handlers stop the parser themselves; then our own message stands. */
    bool good =
        XML_Parse(r->parser, text->s ? text->s : "", (int)text->length, XML_TRUE) == XML_STATUS_OK;
    if (!good && r->e->kind == ERR_NONE && XML_GetErrorCode(r->parser) == XML_ERROR_NO_MEMORY)
        err_set(r->e, ERR_INTERNAL, "out of memory reading %s", r->robot->path);
    else if (!good && r->e->kind == ERR_NONE)
        err_set_at(r->e, ERR_DATA, r->robot->path, line_now(r), "XML: %s",
                   XML_ErrorString(XML_GetErrorCode(r->parser)));
    return good && r->e->kind == ERR_NONE;
}

/* Elements first, then the tree that their names make. */
bool urdf_read(const char *path, struct urdf_robot *robot, struct arena *a, struct err *e)
{
    struct text text = {0};
    *robot = (struct urdf_robot){.path = arena_text(a, path)};
    struct reader r = {.a = a, .e = e, .robot = robot};
    if (e->kind != ERR_NONE || !text_read_file(&text, path, e)) return false;
    /* Before expat, which takes lengths as int. */
    bool good = text.length <= MAX_BYTES ||
                err_set_at(e, ERR_DATA, path, 0, "larger than %d bytes", MAX_BYTES);
    if (good) {
        r.parser = XML_ParserCreate(NULL);
        good = r.parser ? xml_parse(&r, &text)
                        : err_set(e, ERR_INTERNAL, "no memory for the XML reader");
        if (r.parser) XML_ParserFree(r.parser);
    }
    text_free(&text);
    return good && urdf_tree(robot, r.names, a, e);
}

/* vector.c - reading dynref-1 files: the system, its state, and the answers. */
#include "model/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "io/document.h"
#include "model/vector_check.h"

enum { MAX_BODIES = 1000000, JOINT_KINDS = 5 };

/* In the order of enum vector_joint. */
static const struct {
    const char *name;
    int nq, nv;
} joint_table[JOINT_KINDS] = {
    {"fixed", 0, 0}, {"revolute", 1, 1}, {"prismatic", 1, 1}, {"spherical", 4, 3}, {"floating", 7,
     6}};

const char *vector_joint_name(enum vector_joint joint) { return joint_table[joint].name; }
int vector_joint_nq(enum vector_joint joint) { return joint_table[joint].nq; }
int vector_joint_nv(enum vector_joint joint) { return joint_table[joint].nv; }

/* Where messages point, where memory comes from, and where the first error goes. */
struct reader {
    const char *path;
    struct arena *a;
    struct err *e;
};

/* False, so that it can end a chain of conditions. */
static bool fail(struct reader *r, const struct node *at, const char *text)
{
    return err_set_at(r->e, ERR_DATA, r->path, at ? at->line : 0, "%s", text);
}

/* A short name: most keys are lists of numbers. */
static bool numbers(struct reader *r, const struct node *map, const char *key, double *x, int n)
{
    return document_numbers(map, key, r->path, x, n, r->e);
}

/* A list of n numbers, nested or not; required. */
static const double *array_need(struct reader *r, const struct node *map, const char *key,
                                int64_t n)
{
    const struct node *node = document_need(map, key, r->path, r->e);
    if (!node) return NULL;
    /* Counted first: memory is taken for numbers that the file holds, not for those that its counts
     * promise. */
    int64_t there = document_count(node);
    if (there < n) {
        err_set_at(r->e, ERR_DATA, r->path, node->line,
                   "'%s' has %lld of the %lld numbers expected (%.3g GB of them)", key,
                   (long long)there, (long long)n, (double)n * sizeof(double) / 1e9);
        return NULL;
    }
    double *x = TAKE(r->a, n > 0 ? n : 1, double);
    return document_flat(node, key, r->path, x, n, r->e) ? x : NULL;
}

/* The same when the file may leave it out: true and NULL. */
static bool array_maybe(struct reader *r, const struct node *map, const char *key, int64_t n,
                        const double **x)
{
    *x = NULL;
    if (!document_find(map, key)) return true;
    *x = array_need(r, map, key, n);
    return *x != NULL;
}

/* The rotation comes twice: the quaternion counts, and R must agree with it. */
static bool frame_read(struct reader *r, const struct node *map, const char *key,
                       struct vector_frame *f)
{
    const struct node *node = document_need(map, key, r->path, r->e);
    if (!node || !numbers(r, node, "p", f->p, 3) || !numbers(r, node, "quat", f->quat, 4) ||
        !numbers(r, node, "R", f->R, 9))
        return false;
    /* A length that is off by more than rounding is a mistake of the writer. "Not less" refuses
     * NaN, too. */
    double square = 0;
    for (int i = 0; i < 4; i++) square += f->quat[i] * f->quat[i];
    if (!(fabs(square - 1) < 1e-6)) return fail(r, node, "'quat' is no unit quaternion");
    return vector_check_frame(f, node, r->path, r->e);
}

/* Joints without a direction are left as they are: an axis is not read there. */
static bool joint_read(struct reader *r, const struct node *body, struct vector_body *b)
{
    const struct node *joint = document_need(body, "joint", r->path, r->e);
    /* document_need has set the error. */
    if (!joint) return false;
    const char *type = document_text(joint, "type");
    /* By search in the table, so that the names stand once. */
    int k = 0;
    while (k < JOINT_KINDS && strcmp(type, joint_table[k].name) != 0) k++;
    if (k == JOINT_KINDS)
        return err_set_at(r->e, ERR_DATA, r->path, joint->line,
                          "unknown joint type '%.40s'; known: fixed, revolute, prismatic, "
                          "spherical, floating", type);
    b->joint = (enum vector_joint)k;
    if (b->joint != VECTOR_REVOLUTE && b->joint != VECTOR_PRISMATIC) return true;
    if (!numbers(r, joint, "axis", b->axis, 3)) return false;
    /* Unit to the digits of a file. */
    double square = b->axis[0] * b->axis[0] + b->axis[1] * b->axis[1] + b->axis[2] * b->axis[2];
    return fabs(square - 1) < 1e-6 || fail(r, joint, "'axis' is no unit vector");
}

/* Parents before children: i - 1 is the last that may be one. */
static bool body_read(struct reader *r, const struct node *node, int i, struct vector_body *b)
{
    b->line = node->line;
    b->name = document_text(node, "link_name");
    return document_integer(node, "parent", r->path, -1, i - 1, &b->parent, r->e) &&
           joint_read(r, node, b) && frame_read(r, node, "placement", &b->placement) &&
           document_number(node, "mass", r->path, &b->mass, r->e) &&
           numbers(r, node, "com", b->com, 3) && numbers(r, node, "inertia_com", b->inertia, 6);
}

/* Coordinates are numbered on the way. */
static bool bodies_read(struct reader *r, const struct node *root, struct vector_case *c)
{
    const struct node *list = document_need(root, "bodies", r->path, r->e);
    if (!list) return false;
    /* The limit is far above any reference, below what would exhaust memory. */
    if (list->kind != NODE_LIST || list->count < 1 || list->count > MAX_BODIES)
        return fail(r, list, "'bodies' must be a list of 1 to 1000000 bodies");
    c->nbody = list->count;
    c->body = TAKE(r->a, c->nbody, struct vector_body);
    int i = 0;
    for (const struct node *node = list->child; node; node = node->next, i++) {
        struct vector_body *b = &c->body[i];
        if (!body_read(r, node, i, b)) return false;
        b->q = c->nq;
        b->v = c->nv;
        c->nq += joint_table[b->joint].nq;
        c->nv += joint_table[b->joint].nv;
    }
    return true;
}

/* nq and nv follow from the joints. That files give them, too, shows when reader and writer mean
 * different things by a joint. */
static bool counts_check(struct reader *r, const struct node *root, const struct vector_case *c)
{
    int nq, nv;
    if (!document_integer(root, "nq", r->path, 0, 7 * MAX_BODIES, &nq, r->e) ||
        !document_integer(root, "nv", r->path, 0, 6 * MAX_BODIES, &nv, r->e))
        return false;
    if (nq == c->nq && nv == c->nv) return true;
    return err_set_at(r->e, ERR_DATA, r->path, root->line,
                      "nq, nv = %d, %d do not fit the joints, which have %d, %d", nq, nv, c->nq,
                      c->nv);
}

/* Rows stay as written, [linear; angular] in axes of frame a: room dynamics reorders them. */
static bool loop_read(struct reader *r, const struct node *node, int nbody,
                      struct vector_loop *loop)
{
    const struct node *rows = document_need(node, "rows", r->path, r->e);
    if (!rows) return false;
    /* Six rows fix a body to the other; more would only repeat them. */
    if (rows->kind != NODE_LIST || rows->count < 1 || rows->count > 6)
        return fail(r, rows, "a loop has 1 to 6 rows");
    /* The loop's own line, where the model's checks point. */
    loop->line = node->line;
    loop->nrow = rows->count;
    int k = 0;
    for (const struct node *row = rows->child; row; row = row->next, k++)
        if (!document_flat(row, "rows", r->path, loop->row[k], 6, r->e)) return false;
    return document_integer(node, "body_a", r->path, -1, nbody - 1, &loop->body_a, r->e) &&
           document_integer(node, "body_b", r->path, -1, nbody - 1, &loop->body_b, r->e) &&
           frame_read(r, node, "frame_a", &loop->frame_a) &&
           frame_read(r, node, "frame_b", &loop->frame_b);
}

/* Trees leave the list out; `bodies` is then the whole system. */
static bool loops_read(struct reader *r, const struct node *root, struct vector_case *c)
{
    const struct node *list = document_find(root, "loops");
    if (!list) return true;
    if (list->kind != NODE_LIST) return fail(r, list, "'loops' must be a list");
    /* As many as the list has: nothing grows. */
    c->loop = TAKE(r->a, list->count, struct vector_loop);
    for (const struct node *node = list->child; node; node = node->next) {
        if (!loop_read(r, node, c->nbody, &c->loop[c->nloop])) return false;
        /* Rows of all loops together: lambda has as many. */
        c->nrow += c->loop[c->nloop++].nrow;
    }
    return true;
}

/* q and qd are always there, the others by what is asked. */
static bool state_read(struct reader *r, const struct node *root, struct vector_case *c)
{
    /* Each is read only if those before it were good: one error, the first. */
    bool good = (c->q = array_need(r, root, "q", c->nq)) &&
                (c->qd = array_need(r, root, "qd", c->nv)) &&
                array_maybe(r, root, "qdd", c->nv, &c->qdd) &&
                array_maybe(r, root, "tau", c->nv, &c->tau) &&
                array_maybe(r, root, "f_ext", 6 * c->nbody, &c->external) &&
                array_maybe(r, root, "joint_spring", c->nv, &c->spring) &&
                array_maybe(r, root, "joint_spring_q0", c->nv, &c->spring_q0) &&
                array_maybe(r, root, "joint_damping", c->nv, &c->damping);
    /* Half a spring would be a guess. nq = nv rules out quaternions, which have no rest angle. */
    if (good && (c->spring || c->damping) &&
        !(c->spring && c->spring_q0 && c->damping && c->nq == c->nv))
        return fail(
            r, root,
            "springs need joint_spring, joint_spring_q0 and joint_damping, and 1-DOF joints only");
    return good;
}

/* Of a few leaves: they see the errors of all bodies on the way. */
static bool poses_read(struct reader *r, const struct node *root, struct vector_case *c)
{
    const struct node *list = document_find(root, "fk");
    if (!list) return true;
    if (list->kind != NODE_LIST) return fail(r, list, "'fk' must be a list");
    c->pose = TAKE(r->a, list->count, struct vector_pose);
    for (const struct node *node = list->child; node; node = node->next) {
        /* In world axes, without gravity: what an observer would see. */
        struct vector_pose *p = &c->pose[c->npose++];
        if (!document_integer(node, "body", r->path, 0, c->nbody - 1, &p->body, r->e) ||
            !numbers(r, node, "R", p->R, 9) || !numbers(r, node, "p", p->p, 3) ||
            !numbers(r, node, "v", p->v, 3) || !numbers(r, node, "w", p->w, 3) ||
            !numbers(r, node, "a", p->a, 3) || !numbers(r, node, "alpha", p->alpha, 3))
            return false;
    }
    return true;
}

/* Each group as a whole, or not at all. */
static bool totals_read(struct reader *r, const struct node *root, struct vector_case *c)
{
    const struct node *energy = document_find(root, "energy"),
                      *momentum = document_find(root, "momentum");
    /* Presence is told apart from zero. */
    c->has_energy = energy != NULL;
    c->has_momentum = momentum != NULL;
    c->has_com = document_find(root, "com_world") != NULL;
    if (energy && !(document_number(energy, "kinetic", r->path, &c->kinetic, r->e) &&
                    document_number(energy, "potential", r->path, &c->potential, r->e)))
        return false;
    if (momentum && !(numbers(r, momentum, "linear", c->linear, 3) &&
                      numbers(r, momentum, "angular_about_world_origin", c->angular, 3)))
        return false;
    return !c->has_com || (numbers(r, root, "com_world", c->com_world, 3) &&
                           document_number(root, "total_mass", r->path, &c->total_mass, r->e));
}

/* Missing and null are the same: no answer. */
static double number_or_nan(const struct node *map, const char *key)
{
    const struct node *node = document_find(map, key);
    return node && node->kind == NODE_NUMBER ? node->number : NAN;
}

/* The smaller of the two, ignoring "no answer"; libraries run in more than double precision do not
 * compete. */
static void peer_compete(struct vector_peer *best, double error, const char *name)
{
    /* "Not larger or equal" is true against NAN: any number wins over no number. */
    if (isfinite(error) && !(error >= best->error)) *best = (struct vector_peer){error, name};
}

/* How well other libraries do in double: for people who compare. */
static void peers_read(const struct node *root, struct vector_case *c)
{
    const struct node *list = document_find(root, "peers"),
                      *floor = document_find(root, "input_rounding_floor");
    /* How much rounding of the inputs alone changes the answers. */
    c->floor_id = number_or_nan(floor, "tau_id");
    c->floor_fd = number_or_nan(floor, "qdd_fd");
    c->peer_id = c->peer_fd = (struct vector_peer){NAN, ""};
    if (!list || list->kind != NODE_LIST) return;
    for (const struct node *node = list->child; node; node = node->next) {
        const struct node *diff = document_find(node, "max_rel_diff");
        /* Run in quad precision: no measure of what doubles can reach. */
        if (strstr(document_text(node, "version"), "113-bit")) continue;
        /* Forward dynamics counts both ways: by recursion and through the mass matrix. */
        const char *name = document_text(node, "name");
        peer_compete(&c->peer_id, number_or_nan(diff, "tau_id"), name);
        peer_compete(&c->peer_fd, number_or_nan(diff, "qdd_fd"), name);
        peer_compete(&c->peer_fd, number_or_nan(diff, "qdd_fd_via_mass_matrix"), name);
    }
}

/* One state of a trajectory with its conserved quantities. */
static bool instant_read(struct reader *r, const struct node *node, const struct vector_case *c,
                         struct vector_instant *t)
{
    /* All of them: a state without its energy cannot be judged. */
    const struct node *energy = document_need(node, "energy", r->path, r->e);
    const struct node *momentum = energy ? document_need(node, "momentum", r->path, r->e) : NULL;
    return momentum && document_number(energy, "kinetic", r->path, &t->energy[0], r->e) &&
           document_number(energy, "potential", r->path, &t->energy[1], r->e) &&
           document_number(energy, "total", r->path, &t->energy[2], r->e) &&
           numbers(r, momentum, "linear", t->linear, 3) &&
           numbers(r, momentum, "angular_about_world_origin", t->angular, 3) &&
           (t->q = array_need(r, node, "q", c->nq)) && (t->qd = array_need(r, node, "qd", c->nv));
}

/* The same states as texts of 45 digits: numbers as near to them as doubles are. */
static bool digits_read(struct reader *r, const struct node *root, struct vector_case *c)
{
    const struct node *list = document_find(root, "states_45_digits");
    if (!list) return true;
    if (list->kind != NODE_LIST || list->count != c->ninstant)
        return fail(r, list, "'states_45_digits' must have as many states as 'trajectory'");
    /* q, then qd, in one list. */
    int k = 0, n = c->nq + c->nv;
    for (const struct node *state = list->child; state; state = state->next, k++) {
        /* Nearest doubles: what remains is beyond their digits. */
        double *x = TAKE(r->a, (size_t)n + 1, double);
        /* Otherwise a shifted list would be compared number by number. */
        if (state->kind != NODE_LIST || state->count != n)
            return fail(r, state,
                        "a state of 'states_45_digits' must hold all numbers of q and qd");
        int i = 0;
        for (const struct node *digit = state->child; digit; digit = digit->next, i++) {
            char *end = NULL;
            if (digit->kind == NODE_TEXT) x[i] = strtod(digit->text, &end);
            if (!end || end == digit->text || *end || !isfinite(x[i]))
                return fail(r, digit, "'states_45_digits' must hold numbers as texts");
        }
        c->instant[k].digits = x;
    }
    return true;
}

/* States at increasing times, each with what is known of its accuracy. */
static bool trajectory_read(struct reader *r, const struct node *root, struct vector_case *c)
{
    const struct node *trajectory = document_find(root, "trajectory");
    if (!trajectory) return true;
    const struct node *states = document_need(trajectory, "states", r->path, r->e);
    if (!states) return false;
    int n = states->count, k = 0;
    if (states->kind != NODE_LIST || n < 1)
        return fail(r, states, "'states' must be a list of states");
    const double *time = array_need(r, trajectory, "times", n);
    /* Of the reference itself: its own error, and how fast errors grow. Either may be missing. */
    const double *accuracy, *sensitivity;
    if (!time || !array_maybe(r, trajectory, "verified_accuracy_max_abs_diff", n, &accuracy) ||
        !array_maybe(r, trajectory, "sensitivity_to_initial_state", n, &sensitivity))
        return false;
    c->instant = TAKE(r->a, n, struct vector_instant);
    c->ninstant = n;
    for (const struct node *node = states->child; node; node = node->next, k++) {
        c->instant[k] = (struct vector_instant){.time = time[k],
                                                .accuracy = accuracy ? accuracy[k] : NAN,
                                                .sensitivity = sensitivity ? sensitivity[k] : NAN};
        if (!instant_read(r, node, c, &c->instant[k])) return false;
        /* Integrators go from one time to the next, so each must be later. */
        if (k > 0 && !(time[k] > time[k - 1])) return fail(r, trajectory, "'times' must increase");
    }
    return digits_read(r, root, c);
}

/* All of them may be missing; vector_check.c says which should not. */
static bool answers_read(struct reader *r, const struct node *root, struct vector_case *c)
{
    return array_maybe(r, root, "tau_id", c->nv, &c->tau_id) &&
           array_maybe(r, root, "qdd_fd", c->nv, &c->qdd_fd) &&
           array_maybe(r, root, "bias", c->nv, &c->bias) &&
           array_maybe(r, root, "lambda", c->nrow, &c->lambda) &&
           array_maybe(r, root, "gravity_torque", c->nv, &c->gravity_torque) &&
           array_maybe(r, root, "M", size_count(c->nv, c->nv), &c->mass_matrix) &&
           array_maybe(r, root, "joint_wrench_id", 6 * c->nbody, &c->joint_wrench) &&
           totals_read(r, root, c) && poses_read(r, root, c) && trajectory_read(r, root, c);
}

/* An answer without its question cannot be checked. */
static bool complete_check(struct reader *r, const struct node *root, const struct vector_case *c)
{
    /* A trajectory is an answer by itself. */
    if (c->ninstant > 0) return true;
    if (c->tau_id && !c->qdd) return fail(r, root, "'tau_id' is given without 'qdd'");
    if (c->qdd_fd && !c->tau) return fail(r, root, "'qdd_fd' is given without 'tau'");
    return c->tau_id || c->qdd_fd ||
           fail(r, root, "neither 'tau_id', 'qdd_fd' nor 'trajectory': nothing to compare with");
}

/* Keys first: a misspelt one is then named as such and not as missing. Bodies before all that is
 * counted by them; the peers are free text and cannot be wrong. */
bool vector_read(const char *path, struct vector_case *c, struct arena *a, struct err *e)
{
    struct reader r = {arena_text(a, path), a, e};
    const struct node *root = document_read(r.path, a, e);
    if (!root) return false;
    if (strcmp(document_text(root, "format"), "dynref-1") != 0)
        return fail(&r, root, "not a reference vector: 'format' must be \"dynref-1\"");
    /* Missing texts are "": no reader below depends on them. */
    *c = (struct vector_case){.path = r.path,
                              .name = document_text(root, "name"),
                              .group = document_text(root, "group"),
                              .urdf = document_text(root, "urdf"),
                              .declared = document_find(root, "answers")};
    /* The line is for the message about a file that is not there. */
    const struct node *urdf = document_find(root, "urdf");
    if (urdf) c->urdf_line = urdf->line;
    bool good = vector_check_keys(root, r.path, e) && numbers(&r, root, "gravity", c->gravity, 3) &&
                bodies_read(&r, root, c) && counts_check(&r, root, c) && loops_read(&r, root, c) &&
                state_read(&r, root, c) && answers_read(&r, root, c) && complete_check(&r, root, c);
    if (good) peers_read(root, c);
    return good;
}

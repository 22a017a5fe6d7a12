/* kernel_spec.c - the settings of the parallel program.
 *
 * One struct serves all built-in programs: formulation to refinement act on multibody dynamics,
 * message to ring_ranks on the benchmarks. A setting that cannot act on the program at hand is
 * "idle": it is told to a user who sets it and left out of tables, but it is part of the
 * configuration. Solvers:
 *
 *     thomas            serial block Cholesky on rank 0 (physics 5.1), the reference
 *     cr                cyclic reduction (5.2): backward stable, 2 lg P steps
 *     pcr-symmetric     parallel cyclic reduction (5.3 ii): lg P steps; pcr: the textbook's form
 * (5.3 i) cr-pcr            some levels of the first, then the second (5.4 d) partition local
 * elimination, then cr or pcr-symmetric on one row a rank (5.4 a) */
#include "spec/kernel_spec.h"

#include <string.h>

#include "comm/collective_rules.h"
#include "spec/spec_fields.h"

#define AT(member) .offset = offsetof(struct kernel_spec, member)

/* Words of enums, in the order of their values (kernel_spec.h). */
static const char *const formulations[] = {"paper", "direct", NULL};
static const char *const solvers[] = {"pcr-symmetric", "pcr",    "cr", "cr-pcr",
                                      "partition",     "thomas", NULL};
static const char *const part_solvers[] = {"pcr", "cr", NULL};
static const char *const operators[] = {"structured", "dense", NULL};
static const char *const algebras[] = {"auto", "spatial", "planar", NULL};
static const char *const precisions[] = {"double", "float", "quad", NULL};
static const char *const residuals[] = {"working", "twice", NULL};
static const char *const partitions[] = {"block", "balanced", NULL};
static const char *const refinement_rules[] = {"as-needed", "as-given", NULL};
static const char *const step_rules[] = {"semi-implicit", "kdk", "rk4", "linearly-implicit", NULL};

/* Programs are told by their traits, not by name: the list is the only place that knows them. */
bool kernel_spec_has(const struct kernel_spec *k, enum program_trait trait)
{
    static const struct {
        const char *name;
        unsigned traits;
    } list[] = {
#define X(word, stem, traits) {word, traits},
        PROGRAM_LIST(X)
#undef X
    };
    if (k->own) return false;
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        if (strcmp(k->name, list[i].name) == 0) return (list[i].traits & trait) != 0;
    /* a name that the plan is about to refuse */
    return (trait & (PROGRAM_SCENE | PROGRAM_FORWARD)) != 0;
}

bool kernel_spec_needs_model(const struct kernel_spec *k)
{
    return kernel_spec_has(k, PROGRAM_SCENE);
}

static const char built_in_alone[] = "only built-in programs have it";

/* Why a setting cannot act, as a clause for messages; NULL when it acts. Each check begins with the
 * wider ones, so that the first reason that holds is told. */
static const char *idle_without_model(const struct run_spec *r)
{
    if (r->kernel.own) return built_in_alone;
    return kernel_spec_needs_model(&r->kernel)
               ? NULL
               : "this kernel only sends messages and computes nothing";
}

/* Sizes, distances and roots of the message benchmarks. */
static const char *idle_with_model(const struct run_spec *r)
{
    if (r->kernel.own) return built_in_alone;
    return kernel_spec_needs_model(&r->kernel) ? "only the message benchmarks have it" : NULL;
}

/* Only forward dynamics has a system to solve (physics 4). */
static const char *idle_without_forward(const struct run_spec *r)
{
    const char *why = idle_without_model(r);
    if (why != NULL) return why;
    return kernel_spec_has(&r->kernel, PROGRAM_FORWARD) ? NULL
                                                        : "inverse dynamics solves no system";
}

/* Models whose bodies branch or close loops by construction. A file may hold anything: it is
 * treated as a chain until it has been read (kernel/omission.c tells the rest). */
static bool branches(const struct run_spec *r)
{
    /* What the generator makes, not what is in a file. */
    switch (r->model.generator) {
    case MODEL_SERIAL_CHAIN:
    case MODEL_POLYMER:
    case MODEL_URDF:
    case MODEL_VECTOR: return false;
    default: return true;
    }
}

/* Trees are solved by contraction (physics 6.2), whatever the solver says. */
static const char *idle_without_chain_solver(const struct run_spec *r)
{
    const char *why = idle_without_forward(r);
    if (why != NULL) return why;
    return branches(r)
               ? "trees and closed chains are contracted, not solved as a block tridiagonal system"
               : NULL;
}

/* The interface system exists in the partition method alone (physics 5.4 a). */
static const char *idle_unless_partition(const struct run_spec *r)
{
    const char *why = idle_without_chain_solver(r);
    if (why != NULL) return why;
    return r->kernel.solver == SOLVER_PARTITION ? NULL : "kernel.solver is not 'partition'";
}

/* Levels before the change of method (physics 5.4 d). */
static const char *idle_unless_hybrid(const struct run_spec *r)
{
    const char *why = idle_without_chain_solver(r);
    if (why != NULL) return why;
    return r->kernel.solver == SOLVER_CR_PCR ? NULL : "kernel.solver is not 'cr-pcr'";
}

/* Length and rule of a step that is not made. */
static const char *idle_without_steps(const struct run_spec *r)
{
    const char *why = idle_without_model(r);
    if (why != NULL) return why;
    return r->kernel.steps > 0 ? NULL : "kernel.steps is 0: one evaluation";
}

/* One benchmark has a partner at a distance. */
static const char *idle_unless_shift(const struct run_spec *r)
{
    const char *why = idle_with_model(r);
    if (why != NULL) return why;
    return kernel_spec_has(&r->kernel, PROGRAM_DISTANCE) ? NULL : "only 'shift' has a distance";
}

/* Sizes act on all benchmarks but barriers. */
static const char *idle_without_message(const struct run_spec *r)
{
    const char *why = idle_with_model(r);
    if (why != NULL) return why;
    return kernel_spec_has(&r->kernel, PROGRAM_MESSAGE) ? NULL : "a barrier has no size";
}

/* An algorithm, or the machine's rules. */
static const char *idle_without_algorithm(const struct run_spec *r)
{
    const char *why = idle_with_model(r);
    if (why != NULL) return why;
    return kernel_spec_has(&r->kernel, PROGRAM_COLLECTIVE) ? NULL
                                                           : "only collectives have algorithms";
}

/* The others treat all ranks alike. */
static const char *idle_without_root(const struct run_spec *r)
{
    const char *why = idle_with_model(r);
    if (why != NULL) return why;
    return kernel_spec_has(&r->kernel, PROGRAM_ROOT)
               ? NULL
               : "only broadcast, reduce, gather and scatter have a root";
}

/* How many ranks stand in one ring. */
static const char *idle_unless_ring(const struct run_spec *r)
{
    const char *why = idle_with_model(r);
    if (why != NULL) return why;
    return kernel_spec_has(&r->kernel, PROGRAM_RING) ? NULL
                                                     : "only 'ring' and 'random-ring' have rings";
}

/* Pieces of trees follow from the shape of the tree (physics 6.3). */
static const char *idle_without_branch_choice(const struct run_spec *r)
{
    const char *why = idle_without_model(r);
    if (why != NULL) return why;
    return branches(r) ? "trees are always cut into pieces of equal work" : NULL;
}

/* The outgoing form needs a successor, which only a chain has (physics 3.2). */
static const char *idle_unless_open_chain(const struct run_spec *r)
{
    const char *why = idle_without_model(r);
    if (why != NULL) return why;
    return branches(r) ? "trees and closed chains always take incoming composites" : NULL;
}

/* Exact zeros only, as in kernel/omission.c. */
static bool all_zero(const double *x, int n)
{
    for (int i = 0; i < n; i++)
        if (x[i] != 0) return false;
    return true;
}

/* Scans along the chain carry velocities, accelerations and forces that the bodies have by
 * themselves. Without any of them nothing is scanned, and the form of composites does not
 * matter. */
static const char *idle_without_scans(const struct run_spec *r)
{
    const char *why = idle_unless_open_chain(r);
    if (why != NULL) return why;
    const struct model_spec *m = &r->model;
    const struct kernel_spec *k = &r->kernel;
    const bool from_file = m->generator == MODEL_URDF || m->generator == MODEL_VECTOR;
    if (kernel_spec_has(k, PROGRAM_INVERSE) || from_file || m->rate != 0 || k->steps > 0 ||
        k->outer_refinements > 0)
        return NULL;
    if (k->formulation == FORMULATION_DIRECT)
        return "nothing moves, so the direct formulation scans nothing";
    /* The paper's form scans a bias, which is zero without motion, weight and load (physics
     * 4.2). */
    const bool still = m->base != BASE_MOVING || all_zero(m->base_acceleration, 6);
    return still && all_zero(m->gravity, 3) && m->external_force == 0
               ? "nothing moves and nothing weighs, so the paper's formulation scans nothing"
               : NULL;
}

static const struct field fields[] = {
    /* Formulations (physics 4.2, 4.3) and solvers (5.1 to 5.4). */
    {.key = "name", .kind = FIELD_TEXT, AT(name), .capacity = 32, .fallback = "dynamics",
     .doc = "the program; see `mimdsim kernels`"},
    {.key = "formulation", .kind = FIELD_CHOICE, AT(formulation), .choice = formulations,
     .fallback = "paper",
     .idle = idle_without_forward,
     .doc = "forward dynamics: the paper's constraint system or the direct one"},
    {.key = "solver", .kind = FIELD_CHOICE, AT(solver), .choice = solvers,
     .fallback = "pcr-symmetric",
     .idle = idle_without_chain_solver, .doc = "solver of the block tridiagonal system"},
    {.key = "part_solver", .kind = FIELD_CHOICE, AT(part_solver), .choice = part_solvers,
     .fallback = "pcr",
     .idle = idle_unless_partition, .doc = "solver of the interface system of solver 'partition'"},
    /* How the numbers are computed: full matrices or (r, p) (physics 1.2), in which precision. */
    {.key = "operators", .kind = FIELD_CHOICE, AT(operators), .choice = operators,
     .fallback = "structured",
     .idle = idle_without_model,
     .doc = "operators as full 6x6 matrices, as in the paper's code, or as "
                                        "rotation and offset"},
    {.key = "algebra", .kind = FIELD_CHOICE, AT(algebra), .choice = algebras, .fallback = "auto",
     .idle = idle_without_model,
     .doc = "six components, or three in the plane of a planar scene; auto: three with structured "
            "operators"},
    /* double, float, or quad (113 bits, in software). */
    {.key = "precision", .kind = FIELD_CHOICE, AT(precision), .choice = precisions,
     .fallback = "double",
     .idle = idle_without_model, .doc = "precision of the arithmetic"},
    /* How the work lies on the ranks: blocks (physics 3.3), composites incoming (3.1) or outgoing
     * (3.2). */
    {.key = "partition", .kind = FIELD_CHOICE, AT(partition), .choice = partitions,
     .fallback = "block",
     .idle = idle_without_branch_choice,
     .doc = "distribution of bodies over ranks: equal counts, or equal work"},
    {.key = "composites_incoming", .kind = FIELD_BOOL, AT(composites_incoming), .fallback = "false",
     .idle = idle_without_scans,
     .doc = "transforms of the recursive doubling: incoming composites, or the paper's outgoing "
            "ones"},
    /* Physics 5.4 d: each level halves the rows that go on and costs a step on the way back. */
    {.key = "hybrid_levels", .kind = FIELD_INT, AT(hybrid_levels), .min = 0, .max = 32,
     .fallback = "1",
     .idle = idle_unless_hybrid,
     .doc = "levels of cyclic reduction before parallel cyclic reduction"},
    /* What is done about rounding errors (physics 8.6). */
    {.key = "refinement", .kind = FIELD_CHOICE, AT(refinement), .choice = refinement_rules,
     .fallback = "as-needed",
     .idle = idle_without_forward,
     .doc = "whether further refinements are added if the residual requires them"},
    {.key = "residual", .kind = FIELD_CHOICE, AT(residual), .choice = residuals,
     .fallback = "working",
     .idle = idle_without_chain_solver,
     .doc = "precision of forces and residual of a refined solution: that of the arithmetic, or "
            "twice its digits"},
    /* Fixed numbers of corrections; more are added as needed. */
    {.key = "inner_refinements", .kind = FIELD_INT, AT(inner_refinements), .min = 0, .max = 100,
     .fallback = "0",
     .idle = idle_without_forward,
     .doc = "inner refinements: corrections of the solution by its residual"},
    {.key = "outer_refinements", .kind = FIELD_INT, AT(outer_refinements), .min = 0, .max = 100,
     .fallback = "0",
     .idle = idle_without_forward,
     .doc = "outer refinements: corrections of the accelerations by inverse dynamics"},
    /* Time integration (physics 9). */
    {.key = "steps", .kind = FIELD_INT, AT(steps), .min = 0, .max = 1 << 30, .fallback = "0",
     .idle = idle_without_model, .doc = "number of time steps, 0: one evaluation"},
    {.key = "step_size", .kind = FIELD_REAL, .unit = UNIT_TIME, AT(step_size), .min = 1e-18,
     .max = 1e3,
     .fallback = "1 ms", .idle = idle_without_steps, .doc = "length of a time step"},
    /* Orders 1, 2, 4 and 1; the last one also takes stiff springs at any step size. */
    {.key = "step", .kind = FIELD_CHOICE, AT(step), .choice = step_rules,
     .fallback = "semi-implicit",
     .idle = idle_without_steps,
     .doc = "semi-implicit Euler (order 1), kick-drift-kick (order 2, one evaluation a step), "
            "Runge-Kutta 4, or linearly implicit in springs and dampers (order 1)"},
    /* Message benchmarks only. */
    {.key = "repeat", .kind = FIELD_INT, AT(repeat), .min = 1, .max = 1 << 30, .fallback = "1",
     .idle = idle_with_model, .doc = "benchmarks: repetitions within a run"},
    /* What a benchmark sends, and to whom. */
    {.key = "message", .kind = FIELD_INT64, .unit = UNIT_BYTES, AT(message_bytes), .min = 0,
     .max = 1e12,
     .fallback = "0 B", .idle = idle_without_message, .doc = "benchmarks: size of a message"},
    {.key = "distance", .kind = FIELD_INT, AT(distance), .min = 0, .max = 1 << 30, .fallback = "1",
     .idle = idle_unless_shift, .doc = "benchmarks: distance of the partner in ranks"},
    /* Collectives: which algorithm, whose root (docs/collectives.md). */
    {.key = "algorithm", .kind = FIELD_TEXT, AT(algorithm), .capacity = 32, .fallback = "auto",
     .valid = collective_choice_valid, .idle = idle_without_algorithm,
     .doc = "collectives: an algorithm by name (docs/collectives.md), or by "
            "machine.software.collectives and size"},
    {.key = "root", .kind = FIELD_INT, AT(root), .min = -(1 << 30), .max = 1 << 30, .fallback = "0",
     .idle = idle_without_root, .doc = "collectives: root rank; -1: the last"},
    {.key = "ring_ranks", .kind = FIELD_INT, AT(ring_ranks), .min = 0, .max = 1 << 30,
     .fallback = "0",
     .idle = idle_unless_ring,
     .doc = "ring, random-ring: ranks per ring, 0: one ring of all ranks"},
};

const struct field_table kernel_table = {
    .prefix = "kernel", .doc = "the parallel program", .offset = offsetof(struct run_spec, kernel),
    .size = sizeof(struct kernel_spec), .nfield = (int)(sizeof fields / sizeof *fields),
    .field = fields,
};

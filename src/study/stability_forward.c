/* stability_forward.c - accelerations of one scene by every algorithm, compared with quad
 * precision.
 *
 * Two numbers make an error readable: the condition, what any algorithm must lose, and the
 * residual, what this one lost in forces. A row that is not ok is run again in quad precision,
 * to tell rounding from an algorithm that cannot do the scene. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "dynamics/dynamics_table.h"
#include "kernel/trust.h"
#include "study/stability_scene.h"
#include "study/trial.h"

enum {
    MOST_RANKS = 64,
    MOST_DENSE = 1024,    /* degrees of freedom for the mass matrix */
    MOST_MEASURED = 8192, /* bodies for the condition, which takes a second reference */
    MOST_INNER = 20,
    FEW_INNER = 4,
    FEW_BODIES = 1000 /* passes of refinement; fewer where many bodies make them long */
};

/* A trial that was made: rows that are the same program share it, with what is measured of it. */
struct known {
    struct kernel_spec kernel; /* as it ran */
    struct trial trial;        /* of its arrays qdd alone */
    bool measured;
    double forces, power;      /* residual_of */
};

enum { MOST_KNOWN = 32 };
struct known_list {
    int n;
    struct known item[MOST_KNOWN];
};

/* The scene that all rows are judged by, with its reference in quad precision. */
struct judge {
    struct stability_report *report;
    const char *subject;
    const struct model *m;
    const struct state *s;
    struct arena *a;
    double *reference;   /* (nu) */
    /* (nu) joint forces of the reference by inverse dynamics in quad precision */
    double *right;
    struct held *quad;   /* the scene in quad precision, for inverse dynamics */
    struct known_list *known;
    struct arena *kept;  /* what rows share; `a` is emptied after each */
    double force;        /* largest joint force with the right answer: the residual's scale */
    double condition;
};

/* The reference: articulated bodies in quad precision. False: it broke down. */
static bool quad_forward(const struct model *m, const struct state *s, struct arena *a, double *qdd)
{
    struct work w = {0};
    return dynamics_type_of(PRECISION_QUAD)->forward(m, s, FORWARD_ABA, a, qdd, NULL, NULL, &w);
}

/* Condition: how much the accelerations change, relative to a relative change of 1e-10 of
 * coordinates, rates and forces. Signs alternate, so that changes do not cancel by symmetry.
 * Quad precision sees a change of 1e-10 to 20 digits. One direction is tried: a lower bound. */
static double condition_of(const struct judge *j)
{
    const double change = 1e-10;
    const struct model *m = j->m;
    struct arena_mark mark = arena_mark(j->a);
    struct state s = *j->s;
    double *qdd = TAKE(j->a, m->nu, double);
    s.q = TAKE(j->a, m->nq, double), s.qd = TAKE(j->a, m->nu, double),
    s.tau = TAKE(j->a, m->nu, double);
    for (int i = 0; i < m->nq; i++) s.q[i] = j->s->q[i] * (1 + (i % 3 - 1) * change);
    for (int i = 0; i < m->nu; i++) s.qd[i] = j->s->qd[i] * (1 + (i % 2 ? change : -change));
    for (int i = 0; i < m->nu; i++) s.tau[i] = j->s->tau[i] * (1 + (i % 2 ? -change : change));
    double moved =
        quad_forward(m, &s, j->a, qdd) ? trial_error(qdd, j->reference, m->nu) / change : NAN;
    arena_release(j->a, mark);
    return moved;
}

/* Joint forces that the error of qdd stands for, M (qdd - reference): the largest over j->force,
 * and in *power what they do on the motion, u . M (qdd - reference), over j->force sum |u|. The
 * answer's own rounding is part of both. */
static double residual_of(const struct judge *j, const double *qdd, double *power)
{
    const struct model *m = j->m;
    struct arena_mark mark = arena_mark(j->a);
    double *tau = TAKE(j->a, m->nu, double), largest = 0, rates = 0;
    const double *right = j->right;
    /* Two inverse dynamics in quad precision: their difference has M alone, without bias forces. */
    dynamics_type_of(PRECISION_QUAD)->inverse_held(j->quad, qdd, tau);
    *power = 0;
    for (int i = 0; i < m->nu; i++) {
        largest = fmax(largest, fabs(tau[i] - right[i]));
        *power += j->s->qd[i] * (tau[i] - right[i]);
        rates += fabs(j->s->qd[i]);
    }
    *power = rates > 0 && j->force > 0 ? fabs(*power) / (j->force * rates) : NAN;
    arena_release(j->a, mark);
    return j->force > 0 ? largest / j->force : largest;
}

/* Scale of the residual: the largest joint force that rates and gravity need without any
 * acceleration, or that a motor applies. Their sum may cancel; rounding goes by its terms. */
static double force_of(const struct judge *j)
{
    const struct model *m = j->m;
    struct arena_mark mark = arena_mark(j->a);
    double *tau = TAKE(j->a, m->nu, double), *zero = TAKE(j->a, m->nu, double), largest = 0;
    dynamics_type_of(PRECISION_QUAD)->inverse_held(j->quad, zero, tau);
    for (int i = 0; i < m->nu; i++) largest = fmax(largest, fmax(fabs(tau[i]), fabs(j->s->tau[i])));
    arena_release(j->a, mark);
    return largest;
}

/* Grades a row and fills in what is measured the same way for every algorithm. With loops,
 * forces do not follow from accelerations alone: the algorithm's own residual stays. */
static void finish_row(const struct judge *j, struct stability_row *x, const double *qdd,
                       double own_residual, bool single, struct known *known)
{
    row_grade(x, trial_error(qdd, j->reference, j->m->nu), single);
    x->residual = own_residual;
    if (isfinite(x->error)) {
        if (!known->measured) known->forces = residual_of(j, qdd, &known->power);
        known->measured = true;
        x->energy_drift = known->power;
        if (j->m->nloop == 0) x->residual = known->forces;
    }
    x->condition = j->condition;
}

/* One serial algorithm in one precision; a broken pivot leaves the row failed. */
static void serial_row(const struct judge *j, enum forward_method method, enum precision precision)
{
    const struct dynamics_type *t = dynamics_type_of(precision);
    struct stability_row *x = row_add(j->report, j->subject, forward_method_name(method), t->name);
    double *qdd = TAKE(j->a, j->m->nu + 1, double);
    struct work w = {0};
    struct forward_report f = {0};
    if (!t->forward(j->m, j->s, method, j->a, qdd, NULL, &f, &w)) {
        text_copy(x->reason, sizeof x->reason, "a pivot was not positive");
        return;
    }
    if (method == FORWARD_CFA_ROBUST) x->refinements = f.refined;
    if (f.fell_back) text_copy(x->reason, sizeof x->reason, "solved by articulated bodies instead");
    struct known once = {0};
    finish_row(j, x, qdd, f.residual, precision == PRECISION_FLOAT, &once);
}

static const struct variant {
    const char *name;
    bool contraction; /* for trees and loops; the others for open chains */
    enum precision precision;
    enum formulation formulation;
    enum solver solver;
    int inner, outer;
    bool twice; /* forces and residuals in twice the precision, and as many passes as the hardest
                   scene takes */
    bool as_needed; /* what a run would switch on by itself */
} variant_table[] = {
    {"paper cr", false, PRECISION_DOUBLE, FORMULATION_PAPER, SOLVER_CR, 0, 0, false, false},
    {"paper pcr", false, PRECISION_DOUBLE, FORMULATION_PAPER, SOLVER_PCR_SYMMETRIC, 0,
     0, false, false},
    {"direct cr", false, PRECISION_DOUBLE, FORMULATION_DIRECT, SOLVER_CR, 0, 0, false, false},
    {"direct pcr", false, PRECISION_DOUBLE, FORMULATION_DIRECT, SOLVER_PCR_SYMMETRIC, 0,
     0, false, false},
    {"direct pcr inner", false, PRECISION_DOUBLE, FORMULATION_DIRECT, SOLVER_PCR_SYMMETRIC, 1,
     0, false, false},
    {"robust cr", false, PRECISION_DOUBLE, FORMULATION_DIRECT, SOLVER_CR, 1, 1, false, false},
    {"robust pcr", false, PRECISION_DOUBLE, FORMULATION_DIRECT, SOLVER_PCR_SYMMETRIC, 1,
     1, false, false},
    {"twice cr", false, PRECISION_DOUBLE, FORMULATION_DIRECT, SOLVER_CR, MOST_INNER,
     0, true, false},
    {"twice pcr", false, PRECISION_DOUBLE, FORMULATION_DIRECT, SOLVER_PCR_SYMMETRIC, MOST_INNER,
     0, true, false},
    {"paper pcr as needed", false, PRECISION_DOUBLE, FORMULATION_PAPER, SOLVER_PCR_SYMMETRIC, 0,
     0, false, true},
    {"direct pcr as needed", false, PRECISION_DOUBLE, FORMULATION_DIRECT, SOLVER_PCR_SYMMETRIC, 0,
     0, false, true},
    {"robust pcr", false, PRECISION_FLOAT, FORMULATION_DIRECT, SOLVER_PCR_SYMMETRIC, 1,
     1, false, false},
    {"paper contraction", true, PRECISION_DOUBLE, FORMULATION_PAPER, SOLVER_CR, 0, 0, false, false},
    {"direct contraction", true, PRECISION_DOUBLE, FORMULATION_DIRECT, SOLVER_CR, 0,
     0, false, false},
    {"paper contraction as needed", true, PRECISION_DOUBLE, FORMULATION_PAPER, SOLVER_CR, 0,
     0, false, true},
    {"robust contraction", true, PRECISION_DOUBLE, FORMULATION_DIRECT, SOLVER_CR, 1,
     1, false, false},
};

/* One trial, or the one that another row made of the same program: what a run may switch on
 * afterwards is no part of it. */
static struct known *known_trial(const struct judge *j, const struct run_spec *spec)
{
    struct known_list *list = j->known;
    struct kernel_spec kernel = spec->kernel;
    kernel.refinement = REFINEMENT_AS_GIVEN;
    for (int i = 0; i < list->n; i++)
        /* Structs are compared as bytes: padding that differs would only cost a trial. */
        if (memcmp(&list->item[i].kernel, &kernel, sizeof kernel) == 0) return &list->item[i];
    const struct trial t = trial_run(spec, j->m, j->s, j->a);
    /* A list that is full goes on with its last place. */
    struct known *k = &list->item[list->n < MOST_KNOWN ? list->n++ : MOST_KNOWN - 1];
    *k = (struct known){.kernel = kernel, .trial = t};
    k->trial.tau = k->trial.lambda = k->trial.qdd = NULL;
    k->trial.finish_ps = NULL;
    if (!t.answered) return k;
    k->trial.qdd = TAKE(j->kept, j->m->nu, double);
    memcpy(k->trial.qdd, t.qdd, (size_t)j->m->nu * sizeof *t.qdd);
    return k;
}

/* A variant as a run on a crossbar with a body, or several, per processor. Then as a run would
 * do it: corrections are switched on while the residual asks for them (trust.h). */
static struct known *variant_trial(const struct judge *j, const struct variant *v,
                                  enum precision precision)
{
    /* Enough ranks for every phase of the kernel; a block of bodies each in large scenes. */
    int P = j->m->nbody < MOST_RANKS ? j->m->nbody : MOST_RANKS;
    struct run_spec spec = {.machine = trial_machine(P), .nrank = P};
    /* Quad precision has no type of twice its width. */
    bool twice = v->twice && precision != PRECISION_QUAD;
    spec.kernel = (struct kernel_spec){.name = "forward",
                                       .formulation = v->formulation,
                                       .solver = v->solver,
                                       .part_solver = PART_CR,
                                       .precision = precision,
                                       .composites_incoming = true,
                                       .residual = twice ? RESIDUAL_TWICE : RESIDUAL_WORKING,
                                       .inner_refinements = v->inner,
                                       .outer_refinements = v->outer,
                                       .algebra = ALGEBRA_SPATIAL};
    /* Passes cost time in proportion to the bodies. */
    if (v->twice && j->m->nbody > FEW_BODIES) spec.kernel.inner_refinements = FEW_INNER;
    spec.kernel.refinement = v->as_needed ? REFINEMENT_AS_NEEDED : REFINEMENT_AS_GIVEN;
    static const struct job_omit nothing;
    struct known *t = known_trial(j, &spec);
    while (trust_refine(&spec, j->m, &nothing, &(struct run_result){.residual = t->trial.residual}))
        t = known_trial(j, &spec);
    return t;
}

/* One row of a parallel variant. Its growth is the condition that the reduction reports of
 * itself. */
static void parallel_row(const struct judge *j, const struct variant *v)
{
    struct stability_row *x =
        row_add(j->report, j->subject, v->name, dynamics_type_of(v->precision)->name);
    struct known *known = variant_trial(j, v, v->precision);
    const struct trial *t = &known->trial;
    if (!t->answered) {
        text_copy(x->reason, sizeof x->reason, t->text);
        return;
    }
    x->refinements = t->refined;
    finish_row(j, x, t->qdd, t->residual, v->precision == PRECISION_FLOAT, known);
    if (t->condition > 0) x->growth = t->condition;
}

/* --- why an answer is not good ---------------------------------------------------------------- */

/* The error of a row's algorithm in quad precision; INFINITY: it breaks down there too. The row
 * knows its algorithm by name only, so both lists are searched. */
static double quad_error(const struct judge *j, const struct stability_row *x)
{
    struct arena_mark mark = arena_mark(j->a);
    double *qdd = TAKE(j->a, j->m->nu + 1, double), error = INFINITY;
    struct work w = {0};
    for (int k = 0; k < FORWARD_METHODS; k++)
        if (strcmp(x->algorithm, forward_method_name((enum forward_method)k)) == 0 &&
            dynamics_type_of(PRECISION_QUAD)
                ->forward(j->m, j->s, (enum forward_method)k, j->a, qdd, NULL, NULL, &w))
            error = trial_error(qdd, j->reference, j->m->nu);
    for (size_t k = 0; k < sizeof variant_table / sizeof *variant_table; k++) {
        const struct variant *v = &variant_table[k];
        if (strcmp(x->algorithm, v->name) != 0 ||
            strcmp(x->precision, dynamics_type_of(v->precision)->name) != 0)
            continue;
        const struct trial *t = &variant_trial(j, v, PRECISION_QUAD)->trial;
        if (t->answered) error = trial_error(t->qdd, j->reference, j->m->nu);
    }
    arena_release(j->a, mark);
    return error;
}

static bool is_serial(const struct stability_row *x)
{
    for (int k = 0; k < FORWARD_METHODS; k++)
        if (strcmp(x->algorithm, forward_method_name((enum forward_method)k)) == 0) return true;
    return false;
}

/* What answers the scene well in double precision, as advice: the last of the same kind (serial
 * or parallel), else the last of all, since algorithms are listed from simple to robust. NULL:
 * nothing. */
static const char *remedy_of(const struct stability_report *r, int first,
                             const struct stability_row *failed)
{
    const char *any = NULL, *same = NULL;
    for (int i = first; i < r->nrow; i++) {
        const struct stability_row *x = &r->row[i];
        if (x->status != STABILITY_OK || strcmp(x->precision, "double") != 0) continue;
        any = x->algorithm;
        if (is_serial(x) == is_serial(failed)) same = x->algorithm;
    }
    return same ? same : any;
}

/* Adds to the row's reason whether rounding or the algorithm is to blame: what is right in quad
 * precision was rounding. */
static void cause_tell(const struct judge *j, int first, struct stability_row *x)
{
    char before[sizeof x->reason], cause[96];
    const char *remedy = remedy_of(j->report, first, x);
    double error = quad_error(j, x);
    x->cause = error <= 1e-8 ? CAUSE_ROUNDING : CAUSE_ALGORITHM;
    if (x->cause == CAUSE_ROUNDING)
        snprintf(cause, sizeof cause, "rounding: %.1e in quad precision", error);
    else
        snprintf(cause, sizeof cause, "algorithm-fails: %.1e in quad precision%s%s", error,
                 remedy ? "; use " : "", remedy ? remedy : "");
    text_copy(before, sizeof before, x->reason);
    snprintf(x->reason, sizeof x->reason, "%.60s%s%s", before, before[0] ? "; " : "", cause);
}

/* Causes of the rows from `first` on that are not ok. Quad precision takes some fifty times as
 * long: rows of larger scenes get none. */
static void causes_tell(const struct judge *j, int first)
{
    enum { MOST_CAUSED = 1100 };
    int end = j->report->nrow;
    if (j->m->nbody > MOST_CAUSED) return;
    for (int i = first; i < end; i++)
        if (j->report->row[i].status != STABILITY_OK) cause_tell(j, first, &j->report->row[i]);
}

/* Rows of serial algorithms. The sparse factorisation solves the same system as the dense one,
 * which large scenes cannot afford; single precision of two algorithms shows the rest. */
static void serial_rows(const struct judge *j)
{
    for (int k = 0; k < FORWARD_METHODS; k++) {
        struct arena_mark mark = arena_mark(j->a);
        if (k == FORWARD_CRBA_SPARSE || (k == FORWARD_CRBA && j->m->nu > MOST_DENSE)) continue;
        serial_row(j, (enum forward_method)k, PRECISION_DOUBLE);
        if (k == FORWARD_ABA || k == FORWARD_CFA_DIRECT)
            serial_row(j, (enum forward_method)k, PRECISION_FLOAT);
        arena_release(j->a, mark);
    }
}

/* Trees and loops are contracted, open chains solved: the table has variants for both. */
static void parallel_rows(const struct judge *j)
{
    const bool branched = !j->m->is_chain || j->m->nloop > 0;
    for (size_t k = 0; k < sizeof variant_table / sizeof *variant_table; k++) {
        struct arena_mark mark = arena_mark(j->a);
        if (variant_table[k].contraction == branched) parallel_row(j, &variant_table[k]);
        arena_release(j->a, mark);
    }
}

void stability_accelerations(struct stability_report *r, const char *subject, const struct model *m,
                             const struct state *s, bool causes, struct arena *scratch)
{
    const int first = r->nrow;
    struct known_list known = {0};
    struct judge j = {.report = r, .subject = subject, .m = m, .s = s, .a = scratch,
                      .known = &known, .condition = NAN};
    j.reference = TAKE(scratch, m->nu + 1, double);
    j.right = TAKE(scratch, m->nu + 1, double);
    if (!quad_forward(m, s, scratch, j.reference)) {
        text_copy(row_add(r, subject, "aba", "quad")->reason, 60,
                  "the reference itself broke down");
        return;
    }
    /* The yardsticks of all rows. */
    j.kept = arena_create();
    j.quad = dynamics_type_of(PRECISION_QUAD)->hold(m, s, j.kept);
    j.force = force_of(&j);
    dynamics_type_of(PRECISION_QUAD)->inverse_held(j.quad, j.reference, j.right);
    if (m->nbody <= MOST_MEASURED) j.condition = condition_of(&j);
    serial_rows(&j);
    parallel_rows(&j);
    if (causes) causes_tell(&j, first);
    arena_destroy(j.kept);
}

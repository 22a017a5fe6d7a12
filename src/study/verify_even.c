/* verify_even.c - the case with fixed joints lumped, and the same scene with even masses
 * (verify_rows.h). */
#include "dynamics/system.h"
#include "model/lump.h"
#include "model/vector_model.h"
#include "model/vector_perturb.h"
#include "study/trial.h"
#include "study/verify_rows.h"

/* Constraint forces need every body's inertia: bodies on fixed joints are lumped when that
 * helps. */
bool verify_lump(struct verify_case *v, struct err *e)
{
    v->lumped = v->model;
    v->lumped_state = v->state;
    /* With inverses of all inertias there is nothing to lump. */
    if (v->model->has_phi) return true;
    struct lumped lumped;
    if (!lump_fixed(v->model, true, v->arena, &lumped, e)) return false;
    if (!lumped.model || lumped.model->nbody == v->model->nbody) return true;
    v->lumped = lumped.model;
    v->lumped_state = lump_state(&lumped, v->model, v->state, v->arena);
    return true;
}

/* The same scene with even masses, made once and kept: a row that fails on the case is asked
 * again there. Its reference is articulated bodies in quad precision. */
bool verify_even(struct verify_case *v, struct err *e)
{
    if (v->even) return true;
    struct verify_case *x = TAKE(v->arena, 1, struct verify_case);
    struct work w = {0};
    *x = *v;
    x->vector = vector_even(v->vector, v->arena);
    struct model *m = vector_model(x->vector, v->arena, e);
    if (!m) return false;
    system_prepare(m);
    x->model = m;
    x->state = vector_state(x->vector, m, v->arena);
    double *qdd = TAKE(v->arena, m->nu + 1, double);
    x->answers.exact = qdd;
    x->answers.forward = dynamics_type_of(PRECISION_QUAD)
                             ->forward(m, x->state, FORWARD_ABA, v->arena, qdd, NULL, NULL, &w);
    if (!verify_lump(x, e)) return false;
    v->even = x;
    return true;
}

/* On a scene without extremes every correct algorithm has eight digits. */
bool verify_even_right(const struct verify_case *v, const double *qdd)
{
    const struct verify_answers *x = &v->even->answers;
    return x->forward && trial_error(qdd, x->exact, v->vector->nv) <= 1e-8;
}

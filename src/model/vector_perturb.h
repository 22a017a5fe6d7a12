/* vector_perturb.h - reference vectors changed on purpose: by roundings of their inputs, or to an
 * even scene. */
#ifndef MODEL_VECTOR_PERTURB_H
#define MODEL_VECTOR_PERTURB_H

#include "base/arena.h"
#include "base/random.h"
#include "model/vector.h"

/* vector_perturb: a copy of c, in `a`, whose inputs differ at random by `size` of themselves:
 * vectors, quaternions and the forces, rates and accelerations of one joint by `size` of their
 * length in any direction, so that zeros that are there by the choice of axes move too; products of
 * inertia by `size` of the root of their two moments; all other numbers by `size` of their value.
 * Answers are those of c, and wrong. */
struct vector_case *vector_perturb(const struct vector_case *c, double size, struct random *r,
                                   struct arena *a);

/* vector_even: a copy of c whose bodies all have the mass 1 and the inertia of a ball as large as a
 * mean link: the same topology, joints, pose and loops without extremes of mass or inertia. */
struct vector_case *vector_even(const struct vector_case *c, struct arena *a);

#endif

/* generator.h - models without a file: chains, trees, rings, the four-bar linkage, polymers. */
#ifndef MODEL_GENERATOR_H
#define MODEL_GENERATOR_H

#include "model/model.h"

/* generator_model: the generated system of `spec`; NULL with *e set when its numbers make no
 * bodies.
 *
 *   Links are rods of the given length, radius and mass along x, the next one at the tip;
 * INERTIA_RANDOM gives each body its own mass (log-uniform over mass_ratio), centre of mass and
 * full tensor. Trees: comb (every branch-th body on the spine, the others teeth on it), star (all
 * on body 0), dendrimer (branch children each), random-tree (uniform parent). ring: a closed
 * polygon with the base, or a floating body 0, as last side; four-bar: n = 3; polymer: n CH2 groups
 * on torsion joints in amu, angstrom and picoseconds.
 *
 *   Links shorter than 1e-6 or longer than 1e6 m, lighter than 1e-6 or heavier than 1e6 kg get
 * units of their own: powers of two, so that nothing is rounded and no precision's range is
 * left. */
struct model *generator_model(const struct model_spec *spec, struct arena *a, struct err *e);

/* generator_part: of a system that model_divides, bodies first .. end - 1 (model_part). */
struct model *generator_part(const struct model_spec *spec, int first, int end, struct arena *a,
                             struct err *e);

#endif

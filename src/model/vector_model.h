/* vector_model.h - models and states made from reference vectors. The conventions of both agree
 * (model.h), so numbers are copied, never converted. */
#ifndef MODEL_VECTOR_MODEL_H
#define MODEL_VECTOR_MODEL_H

#include "base/arena.h"
#include "base/err.h"
#include "model/model.h"
#include "model/vector.h"
#include "spec/model_spec.h"

/* vector_model: the model of a case, one body for each of the file's, loops by rows; non-physical
 * bodies are kept, as some reference systems have them (has_phi then says what they rule out). NULL
 * with *e set when it makes no sense. */
struct model *vector_model(const struct vector_case *c, struct arena *a, struct err *e);

/* vector_state: the case's q, qd, qdd, tau and external wrenches. Arrays that the file does not
 * have are zero. */
struct state *vector_state(const struct vector_case *c, const struct model *m, struct arena *a);

/* vector_model_build: the model of the reference vector spec->path. NULL with *e set as
 * vector_read. */
struct model *vector_model_build(const struct model_spec *spec, struct arena *a, struct err *e);

/* vector_state_make: the state in the reference vector spec->path for its model. NULL with *e set
 * as vector_read. */
struct state *vector_state_make(const struct model *m, const struct model_spec *spec,
                                struct arena *a, struct err *e);

#endif

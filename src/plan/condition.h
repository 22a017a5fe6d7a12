/* condition.h - conditions on the points of a sweep, in terms of their settings: `P <=
 * machine.processors`.
 *
 * Names are n, P (or ranks), n_over_p, processors (or machine.processors) and every key of a
 * scenario, in full or short: level, kernel.solver, machine.network.link.bandwidth. The language is
 * that of base/expression.h. */
#ifndef PLAN_CONDITION_H
#define PLAN_CONDITION_H

#include "base/err.h"
#include "base/expression.h"
#include "spec/run_spec.h"

struct condition {
    const struct expression *formula;
    const char *file; /* a path or "--only" */
    int line;         /* 0: none */
};

/* condition_read: the condition that `text` is; texts in `a`. Returns false with ERR_DATA
 * (ERR_USAGE for "--only"). */
bool condition_read(struct condition *c, const char *text, const char *file, int line,
                    struct arena *a, struct err *e);

/* condition_holds: whether `run`, whose sizes are resolved, satisfies it, into *holds. Returns
 * false as condition_read: an unknown name (with the nearest), units that do not fit. */
bool condition_holds(const struct condition *c, const struct run_spec *run, bool *holds,
                     struct err *e);

/* condition_lookup: the value of a name in the run that *context points to (struct run_spec): an
 * expression_lookup_fn. Texts live as long as the arena of the lookup: see condition_scope. */
struct condition_scope {
    const struct run_spec *run;
    struct arena *arena;
};
bool condition_lookup(void *context, const char *name, struct expression_value *v, char *why,
                      int size);

#endif

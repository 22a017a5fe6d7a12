/* outcome.h - what a run came to, and formulas of that and of its settings: goals of `optimise:`,
 * of `answer:`. */
#ifndef APP_OUTCOME_H
#define APP_OUTCOME_H

#include "base/expression.h"
#include "plan/plan.h"
#include "store/store.h"

/* A stored run, as far as formulas may ask; NAN: not known. */
struct outcome {
    bool ok;
    double makespan_s, speedup, efficiency, messages, sent_bytes;
    int64_t id; /* in table run */
};

extern const struct outcome outcome_unknown;

/* outcome_read: of `run` as the database has it; outcome_unknown where it is not stored. */
bool outcome_read(struct store *s, const struct run_spec *run, struct outcome *o, struct err *e);

/* outcome_value: what formula `x` comes to, into *v: of settings (condition.h) and of the results
 * makespan, speedup, efficiency, messages and sent_bytes. Returns false with ERR_DATA at file:line
 * of the key `asked` that has the formula: an unknown name, units that do not fit, a text. */
bool outcome_value(const struct expression *x, const struct run_spec *run, const struct outcome *o,
                   const char *asked, const char *file, int line, struct expression_value *v,
                   struct err *e);

#endif

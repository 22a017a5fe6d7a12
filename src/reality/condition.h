/* condition.h - under which condition a computer was when a program ran on it: how fast, beside
 * when it was calibrated.
 *
 * The same few operations are timed (host_speed.h) while rates are measured and around each burst
 * of repetitions of a real run. The ratio of the two says what a prediction cannot know. */
#ifndef REALITY_CONDITION_H
#define REALITY_CONDITION_H

#include "measure/real_row.h"
#include "plan/plan.h"
#include "spec/machine_spec.h"

/* CONDITION_SAME: operations that differ by no more than this part are of one condition.
 * CONDITION_LEAST: undisturbed repetitions that a burst needs. */
#define CONDITION_SAME 0.10
enum { CONDITION_LEAST = 3 };

/* How fast the computer was while the prices of a machine file were measured; 0: not known. */
struct condition_reference {
    struct host_speed rates; /* of kernels and messages */
    struct host_speed code;  /* of the loops of programs in one file */
};

/* condition_note: what the file says of it behind the source of price `key`, "; probe 0.1045 ns" of
 * "node.flop_rate", appended to `text`; nothing where it is not known or not noted there. */
void condition_note(const struct condition_reference *r, const char *key, char *text, size_t size);

/* condition_reference_of: read back from a machine's values (n). Whether there is any. */
bool condition_reference_of(const struct origin *o, int n, struct condition_reference *out);

/* condition_apply: times of `m` as they are when the operations take `now`: each group of prices
 * multiplied by the ratio of the operation that stands for it; what is not known on either side
 * stays.
 *
 *   flop_rate, div, trig    multiply_add: small dense code, whose blocks the divisions wait for
 *   sqrt, instruction       chain
 *   call                    call
 *   code                    chain of what waits (chain, step, latencies, div, root), multiply_add
 *                           of all else
 *   copy, bytes of messages copy
 *   overheads and latency   message */
void condition_apply(struct machine_spec *m, const struct condition_reference *r,
                     const struct host_speed *now);

/* One burst of a run that can be compared. */
struct condition_burst {
    double seconds;          /* median of the undisturbed repetitions */
    struct host_speed speed; /* mean of before and after */
};

/* What the bursts of a run say. */
struct condition {
    int bursts; /* with at least CONDITION_LEAST undisturbed repetitions; 0: nothing is known */
    int steady; /* of them, those before and after which multiply_add, call and chain differ by
                   CONDITION_SAME at most */
    struct condition_burst burst[REAL_BURSTS]; /* (steady) */
};

/* condition_of: from the samples and bursts of `r`, at most REAL_BURSTS. condition_changed: the
 * computer's speed changed during the run: fewer than half of the bursts are steady. */
struct condition condition_of(const struct real_result *r);
bool condition_changed(const struct condition *c);

/* condition_middle: the index of the median of n >= 1 errors, the lower one of two. */
int condition_middle(const double *error, int n);

#endif

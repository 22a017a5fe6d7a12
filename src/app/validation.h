/* validation.h - published figures judged: what the simulator answers, how far off, and what all
 * say together. */
#ifndef APP_VALIDATION_H
#define APP_VALIDATION_H

#include "app/published.h"
#include "base/arena.h"
#include "base/err.h"
#include "base/json.h"
#include "plan/plan.h"

/* Errors above this need a cause that somebody wrote down. */
#define VALIDATION_UNEXPLAINED 0.3


/* validation_level_name: "loggp", ... of enum network_level below LEVELS. */
const char *validation_level_name(int level);

/* validation_levels_json: an object of one number a level, each over `scale`; not finite: null. */
void validation_levels_json(const double level[LEVELS], double scale, struct json *j);

/* What a point came to. */
struct validated {
    bool measured;
    double value;            /* SI; NAN: not measured */
    /* why the machine has no such quantity, or why the row's cause does not explain the error */
    char why[256];
    double error, tolerance; /* relative */
    const char *verdict;     /* pass, fail, explained, not-testable */
    bool contended;          /* several ranks share the wires: */
    double level[LEVELS]; /* then the value at each level of enum network_level, SI, NAN: none */
    bool computed;        /* the node's model matters: */
    double model[NODE_MODELS]; /* then the value with each of enum node_model, SI, NAN: none */
};

/* validation_measure: the figure `p` asked of its simulated machine, and judged.
 *
 * A figure used for calibration, and every rate of wires, has its tolerance: 5 % wires, reads and
 * cuts, 10 % what was published or derived, 20 % what was recalled or estimated. A figure that was
 * held back may be off by VALIDATION_UNEXPLAINED. Inside its published range every figure passes.
 * What misses is `explained` where the row names a cause that begins with this error ("+40 %: ...",
 * within the tolerance), else `fail`; what the machine lacks, or what was measured on another, is
 * `not-testable`.
 *
 * Returns false with the error of plan_machine when the machine cannot be read or set up. */
bool validation_measure(const struct published *p, struct validated *o, struct arena *a,
                        struct err *e);

/* validation_judge: error, tolerance and verdict of an outcome whose value was measured, or was
 * not. */
void validation_judge(const struct published *p, struct validated *o);

/* One group of testable points. */
struct validation_group {
    /* points; above VALIDATION_UNEXPLAINED; those of them without a cause */
    int n, above, unnamed;
    double median, mean, worst; /* of |error|; worst with its sign */
    const char *worst_id;      /* borrowed; "": no point */
};

/* What a table of points says together. A point counts in a group when it was measured, is not
 * `other`, and its class is not E: an estimate only says that the file was followed. */
struct validation_summary {
    int shown, failed, explained, untested, estimated;
    struct validation_group calibrated, held;
};

/* validation_summarize: of `n` points (rows and outcomes side by side). Memory of its own, given
 * back. */
struct validation_summary validation_summarize(const struct published *const *p,
                                               const struct validated *o, int n);

#endif

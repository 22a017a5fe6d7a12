/* explain_space.h - what the paper does not state: the parameters that `claims --explain` may
 * change, and how far.
 *
 * A point is a vector u of changes, one entry an axis, 0 where nothing changes: the natural
 * logarithm of the factor by which the axis's numbers differ from the machine file's; of others'
 * traffic -ln(1 - load), of disturbances ln(1 + spread). Distances are sums of |u|: exp(distance)
 * is the product of all factors. Published ranges come from the machine files alone; what lies
 * beyond one is told as such. */
#ifndef APP_EXPLAIN_SPACE_H
#define APP_EXPLAIN_SPACE_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "base/text.h"
#include "spec/field.h"
#include "spec/run_spec.h"

enum { EXPLAIN_MOST_AXES = 12, EXPLAIN_MOST_KEYS = 3 };

/* How a change becomes a number. */
enum explain_map {
    EXPLAIN_FACTOR,   /* value = nominal exp(u) */
    EXPLAIN_RELATIVE, /* value = exp(u) times the value of the first axis; nothing at u = 0 */
    EXPLAIN_SHARE,    /* value = 1 - exp(-u), u >= 0 */
    EXPLAIN_SPREAD    /* value = exp(u) - 1, u >= 0 */
};

struct explain_axis {
    const char *words; /* "the code runs at": a value follows */
    const char *after; /* and then these, "" when there are none */
    enum explain_map map;
    int nkey;
    const char *key[EXPLAIN_MOST_KEYS]; /* (nkey) without "machine." */
    const struct field *field[EXPLAIN_MOST_KEYS];
    double nominal[EXPLAIN_MOST_KEYS];                      /* SI, of the machine file */
    /* published, both 0 when there is no range */
    double low[EXPLAIN_MOST_KEYS], high[EXPLAIN_MOST_KEYS];
    double least, most;                                     /* of u: the box that is searched */
    bool dear; /* simulating a change takes ten times as long: tried sparingly */
};

struct explain_space {
    const char *machine;
    int n;
    struct explain_axis axis[EXPLAIN_MOST_AXES];
};

/* explain_space_make: the axes of machine `name` (a file's stem): those of the table whose numbers
 * are not 0 there. The texts live in `a`. Returns false as plan_machine. */
bool explain_space_make(struct explain_space *s, const char *name, struct arena *a, struct err *e);

/* explain_space_snap: put u (n) into the box and onto values of three digits, so that a point is
 * what its text says. */
void explain_space_snap(const struct explain_space *s, double *u);

/* explain_space_distance: sum of |u|. */
double explain_space_distance(const struct explain_space *s, const double *u);

/* explain_space_value: the number of key k of axis i at the snapped u, in SI. */
double explain_space_value(const struct explain_space *s, const double *u, int i, int k);

/* explain_space_settings: "machine.node.flop_rate=20 Mflop/s, ...": the changed keys as for --set,
 * appended. */
void explain_space_settings(const struct explain_space *s, const double *u, struct text *out);

/* explain_space_apply: the run at the point u: settings changed, identity anew (its text in
 * `a`). */
void explain_space_apply(const struct explain_space *s, const double *u, struct run_spec *run,
                         struct arena *a);

/* explain_space_phrase: axis i at u in words: "the code runs at 20 Mflop/s (2.8 times below
 * nominal, outside the published range of 35 Mflop/s to 100 Mflop/s)", appended; `brief`: without
 * what stands in brackets. */
void explain_space_phrase(const struct explain_space *s, const double *u, int i, bool brief,
                          struct text *out);

/* explain_space_published: whether every changed number that has a published range is within it,
 * and every changed number has one. */
bool explain_space_published(const struct explain_space *s, const double *u);

#endif

/* expression.h - formulas and conditions that users write: `ranks <= processors and n % ranks ==
 * 0`.
 *
 * Numbers with units ("2 ms", "5%"), names, + - * / %, < <= > >= == !=, and, or, not, brackets, and
 * the functions log2, sqrt, min and max. A formula is data: nothing is executed, and what it may
 * look at is what the lookup function gives. Its length and depth are limited. Units are checked:
 * a time is compared with a time. Words may hold hyphens ("pcr-symmetric"), so a minus between
 * names needs blanks. */
#ifndef BASE_EXPRESSION_H
#define BASE_EXPRESSION_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/units.h"

enum { EXPRESSION_MAX_LENGTH = 400, EXPRESSION_MAX_DEPTH = 40 };

struct expression; /* in its arena */

/* A number with its kind of unit, in SI; or a text. */
struct expression_value {
    const char *text; /* NULL: a number */
    double number;    /* conditions: 1 or 0; NaN: not known, and no comparison with it holds */
    enum unit unit;   /* UNIT_KINDS: of products that have no name, which compare with anything */
    bool truth;       /* it came from a comparison, and, or, not */
    double excess;    /* of a condition that does not hold: by how much, relative; 0: it holds */
};

/* The value of a name.
 * Returns false with a clause in why[size] when there is no such name. */
typedef bool expression_lookup_fn(void *context, const char *name, struct expression_value *v,
                                  char *why, int size);

/* expression_read: the formula `text` in `a`; NULL with a clause in why[size]: what is wrong, and
 * where. */
struct expression *expression_read(const char *text, struct arena *a, char *why, int size);

/* expression_value: what it comes to. A word next to == or != whose other side is a text, and which
 * `lookup` does not know, stands for itself. Returns false with a clause in why[size]: an unknown
 * name, units that do not fit, a text where a number belongs. Division by zero gives NaN. */
bool expression_value(const struct expression *x, expression_lookup_fn *lookup, void *context,
                      struct expression_value *v, char *why, int size);

/* expression_text: the formula as it was written. */
const char *expression_text(const struct expression *x);

#endif

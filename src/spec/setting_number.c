/* setting_number.c - numbers out of the texts of settings; see setting_number.h.
 *
 * A text is what a user wrote and what identifies a run; a number is what a figure needs. Both are
 * kept, and this is the one place that makes the second out of the first. */
#include "spec/setting_number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "spec/field.h"
#include "spec/spec_fields.h"

/* A number and nothing behind it. */
static bool plain_number(const char *value, double *number)
{
    char *end;
    *number = strtod(value, &end);
    return end != value && *end == '\0' && isfinite(*number);
}

/* The kinds of quantity that parameters of programs may have: no two share a unit's name. */
static bool guess_number(const char *value, double *number, enum unit *unit)
{
    static const enum unit kind[] = {UNIT_TIME, UNIT_BYTES, UNIT_BANDWIDTH, UNIT_FREQUENCY,
                                     UNIT_FLOP_RATE, UNIT_PERCENT};
    char why[160];
    *unit = UNIT_NONE;
    if (plain_number(value, number)) return true;
    for (size_t i = 0; i < sizeof kind / sizeof *kind; i++) {
        if (!units_parse(value, kind[i], number, why, (int)sizeof why)) continue;
        *unit = kind[i];
        return true;
    }
    return false;
}

bool setting_number(const char *key, const char *value, double *number, enum unit *unit)
{
    const struct field_table *table;
    const struct field *f = field_find_full(key, &table);
    char why[160];
    *unit = UNIT_NONE;
    /* What no table knows is a parameter of a program, or nothing. */
    if (f == NULL)
        return strncmp(key, "program.", 8) == 0 && guess_number(value, number, unit);
    *unit = f->unit;
    switch (f->kind) {
    case FIELD_REAL:
    case FIELD_INT64:
    case FIELD_INT:
    case FIELD_SEED:
        /* As field_set reads it; "unlimited" is no number. */
        return f->unit == UNIT_NONE ? plain_number(value, number)
                                    : units_parse(value, f->unit, number, why, (int)sizeof why);
    /* Words and lists have no order that a figure could draw. */
    default:
        return false;
    }
}

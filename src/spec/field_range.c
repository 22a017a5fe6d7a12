/* field_range.c - whether a value is within its field's bounds, and refusals (field_list.h).
 *
 * Bounds are inclusive, in SI, and belong to every entry of a list. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "spec/field_list.h"

/* Always false, so that a refusal is one statement: return field_refuse(..). */
bool field_refuse(char *why, int size, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(why, (size_t)size, format, args);
    va_end(args);
    return false;
}

/* A bound for messages: counts without, quantities with their unit, as the user writes them. */
static void print_bound(const struct field *f, double value, char *buffer, int size)
{
    if (f->kind == FIELD_REAL || f->kind == FIELD_REALS || f->unit == UNIT_BYTES)
        units_print(value, f->unit, buffer, size);
    else snprintf(buffer, (size_t)size, "%.0f", value);
}

/* "Not a number" fails both comparisons and is refused. Bounds that are technical (1e15 and more)
 * are not told, since they would not help anybody. */
bool field_in_range(const struct field *f, double value, char *why, int size)
{
    if (value >= f->min && value <= f->max) return true;
    char low[48], high[48];
    print_bound(f, f->min, low, (int)sizeof low);
    print_bound(f, f->max, high, (int)sizeof high);
    bool has_low = isfinite(f->min), has_high = isfinite(f->max) && fabs(f->max) < 1e15;
    if (has_low && has_high)
        return field_refuse(why, size, "out of range; expected %s to %s", low, high);
    if (has_low) return field_refuse(why, size, "out of range; expected at least %s", low);
    return field_refuse(why, size, "out of range; expected at most %s", high);
}

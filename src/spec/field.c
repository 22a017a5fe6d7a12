/* field.c - single values: text to their place in a struct and back.
 *
 * A value is text in files, on the command line and in the store, and a number in the struct.
 * Between the two stands one row of a table. Reading checks syntax, unit, range and choice, and
 * says as a clause what was expected; the caller adds key, file and line. Examples, by kind:
 *
 *     REAL "480 MB/s" -> 4.8e8      INT64 "8 KiB" -> 8192      CHOICE "cr" -> SOLVER_CR
 *     INTS "[8, 4, 4]", "8x4x4"     REALS "[0, 0, -9.81] m/s^2"     SEED "18446744073709551615"
 *
 * Printing uses the shortest text that reads back to the same bits, so a printed configuration is
 * an identity. */
#include "spec/field.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "spec/field_list.h"
#include "spec/field_segments.h"

/* The whole text must be one decimal number; blanks may follow. strtoll alone would accept
 * "16x". */
bool field_int_parse(const char *text, int64_t *value, char *why, int size)
{
    char *end;
    errno = 0;
    long long v = strtoll(text, &end, 10);
    const bool digits = end != text;
    while (isspace((unsigned char)*end)) end++;
    if (!digits || *end != '\0')
        return field_refuse(why, size, "not a whole number; expected one such as '16'");
    if (errno == ERANGE) return field_refuse(why, size, "out of range of 64-bit whole numbers");
    *value = v;
    return true;
}

/* A quantity: number and unit in, SI value out (base/units.h). The range is checked in SI. */
static bool set_real(const struct field *f, double *place, const char *text, char *why, int size)
{
    double v;
    if (f->zero != NULL && strcmp(text, f->zero) == 0) return *place = 0, true;
    if (!units_parse(text, f->unit, &v, why, size) || !field_in_range(f, v, why, size))
        return false;
    *place = v;
    return true;
}

/* Range first, then the narrowing to int: all ranges of such fields lie within it. */
static bool set_int(const struct field *f, int *place, const char *text, char *why, int size)
{
    int64_t v;
    if (!field_int_parse(text, &v, why, size) || !field_in_range(f, (double)v, why, size))
        return false;
    *place = (int)v;
    return true;
}

/* A size may be given in any byte unit but has to be a whole number of bytes: "1.5 KiB" is one,
 * "0.1 B" is not. */
static bool set_int64(const struct field *f, int64_t *place, const char *text, char *why, int size)
{
    /* Counts of 64 bits have no unit; sizes have one. */
    if (f->unit == UNIT_NONE) {
        int64_t v;
        if (!field_int_parse(text, &v, why, size) || !field_in_range(f, (double)v, why, size))
            return false;
        *place = v;
        return true;
    }
    /* Where a limit can be absent, -1 means so; no other number is negative. */
    if (f->min < 0 && strcmp(text, "unlimited") == 0) {
        *place = -1;
        return true;
    }
    double v;
    if (!units_parse(text, f->unit, &v, why, size)) return false;
    /* A negative size would pass as "unlimited" where that is allowed. */
    if (v < 0) return field_refuse(why, size, "a size cannot be negative");
    if (!field_in_range(f, v, why, size)) return false;
    if (v != floor(v)) return field_refuse(why, size, "not a whole number of bytes");
    *place = (int64_t)v;
    return true;
}

/* All 64 bits, so that not int64; strtoull would take "-1", hence the test for a digit. */
static bool set_seed(uint64_t *place, const char *text, char *why, int size)
{
    char *end;
    errno = 0;
    unsigned long long v = strtoull(text, &end, 10);
    if (!isdigit((unsigned char)text[0]) || *end != '\0' || errno == ERANGE)
        return field_refuse(why, size, "not a seed; expected a whole number from 0 to 2^64-1");
    *place = v;
    return true;
}

/* YAML's words for truth; "1" and "0" are refused, since they look like counts. */
static bool set_bool(bool *place, const char *text, char *why, int size)
{
    static const char *const yes[] = {"true", "yes", "on"}, *const no[] = {"false", "no", "off"};
    for (int i = 0; i < 3; i++) {
        if (strcmp(text, yes[i]) == 0) return *place = true, true;
        if (strcmp(text, no[i]) == 0) return *place = false, true;
    }
    return field_refuse(why, size, "expected 'true' or 'false'");
}

/* Exact words only: an abbreviation would change its meaning with the next choice added. A near
 * miss is told by name. */
static bool set_choice(const struct field *f, int *place, const char *text, char *why, int size)
{
    /* The list of choices is part of the message: nobody should have to look it up. */
    int n = 0, at = 0;
    for (; f->choice[n] != NULL; n++)
        if (strcmp(f->choice[n], text) == 0) return *place = n, true;
    at = snprintf(why, (size_t)size, "expected one of");
    for (int i = 0; i < n && at < size; i++)
        at += snprintf(why + at, (size_t)(size - at), "%s %s", i > 0 ? "," : "", f->choice[i]);
    const char *near = text_nearest(text, f->choice, n);
    if (near != NULL && at < size)
        snprintf(why + at, (size_t)(size - at), "; did you mean '%s'?", near);
    return false;
}

/* Names end up in tables, files and databases: no control characters. The rest of the room is
 * zeroed, because structs are compared as bytes (struct field_table). */
static bool set_text(const struct field *f, char *place, const char *text, char *why, int size)
{
    size_t length = strlen(text);
    if (length >= (size_t)f->capacity)
        return field_refuse(why, size, "too long; at most %d bytes", f->capacity - 1);
    for (const char *s = text; *s != '\0'; s++)
        if ((unsigned char)*s < 0x20)
            return field_refuse(why, size, "control characters are not allowed in a name");
    /* A text with a meaning of its own is checked by who understands it. */
    if (f->valid != NULL && !f->valid(text, why, size)) return false;
    memset(place, 0, (size_t)f->capacity);
    memcpy(place, text, length);
    return true;
}

/* One reader a kind; a new kind needs one here and one in field_print. */
bool field_set(const struct field *f, void *base, const char *text, struct arena *a, char *why,
               int size)
{
    void *place = (char *)base + f->offset;
    switch (f->kind) {
    /* Numbers: unit, range. */
    case FIELD_REAL:
        return set_real(f, place, text, why, size);
    case FIELD_INT:
        return set_int(f, place, text, why, size);
    case FIELD_INT64:
        return set_int64(f, place, text, why, size);
    case FIELD_SEED:
        return set_seed(place, text, why, size);
    /* Words. */
    case FIELD_BOOL:
        return set_bool(place, text, why, size);
    case FIELD_CHOICE:
        return set_choice(f, place, text, why, size);
    case FIELD_TEXT:
        return set_text(f, place, text, why, size);
    /* Lists: the number of entries goes to the struct beside the entries (field_list.c). */
    case FIELD_INTS:
        return field_ints_set(f, base, text, why, size);
    case FIELD_REALS:
        return field_reals_set(f, base, text, why, size);
    case FIELD_INT_LIST:
        return field_int_list_set(f, base, text, a, why, size);
    case FIELD_PAIR_LIST:
        return field_pair_list_set(f, base, text, a, why, size);
    /* Mappings, whose values are fields themselves (field_segments.c). */
    case FIELD_SEGMENTS:
        return field_segments_set(f, base, text, field_set, a, why, size);
    }
    CHECK(false); /* a kind without a reader */
    return false;
}

/* Defaults are texts and take the same way as a user's: they cannot violate their own range. */
void field_defaults(const struct field_table *t, void *base, struct arena *a)
{
    char why[160];
    /* Zeroed with its padding: equal settings are then equal bytes. */
    memset(base, 0, t->size);
    for (int i = 0; i < t->nfield; i++)
        if (t->field[i].fallback != NULL)
            /* A default that is refused is a mistake in the table. */
            CHECK(field_set(&t->field[i], base, t->field[i].fallback, a, why, (int)sizeof why));
}

/* Without a format: identities of large campaigns spend their time here. */
static void add_word(const char *word, struct text *out)
{
    text_add_bytes(out, word, strlen(word));
}

/* The shortest text that reads back to the same bits (units_print). */
static void print_real(double v, enum unit unit, struct text *out)
{
    char buffer[64];
    units_print(v, unit, buffer, (int)sizeof buffer);
    add_word(buffer, out);
}

/* Sizes print with their unit, counts without. */
static void print_int64(const struct field *f, int64_t v, struct text *out)
{
    if (f->unit == UNIT_NONE) text_add_integer(out, v);
    else if (v < 0) text_add(out, "unlimited");
    else print_real((double)v, f->unit, out);
}

/* Kinds that can be compared and counted with; a seed, too, although few of its bits fit. */
bool field_number(const struct field *f, const void *base, double *number)
{
    const void *place = (const char *)base + f->offset;
    switch (f->kind) {
    case FIELD_REAL:
        *number = *(const double *)place;
        return true;
    case FIELD_INT:
        *number = *(const int *)place;
        return true;
    case FIELD_INT64:
        *number = (double)*(const int64_t *)place;
        return true;
    /* Beyond 2^53 neighbours become equal, which no condition on a seed can notice. */
    case FIELD_SEED:
        *number = (double)*(const uint64_t *)place;
        return true;
    default:
        return false;
    }
}

/* A rate of 0 that stands for no limit reads as the opposite of what it means. */
static bool is_zero(const struct field *f, const void *base)
{
    const char *place = (const char *)base + f->offset;
    return f->zero != NULL && *(const double *)(const void *)place == 0;
}

void field_show(const struct field *f, const void *base, struct text *out)
{
    if (is_zero(f, base)) text_add(out, "%s", f->zero);
    else field_print(f, base, out);
}

bool field_is_wordless_zero(const struct field *f, const void *base, const char *text)
{
    return is_zero(f, base) && strcmp(text, f->zero) != 0;
}

const char *field_word(const struct field *f, const char *value)
{
    const char *word = f == NULL ? NULL : f->zero != NULL ? f->zero : f->instead;
    return word == NULL || strtod(value, NULL) != 0 ? value : word;
}

/* The inverse of field_set, kind by kind. The identity of a run is made of these texts. */
void field_print(const struct field *f, const void *base, struct text *out)
{
    const char *place = (const char *)base + f->offset;
    const int *ints = (const int *)(const void *)place;
    switch (f->kind) {
    /* Reals always print with their unit: nobody has to know the key to read the value. */
    case FIELD_REAL:
        print_real(*(const double *)(const void *)place, f->unit, out);
        return;
    case FIELD_INT:
        text_add_integer(out, *ints);
        return;
    case FIELD_INT64:
        print_int64(f, *(const int64_t *)(const void *)place, out);
        return;
    /* All 64 bits, as they were given. */
    case FIELD_SEED:
        text_add(out, "%" PRIu64, *(const uint64_t *)(const void *)place);
        return;
    case FIELD_BOOL:
        add_word(*(const bool *)place ? "true" : "false", out);
        return;
    /* The word, not the number: enums may be reordered between versions. */
    case FIELD_CHOICE:
        add_word(f->choice[*ints], out);
        return;
    case FIELD_TEXT:
        add_word(place, out);
        return;
    /* Lists print in one form, whatever form they were given in. */
    case FIELD_INTS:
    case FIELD_REALS:
    case FIELD_INT_LIST:
    case FIELD_PAIR_LIST:
        field_list_print(f, base, out);
        return;
    case FIELD_SEGMENTS:
        field_segments_print(f, base, field_print, out);
        return;
    }
    CHECK(false); /* a kind without a printer */
}

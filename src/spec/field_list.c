/* field_list.c - lists of numbers in brackets or without, by commas, blanks or 'x'.
 *
 *     ints     [8, 4, 4]   8 4 4   8,4,4   8x4x4
 *     pairs    [[0, 1], [1, 2]]
 *     reals    [0, 0, -9.81] m/s^2   0, 0, -9.81 m/s^2   [480 MB/s, 1 GB/s]
 *
 * A unit after the last number holds for all numbers that have none of their own. Numbers of a list
 * of any length are counted in a first pass and stored in a second, by the same code. */
#include "spec/field_list.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A limit against mistakes, before memory is taken for a list. */
enum { LIST_MAX_ENTRIES = 1 << 22, ENTRY_LENGTH = 64 };

/* Blanks are allowed wherever a person might put them. */
static const char *skip_blanks(const char *s)
{
    while (isspace((unsigned char)*s)) s++;
    return s;
}

/* One whole number at *s, which moves behind it. A number beyond 64 bits is read as the largest one
 * and then fails its range. */
static bool take_int(const struct field *f, const char **s, int *value, char *why, int size)
{
    char *end;
    long long v = strtoll(*s, &end, 10);
    if (end == *s)
        return field_refuse(why, size,
                            "not a list of whole numbers; expected one such as '[8, 4, 4]'");
    if (!field_in_range(f, (double)v, why, size)) return false;
    *value = (int)v;
    *s = end;
    return true;
}

/* Numbers up to the end or the closing bracket; `value` NULL only counts. "8x4x4" is the customary
 * way to write dimensions, without brackets. */
static bool scan_ints(const struct field *f, const char *text, int *value, int capacity, int *count,
                      char *why, int size)
{
    const char *s = skip_blanks(text);
    bool bracket = *s == '[';
    int n = 0;
    s = skip_blanks(s + bracket);
    /* Separators may be missing or doubled with blanks; two commas in a row may not. */
    while (*s != '\0' && *s != ']') {
        int v = 0;
        if (!take_int(f, &s, &v, why, size)) return false;
        if (n == capacity) return field_refuse(why, size, "too many entries");
        if (value != NULL) value[n] = v;
        n++;
        /* "8+4" is a sum, not a list. */
        if (*s == '+' || *s == '-')
            return field_refuse(why, size,
                                "not a list of whole numbers; expected one such as '[8, 4, 4]'");
        s = skip_blanks(s);
        if (*s != ',' && (*s != 'x' || bracket)) continue;
        /* A separator separates: behind it there is a number. */
        s = skip_blanks(s + 1);
        if (*s == '\0' || *s == ']')
            return field_refuse(why, size,
                                "a number is missing at the end; expected a list such as '[8, 4, "
                                "4]' or '8x4x4'");
    }
    /* A bracket on one side only, or something behind the closing one. */
    if (bracket != (*s == ']') || (bracket && *skip_blanks(s + 1) != '\0'))
        return field_refuse(why, size,
                            "brackets do not match; expected a list such as '[8, 4, 4]'");
    *count = n;
    return true;
}

/* Two passes: nothing is written until the whole list has been read and is right. */
bool field_ints_set(const struct field *f, void *base, const char *text, char *why, int size)
{
    int n = 0, *place = (int *)(void *)((char *)base + f->offset);
    if (!scan_ints(f, text, NULL, f->capacity, &n, why, size)) return false;
    if (n == 0) return field_refuse(why, size, "an empty list; expected at least one number");
    memset(place, 0, (size_t)f->capacity * sizeof *place);
    scan_ints(f, text, place, f->capacity, &n, why, size);
    *(int *)(void *)((char *)base + f->count) = n;
    return true;
}

/* The first pass counts, so that the arena gives exactly what is needed. */
bool field_int_list_set(const struct field *f, void *base, const char *text, struct arena *a,
                        char *why, int size)
{
    int n = 0, *list = NULL;
    if (!scan_ints(f, text, NULL, LIST_MAX_ENTRIES, &n, why, size)) return false;
    if (n > 0) list = TAKE(a, n, int);
    scan_ints(f, text, list, n, &n, why, size);
    memcpy((char *)base + f->offset, &list, sizeof list);
    *(int *)(void *)((char *)base + f->count) = n;
    return true;
}

/* "[a, b]" at *s, which moves behind it and the blanks that follow. */
static bool take_pair(const struct field *f, const char **s, int pair[2], char *why, int size)
{
    static const char expected[] = "not a list of pairs; expected one such as '[[0, 1], [1, 2]]'";
    if (**s != '[') return field_refuse(why, size, expected);
    for (int i = 0; i < 2; i++) {
        *s = skip_blanks(*s + 1);
        if (!take_int(f, s, &pair[i], why, size)) return false;
        *s = skip_blanks(*s);
        if (**s != (i == 0 ? ',' : ']')) return field_refuse(why, size, expected);
    }
    *s = skip_blanks(*s + 1);
    return true;
}

/* As scan_ints: with `list` NULL it only counts. */
static bool scan_pairs(const struct field *f, const char *text, int (*list)[2], int *count,
                       char *why, int size)
{
    const char *s = skip_blanks(text);
    int n = 0, pair[2];
    if (*s != '[')
        return field_refuse(why, size,
                            "not a list of pairs; expected one such as '[[0, 1], [1, 2]]'");
    s = skip_blanks(s + 1);
    while (*s != '\0' && *s != ']') {
        if (!take_pair(f, &s, pair, why, size)) return false;
        if (n == LIST_MAX_ENTRIES) return field_refuse(why, size, "too many entries");
        if (list != NULL) memcpy(list[n], pair, sizeof pair);
        n++;
        if (*s == ',') s = skip_blanks(s + 1);
    }
    if (*s != ']' || *skip_blanks(s + 1) != '\0')
        return field_refuse(why, size, "brackets do not match");
    *count = n;
    return true;
}

/* The struct holds pointer and count; the pairs live in the arena. */
bool field_pair_list_set(const struct field *f, void *base, const char *text, struct arena *a,
                         char *why, int size)
{
    int n, (*list)[2] = NULL;
    if (!scan_pairs(f, text, NULL, &n, why, size)) return false;
    if (n > 0) list = arena_take(a, (size_t)n * sizeof *list);
    scan_pairs(f, text, list, &n, why, size);
    memcpy((char *)base + f->offset, &list, sizeof list);
    *(int *)(void *)((char *)base + f->count) = n;
    return true;
}

/* The next entry of a list of quantities, up to a comma; without commas a blank before a digit or
 * sign separates, so that "1 2 m/s" is two numbers and one unit. NULL: too long for `entry`. */
static const char *next_entry(const char *s, bool commas, char entry[ENTRY_LENGTH])
{
    int n = 0;
    s = skip_blanks(s);
    while (*s != '\0' && *s != ',') {
        const char *next = skip_blanks(s);
        if (!commas && n > 0 && next > s && strchr("+-.0123456789", *next) != NULL) break;
        /* blanks at the end need no room; a number that has none is no number of fewer digits */
        if (n < ENTRY_LENGTH - 1) entry[n++] = *s;
        else if (!isspace((unsigned char)*s)) return NULL;
        s++;
    }
    while (n > 0 && isspace((unsigned char)entry[n - 1])) n--;
    entry[n] = '\0';
    return *s == ',' ? s + 1 : s;
}

/* "[a, b] unit" or "a, b unit" without brackets into `inner`; the unit behind a bracket into
 * `unit`, "" where there is none. */
static bool open_list(const char *text, char *inner, int capacity, char unit[ENTRY_LENGTH],
                      char *why, int size)
{
    const char *s = skip_blanks(text);
    bool bracket = *s == '[';
    const char *end = bracket ? strchr(s, ']') : s + strlen(s);
    if (end == NULL) return field_refuse(why, size, "a bracket is not closed");
    s += bracket;
    if (end - s >= capacity) return field_refuse(why, size, "too long a list");
    memcpy(inner, s, (size_t)(end - s));
    inner[end - s] = '\0';
    if (snprintf(unit, ENTRY_LENGTH, "%s", bracket ? skip_blanks(end + 1) : "") >= ENTRY_LENGTH)
        return field_refuse(why, size, "too long a unit");
    return true;
}

/* Where the unit of an entry begins: behind its number, as strtod sees it. */
static const char *unit_of(const char *entry)
{
    char *end;
    strtod(entry, &end);
    return skip_blanks(end);
}

/* Entries first, as texts, because the unit of all may stand behind the last one. */
bool field_reals_set(const struct field *f, void *base, const char *text, char *why, int size)
{
    char inner[1024], unit[ENTRY_LENGTH], entry[16][ENTRY_LENGTH], quantity[2 * ENTRY_LENGTH];
    double value[16] = {0};
    int n = 0;
    if (!open_list(text, inner, (int)sizeof inner, unit, why, size)) return false;
    bool commas = strchr(inner, ',') != NULL;
    for (const char *s = skip_blanks(inner); *s != '\0'; s = skip_blanks(s)) {
        if (n == f->capacity || n == 16) return field_refuse(why, size, "too many entries");
        s = next_entry(s, commas, entry[n++]);
        if (s == NULL) return field_refuse(why, size, "too long a number");
    }
    /* Vectors of three need all three numbers. */
    if (n < f->at_least) {
        snprintf(why, (size_t)size, "%d numbers; expected %d", n, f->at_least);
        return false;
    }
    /* Behind a bracket there is a unit or nothing, even where nobody needs it. */
    snprintf(quantity, sizeof quantity, "1 %.63s", unit);
    if (unit[0] != '\0' && !units_parse(quantity, f->unit, &value[0], why, size)) return false;
    /* No unit behind a bracket: that of the last entry holds for those that have none. */
    if (unit[0] == '\0') snprintf(unit, sizeof unit, "%s", unit_of(entry[n - 1]));
    for (int i = 0; i < n; i++) {
        /* A bare number borrows the unit; an entry with its own keeps it. */
        bool bare = unit_of(entry[i])[0] == '\0' && unit[0] != '\0';
        snprintf(quantity, sizeof quantity, "%.63s%s%.63s", entry[i], bare ? " " : "",
                 bare ? unit : "");
        if (!units_parse(quantity, f->unit, &value[i], why, size) ||
            !field_in_range(f, value[i], why, size))
            return false;
    }
    /* The whole capacity: what is not given is 0. */
    memcpy((char *)base + f->offset, value, (size_t)f->capacity * sizeof *value);
    return true;
}

/* The struct's bytes are copied, since the table knows offsets and not types. */
static void print_pair_list(const struct field *f, const void *base, int n, struct text *out)
{
    int(*list)[2];
    memcpy(&list, (const char *)base + f->offset, sizeof list);
    for (int i = 0; i < n; i++)
        text_add(out, "%s[%d, %d]", i > 0 ? ", " : "", list[i][0], list[i][1]);
}

static void print_reals(const struct field *f, const void *base, struct text *out)
{
    const double *value = (const double *)(const void *)((const char *)base + f->offset);
    char buffer[64];
    /* Trailing zeros are left out: "[0, 0, -9.81]" is whole, "[1, 0, 0]" of one required number is
     * "[1]". */
    int n = f->capacity;
    while (n > f->at_least && value[n - 1] == 0) n--; /* what is not given is 0 */
    for (int i = 0; i < n; i++) {
        units_print(value[i], f->unit, buffer, (int)sizeof buffer);
        text_add(out, "%s%s", i > 0 ? ", " : "", buffer);
    }
}

/* All lists print in one form, with brackets and commas, whatever form they were given in. */
void field_list_print(const struct field *f, const void *base, struct text *out)
{
    const char *place = (const char *)base + f->offset;
    const int *list = (const int *)(const void *)place;
    int n =
        f->kind == FIELD_REALS ? 0 : *(const int *)(const void *)((const char *)base + f->count);
    /* The four kinds differ in where the entries are: in the struct or behind a pointer. */
    text_add(out, "[");
    if (f->kind == FIELD_INT_LIST) memcpy(&list, place, sizeof list);
    if (f->kind == FIELD_PAIR_LIST) print_pair_list(f, base, n, out);
    if (f->kind == FIELD_REALS) print_reals(f, base, out);
    if (f->kind == FIELD_INTS || f->kind == FIELD_INT_LIST)
        for (int i = 0; i < n; i++) text_add(out, "%s%d", i > 0 ? ", " : "", list[i]);
    text_add(out, "]");
}

/* uncertain.c - see uncertain.h. */
#include "study/uncertain.h"

#include <math.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

/* Medians of the ranges that machines/ *.yaml print: 18 of class P, 14 PR, 31 D, 191 E. */
double uncertain_class_factor(const char *evidence)
{
    static const struct {
        const char *word;
        double factor;
    } class[] = {{"P", 1.15}, {"PR", 1.4}, {"D", 1.6}, {"E", 1.7}};
    double factor = 0;
    /* "P/PR": of mixed evidence the weaker part decides */
    for (const char *s = evidence; *s != '\0';) {
        const size_t n = strcspn(s, "/");
        for (size_t i = 0; i < sizeof class / sizeof *class; i++)
            if (strlen(class[i].word) == n && strncmp(class[i].word, s, n) == 0)
                factor = fmax(factor, class[i].factor);
        s += n + (s[n] == '/');
    }
    return factor;
}

static bool is_number(const struct field *f)
{
    return f->kind == FIELD_REAL || f->kind == FIELD_INT || f->kind == FIELD_INT64;
}

double uncertain_number(const struct uncertain *u, const struct machine_spec *m)
{
    const char *at = (const char *)m + u->field->offset;
    int whole;
    int64_t large;
    double real;
    switch (u->field->kind) {
    case FIELD_REAL:
        return memcpy(&real, at, sizeof real), real;
    case FIELD_INT64:
        return memcpy(&large, at, sizeof large), (double)large;
    default:
        return memcpy(&whole, at, sizeof whole), whole;
    }
}

void uncertain_apply(const struct uncertain *u, double value, struct machine_spec *m)
{
    char *at = (char *)m + u->field->offset;
    const int64_t large = (int64_t)value;
    const int whole = (int)value;
    switch (u->field->kind) {
    case FIELD_REAL:
        memcpy(at, &value, sizeof value);
        return;
    case FIELD_INT64:
        memcpy(at, &large, sizeof large);
        return;
    default:
        CHECK(u->field->kind == FIELD_INT);
        memcpy(at, &whole, sizeof whole);
    }
}

/* The range of a value for which the file prints none. */
static bool class_range(struct uncertain *u, const struct machine_spec *at)
{
    const double factor = uncertain_class_factor(u->evidence), value = uncertain_number(u, at);
    /* a clock and a count are what they are */
    if (u->field->kind != FIELD_REAL || u->field->unit == UNIT_FREQUENCY) return false;
    if (factor == 0 || !(value > 0)) return false;
    u->low = fmax(value / factor, u->field->min);
    u->high = fmin(value * factor, u->field->max);
    return u->low < u->high;
}

int uncertain_list(const struct origin *o, int n, const struct machine_spec *at,
                   enum uncertain_ranges which, struct arena *a, struct uncertain **list)
{
    int found = 0;
    *list = TAKE(a, n + 1, struct uncertain);
    for (int i = 0; i < n; i++) {
        struct text full = {0};
        text_add(&full, "machine.%s", o[i].key);
        const struct field_table *table;
        const struct field *f = field_find_full(full.s, &table);
        text_free(&full);
        /* published figures that no run uses are in the list of origins, too */
        if (f == NULL || !is_number(f)) continue;
        /* what cannot act is certain enough */
        if (f->dormant != NULL && f->dormant(at)) continue;
        struct uncertain u = {o[i].key, f, o[i].min, o[i].max, o[i].evidence, true};
        const bool printed = u.high > u.low && u.low >= 0;
        if (!printed) u.printed = false;
        if (printed || (which == UNCERTAIN_ALL && class_range(&u, at))) (*list)[found++] = u;
    }
    return found;
}

double uncertain_value(const struct uncertain *u, double x)
{
    const double value = u->low > 0 ? u->low * exp(x * log(u->high / u->low)) : x * u->high;
    return u->field->kind == FIELD_REAL ? value : round(value);
}

/* how_sure.c - see how_sure.h.
 *
 * No number without its error: what is not known is said to be, so that nobody takes silence for
 * certainty. */
#include "report/how_sure.h"

#include <stdlib.h>

/* Runs, level error and how many know it, the machine's low and high and how many, the arithmetic's
 * and how many. */
static bool take(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct how_sure *h = context;
    double x[8];
    (void)ncolumn, (void)name;
    for (int i = 0; i < 8; i++) x[i] = value[i] != NULL ? strtod(value[i], NULL) : 0;
    *h = (struct how_sure){.runs = (int)x[0],
                           .level_error = x[1],
                           .level = (int)x[2],
                           .machine_low = x[3],
                           .machine_high = x[4],
                           .machine = (int)x[5],
                           .arithmetic_error = x[6],
                           .arithmetic = (int)x[7]};
    return false;
}

/* Older databases have no such view, and readers add none. */
static bool found(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn, (void)name, (void)value;
    *(bool *)context = true;
    return false;
}

bool how_sure_read(struct store *s, const char *run_ids, struct how_sure *out, struct err *e)
{
    bool there = false;
    static const char view[] =
        "SELECT 1 FROM sqlite_schema WHERE type = 'view' AND name = 'v_known_error'";
    *out = (struct how_sure){0};
    if (!store_select(s, view, 0, NULL, found, &there, e)) return false;
    const char *const bound[] = {run_ids};
    return !there ||
           store_select(s,
                        "SELECT count(*), max(level_error), count(level_error), min(machine_low), "
                        "max(machine_high), count(machine_low), max(arithmetic_error), "
                        "count(arithmetic_error) FROM v_known_error WHERE ?1 IS NULL OR run_id IN "
                        "(SELECT value FROM json_each(?1))",
                        1, bound, take, out, e);
}

/* Of some of several runs: which part knows it. */
static void add_part(struct text *t, int known, int all)
{
    if (known > 0 && known < all) text_add(t, " (%d of %d runs)", known, all);
}

/* Each of the three says what would tell it. */
void how_sure_sentence(const struct how_sure *h, struct text *out)
{
    if (h->runs == 0) return;
    text_add(out, "How sure: the network level is ");
    if (h->level > 0) text_add(out, "within %.2g %%", 100 * h->level_error);
    else text_add(out, "not known to be right (mimdsim accuracy measures it)");
    add_part(out, h->level, h->runs);
    text_add(out, "; what the parameters of the machine leave open is ");
    if (h->machine > 0)
        text_add(out, "%+.0f to %+.0f %%", 100 * h->machine_low, 100 * h->machine_high);
    else text_add(out, "not known (mimdsim run --uncertainty 64 tells)");
    add_part(out, h->machine, h->runs);
    text_add(out, "; the arithmetic is ");
    if (h->arithmetic > 0) text_add(out, "within %.1g", h->arithmetic_error);
    else text_add(out, "not checked");
    add_part(out, h->arithmetic, h->runs);
    text_add(out, ".");
}

/* The least that holds of both. */
static double least(double a, int na, double b, int nb)
{
    if (na == 0 || nb == 0) return na == 0 ? b : a;
    return a < b ? a : b;
}

static double most(double a, int na, double b, int nb)
{
    if (na == 0 || nb == 0) return na == 0 ? b : a;
    return a > b ? a : b;
}

void how_sure_join(struct how_sure *h, const struct how_sure *more)
{
    h->level_error = most(h->level_error, h->level, more->level_error, more->level);
    h->machine_low = least(h->machine_low, h->machine, more->machine_low, more->machine);
    h->machine_high = most(h->machine_high, h->machine, more->machine_high, more->machine);
    h->arithmetic_error =
        most(h->arithmetic_error, h->arithmetic, more->arithmetic_error, more->arithmetic);
    h->runs += more->runs;
    h->level += more->level;
    h->machine += more->machine;
    h->arithmetic += more->arithmetic;
}

/* One error of the line below a figure. */
static void add_short(struct text *t, const char *what, const char *value, int known, int all)
{
    text_add(t, "%s%s ", what[0] == 'l' ? "error of " : ", ", what);
    text_add(t, "%s", known == 0 ? "not known" : value);
    add_part(t, known, all);
}

void how_sure_short(const struct how_sure *h, struct text *out)
{
    char text[64];
    /* runs without a predicted time have no error of it */
    if (h->runs == 0) return;
    snprintf(text, sizeof text, "<= %.2g %%", 100 * h->level_error);
    add_short(out, "level", text, h->level, h->runs);
    snprintf(text, sizeof text, "%+.0f..%+.0f %%", 100 * h->machine_low, 100 * h->machine_high);
    add_short(out, "machine", text, h->machine, h->runs);
    snprintf(text, sizeof text, "<= %.1g", h->arithmetic_error);
    add_short(out, "arithmetic", text, h->arithmetic, h->runs);
}

/* explain_space.c - the table of what may change, and points of that space as settings, runs and
 * words; see explain_space.h.
 *
 * Axes are logarithmic: a rate ten times as large is as far from nominal as one ten times as
 * small. A parameter that the paper states is no axis. */
#include "app/explain_space.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/units.h"
#include "plan/plan.h"
#include "spec/identity.h"

/* One row a parameter. `reach` is the largest u either way: a factor of ten, others' traffic up to
 * 90 %, computations longer by up to 100 % at random. The paper says nothing of any of them; its
 * machines were shared with others. */
static const struct explain_axis table[] = {
    /* computing: the paper gives no rate of its code */
    {.words = "the code runs at", .map = EXPLAIN_FACTOR, .nkey = 1, .key = {"node.flop_rate"},
     .most = 2.3026},
    {.words = "the serial code runs at",
     .map = EXPLAIN_RELATIVE,
     .nkey = 1,
     .key = {"node.serial_rate"},
     .most = 2.3026},
    {.words = "calling a small operator takes", .map = EXPLAIN_FACTOR, .nkey = 1,
     .key = {"node.call"}, .most = 2.3026},
    {.words = "the program copies at",
     .map = EXPLAIN_FACTOR,
     .nkey = 1,
     .key = {"node.copy.bandwidth"},
     .most = 2.3026},
    /* message software: the keys of one library move together */
    {.words = "sending a message takes",
     .after = ", receiving one and the gap in proportion",
     .map = EXPLAIN_FACTOR,
     .nkey = 3,
     .key = {"software.send.overhead", "software.recv.overhead", "software.gap"},
     .most = 2.3026},
    {.words = "message software takes",
     .after = " at each end",
     .map = EXPLAIN_FACTOR,
     .nkey = 2,
     .key = {"software.send.copy", "software.recv.copy"},
     .most = 2.3026},
    /* the network itself */
    {.words = "entry to and exit from the network take",
     .map = EXPLAIN_FACTOR,
     .nkey = 1,
     .key = {"network.end_latency"},
     .most = 2.3026},
    {.words = "links carry", .map = EXPLAIN_FACTOR, .nkey = 1, .key = {"network.link.bandwidth"},
     .most = 2.3026},
    /* other users of the machine */
    {.words = "others' traffic takes",
     .after = " of every link",
     .map = EXPLAIN_SHARE,
     .nkey = 1,
     .key = {"noise.background.load"},
     .most = 2.3026,
     .dear = true},
    {.words = "other users vary each computation by",
     .map = EXPLAIN_SPREAD,
     .nkey = 1,
     .key = {"noise.compute"},
     .most = 0.6931},
};

/* --- the axes of a machine -------------------------------------------------------------------- */

/* The value's origin in the machine file; NULL: a default. */
static const struct origin *origin_of(const struct origin *o, int n, const char *key)
{
    for (int i = 0; i < n; i++)
        if (strcmp(o[i].key, key) == 0) return &o[i];
    return NULL;
}

/* Every key of the table is a number: another kind would be a mistake of ours. */
static const struct field *machine_field(const char *key)
{
    const struct field_table *t;
    struct text full = {0};
    text_add(&full, "machine.%s", key);
    const struct field *f = field_find_full(full.s, &t);
    text_free(&full);
    CHECK(f && f->kind == FIELD_REAL);
    return f;
}

/* The range widened by what another message library of the same machine is published with: both
 * are ranges of what the paper may have used. */
static void widen(double *low, double *high, const struct origin *other)
{
    if (!other || other->max <= other->min) return;
    if (*high <= *low) *low = other->min, *high = other->max;
    *low = fmin(*low, other->min), *high = fmax(*high, other->max);
}

static bool is_software(const char *key) { return strncmp(key, "software.", 9) == 0; }

/* One row of the table for this machine; false when it has no number to change: a factor of 0 is
 * 0, and a share can only be added where there is none. */
static bool fill_axis(struct explain_axis *x, const struct machine_spec *m, const struct origin *o,
                      int n, const struct origin *mpich, int nmpich)
{
    if (!x->after) x->after = ""; /* most axes end with their number */
    x->least = x->map == EXPLAIN_FACTOR || x->map == EXPLAIN_RELATIVE ? -x->most : 0;
    for (int k = 0; k < x->nkey; k++) {
        x->field[k] = machine_field(x->key[k]);
        memcpy(&x->nominal[k], (const char *)m + x->field[k]->offset, sizeof(double));
        /* The serial rate has no range of its own: it is the same processor. */
        const char *ranged = x->map == EXPLAIN_RELATIVE ? "node.flop_rate" : x->key[k];
        widen(&x->low[k], &x->high[k], origin_of(o, n, ranged));
        if (is_software(ranged)) widen(&x->low[k], &x->high[k], origin_of(mpich, nmpich, ranged));
    }
    return x->map == EXPLAIN_FACTOR ? x->nominal[0] > 0 : x->nominal[0] == 0;
}

/* The axes of a machine. Its variant with MPICH is optional. */
bool explain_space_make(struct explain_space *s, const char *name, struct arena *a, struct err *e)
{
    struct machine_spec m, library;
    struct origin *origin, *mpich = NULL;
    int n, nmpich = 0;
    struct plan_options none = {0};
    struct err ignored;
    struct text other = {0};
    *s = (struct explain_space){.machine = arena_text(a, name)};
    if (!plan_machine(&m, name, &none, a, &origin, &n, e)) return false;
    text_add(&other, "%s-mpich", name);
    err_clear(&ignored);
    if (!plan_machine(&library, other.s, &none, a, &mpich, &nmpich, &ignored)) nmpich = 0;
    text_free(&other);
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        /* An axis that this machine lacks is overwritten by the next one. */
        s->axis[s->n] = table[i];
        if (fill_axis(&s->axis[s->n], &m, origin, n, mpich, nmpich)) s->n++;
    }
    return true;
}

/* --- numbers ---------------------------------------------------------------------------------- */

/* x > 0 with three significant digits: the double that its decimal text reads back to, as 10^k is
 * exact up to k = 22. */
static double three_digits(double x)
{
    static const double ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                 1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    /* two digits behind the first */
    int k = 2 - (int)floor(log10(x));
    if (abs(k) > 22) return x; /* no parameter is as large or as small */
    return k >= 0 ? round(x * ten[k]) / ten[k] : round(x / ten[-k]) * ten[-k];
}

/* Values are rounded as they are printed, three digits or whole per cent: a point that is typed
 * in again is the same point. */
double explain_space_value(const struct explain_space *s, const double *u, int i, int k)
{
    const struct explain_axis *x = &s->axis[i];
    /* Unchanged is unchanged to the last bit, not rounded. */
    if (u[i] == 0) return x->nominal[k];
    switch (x->map) {
    case EXPLAIN_FACTOR:
        return three_digits(x->nominal[k] * exp(u[i]));
    case EXPLAIN_RELATIVE:
        return three_digits(explain_space_value(s, u, 0, 0) * exp(u[i]));
    case EXPLAIN_SHARE:
        return round(100 * (1 - exp(-u[i]))) / 100;
    default:
        return round(100 * (exp(u[i]) - 1)) / 100;
    }
}

/* The change that a value is: the inverse of explain_space_value. */
static double change_of(const struct explain_space *s, const double *u, int i, double value)
{
    const struct explain_axis *x = &s->axis[i];
    switch (x->map) {
    case EXPLAIN_FACTOR:
        return log(value / x->nominal[0]);
    case EXPLAIN_RELATIVE:
        return log(value / explain_space_value(s, u, 0, 0));
    case EXPLAIN_SHARE:
        return -log(1 - value);
    default:
        return log(1 + value);
    }
}

/* A point is what its text says: changes are rounded to the values that are printed. */
void explain_space_snap(const struct explain_space *s, double *u)
{
    for (int i = 0; i < s->n; i++) {
        const struct explain_axis *x = &s->axis[i];
        u[i] = fmin(fmax(u[i], x->least), x->most);
        /* A change of less than the last digit is none. */
        if (fabs(u[i]) < 0.005) u[i] = 0;
        else u[i] = change_of(s, u, i, explain_space_value(s, u, i, 0));
        if (fabs(u[i]) < 0.003) u[i] = 0;
    }
}

/* L1 norm: many small changes are as far as one large one. */
double explain_space_distance(const struct explain_space *s, const double *u)
{
    double sum = 0;
    for (int i = 0; i < s->n; i++) sum += fabs(u[i]);
    return sum;
}

/* --- settings, runs, words -------------------------------------------------------------------- */

/* What a user would type to simulate this point. */
void explain_space_settings(const struct explain_space *s, const double *u, struct text *out)
{
    char number[64];
    for (int i = 0; i < s->n; i++)
        for (int k = 0; u[i] != 0 && k < s->axis[i].nkey; k++) {
            units_print(explain_space_value(s, u, i, k), s->axis[i].field[k]->unit, number,
                        sizeof number);
            text_add(out, "%smachine.%s=%s", out->length ? ", " : "", s->axis[i].key[k], number);
        }
}

/* Settings are written into the struct; then the run has another identity. */
void explain_space_apply(const struct explain_space *s, const double *u, struct run_spec *run,
                         struct arena *a)
{
    for (int i = 0; i < s->n; i++)
        for (int k = 0; u[i] != 0 && k < s->axis[i].nkey; k++) {
            double value = explain_space_value(s, u, i, k);
            memcpy((char *)&run->machine + s->axis[i].field[k]->offset, &value, sizeof value);
        }
    run_identify(run, a);
}

/* Rounding to three digits may leave a range by a thousandth. */
static bool within(const struct explain_axis *x, int k, double value)
{
    return value >= 0.999 * x->low[k] && value <= 1.001 * x->high[k];
}

/* All keys of an axis must be within their ranges. */
static bool axis_published(const struct explain_space *s, const double *u, int i)
{
    const struct explain_axis *x = &s->axis[i];
    for (int k = 0; k < x->nkey; k++)
        if (x->high[k] <= x->low[k] || !within(x, k, explain_space_value(s, u, i, k))) return false;
    return true;
}

bool explain_space_published(const struct explain_space *s, const double *u)
{
    for (int i = 0; i < s->n; i++)
        if (u[i] != 0 && !axis_published(s, u, i)) return false;
    return true;
}

/* "the code runs at 20 Mflop/s (2.8 times below nominal, outside the published range ...)" */
void explain_space_phrase(const struct explain_space *s, const double *u, int i, bool brief,
                          struct text *out)
{
    const struct explain_axis *x = &s->axis[i];
    char number[64], low[64], high[64];
    enum unit unit = x->field[0]->unit;
    units_print(explain_space_value(s, u, i, 0), unit, number, sizeof number);
    text_add(out, "%s %s%s", x->words, number, x->after);
    if (brief) return;
    text_add(out, " (");
    /* Nominal is none: there is no factor to tell. */
    if (x->map == EXPLAIN_SHARE || x->map == EXPLAIN_SPREAD) {
        text_add(out, "nominal none, no published range)");
        return;
    }
    text_add(out, "%.3g times %s %s", exp(fabs(u[i])), u[i] < 0 ? "below" : "above",
             x->map == EXPLAIN_RELATIVE ? "the parallel program's rate" : "nominal");
    units_print(x->low[0], unit, low, sizeof low);
    units_print(x->high[0], unit, high, sizeof high);
    if (x->high[0] <= x->low[0]) text_add(out, ", no published range)");
    else
        text_add(out, ", %s the published range of %s to %s)",
                 axis_published(s, u, i) ? "within" : "outside", low, high);
}

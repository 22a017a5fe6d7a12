/* sample_file.c - see sample_file.h.
 *
 * The points are made here, as texts of settings, so that everything behind sees a sweep like any
 * other: each point is a run with its own identity, stored, resumed and counted as such. */
#include "plan/sample_file.h"

#include <stdlib.h>
#include <string.h>

#include "base/design.h"
#include "base/text.h"

enum { MOST_VALUES = 1000000 }; /* a few lines must not ask for any amount of memory */

/* A key that is drawn: between two values, or one of a list. */
struct drawn {
    bool listed;
    struct range range;
    const char *key; /* in full */
    int line, nvalue;
    const char **value; /* (nvalue) of a list */
};

struct sample {
    const char *file;
    struct arena *arena;
    struct err *err;
    int points;
    enum design method;
    int64_t seed;
    int n;
    struct drawn *key; /* (n) */
};

/* The value and what was expected, at its line. */
static bool refuse(struct sample *s, const struct node *n, const char *expected)
{
    return err_set_at(s->err, ERR_DATA, s->file, n->line, "sample: %s: '%.80s': %s", n->key,
                      n->text != NULL ? n->text : "a list or mapping", expected);
}

/* By the checks of a field, for the same messages as everywhere. */
static bool read_whole(struct sample *s, const struct node *n, double least, double most,
                       int *value)
{
    const struct field f = {.key = n->key, .kind = FIELD_INT, .min = least, .max = most};
    char why[256] = "expected a whole number";
    if (n->text != NULL && field_set(&f, value, n->text, NULL, why, (int)sizeof why)) return true;
    return refuse(s, n, why);
}

/* Names of designs are few: the nearest is told. */
static bool read_method(struct sample *s, const struct node *n)
{
    const char *names[DESIGNS];
    for (int i = 0; i < DESIGNS; i++) {
        names[i] = design_name((enum design)i);
        if (n->text != NULL && strcmp(n->text, names[i]) == 0)
            return s->method = (enum design)i, true;
    }
    const char *near = n->text != NULL ? text_nearest(n->text, names, DESIGNS) : NULL;
    if (near == NULL) return refuse(s, n, "expected sobol, latin-hypercube, halton or random");
    return err_set_at(s->err, ERR_DATA, s->file, n->line,
                      "sample: method: '%.40s': did you mean '%s'?", n->text, near);
}

/* A list of values: each is checked as a setting when its point is made. */
static bool read_list(struct sample *s, struct drawn *d, const struct node *n)
{
    d->listed = true;
    d->value = TAKE(s->arena, n->count + 1, const char *);
    for (const struct node *c = n->child; c != NULL; c = c->next)
        if ((d->value[d->nvalue++] = setting_value(d->key, c, s->file, s->arena, s->err)) == NULL)
            return false;
    return n->count > 0 || refuse(s, n, "expected at least one value");
}

/* Lists and ranges side by side; the order of the file is the order of the dimensions. */
static bool read_keys(struct sample *s, const struct node *n)
{
    if (n->kind != NODE_MAP || n->count == 0 || n->count > SAMPLE_MAX_KEYS)
        return refuse(s, n,
                      "expected 1 to 40 keys with lists or ranges, such as {n: {from: 8, to: 64}}");
    /* in the order of the file */
    s->key = TAKE(s->arena, n->count, struct drawn);
    for (const struct node *c = n->child; c != NULL; c = c->next) {
        const char *full = setting_key(c->key);
        struct drawn *d = &s->key[s->n++];
        *d = (struct drawn){.key = arena_text(s->arena, full), .line = c->line};
        if (!setting_is_key(full)) return setting_unknown("", c->key, s->file, c->line, s->err);
        const bool read = c->kind == NODE_LIST
                              ? read_list(s, d, c)
                              : range_read(&d->range, d->key, c, s->file, s->arena, s->err);
        if (!read) return false;
    }
    return true;
}

/* One key of the mapping, or the nearest that there is. */
static bool read_entry(struct sample *s, const struct node *n)
{
    static const char *const known[] = {"points", "method", "seed", "of"};
    int seed;
    if (strcmp(n->key, "points") == 0) return read_whole(s, n, 1, SCENARIO_MAX_POINTS, &s->points);
    if (strcmp(n->key, "method") == 0) return read_method(s, n);
    if (strcmp(n->key, "of") == 0) return read_keys(s, n);
    if (strcmp(n->key, "seed") == 0)
        return read_whole(s, n, 0, 1e9, &seed) && (s->seed = seed, true);
    return err_set_at(s->err, ERR_DATA, s->file, n->line, "sample: unknown key '%.80s'%s", n->key,
                      text_hint(n->key, known, 4, "; expected points, method, seed, of").s);
}

/* The settings of all points. A list of m values is drawn from by cutting [0, 1) into m parts. */
static bool make_points(struct sample *s, struct axis *x)
{
    /* one dimension of the design for each key */
    double *u = TAKE(s->arena, size_product(s->points, s->n), double);
    design_fill(s->method, (uint64_t)s->seed, s->points, s->n, u);
    x->npoint = s->points;
    x->point = TAKE(s->arena, s->points, struct setting_list);
    for (int i = 0; i < s->points; i++)
        for (int k = 0; k < s->n; k++) {
            const struct drawn *d = &s->key[k];
            /* where this key lies in the cube */
            const double at = u[(size_t)i * (size_t)s->n + (size_t)k];
            const char *text =
                d->listed ? d->value[(int)(at * d->nvalue)] : range_text(&d->range, at, s->arena);
            if (!setting_list_add(&x->point[i], d->key, text, s->file, d->line, s->arena, s->err))
                return false;
        }
    return true;
}

/* What is missing or too much is told before any point is made. */
bool sample_file_read(struct axis *x, const struct node *n, const char *file, struct arena *a,
                      struct err *e)
{
    /* points and keys have no default: both are asked for below */
    struct sample s = {.file = file, .arena = a, .err = e};
    *x = (struct axis){.key = "sample", .line = n->line};
    if (n->kind != NODE_MAP)
        return err_set_at(e, ERR_DATA, file, n->line,
                          "sample: expected {points: 64, of: {KEY: {from: A, to: B}}}");
    for (const struct node *c = n->child; c != NULL; c = c->next)
        if (!read_entry(&s, c)) return false;
    if (s.points == 0 || s.n == 0)
        return err_set_at(e, ERR_DATA, file, n->line, "sample: %s is missing",
                          s.points == 0 ? "points" : "of");
    if ((int64_t)s.points * s.n > MOST_VALUES)
        return err_set_at(e, ERR_DATA, file, n->line,
                          "sample: %d points of %d keys are more than %d values", s.points, s.n,
                          MOST_VALUES);
    if (s.n > design_dimensions(s.method))
        return err_set_at(e, ERR_DATA, file, n->line, "sample: %s has at most %d keys, here are %d",
                          design_name(s.method), design_dimensions(s.method), s.n);
    return make_points(&s, x);
}

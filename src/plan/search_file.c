/* search_file.c - see search_file.h.
 *
 * A range takes part in the plan at its middle, so that the plan is complete without the search:
 * `explain` and `plan` show runs that will be made. */
#include "plan/search_file.h"

#include <string.h>

#include "base/text.h"

struct reading {
    struct scenario *scenario;
    struct plan_search *search;
    search_axis_fn *add_axis; /* the scenario's own way */
    struct arena *arena;
    struct err *err;
};

/* The value and what was expected, at its line. */
static bool refuse(struct reading *r, const struct node *n, const char *expected)
{
    return err_set_at(r->err, ERR_DATA, r->scenario->path, n->line, "optimise: %s: '%.80s': %s",
                      n->key, n->text != NULL ? n->text : "a list or mapping", expected);
}

/* A goal or a limit: names of results are known to those who have results. */
static const struct expression *read_formula(struct reading *r, const struct node *n)
{
    char why[256] = "expected a formula such as makespan";
    const struct expression *x = NULL;
    if (n->text != NULL) x = expression_read(n->text, r->arena, why, (int)sizeof why);
    if (x == NULL) refuse(r, n, why);
    return x;
}

/* Least or greatest: two goals would need weights, which a formula can give. */
static bool read_goal(struct reading *r, const struct node *n)
{
    struct plan_search *s = r->search;
    if (s->goal != NULL) return refuse(r, n, "a search has one goal: least or greatest");
    s->greatest = strcmp(n->key, "greatest") == 0;
    s->goal = read_formula(r, n);
    return s->goal != NULL;
}

/* A simplex needs a few points before it can turn. */
static bool read_runs(struct reading *r, const struct node *n)
{
    static const struct field count = {.key = "runs", .kind = FIELD_INT, .min = 4, .max = 10000};
    char why[256] = "expected a whole number";
    if (n->text != NULL && field_set(&count, &r->search->most, n->text, NULL, why, (int)sizeof why))
        return true;
    return refuse(r, n, why);
}

/* A list is an axis; a range is a value, its middle, and a range. */
static bool read_key(struct reading *r, const struct node *n)
{
    struct plan_search *s = r->search;
    if (n->kind == NODE_LIST) {
        if (!r->add_axis(r->scenario, n->key, n, r->arena, r->err)) return false;
        r->scenario->axis[r->scenario->naxis - 1].searched = true;
        return true;
    }
    if (s->nrange == PLAN_MOST_RANGES) return refuse(r, n, "too many ranges; expected at most 8");
    const char *full = setting_key(n->key);
    if (!setting_is_key(full))
        return setting_unknown("", n->key, r->scenario->path, n->line, r->err);
    struct range *x = &s->range[s->nrange];
    if (!range_read(x, n->key, n, r->scenario->path, r->arena, r->err)) return false;
    s->nrange++;
    return setting_list_add(&r->scenario->base, x->key, range_text(x, 0.5, r->arena),
                            r->scenario->path, n->line, r->arena, r->err);
}

/* Every key is an axis of its own or a range. */
static bool read_over(struct reading *r, const struct node *n)
{
    if (n->kind != NODE_MAP || n->count == 0)
        return refuse(r, n,
                      "expected keys with lists or ranges, such as {kernel.solver: [cr, pcr]}");
    for (const struct node *c = n->child; c != NULL; c = c->next)
        if (!read_key(r, c)) return false;
    return true;
}

/* One key of the mapping, or the nearest that there is. */
static bool read_entry(struct reading *r, const struct node *n)
{
    static const char *const known[] = {"least", "greatest", "within", "over", "runs"};
    if (strcmp(n->key, "least") == 0 || strcmp(n->key, "greatest") == 0) return read_goal(r, n);
    if (strcmp(n->key, "within") == 0) return (r->search->within = read_formula(r, n)) != NULL;
    if (strcmp(n->key, "over") == 0) return read_over(r, n);
    if (strcmp(n->key, "runs") == 0) return read_runs(r, n);
    static const char all[] = "; expected least, greatest, within, over, runs";
    return err_set_at(r->err, ERR_DATA, r->scenario->path, n->line,
                      "optimise: unknown key '%.80s'%s", n->key,
                      text_hint(n->key, known, 5, all).s);
}

/* A search without a goal or without anything to change is none. */
bool search_file_read(struct scenario *s, const struct node *n, search_axis_fn *add_axis,
                      struct arena *a, struct err *e)
{
    struct reading r = {s, TAKE(a, 1, struct plan_search), add_axis, a, e};
    *r.search = (struct plan_search){.most = 100, .file = s->path, .line = n->line};
    if (n->kind != NODE_MAP)
        return err_set_at(e, ERR_DATA, s->path, n->line,
                          "optimise: expected {least: makespan, over: {KEY: [A, B]}}");
    s->search = r.search;
    for (const struct node *c = n->child; c != NULL; c = c->next)
        if (!read_entry(&r, c)) return false;
    if (r.search->goal == NULL)
        return err_set_at(e, ERR_DATA, s->path, n->line,
                          "optimise: the goal is missing, such as 'least: makespan'");
    /* Something must be left to choose from. */
    bool searched = r.search->nrange > 0;
    for (int i = 0; i < s->naxis; i++) searched = searched || s->axis[i].searched;
    return searched || err_set_at(e, ERR_DATA, s->path, n->line,
                                  "optimise: 'over' is missing: the settings that may change");
}

/* The order of the others stays. */
void search_file_drop(struct scenario *s, const char *key)
{
    struct plan_search *x = s->search;
    for (int i = 0; x != NULL && i < x->nrange; i++) {
        if (strcmp(x->range[i].key, key) != 0) continue;
        memmove(&x->range[i], &x->range[i + 1], (size_t)(--x->nrange - i) * sizeof *x->range);
        return;
    }
}

/* A key that is swept has its values already. */
bool search_file_check(const struct scenario *s, struct err *e)
{
    for (int k = 0; s->search != NULL && k < s->search->nrange; k++)
        for (int i = 0; i < s->naxis; i++)
            for (int j = 0; j < s->axis[i].point[0].n; j++)
                if (strcmp(s->axis[i].point[0].at[j].key, s->search->range[k].key) == 0)
                    return err_set_at(e, ERR_DATA, s->path, s->axis[i].line,
                                      "'%s' is swept here and searched in line %d",
                                      s->search->range[k].key, s->search->range[k].line);
    return true;
}

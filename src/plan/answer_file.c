/* answer_file.c - see answer_file.h. */
#include "plan/answer_file.h"

#include <string.h>

#include "base/text.h"
#include "base/units.h"

/* What is being read, and where a mistake goes. */
struct reading {
    struct scenario *scenario;
    struct plan_answer *answer;
    struct arena *arena;
    struct err *err;
};

/* The value and what was expected, at its line. */
static bool refuse(struct reading *r, const struct node *n, const char *expected)
{
    return err_set_at(r->err, ERR_DATA, r->scenario->path, n->line, "answer: %s: '%.80s': %s",
                      n->key, n->text != NULL ? n->text : "a list or mapping", expected);
}

/* A goal: names of results are known to those who have results. */
static bool read_goal(struct reading *r, const struct node *n)
{
    /* Two goals would need weights, which a formula can give. */
    char why[256] = "expected a formula such as makespan";
    if (r->answer->goal != NULL) return refuse(r, n, "one goal: least or greatest");
    if (n->text != NULL) r->answer->goal = expression_read(n->text, r->arena, why, (int)sizeof why);
    r->answer->greatest = strcmp(n->key, "greatest") == 0;
    return r->answer->goal != NULL || refuse(r, n, why);
}

/* Above nothing: equal would be equal to the last bit. */
static bool read_within(struct reading *r, const struct node *n)
{
    /* As every share in files: with its sign. */
    char why[256] = "expected a share such as 10 %";
    double share = 0;
    if (n->text != NULL && units_parse(n->text, UNIT_PERCENT, &share, why, (int)sizeof why) &&
        share > 0 && share <= 10) {
        r->answer->within = share;
        return true;
    }
    return refuse(r, n, share != 0 ? "expected above 0 % and at most 1000 %" : why);
}

/* A key of the sweep; whether it is one is asked when all of the file is known. */
static bool read_key(struct reading *r, const struct node *n, const char **key, const char **word)
{
    if (n->text == NULL) return refuse(r, n, "expected a key of the sweep, or 'variant'");
    *word = n->text;
    *key = strcmp(n->text, "variant") == 0 ? "variant" : setting_key(n->text);
    return true;
}

/* One key of the mapping, or the nearest that there is. */
static bool read_entry(struct reading *r, const struct node *n)
{
    static const char *const known[] = {"of",      "over",   "least", "greatest",
                                        "against", "within", "called"};
    enum { KNOWN = sizeof known / sizeof *known };
    if (strcmp(n->key, "of") == 0) return read_key(r, n, &r->answer->of, &r->answer->of_word);
    if (strcmp(n->key, "over") == 0) return read_key(r, n, &r->answer->over, &r->answer->over_word);
    if (strcmp(n->key, "least") == 0 || strcmp(n->key, "greatest") == 0) return read_goal(r, n);
    if (strcmp(n->key, "within") == 0) return read_within(r, n);
    if (strcmp(n->key, "called") == 0) {
        r->answer->called = n->text;
        return (n->text != NULL && n->text[0] != '\0') || refuse(r, n, "expected a text");
    }
    if (strcmp(n->key, "against") == 0) {
        r->answer->against = n->text;
        /* Whether some run has it is known when all runs are. */
        return n->text != NULL || refuse(r, n, "expected one value of 'of'");
    }
    /* A key that is none of these: the nearest, or all that there are. */
    static const char all[] = "; expected of, over, least, greatest, called, against, within";
    return err_set_at(r->err, ERR_DATA, r->scenario->path, n->line, "answer: unknown key '%.80s'%s",
                      n->key, text_hint(n->key, known, KNOWN, all).s);
}

bool answer_file_read(struct scenario *s, const struct node *n, struct arena *a, struct err *e)
{
    struct reading r = {s, TAKE(a, 1, struct plan_answer), a, e};
    *r.answer = (struct plan_answer){.file = s->path, .line = n->line};
    if (n->kind != NODE_MAP)
        return err_set_at(e, ERR_DATA, s->path, n->line,
                          "answer: expected {of: variant, over: n, least: makespan}");
    /* In the order of the file: the first mistake is told. */
    for (const struct node *c = n->child; c != NULL; c = c->next)
        if (!read_entry(&r, c)) return false;
    /* The scenario has it from here on, also for the checks at the end of the file. */
    s->answer = r.answer;
    /* Each answer is a comparison of something by something. */
    if (r.answer->of == NULL)
        return err_set_at(e, ERR_DATA, s->path, n->line,
                          "answer: 'of' is missing: the key of the sweep that is chosen");
    if (r.answer->goal == NULL)
        return err_set_at(e, ERR_DATA, s->path, n->line,
                          "answer: the goal is missing, such as 'least: makespan'");
    /* A share of what? Of the value that the others are compared with. */
    if (r.answer->within > 0 && r.answer->against == NULL)
        return err_set_at(e, ERR_DATA, s->path, n->line,
                          "answer: 'within' needs 'against': the value of '%s' that is good",
                          r.answer->of);
    return true;
}

/* Whether an axis has that name, or points that set that key. */
static bool is_swept(const struct scenario *s, const char *key)
{
    for (int i = 0; i < s->naxis; i++) {
        if (strcmp(s->axis[i].key, key) == 0) return true;
        /* All points of an axis set the same keys: the first says which. */
        for (int k = 0; k < s->axis[i].point[0].n; k++)
            if (strcmp(s->axis[i].point[0].at[k].key, key) == 0) return true;
    }
    return false;
}

/* --set may have taken an axis away: then there is one value, and nothing to compare. That is told
 * with the answer, not here; a key that the file never sweeps is a mistake in it. */
bool answer_file_check(const struct scenario *s, struct err *e)
{
    const struct plan_answer *x = s->answer;
    if (x == NULL) return true;
    /* The first of both that is none is told. */
    const char *key = !is_swept(s, x->of)                        ? x->of
                      : x->over != NULL && !is_swept(s, x->over) ? x->over
                                                                 : NULL;
    if (key != NULL)
        return err_set_at(e, ERR_DATA, s->path, x->line,
                          "answer: '%.80s' is not swept; expected a key of the sweep, or 'variant'",
                          key);
    return s->search == NULL ||
           err_set_at(e, ERR_DATA, s->path, x->line,
                      "answer and optimise in one scenario: the search answers it");
}

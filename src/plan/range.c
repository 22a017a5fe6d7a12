/* range.c - see range.h.
 *
 * Values are rounded to four digits, so that a point of a sample or a search is what its text says,
 * and typing that text in gives the same run. */
#include "plan/range.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

/* The number of a setting whose field holds one. */
static double number_of(const struct setting *s, struct arena *a)
{
    struct run_spec trial;
    char why[256];
    double number = 0;
    char *base = (char *)&trial + s->table->offset;
    CHECK(field_set(s->field, base, s->text, a, why, (int)sizeof why));
    CHECK(field_number(s->field, base, &number));
    return number;
}

/* Settings of other kinds have values, but no order between them. */
static bool is_number(const struct setting *s)
{
    return s->kind == SETTING_FIELD &&
           (s->field->kind == FIELD_REAL || s->field->kind == FIELD_INT ||
            s->field->kind == FIELD_INT64);
}

/* One end of the range, through the checks of the setting. */
static bool read_end(struct range *r, const struct node *n, double *value, const char *file,
                     struct arena *a, struct err *e)
{
    struct setting s;
    const char *text = setting_value(r->key, n, file, a, e);
    if (text == NULL || !setting_make(&s, r->key, text, file, n->line, a, e)) return false;
    if (!is_number(&s))
        return err_set_at(e, ERR_DATA, file, n->line,
                          "%s: no number, so it has no range; expected a list of values", r->key);
    r->field = s.field;
    r->key = s.key;
    *value = number_of(&s, a);
    return true;
}

/* The logarithm of 0 is no number. */
static bool read_scale(struct range *r, const struct node *n, const char *file, struct err *e)
{
    if (n->text != NULL && strcmp(n->text, "linear") == 0) return r->log = false, true;
    if (n->text != NULL && strcmp(n->text, "log") == 0 && r->low > 0) return r->log = true, true;
    return err_set_at(e, ERR_DATA, file, n->line, "%s: scale: '%.40s': expected linear%s", r->key,
                      n->text != NULL ? n->text : "a list or mapping",
                      r->low > 0 ? " or log" : ", as the range begins at 0");
}

/* Unknown keys first, as a misspelt 'to' would be told as missing otherwise. */
bool range_read(struct range *r, const char *key, const struct node *n, const char *file,
                struct arena *a, struct err *e)
{
    static const char *const known[] = {"from", "to", "scale"};
    *r = (struct range){.key = key, .line = n->line};
    const struct node *from = n->kind == NODE_MAP ? document_find(n, "from") : NULL,
                      *to = n->kind == NODE_MAP ? document_find(n, "to") : NULL;
    if (from == NULL || to == NULL)
        return err_set_at(e, ERR_DATA, file, n->line,
                          "%s: expected a list of values, or a range such as {from: 1, to: 8}",
                          key);
    /* what the mapping may hold */
    for (const struct node *c = n->child; c != NULL; c = c->next)
        if (strcmp(c->key, "from") != 0 && strcmp(c->key, "to") != 0 &&
            strcmp(c->key, "scale") != 0) {
            return err_set_at(e, ERR_DATA, file, c->line, "%s: unknown key '%.80s'%s", key, c->key,
                              text_hint(c->key, known, 3, "; expected from, to, scale").s);
        }
    if (!read_end(r, from, &r->low, file, a, e) || !read_end(r, to, &r->high, file, a, e))
        return false;
    if (!(r->low < r->high))
        return err_set_at(e, ERR_DATA, file, to->line, "%s: 'from' has to be below 'to'", key);
    /* by default even in the logarithm, where there is one */
    r->log = r->low > 0;
    const struct node *scale = document_find(n, "scale");
    return scale == NULL || read_scale(r, scale, file, e);
}

/* Four digits, by way of their text: the double that they read back to. */
static double rounded(double x)
{
    char digits[40];
    double value = x;
    snprintf(digits, sizeof digits, "%.3e", x);
    CHECK(sscanf(digits, "%lf", &value) == 1);
    return value;
}

/* Even in the logarithm: a factor of two is as likely anywhere in the range. Where the ratio or the
 * difference of the ends is no double, by way of numbers that are. */
static double value_at(const struct range *r, double u)
{
    const double ratio = r->high / r->low, width = r->high - r->low;
    if (r->log)
        return isfinite(ratio) ? r->low * exp(u * log(ratio))
                               : exp((1 - u) * log(r->low) + u * log(r->high));
    return isfinite(width) ? r->low + u * width : (1 - u) * r->low + u * r->high;
}

const char *range_text(const struct range *r, double u, struct arena *a)
{
    char text[64];
    double x = value_at(r, u);
    x = r->field->kind == FIELD_REAL ? rounded(x) : round(x);
    /* Rounding must not leave the range. */
    x = fmin(fmax(x, r->low), r->high);
    units_print(x, r->field->unit, text, (int)sizeof text);
    return arena_text(a, text);
}

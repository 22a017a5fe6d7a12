/* answer.c - see answer.h.
 *
 * The runs become a table: a line for each value of `over`, a column for each value of `of`, in the
 * order of the plan; a cell is the goal, the mean of repetitions. Up to three clauses are read off
 * it, as far as the scenario asks for them: which column is best on which lines, how far each is
 * from the column `against`, and up to which column it stays `within` a share of that. */
#include "app/answer.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/outcome.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/units.h"
#include "plan/condition.h"
#include "report/plot.h"
#include "spec/run_label.h"
#include "spec/spec_fields.h"
#include "store/temporary.h"

/* A value of `of` or `over`. */
struct mark {
    const char *text;
    double number; /* NAN: a word */
    enum unit unit;
};

struct cell {
    double sum;
    int n;
    int64_t id; /* the first of its runs */
};

/* The table of the runs. */
struct answer {
    const struct plan *plan;
    const struct plan_answer *asked;
    struct arena *arena;
    int nof, nover, against; /* against: column, -1: none */
    struct mark *of, *over;  /* (nof), (nover) */
    struct cell *cell;       /* (nover x nof) */
    double *best;            /* (nover) without the column `against`; NAN: no results */
    enum unit unit; /* of the goal */
    int missing;    /* runs without a result */
};

/* ---- reading ---- */

/* What the run has for `key`: a name of a variant or machine, or a setting as files write it. */
static struct mark mark_of(const struct run_spec *r, const char *key, struct arena *a)
{
    struct mark m = {.text = "", .number = NAN, .unit = UNIT_NONE};
    struct condition_scope scope = {r, a};
    struct expression_value v;
    struct text t = {0};
    char why[128];
    const struct field_table *table;
    if (key == NULL) return m;
    /* A variant is what its file calls it; without a name it is what was changed. */
    if (strcmp(key, "variant") == 0) {
        if (r->label[0] != '\0') text_add(&t, "%s", r->label);
        else run_label(r, &t);
    } else {
        if (condition_lookup(&scope, key, &v, why, (int)sizeof why) && v.text == NULL)
            m.number = v.number, m.unit = v.unit;
        const struct field *f = field_find_full(key, &table);
        if (f != NULL) field_print(f, (const char *)r + table->offset, &t);
        else text_add(&t, "%.6g", m.number);
    }
    m.text = arena_text(a, t.s != NULL ? t.s : "");
    text_free(&t);
    return m;
}

/* The place of `m` in a list, where it is put at the end if it is new. */
static int place_of(struct mark *list, int *n, struct mark m)
{
    for (int i = 0; i < *n; i++)
        if (strcmp(list[i].text, m.text) == 0) return i;
    list[*n] = m;
    return (*n)++;
}

static struct cell *cell_at(const struct answer *t, int over, int of)
{
    return &t->cell[(size_t)over * (size_t)t->nof + (size_t)of];
}

/* The goal there; NAN: no run ended well. */
static double value_at(const struct answer *t, int over, int of)
{
    const struct cell *c = cell_at(t, over, of);
    return c->n > 0 ? c->sum / c->n : NAN;
}

/* One run into its cell. */
static bool add_run(struct answer *t, const struct run_spec *r, struct store *s, struct err *e)
{
    const struct plan_answer *a = t->asked;
    struct outcome o;
    struct expression_value v;
    struct cell *c = cell_at(t, place_of(t->over, &t->nover, mark_of(r, a->over, t->arena)),
                             place_of(t->of, &t->nof, mark_of(r, a->of, t->arena)));
    if (!outcome_read(s, r, &o, e) ||
        !outcome_value(a->goal, r, &o, "answer", a->file, a->line, &v, e))
        return false;
    /* A run that failed, or a goal that it does not have, is counted and told at the end. */
    if (!o.ok || !isfinite(v.number)) {
        t->missing++;
        return true;
    }
    t->unit = v.unit;
    if (c->n++ == 0) c->id = o.id;
    c->sum += v.number;
    return true;
}

/* The column that the others are held against has to be there. */
static bool find_against(struct answer *t, struct err *e)
{
    const struct plan_answer *a = t->asked;
    const char **name = TAKE(t->arena, t->nof + 1, const char *);
    t->against = -1;
    for (int k = 0; k < t->nof; k++) {
        name[k] = t->of[k].text;
        if (a->against != NULL && strcmp(name[k], a->against) == 0) t->against = k;
    }
    if (a->against == NULL || t->against >= 0) return true;
    /* Misspelt, or left out by a condition or --set: the nearest of those that there are. */
    return err_set_at(e, ERR_DATA, a->file, a->line, "answer: against: no run has '%.80s' for %s%s",
                      a->against, a->of_word, text_hint(a->against, name, t->nof, "").s);
}

/* How many times worse x is than `than`; 1: the same. */
static double worse(const struct answer *t, double x, double than)
{
    return t->asked->greatest ? than / x : x / than;
}

/* The least or greatest value of a line, without the column `against`; NAN: no results. */
static double best_value(const struct answer *t, int over)
{
    double best = NAN;
    for (int k = 0; k < t->nof; k++) {
        const double x = value_at(t, over, k);
        if (isnan(x) || k == t->against) continue;
        if (isnan(best) || worse(t, x, best) < 1) best = x;
    }
    return best;
}

/* As many values as a sentence can be made of: all are compared with each other. */
enum { MOST_VALUES = 4096, MOST_CELLS = 1 << 20 };

/* The values of `of` and `over` in the plan, in its order. Whether they are too many is known as
 * soon as they are, and before any run. */
static bool list_values(const struct plan *p, struct answer *t, struct err *e)
{
    const struct plan_answer *a = p->answer;
    struct mark *of = TAKE(t->arena, MOST_VALUES + 1, struct mark),
                *over = TAKE(t->arena, MOST_VALUES + 1, struct mark);
    for (int i = 0; i < p->nrun; i++) {
        place_of(of, &t->nof, mark_of(&p->run[i], a->of, t->arena));
        place_of(over, &t->nover, mark_of(&p->run[i], a->over, t->arena));
        if (t->nof <= MOST_VALUES && t->nover <= MOST_VALUES && t->nof <= MOST_CELLS / t->nover)
            continue;
        char each[128] = "";
        if (a->over)
            snprintf(each, sizeof each, " for each of %d of '%.80s'", t->nover, a->over_word);
        return err_set_at(e, ERR_CONFIG, a->file, a->line,
                          "answer: %d values of '%.80s'%s, or more, are too many to compare; "
                          "expected at most %d of each, and %d pairs",
                          t->nof, a->of_word, each, MOST_VALUES, MOST_CELLS);
    }
    t->of = of;
    t->over = over;
    return true;
}

/* The runs of the plan as they are stored, each in its cell. */
struct answer *answer_read(const struct plan *p, struct store *s, struct arena *a, struct err *e)
{
    struct answer *t = TAKE(a, 1, struct answer);
    *t = (struct answer){.plan = p, .asked = p->answer, .arena = a};
    if (!list_values(p, t, e)) return NULL;
    t->cell = TAKE(a, size_product(t->nof, t->nover), struct cell);
    for (int i = 0; i < p->nrun; i++)
        if (!add_run(t, &p->run[i], s, e)) return NULL;
    if (!find_against(t, e)) return NULL;
    /* Each line's best is asked for once for each column. */
    t->best = TAKE(a, t->nover, double);
    for (int i = 0; i < t->nover; i++) t->best[i] = best_value(t, i);
    return t;
}

/* ---- clauses ---- */

/* What the goal is called on an axis: as the file says, or the formula. */
static const char *goal_name(const struct plan_answer *a)
{
    return a->called != NULL ? a->called : expression_text(a->goal);
}

/* The same in a sentence, where its unit in brackets has no place. */
static void add_goal(const struct plan_answer *a, struct text *out)
{
    const char *name = goal_name(a), *unit = strstr(name, " [");
    text_add_bytes(out, name, unit != NULL ? (size_t)(unit - name) : strlen(name));
}

/* The last two words of a key say enough: link.bandwidth. */
static const char *last_words(const char *key)
{
    const char *dot = strrchr(key, '.');
    while (dot != NULL && dot > key && dot[-1] != '.') dot--;
    return dot != NULL ? dot : key;
}

/* "kernel.message 8 B to 64 KiB", or nothing where there is one line. */
static void add_range(const struct answer *t, int first, int last, struct text *out)
{
    if (t->asked->over == NULL || t->nover == 0) return;
    /* In the order of the plan, which is that of the file: from the first value to the last. */
    text_add(out, " for %s %s", last_words(t->asked->over_word), t->over[first].text);
    if (last > first) text_add(out, " to %s", t->over[last].text);
}

/* "1.05 times", "1.05 to 1.3 times", "the same" */
static void add_times(double least, double most, struct text *out)
{
    enum { DIGITS = 3 };
    /* Within half of the last digit that would be printed. */
    const bool one = fabs(least - 1) < 0.0005 && fabs(most - 1) < 0.0005;
    if (one) {
        text_add(out, "the same");
        return;
    }
    text_add(out, "%.*g", DIGITS, least);
    if (most > least * 1.005) text_add(out, " to %.*g", DIGITS, most);
    text_add(out, " times");
}

/* Whether column k has the best value of the line, or one that prints alike. */
static bool is_best(const struct answer *t, int over, int k)
{
    const double x = value_at(t, over, k);
    return k != t->against && !isnan(x) && worse(t, x, t->best[over]) < 1 + 1e-6;
}

/* How many lines from `first` on column k is best on. */
static int best_for(const struct answer *t, int first, int k)
{
    int end = first;
    while (end < t->nover && is_best(t, end, k)) end++;
    return end - first;
}

/* Of the columns that are best on line `first` the one that stays so longest; -1: none. */
static int longest_best(const struct answer *t, int first)
{
    int best = -1, most = 0;
    for (int k = 0; k < t->nof; k++)
        if (best_for(t, first, k) > most) {
            best = k;
            most = best_for(t, first, k);
        }
    return best;
}

/* How many times worse the next column is on this line. */
static double next_to(const struct answer *t, int over, int best)
{
    double next = INFINITY;
    for (int k = 0; k < t->nof; k++) {
        const double x = value_at(t, over, k);
        if (k == best || k == t->against || isnan(x)) continue;
        next = fmin(next, worse(t, x, value_at(t, over, best)));
    }
    return next;
}

/* " (the next: 1.1 to 1.4 times)": on lines first .. end - 1. */
static void add_next(const struct answer *t, int first, int end, int best, bool named,
                     struct text *out)
{
    double least = INFINITY, most = 0;
    for (int i = first; i < end; i++) {
        least = fmin(least, next_to(t, i, best));
        most = fmax(most, next_to(t, i, best));
    }
    /* Nobody is next to a column that stands alone. */
    if (!isfinite(most)) return;
    text_add(out, named ? " (the next: " : " (");
    /* of a greatest goal the next one has less */
    if (t->asked->greatest) add_times(1 / most, 1 / least, out);
    else add_times(least, most, out);
    text_add(out, ")");
}

/* "'a' has the least makespan for n 16 to 64 (the next: 1.1 to 1.4 times), 'b' for ..." Lines that
 * follow each other and have one best column are told together. Where the others are held against
 * one column anyway, this is told only if another one is best on some lines than on others. */
static void add_best(const struct answer *t, struct text *out)
{
    int told = 0;
    /* One value, or one and what it is compared with, has nothing to be better than. */
    if (t->nof - (t->against >= 0) < 2) return;
    /* With `against` the ratios to that say it all, unless the order of the others changes: then
     * the place where it does is what one wants to know. */
    const int first = longest_best(t, 0);
    if (t->against >= 0 && (first < 0 || best_for(t, 0, first) == t->nover)) return;
    if (t->against >= 0) text_add(out, "beside '%s', ", t->of[t->against].text);
    for (int i = 0, end; i < t->nover; i = end) {
        const int best = longest_best(t, i);
        end = best < 0 ? i + 1 : i + best_for(t, i, best);
        /* a line without any result says nothing */
        if (best < 0) continue;
        text_add(out, "%s'%s'", told ? ", " : "", t->of[best].text);
        if (told == 0) {
            text_add(out, " has the %s ", t->asked->greatest ? "greatest" : "least");
            add_goal(t->asked, out);
        }
        add_range(t, i, end - 1, out);
        add_next(t, i, end, best, told++ == 0, out);
    }
}

/* "against 'as it is' makespan is 0.52 to 0.99 times with 'a', ..." */
static void add_against(const struct answer *t, struct text *out)
{
    int told = 0;
    for (int k = 0; k < t->nof && t->against >= 0; k++) {
        double least = INFINITY, most = 0;
        for (int i = 0; i < t->nover; i++) {
            /* the goal itself, not how much worse: less is less whatever is wanted */
            const double ratio = value_at(t, i, k) / value_at(t, i, t->against);
            if (!isfinite(ratio)) continue;
            least = fmin(least, ratio);
            most = fmax(most, ratio);
        }
        if (k == t->against || most <= 0) continue;
        text_add(out, "%s", told > 0 ? ", " : out->length > 0 ? "; " : "");
        if (told++ == 0) {
            text_add(out, "against '%s' ", t->of[t->against].text);
            add_goal(t->asked, out);
            text_add(out, " is ");
        }
        add_times(least, most, out);
        text_add(out, " with '%s'", t->of[k].text);
    }
}

/* The last column behind `against` up to which all are good enough on this line. */
static int good_until(const struct answer *t, int over)
{
    int last = t->against;
    /* The order of the file is that of the values: more and more of something. */
    const double than = value_at(t, over, t->against);
    for (int k = t->against + 1; k < t->nof; k++) {
        const double x = value_at(t, over, k);
        if (isnan(x) || worse(t, x, than) > 1 + t->asked->within) break;
        last = k;
    }
    return last;
}

/* "within 5 % of '1': up to '4' for n 64 to 256, '2' for n 512" */
static void add_within(const struct answer *t, struct text *out)
{
    if (t->asked->within <= 0) return;
    text_add(out, "%swithin %.3g %% of '%s': ", out->length > 0 ? "; " : "", 100 * t->asked->within,
             t->of[t->against].text);
    for (int i = 0, end; i < t->nover; i = end) {
        /* Lines that follow each other and have one answer are told together. */
        const int last = good_until(t, i);
        for (end = i + 1; end < t->nover && good_until(t, end) == last; end++) continue;
        text_add(out, "%s%s'%s'", i > 0 ? ", " : "", last > t->against ? "up to " : "only ",
                 t->of[last].text);
        add_range(t, i, end - 1, out);
    }
}

bool answer_check(const struct plan *p, struct err *e)
{
    struct expression_value v;
    const struct plan_answer *a = p->answer;
    if (a == NULL) return true;
    struct answer t = {.asked = a, .arena = arena_create()};
    const bool ok =
        list_values(p, &t, e) &&
        outcome_value(a->goal, &p->run[0], &outcome_unknown, "answer", a->file, a->line, &v, e);
    arena_destroy(t.arena);
    return ok;
}

void answer_sentence(const struct answer *t, struct text *out)
{
    /* The clauses in the order of the questions: which, how much, how far. */
    struct text said = {0};
    add_best(t, &said);
    add_against(t, &said);
    add_within(t, &said);
    text_add(out, "%s", said.length > 0 ? said.s : "one value alone: there is nothing to compare");
    if (t->missing > 0)
        text_add(out, "; %d run%s no result", t->missing, t->missing > 1 ? "s have" : " has");
    text_add(out, ".");
    text_free(&said);
}

/* ---- picture ---- */

/* A column's name: a plain word, and what says its unit (plot_sheet.c), so that the axis is called
 * as in other figures; what is no plain word stands on the axis, beside a column `otherwise`. */
static struct plot_axis_name add_name(const char *word, const char *otherwise, enum unit unit,
                                      struct text *sql)
{
    bool plain = true;
    for (const char *c = word; *c != '\0'; c++) plain = plain && isalnum((unsigned char)*c);
    text_add(sql, "%s%s", plain ? word : otherwise, plain && unit == UNIT_TIME ? "_s" : "");
    /* A product of units that has no name has no unit on an axis either. */
    return (struct plot_axis_name){plain ? NULL : word, unit == UNIT_KINDS ? UNIT_NONE : unit};
}

/* Whether the axis is what is chosen: without `over`, or where that is a number with more values
 * than curves can be told apart by. Then the curves are those of `over`. */
static bool is_along(const struct answer *t)
{
    enum { MOST_CURVES = 6 };
    bool numbers = t->nof > MOST_CURVES;
    /* Words have no place between each other, so that they make no axis with curves. */
    for (int k = 0; k < t->nof; k++) numbers = numbers && isfinite(t->of[k].number);
    return t->asked->over == NULL || numbers;
}

/* A row for each cell: place on the axis, curve, value. */
static bool fill(const struct answer *t, struct store *s, bool *numbers, struct err *e)
{
    const bool along = is_along(t);
    *numbers = true;
    for (int i = 0; i < (along ? t->nof : t->nover); i++)
        *numbers = *numbers && isfinite(along ? t->of[i].number : t->over[i].number);
    bool ok = store_temporary(s, "answer_cell",
                              *numbers ? "run_id INTEGER, x REAL, curve TEXT, value REAL"
                                       : "run_id INTEGER, x TEXT, curve TEXT, value REAL",
                              e);
    for (int i = 0; ok && i < t->nover * t->nof; i++) {
        const int over = i / t->nof, of = i % t->nof;
        const struct mark *m = along ? &t->of[of] : &t->over[over],
                          *curve = along ? &t->over[over] : &t->of[of];
        if (isnan(value_at(t, over, of))) continue;
        /* "n 256": a number alone does not say of what. */
        struct text name = {0};
        const char *word = along ? t->asked->over_word : t->asked->of_word;
        const bool bare = isfinite(curve->number) && curve->unit == UNIT_NONE;
        text_add(&name, "%s%s%s", bare ? last_words(word) : "", bare ? " " : "", curve->text);
        const struct store_value row[] = {store_int(cell_at(t, over, of)->id),
                                          *numbers ? store_real(m->number) : store_text(m->text),
                                          store_text(name.s), store_real(value_at(t, over, of))};
        ok = store_temporary_row(s, "answer_cell", 4, row, e);
        text_free(&name);
    }
    return ok;
}

bool answer_draw(const struct answer *t, struct store *s, const char *dir, struct err *e)
{
    struct text sql = {0}, told = {0};
    bool numbers, ok = fill(t, s, &numbers, e);
    if (ok) {
        const bool along = is_along(t);
        const char *axis = along ? t->asked->of_word : t->asked->over_word;
        const char *curve = t->asked->over == NULL ? ""
                            : along                ? t->asked->over_word
                                                   : t->asked->of_word;
        /* Names of columns are made of letters and digits: no text of a file gets into the query,
         * and what stands in the table is bound. */
        struct plot_request r = {
            .by = *curve ? "curve" : "", .title = t->plan->question, .as = t->plan->name};
        text_add(&sql, "SELECT run_id, x AS \"");
        r.x_name = add_name(last_words(axis), "x",
                            numbers ? (along ? t->of : t->over)->unit : UNIT_NONE, &sql);
        text_add(&sql, "\", value AS \"");
        /* A name with a unit of its own has said it. */
        const char *goal = goal_name(t->asked);
        r.value_name =
            add_name(goal, "value", strstr(goal, " [") != NULL ? UNIT_NONE : t->unit, &sql);
        text_add(&sql, "\", curve FROM answer_cell ORDER BY rowid");
        r.query = sql.s;
        ok = plot_draw(s, plan_data_dir(), &r, dir, &told, e);
    }
    text_free(&sql);
    text_free(&told);
    return ok;
}

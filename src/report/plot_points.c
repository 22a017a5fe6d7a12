/* plot_points.c - from rows to points; see plot_points.h.
 *
 * The rule of every figure here: a curve never mixes rows in silence. Rows that fall on one point
 * are first told apart by a column in which they differ; where the user said by which columns, what
 * remains is drawn as a mean with its spread, and what the rows differ in is told. */
#include "report/plot_points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static const double HIDDEN = 0.005; /* curves that are nearer to each other lie on each other */
enum { MOST_SPLIT = 24 }; /* a column with more values makes no legend: they are samples */
enum { MOST_DRAWN = 50000 }; /* rows, which are compared with each other: some seconds */

/* One row with its place. */
struct placed {
    int row, xi, yi, panel, series;
};

/* What is at work. */
struct making {
    const struct plot_sheet *sheet;
    struct plot_axes *axes;
    struct plot_points *p;
    struct placed *at; /* (n) rows that have a place */
    int n;
    bool one_value[MOST_BY]; /* columns that tell curves apart, but have one value */
};

/* What people read of a value. */
static const char *text_at(const struct making *m, int row, int column)
{
    return plot_sheet_at(m->sheet, row, column)->text;
}

/* ---- places on the axes ---- */

/* By number where all are numbers; else as they come. */
static int compare_cells(const struct making *m, int column, int a, int b)
{
    if (!m->sheet->column[column].number) return 0;
    const double x = plot_sheet_at(m->sheet, a, column)->number,
                 y = plot_sheet_at(m->sheet, b, column)->number;
    /* No value is a place of its own, before all numbers. */
    if (isnan(x) || isnan(y)) return !isnan(x) - !isnan(y);
    return (x > y) - (x < y);
}

/* Whether two rows have one place on an axis. */
static bool same_place(const struct making *m, int column, int a, int b)
{
    if (m->sheet->column[column].number) return compare_cells(m, column, a, b) == 0;
    return strcmp(text_at(m, a, column), text_at(m, b, column)) == 0;
}

/* A row for every value of the axis, in order; insertion keeps the list sorted, and an axis has a
 * few hundred places. */
static int list_places(const struct making *m, int column, int *place)
{
    int n = 0;
    for (int i = 0; i < m->n; i++) {
        const int row = m->at[i].row;
        int k = n;
        bool known = false;
        for (int j = 0; j < n && !known; j++) known = same_place(m, column, place[j], row);
        if (known) continue;
        /* Words compare equal: they keep the order in which they came. */
        for (; k > 0 && compare_cells(m, column, place[k - 1], row) > 0; k--)
            place[k] = place[k - 1];
        place[k] = row;
        n++;
    }
    return n;
}

/* The number of the row's value on an axis. */
static int place_of(const struct making *m, int column, const int *place, int n, int row)
{
    for (int i = 0; i < n; i++)
        if (same_place(m, column, place[i], row)) return i;
    return 0;
}

/* Whether the row can be drawn: it has a value, and a place on each axis. */
static bool has_place(const struct making *m, int row)
{
    const struct plot_axes *a = m->axes;
    if (isnan(plot_sheet_at(m->sheet, row, a->value)->number)) return false;
    if (text_at(m, row, a->x)[0] == '\0') return false;
    return a->y < 0 || text_at(m, row, a->y)[0] != '\0';
}

/* Each row gets its numbers on the axes; the lists of places are made from the rows that have
 * one. */
static void place_rows(struct making *m)
{
    struct plot_points *p = m->p;
    struct arena *a = m->sheet->arena;
    /* Rows without a place are counted, since whoever reads the figure has to know of them. */
    for (int i = 0; i < m->sheet->nrow; i++)
        if (has_place(m, i)) m->at[m->n++].row = i;
        else p->unknown++;
    p->x = TAKE(a, m->n + 1, int);
    p->y = TAKE(a, m->n + 1, int);
    p->nx = list_places(m, m->axes->x, p->x);
    p->ny = m->axes->y >= 0 ? list_places(m, m->axes->y, p->y) : 0;
    for (int i = 0; i < m->n; i++) {
        m->at[i].xi = place_of(m, m->axes->x, p->x, p->nx, m->at[i].row);
        m->at[i].yi = p->ny > 0 ? place_of(m, m->axes->y, p->y, p->ny, m->at[i].row) : 0;
    }
}

/* ---- curves ---- */

/* Whether the rows agree in every column that tells curves apart, from number `from` on. */
static bool same_curve(const struct making *m, int from, int a, int b)
{
    for (int i = from; i < m->axes->nby; i++)
        if (strcmp(text_at(m, a, m->axes->by[i]), text_at(m, b, m->axes->by[i])) != 0) return false;
    return true;
}

/* Rows of one place and one curve. */
static bool same_point(const struct making *m, int i, int k)
{
    return m->at[i].xi == m->at[k].xi && m->at[i].yi == m->at[k].yi &&
           same_curve(m, 0, m->at[i].row, m->at[k].row);
}

/* Whether `column` differs between two rows of one point. */
static bool splits(const struct making *m, int column)
{
    /* All pairs: a few thousand rows are compared in a fraction of a second, and most pairs differ
     * in their place already. */
    for (int i = 0; i < m->n; i++)
        for (int k = 0; k < i; k++)
            if (same_point(m, i, k) &&
                strcmp(text_at(m, m->at[i].row, column), text_at(m, m->at[k].row, column)) != 0)
                return true;
    return false;
}

/* How many different values a column has among the rows that are drawn. */
static int values_of(const struct making *m, int column)
{
    int *place = memory_take((size_t)m->n + 1, sizeof *place);
    const int n = list_places(m, column, place);
    free(place);
    return n;
}

/* Whether a column is an axis already, or tells curves apart. */
static bool is_used(const struct plot_axes *a, int column)
{
    bool used = column == a->x || column == a->y || column == a->value;
    for (int i = 0; i < a->nby; i++) used = used || a->by[i] == column;
    return used;
}

/* Columns are added until no two different runs fall on one point: in the order of the sheet, which
 * is that in which a legend should name them. Of a query, words are taken. */
static void choose_columns(struct making *m)
{
    struct plot_axes *a = m->axes;
    for (int c = 0; c < m->sheet->ncolumn && a->nby < MOST_BY; c++) {
        const struct plot_column *column = &m->sheet->column[c];
        /* A result that differs says nothing about which runs these are. */
        const bool fit = m->sheet->runs ? column->trait : !column->number;
        if (fit && !is_used(a, c) && splits(m, c) && values_of(m, c) <= MOST_SPLIT)
            a->by[a->nby++] = c;
    }
}

/* A word that says of what only beside the name of its column. */
static bool is_truth(const char *text)
{
    return strcmp(text, "true") == 0 || strcmp(text, "false") == 0;
}

/* "t3e-300, link": words as they are, numbers with what they are. */
static const char *curve_name(const struct making *m, int from, int to, int row)
{
    struct text t = {0};
    for (int i = from; i < to; i++) {
        const struct plot_column *c = &m->sheet->column[m->axes->by[i]];
        const char *text = text_at(m, row, m->axes->by[i]);
        /* What all rows share tells nothing apart. */
        if (text[0] == '\0' || m->one_value[i]) continue;
        text_add(&t, "%s", t.length > 0 ? ", " : "");
        /* "bodies n 64": a number alone would not say of what. */
        if (c->number || is_truth(text)) text_add(&t, "%s ", c->title);
        text_add(&t, "%s", text);
    }
    const char *name = arena_text(m->sheet->arena, t.s != NULL ? t.s : "");
    text_free(&t);
    return name;
}

/* The number of the row's name in a list, which it joins when it is new. */
static int join(const char **list, int *n, const char *name)
{
    for (int i = 0; i < *n; i++)
        if (strcmp(list[i], name) == 0) return i;
    list[*n] = name;
    return (*n)++;
}

/* More curves than a panel can show: which columns made them. Returns false. */
static bool too_many(const struct making *m, int n, struct err *e)
{
    struct text t = {0};
    for (int i = 0; i < m->axes->nby; i++)
        text_add(&t, "%s%s (%d values)", i > 0 ? ", " : "", m->sheet->column[m->axes->by[i]].title,
                 values_of(m, m->axes->by[i]));
    err_set(e, ERR_USAGE,
            "%d curves are more than can be told apart; they differ in %s: choose with --by or "
            "--where",
            n, t.s != NULL ? t.s : "nothing");
    text_free(&t);
    return false;
}

/* One panel where all curves fit; else one for each value of the first column. */
static bool name_curves(struct making *m, struct err *e)
{
    struct plot_points *p = m->p;
    struct arena *a = m->sheet->arena;
    const int nby = m->axes->nby;
    for (int i = 0; i < nby; i++) m->one_value[i] = values_of(m, m->axes->by[i]) == 1;
    p->panel = TAKE(a, m->n + 1, const char *);
    p->series = TAKE(a, m->n + 1, const char *);
    /* First all in one panel; when that is too much, a panel for each value of the first column. */
    for (int from = 0; from < 2; from++) {
        const bool maps = m->axes->y >= 0; /* a heat map has one panel for each curve */
        const int split = maps ? nby : from;
        p->npanel = p->nseries = 0;
        for (int i = 0; i < m->n; i++) {
            m->at[i].panel = join(p->panel, &p->npanel, curve_name(m, 0, split, m->at[i].row));
            m->at[i].series = join(p->series, &p->nseries, curve_name(m, split, nby, m->at[i].row));
        }
        if (p->nseries <= MOST_SERIES && p->npanel <= MOST_PANELS) return true;
        if (nby < 2 || maps) break;
    }
    return too_many(m, p->nseries > MOST_SERIES ? p->nseries * p->npanel : p->npanel, e);
}

/* ---- points ---- */

/* For qsort: by panel, curve and place; rows of one point as they came. */
static int compare_placed(const void *a, const void *b)
{
    const struct placed *x = a, *y = b;
    const int order[][2] = {{x->panel, y->panel}, {x->series, y->series}, {x->xi, y->xi},
                            {x->yi, y->yi},       {x->row, y->row}};
    for (int i = 0; i < 5; i++)
        if (order[i][0] != order[i][1]) return order[i][0] < order[i][1] ? -1 : 1;
    return 0;
}

/* Student's t for 95 % on both sides, as view v_repetition has it. */
static double student(int n)
{
    static const double t[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262};
    return n <= 10 ? t[n - 2] : 1.96 + 2.5 / (n - 1);
}

/* Whether (n) rows are repetitions of one run. */
static bool repetitions(const struct making *m, const struct placed *at, int n)
{
    struct err ignored;
    err_clear(&ignored);
    const int hash = m->sheet->runs ? plot_sheet_find(m->sheet, "config_hash", &ignored) : -1;
    for (int i = 1; i < n && hash >= 0; i++)
        if (strcmp(text_at(m, at[0].row, hash), text_at(m, at[i].row, hash)) != 0) return false;
    return hash >= 0;
}

/* Whether `title` is one of the titles in "a, b, c": "rate" is not in "hop_rate". */
static bool is_told(const char *all, const char *title)
{
    const size_t n = strlen(title);
    /* Title by title: of a query one may be empty, or begin with a blank. */
    for (const char *s = all; s != NULL;) {
        if (strncmp(s, title, n) == 0 && (s[n] == '\0' || s[n] == ',')) return true;
        s = strstr(s, ", ");
        if (s != NULL) s += 2;
    }
    return false;
}

/* The columns in which rows of one point differ, each told once. */
static void tell_difference(struct making *m, const struct placed *at, int n)
{
    struct text *out = &m->p->differ;
    for (int c = 0; c < m->sheet->ncolumn; c++) {
        const struct plot_column *column = &m->sheet->column[c];
        bool differs = false;
        for (int i = 1; i < n; i++)
            differs = differs || strcmp(text_at(m, at[0].row, c), text_at(m, at[i].row, c)) != 0;
        if (!differs || is_used(m->axes, c) || (m->sheet->runs && !column->trait)) continue;
        if (!is_told(out->s, column->title))
            text_add(out, "%s%s", out->length > 0 ? ", " : "", column->title);
    }
}

/* (n) rows of one place as one point. */
static void add_point(struct making *m, const struct placed *at, int n)
{
    struct plot_points *p = m->p;
    double sum = 0, square = 0, low = INFINITY, high = -INFINITY;
    for (int i = 0; i < n; i++) {
        const double v = plot_sheet_at(m->sheet, at[i].row, m->axes->value)->number;
        sum += v;
        low = fmin(low, v);
        high = fmax(high, v);
    }
    /* In a second pass, since squares of nearly equal numbers would cancel in one. */
    const double mean = sum / n;
    for (int i = 0; i < n; i++) {
        const double d = plot_sheet_at(m->sheet, at[i].row, m->axes->value)->number - mean;
        square += d * d;
    }
    const bool repeated = n > 1 && repetitions(m, at, n);
    if (repeated) {
        /* half the width of the interval: t s / sqrt(n), s^2 = sum of squares / (n - 1) */
        const double half = student(n) * sqrt(square / (n - 1.0) / n);
        low = mean - half, high = mean + half;
    } else if (n > 1) {
        /* Runs that differ in more are no sample of one quantity: a range, no interval. */
        tell_difference(m, at, n);
    }
    p->repeated += repeated;
    p->mixed += n > 1 && !repeated;
    p->band = p->band || n > 1;
    p->at[p->n++] = (struct plot_point){.panel = at->panel, .series = at->series, .xi = at->xi,
                                        .yi = at->yi, .value = mean, .low = n > 1 ? low : NAN,
                                        .high = n > 1 ? high : NAN, .rows = n, .row = at->row};
}

/* The point of a curve at a place, NULL: it has none. */
static const struct plot_point *point_at(const struct plot_points *p, int panel, int series, int xi)
{
    for (int i = 0; i < p->n; i++)
        if (p->at[i].panel == panel && p->at[i].series == series && p->at[i].xi == xi)
            return &p->at[i];
    return NULL;
}

/* The largest relative difference of two curves where both have points; 1 when one has a point
 * where the other has none. */
static double distance(const struct plot_points *p, int a, int b)
{
    double largest = 0;
    for (int i = 0; i < p->n; i++) {
        const struct plot_point *q = &p->at[i];
        if (q->series != a && q->series != b) continue;
        const struct plot_point *other = point_at(p, q->panel, q->series == a ? b : a, q->xi);
        /* A curve that goes on alone can be seen there. */
        if (other == NULL) return 1;
        const double scale = fmax(fabs(q->value), fabs(other->value));
        if (scale > 0) largest = fmax(largest, fabs(q->value - other->value) / scale);
    }
    return largest;
}

/* A curve that lies on an earlier one cannot be seen: the legend says where it is. */
static void name_hidden(struct making *m)
{
    struct plot_points *p = m->p;
    for (int b = 1; b < p->nseries && p->ny == 0; b++)
        for (int a = 0; a < b; a++) {
            const double d = distance(p, a, b);
            if (d > HIDDEN || strstr(p->series[a], " = ") != NULL) continue;
            struct text t = {0};
            text_add(&t, d > 0 ? "%s = %s within %.1g %%" : "%s = %s", p->series[b], p->series[a],
                     100 * d);
            p->series[b] = arena_text(m->sheet->arena, t.s);
            text_free(&t);
            break;
        }
}

/* Everything but the result lives in the arena of the sheet. */
bool plot_points_make(struct plot_points *p, const struct plot_sheet *sheet, struct plot_axes *axes,
                      struct err *e)
{
    *p = (struct plot_points){0};
    if (sheet->nrow > MOST_DRAWN)
        return err_set(e, ERR_USAGE,
                       "%d rows are more than a figure can show, which is %d: choose with --where, "
                       "or let a query of your own group them",
                       sheet->nrow, MOST_DRAWN);
    struct making m = {.sheet = sheet, .axes = axes, .p = p,
                       .at = TAKE(sheet->arena, sheet->nrow + 1, struct placed)};
    /* Places first: which rows meet on one point decides which columns a legend needs. */
    place_rows(&m);
    if (m.n == 0)
        return err_set(e, ERR_NO_INPUT, "no row has a number for %s and a value for %s",
                       sheet->column[axes->value].key, sheet->column[axes->x].key);
    if (!axes->by_given) choose_columns(&m);
    if (!name_curves(&m, e)) return false;
    /* Rows of one point follow each other then. */
    qsort(m.at, (size_t)m.n, sizeof *m.at, compare_placed);
    p->at = TAKE(sheet->arena, m.n, struct plot_point);
    for (int i = 0, k; i < m.n; i = k) {
        for (k = i + 1; k < m.n && m.at[k].panel == m.at[i].panel &&
                        m.at[k].series == m.at[i].series && m.at[k].xi == m.at[i].xi &&
                        m.at[k].yi == m.at[i].yi; k++) {}
        add_point(&m, &m.at[i], k - i);
    }
    name_hidden(&m);
    return true;
}

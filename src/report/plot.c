/* plot.c - a request for a plot becomes temporary tables, and a figure of plots/ draws them; see
 * plot.h.
 *
 * What the script needs to know (scales, titles, numbers of curves) is a row of data like the
 * points: the script is the same for every request, and no text gets into it. */
#include "report/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "report/plot_points.h"
#include "report/report.h"
#include "store/temporary.h"

/* A logarithmic axis is chosen where the largest value is this many times the least. */
enum { LOG_FROM = 16, MOST_KEYS = 48, MOST_BARS = 96 };

/* An axis as people read it. */
struct axis {
    char label[200];
    double scale; /* what a number in base units is multiplied by */
    int base;     /* of the logarithm, 0: linear */
};

/* Everything of one plot. */
struct plot {
    const struct plot_request *request;
    struct plot_sheet sheet;
    struct plot_axes axes;
    struct plot_points points;
    int rows_before; /* conditions were applied */
    struct axis x, y, value;
    const char *figure; /* whose script draws it */
};

/* ---- which columns ---- */

/* The column of a query that was not named: number `nth` of those that fit. */
static int nth_column(const struct plot_sheet *sheet, int nth, bool number)
{
    for (int i = 0; i < sheet->ncolumn; i++)
        if ((!number || sheet->column[i].number) && strcmp(sheet->column[i].key, "run_id") != 0 &&
            nth-- == 0)
            return i;
    return 0;
}

/* The column of a key; `otherwise` where none was named. -1 with *e set. */
static int column_of(const struct plot_sheet *sheet, const char *key, int otherwise, struct err *e)
{
    return key != NULL ? plot_sheet_find(sheet, key, e) : otherwise;
}

/* The words of a list divided by commas, each handed on without blanks. */
static int split(const char *list, const char **word, int most, struct arena *a)
{
    int n = 0;
    char *rest = arena_text(a, list), *w, *save = NULL;
    for (w = strtok_r(rest, ", ", &save); w != NULL && n < most; w = strtok_r(NULL, ", ", &save))
        word[n++] = w;
    return n;
}

/* The columns of --by. Given but empty ("--by ''"), it puts everything on one curve. */
static bool find_by(struct plot *p, struct err *e)
{
    const char *word[MOST_BY + 1];
    if (p->request->by == NULL) return true;
    /* One word more than there is room for shows that there were too many. */
    const int n = split(p->request->by, word, MOST_BY + 1, p->sheet.arena);
    p->axes.by_given = true;
    if (n > MOST_BY) return err_set(e, ERR_USAGE, "--by: more than %d columns", MOST_BY);
    for (int i = 0; i < n; i++) {
        const int c = plot_sheet_find(&p->sheet, word[i], e);
        if (c < 0) return false;
        p->axes.by[p->axes.nby++] = c;
    }
    return true;
}

/* What the caller calls an axis better than its column does. */
static void name_axis(struct plot_column *c, struct plot_axis_name name)
{
    if (name.title != NULL) c->title = name.title;
    if (name.unit != UNIT_NONE) c->unit = name.unit;
}

/* What stands on which axis: of a heat map --y is a place and --z the value, of all others --y is
 * the value. */
static bool find_axes(struct plot *p, struct err *e)
{
    const struct plot_request *r = p->request;
    const struct plot_sheet *s = &p->sheet;
    const bool map = r->z != NULL || r->kind == PLOT_HEAT;
    struct plot_axes *a = &p->axes;
    /* Of a query the first columns are the axes; of runs all axes were named (check_request). */
    a->x = column_of(s, r->x, nth_column(s, 0, false), e);
    const int y = column_of(s, r->y, nth_column(s, 1, !map), e);
    a->y = map ? y : -1;
    a->value = map ? column_of(s, r->z, nth_column(s, 2, true), e) : y;
    if (a->x < 0 || y < 0 || a->value < 0) return false;
    /* An axis may have words on it, a value must be a number. */
    if (!s->column[a->value].number)
        return err_set(e, ERR_USAGE, "'%s' is no number: it cannot be drawn over '%s'",
                       s->column[a->value].key, s->column[a->x].key);
    name_axis(&s->column[a->x], r->x_name);
    name_axis(&s->column[a->value], r->value_name);
    return find_by(p, e);
}

/* ---- axes ---- */

/* A prefix under which the largest value has one to three digits before its point. */
/* Base units in the data, readable ones on the axis: the factor between them is data, too. */
static double prefix_of(enum unit unit, double largest, const char **name)
{
    static const struct {
        double factor;
        const char *time, *rate;
    } prefix[] = {{1e-9, "ns", ""},  {1e-6, "µs", ""},  {1e-3, "ms", ""},  {1, "s", ""},
                  {1e3, "s", "k"},  {1e6, "s", "M"},  {1e9, "s", "G"},  {1e12, "s", "T"}};
    /* Times go down from seconds, rates go up from one: nobody reads kiloseconds or millibytes. */
    const bool time = unit == UNIT_TIME;
    size_t at = 3;
    const size_t n = sizeof prefix / sizeof *prefix;
    if (time)
        while (at > 0 && largest < prefix[at].factor) at--;
    else
        while (at + 1 < n && largest >= prefix[at + 1].factor) at++;
    *name = time ? prefix[at].time : prefix[at].rate;
    return prefix[at].factor;
}

/* frexp gives a mantissa of one half exactly for these. */
static bool is_power_of_two(double v)
{
    int exponent;
    return v > 0 && frexp(v, &exponent) == 0.5;
}

/* Logarithmic by default where the range asks for it; to base 2 where all values are powers of
 * it. */
static int log_base(enum plot_scale wanted, double least, double largest, bool powers)
{
    if (wanted == PLOT_SCALE_LINEAR || least <= 0) return 0;
    if (wanted == PLOT_SCALE_AUTO && largest < LOG_FROM * least) return 0;
    return powers || largest < 500 * least ? 2 : 10;
}

/* "hop_latency [µs]" and its scale, from the values that are drawn. */
static void make_axis(struct axis *axis, const struct plot_column *c, enum plot_scale wanted, int n,
                      const double *v)
{
    double least = INFINITY, largest = 0;
    bool powers = true;
    /* Numbers of bodies and of ranks are counted in powers of two, even where some are none. */
    const bool counts = strcmp(c->key, "n") == 0 || strcmp(c->key, "P") == 0;
    for (int i = 0; i < n; i++) {
        least = fmin(least, v[i]);
        largest = fmax(largest, fabs(v[i]));
        powers = powers && (counts || is_power_of_two(v[i]));
    }
    /* Sizes stay in bytes: their prefixes are powers of 1,024, which a logarithmic axis shows by
     * itself. */
    const char *name = "", *si = units_si(c->unit);
    const bool scaled = c->unit == UNIT_TIME || c->unit == UNIT_BANDWIDTH ||
                        c->unit == UNIT_FLOP_RATE || c->unit == UNIT_FREQUENCY;
    const char *per = c->unit == UNIT_BANDWIDTH ? "B/s" : c->unit == UNIT_FLOP_RATE ? "flop/s" : si;
    const double factor = scaled && largest > 0      ? prefix_of(c->unit, largest, &name)
                          : c->unit == UNIT_PERCENT ? 0.01
                                                    : 1;
    axis->scale = 1 / factor;
    axis->base = c->number ? log_base(wanted, least, largest, powers) : 0;
    if (c->unit == UNIT_TIME)
        snprintf(axis->label, sizeof axis->label, "%.150s [%s]", c->title, name);
    else if (c->unit == UNIT_PERCENT)
        snprintf(axis->label, sizeof axis->label, "%.150s [%%]", c->title);
    else if (*si != '\0')
        snprintf(axis->label, sizeof axis->label, "%.150s [%s%s]", c->title, name, per);
    else text_copy(axis->label, sizeof axis->label, c->title);
}

/* All three, each from its own numbers. */
static void make_axes(struct plot *p)
{
    const struct plot_points *q = &p->points;
    const struct plot_sheet *s = &p->sheet;
    const struct plot_request *r = p->request;
    /* One buffer for the numbers of each axis in turn. */
    double *v = memory_take((size_t)(q->n + q->nx + q->ny + 1), sizeof *v);
    for (int i = 0; i < q->nx; i++) v[i] = plot_sheet_at(s, q->x[i], p->axes.x)->number;
    make_axis(&p->x, &s->column[p->axes.x], r->x_scale, q->nx, v);
    for (int i = 0; i < q->ny; i++) v[i] = plot_sheet_at(s, q->y[i], p->axes.y)->number;
    if (q->ny > 0) make_axis(&p->y, &s->column[p->axes.y], PLOT_SCALE_AUTO, q->ny, v);
    for (int i = 0; i < q->n; i++) v[i] = q->at[i].value;
    make_axis(&p->value, &s->column[p->axes.value], r->y_scale, q->n, v);
    free(v);
}

/* Curves over numbers, bars over names, unless something else is wanted. */
static const char *figure_of(const struct plot *p)
{
    if (p->axes.y >= 0) return "_heat";
    if (p->request->kind == PLOT_BARS) return "_bars";
    if (p->request->kind == PLOT_LINES) return "_lines";
    return p->sheet.column[p->axes.x].number && p->points.nx > 1 ? "_lines" : "_bars";
}

/* Bars that no page has room for. */
static bool check_bars(const struct plot *p, struct err *e)
{
    /* Counted as if every curve had every place. */
    const int n = p->points.nx * p->points.nseries * p->points.npanel;
    return strcmp(p->figure, "_bars") != 0 || n <= MOST_BARS ||
           err_set(e, ERR_USAGE, "%d bars are more than a page holds; choose with --where, or draw "
                                 "--kind lines", n);
}

/* ---- texts ---- */

/* "Run time against bodies n", unless the user has a better one. */
static void make_title(const struct plot *p, struct text *t)
{
    const struct plot_sheet *s = &p->sheet;
    if (p->request->title != NULL) {
        text_add(t, "%s", p->request->title);
        return;
    }
    text_add(t, "%s against %s", s->column[p->axes.value].title, s->column[p->axes.x].title);
    /* A heat map has two. */
    if (p->axes.y >= 0) text_add(t, " and %s", s->column[p->axes.y].title);
    /* A sentence begins with a capital, the name of a column stays as it is. */
    if (t->s[0] >= 'a' && t->s[0] <= 'z' && strchr(s->column[p->axes.value].title, ' ') != NULL)
        t->s[0] = (char)(t->s[0] - 'a' + 'A');
}

/* What all rows have in common: which machine, which program, which level. */
static void make_subtitle(const struct plot *p, struct text *t)
{
    static const char *const key[] = {"kernel", "name", "level", "formulation", "solver"};
    const struct plot_sheet *s = &p->sheet;
    text_add(t, "%s", "");
    for (size_t i = 0; s->runs && i < sizeof key / sizeof *key; i++) {
        struct err ignored;
        err_clear(&ignored);
        const int c = plot_sheet_find(s, key[i], &ignored);
        /* Only what every row shares is true of the whole figure. */
        bool one = c >= 0 && c != p->axes.x && c != p->axes.y;
        for (int k = 1; one && k < s->nrow; k++)
            one = strcmp(plot_sheet_at(s, k, c)->text, plot_sheet_at(s, 0, c)->text) == 0;
        if (one && plot_sheet_at(s, 0, c)->text[0] != '\0')
            text_add(t, "%s%s%s", t->length > 0 ? ", " : "", i == 2 ? "level " : "",
                     plot_sheet_at(s, 0, c)->text);
    }
}

/* What the bars or bands stand for. */
static void say_bands(const struct plot_points *q, struct text *t)
{
    if (q->repeated > 0)
        text_add(t, "%sbands: 95 %% confidence of the mean of repetitions",
                 t->length > 0 ? "; " : "");
    if (q->mixed > 0)
        text_add(t, "%spoints: mean and range of runs that differ in %s", t->length > 0 ? "; " : "",
                 q->differ.s != NULL ? q->differ.s : "nothing that is stored");
}

/* Which rows are in the figure, and which are not. */
static void tell(const struct plot *p, struct text *told)
{
    const struct plot_sheet *s = &p->sheet;
    const char *what = s->runs ? "runs" : "rows";
    /* Every row is accounted for: drawn, left out by a condition, or without a number. */
    int total = p->rows_before, drawn = s->nrow - p->points.unknown;
    text_add(told, "drawn: %d of %d %s", drawn, total, what);
    if (total > s->nrow) text_add(told, "; left out: %d by --where", total - s->nrow);
    if (p->points.unknown > 0)
        text_add(told, "; left out: %d without %s", p->points.unknown,
                 s->column[p->axes.value].title);
    if (p->axes.nby > 0) text_add(told, "; curves by ");
    for (int i = 0; i < p->axes.nby; i++)
        text_add(told, "%s%s", i > 0 ? ", " : "", s->column[p->axes.by[i]].title);
    if (s->nleft > 0)
        text_add(told, "; not looked at: %d settings more in which runs differ (%s, ...)", s->nleft,
                 s->left);
    struct text bands = {0};
    say_bands(&p->points, &bands);
    if (bands.length > 0) text_add(told, "; %s", bands.s);
    text_free(&bands);
}

/* ---- tables ---- */

/* The points as rows, with the texts of their places: what a reader of the CSV file gets, too. */
static bool put_points(const struct plot *p, struct store *s, struct err *e)
{
    const struct plot_points *q = &p->points;
    bool ok = store_temporary(
        s, "plot_point",
        "panel INTEGER, panel_name TEXT, series INTEGER, curve TEXT, xi INTEGER, x REAL,"
        " x_text TEXT, yi INTEGER, y REAL, y_text TEXT, value REAL, low REAL, high REAL,"
        " rows INTEGER, run_id INTEGER", e);
    for (int i = 0; ok && i < q->n; i++) {
        const struct plot_point *a = &q->at[i];
        const struct plot_cell *x = plot_sheet_at(&p->sheet, q->x[a->xi], p->axes.x);
        /* Curves and bars have no second axis. */
        static const struct plot_cell none = {"", NAN};
        const struct plot_cell *y =
            q->ny > 0 ? plot_sheet_at(&p->sheet, q->y[a->yi], p->axes.y) : &none;
        const int64_t id = p->sheet.run_id[a->row];
        /* Numbers of panels, curves and places begin with 1, as gnuplot counts. */
        const struct store_value v[] = {
            store_int(a->panel + 1), store_text(q->panel[a->panel]), store_int(a->series + 1),
            store_text(q->series[a->series]), store_int(a->xi + 1), store_real(x->number),
            store_text(x->text), store_int(a->yi + 1), store_real(y->number), store_text(y->text),
            store_real(a->value), store_real(a->low), store_real(a->high), store_int(a->rows),
            id > 0 ? store_int(id) : store_null()};
        ok = store_temporary_row(s, "plot_point", (int)(sizeof v / sizeof *v), v, e);
    }
    return ok;
}

/* Every run that a point stands for, for the figure's provenance. */
static bool put_runs(const struct plot *p, struct store *s, struct err *e)
{
    /* Also of runs that are only a part of a mean. */
    bool ok = store_temporary(s, "plot_run", "run_id INTEGER", e);
    for (int i = 0; ok && i < p->sheet.nrow; i++) {
        const struct store_value v = store_int(p->sheet.run_id[i]);
        if (v.integer > 0) ok = store_temporary_row(s, "plot_run", 1, &v, e);
    }
    return ok;
}

/* One row with all that a script has to know. */
static bool put_about(const struct plot *p, struct store *s, struct err *e)
{
    /* Texts are data, too: they are shown as they are and never part of a command. */
    struct text title = {0}, subtitle = {0}, bands = {0};
    const struct plot_points *q = &p->points;
    size_t longest = 0;
    /* The script makes room for the longest name in the legend. */
    for (int i = 0; i < q->nseries; i++)
        if (strlen(q->series[i]) > longest) longest = strlen(q->series[i]);
    make_title(p, &title);
    make_subtitle(p, &subtitle);
    text_add(&bands, "%s", "");
    say_bands(q, &bands);
    /* Bars stand at words, also where these are numbers. */
    const bool axis =
        strcmp(p->figure, "_bars") != 0 && p->sheet.column[p->axes.x].number;
    const struct store_value v[] = {
        store_text(title.s),        store_text(subtitle.s),
        store_text(bands.s),        store_text(p->x.label),
        store_text(p->y.label),     store_text(p->value.label),
        store_real(p->x.scale),     store_real(p->value.scale),
        store_int(p->x.base),       store_int(p->value.base),
        store_int(q->npanel),       store_int(q->nseries),
        store_int(q->nx),           store_int(q->ny),
        store_int(q->band),         store_int(axis),
        store_int((int64_t)longest)};
    bool ok = store_temporary(s, "plot_about",
                              "title TEXT, subtitle TEXT, bands TEXT, xlabel TEXT, ylabel TEXT,"
                              " vlabel TEXT, xscale REAL, vscale REAL, xlog INTEGER, vlog INTEGER,"
                              " panels INTEGER, curves INTEGER, nx INTEGER, ny INTEGER,"
                              " band INTEGER, x_number INTEGER, longest INTEGER", e) &&
              store_temporary_row(s, "plot_about", (int)(sizeof v / sizeof *v), v, e);
    text_free(&title);
    text_free(&subtitle);
    text_free(&bands);
    return ok;
}

/* ---- all of it ---- */

/* The keys that the rows are needed for: axes, curves, conditions. */
static int list_keys(const struct plot_request *r, const char **key, struct arena *a)
{
    int n = 0;
    /* In this order, so that a legend names first what the user asked for first. */
    const char *const axis[] = {r->x, r->y, r->z};
    for (int i = 0; i < 3; i++)
        if (axis[i] != NULL) key[n++] = axis[i];
    if (r->by != NULL) n += split(r->by, key + n, MOST_BY, a);
    for (int i = 0; i < r->nwhere && n < MOST_KEYS; i++) key[n++] = r->where[i].key;
    return n;
}

/* Rows of the query or of the runs, and the conditions on them. */
static bool read_rows(struct plot *p, struct store *s, struct err *e)
{
    const struct plot_request *r = p->request;
    const char *key[MOST_KEYS + MOST_BY];
    struct arena *a = arena_create();
    const bool ok = r->query != NULL
                        ? plot_sheet_query(&p->sheet, s, r->query, e)
                        : plot_sheet_runs(&p->sheet, s, list_keys(r, key, a), key, e);
    arena_destroy(a);
    if (!ok) return false;
    /* Conditions come after reading: they may name columns of a query as well as settings. */
    p->rows_before = p->sheet.nrow;
    return plot_where_keep(&p->sheet, r->nwhere, r->where, e);
}

/* Without axes there is nothing to draw; of a query the columns say what they are. */
static bool check_request(const struct plot_request *r, struct err *e)
{
    if (r->query == NULL && (r->x == NULL || r->y == NULL))
        return err_set(e, ERR_USAGE,
                       "--%s is missing: which column to draw, such as --x n --y speedup",
                       r->x == NULL ? "x" : "y");
    if (r->query == NULL && r->kind == PLOT_HEAT && r->z == NULL)
        return err_set(e, ERR_USAGE,
                       "--z is missing: a heat map shows a third column over --x and --y");
    if (r->z != NULL && r->kind != PLOT_HEAT && r->kind != PLOT_AUTO)
        return err_set(e, ERR_USAGE, "--z belongs to a heat map alone");
    return true;
}

/* Rows, columns, points, scales, tables, figure. Whatever fails, what was read is given back. */
bool plot_draw(struct store *s, const char *data_dir, const struct plot_request *r, const char *dir,
               struct text *told, struct err *e)
{
    struct plot p = {.request = r};
    if (!check_request(r, e)) return false;
    bool ok = read_rows(&p, s, e) && find_axes(&p, e) &&
              plot_points_make(&p.points, &p.sheet, &p.axes, e);
    /* Scales and texts follow from the points; then the figure's own query reads them as data. */
    if (ok) {
        make_axes(&p);
        p.figure = figure_of(&p);
        ok = check_bars(&p, e) && put_points(&p, s, e) && put_runs(&p, s, e) && put_about(&p, s, e);
        tell(&p, told);
    }
    ok = ok && report_figure_run(s, data_dir, p.figure, 0, r->as, dir, e);
    text_free(&p.points.differ);
    plot_sheet_free(&p.sheet);
    return ok;
}

/* Which runs fulfil the conditions is found out as for a plot; the copy of the database then holds
 * these alone, so that no figure needs to know of conditions. */
bool plot_only(struct store *s, int n, const struct plot_condition *where, struct text *told,
               struct err *e)
{
    struct plot_sheet sheet = {0};
    const char *key[MOST_CONDITIONS];
    struct text ids = {0};
    for (int i = 0; i < n; i++) key[i] = where[i].key;
    bool ok = plot_sheet_runs(&sheet, s, n, key, e);
    const int before = sheet.nrow;
    ok = ok && plot_where_keep(&sheet, n, where, e);
    for (int i = 0; ok && i < sheet.nrow; i++)
        text_add(&ids, "%s%lld", i > 0 ? "," : "[", (long long)sheet.run_id[i]);
    /* The list of runs goes to the database as one bound text. */
    text_add(&ids, "]");
    ok = ok && store_only(s, ids.s, e);
    if (ok) text_add(told, "drawn from %d of %d runs", sheet.nrow, before);
    text_free(&ids);
    plot_sheet_free(&sheet);
    return ok;
}

/* A setting's unit stands in its row; a column's in its name. */
static bool print_column(void *context, int ncolumn, const char *const *name,
                         const struct store_value *value)
{
    (void)value;
    for (int i = 0; i < ncolumn; i++) fprintf(context, "%s\n", name[i]);
    return true;
}

static bool print_setting(void *context, int ncolumn, const char *const *name,
                          const char *const *value)
{
    (void)ncolumn, (void)name;
    fprintf(context, "%-44s %s%s%s\n", value[0], value[2],
            value[1][0] != '\0' ? " " : "", value[1]);
    return true;
}

static bool no_row(void *context, int ncolumn, const char *const *name,
                   const struct store_value *value)
{
    (void)context, (void)ncolumn, (void)name, (void)value;
    return true;
}

/* Columns of the view, then settings: of those that vary how many values there are. */
bool plot_columns(struct store *s, FILE *out, struct err *e)
{
    return store_query(s, "SELECT * FROM v_run LIMIT 0", 0, NULL, print_column, no_row, out, e) &&
           store_select(s,
                        "SELECT key, max(unit), iif(count(DISTINCT id) > 1, count(DISTINCT id) || "
                        "' values', max(value)) FROM setting WHERE id IN (SELECT setting_id FROM "
                        "run_setting) GROUP BY key ORDER BY key",
                        0, NULL, print_setting, out, e);
}

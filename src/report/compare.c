/* compare.c - which runs of several sides belong together; see compare.h.
 *
 * The settings say it. What is one value on each side, but not the same one, is what the sides
 * differ in. What varies within a side (n, the level, a sweep) tells its points apart, and runs of
 * two sides with the same values of these are the same point. */
#include "report/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "report/how_sure.h"
#include "report/report.h"
#include "spec/field.h"
#include "store/temporary.h"

enum { MOST_KEYS = 400 }; /* settings: more than any version has */

const char *const compare_part[COMPARE_PARTS] = {"computing", "sending and receiving", "waiting",
                                                 "contention"};

/* A setting of some side. */
struct key {
    const char *name;
    bool varies;                    /* within a side */
    const char *value[MOST_SIDES];  /* the only one of each side, NULL: it has none or several */
    bool there[MOST_SIDES];
};

/* Reading the settings of one side, and then its runs. */
struct reading {
    struct compare *c;
    int side;
    int nkey;
    struct key *key; /* (MOST_KEYS) */
    int npoint_key;
    const struct key **point_key; /* (npoint_key) */
    bool named;      /* a point has the name of its machine */
    int capacity;
    struct err *e;
};

/* ---- settings ---- */

/* The key of that name, made when it is new; NULL: more keys than any version has. */
static struct key *key_of(struct reading *r, const char *name)
{
    for (int i = 0; i < r->nkey; i++)
        if (strcmp(r->key[i].name, name) == 0) return &r->key[i];
    if (r->nkey == MOST_KEYS) return NULL;
    struct key *k = &r->key[r->nkey++];
    *k = (struct key){.name = arena_text(r->c->arena, name)};
    return k;
}

/* key, how many values it has on this side, one of them */
static bool take_key(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct reading *r = context;
    (void)ncolumn, (void)name;
    struct key *k = key_of(r, value[0]);
    if (k == NULL) return true;
    /* A key that varies on any side varies: it tells points apart on all of them. */
    const bool one = strcmp(value[1], "1") == 0;
    k->there[r->side] = true;
    k->varies = k->varies || !one;
    if (one) k->value[r->side] = arena_text(r->c->arena, value[2]);
    return true;
}

/* How many runs a side has, and on how many machines. */
static bool take_count(void *context, int ncolumn, const char *const *name,
                       const char *const *value)
{
    struct compare_side *s = context;
    (void)ncolumn, (void)name;
    s->nrun = atoi(value[0]);
    s->machines = strcmp(value[1], "1") > 0 && strcmp(value[1], "0") != 0 && atoi(value[1]) > 1;
    return true;
}

/* The settings of all sides, and how many runs and machines each has. */
static bool read_settings(struct reading *r, struct err *e)
{
    struct compare *c = r->c;
    for (r->side = 0; r->side < c->nside; r->side++) {
        struct compare_side *s = &c->side[r->side];
        const char *const ids[] = {s->run_ids};
        if (!store_select(s->store,
                          "SELECT count(*), count(DISTINCT name) FROM v_run"
                          " WHERE run_id IN (SELECT value FROM json_each(?1))",
                          1, ids, take_count, s, e) ||
            !store_select(s->store,
                          "SELECT key, count(DISTINCT value), min(value) FROM v_setting WHERE "
                          "run_id IN (SELECT run_id FROM v_run WHERE run_id IN (SELECT value FROM "
                          "json_each(?1))) GROUP BY key ORDER BY key",
                          1, ids, take_key, r, e))
            return false;
        if (s->nrun == 0)
            return err_set(e, ERR_NO_INPUT, "'%s' has no run that ended well", s->name);
        r->named = r->named || s->machines;
    }
    return true;
}

/* Whether a key belongs to the machine, which has a name; its level is a question. */
static bool is_machine(const char *key)
{
    return strncmp(key, "machine.", 8) == 0 && strcmp(key, "machine.network.level") != 0 &&
           strcmp(key, "machine.network.tolerance") != 0;
}

/* What tells points apart: n and ranks first, then the others by name. */
static void choose_point_keys(struct reading *r)
{
    r->point_key = TAKE(r->c->arena, r->nkey + 1, const struct key *);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < r->nkey; i++) {
            const struct key *k = &r->key[i];
            const bool size = strcmp(k->name, "model.n") == 0 || strcmp(k->name, "ranks") == 0 ||
                              strcmp(k->name, "program.n") == 0;
            /* A setting that is unknown on a side (an older database) cannot tell its points
             * apart. */
            bool everywhere = true;
            for (int s = 0; s < r->c->nside; s++) everywhere = everywhere && k->there[s];
            if (k->varies && everywhere && !is_machine(k->name) && size == (pass == 0) &&
                strcmp(k->name, "seed") != 0 && strcmp(k->name, "scenario") != 0 &&
                strncmp(k->name, "record.", 7) != 0)
                r->point_key[r->npoint_key++] = k;
        }
}

/* One value a side, and not the same everywhere. With several machines on a side their settings
 * are no difference between the sides. */
static void list_differences(struct reading *r)
{
    struct compare *c = r->c;
    c->difference = TAKE(c->arena, r->nkey + 1, struct compare_difference);
    for (int i = 0; i < r->nkey; i++) {
        const struct key *k = &r->key[i];
        /* A key that a side does not have (an older database) is a difference, too, shown as
         * "-". */
        bool same = true, known = true;
        for (int s = 0; s < c->nside; s++) {
            known = known && (k->value[s] != NULL || !k->there[s]);
            same = same && k->value[s] != NULL && k->value[0] != NULL &&
                   strcmp(k->value[s], k->value[0]) == 0;
        }
        if (same || !known || k->varies || strcmp(k->name, "scenario") == 0 ||
            (r->named && is_machine(k->name)))
            continue;
        struct compare_difference *d = &c->difference[c->ndifference++];
        d->key = k->name;
        const struct field_table *table;
        const struct field *f = field_find_full(k->name, &table);
        for (int s = 0; s < c->nside; s++)
            d->value[s] = k->value[s] != NULL ? field_word(f, k->value[s]) : "-";
    }
}

/* ---- points ---- */

/* The point of that name, made when it is new. */
static struct compare_point *point_of(struct reading *r, const char *name)
{
    struct compare *c = r->c;
    /* Points are found by their names: a few hundred of them at most. */
    for (int i = 0; i < c->npoint; i++)
        if (strcmp(c->point[i].name, name) == 0) return &c->point[i];
    /* Twice as many each time; the arena keeps the smaller ones until the end. */
    if (c->npoint == r->capacity) {
        r->capacity = r->capacity > 0 ? 2 * r->capacity : 64;
        struct compare_point *more = TAKE(c->arena, r->capacity, struct compare_point);
        if (c->npoint > 0) memcpy(more, c->point, (size_t)c->npoint * sizeof *more);
        c->point = more;
    }
    struct compare_point *p = &c->point[c->npoint++];
    *p = (struct compare_point){.name = arena_text(c->arena, name), .x = NAN};
    return p;
}

/* One run: its number, its machine's name, its time, the shares of it, then for each key of a point
 * the value and the number. The mean grows as runs come; squares are in `half` until the end. */
static bool take_run(void *context, int ncolumn, const char *const *name,
                     const struct store_value *v)
{
    struct reading *r = context;
    struct text t = {0};
    (void)name;
    /* The machine's name leads, as in legends. */
    if (r->named) text_add(&t, "%s", v[1].kind == STORE_TEXT ? v[1].text : "");
    for (int i = 7; i + 1 < ncolumn; i += 2) {
        const char *key = r->point_key[(i - 7) / 2]->name, *dot = strrchr(key, '.');
        const bool word = v[i + 1].kind == STORE_NULL;
        /* With one rank a body the two numbers are one. */
        const bool again = i == 9 && strcmp(key, "ranks") == 0 && v[7].kind == STORE_TEXT &&
                           v[9].kind == STORE_TEXT && strcmp(v[7].text, v[9].text) == 0;
        if (v[i].kind != STORE_TEXT || again) continue;
        text_add(&t, "%s", t.length > 0 ? ", " : "");
        if (!word) text_add(&t, "%s ", dot != NULL ? dot + 1 : key);
        text_add(&t, "%s", v[i].text);
    }
    struct compare_point *p = point_of(r, t.s != NULL ? t.s : "");
    text_free(&t);
    /* The first key is n or ranks, where these vary: the horizontal axis. */
    if (isnan(p->x) && ncolumn > 8 && v[8].kind == STORE_REAL) p->x = v[8].real;
    struct compare_cell *cell = &p->cell[r->side];
    const double time = v[2].real, before = cell->makespan;
    if (cell->runs++ == 0) cell->run = v[0].integer;
    /* Welford's update of mean and sum of squared deviations */
    cell->makespan += (time - before) / cell->runs;
    cell->half += (time - before) * (time - cell->makespan);
    for (int i = 0; i < COMPARE_PARTS; i++)
        cell->part[i] +=
            ((v[3 + i].kind == STORE_REAL ? v[3 + i].real : 0) * time - cell->part[i]) / cell->runs;
    return true;
}

/* Sums of squares become half widths of the 95 % confidence interval of the mean (Student's t as in
 * view v_repetition). */
static void finish_cells(struct compare *c)
{
    static const double t[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262};
    for (int i = 0; i < c->npoint; i++)
        for (int s = 0; s < c->nside; s++) {
            struct compare_cell *cell = &c->point[i].cell[s];
            const int n = cell->runs;
            const double student = n <= 10 && n > 1 ? t[n - 2] : 1.96 + 2.5 / fmax(n - 1.0, 1);
            cell->half = n > 1 ? student * sqrt(fmax(cell->half, 0) / (n - 1.0) / n) : 0;
        }
}

/* One query for each side, the same text for all. */
static bool read_runs(struct reading *r, struct err *e)
{
    struct text sql = {0};
    struct compare *c = r->c;
    const char **param = TAKE(c->arena, r->npoint_key + 1, const char *);
    bool ok = true;
    text_add(&sql, "SELECT v.run_id, v.name, v.makespan_s, v.compute_share, v.overhead_share,"
                   " v.wait_share, v.contention_share");
    /* Keys are bound: they are texts of a database. Each is looked up for itself: SQLite joins at
     * most 64 tables, and any number of settings may vary. */
    static const char *const part[] = {"value", "number"};
    for (int i = 0; i < r->npoint_key; i++)
        for (int k = 0; k < 2; k++)
            text_add(&sql, ", (SELECT %s FROM v_setting WHERE run_id = v.run_id AND key = ?%d)",
                     part[k], i + 2);
    /* v_run has runs that ended well alone, with their names. */
    text_add(&sql, " FROM v_run v WHERE v.run_id IN (SELECT value FROM json_each(?1))"
                   " ORDER BY v.run_id");
    for (r->side = 0; r->side < c->nside && ok; r->side++) {
        param[0] = c->side[r->side].run_ids;
        for (int i = 0; i < r->npoint_key; i++) param[i + 1] = r->point_key[i]->name;
        ok = store_query(c->side[r->side].store, sql.s, r->npoint_key + 1, param, NULL, take_run, r,
                         e);
    }
    text_free(&sql);
    return ok;
}

/* ---- all of it ---- */

/* Whether a ratio to the first side can be told for every other one. */
static bool has_all(const struct compare *c, const struct compare_point *p)
{
    for (int s = 0; s < c->nside; s++)
        if (p->cell[s].runs == 0) return false;
    return true;
}

/* Points that all sides have first, each group by x and then as they came. */
static void order_points(struct compare *c)
{
    struct compare_point *sorted = TAKE(c->arena, c->npoint + 1, struct compare_point);
    int n = 0;
    for (int all = 1; all >= 0; all--) {
        const int first = n;
        for (int i = 0; i < c->npoint; i++) {
            if (has_all(c, &c->point[i]) != (all == 1)) continue;
            /* Insertion: a comparison has tens of points, and equal ones keep their order. */
            int k = n++;
            for (; k > first && sorted[k - 1].x > c->point[i].x; k--) sorted[k] = sorted[k - 1];
            sorted[k] = c->point[i];
        }
        if (all) c->ncommon = n;
    }
    c->point = sorted;
}

/* Runs of a side on several machines are told apart by what they are called, on all sides. */
static bool nothing_common(const struct compare *c, struct err *e)
{
    const char *several = NULL;
    for (int i = 0; i < c->nside && several == NULL; i++)
        if (c->side[i].machines) several = c->side[i].name;
    if (several == NULL)
        return err_set(e, ERR_NO_INPUT,
                       "no two runs of all sides agree in what they were asked: nothing can be "
                       "compared point by point");
    return err_set(e, ERR_NO_INPUT,
                   "'%.80s' has runs on several machines, so only runs on machines of the same "
                   "name are compared, and the sides have no such runs that were asked the same; "
                   "single runs are compared by their numbers: mimdsim compare 1 2 -o DB",
                   several);
}

/* Settings of all sides first: what varies on any of them tells the points of all apart. */
bool compare_make(struct compare *c, int n, const struct compare_side *side, struct err *e)
{
    *c = (struct compare){.arena = arena_create(), .nside = n};
    CHECK(n >= 2 && n <= MOST_SIDES);
    /* The caller's stores stay the caller's. */
    for (int i = 0; i < n; i++) c->side[i] = side[i];
    struct reading r = {.c = c, .key = TAKE(c->arena, MOST_KEYS, struct key), .e = e};
    /* What fails half way is given back by compare_free, which the caller calls in any case. */
    if (!read_settings(&r, e)) return false;
    /* In this order: what tells points apart is no difference between the sides. */
    choose_point_keys(&r);
    list_differences(&r);
    if (!read_runs(&r, e)) return false;
    finish_cells(c);
    order_points(c);
    if (c->ncommon == 0) return nothing_common(c, e);
    /* With ranks = n there are two keys, but one number says both. */
    bool apart = false;
    for (int i = 0; i < c->npoint; i++) apart = apart || strstr(c->point[i].name, "ranks ") != NULL;
    const int sizes = !apart && r.npoint_key > 1 && strcmp(r.point_key[0]->name, "model.n") == 0 &&
                      strcmp(r.point_key[1]->name, "ranks") == 0 ? 2 : 1;
    /* Only then does a curve through the points mean anything. */
    c->x_only = !r.named && r.npoint_key > 0 && r.npoint_key <= sizes && !isnan(c->point[0].x);
    const char *key = r.npoint_key > 0 ? r.point_key[0]->name : "", *dot = strrchr(key, '.');
    c->x_name = dot != NULL ? dot + 1 : key;
    return true;
}

void compare_free(struct compare *c)
{
    arena_destroy(c->arena);
    *c = (struct compare){0};
}

double compare_ratio(const struct compare_point *p, int side, double *error)
{
    /* The first side is what all others are held against. */
    const struct compare_cell *a = &p->cell[0], *b = &p->cell[side];
    *error = 0;
    if (a->runs == 0 || b->runs == 0 || a->makespan == 0) return NAN;
    /* Relative errors of a quotient add as squares: the two means are independent. */
    *error = hypot(a->half / a->makespan, b->half / fmax(b->makespan, 1e-300));
    return b->makespan / a->makespan;
}

/* ---- the figure ---- */

enum { MOST_BARS = 42 }; /* that a page has room for */

/* Rows for the figure: every common point, or as many as fit, evenly chosen with first and last. */
static bool put_points(const struct compare *c, struct store *s, struct err *e)
{
    /* The curves above show every point; bars need room. */
    const int most = MOST_BARS / c->nside, shown = c->ncommon < most ? c->ncommon : most;
    bool ok = store_temporary(s, "compare_point",
                              "place INTEGER, point TEXT, x REAL, side INTEGER, name TEXT, "
                              "makespan_s REAL, half_s REAL, compute_s REAL, overhead_s REAL, "
                              "wait_s REAL,"
                              " contention_s REAL, ratio REAL, bar INTEGER", e);
    for (int i = 0; ok && i < c->ncommon; i++) {
        const struct compare_point *p = &c->point[i];
        /* First and last are always among them, the others at equal distances. */
        int place = 0; /* of its bars: number `place` of those that are shown */
        for (int k = 0; k < shown; k++)
            if ((shown > 1 ? (int)((int64_t)k * (c->ncommon - 1) / (shown - 1)) : 0) == i)
                place = k + 1;
        for (int k = 0; ok && k < c->nside; k++) {
            double error;
            const struct compare_cell *cell = &p->cell[k];
            const struct store_value v[] = {
                store_int(place), store_text(p->name), store_real(p->x), store_int(k + 1),
                store_text(c->side[k].name), store_real(cell->makespan), store_real(cell->half),
                store_real(cell->part[0]), store_real(cell->part[1]), store_real(cell->part[2]),
                store_real(cell->part[3]), store_real(compare_ratio(p, k, &error)),
                store_int(place > 0)};
            ok = store_temporary_row(s, "compare_point", (int)(sizeof v / sizeof *v), v, e);
        }
    }
    return ok;
}

/* How far the times of all sides are known, for the foot: a side may be another database, so the
 * figure's own stamp cannot tell. */
static bool known_errors(const struct compare *c, struct text *out, struct err *e)
{
    struct how_sure all = {0}, one;
    for (int i = 0; i < c->nside; i++) {
        if (!how_sure_read(c->side[i].store, c->side[i].run_ids, &one, e)) return false;
        how_sure_join(&all, &one);
    }
    how_sure_short(&all, out);
    text_add(out, "%s", ""); /* a text, also without runs */
    return true;
}

/* The tables are temporary ones of the first side's connection, wherever the other sides came
 * from. */
bool compare_draw(const struct compare *c, const char *data_dir, const char *dir, const char *as,
                  struct err *e)
{
    struct store *s = c->side[0].store;
    struct text title = {0}, errors = {0};
    const int most = MOST_BARS / c->nside;
    for (int i = 0; i < c->nside; i++)
        text_add(&title, "%s%s", i == 0 ? "" : i + 1 < c->nside ? ", " : " and ", c->side[i].name);
    /* Two points make no curve, and points that differ in words have no axis. */
    const bool lines = c->x_only && c->ncommon > 2;
    /* What the script has to know stands in one row, as for mimdsim plot. */
    bool ok = known_errors(c, &errors, e);
    const struct store_value about[] = {
        store_text(title.s), store_text(errors.s), store_int(c->nside),
        store_int(c->ncommon < most ? c->ncommon : most),
        store_int(c->ncommon), store_int(lines), store_text(c->x_name),
        store_int(lines && c->point[0].x > 0 && c->point[c->ncommon - 1].x >= 16 * c->point[0].x)};
    ok = ok && put_points(c, s, e) &&
        store_temporary(s, "compare_about",
                        "title TEXT, errors TEXT, sides INTEGER, shown INTEGER, points "
                        "INTEGER, lines INTEGER, xlabel TEXT, xlog INTEGER",
                        e) &&
        store_temporary_row(s, "compare_about", (int)(sizeof about / sizeof *about), about, e) &&
        report_figure_run(s, data_dir, "_compare", 0, as, dir, e);
    text_free(&title);
    text_free(&errors);
    return ok;
}

/* plot_sheet.c - stored runs as a table of any columns and settings; see plot_sheet.h.
 *
 * Keys come from the command line and values from a database that may be anybody's. So a key is
 * looked up in lists, of columns and of settings, and what is written into the query is the list's
 * own word; the names of settings are bound. */
#include "report/plot_sheet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "spec/setting_number.h"

enum { MOST_NAMES = 512, MOST_COLUMNS = 40 };

/* Other words for columns, as people say them. */
static const char *const alias[][2] = {
    {"machine", "name"},          {"label", "name"},         {"makespan", "makespan_s"},
    {"time", "makespan_s"},       {"ranks", "P"},            {"p", "P"},
    {"processors", "P"},          {"model.n", "n"},          {"kernel.name", "kernel"},
    {"machine.name", "name"},     {"bytes", "sent_bytes"},   {"machine.network.level", "level"},
};

/* What an axis calls a column, where its name says too little. */
static const char *const title[][2] = {
    {"name", "machine"},
    {"makespan_s", "run time"},
    {"speedup", "speedup over the fastest serial code"},
    {"speedup_self", "speedup over one processor"},
    {"efficiency", "efficiency against the fastest serial code"},
    {"parallel_fraction", "degree of parallelism f"},
    {"compute_share", "share of the time: computing"},
    {"overhead_share", "share of the time: sending and receiving"},
    {"wait_share", "share of the time: waiting"},
    {"contention_share", "share of the time: contention"},
    {"sent_bytes", "bytes sent"},
    {"measured_s", "measured time"},
    {"n", "bodies n"},
    {"P", "ranks P"},
};

/* Columns in which runs may differ, in the order in which a legend should name them. */
static const char *const traits[] = {"name",        "kernel",    "formulation", "solver",
                                     "part_solver", "operators", "precision",   "level",
                                     "base",        "model",     "joint",       "n",
                                     "P",           "scenario"};
enum { TRAITS = sizeof traits / sizeof *traits };
/* Those that a program without bodies has, too, but does not read. */
static const char *const of_bodies[] = {"formulation", "solver", "part_solver", "operators",
                                        "precision",   "base",   "model",       "joint"};
enum { OF_BODIES = sizeof of_bodies / sizeof *of_bodies };

/* The columns and settings that there are. */
struct names {
    struct arena *arena;
    int nview, ncolumn, nsetting; /* of view v_run; of that and table run; of table setting */
    const char *column[MOST_NAMES], *setting[MOST_NAMES];
    int nvaried; /* settings that differ between runs come first */
};

/* What one column of the sheet is read from. */
struct source {
    const char *name; /* of the column or the setting */
    bool setting;
    bool result; /* a column of table run that the view v_run lacks */
};

static const char *looked_up(const char *const list[][2], size_t n, const char *word)
{
    for (size_t i = 0; i < n; i++)
        if (strcmp(list[i][0], word) == 0) return list[i][1];
    return word;
}

/* Lists of some tens of words: searched from the front. */
static bool is_in(const char *const *list, int n, const char *word)
{
    for (int i = 0; i < n; i++)
        if (strcmp(list[i], word) == 0) return true;
    return false;
}

/* ---- what there is ---- */

/* Names of columns that cannot stand in double quotes are none that this program made. */
static bool add_columns(void *context, int ncolumn, const char *const *name,
                        const struct store_value *value)
{
    struct names *n = context;
    (void)value;
    for (int i = 0; i < ncolumn && n->ncolumn < MOST_NAMES; i++)
        if (!is_in(n->column, n->ncolumn, name[i]) && strchr(name[i], '"') == NULL)
            n->column[n->ncolumn++] = arena_text(n->arena, name[i]);
    return true;
}

static bool no_row(void *context, int ncolumn, const char *const *name,
                   const struct store_value *value)
{
    (void)context, (void)ncolumn, (void)name, (void)value;
    return true;
}

static bool add_setting(void *context, int ncolumn, const char *const *name,
                        const char *const *value)
{
    struct names *n = context;
    (void)ncolumn, (void)name;
    if (n->nsetting == MOST_NAMES) return false;
    n->nvaried += strcmp(value[1], "1") == 0;
    n->setting[n->nsetting++] = arena_text(n->arena, value[0]);
    return true;
}

/* Settings in which runs differ come first, since these are what curves are told apart by. */
static bool list_names(struct names *n, struct store *s, struct err *e)
{
    if (!store_query(s, "SELECT * FROM v_run LIMIT 0", 0, NULL, add_columns, no_row, n, e))
        return false;
    n->nview = n->ncolumn;
    return store_query(s, "SELECT * FROM run LIMIT 0", 0, NULL, add_columns, no_row, n, e) &&
           store_select(s,
                        "SELECT key, count(DISTINCT id) > 1 FROM setting WHERE id IN (SELECT "
                        "setting_id FROM run_setting) GROUP BY key ORDER BY 2 DESC, key",
                        0, NULL, add_setting, n, e);
}

/* Whether `key` ends with the whole words `end`. */
static bool ends_in(const char *key, const char *end)
{
    const size_t n = strlen(key), m = strlen(end);
    return m <= n && strcmp(key + n - m, end) == 0 && (m == n || key[n - m - 1] == '.');
}

/* The nearest of all names, or a word on where they are listed. Returns false. */
static bool unknown(const struct names *n, const char *key, struct err *e)
{
    const char *all[2 * MOST_NAMES + 16];
    int count = 0;
    for (int i = 0; i < n->ncolumn; i++) all[count++] = n->column[i];
    for (int i = 0; i < n->nsetting; i++) {
        const char *dot = strrchr(n->setting[i], '.');
        all[count++] = n->setting[i];
        if (dot != NULL && count < 2 * MOST_NAMES) all[count++] = dot + 1;
    }
    /* The last word of a key is what people remember of it. */
    return err_set(e, ERR_USAGE,
                   "'%.80s' is neither a column of a run nor a setting%s; `mimdsim plot DB "
                   "--columns` lists them",
                   key, text_hint(key, all, count, "").s);
}

/* Where the values of `key` are: a column by its name, a setting by its key or a unique end of
 * it. */
static bool resolve(const struct names *n, const char *key, struct source *out, struct err *e)
{
    const char *word = looked_up(alias, sizeof alias / sizeof *alias, key), *found = NULL;
    *out = (struct source){.name = word};
    for (int i = 0; i < n->ncolumn; i++)
        if (strcmp(n->column[i], word) == 0)
            return out->name = n->column[i], out->result = i >= n->nview, true;
    out->setting = true;
    /* A whole key wins over the ends of others. */
    for (int i = 0; i < n->nsetting; i++) {
        if (strcmp(n->setting[i], word) == 0) return out->name = n->setting[i], true;
        if (!ends_in(n->setting[i], word)) continue;
        if (found != NULL)
            return err_set(e, ERR_USAGE, "'%.80s' may be '%s' or '%s': write more of the key", key,
                           found, n->setting[i]);
        found = n->setting[i];
    }
    out->name = found;
    return found != NULL || unknown(n, key, e);
}

/* ---- runs ---- */

/* A list of sources, each once. What there is no room for is counted, and its first told. */
static int add_source(struct plot_sheet *sheet, struct source *list, int n, struct source one)
{
    for (int i = 0; i < n; i++)
        if (strcmp(list[i].name, one.name) == 0) return n;
    if (n < MOST_COLUMNS) list[n++] = one;
    else if (sheet->nleft++ == 0) sheet->left = arena_text(sheet->arena, one.name);
    return n;
}

/* What was asked for, then everything in which runs may differ: machines are told apart by their
 * names, n and ranks by their columns. */
static int choose(struct plot_sheet *sheet, const struct names *n, int nkey,
                  const char *const *key, struct source *list, struct err *e)
{
    int count = 0;
    for (int i = 0; i < nkey; i++) {
        struct source one;
        if (!resolve(n, key[i], &one, e)) return -1;
        count = add_source(sheet, list, count, one);
    }
    /* Behind what was asked for: all in which runs may differ, so that nothing is mixed unseen. */
    for (int i = 0; i < TRAITS; i++)
        count = add_source(sheet, list, count, (struct source){.name = traits[i]});
    /* Runs with one configuration are repetitions of each other. */
    count = add_source(sheet, list, count, (struct source){.name = "config_hash"});
    for (int i = 0; i < n->nvaried; i++) {
        const char *k = n->setting[i], *dot = strchr(k, '.');
        bool told = strncmp(k, "machine.", 8) == 0 || strcmp(k, "model.n") == 0 ||
                    strcmp(k, "ranks") == 0 || strcmp(k, "seed") == 0 ||
                    strcmp(k, "kernel.name") == 0 || strcmp(k, "model.generator") == 0 ||
                    (dot != NULL && is_in(traits, TRAITS, dot + 1));
        if (!told)
            count = add_source(sheet, list, count, (struct source){.name = k, .setting = true});
    }
    return count;
}

/* One row a run: its number, then for each column the value and, of a setting, the number. */
static void write_query(const struct source *list, int n, struct text *sql)
{
    /* A setting is joined by its key, which is a bound parameter; a column stands in the view or,
     * where that lacks it, in the table. */
    int param = 0;
    text_add(sql, "SELECT v.run_id");
    for (int i = 0; i < n; i++) {
        if (!list[i].setting) {
            const bool bodies = is_in(of_bodies, OF_BODIES, list[i].name);
            text_add(sql, bodies ? ", iif(r.nu > 0, %s.\"%s\", NULL), NULL, NULL"
                                 : ", %s.\"%s\", NULL, NULL",
                     list[i].result ? "r" : "v", list[i].name);
            continue;
        }
        text_add(sql, ", s%d.value, s%d.number, s%d.unit", i, i, i);
    }
    text_add(sql, " FROM v_run v JOIN run r ON r.id = v.run_id");
    for (int i = 0; i < n; i++)
        if (list[i].setting)
            text_add(sql, " LEFT JOIN v_setting s%d ON s%d.run_id = v.run_id AND s%d.key = ?%d AND "
                          "s%d.value <> ''", i, i, i, ++param, i);
    text_add(sql, " ORDER BY v.run_id");
}

/* What a column's name says of its unit. */
static enum unit unit_of_name(const char *name)
{
    const size_t n = strlen(name);
    if (n > 2 && strcmp(name + n - 2, "_s") == 0) return UNIT_TIME;
    if (n > 6 && strcmp(name + n - 6, "_bytes") == 0) return UNIT_BYTES;
    return UNIT_NONE;
}

/* The kind of quantity whose symbol in base units this is. */
static enum unit unit_of_symbol(const char *si)
{
    for (int i = 0; i < UNIT_KINDS; i++)
        if (si[0] != '\0' && strcmp(units_si((enum unit)i), si) == 0) return (enum unit)i;
    return UNIT_NONE;
}

enum { MOST_ROWS = 1000000 }; /* read for a figure: a query of one's own may have no end */

/* Rows as they come. */
struct reading {
    struct plot_sheet *sheet;
    int capacity;
    int run_column; /* of a query: which column is run_id, -1: none */
    bool too_many;  /* rows: the others were not read */
};

/* Room for one row more; NULL: no figure has so many. */
static struct plot_cell *next_row(struct reading *r)
{
    struct plot_sheet *sheet = r->sheet;
    r->too_many = sheet->nrow == MOST_ROWS;
    if (r->too_many) return NULL;
    if (sheet->nrow == r->capacity) {
        r->capacity = r->capacity > 0 ? 2 * r->capacity : 64;
        const size_t row = (size_t)sheet->ncolumn * sizeof *sheet->cell;
        sheet->cell = memory_resize(sheet->cell, (size_t)r->capacity, row);
        sheet->run_id = memory_resize(sheet->run_id, (size_t)r->capacity, sizeof *sheet->run_id);
    }
    return &sheet->cell[(size_t)sheet->nrow++ * (size_t)sheet->ncolumn];
}

/* A value of any kind as text and number. */
static struct plot_cell cell_of(struct arena *a, const struct store_value *v)
{
    struct plot_cell c = {.text = "", .number = NAN};
    char buffer[40];
    if (v->kind == STORE_INT) c.number = (double)v->integer;
    if (v->kind == STORE_REAL) c.number = v->real;
    if (v->kind == STORE_TEXT) c.text = arena_text(a, v->text);
    if (v->kind == STORE_INT || v->kind == STORE_REAL) {
        snprintf(buffer, sizeof buffer, "%.6g", c.number);
        c.text = arena_text(a, buffer);
    }
    return c;
}

/* A row of write_query: three values for each column. */
static bool take_run(void *context, int ncolumn, const char *const *name,
                     const struct store_value *value)
{
    struct reading *r = context;
    (void)ncolumn, (void)name;
    struct plot_cell *row = next_row(r);
    if (row == NULL) return false;
    /* The number of the run is no column: no axis shows it. */
    r->sheet->run_id[r->sheet->nrow - 1] = value[0].integer;
    for (int i = 0; i < r->sheet->ncolumn; i++) {
        const struct store_value *v = &value[1 + 3 * i];
        row[i] = cell_of(r->sheet->arena, &v[0]);
        /* Of a setting the text is what people read, the number what is drawn. */
        if (v[1].kind == STORE_REAL) row[i].number = v[1].real;
        if (v[2].kind == STORE_TEXT) r->sheet->column[i].unit = unit_of_symbol(v[2].text);
    }
    return true;
}

/* Returns false when there were too many. */
static bool refuse_rows(const struct reading *r, struct err *e)
{
    return !r->too_many || err_set(e, ERR_USAGE,
                                   "more than %d rows are too many for a figure: let a query of "
                                   "your own group or choose them",
                                   MOST_ROWS);
}

/* A column whose known values are all numbers has an axis; any other has names on it. */
static void find_numbers(struct plot_sheet *sheet)
{
    for (int i = 0; i < sheet->ncolumn; i++) {
        bool any = false, all = true;
        for (int k = 0; k < sheet->nrow; k++) {
            const struct plot_cell *c = plot_sheet_at(sheet, k, i);
            any = any || !isnan(c->number);
            all = all && (c->text[0] == '\0' || !isnan(c->number));
        }
        sheet->column[i].number = any && all;
    }
}

/* Two words of a key mostly say enough: link.bandwidth; of a person's own program its parameter
 * alone. */
static const char *end_of_key(const char *name)
{
    const char *last = strrchr(name, '.'), *word = last;
    if (last == NULL) return name;
    while (word > name && word[-1] != '.') word--;
    return strncmp(word, "program.", strlen("program.")) == 0 ? last + 1 : word;
}

/* How each column is called on an axis and in a legend. */
static void name_columns(struct plot_sheet *sheet, const struct source *list)
{
    for (int i = 0; i < sheet->ncolumn; i++) {
        const char *name = arena_text(sheet->arena, list[i].name);
        /* The unit of a setting comes with its rows. */
        sheet->column[i] = (struct plot_column){
            .key = name,
            .title = looked_up(title, sizeof title / sizeof *title, end_of_key(name)),
            .unit = list[i].setting ? UNIT_NONE : unit_of_name(name),
            .trait = list[i].setting || is_in(traits, TRAITS, name)};
    }
}

/* One query for all columns. Its text is made of names out of the lists above alone. */
bool plot_sheet_runs(struct plot_sheet *sheet, struct store *s, int n, const char *const *key,
                     struct err *e)
{
    *sheet = (struct plot_sheet){.arena = arena_create(), .runs = true};
    struct names *names = TAKE(sheet->arena, 1, struct names);
    struct source list[MOST_COLUMNS];
    const char *param[MOST_COLUMNS];
    struct text sql = {0};
    struct reading r = {.sheet = sheet};
    names->arena = sheet->arena;
    int nparam = 0, count = list_names(names, s, e) ? choose(sheet, names, n, key, list, e) : -1;
    if (count >= 0) {
        sheet->ncolumn = count;
        sheet->column = TAKE(sheet->arena, count, struct plot_column);
        name_columns(sheet, list);
        write_query(list, count, &sql);
        for (int i = 0; i < count; i++)
            if (list[i].setting) param[nparam++] = list[i].name;
    }
    bool ok = count >= 0 && store_query(s, sql.s, nparam, param, NULL, take_run, &r, e) &&
              refuse_rows(&r, e);
    text_free(&sql);
    if (ok) find_numbers(sheet);
    else plot_sheet_free(sheet);
    return ok;
}

/* ---- queries ---- */

/* The columns of a query are its own. */
static bool take_header(void *context, int ncolumn, const char *const *name,
                        const struct store_value *value)
{
    struct reading *r = context;
    struct plot_sheet *sheet = r->sheet;
    (void)value;
    sheet->ncolumn = ncolumn;
    sheet->column = TAKE(sheet->arena, ncolumn, struct plot_column);
    /* A query that has a column run_id tells whose numbers these are; the provenance names them. */
    r->run_column = -1;
    for (int i = 0; i < ncolumn; i++) {
        const char *own = arena_text(sheet->arena, name[i]);
        if (strcmp(own, "run_id") == 0) r->run_column = i;
        sheet->column[i] = (struct plot_column){
            .key = own,
            .title = looked_up(title, sizeof title / sizeof *title, own),
            .unit = unit_of_name(own)};
    }
    return true;
}

/* A row of a user's query: texts as they are, numbers with six digits as texts. */
static bool take_row(void *context, int ncolumn, const char *const *name,
                     const struct store_value *value)
{
    struct reading *r = context;
    (void)name;
    struct plot_cell *row = next_row(r);
    if (row == NULL) return false;
    for (int i = 0; i < ncolumn; i++) row[i] = cell_of(r->sheet->arena, &value[i]);
    r->sheet->run_id[r->sheet->nrow - 1] = r->run_column >= 0 ? value[r->run_column].integer : 0;
    return true;
}

/* store_query refuses whatever would change the database, and more than one statement. */
bool plot_sheet_query(struct plot_sheet *sheet, struct store *s, const char *sql, struct err *e)
{
    *sheet = (struct plot_sheet){.arena = arena_create()};
    struct reading r = {.sheet = sheet};
    if (!store_query(s, sql, 0, NULL, take_header, take_row, &r, e) || !refuse_rows(&r, e))
        return plot_sheet_free(sheet), false;
    find_numbers(sheet);
    return true;
}

/* ---- looking up ---- */

/* In a query only its own names count; of runs also other words for columns, and ends of keys. */
int plot_sheet_find(const struct plot_sheet *sheet, const char *key, struct err *e)
{
    const char *name[MOST_NAMES];
    const char *word = sheet->runs ? looked_up(alias, sizeof alias / sizeof *alias, key) : key;
    int found = -1, told = 0;
    for (int i = 0; i < sheet->ncolumn; i++) {
        if (strcmp(sheet->column[i].key, word) == 0) return i;
        if (sheet->runs && found < 0 && ends_in(sheet->column[i].key, word)) found = i;
        /* A query may have more columns than anybody looks for by a nearly right name. */
        if (told < MOST_NAMES) name[told++] = sheet->column[i].key;
    }
    if (found >= 0) return found;
    err_set(e, ERR_USAGE, "'%.80s' is no column of the query%s", key,
            text_hint(key, name, told, "").s);
    return -1;
}

const struct plot_cell *plot_sheet_at(const struct plot_sheet *sheet, int row, int column)
{
    return &sheet->cell[(size_t)row * (size_t)sheet->ncolumn + (size_t)column];
}

void plot_sheet_free(struct plot_sheet *sheet)
{
    free(sheet->cell);
    free(sheet->run_id);
    arena_destroy(sheet->arena);
    *sheet = (struct plot_sheet){0};
}

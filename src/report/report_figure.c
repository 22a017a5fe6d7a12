/* report_figure.c - a figure is two files in plots/: what to ask the database, and how gnuplot
 * draws it.
 *
 * NAME.sql holds one statement, or several of which each after the first follows a line "-- table:
 * x"; the first gives NAME.csv, the others NAME.x.csv. A line "-- needs: ..." says which command
 * fills the database for it. What stands between a line "-- shared:" and a line "-- main:" is the
 * beginning of each of several statements; a line "-- like: OTHER" stands for those of OTHER.sql.
 * A line "-- each: QUERY" says that there is a drawing for each row of QUERY: ?1 is its first
 * column, the files are called after its second. The script that is run is made of the figure's
 * name, style.gp and NAME.gp, and stays beside the images: gnuplot NAME.gp redraws them from the
 * CSV without this program.
 *
 * A database may come from a stranger. Its texts go into data files alone, NAME.csv and
 * NAME.provenance, never into a script; of a name that one gives to a drawing, what has a meaning
 * to a shell, to gnuplot or in a path is replaced. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/arena.h"
#include "base/beside.h"
#include "base/check.h"
#include "base/draft_folder.h"
#include "base/memory.h"
#include "base/text.h"
#include "report/csv.h"
#include "report/figure_text.h"
#include "report/gnuplot.h"
#include "report/images.h"
#include "report/report.h"
#include "report/stamp.h"
#include "report/svg.h"

/* One figure in the making. */
struct figure {
    struct store *s;
    const char *plots; /* folder of the descriptions */
    const char *name;
    const char *as;      /* the results' name */
    const char *run;     /* what ?1 is: the run or row to show; NULL: the description chooses */
    const char *dir;     /* folder of the results */
    struct draft_folder draft; /* in it: where they are made */
    struct text run_ids; /* JSON array of the runs shown, for its provenance */
    int64_t nrow;        /* of the first table */
    bool folder_made;    /* `dir` was not there */
};

/* Owned by the caller. */
static char *joined(const char *a, const char *b, const char *c)
{
    struct text t = {0};
    text_add(&t, "%s%s%s", a, b, c);
    return t.s;
}

/* JSON, as SQLite's json_each takes it back. Called for every row that has a run_id; a run may come
 * several times. */
static void remember_run(void *context, int64_t id)
{
    struct text *ids = context;
    text_add(ids, "%s%lld", ids->length == 0 ? "[" : ",", (long long)id);
}

/* One table of the figure into its file, unless the main one has no rows. */
static bool write_table(struct figure *f, const char *sql, const char *table, int64_t *nrow,
                        struct err *e)
{
    struct text path = {0}, data = {0};
    /* ?1 is bound only where the description asks for a run. */
    FILE *out = text_stream(&data);
    bool ok = csv_write(f->s, sql, strstr(sql, "?1") != NULL, &f->run, out, remember_run,
                        &f->run_ids, nrow, e);
    if (!ok) err_in(e, f->name);
    text_stream_end(out);
    text_add(&path, "%s/%s%s%s.csv", f->draft.path, f->as, *table ? "." : "", table);
    if (ok && (*table || *nrow > 0)) ok = beside_write(path.s, data.s, data.length, e);
    text_free(&path);
    text_free(&data);
    return ok;
}

/* What all statements of `sql` begin with, into *shared; returns where the first of them goes
 * on. */
static const char *take_shared(const char *sql, struct text *shared)
{
    char rest[8];
    const char *from = figure_line(sql, "-- shared:", rest, sizeof rest),
               *main = from != NULL ? figure_line(from, "-- main:", rest, sizeof rest) : NULL;
    text_add(shared, "%s", "");
    if (main == NULL) return sql;
    text_add_bytes(shared, from, (size_t)(main - from));
    return main;
}

/* All tables of NAME.sql. */
static bool write_tables(struct figure *f, const char *sql, struct err *e)
{
    char table[64] = "", next[64];
    struct text shared = {0};
    bool ok = true;
    for (const char *from = take_shared(sql, &shared); ok && from != NULL;) {
        const char *after = figure_line(from, "-- table: ", next, sizeof next);
        struct text statement = {0};
        int64_t nrow;
        text_add(&statement, "%s%s", shared.s, from);
        /* Each statement ends where the next table's mark begins. */
        if (after != NULL) *strstr(statement.s, "-- table: ") = '\0';
        ok = write_table(f, statement.s, table, &nrow, e);
        text_free(&statement);
        if (ok && *table == '\0') f->nrow = nrow;
        /* Without rows in the main table nothing is drawn, so the others are not needed. */
        if (f->nrow == 0) break;
        text_copy(table, sizeof table, next);
        from = after;
    }
    text_free(&shared);
    return ok;
}

/* Appends plots/NAME.gp. */
static bool add_file(struct text *script, const char *plots, const char *name, struct err *e)
{
    struct text path = {0}, content = {0};
    text_add(&path, "%s/%s.gp", plots, name);
    bool ok = text_read_file(&content, path.s, e);
    if (ok) text_add_bytes(script, content.s ? content.s : "", content.length);
    text_free(&path);
    text_free(&content);
    return ok;
}

/* Who made the numbers, as one line beside them. */
static bool write_provenance(struct figure *f, struct err *e)
{
    struct text source = {0}, path = {0};
    /* run_ids is closed here, once all tables have been read. */
    if (f->run_ids.length > 0) text_add(&f->run_ids, "]");
    bool ok = stamp_make(f->s, f->run_ids.s, &source, e);
    if (source.length == 0) text_add(&source, "unknown");
    /* A database's texts must not break the line. */
    csv_plain(source.s);
    text_add(&source, "\n");
    text_add(&path, "%s/%s.provenance", f->draft.path, f->as);
    ok = ok && beside_write(path.s, source.s, source.length, e);
    text_free(&source);
    text_free(&path);
    return ok;
}

/* The script: the figure's name, the common style, then the figure's own commands. The name is
 * this program's, or went through figure_file_name: only a quote in it needs care. */
static bool write_script(struct figure *f, struct err *e)
{
    struct text script = {0}, path = {0};
    text_add(&script, "figure = '");
    for (const char *c = f->as; *c; c++) text_add(&script, *c == '\'' ? "''" : "%c", *c);
    text_add(&script, "'\n");
    bool ok = add_file(&script, f->plots, "style", e) && add_file(&script, f->plots, f->name, e);
    text_add(&path, "%s/%s.gp", f->draft.path, f->as);
    ok = ok && beside_write(path.s, script.s, script.length, e);
    text_free(&script);
    text_free(&path);
    return ok;
}

static bool has_name(const char *dir, struct err *e)
{
    return *dir != '\0' || err_set(e, ERR_CREATE, "cannot make folder '': it has no name");
}

/* As mkdir -p. That a folder exists is no error; that a file has its name is one. */
bool report_folder(const char *dir, struct err *e)
{
    if (!has_name(dir, e)) return false;
    char *path = memory_text(dir);
    for (char *slash = strchr(path + 1, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(path, 0777);
        *slash = '/';
    }
    struct stat info;
    bool ok = mkdir(path, 0777) == 0 || errno == EEXIST;
    if (!ok) err_set(e, ERR_CREATE, "cannot make folder %s: %s", dir, strerror(errno));
    else if (stat(path, &info) == 0 && !S_ISDIR(info.st_mode))
        ok = err_set(e, ERR_CREATE, "%s is not a folder", dir);
    free(path);
    return ok;
}

/* The folder itself, or what is there of those above it, has to take new files. */
bool report_folder_check(const char *dir, struct err *e)
{
    if (!has_name(dir, e)) return false;
    char *path = memory_text(dir);
    const char *nearest = path;
    const bool there = access(path, F_OK) == 0;
    for (char *slash; access(path, F_OK) != 0 && errno == ENOENT; *slash = '\0')
        if ((slash = strrchr(path, '/')) == NULL || slash == path) break;
    /* nothing is left of a name without a folder: it would be made here, or in the root */
    if (access(path, F_OK) != 0 && errno == ENOENT) nearest = *path == '/' ? "/" : ".";
    struct stat info;
    bool ok = true;
    if (there && stat(nearest, &info) == 0 && !S_ISDIR(info.st_mode))
        ok = err_set(e, ERR_CREATE, "%s is not a folder", dir);
    else if (stat(nearest, &info) == 0 && !S_ISDIR(info.st_mode))
        ok = err_set(e, ERR_CREATE, "cannot make folder %s: %s", dir, strerror(ENOTDIR));
    else if (access(nearest, W_OK | X_OK) != 0)
        ok = err_set(e, ERR_CREATE, "cannot make %s %s: %s", there ? "files in" : "folder", dir,
                     strerror(errno));
    free(path);
    return ok;
}

/* Nothing to draw. A folder that was made for it is removed again. */
static bool no_rows(const struct figure *f, const char *sql, struct err *e)
{
    char needs[200] = "";
    if (f->folder_made) rmdir(f->dir);
    figure_line(sql, "-- needs: ", needs, sizeof needs);
    return err_set(e, ERR_NO_INPUT, "database %s has no runs for figure '%s'%s%s", store_path(f->s),
                   f->name, *needs ? "; first: " : "", needs);
}

/* gnuplot's SVG as it may stand in a page: with a title, tooltips without a script, and nothing
 * but shapes and texts. */
static bool clean_svg(const struct figure *f, struct err *e)
{
    struct text path = {0}, svg = {0}, clean = {0};
    text_add(&path, "%s/%s.svg", f->draft.path, f->as);
    /* A script may draw a PNG alone. */
    bool ok = true;
    if (access(path.s, F_OK) == 0) {
        FILE *out = text_stream(&clean);
        ok = text_read_file(&svg, path.s, e) && svg_clean(&svg, NULL, out, e);
        text_stream_end(out);
        if (!ok) err_in(e, f->as);
        ok = ok && beside_write(path.s, clean.s, clean.length, e);
    }
    text_free(&clean);
    text_free(&path);
    text_free(&svg);
    return ok;
}

static bool is_picture(const char *name)
{
    const size_t n = strlen(name);
    return n > 4 && (strcmp(name + n - 4, ".png") == 0 || strcmp(name + n - 4, ".svg") == 0);
}

static bool is_no_picture(const char *name) { return !is_picture(name); }

/* Tables, then the script, then gnuplot, all in the folder of drafts. Pictures of an earlier
 * drawing go before its data do: none is to be seen beside other numbers. If gnuplot fails, data
 * and script get their places all the same, to be drawn elsewhere. */
static bool draw(struct figure *f, const char *sql, struct err *e)
{
    struct text script = {0};
    if (!write_tables(f, sql, e)) return false;
    /* What a drawing of another database left stays. */
    if (f->nrow == 0) return true;
    bool ok = write_provenance(f, e) && write_script(f, e);
    text_add(&script, "%s.gp", f->as);
    const bool drawn = ok && gnuplot_run(f->draft.path, f->dir, script.s, e) &&
                       images_check(f->draft.path, f->dir, f->as, e) && clean_svg(f, e);
    text_free(&script);
    images_remove(f->dir, f->as);
    /* A second error is not told: the first cause wins. */
    ok = ok && draft_folder_publish(&f->draft, is_no_picture, e);
    return ok && drawn && draft_folder_publish(&f->draft, is_picture, e);
}

/* The folder of drafts around it. A folder of results that was made for nothing goes again. */
static bool draw_apart(struct figure *f, const char *sql, struct err *e)
{
    struct text path = {0};
    text_add(&path, "%s/%s", f->dir, f->as);
    bool ok = draft_folder_begin(&f->draft, path.s, e) && draw(f, sql, e);
    draft_folder_end(&f->draft);
    text_free(&path);
    return ok && (f->nrow > 0 || no_rows(f, sql, e));
}

/* One drawing: `run` is what ?1 is bound to, `as` the name of its files. */
static bool make_figure(struct store *s, const char *data_dir, const char *name, const char *run,
                        const char *as, const char *dir, struct err *e)
{
    struct text sql = {0};
    if (!figure_description(data_dir, name, &sql, e)) return figure_unknown(data_dir, name, e);
    char *plots = joined(data_dir, "/plots", "");
    struct figure f = {.s = s, .plots = plots, .name = name, .as = as, .run = run, .dir = dir};
    f.folder_made = access(dir, F_OK) != 0;
    bool ok = report_folder(dir, e) && draw_apart(&f, sql.s ? sql.s : "", e);
    text_free(&f.run_ids);
    text_free(&sql);
    free(plots);
    return ok;
}

/* Every drawing is tried, though gnuplot is missing for one as for all: the numbers are written.
 * Any other error stops. */
bool report_figure(struct store *s, const char *data_dir, const char *name, const char *dir,
                   struct err *e)
{
    struct report_drawings d;
    struct err first;
    err_clear(&first);
    if (!report_drawings_find(s, data_dir, name, &d, e)) return false;
    for (int i = 0; i < d.n && (first.kind == ERR_NONE || first.kind == ERR_UNAVAILABLE); i++) {
        struct err mine; /* without gnuplot the numbers of the others are written all the same */
        err_clear(&mine);
        if (!make_figure(s, data_dir, d.figure, *d.which[i] ? d.which[i] : NULL, d.as[i], dir,
                         &mine))
            first = mine;
    }
    report_drawings_free(&d);
    if (first.kind != ERR_NONE) *e = first;
    return first.kind == ERR_NONE;
}

bool report_figure_run(struct store *s, const char *data_dir, const char *name, int64_t run_id,
                       const char *as, const char *dir, struct err *e)
{
    char id[24];
    snprintf(id, sizeof id, "%lld", (long long)run_id);
    return make_figure(s, data_dir, name, id, as, dir, e);
}

/* cmd_compare.c - mimdsim compare: machines, scenarios, runs or databases side by side.
 *
 * Each argument becomes a set of stored runs. For a machine or a scenario these are made first,
 * where they are not stored already; then report/compare.h pairs them. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/flag.h"
#include "app/known_error.h"
#include "app/levels.h"
#include "app/verb.h"
#include "plan/file_kind.h"
#include "report/compare.h"
#include "report/figure_text.h"
#include "report/how_sure.h"
#include "report/report.h"
#include "run/run.h"
#include "store/store.h"
#include "store/swept.h"

static const char doc[] =
    "Compare machines, scenarios, stored runs or databases: what differs in their settings, their "
    "times with ratios, where the time goes, and one figure of all.\n\n"
    "Example: mimdsim compare t3e-300 paragon my.yaml --on speedup-t3e --set n=16,64\n"
    "Example: mimdsim compare before.db after.db\n"
    "Example: mimdsim compare t3e-300 \"T3E, links x2\" -o mimdsim.db\n"
    "\vEach of A, B, ... is a machine (a name or a file: the points of --on are run on it and "
    "stored), a scenario (its points are run and stored), a database (all its runs), the number of "
    "a run of the database -o, or what runs of that database are called.\n\n"
    "Runs of two sides are compared where they agree in everything but what the sides differ in. "
    "Ratios are to A; if runs are repeated, with their 95 % confidence interval. The figure is "
    "compare-A-B in the folder --dir.";

/* What is compared, and what it takes. */
struct request {
    const struct common *common;
    const char *on;            /* scenario that machines run */
    struct arena *arena;
    struct store *own;         /* of -o, NULL: not needed so far */
    struct store *other[MOST_SIDES]; /* databases that were named */
    struct plan plan[MOST_SIDES]; /* of sides that are run first; no runs: it is none of these */
    int nside;
    struct compare_side side[MOST_SIDES];
};

/* The database -o; for writing only where runs are to be made. */
static struct store *own_store(struct request *r, bool write, struct err *e)
{
    if (r->own == NULL)
        r->own = write ? arguments_store(r->common, r->common->database, e)
                       : store_open(r->common->database, STORE_READ, e);
    return r->own;
}

/* ---- runs that are there ---- */

/* [id, id, ...] of what a query finds. */
static bool add_id(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct text *t = context;
    (void)ncolumn, (void)name;
    text_add(t, "%s%s", t->length > 0 ? "," : "[", value[0]);
    return true;
}

/* The runs of `s` that the query chooses, as a side. */
static bool stored_side(struct request *r, const char *name, struct store *s, const char *sql,
                        const char *param, struct err *e)
{
    struct text ids = {0};
    const char *const bound[] = {param};
    bool ok = store_select(s, sql, param != NULL, bound, add_id, &ids, e);
    if (ok && ids.length > 0) {
        text_add(&ids, "]");
        r->side[r->nside++] = (struct compare_side){
            .name = name, .store = s, .run_ids = arena_text(r->arena, ids.s)};
    } else if (ok) {
        ok = err_set(e, ERR_NO_INPUT, "'%.80s' has no run that ended well in %s", name,
                     store_path(s));
    }
    text_free(&ids);
    return ok;
}

/* Every run of a database that ended well. */
static bool database_side(struct request *r, const char *path, struct err *e)
{
    struct store *s = r->other[r->nside] = store_open(path, STORE_READ, e);
    return s != NULL &&
           stored_side(r, path, s, "SELECT id FROM run WHERE status = 'ok' ORDER BY id", NULL, e);
}

/* ---- runs that are made ---- */

/* Whom the results go to. */
struct keep {
    struct store *store;
    struct err *error;
};

/* Into the database, as `mimdsim run` does it. */
static bool keep_result(void *context, const struct run_spec *spec, const struct run_result *result)
{
    struct keep *k = context;
    return store_put(k->store, spec, NULL, result, k->error);
}

/* Every point that is not stored yet. A point that does not fit its machine is left out, as on a
 * small machine of several. */
static bool make_runs(struct request *r, const struct plan *p, struct run_spec *run, struct err *e)
{
    struct store *s = own_store(r, true, e);
    if (s == NULL) return false;
    struct run_order *order = TAKE(r->arena, p->nrun, struct run_order);
    bool *skip = TAKE(r->arena, p->nrun, bool);
    if (!levels_settle(s, run, order, p->nrun, r->common->quiet, r->arena, e)) return false;
    for (int i = 0; i < p->nrun; i++)
        skip[i] = run[i].refused != NULL || (store_has(s, &run[i]) && !r->common->force);
    /* A result that cannot be stored ends the campaign, with its reason in *e. */
    struct keep k = {s, e};
    return run_campaign(run, order, p->nrun, skip, r->common->jobs, r->common->quiet, keep_result,
                        &k, e) &&
           e->kind == ERR_NONE && known_error_note(s, NULL, run, p->nrun, e) &&
           store_swept_view(s, e);
}

/* What side number `side` will run: a scenario; on `machine`, unless it is NULL. Nothing is run or
 * stored before all sides are found. */
static bool read_plan(struct request *r, int side, const char *scenario, const char *machine,
                      struct err *e)
{
    struct plan_options o = common_plan(r->common);
    /* --machine is this verb's argument; everything else of the command line holds for all sides.
     */
    if (machine != NULL) o.machine = machine;
    return plan_read(&r->plan[side], scenario, &o, e);
}

/* The runs of that plan, made where they are not stored. */
static bool planned_side(struct request *r, int side, const char *name, const char *scenario,
                         const char *machine, struct err *e)
{
    const struct plan p = r->plan[side];
    struct text ids = {0};
    bool ok = true;
    struct run_spec *run = TAKE(r->arena, p.nrun + 1, struct run_spec);
    if (ok) memcpy(run, p.run, (size_t)p.nrun * sizeof *run);
    ok = ok && make_runs(r, &p, run, e);
    for (int i = 0; ok && i < p.nrun; i++) {
        /* What was refused or failed is not stored, and no part of the side. */
        const int64_t id = store_run_id(r->own, &run[i]);
        if (id > 0) text_add(&ids, "%s%lld", ids.length > 0 ? "," : "[", (long long)id);
    }
    if (ok && ids.length == 0)
        ok = err_set(e, ERR_NO_INPUT, "no point of %s can run on '%.80s'", scenario, name);
    if (ok) {
        text_add(&ids, "]");
        /* Legends name a machine as its runs are called. */
        const char *called = machine != NULL && run[0].called != NULL ? run[0].called : name;
        r->side[r->nside++] = (struct compare_side){.name = arena_text(r->arena, called),
                                                    .store = r->own,
                                                    .run_ids = arena_text(r->arena, ids.s)};
    }
    text_free(&ids);
    return ok;
}

/* ---- arguments ---- */

/* Names that runs of the database have, for the nearest one. */
struct names {
    struct arena *arena;
    const char *name[256];
    int n;
};

/* As many as a message could ever choose from. */
static bool add_name(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct names *n = context;
    (void)ncolumn, (void)name;
    if (n->n < 256) n->name[n->n++] = arena_text(n->arena, value[0]);
    return n->n < 256;
}

/* Neither a file nor a machine: what runs are called, or a mistake. */
static bool called_side(struct request *r, const char *word, struct err *e)
{
    /* A database that is not there has no names; that is told with the word itself. */
    struct names n = {.arena = r->arena};
    struct err ignored;
    err_clear(&ignored);
    struct store *s = own_store(r, false, &ignored);
    if (s != NULL)
        store_select(s, "SELECT DISTINCT name FROM v_label ORDER BY 1", 0, NULL, add_name, &n,
                     &ignored);
    for (int i = 0; i < n.n; i++)
        if (strcmp(n.name[i], word) == 0)
            return stored_side(r, word, s,
                               "SELECT v.run_id FROM v_label v JOIN run r ON r.id = v.run_id WHERE "
                               "v.name = ?1 AND r.status = 'ok' ORDER BY 1",
                               word, e);
    /* Machines are meant most often. */
    const char **stem, **title;
    int nmachine = 0;
    if (plan_list("machines", r->arena, &stem, &title, &nmachine, &ignored))
        for (int i = 0; i < nmachine && n.n < 256; i++) n.name[n.n++] = stem[i];
    return err_set(e, ERR_NO_INPUT,
                   "'%.80s' is no machine, scenario or database, and no run of %s is called so%s",
                   word, r->common->database, text_hint(word, n.name, n.n, "").s);
}

/* Digits only: the number of a run. */
static bool is_number(const char *word)
{
    for (const char *s = word; *s != '\0'; s++)
        if (!isdigit((unsigned char)*s)) return false;
    return *word != '\0';
}

/* By what the word is: files are looked at, names are looked up. Sides that have a plan are run;
 * those without one are stored already. */
static bool add_side(struct request *r, int side, const char *word, struct err *e)
{
    const enum file_kind kind = file_kind_of(word, r->arena);
    if (r->plan[side].nrun > 0)
        return kind == FILE_MACHINE ? planned_side(r, side, word, r->on, word, e)
                                    : planned_side(r, side, word, word, NULL, e);
    if (is_number(word)) {
        struct text name = {0};
        text_add(&name, "run %s", word);
        const char *called = arena_text(r->arena, name.s);
        text_free(&name);
        struct store *s = own_store(r, false, e);
        return s != NULL && stored_side(r, called, s,
                                        "SELECT id FROM run WHERE id = CAST(?1 AS INTEGER) AND "
                                        "status = 'ok'",
                                        word, e);
    }
    return kind == FILE_DATABASE ? database_side(r, word, e) : called_side(r, word, e);
}

/* Databases are closed, sides forgotten. Plans stay: they were read at the first look, and reading
 * a scenario of a person's program again would compile it again. */
static void forget_sides(struct request *r)
{
    for (int i = 0; i < MOST_SIDES; i++) {
        store_close(r->other[i]);
        r->other[i] = NULL;
    }
    store_close(r->own);
    r->own = NULL;
    r->nside = 0;
}

/* Everything that is named has to be there before the first run is made: plans are read, stored
 * sides are looked up. *makes: some side has runs to make. */
static bool look_at_sides(struct request *r, bool *makes, struct err *e)
{
    bool ok = true;
    *makes = false;
    for (int i = 0; ok && i < r->common->narg; i++) {
        const char *word = r->common->arg[i];
        const enum file_kind kind = is_number(word) ? FILE_UNKNOWN : file_kind_of(word, r->arena);
        if (kind == FILE_MACHINE) ok = read_plan(r, i, r->on, word, e);
        else if (kind == FILE_SCENARIO) ok = read_plan(r, i, word, NULL, e);
        else ok = add_side(r, i, word, e);
        *makes = *makes || r->plan[i].nrun > 0;
    }
    /* They were looked up for reading; runs that are made need another connection. */
    forget_sides(r);
    return ok;
}

/* "compare-t3e-300-paragon" */
static char *figure_name(const struct request *r)
{
    /* A name with signs that mean something in a path gets a fingerprint. */
    struct text t = {0};
    text_add(&t, "compare");
    for (int i = 0; i < r->nside; i++) text_add(&t, "-%s", r->side[i].name);
    char *name = figure_file_name("compare", t.s);
    text_free(&t);
    return name;
}

/* How far the times of each side are known: a ratio is no better than what it is made of. */
static bool tell_errors(const struct request *r, struct err *e)
{
    printf("\n");
    for (int i = 0; i < r->nside; i++) {
        struct how_sure h;
        struct text sentence = {0};
        if (!how_sure_read(r->side[i].store, r->side[i].run_ids, &h, e)) return false;
        how_sure_sentence(&h, &sentence);
        if (sentence.length > 0) printf("%c  %s\n", 'A' + i, sentence.s);
        text_free(&sentence);
    }
    return true;
}

/* The tables first: they are there even if gnuplot is not. */
static bool answer(struct request *r, struct err *e)
{
    struct compare c;
    const struct common *common = r->common;
    bool makes;
    if (!look_at_sides(r, &makes, e)) return false;
    /* Runs that are made first would be made for a picture that has no place. */
    if (makes && (!report_folder_check(common->directory, e) || own_store(r, true, e) == NULL))
        return false;
    for (int i = 0; i < common->narg; i++)
        if (!add_side(r, i, common->arg[i], e)) return false;
    bool ok = compare_make(&c, r->nside, r->side, e);
    if (ok) {
        compare_print(&c, common->json, stdout);
        ok = common->json || tell_errors(r, e);
    }
    if (ok) {
        fflush(stdout);
        char *name = figure_name(r);
        ok = compare_draw(&c, plan_data_dir(), common->directory, name, e);
        if (ok && !common->json && !common->quiet) printf("\n%s/%s.png\n", common->directory, name);
        free(name);
    }
    compare_free(&c);
    return ok;
}

/* Databases are closed last: the figure still reads from the first of them. */
int cmd_compare(int argc, char **argv)
{
    struct common c;
    struct err e;
    err_clear(&e);
    const char *on = take_value(&argc, argv, "--on");
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE | TAKES_DIR | TAKES_JOBS, "A B [C...]",
                 doc, 2, MOST_SIDES);
    struct request r = {
        .common = &c, .on = on != NULL ? on : "speedup-t3e", .arena = arena_create()};
    bool ok = answer(&r, &e);
    forget_sides(&r);
    for (int i = 0; i < MOST_SIDES; i++) plan_free(&r.plan[i]);
    arena_destroy(r.arena);
    if (ok) return 0;
    /* The document was written already when only the figure failed. */
    if (e.kind == ERR_UNAVAILABLE) c.json = false;
    return common_fail(&c, &e);
}

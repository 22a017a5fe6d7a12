/* cmd_validate.c - mimdsim validate: simulated machines beside published figures, network levels
 * beside references.
 *
 * Two questions with the same form of answer: does the machine file describe the machine that
 * was measured, and does each network level do what a detailed simulator of networks does? */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/contention.h"
#include "app/validation.h"
#include "app/verb.h"
#include "base/check.h"
#include "base/json.h"
#include "base/text.h"
#include "store/store.h"
#include "study/netcheck.h"

static const char doc[] =
    "Run the micro-benchmarks of MACHINE (or of all machines) on the simulator and compare the "
    "results with the published values in machines/published.csv. Print the error of each and "
    "store the runs as check points.\n\n"
    "Example: mimdsim validate t3e-300\n"
    "         mimdsim validate network\n"
    "\v`network` compares every network level with the reference results in tests/data/net, or in "
    "the given FILEs, and prints a table of errors in Markdown. A value of evidence class E only "
    "shows that the machine file was implemented correctly. Limits of the error: 10 % for values "
    "used in calibration (5 % for wires and bisection rates, 20 % for values quoted from memory, "
    "class PR), 30 % for values not used in it. The exit status is 1 if an error exceeds its limit "
    "and the row states no cause. The summary shows both kinds separately. For a single machine, "
    "exchanges among 16 ranks are also measured at every level of the network.";

/* One published figure: value, range, simulated value, error, evidence, whether it was used in
 * calibration, and the verdict with its reason. Numbers are in the file's own unit. */
static void print_row(const struct published *p, const struct validated *o)
{
    char published[48];
    if (p->low < p->high)
        snprintf(published, sizeof published, "%.5g (%.4g-%.4g)", p->value / p->scale,
                 p->low / p->scale, p->high / p->scale);
    else snprintf(published, sizeof published, "%.6g", p->value / p->scale);
    printf("%-6s %-17s %-13s %8s %20s ", p->id, p->machine, probe_name(p->quantity), p->at_text,
           published);
    /* A machine that lacks the quantity has no value and no error. Otherwise both figures are
     * printed in the unit of the file, to be compared with the source by eye. */
    if (o->measured) printf("%11.5g %-7s %+7.1f %%", o->value / p->scale, p->unit, 100 * o->error);
    else printf("%11s %-7s %9s", "-", p->unit, "");
    printf(" %-3s %-5s %s%s%s\n", p->evidence, published_use_name(p->use), o->verdict,
           *p->cause ? ": " : "", o->measured && *o->why ? o->why : p->cause);
}

/* Where ranks meet on the wires, what every level of the network makes of it: the difference
 * between levels is the cost of ignoring contention. */
static void print_levels(const struct published *p, const struct validated *o)
{
    if (!o->contended) return;
    printf("%6s at level", "");
    /* The levels in the order of their cost; a level that was not run prints a dash. */
    for (int i = 0; i < LEVELS; i++) {
        printf("%s %s ", i ? "," : "", validation_level_name(i));
        if (isnan(o->level[i])) printf("-");
        else
            printf("%.5g (%+.1f %%)", o->level[i] / p->scale,
                   100 * (o->level[i] - p->value) / p->value);
    }
    putchar('\n');
}

/* What both models of the node make of computing: the difference is that of caches and of the
 * memory that processors share. */
static void print_models(const struct published *p, const struct validated *o)
{
    if (!o->computed) return;
    printf("%6s by model rates %.5g (%+.1f %%), roofline %.5g (%+.1f %%)\n", "",
           o->model[NODE_RATES] / p->scale, 100 * (o->model[NODE_RATES] - p->value) / p->value,
           o->model[NODE_ROOFLINE] / p->scale,
           100 * (o->model[NODE_ROOFLINE] - p->value) / p->value);
}

/* A published figure and what became of it: one row of the table. */
struct point {
    const struct published *published;
    const struct validated *outcome;
};

static const struct point *point(const void *row) { return row; }

/* A constant or a text of the row. */
static void set_text(struct column_value *v, const char *s)
{
    v->kind = VALUE_TEXT;
    v->text = s;
}

static void read_use(const struct column *c, const void *row, struct column_value *v)
{
    (void)c;
    set_text(v, published_use_name(point(row)->published->use));
}

static void read_quantity(const struct column *c, const void *row, struct column_value *v)
{
    (void)c;
    set_text(v, probe_name(point(row)->published->quantity));
}

/* Where it holds, with the row of the file, since one place may have several figures: together
 * they are a key of table check_point. */
static void read_place(const struct column *c, const void *row, struct column_value *v)
{
    const struct published *p = point(row)->published;
    (void)c;
    CHECK(snprintf(v->buffer, sizeof v->buffer, "%s%s%s", p->at_text, *p->at_text ? " " : "",
                   p->id) < (int)sizeof v->buffer);
    set_text(v, v->buffer);
}

/* A figure in the unit of the file: the real at the column's place over the unit. Not finite:
 * absent. */
static void read_in_unit(const struct column *c, const void *row, struct column_value *v)
{
    const char *base = c->part == PART(struct point, outcome) ? (const char *)point(row)->outcome
                                                              : (const char *)point(row)->published;
    const double x =
        *(const double *)(const void *)(base + c->offset) / point(row)->published->scale;
    if (!isfinite(x)) return;
    v->kind = VALUE_REAL;
    v->real = x;
}

static void write_levels(const struct column *c, const void *row, struct json *j)
{
    (void)c;
    validation_levels_json(point(row)->outcome->level, point(row)->published->scale, j);
}

static void write_models(const struct column *c, const void *row, struct json *j)
{
    const struct point *p = row;
    (void)c;
    json_object(j);
    json_key_real(j, "rates", p->outcome->model[NODE_RATES] / p->published->scale);
    json_key_real(j, "roofline", p->outcome->model[NODE_ROOFLINE] / p->published->scale);
    json_end(j);
}

static bool is_computed(const void *row) { return point(row)->outcome->computed; }

static bool is_contended(const void *row) { return point(row)->outcome->contended; }

/* Of the simulated value: only where there is one. */
static bool is_measured(const void *row) { return point(row)->outcome->measured; }

#define PUBLISHED(member)                                                                          \
    .part = PART(struct point, published), .offset = offsetof(struct published, member)
#define OUTCOME(member)                                                                            \
    .part = PART(struct point, outcome), .offset = offsetof(struct validated, member)

/* The columns for the database (suite, subject, ...) and for JSON, where names are shorter.
 * Ranges are in JSON only. */
static const struct column point_column[] = {
    {"at", COLUMN_STRING, PUBLISHED(at_text), .flags = COLUMN_NO_SQL,
     .doc = "as written in the file"},
    {"at", COLUMN_STRING, .value = read_place, .flags = COLUMN_NO_JSON,
     .doc = "the same, and the row of the file"},
    {"calibrated", COLUMN_STRING, .value = read_use, .flags = COLUMN_NO_SQL,
     .doc = "whether the file was fitted"},
    {"cause", COLUMN_STRING, PUBLISHED(cause), .doc = "of an error that is explained"},
    {"class", COLUMN_STRING, PUBLISHED(evidence), .doc = "evidence: P, PR, D or E"},
    {"high", COLUMN_REAL, PUBLISHED(high), .value = read_in_unit, .flags = COLUMN_NO_SQL,
     .doc = "largest published"},
    {"id", COLUMN_STRING, PUBLISHED(id), .flags = COLUMN_NO_SQL, .doc = "row of the file"},
    {"levels", COLUMN_STRING, .json = write_levels, .known = is_contended, .flags = COLUMN_NO_SQL,
     .doc = "what each level of the network makes of it"},
    {"low", COLUMN_REAL, PUBLISHED(low), .value = read_in_unit, .flags = COLUMN_NO_SQL,
     .doc = "least published"},
    {"subject", COLUMN_STRING, PUBLISHED(machine), .key = "machine", .doc = "the machine"},
    {"models", COLUMN_STRING, .json = write_models, .known = is_computed, .flags = COLUMN_NO_SQL,
     .doc = "what each model of the node makes of it"},
    {"reference", COLUMN_REAL, PUBLISHED(value), .value = read_in_unit, .key = "published",
     .doc = "what is published"},
    {"quantity", COLUMN_STRING, .value = read_quantity, .doc = "what was measured"},
    {"relative_error", COLUMN_REAL, OUTCOME(error), .known = is_measured,
     .doc = "of the simulated value"},
    {"value", COLUMN_REAL, OUTCOME(value), .value = read_in_unit, .known = is_measured,
     .flags = COLUMN_NO_JSON, .doc = "what the simulated machine does"},
    {"simulated", COLUMN_REAL, OUTCOME(value), .value = read_in_unit, .flags = COLUMN_NO_SQL,
     .doc = "what the simulated machine does"},
    {"source", COLUMN_STRING, PUBLISHED(source), .doc = "where it is published"},
    {"tolerance", COLUMN_REAL, OUTCOME(tolerance), .doc = "relative"},
    {"unit", COLUMN_STRING, PUBLISHED(unit), .doc = "of all figures of the row"},
    {"verdict", COLUMN_STRING, OUTCOME(verdict), .doc = "pass, fail, explained or not-testable"},
    {"why", COLUMN_CHARS, OUTCOME(why), .flags = COLUMN_NO_SQL, .doc = "it was not measured"},
};
static const struct column_table point_columns = COLUMNS(point_column);

/* One row of table check_point; a row of the same place is replaced. */
static bool keep(struct store *s, const struct published *p, const struct validated *o,
                 struct err *e)
{
    static const char *const name[] = {"suite"};
    const struct store_value value[] = {store_text("machines")};
    return store_insert_row(s, "check_point", 1, name, value, &point_columns, &(struct point){p, o},
                            e);
}

/* The points shown so far, with their outcomes, for the summary. */
struct table {
    int n;
    const struct published **row; /* (n) borrowed */
    struct validated *outcome;
};

static bool has_points(const void *row) { return ((const struct validation_group *)row)->n > 0; }

#define GROUP(member) .offset = offsetof(struct validation_group, member)

/* Statistics of the points of one use. */
static const struct column group_column[] = {
    {"above_30_percent", COLUMN_INT, GROUP(above), .doc = "points whose error is larger"},
    {"mean_error", COLUMN_REAL, GROUP(mean), .known = has_points, .doc = "of its size"},
    {"median_error", COLUMN_REAL, GROUP(median), .known = has_points, .doc = "of its size"},
    {"points", COLUMN_INT, GROUP(n), .doc = "of the group"},
    {"without_cause", COLUMN_INT, GROUP(unnamed), .doc = "above 30 %, for which no cause is known"},
    {"worst_error", COLUMN_REAL, GROUP(worst), .known = has_points, .doc = "with its sign"},
    {"worst_id", COLUMN_STRING, GROUP(worst_id), .doc = "row of the file"},
};
static const struct column_table group_columns = COLUMNS(group_column);

/* A group inside the summary, by the column's offset. */
static void write_group(const struct column *c, const void *row, struct json *j)
{
    columns_json(&group_columns, (const char *)row + c->offset, j);
}

/* of all points together */
#define SUMMARY(member) .offset = offsetof(struct validation_summary, member)

/* Calibrated and other points apart: a value that was fitted proves nothing about the model. */
static const struct column summary_column[] = {
    {"calibrated", COLUMN_STRING, SUMMARY(calibrated), .json = write_group,
     .doc = "points used for calibration"},
    {"estimated", COLUMN_INT, SUMMARY(estimated),
     .doc = "points of class E, which are in no group"},
    {"explained", COLUMN_INT, SUMMARY(explained), .doc = "points missed for a known cause"},
    {"failed", COLUMN_INT, SUMMARY(failed), .doc = "points missed without one"},
    {"held", COLUMN_STRING, SUMMARY(held), .json = write_group,
     .doc = "points not used for calibration"},
    {"not_testable", COLUMN_INT, SUMMARY(untested), .doc = "points that the machine lacks"},
    {"points", COLUMN_INT, SUMMARY(shown), .doc = "all of them"},
};
static const struct column_table summary_columns = COLUMNS(summary_column);

/* Nothing to say of an empty group. */
static void print_group(const char *name, const struct validation_group *g)
{
    if (g->n == 0) return;
    printf("%-26s %3d points: median |error| %.1f %%, mean %.1f %%, worst %+.1f %% (%s); %d above "
           "%.0f %%, %d of them without a cause\n",
           name, g->n, 100 * g->median, 100 * g->mean, 100 * g->worst, g->worst_id, g->above,
           100 * VALIDATION_UNEXPLAINED, g->unnamed);
}

/* Counts first, then errors. Estimates (class E) are in neither group: agreement with them only
 * shows that the machine file is implemented as written. */
static void print_summary(const struct validation_summary *s)
{
    printf("\n%d points: %d fail, %d explained, %d not testable; %d estimates (class E) are in no "
           "line below\n",
           s->shown, s->failed, s->explained, s->untested, s->estimated);
    print_group("used for calibration", &s->calibrated);
    print_group("not used for calibration", &s->held);
}

/* The points, contention where a single machine was asked for, and the summary; as tables or as
 * one document. */
static void print_table(const struct common *c, const struct table *t, const struct contention *row,
                        int nrow, const struct validation_summary *s)
{
    struct json j = json_make(stdout);
    if (!c->json)
        printf("%-6s %-17s %-13s %8s %20s %11s %-7s %9s %-3s %-5s %s\n", "id", "machine",
               "quantity", "at", "published", "simulated", "unit", "error", "ev.", "cal.",
               /* As a table each figure is one line, and a second one where ranks meet on the
                * wires. */
               "verdict, cause");
    for (int i = 0; i < t->n && !c->json; i++) {
        print_row(t->row[i], &t->outcome[i]);
        print_levels(t->row[i], &t->outcome[i]);
        print_models(t->row[i], &t->outcome[i]);
    }
    if (!c->json) {
        contention_print(row, nrow);
        print_summary(s);
        return;
    /* As a document: contention, points and summary are three keys of one object, sorted. */
    }
    json_object(&j);
    contention_json(row, nrow, &j);
    json_key(&j, "points");
    json_array(&j);
    for (int i = 0; i < t->n; i++)
        columns_json(&point_columns, &(struct point){t->row[i], &t->outcome[i]}, &j);
    json_end(&j);
    json_key(&j, "summary");
    columns_json(&summary_columns, s, &j);
    json_end(&j);
    json_finish(&j);
}

/* Every row of the machine named, or of all, measured and kept. */
static bool go_through(const struct common *c, const struct published *p, int n, struct store *s,
                       struct arena *a, struct table *t, struct err *e)
{
    const char *name = c->arg[0];
    t->row = TAKE(a, n + 1, const struct published *);
    t->outcome = TAKE(a, n + 1, struct validated);
    for (int i = 0; i < n; i++) {
        /* Rows of other machines leave no gap in the table. */
        struct validated *o = &t->outcome[t->n];
        /* The name was checked before, so a row is skipped only because it belongs to another
         * machine. */
        if (strcmp(name, "all") != 0 && strcmp(name, p[i].machine) != 0) continue;
        if (!validation_measure(&p[i], o, a, e) || !keep(s, &p[i], o, e)) return false;
        t->row[t->n++] = &p[i];
    }
    return true;
}

/* Whether there is anything to validate: a machine without published figures is said to have
 * none; a name that is no machine is refused by plan_machine. */
static bool known_machine(const char *name, const struct published *p, int n, struct arena *a,
                          struct err *e)
{
    struct machine_spec m;
    struct plan_options none = {0};
    if (strcmp(name, "all") == 0) return true;
    for (int i = 0; i < n; i++)
        if (strcmp(name, p[i].machine) == 0) return true;
    return plan_machine(&m, name, &none, a, NULL, NULL, e) &&
           err_set(e, ERR_NO_INPUT, "machines/published.csv has no figures of machine '%s'", name);
}

/* All rows in one transaction: the table of check points is of one program. */
static bool validate_machines(const struct common *c, struct arena *a, int *failed, struct err *e)
{
    struct published *p;
    struct table t = {0};
    int n;
    struct text path = {0};
    /* The file belongs to the data directory, not to the working directory: figures and machine
     * files are of one version. */
    text_add(&path, "%s/machines/published.csv", plan_data_dir());
    bool ok = published_read(path.s, a, &p, &n, e) && known_machine(c->arg[0], p, n, a, e);
    text_free(&path);
    if (!ok) return false;
    struct store *s = arguments_store(c, c->database, e);
    ok = s && store_begin(s, e) && go_through(c, p, n, s, a, &t, e) && store_commit(s, e);
    if (!ok && s) store_rollback(s);
    store_close(s);
    if (!ok) return false;
    /* Judged and stored: from here on only printing is left. */
    struct validation_summary sum = validation_summarize(t.row, t.outcome, t.n);
    struct contention row[CONTENTION_ROWS];
    /* Contention is shown for one machine only: it takes seconds for each. */
    int nrow = strcmp(c->arg[0], "all") == 0 ? 0 : contention_measure(c->arg[0], row, a, e);
    if (nrow < 0) return false;
    print_table(c, &t, row, nrow, &sum);
    *failed = sum.failed;
    return true;
}

/* One table a file, in Markdown: mean of |error| in per cent, in brackets the worst with its
 * sign, and how many cases the level could run where not all; a dash where none. */
static void network_table(const struct netcheck *n)
{
    const char *slash = strrchr(n->path, '/');
    /* Columns are the levels, in the order of their cost. */
    printf("`%s`:\n\n| network | cases |", slash ? slash + 1 : n->path);
    for (int l = 0; l < LEVELS; l++) printf(" `%s` |", netcheck_level_name((enum network_level)l));
    printf("\n| --- | --- |");
    for (int l = 0; l < LEVELS; l++) printf(" --- |");
    putchar('\n');
    /* Groups in the order of the file, each once, then all cases together. */
    for (int g = 0; g <= n->nrow; g++) {
        const char *group = g < n->nrow ? n->row[g].group : NULL;
        bool seen = group && !n->row[g].counted; /* a row that is not counted opens no group */
        for (int k = 0; group && k < g && !seen; k++)
            seen = n->row[k].counted && strcmp(n->row[k].group, group) == 0;
        /* A group once, where its first case stands. */
        if (seen) continue;
        int cases = 0;
        for (int k = 0; k < n->nrow; k++)
            cases += n->row[k].counted && (!group || strcmp(n->row[k].group, group) == 0);
        printf("| %s | %d |", group ? group : "all", cases);
        for (int l = 0; l < LEVELS; l++) {
            struct netcheck_total t = netcheck_total(n, group, (enum network_level)l);
            if (t.cases == 0) printf(" - |");
            else if (t.skipped)
                printf(" %.1f (%+.0f), %d cases |", 100 * t.mean, 100 * t.worst, t.cases);
            else printf(" %.1f (%+.0f) |", 100 * t.mean, 100 * t.worst);
        }
        putchar('\n');
    }
    putchar('\n');
}

/* Every file at every level; without FILE, those of tests/data/net. */
static bool validate_network(const struct common *c, struct arena *a, struct err *e)
{
    static const char *const file[] = {"makespan", "makespan_sensitivity", "collectives",
                                       "hand_cases", "latency_load"};
    /* as many as common_parse lets through */
    const char *path[64];
    int n = 0;
    for (int i = 1; i < c->narg; i++) path[n++] = c->arg[i];
    /* `network` alone is one argument: then the files that come with the program are taken. */
    for (size_t i = 0; c->narg == 1 && i < sizeof file / sizeof *file; i++) {
        struct text t = {0};
        text_add(&t, "%s/tests/data/net/%s.json", plan_data_dir(), file[i]);
        /* The name must outlive the loop: netcheck reads the file later and keeps the pointer. */
        char *kept = arena_take(a, t.length + 1);
        memcpy(kept, t.s, t.length + 1);
        text_free(&t);
        path[n++] = kept;
    }
    /* All files are run before the first table is printed. */
    struct netcheck *checks = TAKE(a, n, struct netcheck);
    for (int i = 0; i < n; i++)
        if (!netcheck_run(&checks[i], path[i], NULL, NULL, c->quiet, a, e)) return false;
    struct json j = json_make(stdout);
    if (c->json) json_array(&j);
    for (int i = 0; i < n; i++) {
        if (c->json) netcheck_json_object(&checks[i], -1, &j);
        else network_table(&checks[i]);
    }
    if (c->json) {
        json_end(&j);
        json_finish(&j);
    }
    return true;
}

/* `network` is a word of its own; any other argument is a machine, or `all`. */
int cmd_validate(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, TAKES_STORE, "MACHINE|all\nnetwork [FILE...]", doc, 1, 64);
    struct err e;
    err_clear(&e);
    int failed = 0; /* rows above their limit without a cause */
    struct arena *a = arena_create();
    bool network = strcmp(c.arg[0], "network") == 0;
    bool ok =
        network || c.narg == 1 || err_set(&e, ERR_USAGE, "unexpected argument '%s'", c.arg[1]);
    ok = ok && (network ? validate_network(&c, a, &e) : validate_machines(&c, a, &failed, &e));
    arena_destroy(a);
    if (!ok) return common_fail(&c, &e);
    return failed ? err_exit_status(ERR_CHECK) : 0;
}

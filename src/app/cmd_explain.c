/* cmd_explain.c - mimdsim explain: what will be run, what is left out and why, what it will
 * cost.
 *
 * Estimates come from the programs themselves (run_explain): the numbers of messages and
 * operations that they would send and do. Only --measure runs anything. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/arguments.h"
#include "app/flag.h"
#include "app/keep.h"
#include "app/verb.h"
#include "base/check.h"
#include "base/json.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/units.h"
#include "measure/run_row.h"
#include "report/how_sure.h"
#include "run/run.h"
#include "spec/field.h"
#include "store/store.h"
#include "study/network_remarks.h"
#include "study/savings.h"

static const char doc[] =
    "Show what SCENARIO will run, without running it: points, messages, operations, omissions,\n"
    "and the time and memory needed on this computer.\n\n"
    "Example: mimdsim explain scenarios/speedup-t3e.yaml\n"
    "\v--measure: run a large point with each omission undone in turn, and report what the "
    "omission "
    "saves. Results go to table `omission` of the database and to omissions-SCENARIO.png and .svg.";

enum { MOST_KINDS = 4 * RUN_MAX_OMISSIONS }; /* a sweep has more kinds than one run */

/* Sums and maxima over all runs of a plan. */
struct totals {
    double host_s, host_bytes, most_bytes; /* sum; largest of a run, and of other attempts */
};

/* Runs go one after the other: their times add up, but the memory needed is that of the largest. */
static void add(struct totals *t, const struct run_estimate *r)
{
    t->host_s += r->host_s;
    if (r->host_bytes > t->host_bytes) t->host_bytes = r->host_bytes;
    if (r->host_bytes + r->again_bytes > t->most_bytes)
        t->most_bytes = r->host_bytes + r->again_bytes;
}

/* The omissions of a plan's runs, each kind once. */
struct kinds {
    int n;
    struct kind {
        struct omission omission;
        int runs; /* that leave it out */
    } kind[MOST_KINDS];
};

/* The first run, when all runs have the same idle settings, which are then said once; NULL
 * otherwise. */
static const struct run_estimate *unused_by_all(const struct plan *p, const struct run_estimate *r)
{
    for (int i = 1; i < p->nrun; i++) {
        if (r[i].nunused != r[0].nunused) return NULL;
        for (int k = 0; k < r[i].nunused; k++)
            if (strcmp(r[i].unused[k], r[0].unused[k]) != 0) return NULL;
    }
    return p->nrun > 0 ? r : NULL;
}

/* Each kind of omission once, by what and why, with the number of runs that have it and its
 * largest bound. To be freed. */
static struct kinds *kinds_of(const struct plan *p, const struct run_estimate *r)
{
    struct kinds *k = memory_zeroed(1, sizeof *k);
    for (int i = 0; i < p->nrun; i++)
        for (int j = 0; j < r[i].nomission; j++) {
            const struct omission *o = &r[i].omission[j];
            int at = 0;
            while (at < k->n && (strcmp(k->kind[at].omission.what, o->what) != 0 ||
                                 strcmp(k->kind[at].omission.why, o->why) != 0))
                at++;
            /* More kinds than there is room for cannot be listed; the runs are the same. */
            if (at == MOST_KINDS) continue;
            if (at == k->n) k->kind[k->n++].omission = *o;
            k->kind[at].runs++;
            if (o->bound > k->kind[at].omission.bound) k->kind[at].omission.bound = o->bound;
        }
    return k;
}

/* One choice of a run as scenario files write it; to be freed. */
static struct text choice_of(const struct run_spec *s, const char *key)
{
    const struct field_table *table;
    const struct field *f = field_find_full(key, &table);
    struct text t = {0};
    CHECK(f);
    field_print(f, (const char *)s + table->offset, &t);
    return t;
}

/* A number of a row, or a dash: what programs of one's own cost is known where they tell. */
static void print_count(double x, int width, int digits)
{
    if (isnan(x)) printf(" %*s", width, "-");
    else printf(" %*.*f", width, digits, x);
}

/* The size of the problem: bodies, or what a program of one's own declares as its n. */
static double size_of(const struct run_spec *s, const struct run_estimate *r)
{
    char text[32];
    if (s->kernel.own && program_value_find(s->program.parameters, "n", text, sizeof text))
        return s->model.nbody;
    return r->nu > 0 ? (double)r->nbody : NAN;
}

/* One line of the table. Without a model there are no formulation and no bodies. */
static void print_run(const struct run_spec *s, const struct run_estimate *r)
{
    struct text level = choice_of(s, "machine.network.level"),
                form = choice_of(s, "kernel.formulation");
    printf("%-12.12s %-10s %-12s %-14s", s->machine.name, s->kernel.name, r->nu > 0 ? form.s : "-",
           level.s);
    print_count(size_of(s, r), 8, 0);
    printf(" %8d", s->nrank);
    print_count(r->messages, 12, 0);
    print_count(r->bytes / 1e6, 12, 3);
    print_count(r->flops / 1e6, 12, 3);
    print_count(r->host_s, 10, 4);
    print_count(r->host_bytes / 1e6, 10, 1);
    printf("\n");
    text_free(&level);
    text_free(&form);
}

/* A text and the run that has it. */
struct said {
    const char *text;
    int run;
};

static int compare_said(const void *a, const void *b)
{
    const struct said *x = a, *y = b;
    const int order = strcmp(x->text, y->text);
    return order != 0 ? order : (x->run > y->run) - (x->run < y->run);
}

/* How many runs have the text of run i, at the first that has it; 0 at others, and at those without
 * one ("" or NULL). Sorted, as a plan of 100,000 runs may have as many texts. To be freed. */
static int *count_said(const struct plan *p, const char *const *said)
{
    int *count = memory_zeroed((size_t)p->nrun + 1, sizeof *count), n = 0, first = 0;
    struct said *sorted = memory_zeroed((size_t)p->nrun + 1, sizeof *sorted);
    for (int i = 0; i < p->nrun; i++)
        if (said[i] && said[i][0] != '\0') sorted[n++] = (struct said){said[i], i};
    qsort(sorted, (size_t)n, sizeof *sorted, compare_said);
    for (int i = 0; i < n; i++) {
        if (strcmp(sorted[i].text, sorted[first].text) != 0) first = i;
        count[sorted[first].run]++;
    }
    free(sorted);
    return count;
}

/* The reasons for a way in which runs are executed, each once. */
static void print_way(const struct plan *p, const char *way, const char *const *said)
{
    int *count = count_said(p, said);
    for (int i = 0; i < p->nrun; i++)
        if (count[i] > 0) printf("%s: %d of %d runs: %s\n", way, count[i], p->nrun, said[i]);
    free(count);
}

/* Which runs go on several host threads, which of them by windows of simulated time and why, and
 * why others do not. */
static void print_threads(const struct plan *p, const struct run_estimate *r)
{
    const char **alone = memory_zeroed((size_t)p->nrun + 1, sizeof *alone);
    const char **windows = memory_zeroed((size_t)p->nrun + 1, sizeof *windows);
    int several = 0;
    for (int i = 0; i < p->nrun; i++) {
        several += r[i].threads > 1;
        alone[i] = r[i].alone;
        windows[i] = r[i].alone ? NULL : r[i].ordered;
    }
    if (several > 0) printf("on several threads: %d of %d runs\n", several, p->nrun);
    print_way(p, "threads go by windows of simulated time", windows);
    print_way(p, "on one thread", alone);
    free(windows);
    free(alone);
}

/* What computing costs by: each text once, with the number of runs that it is true of. */
static void print_nodes(const struct plan *p, const struct run_estimate *r)
{
    const char **said = memory_zeroed((size_t)p->nrun + 1, sizeof *said);
    for (int i = 0; i < p->nrun; i++) said[i] = r[i].node;
    int *count = count_said(p, said);
    for (int i = 0; i < p->nrun; i++) {
        if (count[i] == 0) continue;
        printf("computing");
        if (count[i] < p->nrun) printf(" (%d of %d runs)", count[i], p->nrun);
        printf(": %s\n", r[i].node);
    }
    free(count);
    free(said);
}

/* The jobs of the first point; those of others differ by what is swept. */
static void print_jobs(const struct plan *p)
{
    const struct job_set *set = p->nrun > 0 ? p->run[0].jobs : NULL;
    if (!set) return;
    printf("\n%d jobs on one machine, each run tells of one of them:\n", set->n);
    for (int i = 0; i < set->n; i++) {
        /* As scenarios write it: what the file says can be found again. */
        const struct run_spec *s = set->job[i];
        struct text place = choice_of(s, "machine.placement.kind"),
                    start = choice_of(s, "job.start");
        printf("  %-16s %-12s P = %-7d from %-8s placement %s\n", s->job.name, s->kernel.name,
               s->nrank, start.s, place.s);
        text_free(&place);
        text_free(&start);
    }
    /* In the order of the runs above. */
    printf("%-16s %s\n", "  job", "beside");
    for (int i = 0; i < p->nrun && p->run[i].jobs->job == set->job; i++)
        printf("  %-16s %s\n", p->run[i].job.name,
               p->run[i].job.beside[0] ? p->run[i].job.beside : "(alone)");
}

/* What `mimdsim why` needs beyond that for the largest run: its steps take 32 bytes each, some nine
 * a message, fourteen where links are followed; the lists double as they grow (docs/why.md). */
static void print_recording(const struct plan *p, const struct run_estimate *r)
{
    enum { LOGGP_BYTES = 310, LINK_BYTES = 460 };
    double most = 0;
    for (int i = 0; i < p->nrun; i++) {
        const bool loggp = p->run[i].machine.network.level == LEVEL_LOGGP;
        const double bytes = r[i].messages * (loggp ? LOGGP_BYTES : LINK_BYTES);
        if (bytes > most) most = bytes;
    }
    if (most > 0)
        printf("to record the critical path (mimdsim why): about %.*f MB more\n",
               most < 1e7 ? 1 : 0, most / 1e6);
}

/* For people: the table, what is not decided yet, units, cost, then omissions and idle settings. */
static void print_text(const struct plan *p, const struct run_estimate *r)
{
    struct totals t = {0};
    bool open_level = false;
    /* Column heads as wide as print_run's cells. */
    printf("%s\n%d runs\n\n%-12s %-10s %-12s %-14s %8s %8s %12s %12s %12s %10s %10s\n", p->question,
           p->nrun, "machine", "kernel", "formulation", "level", "n", "P", "messages", "MB sent",
           "Mflop", "host s", "host MB");
    for (int i = 0; i < p->nrun; i++) {
        print_run(&p->run[i], &r[i]);
        add(&t, &r[i]);
        open_level = open_level || p->run[i].machine.network.level == LEVEL_AUTO_TOLERANCE;
    }
    print_jobs(p);
    /* Explaining settles nothing: that takes a database and seconds of measuring. */
    if (open_level)
        printf("\nlevel auto-tolerance is settled when it runs, by the network ladder in the "
               "database, or by one that is measured then\n");
    /* Polymers compute in nanometres and picoseconds: results are told in SI. */
    if (p->nrun && r[0].metre > 0 && (r[0].metre != 1 || r[0].kilogram != 1 || r[0].second != 1))
        printf("\nthe model computes in units of %.9g m, %.9g kg, %.9g s\n", r[0].metre,
               r[0].kilogram, r[0].second);
    if (isnan(t.host_s)) printf("\nestimated: not known, the program declares no estimate\n");
    else
        printf("\nestimated: %.2f s of one processor, %.0f MB\n", t.host_s, t.host_bytes / 1e6);
    if (t.most_bytes > 1.05 * t.host_bytes)
        printf("if an answer needs refinement: %.0f MB\n", t.most_bytes / 1e6);
    print_recording(p, r);
    print_threads(p, r);
    print_nodes(p, r);
    network_remarks_print(p, stdout);
    struct kinds *k = kinds_of(p, r);
    for (int i = 0; i < k->n; i++) {
        /* Whether the omission can change a result at all comes first. "left out (exact, in 3 of 12
         * runs): what: why" */
        const struct omission *o = &k->kind[i].omission;
        printf("left out (");
        if (o->bound > 0) printf("bounded by %.1e", o->bound);
        else printf("exact");
        printf("%s", k->kind[i].runs < p->nrun ? ", " : "");
        if (k->kind[i].runs < p->nrun) printf("in %d of %d runs", k->kind[i].runs, p->nrun);
        printf("): %s: %s\n", o->what, o->why);
    }
    free(k);
    for (int i = 0; i < p->nunused; i++) printf("unused: %s\n", p->unused[i]);
    const struct run_estimate *all = unused_by_all(p, r);
    for (int i = 0; all && i < all->nunused; i++) printf("unused: %s\n", all->unused[i]);
}

/* A text of the row or a constant as a column's value. */
static void set_text(struct column_value *v, const char *s)
{
    v->kind = VALUE_TEXT;
    v->text = s;
}

static void read_class(const struct column *c, const void *row, struct column_value *v)
{
    (void)c;
    set_text(v, omission_class(&((const struct kind *)row)->omission));
}

/* Where the values of the columns lie. */
#define KIND(member) .offset = offsetof(struct kind, member)

/* One kind of omission in JSON. */
static const struct column kind_column[] = {
    {"bound", COLUMN_REAL, KIND(omission.bound), .absent = ABSENT_ZERO,
     .doc = "largest relative change of a result"},
    {"class", COLUMN_STRING, .value = read_class, .doc = "exact or bounded"},
    {"runs", COLUMN_INT, KIND(runs), .doc = "that leave it out"},
    {"what", COLUMN_CHARS, KIND(omission.what), .doc = "was left out"},
    {"why", COLUMN_CHARS, KIND(omission.why), .doc = "why no result needs it"},
};
static const struct column_table kind_columns = COLUMNS(kind_column);

/* A planned run with its estimate. */
struct planned {
    const struct run_spec *spec;
    const struct run_estimate *estimate; /* valid unless the point was refused */
};

/* The value of the setting named by `more`, as scenario files write it. */
static void read_level(const struct column *c, const void *row, struct column_value *v)
{
    struct text level = choice_of(((const struct planned *)row)->spec, c->more);
    text_copy(v->buffer, sizeof v->buffer, level.s);
    text_free(&level);
    set_text(v, v->buffer);
}

/* A value of the run, or of its estimate. */
#define SPEC(member) .part = PART(struct planned, spec), .offset = offsetof(struct run_spec, member)
#define ESTIMATE(member)                                                                           \
    .part = PART(struct planned, estimate), .offset = offsetof(struct run_estimate, member)

/* One run of the plan in JSON, with its estimate. */
static const struct column planned_column[] = {
    {"bodies", COLUMN_INT64, ESTIMATE(nbody), .doc = "of the model"},
    {"bytes", COLUMN_REAL, ESTIMATE(bytes), .doc = "sent, estimated"},
    {"computing", COLUMN_CHARS, ESTIMATE(node), .doc = "what computing costs by, \"\": rates"},
    {"flops", COLUMN_REAL, ESTIMATE(flops), .doc = "estimated"},
    {"host_bytes", COLUMN_REAL, ESTIMATE(host_bytes), .doc = "memory on this computer, estimated"},
    {"host_bytes_again", COLUMN_REAL, ESTIMATE(again_bytes),
     .doc = "more memory, if its answer needs refinement"},
    {"host_s", COLUMN_REAL, ESTIMATE(host_s), .doc = "time on this computer, estimated"},
    {"host_threads", COLUMN_INT, ESTIMATE(threads),
     .doc = "that run its ranks on this computer, with --threads auto"},
    {"kernel", COLUMN_CHARS, SPEC(kernel.name), .doc = "the parallel program"},
    {"level", COLUMN_STRING, .value = read_level, .more = "machine.network.level",
     .doc = "of the network"},
    {"machine", COLUMN_CHARS, SPEC(machine.name), .doc = "its name"},
    {"messages", COLUMN_REAL, ESTIMATE(messages), .doc = "estimated"},
    {"ranks", COLUMN_INT, SPEC(nrank), .doc = "virtual processors"},
};
static const struct column_table planned_columns = COLUMNS(planned_column);

/* The same as one document. `measured` NULL: without --measure. */
static void print_json(const struct plan *p, const struct run_estimate *r,
                       const struct savings *measured)
{
    struct json j = json_make(stdout);
    json_object(&j);
    struct kinds *k = kinds_of(p, r);
    network_collectives_json(p, &j);
    json_key(&j, "omissions");
    columns_json_list(&kind_columns, k->kind, k->n, sizeof *k->kind, &j);
    free(k);
    /* keys in the order of the alphabet: omissions, question, routing, runs, savings, unused */
    json_key_text(&j, "question", p->question);
    network_routing_json(p, &j);
    json_key(&j, "runs");
    json_array(&j);
    for (int i = 0; i < p->nrun; i++)
        columns_json(&planned_columns, &(struct planned){&p->run[i], &r[i]}, &j);
    json_end(&j);
    if (measured) savings_json(&j, measured);
    json_key(&j, "unused");
    json_array(&j);
    for (int i = 0; i < p->nunused; i++) json_text(&j, p->unused[i]);
    const struct run_estimate *all = unused_by_all(p, r);
    for (int i = 0; all && i < all->nunused; i++) json_text(&j, all->unused[i]);
    json_end(&j);
    json_end(&j);
    json_finish(&j);
}

/* The rows and the picture of what was measured; a scenario without omissions has no picture. */
/* How far the times of these runs are known: those of them that the database has. A database that
 * is not there, or none, says nothing, and explaining makes none. */
static void tell_errors(const struct common *c, const struct plan *p)
{
    struct how_sure h = {0};
    struct err ignored;
    err_clear(&ignored);
    struct text ids = {0}, sentence = {0};
    struct store *s =
        access(c->database, R_OK) == 0 ? store_open(c->database, STORE_READ, &ignored) : NULL;
    for (int i = 0; s != NULL && i < p->nrun; i++) {
        const int64_t id = store_run_id(s, &p->run[i]);
        if (id > 0) text_add(&ids, "%s%lld", ids.length > 0 ? "," : "[", (long long)id);
    }
    if (ids.length > 0) text_add(&ids, "]");
    if (ids.length > 0 && how_sure_read(s, ids.s, &h, &ignored)) how_sure_sentence(&h, &sentence);
    printf("%s\n", sentence.length > 0
                       ? sentence.s
                       : "How sure: not known before the runs are made; then each has the errors "
                         "of level, machine and arithmetic beside its time");
    text_free(&ids);
    text_free(&sentence);
    store_close(s);
}

static bool keep_and_draw(const struct common *c, const struct savings *all, struct store *s,
                          struct err *e)
{
    struct text figure = {0};
    text_add(&figure, "omissions-%s", all->scenario);
    bool ok = savings_store(s, all, e) && store_publish(s, e);
    ok = ok && (all->n == 0 || keep_draw(c, s, figure.s, e));
    text_free(&figure);
    return ok;
}

/* Points that cannot run have no estimate; they are counted and the first reason is told. */
static bool estimate_all(const struct plan *p, struct run_estimate *r, struct err *e)
{
    const char *first = NULL;
    int64_t work = RUN_EXPLAIN_WORK;
    for (int i = 0; i < p->nrun; i++) {
        if (p->run[i].refused) first = first ? first : p->run[i].refused;
        else if (!run_explain(&p->run[i], &work, &r[i], e)) return false;
    }
    if (first)
        fprintf(stderr, "mimdsim: %d of %d points cannot run; the first: %s\n", p->nrefused,
                p->nrun, first);
    return true;
}

/* Nothing is stored without --measure. */
int cmd_explain(int argc, char **argv)
{
    struct common c;
    bool measure = take_flag(&argc, argv, "--measure");
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE | TAKES_DIR, "SCENARIO", doc, 1, 1);
    struct err e;
    err_clear(&e);
    struct plan p = {0};
    struct plan_options o = common_plan(&c);
    bool ok = plan_read(&p, c.arg[0], &o, &e);
    struct run_estimate *r = memory_zeroed(ok && p.nrun ? (size_t)p.nrun : 1, sizeof *r);
    /* calloc of 1: an empty plan still has an array. */
    struct store *s = ok && measure ? keep_open(&c, &e) : NULL;
    ok = ok && (!measure || s) && r && estimate_all(&p, r, &e);
    /* Too large for the stack: a row for every omission. */
    struct savings *all = memory_zeroed(1, sizeof *all);
    if (ok && !c.json) print_text(&p, r);
    if (ok && !c.json) tell_errors(&c, &p);
    /* The table first: measuring takes seconds to minutes. */
    ok = ok && (!measure || savings_measure(&p, r, all, &e));
    if (ok && measure && !c.json) savings_print(stdout, all);
    ok = ok && (!measure || keep_and_draw(&c, all, s, &e));
    if (ok && c.json) print_json(&p, r, measure ? all : NULL);
    store_close(s);
    free(all);
    free(r);
    plan_free(&p);
    return ok ? 0 : common_fail(&c, &e);
}

/* expand.c - from settings and axes to runs: each with its machine, its P and n, and its identity.
 *
 * A run starts as a copy of what holds for all runs on its machine, so a large sweep costs a copy
 * and a few settings a run; the texts of a struct that did not change since the run before are not
 * printed again (identity.h). */
#include "plan/expand.h"

#include <string.h>

#include "base/digest.h"
#include "base/text.h"
#include "plan/condition.h"
#include "plan/data_dir.h"
#include "plan/file_kind.h"
#include "plan/call.h"
#include "plan/machine_changes.h"
#include "plan/machine_file.h"
#include "plan/program_file.h"
#include "spec/identity.h"

/* A run of a plan takes about 7 KB, so the largest plan takes 0.7 GB and a few seconds. */
enum { MAX_RUNS = 100000, MAX_BODIES = 1 << 27 };

/* What holds for all runs on one machine. */
struct start {
    const char *name; /* as it was asked for */
    struct run_spec run; /* machine and base settings applied */
    struct machine_spec file; /* the machine as its file has it */
    struct machine_file whole; /* with where each value comes from */
    struct start *next; /* the one that was made before */
};

/* What a plan keeps, so that a point can be made again with other settings. */
struct plan_memory {
    const struct scenario *scenario;
    struct start *starts;
    struct start **start_of; /* (nrun) on which machine each run is */
};

struct expansion {
    struct plan *plan;
    const struct scenario *scenario;
    struct err *err;
    struct start *starts; /* made so far, newest first */
    struct start *present; /* of the present point */
    int point[SCENARIO_MAX_AXES]; /* where each axis stands */
    struct identity *identity;    /* owned */
    struct machine_changes changes; /* of the machines seen so far */
    struct calls calls;             /* what runs are called */
};

/* The settings of the present point in the order in which they act; `list` needs naxis + 2
 * entries. */
static int lists_of(const struct expansion *x, const struct setting_list **list)
{
    const struct scenario *s = x->scenario;
    int n = 0;
    /* base, then one point of each axis, then the command line: the last one wins */
    list[n++] = &s->base;
    for (int i = 0; i < s->naxis; i++) list[n++] = &s->axis[i].point[x->point[i]];
    list[n++] = &s->set;
    return n;
}

/* The last setting that matches, NULL when there is none. */
static const struct setting *last_of(const struct expansion *x,
                                     bool (*matches)(const struct setting *))
{
    const struct setting_list *list[SCENARIO_MAX_AXES + 2];
    int n = lists_of(x, list);
    const struct setting *found = NULL;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < list[i]->n; j++)
            if (matches(&list[i]->at[j])) found = &list[i]->at[j];
    return found;
}

/* Settings by what they decide; `program.n` and `model.n` are the same n. */
static bool is_machine(const struct setting *s) { return s->kind == SETTING_MACHINE; }
static bool is_ranks(const struct setting *s) { return strcmp(s->key, "ranks") == 0; }
static bool is_ratio(const struct setting *s) { return s->kind == SETTING_N_OVER_P; }
static bool is_bodies(const struct setting *s)
{
    return strcmp(s->key, "model.n") == 0 || strcmp(s->key, "program.n") == 0;
}

/* The machine is read, and the base settings are applied to it, once for all points on this
 * machine. Returns NULL with *e set. */
static struct start *start_make(struct expansion *x, const struct setting *machine)
{
    struct arena *a = x->plan->arena;
    struct machine_file m;
    struct err why;
    int ntable;
    /* A name in a scenario is looked up beside it, one of the command line is not. */
    bool in_file = machine->line > 0;
    err_clear(&why);
    if (!machine_file_read(&m, machine->text, in_file ? x->scenario->dir : NULL, a, &why)) {
        if (machine->line == 0 && file_kind_refuse(machine->text, FILE_MACHINE, &why))
            err_set(x->err, why.kind, "%s: %s", machine->file, why.text);
        else if (why.file[0] == '\0') /* not found: say where it was asked for */
            err_set_at(x->err, why.kind, machine->file, machine->line, "%s", why.text);
        else err_set_at(x->err, why.kind, why.file, why.line, "%s", why.text);
        return NULL;
    }
    machine_changes_read(&x->changes, m.path, &m.spec);
    struct start *s = TAKE(a, 1, struct start);
    const struct field_table *const *table = field_tables(&ntable);
    for (int i = 0; i < ntable; i++) /* the first table is the whole run's */
        field_defaults(table[i], (char *)&s->run + table[i]->offset, a);
    s->whole = m;
    s->run.machine = s->file = m.spec;
    s->name = machine->text;
    s->next = x->starts;
    x->starts = s;
    text_copy(s->run.scenario, sizeof s->run.scenario, x->scenario->stem);
    for (int i = 0; i < x->scenario->base.n; i++)
        setting_apply(&x->scenario->base.at[i], &s->run, a);
    return s;
}

/* The start of the present point; machines are few, so a list is searched. */
static struct start *start_of(struct expansion *x)
{
    const struct setting *machine = last_of(x, is_machine);
    if (machine == NULL) {
        err_set_at(x->err, ERR_DATA, x->scenario->path, 1,
                   "machine is missing; expected one of `mimdsim machines`");
        return NULL;
    }
    for (struct start *s = x->starts; s != NULL; s = s->next)
        if (strcmp(s->name, machine->text) == 0) return s;
    return start_make(x, machine);
}

/* P and n where one follows from the other. */
static bool resolve_sizes(struct expansion *x, struct run_spec *run)
{
    const struct setting *ranks = last_of(x, is_ranks), *ratio = last_of(x, is_ratio),
                         *bodies = last_of(x, is_bodies);
    if (ranks == NULL)
        return err_set_at(x->err, ERR_DATA, x->scenario->path, 1,
                          "ranks is missing; expected a number, a list, or 'n' for one rank per "
                          "body");
    /* Three numbers of which two determine the third: n = n_over_p x P, or P = n. */
    if (ratio != NULL && bodies != NULL)
        return err_set_at(x->err, ERR_DATA, ratio->file, ratio->line,
                          "n_over_p determines n already; remove '%s' (line %d)", bodies->key,
                          bodies->line);
    if (ratio != NULL && ranks->kind == SETTING_RANKS_ARE_N)
        return err_set_at(x->err, ERR_DATA, ratio->file, ratio->line,
                          "n_over_p needs ranks as numbers, not 'n'");
    if (ranks->kind == SETTING_RANKS_ARE_N) run->nrank = run->model.nbody;
    if (ratio == NULL) return true;
    /* 64 bits: the product may pass INT_MAX before it is refused. */
    int64_t n = (int64_t)ratio->number * run->nrank;
    if (n > MAX_BODIES)
        return err_set_at(x->err, ERR_CONFIG, ratio->file, ratio->line,
                          "n_over_p %d times %d ranks gives more than %d bodies", ratio->number,
                          run->nrank, MAX_BODIES);
    run->model.nbody = (int)n;
    return true;
}

/* Whether the point fits its machine, with a message at the place that the user can change. */
static bool check_fits(struct expansion *x, const struct run_spec *run)
{
    const struct setting *ranks = last_of(x, is_ranks);
    const struct machine_spec *m = &run->machine;
    int64_t n = machine_spec_processors(m);
    /* `ranks: n`: the place to change is that of n. */
    if (ranks->kind == SETTING_RANKS_ARE_N && last_of(x, is_bodies) != NULL)
        ranks = last_of(x, is_bodies);
    if (!machine_file_check(m, ranks->file, ranks->line, x->err)) return false;
    /* A list of places must have one for every rank. */
    if (m->placement.kind == PLACEMENT_LIST && m->placement.nlist < run->nrank)
        return err_set_at(x->err, ERR_CONFIG, ranks->file, ranks->line,
                          "%d ranks, but machine.placement.list names %d processors", run->nrank,
                          m->placement.nlist);
    if (run->nrank > n)
        return err_set_at(x->err, ERR_CONFIG, ranks->file, ranks->line,
                          "%d ranks, but machine '%s' has %lld processors; reduce ranks or enlarge "
                          "machine.topology.dims",
                          run->nrank, m->name, (long long)n);
    /* Only of a chain is the number of bodies known before it is built. */
    if (run->model.generator == MODEL_SERIAL_CHAIN && kernel_spec_needs_model(&run->kernel) &&
        run->model.nbody < run->nrank)
        return err_set_at(
            x->err, ERR_CONFIG, ranks->file, ranks->line,
            "%d ranks for %d bodies: each rank needs at least one body; `only: n >= ranks` "
            "excludes such points",
            run->nrank, run->model.nbody);
    return true;
}

/* Whether the conditions of the scenario and of --only keep this point: 1 yes, 0 no, -1 one makes
 * no sense. All are asked: a mistake in the second is told although the first leaves the point
 * out. */
static int wanted(struct expansion *x, const struct run_spec *run)
{
    const struct scenario *s = x->scenario;
    int keep = 1;
    for (int i = 0; i < s->ncondition; i++) {
        bool holds;
        if (!condition_holds(&s->condition[i], run, &holds, x->err)) return -1;
        if (!holds) keep = 0;
    }
    return keep;
}

/* A model's file is part of a run by its content, wherever it lies. */
static bool resolve_path(struct expansion *x, struct run_spec *run)
{
    char path[2 * sizeof run->model.path];
    const struct model_spec *m = &run->model;
    struct text file = {0};
    bool from_file = m->generator == MODEL_URDF || m->generator == MODEL_VECTOR;
    if (!from_file) return true;
    if (m->path[0] == '\0')
        return err_set_at(x->err, ERR_DATA, x->scenario->path, 0,
                          "model.path is missing: the file of the model");
    snprintf(path, sizeof path, "%s/%s", x->scenario->dir[0] != '\0' ? x->scenario->dir : ".",
             m->path);
    struct err ignored;
    err_clear(&ignored);
    /* Beside the scenario first, then from the working directory. */
    bool relative = m->path[0] != '/' && text_read_file(&file, path, &ignored);
    if (!relative && !text_read_file(&file, m->path, x->err)) return text_free(&file), false;
    /* The content identifies the run: the file may move, or change under its name. */
    digest_sha256_hex(file.s, file.length, run->model_file);
    text_free(&file);
    if (!relative) return true;
    if (strlen(path) >= sizeof run->model.path)
        return err_set_at(x->err, ERR_DATA, x->scenario->path, 0, "model.path: '%.80s' is too long",
                          path);
    text_copy(run->model.path, sizeof run->model.path, path);
    return true;
}

/* A point that cannot run keeps its place in the plan, with the reason: the others are not its
 * business. */
static void note_refusal(struct expansion *x, struct run_spec *run)
{
    /* check_fits writes to x->err: for its time that is `why`. */
    struct err why, *others = x->err;
    err_clear(&why);
    x->err = &why;
    bool fits = check_fits(x, run);
    x->err = others;
    if (fits) return;
    struct plan *p = x->plan;
    /* The first reason is told when no point can run. */
    if (p->nrefused++ == 0) p->refusal = why;
    char place[sizeof why.file + 24] = "";
    if (why.line > 0) snprintf(place, sizeof place, "%s:%d: ", why.file, why.line);
    else if (why.file[0]) snprintf(place, sizeof place, "%s: ", why.file);
    struct text t = {0};
    text_add(&t, "%s%s", place, why.text);
    run->refused = arena_text(p->arena, t.s);
    run->refused_kind = why.kind;
    text_free(&t);
}

/* A program's n stands for n, so its parameters follow when n is known. */
static bool resolve_program(struct expansion *x, struct run_spec *run)
{
    const struct setting_list *list[SCENARIO_MAX_AXES + 2];
    const int n = lists_of(x, list);
    return program_file_choose(x->scenario, run, list, n, x->err) && resolve_sizes(x, run) &&
           program_file_parameters(x->scenario, run, list, n, x->plan->arena, x->err);
}

/* What the run is called; the points of the axes tell apart what shares a given name. */
static void name_run(struct expansion *x, struct run_spec *run, const struct machine_spec *file)
{
    const struct scenario *s = x->scenario;
    struct call_point point[SCENARIO_MAX_AXES];
    for (int i = 0; i < s->naxis; i++) {
        const struct setting_list *list = &s->axis[i].point[x->point[i]];
        point[i] = (struct call_point){s->axis[i].npoint > 1, list->n, list->at};
    }
    call_run(&x->calls, run, file, point, s->naxis);
}

/* One point: 1 run made, 0 left out, -1 failed. */
static int make_point(struct expansion *x, struct run_spec *run)
{
    struct start *start = start_of(x);
    const struct scenario *s = x->scenario;
    if (start == NULL) return -1;
    x->present = start;
    /* Later settings win: the base (in the start), the axes in order, then --set. */
    *run = start->run;
    for (int i = 0; i < s->naxis; i++) {
        const struct setting_list *list = &s->axis[i].point[x->point[i]];
        for (int j = 0; j < list->n; j++) setting_apply(&list->at[j], run, x->plan->arena);
    }
    for (int i = 0; i < s->set.n; i++) setting_apply(&s->set.at[i], run, x->plan->arena);
    if (!resolve_program(x, run)) return -1;
    const int keep = wanted(x, run);
    if (keep <= 0) return keep;
    machine_changes_note(&x->changes, run);
    name_run(x, run, &start->file);
    if (!resolve_path(x, run)) return -1;
    identity_set(x->identity, run, x->plan->arena);
    note_refusal(x, run);
    return 1;
}

/* The next point; false behind the last. */
static bool advance(struct expansion *x)
{
    /* As an odometer: the last axis turns fastest. */
    for (int i = x->scenario->naxis - 1; i >= 0; i--) {
        if (++x->point[i] < x->scenario->axis[i].npoint) return true;
        x->point[i] = 0;
    }
    return false;
}

/* The number of the present point, of all axes or of those that are not searched. */
static int64_t point_number(const struct expansion *x, bool all)
{
    int64_t number = 0;
    /* the last axis counts ones, as in the odometer */
    for (int i = 0; i < x->scenario->naxis; i++)
        if (all || !x->scenario->axis[i].searched)
            number = number * x->scenario->axis[i].npoint + x->point[i];
    return number;
}

/* Of a search: the point of the other axes becomes the next group, unless it is one already. */
static int group_of(struct expansion *x, int64_t *outer)
{
    struct plan *p = x->plan;
    if (x->scenario->search == NULL) return 0;
    /* what is searched makes no difference between groups */
    const int64_t number = point_number(x, false);
    /* the latest first: it is that one unless a searched axis is slower than another */
    for (int i = p->ngroup - 1; i >= 0; i--)
        if (outer[i] == number) return i;
    outer[p->ngroup] = number;
    return p->ngroup++;
}

/* All points in order; repetitions of one follow each other. */
static bool expand_points(struct expansion *x, int64_t capacity)
{
    struct plan *p = x->plan;
    struct run_spec *run = TAKE(p->arena, capacity, struct run_spec);
    int64_t *outer = x->scenario->search != NULL ? TAKE(p->arena, capacity, int64_t) : NULL;
    p->run = run;
    p->point = TAKE(p->arena, capacity, int64_t);
    p->group = TAKE(p->arena, capacity, int);
    p->memory->start_of = TAKE(p->arena, capacity, struct start *);
    do {
        int made = make_point(x, &run[p->nrun]);
        if (made < 0) return false;
        if (made == 0) continue;
        /* Without anything random all repetitions would be the same run. */
        const bool repeats = run_spec_is_random(&p->run[p->nrun]) && !p->run[p->nrun].refused;
        const int repetitions = repeats ? x->scenario->repetitions : 1, group = group_of(x, outer);
        for (int rep = 0; rep < repetitions; rep++) {
            if (rep > 0) run[p->nrun + rep] = run[p->nrun];
            run[p->nrun + rep].rep = rep;
            p->point[p->nrun + rep] = point_number(x, true);
            p->group[p->nrun + rep] = group;
            p->memory->start_of[p->nrun + rep] = x->present;
        }
        p->nrun += repetitions;
    } while (advance(x));
    /* Nothing can run: that is an error, not a plan. */
    if (p->nrun > 0 && p->nrefused == p->nrun) {
        *x->err = p->refusal;
        return false;
    }
    if (p->nrun > 0) return true;
    return err_set_at(x->err, ERR_CONFIG, x->scenario->path, 0,
                      "%s excludes all runs", x->scenario->ncondition > 1 ? "'only' with all its "
                                                                            "conditions"
                      : x->scenario->condition[0].line == 0 ? "--only" : "'only'");
}

/* The product of all axes and repetitions, filtered by `only`. */
bool expand_runs(struct plan *p, const struct scenario *s, struct err *e)
{
    struct expansion x = {.plan = p, .scenario = s, .err = e, .changes = {.arena = p->arena},
                          .calls = {.arena = p->arena}};
    int64_t n = s->repetitions;
    int ntable;
    /* Counted before anything is built: a few lines can ask for any number of runs. The count stops
     * growing long before it overflows. */
    for (int i = 0; i < s->naxis && n < INT64_MAX / SCENARIO_MAX_POINTS; i++)
        n *= s->axis[i].npoint;
    if (n > MAX_RUNS)
        return err_set_at(e, ERR_CONFIG, s->path, 0,
                          "the sweep has %s%lld runs; expected at most %d: make it smaller, or "
                          "split it into several scenarios",
                          n < INT64_MAX / SCENARIO_MAX_POINTS ? "" : "more than ", (long long)n,
                          MAX_RUNS);
    const struct field_table *const *table = field_tables(&ntable);
    x.identity = identity_create(table, ntable);
    p->memory = TAKE(p->arena, 1, struct plan_memory);
    bool fine = expand_points(&x, n);
    identity_destroy(x.identity);
    p->search = s->search;
    p->memory->scenario = s;
    p->memory->starts = x.starts;
    return fine;
}

struct machine_file *expand_machine(const struct plan *p, int index)
{
    return &p->memory->start_of[index]->whole;
}

/* The point is set as the odometer was, and made once more with the further settings behind all
 * others. What it counts is not the plan's. */
bool plan_vary(struct plan *p, int index, int n, const char *const *key, const char *const *text,
               struct run_spec *run, struct err *e)
{
    struct scenario s = *p->memory->scenario;
    struct plan counts = *p;
    struct expansion x = {.plan = &counts, .scenario = &s, .err = e, .starts = p->memory->starts,
                          .changes = {.arena = p->arena}, .calls = {.arena = p->arena}};
    int ntable;
    /* the odometer as it stood when the point was made */
    int64_t number = p->point[index];
    for (int i = s.naxis - 1; i >= 0; i--) {
        x.point[i] = (int)(number % s.axis[i].npoint);
        number /= s.axis[i].npoint;
    }
    /* a list of its own, behind which the further settings stand */
    struct setting_list set = {0};
    for (int i = 0; i < s.set.n; i++)
        if (!setting_list_add(&set, s.set.at[i].key, s.set.at[i].text, s.set.at[i].file, 0,
                              p->arena, e))
            return false;
    for (int i = 0; i < n; i++)
        if (!setting_list_add(&set, key[i], text[i], "optimise", 0, p->arena, e)) return false;
    s.set = set;
    s.ncondition = 0;
    const struct field_table *const *table = field_tables(&ntable);
    x.identity = identity_create(table, ntable);
    /* conditions were asked when the plan was made */
    const int made = make_point(&x, run);
    identity_destroy(x.identity);
    run->rep = p->run[index].rep;
    return made == 1;
}

/* ---- what does not act */

/* Why a setting acts in no run, NULL when it acts in one. */
static const char *why_idle(const struct plan *p, const struct setting *s)
{
    const char *why = NULL;
    if (s->kind != SETTING_FIELD || s->field->idle == NULL) return NULL;
    for (int i = 0; i < p->nrun; i++)
        if ((why = s->field->idle(&p->run[i])) == NULL) return NULL;
    return why;
}

/* One remark per key and reason. */
static void add_unused(struct plan *p, const char *key, const char *why)
{
    struct text t = {0};
    text_add(&t, "%s: %s", key, why);
    for (int i = 0; i < p->nunused && t.s != NULL; i++)
        if (strcmp(p->unused[i], t.s) == 0) text_free(&t);
    if (t.s != NULL) p->unused[p->nunused++] = arena_text(p->arena, t.s);
    text_free(&t);
}

static void add_unused_of(struct plan *p, const struct setting_list *list)
{
    for (int i = 0; i < list->n; i++) {
        const char *why = why_idle(p, &list->at[i]);
        if (why != NULL) add_unused(p, list->at[i].key, why);
    }
}

/* Settings that act in no run of the plan are told: a solver of a program that has none is
 * usually a mistake. */
void expand_unused(struct plan *p, const struct scenario *s)
{
    int ntable, n = 1;
    bool random = false;
    const struct field_table *const *table = field_tables(&ntable);
    for (int i = 0; i < ntable; i++) n += table[i]->nfield;
    p->unused = TAKE(p->arena, n, const char *);
    add_unused_of(p, &s->base);
    for (int i = 0; i < s->naxis; i++)
        for (int j = 0; j < s->axis[i].npoint; j++) add_unused_of(p, &s->axis[i].point[j]);
    add_unused_of(p, &s->set);
    for (int i = 0; i < p->nrun && !random; i++) random = run_spec_is_random(&p->run[i]);
    if (s->repetitions > 1 && !random)
        add_unused(p, "repetitions", "nothing is random in these runs, so each is made once");
}

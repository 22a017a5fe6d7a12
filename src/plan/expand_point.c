/* expand_point.c - one point of a plan: its settings in order, its machine, its P and n, its
 * identity (expand_parts.h).
 *
 * A run starts as a copy of what holds for all runs on its machine, so a large sweep costs a copy
 * and a few settings a run; the texts of a struct that did not change since the run before are not
 * printed again (identity.h). */
#include <string.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/text.h"
#include "plan/condition.h"
#include "plan/expand_parts.h"
#include "plan/file_kind.h"
#include "plan/program_file.h"

/* A run's settings are 5 KB of text as a rule; those of all runs may have as much beyond that. */
enum { MAX_BODIES = 1 << 27, USUAL_TEXT_BYTES = 8192, MOST_TEXT_BYTES = 1 << 26 };

/* The last setting that matches, NULL when there is none. */
static const struct setting *last_of(const struct expansion *x,
                                     bool (*matches)(const struct setting *))
{
    const struct setting_list *list[EXPAND_LISTS];
    int n = expand_lists(x, list);
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
    run_spec_defaults(&s->run, a);
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
    const struct setting *ranks = last_of(x, is_ranks), *bodies = last_of(x, is_bodies);
    const struct machine_spec *m = &run->machine;
    int64_t n = machine_spec_processors(m);
    CHECK(ranks != NULL); /* a plan without them is refused before its points are made */
    /* `ranks: n`: the place to change is that of n. */
    if (ranks->kind == SETTING_RANKS_ARE_N && bodies != NULL) ranks = bodies;
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
bool expand_path(struct expansion *x, struct run_spec *run)
{
    char path[2 * sizeof run->model.path];
    const struct model_spec *m = &run->model;
    struct text file = {0};
    bool from_file = m->generator == MODEL_URDF || m->generator == MODEL_VECTOR;
    /* Of jobs it is found before their combinations are made. */
    if (!from_file || run->model_file[0] != '\0') return true;
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
static void refuse_run(struct expansion *x, struct run_spec *run, const struct err *why)
{
    struct plan *p = x->plan;
    /* The first reason is told when no point can run. */
    if (p->nrefused++ == 0) p->refusal = *why;
    char place[sizeof why->file + 24] = "";
    if (why->line > 0) snprintf(place, sizeof place, "%s:%d: ", why->file, why->line);
    else if (why->file[0]) snprintf(place, sizeof place, "%s: ", why->file);
    struct text t = {0};
    text_add(&t, "%s%s", place, why->text);
    run->refused = arena_text(p->arena, t.s);
    run->refused_kind = why->kind;
    text_free(&t);
}

/* check_fits writes to x->err: for its time that is `why`. Jobs are asked about together
 * (expand_jobs.c). */
static void note_refusal(struct expansion *x, struct run_spec *run)
{
    struct err why, *others = x->err;
    err_clear(&why);
    x->err = &why;
    bool fits = check_fits(x, run);
    x->err = others;
    fits = fits && (run->jobs != NULL || expand_fits(x, &run->machine, run->nrank, NULL, &why));
    if (x->room != NULL) refuse_run(x, run, x->room);
    else if (!fits) refuse_run(x, run, &why);
}

/* A program's n stands for n, so its parameters follow when n is known. */
static bool resolve_program(struct expansion *x, struct run_spec *run)
{
    const struct setting_list *list[EXPAND_LISTS];
    const int n = expand_lists(x, list);
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

bool expand_spec(struct expansion *x, struct run_spec *run)
{
    const struct setting_list *list[EXPAND_LISTS];
    const int n = expand_lists(x, list);
    struct start *start = start_of(x);
    if (start == NULL) return false;
    x->present = start;
    *run = start->run;
    /* The first list is the base, which the start has already. */
    for (int i = 1; i < n; i++)
        for (int j = 0; j < list[i]->n; j++) setting_apply(&list[i]->at[j], run, x->plan->arena);
    return resolve_program(x, run);
}

/* A list of many numbers is a part of what each run is, and so are the settings of all jobs beside
 * it: they are kept, and made into a digest, once for every run. */
static bool check_texts(struct expansion *x, const struct run_spec *run)
{
    const size_t own = strlen(run->config_text);
    if (own > USUAL_TEXT_BYTES) x->text_bytes += own - USUAL_TEXT_BYTES;
    return x->text_bytes <= MOST_TEXT_BYTES ||
           err_set(x->err, ERR_CONFIG,
                   "%s: the lists of all runs, and the jobs beside each, take more than %d MiB of "
                   "text: make the sweep or the lists smaller, or split it into several scenarios",
                   x->scenario->path, MOST_TEXT_BYTES >> 20);
}

int expand_finish(struct expansion *x, struct run_spec *run)
{
    const int keep = wanted(x, run);
    if (keep <= 0) return keep;
    machine_changes_note(&x->changes, run);
    name_run(x, run, &x->present->file);
    if (!expand_path(x, run)) return -1;
    identity_set(x->identity, run, x->plan->arena);
    if (!check_texts(x, run)) return -1;
    note_refusal(x, run);
    return 1;
}

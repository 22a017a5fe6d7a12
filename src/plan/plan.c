/* plan.c - the face of the room: a scenario to runs, a machine to values with their origins,
 * lists, checks.
 *
 * Everything that a user may have written wrongly is found here, before anything runs: after
 * plan_read every run is complete, checked and identified. */
#include "plan/plan.h"

#include <string.h>

#include "plan/data_dir.h"
#include "plan/expand.h"
#include "plan/file_kind.h"
#include "plan/machine_file.h"
#include "plan/program_file.h"
#include "plan/scenario_file.h"
#include "spec/spec_fields.h"

/* Whether every name of a program in the list is known; else the nearest one is told. */
static bool kernels_exist(const struct setting_list *list, const struct plan_options *o,
                          struct err *e)
{
    for (int i = 0; i < list->n; i++) {
        const struct setting *s = &list->at[i];
        /* only settings that name a program */
        bool known = strcmp(s->key, "kernel.name") != 0;
        for (int k = 0; !known && k < o->nkernel; k++) known = strcmp(s->text, o->kernel[k]) == 0;
        if (known) continue;
        return err_set_at(e, ERR_DATA, s->file, s->line,
                          "no kernel is called '%.80s'%s; `mimdsim kernels` lists them", s->text,
                          text_hint(s->text, o->kernel, o->nkernel, "").s);
    }
    return true;
}

/* Kernels are built in above this room, so their names come with the options. */
static bool all_kernels_exist(struct scenario *s, const struct plan_options *o, struct arena *a,
                              struct err *e)
{
    /* Without a list nobody wants to know. */
    if (o == NULL || o->nkernel == 0) return true;
    struct setting_list **list;
    const int n = scenario_lists(s, a, &list);
    for (int i = 0; i < n; i++)
        if (!kernels_exist(list[i], o, e)) return false;
    return true;
}

/* Whether values of the setting sort and align as numbers: those with units are texts. */
static bool is_number(const struct setting *s)
{
    if (s->field == NULL) return s->kind == SETTING_N_OVER_P;
    enum field_kind kind = s->field->kind;
    /* With a unit the text is printed as it was written, "64 KiB": as a number it would lose the
     * unit. */
    bool plain =
        kind == FIELD_REAL || kind == FIELD_INT || kind == FIELD_INT64 || kind == FIELD_SEED;
    return plain && s->field->unit == UNIT_NONE;
}

/* Keys of a point that are not listed yet. */
static void add_swept(struct plan *p, const struct setting_list *list)
{
    for (int i = 0; i < list->n; i++) {
        int k = 0;
        /* Linear search: a scenario varies a few keys only. */
        while (k < p->nswept && strcmp(p->swept[k].key, list->at[i].key) != 0) k++;
        if (k == p->nswept)
            p->swept[p->nswept++] = (struct plan_swept){list->at[i].key, is_number(&list->at[i])};
    }
}

/* The keys that vary, in the order of the file: tables have a column for each. */
static void list_swept(struct plan *p, const struct scenario *s)
{
    int n = 0;
    for (int i = 0; i < s->naxis; i++)
        for (int j = 0; j < s->axis[i].npoint; j++) n += s->axis[i].point[j].n;
    /* room for all settings of all points, though most are of the same keys, and for two of jobs */
    p->swept = TAKE(p->arena, n + 2 + 1, struct plan_swept);
    if (s->jobs != NULL) {
        p->swept[p->nswept++] = (struct plan_swept){"job.name", false};
        p->swept[p->nswept++] = (struct plan_swept){"job.beside", false};
    }
    for (int i = 0; i < s->naxis; i++)
        for (int j = 0; j < s->axis[i].npoint; j++) add_swept(p, &s->axis[i].point[j]);
}

/* From the scenario to its runs. Names are checked first, so that a mistake costs no expansion. */
static bool fill(struct plan *p, struct scenario *s, const struct plan_options *o,
                 struct err *e)
{
    /* Values of parameters are checked before the expansion, which takes them as right. */
    if (!all_kernels_exist(s, o, p->arena, e) || !program_file_check(s, p->arena, e)) return false;
    s->fits = o != NULL ? o->fits : NULL;
    s->identity = o != NULL ? o->identity : NULL;
    text_copy(p->name, sizeof p->name, s->stem);
    p->question = s->question;
    p->figure = s->figure;
    p->nfigure = s->nfigure;
    if (!expand_runs(p, s, e)) return false;
    expand_unused(p, s);
    list_swept(p, s);
    return true;
}

/* Everything of the plan lives in its arena; a failed plan is empty. */
bool plan_read(struct plan *p, const char *name, const struct plan_options *o, struct err *e)
{
    *p = (struct plan){.arena = arena_create()};
    /* It lives as long as the plan, which can make points again (plan_vary). */
    struct scenario *s = TAKE(p->arena, 1, struct scenario);
    if (scenario_file_read(s, name, o, p->arena, e) && fill(p, s, o, e)) return true;
    /* Perhaps it is a file of another kind: then that is told instead. The plan is emptied first,
     * so that a caller may free it whatever happened. */
    plan_free(p);
    file_kind_refuse(name, FILE_SCENARIO, e);
    return false;
}

void plan_free(struct plan *p)
{
    arena_destroy(p->arena);
    *p = (struct plan){0};
}

/* Whether the machine can be built, for one rank. */
static bool machine_fits(const struct machine_file *m, const char *path,
                         const struct plan_options *o, struct err *e)
{
    int64_t work = EXPAND_WORK;
    if (o == NULL || o->fits == NULL || o->fits(&m->spec, 1, NULL, &work, e)) return true;
    if (machine_file_blame(m, e) < 0 || e->line == 0) text_copy(e->file, sizeof e->file, path);
    return false;
}

/* As `run` would read the file, without running. A file of neither kind is read as a scenario,
 * whose messages say what is missing. */
bool plan_check_file(const char *path, const struct plan_options *o, struct err *e)
{
    /* A program, a machine or a scenario, by name and content. */
    struct plan p = {.arena = arena_create()};
    struct scenario s;
    struct machine_file m;
    struct plan_options programs = {0};
    /* Only what reads programs: --set and --machine are not the file's. */
    if (o != NULL) programs.program = o->program, programs.program_context = o->program_context;
    if (program_file_is(path)) {
        const bool made = scenario_file_read(&s, path, &programs, p.arena, e);
        plan_free(&p);
        return made;
    }
    /* Settings of --set are not applied: the file alone is checked. */
    struct node *root = document_read_settings(path, p.arena, e);
    bool fine = root != NULL;
    if (fine && file_kind_of_tree(root) == FILE_MACHINE) {
        struct text as_path = {0};
        /* "./" in front: a name without a slash would be looked up among the shipped machines. */
        text_add(&as_path, "%s%s", strchr(path, '/') == NULL ? "./" : "", path);
        fine = machine_file_read(&m, as_path.s, NULL, p.arena, e) && machine_fits(&m, path, o, e);
        text_free(&as_path);
    } else if (fine) {
        fine = scenario_file_tree(&s, root, path, &programs, p.arena, e) && fill(&p, &s, o, e);
        /* A point that cannot run is an error of the file, which `run` would only report. */
        if (fine && p.nrefused > 0) *e = p.refusal, fine = false;
    }
    plan_free(&p);
    return fine;
}

/* ---- machines */

/* --set of a machine alone: keys begin with "machine." */
static bool set_machine(struct machine_file *m, const char *set, struct arena *a, struct err *e)
{
    /* No equals sign, or no key before it. */
    const char *equals = strchr(set, '='), *full;
    struct setting s;
    struct run_spec run;
    if (equals == NULL || equals == set)
        return err_set(e, ERR_USAGE, "--set '%.80s': expected key=value", set);
    char *name = arena_text(a, set);
    name[equals - set] = '\0';
    full = setting_key(name);
    if (!setting_make(&s, name, arena_text(a, equals + 1), "--set", 0, a, e)) return false;
    if (strncmp(full, "machine.", 8) != 0 || s.kind != SETTING_FIELD)
        return err_set_at(e, ERR_DATA, "--set", 0, "%s: not a setting of a machine", name);
    /* By way of a run: settings apply to runs. */
    run.machine = m->spec;
    setting_apply(&s, &run, a);
    m->spec = run.machine;
    /* The value comes from the command line from now on, without evidence. */
    m->value[field_find(&machine_table, full + 8)] =
        (struct machine_value){.text = s.text, .file = "--set", .evidence = "", .source = ""};
    return machine_file_check(&m->spec, "--set", 0, e);
}

/* A value for people, with where it comes from. */
static struct origin origin_make(const char *key, const char *value, const struct machine_value *v)
{
    return (struct origin){.key = key,
                           .value = value,
                           .file = v->file,
                           .line = v->line,
                           .evidence = v->evidence,
                           .source = v->source,
                           .validate = v->validate != NULL ? v->validate : "",
                           .min = v->min,
                           .max = v->max};
}

/* All values of the machine in the order of the table, then its published figures. */
static int list_origins(const struct machine_file *m, struct origin *list, struct arena *a)
{
    int n = 0;
    /* One origin for each field of the table, whether the file gives it or it is a default. */
    for (int i = 0; i < machine_table.nfield; i++) {
        struct text t = {0};
        field_show(&machine_table.field[i], &m->spec, &t);
        list[n++] = origin_make(machine_table.field[i].key, arena_text(a, t.s != NULL ? t.s : ""),
                                &m->value[i]);
        text_free(&t);
    }
    for (int i = 0; i < m->npublished; i++) {
        struct text t = {0};
        text_add(&t, "published.%s", m->published[i].name);
        list[n++] =
            origin_make(arena_text(a, t.s), m->published[i].value.text, &m->published[i].value);
        text_free(&t);
    }
    return n;
}

/* A machine without a scenario. The origins are listed after --set, so that they say "--set". */
bool plan_machine(struct machine_spec *m, const char *name, const struct plan_options *o,
                  struct arena *a, struct origin **origin, int *norigin, struct err *e)
{
    struct machine_file file;
    if (!machine_file_read(&file, name, NULL, a, e)) {
        file_kind_refuse(name, FILE_MACHINE, e);
        return false;
    }
    /* In the order of the command line: the last setting of a key counts. */
    for (int i = 0; o != NULL && i < o->nset; i++)
        if (!set_machine(&file, o->set[i], a, e)) return false;
    *m = file.spec;
    if (origin == NULL) return true;
    *origin = TAKE(a, machine_table.nfield + file.npublished, struct origin);
    /* texts live in the caller's arena */
    *norigin = list_origins(&file, *origin, a);
    return true;
}

/* Runs follow each other by machine, so the list is made anew only where the machine changes; it is
 * remembered in the file itself. */
void plan_origins(const struct plan *p, int index, const struct origin **origin, int *n)
{
    struct machine_file *m = expand_machine(p, index);
    if (m->origin == NULL) {
        m->origin = TAKE(p->arena, machine_table.nfield + m->npublished, struct origin);
        m->norigin = list_origins(m, m->origin, p->arena);
    }
    *origin = m->origin;
    *n = m->norigin;
}

const struct machine_spec *plan_machine_file(const struct plan *p, int index)
{
    return &expand_machine(p, index)->spec;
}

/* ---- lists */

/* The title of a machine or the question of a scenario; of a file that cannot be read, why. */
static const char *title_of(const char *what, const char *name, struct arena *a)
{
    struct err e;
    err_clear(&e);
    const char *path = data_dir_find(what, name, NULL, a, &e);
    struct node *root = path != NULL ? document_read_settings(path, a, &e) : NULL;
    const struct node *n = NULL;
    if (root != NULL)
        n = document_find(root, strcmp(what, "machines") == 0 ? "title" : "question");
    if (n != NULL && n->text != NULL) return n->text;
    return root != NULL ? "" : arena_text(a, e.text);
}

bool plan_list(const char *what, struct arena *a, const char ***stem, const char ***title, int *n,
               struct err *e)
{
    *stem = data_dir_names(what, a, n);
    *title = TAKE(a, *n + 1, const char *);
    /* None at all means that the data directory is wrong, not that the list is empty. */
    if (*n == 0) return err_set(e, ERR_NO_INPUT, "no %s in %s/%s", what, plan_data_dir(), what);
    for (int i = 0; i < *n; i++) (*title)[i] = title_of(what, (*stem)[i], a);
    return true;
}

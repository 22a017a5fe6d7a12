/* program_file.c - see program_file.h.
 *
 * A program declares its parameters: they become keys like any other, with ranges, units and
 * nearest names. To know them the program must be opened before the scenario is read. */
#include "plan/program_file.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/check.h"
#include "base/text.h"
#include "plan/data_dir.h"
#include "spec/field.h"

enum { MOST_BODIES = 1 << 27 };

/* A program of the scenario, by the name under which its settings know it. */
struct scenario_program {
    const char *name;
    const struct program_sheet *sheet; /* what it declares, kind and hash */
};

/* --- which files ------------------------------------------------------------------------------ */

/* With its dot; a dot in a folder's name is none. */
static const char *ending_of(const char *name)
{
    const char *slash = strrchr(name, '/'), *dot = strrchr(name, '.');
    return dot != NULL && dot > (slash != NULL ? slash : name) ? dot : "";
}

/* Images have any name, so their first bytes tell. */
static bool is_elf(const char *path)
{
    char head[4] = "";
    struct err unread = {0};
    FILE *f = text_open_file(path, &unread);
    const bool yes = f != NULL && fread(head, 1, 4, f) == 4 && memcmp(head, "\177ELF", 4) == 0;
    if (f != NULL) fclose(f);
    return yes;
}

/* By its ending, or by its content where it has none that is known. */
bool program_file_is(const char *name)
{
    static const char *const ending[] = {".c",   ".cc",  ".cpp", ".cxx", ".C",   ".f",    ".F",
                                         ".f90", ".F90", ".f95", ".f03", ".f08", ".goal", ".so"};
    for (size_t i = 0; i < sizeof ending / sizeof *ending; i++)
        if (strcmp(ending_of(name), ending[i]) == 0) return true;
    return is_elf(name);
}

/* A program alone is a scenario of its own: a few numbers of ranks on a well-known machine. */
struct node *program_file_scenario(const char *name, struct arena *a, struct err *e)
{
    /* A quoted name of YAML: a quote in it is doubled. */
    struct text t = {0};
    text_add(&t, "schema_version: 1\nmachine: t3e-300\nranks: [1, 2, 4, 8, 16]\nprogram: '");
    for (const char *s = name; *s != '\0'; s++) text_add(&t, *s == '\'' ? "''" : "%c", *s);
    text_add(&t, "'\n");
    struct node *root = document_parse_settings(t.s, t.length, name, a, e);
    text_free(&t);
    return root;
}

/* What is being collected, and what is needed to open it. */
struct collection {
    struct scenario *scenario; /* whose programs are opened */
    const struct plan_options *options; /* who opens programs, and whether any may be */
    struct arena *arena;
    struct err *err;
};

/* Whether the file at `path` lies below folder `dir`, links and ".." resolved. */
static bool lies_in(const char *path, const char *dir)
{
    char file[PATH_MAX], folder[PATH_MAX];
    /* Both are resolved, or a link inside the folder could lead out of it. */
    if (realpath(path, file) == NULL || realpath(dir[0] != '\0' ? dir : ".", folder) == NULL)
        return false;
    const size_t n = strlen(folder);
    return strncmp(file, folder, n) == 0 && (file[n] == '/' || (n == 1 && folder[0] == '/'));
}

/* The file that `name` means: of the command line as a shell takes it, of a scenario from its
 * folder. */
static const char *path_of(const struct collection *x, const char *name, bool typed)
{
    const char *dir = x->scenario->dir;
    if (typed || name[0] == '/' || dir[0] == '\0') return name;
    struct text t = {0};
    text_add(&t, "%s/%s", dir, name);
    const char *path = arena_text(x->arena, t.s);
    text_free(&t);
    return path;
}

/* A scenario may come from a stranger: it must not name programs elsewhere on this computer. */
static bool refuse_outside(const struct collection *x, const char *name, int line)
{
    return err_set_at(
        x->err, ERR_DATA, x->scenario->path, line,
        "program '%.120s' lies outside the scenario's folder; a program runs with all your rights, "
        "so read it first and then add --allow-programs",
        name);
}

/* One program of the scenario, opened once however often it is named. */
static bool add_program(struct collection *x, const char *name, bool typed, int line)
{
    struct scenario *s = x->scenario;
    const char *file = typed ? "--set" : s->path, *path = path_of(x, name, typed);
    /* The name is the key, not the file: settings refer to the name. */
    for (int i = 0; i < s->nprogram; i++)
        if (strcmp(s->program[i].name, name) == 0) return true;
    if (s->nprogram == SCENARIO_MAX_PROGRAMS)
        return err_set_at(x->err, ERR_DATA, file, line, "more than %d programs",
                          SCENARIO_MAX_PROGRAMS);
    /* In this order: does it exist, may it be used, can this verb use it, is it a file, does it
     * open. */
    if (access(path, F_OK) != 0)
        return err_set_at(x->err, ERR_NO_INPUT, file, line,
                          "program '%.120s': there is no such file", path);
    if (!typed && !x->options->allow_programs && !lies_in(path, s->dir))
        return refuse_outside(x, name, line);
    if (x->options->program == NULL)
        return err_set_at(x->err, ERR_USAGE, file, line, "this verb takes no programs of your own");
    /* A compiler would wait for what a pipe has to say, for ever. */
    FILE *in = text_open_file(path, x->err);
    if (in == NULL) return false;
    fclose(in);
    const struct program_sheet *sheet =
        x->options->program(x->options->program_context, path, x->arena, x->err);
    if (sheet == NULL) return false;
    if (s->program == NULL)
        s->program = TAKE(x->arena, SCENARIO_MAX_PROGRAMS, struct scenario_program);
    s->program[s->nprogram++] = (struct scenario_program){name, sheet};
    return true;
}

/* All names below a node that says which program: a scalar, a list, a mapping with `file`. */
static bool add_names(struct collection *x, const struct node *n)
{
    if (n->kind == NODE_TEXT)
        return n->text[0] == '\0' || add_program(x, n->text, x->scenario->typed, n->line);
    for (const struct node *c = n->child; c != NULL; c = c->next)
        if ((n->kind == NODE_LIST || strcmp(c->key, "file") == 0) && !add_names(x, c))
            return false;
    return true;
}

/* Wherever in the tree it may stand: at the top, in a sweep, in a variant. */
static bool add_tree(struct collection *x, const struct node *n)
{
    const bool names =
        n->key != NULL && (strcmp(n->key, "program") == 0 || strcmp(n->key, "program.file") == 0);
    if (names) return add_names(x, n);
    for (const struct node *c = n->child; c != NULL; c = c->next)
        if (!add_tree(x, c)) return false;
    return true;
}

/* --set program=a.c,b.c: the text behind the equals sign, NULL: it sets something else. */
static const char *set_names(const char *set)
{
    static const char *const key[] = {"program=", "program.file="};
    for (int i = 0; i < 2; i++)
        if (strncmp(set, key[i], strlen(key[i])) == 0) return set + strlen(key[i]);
    return NULL;
}

/* All programs that the scenario names, opened. It needs no order of keys: the tree is searched
 * first. */
bool program_file_collect(struct scenario *s, struct node *root, const struct plan_options *o,
                          struct arena *a, struct err *e)
{
    static const struct plan_options none;
    struct collection x = {s, o != NULL ? o : &none, a, e};
    bool replaced = false;
    /* The command line takes the place of what the file says, which is then not looked at. */
    for (int i = 0; o != NULL && i < o->nset; i++) {
        /* Only the program itself counts here: its parameters are settings like others, read
         * later. */
        const char *names = set_names(o->set[i]);
        if (names == NULL) continue;
        replaced = true;
        char *list = arena_text(a, names), *rest = list;
        /* A list may stand in brackets, as in a scenario. */
        if (list[0] == '[') list[strcspn(list, "]")] = '\0', rest++;
        for (char *name; (name = strsep(&rest, ",")) != NULL;) {
            name += strspn(name, " ");
            if (name[0] != '\0' && !add_program(&x, name, true, 0)) return false;
        }
    }
    return replaced || add_tree(&x, root);
}

/* One that is made for a number of ranks runs on these, where nobody says otherwise. */
void program_file_ranks(const struct scenario *s, struct node *root, struct arena *a)
{
    const int nrank = s->nprogram > 0 ? s->program[0].sheet->nrank : 0;
    struct node *ranks = document_find(root, "ranks");
    char text[16];
    if (nrank == 0 || ranks == NULL) return;
    snprintf(text, sizeof text, "%d", nrank);
    ranks->kind = NODE_TEXT;
    ranks->text = arena_text(a, text);
    ranks->child = NULL;
    ranks->count = 0;
}

void program_file_entitle(struct scenario *s, struct arena *a)
{
    char *stem = arena_text(a, s->stem);
    stem[strlen(stem) - strlen(ending_of(stem))] = '\0';
    s->stem = stem;
    s->question = s->nprogram > 0 ? s->program[0].sheet->title : "";
}

/* --- keys ------------------------------------------------------------------------------------- */

/* Whether some program of the scenario has a parameter of this name. */
static bool is_declared(const struct scenario *s, const char *name)
{
    /* Programs share the names of parameters: any of them will do. */
    for (int i = 0; i < s->nprogram; i++)
        if (program_sheet_find(s->program[i].sheet, name) != NULL) return true;
    return false;
}

/* The whole key of a short name, "chunk" for "program.chunk"; others as they are. */
const char *program_file_key(const struct scenario *s, const char *key, struct arena *a)
{
    /* Words of scenarios keep their meaning, but for n: the size of a problem is what it says. */
    const bool taken = strcmp(key, "n") != 0 && setting_is_key(setting_key(key));
    if (taken || !is_declared(s, key)) return key;
    struct text t = {0};
    text_add(&t, "program.%s", key);
    const char *full = arena_text(a, t.s);
    text_free(&t);
    return full;
}

/* Short names of parameters to their whole keys, in one mapping. */
static void rename_keys(const struct scenario *s, struct node *mapping, struct arena *a)
{
    for (struct node *n = mapping->child; n != NULL; n = n->next)
        if (n->key != NULL) n->key = program_file_key(s, n->key, a);
}

/* After this the scenario is read as any other. */
void program_file_rename(const struct scenario *s, struct node *root, struct arena *a)
{
    if (s->nprogram == 0) return;
    rename_keys(s, root, a);
    /* Keys occur at the top, in a sweep and in the points of variants. */
    struct node *sweep = document_find(root, "sweep");
    if (sweep != NULL) rename_keys(s, sweep, a);
    /* Jobs are mappings of settings, too. */
    const struct node *jobs = document_find(root, "jobs");
    for (struct node *n = jobs != NULL ? jobs->child : NULL; n != NULL; n = n->next)
        rename_keys(s, n, a);
    /* The points of `variant` are mappings of settings, at the top or in a sweep. */
    struct node *at[2] = {document_find(root, "variant"),
                               sweep != NULL ? document_find(sweep, "variant") : NULL};
    for (int i = 0; i < 2; i++)
        for (struct node *n = at[i] != NULL ? at[i]->child : NULL; n != NULL; n = n->next)
            rename_keys(s, n, a);
}

/* A key that is none may be a misspelt parameter: those are asked first. */
bool program_file_unknown(const struct scenario *s, const char *key, const char *file, int line,
                          struct err *e)
{
    const char *name[SCENARIO_MAX_PROGRAMS * 8];
    int n = 0, most = (int)(sizeof name / sizeof *name);
    /* The nearest name is looked for among all programs, since the misspelt one may belong to
     * any. */
    for (int i = 0; i < s->nprogram; i++)
        for (int j = 0; j < s->program[i].sheet->nparameter && n < most; j++)
            name[n++] = s->program[i].sheet->parameter[j].key;
    const char *near = text_nearest(key, name, n);
    if (near == NULL) return setting_unknown("", key, file, line, e);
    return err_set_at(e, ERR_DATA, file, line, "unknown key '%.120s'; did you mean '%s'?", key,
                      near);
}

/* --- values ----------------------------------------------------------------------------------- */

static const char *name_of(const struct setting *p) { return p->key + strlen("program."); }

/* A key below `program` that no program declares: what there is. */
static bool refuse_parameter(const struct scenario *s, const struct setting *p, struct err *e)
{
    /* keys below `program` that every program has */
    static const char *const own[] = {"file", "arguments", "cost", "factor"};
    const char *name[SCENARIO_MAX_PROGRAMS * 8];
    int n = 0, most = (int)(sizeof name / sizeof *name);
    if (s->nprogram == 0)
        return err_set_at(e, ERR_DATA, p->file, p->line,
                          "unknown key '%s': no program of your own is given (program: FILE)",
                          p->key);
    struct text all = {0};
    for (int i = 0; i < s->nprogram; i++)
        for (int j = 0; j < s->program[i].sheet->nparameter && n < most; j++) {
            name[n] = s->program[i].sheet->parameter[j].key;
            text_add(&all, "%s%s", n > 0 ? ", " : "", name[n]);
            n++;
        }
    for (size_t i = 0; i < 4 && n < most; i++) name[n++] = own[i];
    err_set_at(e, ERR_DATA, p->file, p->line, "program %s declares no parameter '%s'%s; it has %s",
               s->program[0].sheet->name, name_of(p), text_hint(name_of(p), name, n, "").s,
               all.s != NULL ? all.s : "none");
    text_free(&all);
    return false;
}

/* A value has to suit every program that declares its name. */
static bool check_setting(const struct scenario *s, struct setting *p, struct arena *a,
                          struct err *e)
{
    char why[256];
    if (p->kind != SETTING_PARAMETER) return true;
    for (int i = 0; i < s->nprogram; i++) {
        const struct field *f = program_sheet_find(s->program[i].sheet, name_of(p));
        /* another program declares it */
        if (f == NULL) continue;
        /* the last one: any will do for tables, all agree on the value */
        p->field = f;
        if (program_parameter_text(f, p->text, a, why, (int)sizeof why) == NULL)
            return err_set_at(e, ERR_DATA, p->file, p->line, "%s: '%.80s': %s (%s of program %s)",
                              p->key, p->text, why, f->doc, s->program[i].sheet->name);
    }
    return p->field != NULL || refuse_parameter(s, p, e);
}

static bool check_list(const struct scenario *s, struct setting_list *list, struct arena *a,
                       struct err *e)
{
    for (int i = 0; i < list->n; i++)
        if (!check_setting(s, &list->at[i], a, e)) return false;
    return true;
}

/* Every value against the programs that declare its name: in the base, in all points, in --set. */
bool program_file_check(struct scenario *s, struct arena *a, struct err *e)
{
    struct setting_list **list;
    const int n = scenario_lists(s, a, &list);
    for (int i = 0; i < n; i++)
        if (!check_list(s, list[i], a, e)) return false;
    return true;
}

/* The last setting of `key` at a point, NULL: there is none. */
static const struct setting *last_of(const struct setting_list *const *list, int n, const char *key)
{
    const struct setting *found = NULL;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < list[i]->n; j++)
            if (strcmp(list[i]->at[j].key, key) == 0) found = &list[i]->at[j];
    return found;
}

/* The sheet of the run's program; NULL: it has none of its own. */
static const struct program_sheet *sheet_of(const struct scenario *s, const struct run_spec *run)
{
    for (int i = 0; i < s->nprogram; i++)
        if (strcmp(s->program[i].name, run->program.file) == 0) return s->program[i].sheet;
    return NULL;
}

/* The value of parameter `f` at a point, in its canonical form. */
static const char *value_at(const struct field *f, const struct setting_list *const *list, int n,
                            struct arena *a)
{
    char key[64], why[256];
    snprintf(key, sizeof key, "program.%s", f->key);
    const struct setting *p = last_of(list, n, key);
    const char *value =
        program_parameter_text(f, p != NULL ? p->text : f->fallback, a, why, (int)sizeof why);
    CHECK(value != NULL); /* program_file_check has seen it, program_sheets are checked when made */
    return value;
}

/* The program of a point: its kind and hash are part of the run, its name takes the kernel's
 * place. */
bool program_file_choose(const struct scenario *s, struct run_spec *run,
                         const struct setting_list *const *list, int n, struct err *e)
{
    const struct program_sheet *sheet = sheet_of(s, run);
    const struct setting *file = last_of(list, n, "program.file"),
                         *kernel = last_of(list, n, "kernel.name");
    /* A built-in kernel is all there is. */
    if (run->program.file[0] == '\0') return true;
    CHECK(sheet != NULL && file != NULL);
    if (kernel != NULL)
        return err_set_at(
            e, ERR_DATA, file->file, file->line,
            "program '%.80s' and kernel '%.40s' (line %d) exclude each other; remove one",
            file->text, kernel->text, kernel->line);
    struct program_spec *p = &run->program;
    p->kind = sheet->kind;
    p->image = sheet->image;
    text_copy(p->hash, sizeof p->hash, sheet->hash);
    /* Names are compared as bytes: nothing of a longer one may stay behind. */
    memset(run->kernel.name, 0, sizeof run->kernel.name);
    text_copy(run->kernel.name, sizeof run->kernel.name, sheet->name);
    run->kernel.own = true;
    /* Its n is the n of tables and conditions. */
    const struct field *f = program_sheet_find(sheet, "n");
    struct arena *scratch = arena_create();
    const long long size =
        f != NULL && f->kind == FIELD_INT64 ? atoll(value_at(f, list, n, scratch)) : 0;
    if (size >= 1 && size <= MOST_BODIES) run->model.nbody = (int)size;
    arena_destroy(scratch);
    return true;
}

/* All parameters of the point's program, with defaults, as lines: they identify the run. */
bool program_file_parameters(const struct scenario *s, struct run_spec *run,
                             const struct setting_list *const *list, int n, struct arena *a,
                             struct err *e)
{
    const struct program_sheet *sheet = sheet_of(s, run);
    /* n_over_p fixes n, whatever its parameter says. */
    const struct setting *ratio = last_of(list, n, "n_over_p");
    if (run->program.file[0] == '\0' || sheet->nparameter == 0) return true;
    /* "name = value" lines, in the order of the declaration. */
    struct text lines = {0};
    for (int i = 0; i < sheet->nparameter; i++) {
        const struct field *f = &sheet->parameter[i];
        char made[24], why[256];
        const char *value = value_at(f, list, n, a);
        if (ratio != NULL && strcmp(f->key, "n") == 0) {
            snprintf(made, sizeof made, "%d", run->model.nbody);
            value = program_parameter_text(f, made, a, why, (int)sizeof why);
            if (value == NULL) {
                text_free(&lines);
                return err_set_at(e, ERR_DATA, ratio->file, ratio->line,
                                  "n_over_p gives n = %s: %s", made, why);
            }
        }
        program_lines_add(&lines, f->key, value);
    }
    run->program.parameters = arena_text(a, lines.s);
    text_free(&lines);
    return true;
}

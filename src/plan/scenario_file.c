/* scenario_file.c - scenarios/NAME.yaml: which keys there are at the top, lists as axes, and
 * --set on top.
 *
 * A list where a single value belongs is an axis of the sweep; the first axis in the file
 * changes slowest.
 *
 * Nothing is expanded here: a scenario is lists of settings, each with the line that it comes
 * from, and room for messages about any of them. */
#include "plan/scenario_file.h"

#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "plan/answer_file.h"
#include "plan/data_dir.h"
#include "plan/jobs_file.h"
#include "plan/program_file.h"
#include "plan/sample_file.h"
#include "plan/search_file.h"

/* Fields whose single value is a list: there a list is no sweep. */
static bool is_list_field(const char *key)
{
    const struct field_table *t;
    const struct field *f = field_find_full(key, &t);
    if (f == NULL) return false;
    return f->kind == FIELD_INTS || f->kind == FIELD_REALS || f->kind == FIELD_INT_LIST ||
           f->kind == FIELD_PAIR_LIST || f->kind == FIELD_SEGMENTS;
}

/* A list of pairs begins with "[[" by itself. */
static bool is_pair_list(const char *key)
{
    const struct field_table *t;
    const struct field *f = field_find_full(key, &t);
    return f != NULL && f->kind == FIELD_PAIR_LIST;
}

/* ---- axes */

/* For setting_walk: a value into the list that `context` is. */
static bool add_leaf(void *context, const char *key, const struct node *leaf, const char *file,
                     struct arena *a, struct err *e)
{
    const char *text = setting_value(key, leaf, file, a, e);
    return text != NULL && setting_list_add(context, key, text, file, leaf->line, a, e);
}

/* One point: a value of the axis's own key, or a mapping of settings below the group that the axis
 * names. */
static bool read_point(struct setting_list *point, const char *key, const char *group,
                       const struct node *node, const char *file, struct arena *a,
                       struct err *e)
{
    if (node->kind == NODE_MAP) {
        if (group == NULL)
            return err_set_at(e, ERR_DATA, file, node->line,
                              "sweep: '%s' takes values, not settings", key);
        return setting_walk(node, group, file, add_leaf, point, a, e);
    }
    if (key == NULL)
        return err_set_at(e, ERR_DATA, file, node->line,
                          "sweep: each variant is a mapping such as {kernel.solver: cr}");
    if (node->kind == NODE_LIST && !is_list_field(key))
        return err_set_at(e, ERR_DATA, file, node->line, "%s: a list within a list", key);
    const char *text = setting_value(key, node, file, a, e);
    return text != NULL && setting_list_add(point, key, text, file, node->line, a, e);
}

/* The group below which an axis's mappings set: kernel, model, machine; all for `variant`; NULL:
 * values only. */
static const char *axis_group(const char *name)
{
    if (strcmp(name, "variant") == 0) return "";
    bool group =
        strcmp(name, "kernel") == 0 || strcmp(name, "model") == 0 || strcmp(name, "machine") == 0 ||
        strcmp(name, "program") == 0;
    return group ? name : NULL;
}

/* A value that stands twice in a list is a slip of the pen: its runs would be the same runs. */
static bool check_twice(const struct scenario *s, const char *name, const struct node *n,
                        const struct node *list, struct err *e)
{
    if (n->kind != NODE_TEXT) return true;
    for (const struct node *other = list->child; other != n; other = other->next)
        if (other->kind == NODE_TEXT && strcmp(other->text, n->text) == 0)
            return err_set_at(e, ERR_DATA, s->path, n->line, "%s: '%.80s' stands twice in its list",
                              name, n->text);
    return true;
}

/* An axis from its list. It sets one key (values), or several below a group (mappings). */
static bool add_axis(struct scenario *s, const char *name, const struct node *list,
                     struct arena *a, struct err *e)
{
    /* What it sweeps: a key, a group, or both ("kernel" is a short name and a group). */
    const char *group = axis_group(name), *full = setting_key(name),
               *key = setting_is_key(full) ? full : NULL;
    if (key == NULL && group == NULL) return program_file_unknown(s, name, s->path, list->line, e);
    if (strcmp(full, "label") == 0)
        return err_set_at(e, ERR_DATA, s->path, list->line,
                          "%s: names alone are no sweep; give each variant its name: "
                          "'variant: [{name: fast links, machine.network.link.bandwidth: 1 GB/s}]'",
                          name);
    if (list->kind != NODE_LIST || list->count == 0)
        return err_set_at(e, ERR_DATA, s->path, list->line,
                          "sweep: '%s' needs a list such as [2, 4, 8]", name);
    for (int i = 0; i < s->naxis; i++)
        if (strcmp(s->axis[i].key, full) == 0)
            return err_set_at(e, ERR_DATA, s->path, list->line,
                              "duplicate key '%s'; first swept in line %d", full, s->axis[i].line);
    if (s->naxis == SCENARIO_MAX_AXES || list->count > SCENARIO_MAX_POINTS)
        return err_set_at(e, ERR_DATA, s->path, list->line, "too large a sweep");
    struct axis *x = &s->axis[s->naxis++];
    *x = (struct axis){.key = full, .line = list->line, .npoint = list->count};
    x->point = TAKE(a, list->count, struct setting_list);
    int i = 0;
    for (const struct node *n = list->child; n != NULL; n = n->next)
        if (!read_point(&x->point[i++], key, group, n, s->path, a, e) ||
            !check_twice(s, name, n, list, e))
            return false;
    return true;
}

/* ---- the file */

struct top {
    struct scenario *scenario; /* being read */
    struct arena *arena; /* of the scenario's texts */
    struct err *err; /* set by the first key that makes no sense */
};

/* A key at the top with a value that makes no sense. Returns false. */
static bool refuse(struct top *t, const struct node *n, const char *expected)
{
    return err_set_at(t->err, ERR_DATA, t->scenario->path, n->line, "%s: '%.80s': %s", n->key,
                      n->text != NULL ? n->text : "a list or mapping", expected);
}

static bool read_version(struct top *t, const struct node *n)
{
    return (n->text != NULL && strcmp(n->text, "1") == 0) ||
           refuse(t, n, "this program reads version 1");
}

static bool read_question(struct top *t, const struct node *n)
{
    if (n->text == NULL) return refuse(t, n, "expected one line of text");
    t->scenario->question = n->text;
    return true;
}

/* Through the checks of a field, for the same messages as everywhere. */
static bool read_repetitions(struct top *t, const struct node *n)
{
    static const struct field count = {
        .key = "repetitions", .kind = FIELD_INT, .min = 1, .max = 100000};
    char why[256] = "expected a whole number";
    if (n->text != NULL &&
        field_set(&count, &t->scenario->repetitions, n->text, NULL, why, (int)sizeof why))
        return true;
    return refuse(t, n, why);
}

/* Figures must exist: a misspelt one would show up at the end of the study. */
static bool read_figures(struct top *t, const struct node *n)
{
    struct scenario *s = t->scenario;
    if (n->kind != NODE_LIST) return refuse(t, n, "expected a list such as [fig5, fig6]");
    s->figure = TAKE(t->arena, n->count + 1, const char *);
    for (const struct node *f = n->child; f != NULL; f = f->next) {
        if (f->text == NULL || f->text[0] == '\0')
            return refuse(t, n, "expected a list such as [fig5, fig6]");
        if (!data_dir_has_figure(f->text, s->path, f->line, t->arena, t->err)) return false;
        s->figure[s->nfigure++] = f->text;
    }
    return true;
}

/* Points that do not satisfy it are left out. */
static bool read_condition(struct top *t, const struct node *n, const char *text)
{
    struct scenario *s = t->scenario;
    if (text == NULL)
        return refuse(t, n, "expected a condition such as 'n >= ranks', or a list of them");
    if (s->ncondition == SCENARIO_MAX_CONDITIONS)
        return refuse(t, n, "too many conditions; join some by 'and'");
    return condition_read(&s->condition[s->ncondition++], text, s->path, n->line, t->arena, t->err);
}

/* `only:` and `when:`, one condition or a list. */
static bool read_only(struct top *t, const struct node *n)
{
    if (n->kind == NODE_TEXT) return read_condition(t, n, n->text);
    for (const struct node *c = n->child; c != NULL; c = c->next)
        if (!read_condition(t, n, c->text)) return false;
    return n->kind == NODE_LIST || refuse(t, n, "expected a list of conditions");
}

/* A sample is an axis, too. */
static bool read_sample(struct top *t, const struct node *n)
{
    struct scenario *s = t->scenario;
    if (s->naxis == SCENARIO_MAX_AXES)
        return err_set_at(t->err, ERR_DATA, s->path, n->line, "too large a sweep");
    return sample_file_read(&s->axis[s->naxis++], n, s->path, t->arena, t->err);
}

static bool read_search(struct top *t, const struct node *n)
{
    return search_file_read(t->scenario, n, add_axis, t->arena, t->err);
}

static bool read_jobs(struct top *t, const struct node *n)
{
    return jobs_file_read(t->scenario, n, t->arena, t->err);
}

static bool read_combinations(struct top *t, const struct node *n)
{
    return jobs_file_combine(t->scenario, n, t->arena, t->err);
}

/* What the runs are compared by when they are there. Nothing of the plan depends on it, so that
 * runs that are stored already answer it, too. */
static bool read_answer(struct top *t, const struct node *n)
{
    return answer_file_read(t->scenario, n, t->arena, t->err);
}

static bool read_sweep(struct top *t, const struct node *n)
{
    if (n->kind != NODE_MAP) return refuse(t, n, "expected axes such as {n: [2, 4, 8]}");
    for (const struct node *c = n->child; c != NULL; c = c->next) {
        bool read;
        if (strcmp(c->key, "when") == 0) read = read_only(t, c);
        else if (strcmp(c->key, "sample") == 0) read = read_sample(t, c);
        else read = add_axis(t->scenario, c->key, c, t->arena, t->err);
        if (!read) return false;
    }
    return true;
}

typedef bool top_fn(struct top *t, const struct node *n);
/* Keys at the top that are no settings. */
static const struct top_key {
    const char *name;
    top_fn *read;
} top_keys[] = {
    {"schema_version", read_version}, {"question", read_question},
     {"repetitions", read_repetitions},
    {"figures", read_figures},        {"only", read_only},         {"when", read_only},
    {"sweep", read_sweep},            {"optimise", read_search},
    {"jobs", read_jobs},              {"combinations", read_combinations},
    {"answer", read_answer},
};
enum { NTOP = sizeof top_keys / sizeof *top_keys };

/* A key that is no setting: the nearest of this file's own keys before any other. */
static bool unknown_top(struct top *t, const struct node *n)
{
    /* Keys at the top in one list, so that the nearest of all is found. */
    const char *names[NTOP + 9] = {"machine", "model",  "kernel", "ranks",   "seed",
                                   "record",  "n",      "n_over_p", "program"};
    for (int i = 0; i < NTOP; i++) names[9 + i] = top_keys[i].name;
    /* A key of a group, in the wrong place. */
    if (strcmp(n->key, "sample") == 0)
        return err_set_at(t->err, ERR_DATA, t->scenario->path, n->line,
                          "'sample' is a part of 'sweep'; expected it below 'sweep:'");
    const char *near = text_nearest(n->key, names, NTOP + 9);
    if (near == NULL)
        return program_file_unknown(t->scenario, n->key, t->scenario->path, n->line, t->err);
    return err_set_at(t->err, ERR_DATA, t->scenario->path, n->line,
                      "unknown key '%.120s'; did you mean '%s'?", n->key, near);
}

/* A setting at the top; a list where a single value belongs is an axis. */
static bool read_setting(struct top *t, const struct node *n)
{
    struct scenario *s = t->scenario;
    const char *key = setting_key(n->key);
    /* setting_walk takes a mapping: one with this key alone. */
    struct node only = *n, parent = {.kind = NODE_MAP, .count = 1, .child = &only};
    if (!setting_is_key(key) && !setting_is_group(n->key)) return unknown_top(t, n);
    if (n->kind == NODE_LIST && !is_list_field(key))
        return add_axis(s, n->key, n, t->arena, t->err);
    only.next = NULL;
    return setting_walk(&parent, "", s->path, add_leaf, &s->base, t->arena, t->err);
}

static bool read_top(struct top *t, const struct node *n)
{
    for (int i = 0; i < NTOP; i++)
        if (strcmp(n->key, top_keys[i].name) == 0) return top_keys[i].read(t, n);
    return read_setting(t, n);
}

/* Whether the axis is a sample that draws `key`: all of its points set the same keys. */
static bool is_sampled(const struct axis *x, const char *key)
{
    for (int k = 0; strcmp(x->key, "sample") == 0 && k < x->point[0].n; k++)
        if (strcmp(x->point[0].at[k].key, key) == 0) return true;
    return false;
}

/* A key cannot both be swept and hold for all runs. */
static bool check_axes(const struct scenario *s, struct err *e)
{
    /* First what is searched: its middle is a setting for all runs, too. */
    if (!search_file_check(s, e) || !jobs_file_check(s, e) || !answer_file_check(s, e))
        return false;
    for (int i = 0; i < s->naxis; i++)
        for (int j = 0; j < s->base.n; j++) {
            const struct setting *set = &s->base.at[j];
            if (strcmp(s->axis[i].key, set->key) == 0 || is_sampled(&s->axis[i], set->key))
                return err_set_at(e, ERR_DATA, s->path, s->axis[i].line,
                                  "'%s' is swept here and set for all runs in line %d", set->key,
                                  set->line);
        }
    for (int i = 0; i < s->naxis; i++)
        for (int j = 0; j < s->naxis; j++)
            if (i != j && is_sampled(&s->axis[i], s->axis[j].key))
                return err_set_at(e, ERR_DATA, s->path, s->axis[j].line,
                                  "'%s' is swept here and sampled in line %d", s->axis[j].key,
                                  s->axis[i].line);
    return true;
}

/* ---- the command line */

/* Whether `text` gives a single-valued key several values, "[a, b]" or "a,b", or one of lists
 * several lists. A path may hold commas of its own. */
static bool is_sweep(const char *full, const char *text)
{
    if (strcmp(full, "label") == 0) return false;
    if (is_list_field(full)) return text[0] == '[' && text[1] == '[' && !is_pair_list(full);
    return text[0] == '[' || (strchr(text, ',') != NULL && strcmp(full, "model.path") != 0 &&
                              strcmp(full, "program.arguments") != 0);
}

/* The last axis goes to place `at`. */
static void move_axis(struct scenario *s, int at)
{
    struct axis last = s->axis[s->naxis - 1];
    memmove(&s->axis[at + 1], &s->axis[at], (size_t)(s->naxis - 1 - at) * sizeof *s->axis);
    s->axis[at] = last;
}

/* Several values of a single-valued key become an axis in place `at`. */
static bool set_axis(struct scenario *s, const char *key, const char *list, int at, struct arena *a,
                     struct err *e)
{
    struct err why;
    err_clear(&why);
    char *line = TAKE(a, strlen(list) + 6, char);
    sprintf(line, list[0] == '[' ? "v: %s" : "v: [%s]", list);
    /* The list is read as YAML, so that quotes and brackets mean the same as in a file. */
    struct node *root = document_parse_settings(line, strlen(line), "--set", a, &why);
    const char *path = s->path;
    if (root == NULL || root->child->kind != NODE_LIST)
        return err_set_at(e, ERR_DATA, "--set", 0,
                          "%s: '%.80s' is not a list; write a sweep as %s=2,4,8", key, list,
                          key);
    for (struct node *n = root->child->child; n != NULL; n = n->next) n->line = 0;
    root->child->line = 0;
    /* Messages of add_axis name the command line. */
    s->path = "--set";
    bool fine = add_axis(s, key, root->child, a, e);
    if (fine) move_axis(s, at);
    s->path = path;
    return fine;
}

/* Returns the place where the axis was; the end when there was none. */
static int remove_axis(struct scenario *s, const char *full)
{
    for (int i = 0; i < s->naxis; i++) {
        if (strcmp(s->axis[i].key, full) != 0) continue;
        memmove(&s->axis[i], &s->axis[i + 1], (size_t)(--s->naxis - i) * sizeof *s->axis);
        return i;
    }
    return s->naxis;
}

/* What --set replaces; a key is at most once in a list. */
static void remove_setting(struct setting_list *list, const char *full)
{
    for (int i = 0; i < list->n; i++) {
        if (strcmp(list->at[i].key, full) != 0) continue;
        memmove(&list->at[i], &list->at[i + 1], (size_t)(--list->n - i) * sizeof *list->at);
        return;
    }
}

/* One --set: it replaces an axis or a value of the file, in the axis's place, so that the order
 * of runs stays. */
static bool read_set(struct scenario *s, const char *set, struct arena *a, struct err *e)
{
    const char *equals = strchr(set, '=');
    if (equals == NULL || equals == set)
        return err_set(
            e, ERR_USAGE,
            "--set '%.80s': expected key=value, such as machine.network.link.bandwidth='1 GB/s'",
            set);
    char *name = arena_text(a, set);
    name[equals - set] = '\0';
    name = (char *)program_file_key(s, name, a);
    const char *full = setting_key(name);
    /* No setting of a run, but of the scenario: it has a reader of its own. */
    if (strcmp(name, "repetitions") == 0) {
        struct scenario named = {.path = "--set", .repetitions = s->repetitions};
        struct top t = {.scenario = &named, .arena = a, .err = e};
        struct node n = {.key = name, .text = equals + 1};
        bool fine = read_repetitions(&t, &n);
        s->repetitions = named.repetitions;
        return fine;
    }
    if (strcmp(name, "combinations") == 0) {
        struct node n = {.kind = NODE_TEXT, .key = name, .text = equals + 1};
        return jobs_file_combine(s, &n, a, e);
    }
    if (strncmp(name, "jobs.", 5) == 0) return jobs_file_set(s, name, equals + 1, a, e);
    if (!setting_is_key(full)) return program_file_unknown(s, name, "--set", 0, e);
    int at = remove_axis(s, full);
    search_file_drop(s, full);
    remove_setting(&s->set, full);
    remove_setting(&s->base, full);
    if (is_sweep(full, equals + 1)) return set_axis(s, name, arena_text(a, equals + 1), at, a, e);
    return setting_list_add(&s->set, name, arena_text(a, equals + 1), "--set", 0, a, e);
}

/* n and n_over_p exclude each other, and so do kernel and program: what comes from the command line
 * wins. */
static void drop_overruled(struct scenario *s, const char *set, const char *file)
{
    bool given = false;
    for (int i = 0; i < s->set.n; i++) given = given || strcmp(s->set.at[i].key, set) == 0;
    if (!given) return;
    remove_axis(s, file);
    remove_setting(&s->base, file);
}

/* The command line on top of the file; --machine is the last word. */
static bool read_options(struct scenario *s, const struct plan_options *o, struct arena *a,
                         struct err *e)
{
    if (o == NULL) return true;
    for (int i = 0; i < o->nset; i++)
        if (!read_set(s, o->set[i], a, e)) return false;
    drop_overruled(s, "model.n", "n_over_p");
    drop_overruled(s, "n_over_p", "model.n");
    drop_overruled(s, "program.n", "n_over_p");
    drop_overruled(s, "n_over_p", "program.n");
    drop_overruled(s, "kernel.name", "program.file");
    drop_overruled(s, "program.file", "kernel.name");
    if (o->name != NULL) {
        remove_setting(&s->set, "label");
        if (!setting_list_add(&s->set, "label", arena_text(a, o->name), "--name", 0, a, e))
            return false;
    }
    if (o->only != NULL) {
        if (s->ncondition == SCENARIO_MAX_CONDITIONS)
            return err_set(e, ERR_USAGE, "--only: the scenario has %d conditions already",
                           s->ncondition);
        if (!condition_read(&s->condition[s->ncondition++], o->only, "--only", 0, a, e))
            return false;
    }
    if (o->machine == NULL) return true;
    remove_axis(s, "machine.name");
    remove_setting(&s->base, "machine.name");
    remove_setting(&s->set, "machine.name");
    return setting_list_add(&s->set, "machine", arena_text(a, o->machine), "--machine", 0, a, e);
}

/* Programs first, as they add keys; then the keys of the file in order, so that axes keep
 * theirs; the command line last. */
bool scenario_file_tree(struct scenario *s, struct node *root, const char *path,
                        const struct plan_options *o, struct arena *a, struct err *e)
{
    struct top t = {.scenario = s, .arena = a, .err = e};
    *s = (struct scenario){.path = path, .question = "", .repetitions = 1};
    s->typed = program_file_is(path);
    s->stem = data_dir_stem(path, a);
    s->dir = data_dir_of(path, a);
    if (document_find(root, "schema_version") == NULL)
        return err_set_at(e, ERR_DATA, path, 1,
                          "schema_version is missing; expected 'schema_version: 1'");
    /* What programs declare are keys, too. */
    if (!program_file_collect(s, root, o, a, e)) return false;
    program_file_rename(s, root, a);
    if (s->typed) program_file_entitle(s, a), program_file_ranks(s, root, a);
    for (const struct node *n = root->child; n != NULL; n = n->next)
        if (!read_top(&t, n)) return false;
    /* Once more behind the command line, which may say how jobs are combined. */
    return check_axes(s, e) && read_options(s, o, a, e) && jobs_file_check(s, e);
}

/* A file of settings, or a program, for which a scenario is made. */
bool scenario_file_read(struct scenario *s, const char *name, const struct plan_options *o,
                        struct arena *a, struct err *e)
{
    const bool program = program_file_is(name);
    const char *path = program ? name : data_dir_find("scenarios", name, NULL, a, e);
    struct node *root = NULL;
    if (path != NULL)
        root = program ? program_file_scenario(name, a, e) : document_read_settings(path, a, e);
    return root != NULL && scenario_file_tree(s, root, path, o, a, e);
}

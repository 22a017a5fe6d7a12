/* jobs_file.c - see jobs_file.h.
 *
 * A job is a mapping of settings like those at the top, which hold for all jobs that do not say
 * otherwise. Of the machine it has only its own processors: all else is shared.
 *
 * Places are written in a way of their own (placement: random), and become the settings
 * machine.placement.* of the job: everything behind sees a run with a placement like any other. */
#include "plan/jobs_file.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "plan/program_file.h"
#include "spec/spec_fields.h"

/* In all files of places together: each is 10 bytes of a list, and a number of each run. */
enum { MOST_PLACES = 1 << 20 };

static const char places[] = "machine.placement.", kind_key[] = "machine.placement.kind",
                  list_key[] = "machine.placement.list";

/* A job being read. */
struct reading {
    struct scenario *scenario;
    struct scenario_job *job;
    struct arena *arena;
    struct err *err;
};

/* "job 'a': KEY: 'value': " and what was expected. Returns false. */
static bool refuse(const struct reading *r, const struct node *n, const char *expected)
{
    return err_set_at(r->err, ERR_DATA, r->scenario->path, n->line, "job '%.31s': %s: '%.80s': %s",
                      r->job->name, n->key, n->text != NULL ? n->text : "a list or mapping",
                      expected);
}

static bool add(const struct reading *r, const char *key, const char *text, int line)
{
    return setting_list_add(&r->job->set, key, text, r->scenario->path, line, r->arena, r->err);
}

/* ---- where it lies */

/* Numbers of processors, divided by blanks, commas or lines; "4-7" is four of them, and # begins a
 * remark. As the text of a list; NULL with the error. */
static const char *read_places(const struct reading *r, const struct node *n, const char *path)
{
    struct text file = {0}, list = {0};
    const char *found = NULL;
    /* Lines are counted for messages: such files are long, and made by scripts that may err. */
    int line = 1;
    if (!text_read_file(&file, path, r->err)) return NULL;
    text_add(&list, "[");
    for (const char *s = file.s; s != NULL && *s != '\0';) {
        char *end;
        if (*s == '#') s += strcspn(s, "\n");
        if (*s == '\n') line++;
        if (isspace((unsigned char)*s) || *s == ',') {
            s++;
            continue;
        }
        if (*s == '\0') break;
        /* A number, or two with a hyphen: strtol alone would take signs as well. */
        const long from = strtol(s, &end, 10);
        const char *first = s;
        long to = from;
        bool ok = isdigit((unsigned char)*s);
        if (ok && *end == '-') {
            s = end + 1;
            ok = isdigit((unsigned char)*s);
            to = strtol(s, &end, 10);
        }
        ok = ok && to >= from && to < 1 << 30;
        /* A few characters must not ask for any amount of memory, in one file or in many. */
        if (ok && (r->scenario->jobs->nplace += to - from + 1) > MOST_PLACES) {
            err_set_at(r->err, ERR_DATA, path, line,
                       "'%.*s': the files of all jobs name more than %d processors",
                       (int)strcspn(first, " ,\t\n"), first, MOST_PLACES);
            goto out;
        }
        if (!ok) {
            err_set_at(r->err, ERR_DATA, path, line,
                       "'%.*s': expected numbers of processors, such as 0 1 2 or 4-7",
                       (int)strcspn(first, " ,\t\n"), first);
            goto out;
        }
        for (long k = from; k <= to; k++) text_add(&list, "%s%ld", list.length > 1 ? ", " : "", k);
        s = end;
    }
    text_add(&list, "]");
    found = list.length > 2 ? arena_text(r->arena, list.s) : NULL;
    if (found == NULL) refuse(r, n, "the file names no processor");
out:
    text_free(&file);
    text_free(&list);
    return found;
}

/* {file: NAME}: beside the scenario, or where the path leads. */
static bool read_file(const struct reading *r, const struct node *n)
{
    /* A list that is as long as a large job is no part of a scenario that people read. */
    const char *dir = r->scenario->dir;
    struct text path = {0};
    if (n->text == NULL) return refuse(r, n, "expected the name of a file");
    /* As a model's file: relative to the scenario, wherever the program was started. */
    text_add(&path, "%s%s%s", n->text[0] == '/' ? "" : dir,
             n->text[0] == '/' || dir[0] == '\0' ? "" : "/", n->text);
    /* The list as if it stood here. */
    const char *list = read_places(r, n, arena_text(r->arena, path.s));
    text_free(&path);
    return list != NULL && add(r, kind_key, "list", n->line) && add(r, list_key, list, n->line);
}

/* A word, for the order in which processors are taken. */
static bool read_word(const struct reading *r, const struct node *n)
{
    /* The first is the word of job schedulers for what machine files call linear. */
    static const char *const word[] = {"contiguous", "random", "groups", "linear", "snake", "gray"};
    enum { WORDS = sizeof word / sizeof *word };
    for (int i = 0; i < WORDS; i++)
        if (strcmp(n->text, word[i]) == 0)
            return add(r, kind_key, i == 0 ? "linear" : word[i], n->line);
    char why[256];
    /* The nearest word, or all of them. */
    const char *near = text_nearest(n->text, word, WORDS);
    if (near != NULL) snprintf(why, sizeof why, "did you mean '%s'?", near);
    else
        snprintf(why, sizeof why,
                 "expected contiguous, random, groups, snake, gray, a list of processors or "
                 "{file: NAME}");
    return refuse(r, n, why);
}

/* A list of processors. */
static bool read_list(const struct reading *r, const struct node *n)
{
    /* Two settings, in whatever form the list was written. */
    const char *text = setting_value(list_key, n, r->scenario->path, r->arena, r->err);
    return text != NULL && add(r, kind_key, "list", n->line) && add(r, list_key, text, n->line);
}

/* {kind: random, seed: 3}, {list: [0, 1]}, {file: places.txt}. */
static bool read_mapping(const struct reading *r, const struct node *n)
{
    static const char *const known[] = {"kind", "seed", "spread", "list", "file"};
    /* Each key becomes one setting or two; the same one twice is refused there. */
    for (const struct node *c = n->child; c != NULL; c = c->next) {
        bool ok;
        const bool word = strcmp(c->key, "kind") == 0, seed = strcmp(c->key, "seed") == 0,
                   spread = strcmp(c->key, "spread") == 0;
        if ((word || seed || spread) && c->text == NULL)
            ok = refuse(r, c, "expected one value, not a list or a mapping");
        else if (word) ok = read_word(r, c);
        else if (strcmp(c->key, "list") == 0) ok = read_list(r, c);
        else if (strcmp(c->key, "file") == 0) ok = read_file(r, c);
        else if (seed) ok = add(r, "machine.placement.seed", c->text, c->line);
        else if (spread)
            ok = add(r, "machine.placement.spread", c->text, c->line);
        else {
            static const char all[] = "; expected kind, seed, spread, list or file";
            ok = err_set_at(r->err, ERR_DATA, r->scenario->path, c->line,
                            "job '%.31s': placement: unknown key '%.40s'%s", r->job->name, c->key,
                            text_hint(c->key, known, 5, all).s);
        }
        if (!ok) return false;
    }
    return true;
}

/* Three forms: a word, a list, a mapping. */
static bool read_placement(const struct reading *r, const struct node *n)
{
    /* By what stands there, as YAML reads it. */
    if (n->kind == NODE_LIST) return read_list(r, n);
    if (n->kind == NODE_MAP) return read_mapping(r, n);
    return n->text != NULL ? read_word(r, n) : refuse(r, n, "expected where the job lies");
}

/* ---- one job */

/* By the field of the run, for its checks and messages. */
static bool read_start(const struct reading *r, const struct node *n)
{
    /* Into a spare struct: the job's own is made when runs are. */
    const struct field *f = &job_table.field[field_find(&job_table, "start")];
    struct job_spec trial;
    char why[256] = "expected a time such as 1 ms";
    if (n->text == NULL || !field_set(f, &trial, n->text, NULL, why, (int)sizeof why))
        return refuse(r, n, why);
    r->job->start = trial.start;
    return true;
}

/* For setting_walk. */
static bool add_leaf(void *context, const char *key, const struct node *leaf, const char *file,
                     struct arena *a, struct err *e)
{
    const struct reading *r = context;
    /* Its place is the only thing that a job has of the machine. */
    const bool shared = strncmp(key, "machine.", 8) == 0 &&
                        strncmp(key, places, sizeof places - 1) != 0;
    if (shared || strcmp(key, "label") == 0)
        return err_set_at(e, ERR_DATA, file, leaf->line,
                          "job '%.31s': '%.80s' belongs to %s; set it at the top of the scenario",
                          r->job->name, key, shared ? "the machine, which all jobs share" : "runs");
    const char *text = setting_value(key, leaf, file, a, e);
    return text != NULL && add(r, key, text, leaf->line);
}

/* One key of a job. */
static bool read_key(struct reading *r, const struct node *n)
{
    /* The name was read before everything else: messages name the job. */
    if (strcmp(n->key, "name") == 0) return true;
    if (strcmp(n->key, "start") == 0) return read_start(r, n);
    if (strcmp(n->key, "placement") == 0) return read_placement(r, n);
    /* All other keys are settings; setting_walk takes a mapping: one with this key alone. */
    struct node only = *n, parent = {.kind = NODE_MAP, .count = 1, .child = &only};
    only.next = NULL;
    const char *key = setting_key(n->key);
    /* Words that only jobs have are among what may have been meant. */
    static const char *const own[] = {"name", "start", "placement"};
    const char *near = text_nearest(n->key, own, 3);
    if (!setting_is_key(key) && !setting_is_group(n->key)) {
        if (near == NULL)
            return program_file_unknown(r->scenario, n->key, r->scenario->path, n->line, r->err);
        return err_set_at(r->err, ERR_DATA, r->scenario->path, n->line,
                          "unknown key '%.120s'; did you mean '%s'?", n->key, near);
    }
    return setting_walk(&parent, "", r->scenario->path, add_leaf, r, r->arena, r->err);
}

/* A name stands in keys and beside others. */
static bool read_name(const struct scenario *s, const struct node *job, struct scenario_job *out,
                      struct err *e)
{
    const struct node *n = document_find(job, "name");
    if (n == NULL)
        return err_set_at(e, ERR_DATA, s->path, job->line,
                          "jobs: a job without a name; expected {name: solver, kernel: forward, "
                          "...}");
    /* Nothing that ends a key or joins names: jobs.NAME.KEY, "solver + swap". */
    size_t length = n->text != NULL ? strlen(n->text) : 0;
    bool fine = length >= 1 && length < JOB_NAME && isalpha((unsigned char)n->text[0]);
    /* The first is a letter: a number would be a place in the list. */
    for (size_t i = 0; fine && i < length; i++)
        fine = isalnum((unsigned char)n->text[i]) || n->text[i] == '-' || n->text[i] == '_';
    if (!fine)
        return err_set_at(e, ERR_DATA, s->path, n->line,
                          "jobs: name: '%.80s': expected a letter, then letters, digits, - and _, "
                          "at most %d",
                          n->text != NULL ? n->text : "a list or mapping", JOB_NAME - 1);
    if (strcmp(n->text, "background") == 0)
        return err_set_at(e, ERR_DATA, s->path, n->line,
                          "jobs: name: 'background' is what takes the place of all other jobs; "
                          "choose another name");
    /* Of two that have one name the later one is the mistake. */
    for (int i = 0; i < s->jobs->n; i++)
        if (strcmp(s->jobs->job[i].name, n->text) == 0)
            return err_set_at(e, ERR_DATA, s->path, n->line,
                              "jobs: two jobs are called '%s'; the first in line %d", n->text,
                              s->jobs->job[i].line);
    *out = (struct scenario_job){.name = n->text, .line = job->line};
    return true;
}

/* `jobs` and `combinations` may stand in either order. */
static struct scenario_jobs *jobs_of(struct scenario *s, struct arena *a)
{
    if (s->jobs == NULL) s->jobs = TAKE(a, 1, struct scenario_jobs);
    return s->jobs;
}

bool jobs_file_read(struct scenario *s, const struct node *list, struct arena *a, struct err *e)
{
    struct scenario_jobs *j = jobs_of(s, a);
    j->line = list->line;
    if (list->kind != NODE_LIST || list->count == 0)
        return err_set_at(e, ERR_DATA, s->path, list->line,
                          "jobs: expected a list of jobs such as '- {name: solver, kernel: "
                          "forward, n: 64, ranks: 64}'");
    if (list->count > JOB_MOST)
        return err_set_at(e, ERR_DATA, s->path, list->line, "jobs: %d jobs; expected at most %d",
                          list->count, JOB_MOST);
    /* In the order of the file, which is that in which places are taken. */
    for (const struct node *n = list->child; n != NULL; n = n->next) {
        struct scenario_job *job = &j->job[j->n];
        struct reading r = {s, job, a, e};
        if (n->kind != NODE_MAP)
            return err_set_at(e, ERR_DATA, s->path, n->line,
                              "jobs: expected a mapping such as {name: solver, kernel: forward}");
        if (!read_name(s, n, job, e)) return false;
        for (const struct node *c = n->child; c != NULL; c = c->next)
            if (!read_key(&r, c)) return false;
        j->n++;
    }
    return true;
}

/* ---- the rest of the scenario */

/* One word of `combinations`; its bit is its place in the list. */
static bool take_word(struct scenario_jobs *j, const struct scenario *s, const struct node *n,
                      struct err *e)
{
    static const char *const word[] = {"all", "alone", "pairs"};
    const char *text = n->text != NULL ? n->text : "";
    for (int i = 0; i < 3; i++)
        if (strcmp(text, word[i]) == 0) return j->combine |= 1U << i, true;
    return err_set_at(e, ERR_DATA, s->path, n->line, "combinations: '%.80s': %s", text,
                      text_hint(text, word, 3, "; expected all, alone, pairs or a list of them").s +
                          2);
}

bool jobs_file_combine(struct scenario *s, const struct node *words, struct arena *a,
                       struct err *e)
{
    struct scenario_jobs *j = jobs_of(s, a);
    if (j->line == 0) j->line = words->line;
    /* What --set says takes the place of what the file says. */
    j->combine = 0;
    /* --set gives a list as one text, "alone,pairs". */
    if (words->kind == NODE_TEXT && words->text != NULL) {
        char *rest = arena_text(a, words->text);
        for (char *word = strsep(&rest, "[], "); word != NULL; word = strsep(&rest, "[], ")) {
            const struct node one = {.kind = NODE_TEXT, .line = words->line, .text = word};
            if (word[0] != '\0' && !take_word(j, s, &one, e)) return false;
        }
        return j->combine != 0 || take_word(j, s, words, e);
    }
    for (const struct node *n = words->child; n != NULL; n = n->next)
        if (!take_word(j, s, n, e)) return false;
    return j->combine != 0 || take_word(j, s, words, e);
}

/* A key of the sweep that a job sets itself would act on the other jobs alone. */
static bool check_sweep(const struct scenario *s, const struct setting *own, const char *name,
                        struct err *e)
{
    /* Points of one axis may set different keys (variants), so all are asked. */
    for (int i = 0; i < s->naxis; i++)
        for (int k = 0; k < s->axis[i].npoint; k++) {
            const struct setting_list *point = &s->axis[i].point[k];
            for (int p = 0; p < point->n; p++)
                if (strcmp(point->at[p].key, own->key) == 0)
                    return err_set_at(e, ERR_DATA, s->path, s->axis[i].line,
                                      "'%s' is swept here and set by job '%s' in line %d", own->key,
                                      name, own->line);
        }
    return true;
}

bool jobs_file_check(const struct scenario *s, struct err *e)
{
    const struct scenario_jobs *j = s->jobs;
    if (j == NULL) return true;
    /* Words about jobs that are not there are a slip. */
    if (j->n == 0)
        return err_set_at(e, ERR_DATA, s->path, j->line,
                          "combinations: the scenario has no 'jobs' to combine");
    /* A search asks for the best of single runs; what is best for one job is not for another. */
    if (s->search != NULL)
        return err_set_at(e, ERR_DATA, s->path, s->search->line,
                          "'optimise' and 'jobs' (line %d) exclude each other; remove one",
                          j->line);
    for (int i = 0; i < j->n; i++)
        for (int k = 0; k < j->job[i].set.n; k++)
            if (!check_sweep(s, &j->job[i].set.at[k], j->job[i].name, e)) return false;
    return true;
}

/* The job that "jobs.NAME.KEY" names; *key becomes KEY. */
static struct scenario_job *job_of(const struct scenario *s, const char **key, struct err *e)
{
    const char *name = *key + strlen("jobs."), *dot = strchr(name, '.'), *names[JOB_MOST];
    const int n = s->jobs != NULL ? s->jobs->n : 0;
    /* Names have no dots, so the first one ends the name. */
    const size_t length = dot != NULL ? (size_t)(dot - name) : strlen(name);
    for (int i = 0; i < n; i++) {
        names[i] = s->jobs->job[i].name;
        if (dot == NULL || strlen(names[i]) != length || strncmp(names[i], name, length) != 0)
            continue;
        *key = dot + 1;
        return &s->jobs->job[i];
    }
    /* No such job: the nearest, and how such keys look. */
    char word[JOB_NAME];
    snprintf(word, sizeof word, "%.*s", (int)length, name);
    err_set_at(e, ERR_DATA, "--set", 0, "no job is called '%s'%s; keys are jobs.NAME.KEY", word,
               text_hint(word, names, n, "").s);
    return NULL;
}

/* What was set before gives way: `key`, or where that ends in a dot all keys that begin so. */
static void remove_keys(struct setting_list *list, const char *key)
{
    const size_t length = strlen(key);
    const bool group = key[length - 1] == '.';
    int kept = 0;
    for (int i = 0; i < list->n; i++) {
        const char *own = list->at[i].key;
        if (group ? strncmp(own, key, length) != 0 : strcmp(own, key) != 0)
            list->at[kept++] = list->at[i];
    }
    list->n = kept;
}

bool jobs_file_set(struct scenario *s, const char *key, const char *text, struct arena *a,
                   struct err *e)
{
    struct scenario_job *job = job_of(s, &key, e);
    if (job == NULL) return false;
    /* As a file of one line, so that lists and words mean the same. Messages name --set, and paths
     * that the user types begin where he is: the scenario is borrowed under another name. */
    struct text line = {0};
    struct scenario named = *s;
    struct reading r = {&named, job, a, e};
    text_add(&line, "%s: %s", program_file_key(s, key, a), text);
    named.path = "--set";
    named.dir = "";
    struct node *root = document_parse_settings(line.s, line.length, "--set", a, e);
    text_free(&line);
    if (root == NULL || root->child == NULL) return false;
    root->child->line = 0;
    /* Names stand in keys of this very command line. */
    if (strcmp(key, "name") == 0)
        return err_set_at(e, ERR_DATA, "--set", 0, "jobs.%s.name: a job keeps its name", job->name);
    /* A place is several settings, all of which give way. */
    remove_keys(&job->set, strcmp(key, "placement") == 0 ? places : setting_key(root->child->key));
    return read_key(&r, root->child);
}

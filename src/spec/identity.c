/* identity.c - canonical texts of runs, their SHA-256, and runs from stored texts; see identity.h.
 *
 * The text that is hashed has one line for each setting that differs from its default, in the order
 * of the keys, and a line for the content of each file:
 *
 *     kernel.solver = cr
 *     machine.topology.dims = [8, 4, 4]
 *     model.file = sha256 ..
 *
 * A row that is added to a table, moved or given another default text of the same value changes
 * nothing here. Labels (titles) and the repetition number are no part of it, nor are settings that
 * another one puts to sleep (field.h, `dormant`). */
#include "spec/identity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/memory.h"
#include "spec/spec_fields.h"

/* Lines that stand for the content of files, in place of the paths. */
static const char file_key[] = "model.file = sha256 ";
static const char program_key[] = "program.file = sha256 ";
/* Settings of the jobs beside a run. */
static const char job_key[] = "jobs.";

/* One table: the lines of its defaults, and what was printed last from which bytes. */
struct part {
    struct text fallback, full, own;
    void *bytes;
    void *acting; /* the same without settings that cannot act */
    bool known;
};

/* Kept for a whole campaign, which has thousands of runs and few different structs. */
struct identity {
    const struct field_table *const *table;
    int n;
    struct part *part; /* (n) */
};

/* Printed defaults, once: every run of a campaign is compared with these lines. */
struct identity *identity_create(const struct field_table *const *table, int n)
{
    struct identity *x = memory_zeroed(1, sizeof *x);
    struct arena *a = arena_create();
    *x = (struct identity){
        .table = table, .n = n, .part = memory_zeroed((size_t)n, sizeof *x->part)};
    for (int i = 0; i < n; i++) {
        void *base = arena_take(a, table[i]->size);
        field_defaults(table[i], base, a);
        fields_print(table[i], base, false, &x->part[i].fallback);
        x->part[i].bytes = memory_take(table[i]->size, 1);
        x->part[i].acting = memory_take(table[i]->size, 1);
    }
    arena_destroy(a);
    return x;
}

struct identity *identity_of_runs(void)
{
    int n;
    const struct field_table *const *table = field_tables(&n);
    return identity_create(table, n);
}

void identity_destroy(struct identity *x)
{
    for (int i = 0; x != NULL && i < x->n; i++) {
        text_free(&x->part[i].fallback);
        text_free(&x->part[i].full);
        text_free(&x->part[i].own);
        free(x->part[i].bytes);
        free(x->part[i].acting);
    }
    if (x != NULL) free(x->part);
    free(x);
}

struct identity *identity_or_own(struct identity *lent)
{
    return lent != NULL ? lent : identity_of_runs();
}

void identity_back(struct identity *x, const struct identity *lent)
{
    if (x != lent) identity_destroy(x);
}

/* Two runs may have lists of equal length at one address after the arena was used again. */
void identity_forget(struct identity *x)
{
    for (int i = 0; i < x->n; i++) x->part[i].known = false;
}

/* Behind the end of the line at `s`. */
static const char *next_line(const char *s)
{
    s = strchrnul(s, '\n');
    return *s != '\0' ? s + 1 : s;
}

/* The lines of `full` that are other ones in `fallback`: both name the same keys in the same order.
 * Equal lines mean a default, however it was written. */
static void add_differences(const char *full, const char *fallback, struct text *own)
{
    /* Lines side by side: a key stands on the same line of both texts. */
    for (const char *line = full, *other = fallback; *line != '\0';) {
        const char *end = next_line(line), *other_end = next_line(other);
        const size_t n = (size_t)(end - line);
        if (n != (size_t)(other_end - other) || memcmp(line, other, n) != 0)
            text_add_bytes(own, line, n);
        line = end;
        other = other_end;
    }
}

/* Settings that cannot act in `bytes` get their defaults in p->acting. False: all can act, so that
 * p->acting says nothing. A dormant setting is one number: it needs no memory. */
static bool leave_dormant(const struct field_table *t, const void *bytes, struct part *p)
{
    bool any = false;
    char why[160];
    for (int i = 0; i < t->nfield; i++) {
        const struct field *f = &t->field[i];
        if (f->dormant == NULL || !f->dormant(bytes)) continue;
        if (!any) memcpy(p->acting, bytes, t->size);
        any = true;
        CHECK(field_set(f, p->acting, f->fallback, NULL, why, sizeof why));
    }
    return any;
}

/* The texts of table i; the first table's struct is the whole run, which always changes. */
static const struct part *print_part(struct identity *x, int i, const void *base)
{
    const struct field_table *t = x->table[i];
    const void *bytes = (const char *)base + t->offset;
    struct part *p = &x->part[i];
    /* A campaign's runs mostly differ in one table: the others are recognised by their bytes. */
    if (i > 0 && p->known && memcmp(p->bytes, bytes, t->size) == 0) return p;
    p->full.length = p->own.length = 0;
    fields_print(t, bytes, false, &p->full);
    if (leave_dormant(t, bytes, p)) {
        struct text acting = {0};
        fields_print(t, p->acting, false, &acting);
        add_differences(acting.s, p->fallback.s, &p->own);
        text_free(&acting);
    } else {
        add_differences(p->full.s, p->fallback.s, &p->own);
    }
    memcpy(p->bytes, bytes, t->size);
    p->known = true;
    return p;
}

/* Bytes, not the locale's order: identities are the same everywhere. */
static int compare_lines(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Sort the lines of `text`: then neither the order of tables nor that of their rows is part of an
 * identity. n log n comparisons of short lines; a run has a few dozen that differ from defaults. */
static void sort_lines(struct text *text)
{
    struct text sorted = {0};
    int n = 0;
    for (const char *s = text->s; s != NULL && *s != '\0'; s = next_line(s)) n++;
    char **line = memory_zeroed((size_t)n + 1, sizeof *line);
    n = 0;
    /* Each line becomes a string of its own for the comparison. */
    for (char *s = text->s, *end; s != NULL && *s != '\0'; s = end + 1) {
        line[n++] = s;
        end = strchr(s, '\n');
        *end = '\0';
    }
    /* Keys are unique, so that the order is total. */
    qsort(line, (size_t)n, sizeof *line, compare_lines);
    for (int i = 0; i < n; i++) {
        text_add_bytes(&sorted, line[i], strlen(line[i]));
        text_add_bytes(&sorted, "\n", 1);
    }
    free(line);
    text_free(text);
    *text = sorted;
}

/* The full text is for people, in table order; the short one, sorted, is hashed. */
void identity_texts(struct identity *x, const void *base, const char *more, struct text *full,
                    struct text *own)
{
    struct text lines = {0};
    for (int i = 0; i < x->n; i++) {
        const struct part *p = print_part(x, i, base);
        text_add_bytes(full, p->full.s, p->full.length);
        if (p->own.length > 0) text_add_bytes(&lines, p->own.s, p->own.length);
    }
    text_add_bytes(full, more, strlen(more));
    text_add_bytes(&lines, more, strlen(more));
    sort_lines(&lines);
    text_add_bytes(own, lines.s != NULL ? lines.s : "", lines.length);
    text_free(&lines);
}

/* Both texts of a run, with the lines that stand for files. */
static void run_texts(struct identity *x, const struct run_spec *run, struct text *full,
                      struct text *own)
{
    struct text more = {0};
    /* A copy whose paths are emptied: the same file elsewhere is the same run. */
    struct run_spec plain = *run;
    /* An empty text is a text: a string that ends at once, not NULL. */
    text_add(&more, "%s", "");
    /* The content of a file is named: where it lies is no matter. */
    if (run->model_file[0] != '\0') {
        memset(plain.model.path, 0, sizeof plain.model.path);
        text_add(&more, "%s%s\n", file_key, run->model_file);
    }
    if (run->program.hash[0] != '\0') {
        memset(plain.program.file, 0, sizeof plain.program.file);
        /* in the place of the path, so that the key has one line */
        snprintf(plain.program.file, sizeof plain.program.file, "sha256 %s", run->program.hash);
    }
    /* What a program declares itself counts like any setting. */
    program_lines_print(run->program.parameters, &more);
    /* What runs beside it makes it another run. */
    if (run->jobs) job_set_lines(run->jobs, run->job.number, &more);
    identity_texts(x, &plain, more.s, full, own);
    text_free(&more);
}

void identity_set(struct identity *x, struct run_spec *run, struct arena *a)
{
    struct text full = {0}, own = {0};
    run_texts(x, run, &full, &own);
    /* 256 bits: no two different runs of any database will ever share one. */
    digest_sha256_hex(own.s, own.length, run->config_hash);
    run->config_text = arena_text(a, full.s);
    text_free(&full);
    text_free(&own);
}

const char *identity_job(struct identity *x, const struct run_spec *job, struct arena *a)
{
    struct text full = {0}, own = {0};
    run_texts(x, job, &full, &own);
    const char *lines = arena_text(a, own.s);
    text_free(&full);
    text_free(&own);
    return lines;
}

/* For a single run the table of defaults is made and thrown away. */
void run_identify(struct run_spec *run, struct arena *a)
{
    struct identity *x = identity_of_runs();
    identity_set(x, run, a);
    identity_destroy(x);
}

/* --- back from a text --- */

/* What a person's own program declares is known to its image alone, which may be gone: the line is
 * kept as it stands. */
static bool add_parameter(struct run_spec *run, const char *name, const char *value,
                          struct arena *a)
{
    struct text lines = {0};
    text_add(&lines, "%s", run->program.parameters != NULL ? run->program.parameters : "");
    program_lines_add(&lines, name, value);
    run->program.parameters = arena_text(a, lines.s);
    text_free(&lines);
    return true;
}

/* The setting `key` gets the text `value`, read as if a user had written it: a stored text is
 * checked again, since ranges and choices may have changed. */
static bool take_setting(struct run_spec *run, const char *key, const char *value, struct arena *a,
                         char *why, int size)
{
    const struct field_table *table;
    const struct field *f = field_find_full(key, &table);
    struct text shown = {0};
    char clause[160] = "";
    /* Keys below the program's prefix that no table knows are its parameters. */
    const size_t n = strlen(program_table.prefix);
    if (f == NULL && strncmp(key, program_table.prefix, n) == 0 && key[n] == '.')
        return add_parameter(run, key + n + 1, value, a);
    /* A setting of an older version: the run cannot be repeated, and says which key is gone. */
    if (f == NULL)
        return snprintf(why, (size_t)size, "there is no setting '%.80s' any more", key), false;
    /* What has its default already is not read: some defaults, such as an empty list, cannot be
     * given. */
    void *base = (char *)run + table->offset;
    field_print(f, base, &shown);
    bool fine = strcmp(shown.s != NULL ? shown.s : "", value) == 0 ||
                field_set(f, base, value, a, clause, sizeof clause);
    if (!fine) snprintf(why, (size_t)size, "%.60s = %.60s: %s", key, value, clause);
    text_free(&shown);
    return fine;
}

/* Jobs that a text names besides the run itself. */
struct jobs_read {
    int n;
    struct run_spec *job; /* (JOB_MOST), NULL: none so far */
    bool *idle;           /* (JOB_MOST) */
};

static bool take_line(struct run_spec *run, char *line, struct arena *a, char *why, int size);

/* Jobs 1 to `number` are there, with defaults at first. */
static void need_jobs(struct jobs_read *j, int number, struct arena *a)
{
    /* Room for all when the first comes: texts with jobs are few. */
    if (j->job == NULL) {
        j->job = TAKE(a, JOB_MOST, struct run_spec);
        j->idle = TAKE(a, JOB_MOST, bool);
    }
    for (; j->n < number; j->n++) run_spec_defaults(&j->job[j->n], a);
}

/* "NUMBER.KEY = VALUE" behind "jobs." */
static bool take_job_line(struct jobs_read *j, char *line, struct arena *a, char *why, int size)
{
    char *rest;
    const long number = strtol(line, &rest, 10);
    if (number < 1 || number > JOB_MOST || *rest != '.')
        return snprintf(why, (size_t)size, "'jobs.%.80s' is no setting of a job", line), false;
    need_jobs(j, (int)number, a);
    if (strcmp(rest + 1, "idle = true") == 0) return j->idle[number - 1] = true;
    return take_line(&j->job[number - 1], rest + 1, a, why, size);
}

/* The set that the run belongs to: it stands at its own place. */
static void join_jobs(struct run_spec *run, struct jobs_read *j, struct arena *a)
{
    if (run->job.number == 0) return;
    /* The text names the others alone. */
    need_jobs(j, run->job.number, a);
    j->job[run->job.number - 1] = job_alone(run);
    /* Texts as the plan makes them, so that the run has its identity again. */
    struct job_set *set = TAKE(a, 1, struct job_set);
    const struct run_spec **job = TAKE(a, j->n, const struct run_spec *);
    const char **text = TAKE(a, j->n, const char *);
    struct identity *x = identity_of_runs();
    for (int i = 0; i < j->n; i++) {
        job[i] = &j->job[i];
        text[i] = identity_job(x, job[i], a);
    }
    identity_destroy(x);
    *set = (struct job_set){j->n, job, j->idle, text};
    run->jobs = set;
}

/* One line, without its end, whose bytes are ours to change. */
static bool take_line(struct run_spec *run, char *line, struct arena *a, char *why, int size)
{
    char *equals = strstr(line, " = ");
    if (strncmp(line, file_key, strlen(file_key)) == 0) {
        text_copy(run->model_file, sizeof run->model_file, line + strlen(file_key));
        return true;
    }
    if (strncmp(line, program_key, strlen(program_key)) == 0) {
        text_copy(run->program.hash, sizeof run->program.hash, line + strlen(program_key));
        return run->kernel.own = true;
    }
    if (equals == NULL) return snprintf(why, (size_t)size, "'%.80s' is no setting", line), false;
    *equals = '\0';
    /* The value may itself hold " = ": the first one divides. */
    return take_setting(run, line, equals + 3, a, why, size);
}

/* Defaults first, then the lines of the text over them: what a newer version has added is at its
 * default, as it was when the run was made. */
bool run_from_text(struct run_spec *run, const char *text, struct arena *a, char *why, int size)
{
    struct jobs_read jobs = {0};
    run_spec_defaults(run, a);
    for (char *line = arena_text(a, text); *line != '\0';) {
        char *end = strchrnul(line, '\n');
        const bool last = *end == '\0';
        *end = '\0';
        /* Empty lines are no settings. */
        const bool job = strncmp(line, job_key, strlen(job_key)) == 0;
        if (job && !take_job_line(&jobs, line + strlen(job_key), a, why, size)) return false;
        if (!job && line < end && !take_line(run, line, a, why, size)) return false;
        line = last ? end : end + 1;
    }
    join_jobs(run, &jobs, a);
    return true;
}

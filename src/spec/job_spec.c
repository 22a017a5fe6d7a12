/* job_spec.c - the settings of jobs, and what identifies a set of them; see job_spec.h. */
#include "spec/job_spec.h"

#include <string.h>

#include "base/digest.h"
#include "base/text.h"
#include "spec/spec_fields.h"

#define AT(member) .offset = offsetof(struct job_spec, member)

/* Made by `jobs:` of a scenario: nobody sets them one by one. */
static const struct field fields[] = {
    {.key = "name",
     .kind = FIELD_TEXT,
     AT(name),
     .capacity = JOB_NAME,
     .fallback = "",
     .doc = "which of the scenario's `jobs` the run tells of (set by `jobs`)"},
    {.key = "number",
     .kind = FIELD_INT,
     AT(number),
     .min = 0,
     .max = JOB_MOST,
     .fallback = "0",
     .doc = "its place in the list of `jobs`, from 1 (set by `jobs`)"},
    {.key = "beside",
     .kind = FIELD_TEXT,
     AT(beside),
     .capacity = JOB_BESIDE,
     .fallback = "",
     .doc = "the jobs that run beside it; empty: none (set by `jobs`)"},
    {.key = "set",
     .kind = FIELD_TEXT,
     AT(set),
     .capacity = 17,
     .fallback = "",
     .doc = "digest of all `jobs` and the machine: the same for every combination of them (set by "
            "`jobs`)"},
    {.key = "start",
     .kind = FIELD_REAL,
     .unit = UNIT_TIME,
     AT(start),
     .min = 0,
     .max = 1e6,
     .fallback = "0 s",
     .doc = "when the job begins; its times count from there (`start` in `jobs`)"},
};

const struct field_table job_table = {
    .prefix = "job",
    .doc = "one of several jobs on a machine",
    .offset = offsetof(struct run_spec, job),
    .size = sizeof(struct job_spec),
    .nfield = (int)(sizeof fields / sizeof *fields),
    .field = fields,
};

struct run_spec job_alone(const struct run_spec *run)
{
    /* Labels, records and the set itself say nothing of what the job does to others. */
    struct run_spec r = *run;
    struct arena *scratch = arena_create();
    /* Bytes behind a text count where structs are compared, so all of them become zero. */
    memset(r.scenario, 0, sizeof r.scenario);
    memset(r.label, 0, sizeof r.label);
    field_defaults(&machine_table, &r.machine, scratch);
    arena_destroy(scratch);
    /* The machine is everybody's; a place on it is the job's own. */
    r.machine.placement = run->machine.placement;
    /* What is recorded changes no simulated time. */
    r.record = (struct record_spec){0};
    memset(&r.job, 0, sizeof r.job);
    /* Who is who, and when, is a part of the set. */
    text_copy(r.job.name, sizeof r.job.name, run->job.name);
    r.job.start = run->job.start;
    r.jobs = NULL;
    /* Repetitions differ for all jobs of a run together. */
    r.config_text = NULL;
    memset(r.config_hash, 0, sizeof r.config_hash);
    r.rep = 0;
    return r;
}

/* Keys of a person's own program, and of files, are lines like others: nothing here knows them.
 * The lines of one job, each behind "jobs.NUMBER.". */
static void add_lines(const char *lines, int number, struct text *out)
{
    /* Behind the last line stands the end. */
    for (const char *line = lines; *line;) {
        /* The number in front makes a key that no other job's has. */
        const char *end = strchrnul(line, '\n');
        text_add(out, "jobs.%d.%.*s\n", number, (int)(end - line), line);
        line = *end ? end + 1 : end;
    }
}

void job_set_lines(const struct job_set *s, int own, struct text *out)
{
    for (int i = 0; i < s->n; i++) {
        /* Its own settings stand in the text without a number. */
        if (i + 1 == own) continue;
        add_lines(s->text[i], i + 1, out);
        /* Beside the settings of its program, which would be the same alone. */
        if (s->idle[i]) text_add(out, "jobs.%d.idle = true\n", i + 1);
    }
}

void job_set_digest(const struct job_set *s, const char *machine, char digest[17])
{
    char whole[65];
    struct text t = {0};
    /* 64 bits tell the sets of a database apart; their runs have identities of their own. */
    text_add(&t, "%s", machine);
    for (int i = 0; i < s->n; i++) add_lines(s->text[i], i + 1, &t);
    digest_sha256_hex(t.s, t.length, whole);
    text_copy(digest, 17, whole);
    text_free(&t);
}

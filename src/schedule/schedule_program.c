/* schedule_program.c - a schedule is opened, checked against the run, and executed by its ranks.
 *
 * The sheet is what is known before a run (name, ranks, settings, identity); the job is
 * what ranks execute. Rules of both are in docs/schedules.md. */
#include "schedule/schedule_program.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/digest.h"
#include "base/picoseconds.h"
#include "base/text.h"
#include "schedule/schedule.h"
#include "schedule/schedule_run.h"
#include "spec/field.h"

/* Unless the run or the file says otherwise: nanoseconds, as everybody uses LogGOPSim. */
enum { DEFAULT_UNIT_PS = 1000 };

static const struct field parameters[] = {
    {.key = "time_unit",
     .kind = FIELD_REAL,
     .unit = UNIT_TIME,
     .min = 0,
     .max = 1,
     .fallback = "0 s",
     .doc = "what a computing time of 1 means, in whole picoseconds; 0 s: what the file says, else "
            "1 ns"},
};

/* The file's name without folder and ending. */
static void name_of(struct program_sheet *s, const char *path)
{
    const char *base = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    snprintf(s->name, sizeof s->name, "%.*s", (int)strcspn(base, "."), base);
    if (s->name[0] == '\0') text_copy(s->name, sizeof s->name, "schedule");
}

const struct program_sheet *schedule_sheet(const char *path, struct arena *a, struct err *e)
{
    struct arena *scratch = arena_create();
    struct program_sheet *sheet = TAKE(a, 1, struct program_sheet);
    struct text file = {0};
    /* The whole file is read and checked, so that a wrong one is refused before anything
     * runs; it is read again for each run. */
    const struct schedule *s = schedule_read(path, scratch, e);
    const bool fine = s && text_read_file(&file, path, e);
    if (fine) {
        /* A schedule is made for its number of ranks, which a scenario may leave out. */
        *sheet = (struct program_sheet){.kind = PROGRAM_SCHEDULE,
                                        .title = "a schedule",
                                        .image = arena_text(a, path),
                                        .nrank = s->nrank,
                                        .nparameter = (int)(sizeof parameters / sizeof *parameters),
                                        .parameter = parameters};
        name_of(sheet, path);
        /* Results of the same bytes are the same, wherever the file lies. */
        digest_sha256_hex(file.s, file.length, sheet->hash);
    }
    text_free(&file);
    arena_destroy(scratch);
    return fine ? sheet : NULL;
}

/* Sizes are known, but a promise would save events only. */
static int64_t no_promise(const void *job)
{
    (void)job;
    return -1;
}

static const char *const stage_name[] = {"schedule"};

/* Receives may name any rank or tag, so matching follows simulated time; no send is
 * synchronous, which saves events (world.h). */
static const struct rank_program rank_program = {
    .nstage = 1,
    .stage_name = stage_name,
    .workspace_bytes = schedule_workspace,
    .largest_message = no_promise,
    .run = schedule_rank,
    .timed = true,
    .no_synchronous = true,
    .foreign = true,
};

/* Picoseconds of one unit; 0: not a whole number of them. */
static int64_t unit_of(const struct program_run *r, const struct schedule *s)
{
    char text[64], why[128];
    union program_value v = {0};
    /* The setting goes before the remark in the file, and that before the default. */
    const bool given =
        program_value_find(r->spec.program.parameters, "time_unit", text, (int)sizeof text) &&
        field_set(&parameters[0], &v, text, r->arena, why, (int)sizeof why);
    if (!given || v.real == 0) return s->unit_ps > 0 ? s->unit_ps : DEFAULT_UNIT_PS;
    /* 0.1 us is no exact double: a millionth of the unit is forgiven. */
    const int64_t ps = ps_rounded(v.real * 1e12);
    return fabs((double)ps - v.real * 1e12) <= 1e-6 * (double)ps ? ps : 0;
}

/* Computing times as long as simulated time would wrap in picoseconds. Before the run, by
 * line: in it the sum would stop at the end of time without a word of which line. */
static bool times_fit(const struct schedule *s, int64_t unit, const char *path, struct err *e)
{
    for (int64_t i = 0; i < s->nop; i++)
        if (s->op[i].kind == SCHEDULE_COMPUTE && s->op[i].size > PS_LAST / unit)
            return err_set_at(e, ERR_DATA, path, s->op[i].line,
                              "a computing time of %lld times %lld ps; expected at most the "
                              "largest simulated time, %.3g s",
                              (long long)s->op[i].size, (long long)unit, (double)PS_LAST * 1e-12);
    return true;
}

static bool open_schedule(struct program_run *r, struct err *e)
{
    struct schedule_job *job = TAKE(r->arena, 1, struct schedule_job);
    const char *path = r->spec.program.image;
    r->own = job;
    r->rank = &rank_program;
    /* The database keeps the file's hash, not the file. */
    if (!path)
        return err_set(e, ERR_CONFIG, "schedule '%s' of a stored run is not at hand",
                       r->spec.kernel.name);
    const struct schedule *s = schedule_read(path, r->arena, e);
    if (!s) return false;
    *job = (struct schedule_job){.schedule = s, .path = path, .unit_ps = unit_of(r, s)};
    if (job->unit_ps == 0)
        return err_set(e, ERR_CONFIG, "program.time_unit is no whole number of picoseconds");
    /* More ranks would idle, fewer would lack their peers: neither is what the file
     * means. */
    if (r->spec.nrank != s->nrank)
        return err_set(e, ERR_CONFIG,
                       "the schedule '%s' has %d ranks, the run %d; expected ranks: %d",
                       r->spec.kernel.name, s->nrank, r->spec.nrank, s->nrank);
    return times_fit(s, job->unit_ps, path, e);
}

static bool prepare_schedule(struct program_run *r, struct arena *scratch, struct err *e)
{
    (void)e;
    struct schedule_job *job = r->own;
    memset(r->output, 0, sizeof r->output);
    /* Records of messages under way last as long as the run. */
    job->arena = scratch;
    r->job = job;
    return true;
}

/* Exact but for memory: the mean of the operations that a rank has. */
static void estimate_schedule(const struct program_run *r, struct program_estimate *out)
{
    const struct schedule *s = ((const struct schedule_job *)r->own)->schedule;
    *out = (struct program_estimate){
        .rank_bytes = (double)(s->nop * (int64_t)sizeof(struct schedule_op)) / s->nrank};
    for (int64_t i = 0; i < s->nop; i++) {
        out->messages += s->op[i].kind == SCHEDULE_SEND;
        if (s->op[i].kind == SCHEDULE_SEND) out->bytes += (double)s->op[i].size;
    }
}

const struct program_type schedule_program = {
    .name = "schedule",
    .title = "a schedule of messages and computing times",
    .open = open_schedule,
    .prepare = prepare_schedule,
    .estimate = estimate_schedule,
};

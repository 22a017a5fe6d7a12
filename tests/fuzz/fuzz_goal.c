/* fuzz_goal.c - a schedule that was accepted, executed by its ranks (fuzz_goal.h). */
#include "fuzz_goal.h"

#include "../vp/timed_world.h"
#include "schedule/schedule_run.h"

enum { RUN_RANKS = 16, RUN_OPERATIONS = 256 };

static void rank_main(struct comm *c, void *context)
{
    struct schedule_job *job = context;
    schedule_rank(c, job, arena_take(job->arena, schedule_workspace(job, comm_rank(c))));
}

static void whole(const struct schedule *s)
{
    CHECK(s->nrank >= 1 && s->nrank <= SCHEDULE_MOST_RANKS && s->first[0] == 0 &&
          s->first[s->nrank] == s->nop);
    for (int r = 0; r < s->nrank; r++) {
        int64_t n = s->first[r + 1] - s->first[r];
        CHECK(n >= 0);
        for (int64_t i = s->first[r]; i < s->first[r + 1]; i++) {
            CHECK(s->op[i].size >= 0 && s->op[i].peer >= -1 && s->op[i].peer < s->nrank);
            for (int64_t k = s->edge_first[i]; k < s->edge_first[i + 1]; k++)
                CHECK(s->edge[k] / 2 < n);
        }
    }
}

/* Messages have no contents here, so that their sizes cost nothing. A unit of 1 ps: whether times
 * fit other units is asked before a run, by schedule_program.c. */
static void run(const struct schedule *s, struct arena *a)
{
    struct machine_spec m = crossbar(RUN_RANKS);
    struct arena *result = arena_create();
    struct record_spec record = {.spans = false};
    struct schedule_job job = {.schedule = s, .path = "input.goal", .unit_ps = 1, .arena = a};
    struct world_load load = {
        .nrank = s->nrank, .program = rank_main, .context = &job, .nstage = 1};
    struct run_result r = {0};
    struct err e;
    load.timed = load.foreign = true;
    load.stage_name = stage_name;
    load.largest_message = -1;
    err_clear(&e);
    if (!world_run(&m, &load, &record, 1, result, &r, &e)) fuzz_refused(&e);
    else CHECK(r.status == RUN_OK || r.text[0] != '\0');
    arena_destroy(result);
}

void goal_try(const struct schedule *s, struct arena *a, const struct err *e)
{
    if (s == NULL) {
        fuzz_refused(e);
        return;
    }
    whole(s);
    if (s->nrank <= RUN_RANKS && s->nop <= RUN_OPERATIONS) run(s, a);
}

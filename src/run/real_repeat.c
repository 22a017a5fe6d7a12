/* real_repeat.c - one repetition of a real run, and what its ranks tell of it (real.h). */
#include <sched.h>
#include <string.h>

#include "base/digest.h"
#include "base/progress.h"
#include "base/text.h"
#include "host/host_load.h"
#include "run/real_parts.h"

/* --- one repetition --------------------------------------------------------------------------- */

/* Each process learns those of all, so that all come to the same decisions. */
static bool tell_facts(struct real *r, const struct host_times *t)
{
    int64_t mine[FACTS] = {[FACT_BEGIN] = t->begin_ns,
                           [FACT_END] = t->end_ns - t->published_ns,
                           [FACT_PREEMPTED] = t->preempted,
                           [FACT_FAULTS] = t->faults,
                           [FACT_LATE] = t->late_ns,
                           [FACT_DIGEST] = (int64_t)host_comm_digest(r->comm),
                           [FACT_MESSAGES] = t->messages,
                           [FACT_BYTES] = t->bytes,
                           [FACT_NOW] = host_clock_ns(),
                           [FACT_PROCESSOR] = sched_getcpu(),
                           [FACT_PROCESSORS] = (int64_t)host_processor_set(),
                           [FACT_OWN_NS] = (int64_t)(host_processor_seconds() * 1e9)};
    memcpy(&mine[FACT_STAGES], t->stage_ns, sizeof t->stage_ns);
    if (r->hosts != NULL) return r->hosts->call->gather(mine, FACTS, r->facts);
    memcpy(r->facts, mine, sizeof mine);
    return true;
}

/* MPI does not say which process has gone. */
bool real_lost(struct real *r, struct err *e)
{
    return err_set(e, ERR_INTERNAL, "%s cannot reach all processes",
                   r->hosts != NULL ? r->hosts->call->library : "MPI");
}

/* What is inside of the two marks is measured, and nothing else.
 *
 * The ranks once. `judged`: its answer is gathered and checked. */
bool real_repeat(struct real *r, bool judged, struct err *e)
{
    static const struct run_order order = {.real = true};
    struct arena *own = arena_create();
    struct program_run run = {.spec = r->own};
    struct host_times times;
    bool left = false;
    /* Images of people's programs, outputs and tables are made anew, as for a first run. The memory
     * of the program is that of the repetition before: a page that comes while the clock runs may
     * cost more than all that is computed with it; while one rank gets memory, its clock stands,
     * and those of others that wait for it do not; and MPI prepares large messages at the first use
     * of an address. */
    arena_empty(r->memory, SIZE_MAX);
    arena_touch(r->memory, r->bytes);
    bool ok =
        run_open(&r->own, &order, r->cache, own, &run, e) && run.type->prepare(&run, r->memory, e);
    if (ok) {
        const struct rank_program *p = run.rank;
        const int rank = r->hosts != NULL ? r->hosts->rank : 0;
        void *workspace = arena_take(r->memory, run.rank->workspace_bytes(run.job, rank));
        r->nstage = p->nstage;
        for (int i = 0; i < p->nstage; i++)
            text_copy(r->stage_name[i], sizeof r->stage_name[i], p->stage_name[i]);
        arena_touch(own, 0);
        arena_touch(r->memory, 0);
        struct comm *c =
            host_comm_run_begin(r->comm, p->timed, p->nstage, run.output, PROGRAM_OUTPUTS);
        /* People's own programs mark their time themselves: their copy of the image is not part of
         * it (guest_world.c). */
        if (!p->foreign) c->type->mark(c, 1);
        p->run(c, run.job, workspace);
        if (!p->foreign) c->type->mark(c, 0);
        r->bytes = arena_peak(r->memory);
        ok = host_comm_run_end(r->comm, &times, &left) && tell_facts(r, &times);
        if (!ok) real_lost(r, e);
    }
    if (ok && judged) {
        ok = real_judge(r, &run, own, r->memory) || real_lost(r, e);
    }
    run_close(&run);
    arena_destroy(own);
    return ok;
}

/* --- what ranks tell -------------------------------------------------------------------------- */

/* Facts are gathered by MPI into one array of all processes.
 *
 * One row a rank. */
const int64_t *real_facts(const struct real *r, int rank)
{
    return r->facts + (size_t)rank * FACTS;
}

/* Of all ranks together; each rank's is of what it published, in its order. */
void real_note_digest(struct real *r, bool first)
{
    uint64_t d = DIGEST_START;
    for (int i = 0; i < r->nrank; i++) d = digest_mix(d, (uint64_t)real_facts(r, i)[FACT_DIGEST]);
    if (first) r->first_digest = d;
    r->out->repeatable = r->out->repeatable && d == r->first_digest;
}

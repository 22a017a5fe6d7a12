/* campaign_mpi.c - see campaign_mpi.h.
 *
 * Every process reads the plan by itself; nothing of it travels but a digest. What depends on the
 * database, which only the first process has, is sent: the levels of 'auto-tolerance'. */
#include "app/campaign_mpi.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/text.h"
#include "hosts/hosts_copy.h"
#include "run/campaign_hosts.h"
#include "store/build.h"
#include "store/run_entries.h"
#include "study/level_choice.h"

enum { TAG_LEVELS = 100, TAG_RUNS }; /* apart from those of run/campaign_hosts.c */

/* A wrong option would be told once by each process. */
static int silence(void)
{
    const int kept = dup(STDERR_FILENO), null = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (kept >= 0 && null >= 0) dup2(null, STDERR_FILENO);
    if (null >= 0) close(null);
    return kept;
}

/* Asked for by --campaign: without it nothing of MPI is loaded. */
bool job_open(struct job *j, const char *campaign, struct err *e)
{
    /* -1: no stream is kept, which 0 would claim */
    *j = (struct job){.kept = -1};
    if (campaign == NULL) return true;
    if (strcmp(campaign, "mpi") != 0)
        return err_set(e, ERR_USAGE, "--campaign '%.40s': expected mpi", campaign);
    if (!hosts_open(&j->h, e)) return false;
    j->on = true;
    if (j->h.rank > 0) j->kept = silence();
    return true;
}

bool job_open_started(struct job *j, struct err *e)
{
    return job_open(j, hosts_started() ? "mpi" : NULL, e);
}

bool job_open_alone(struct job *j, struct err *e)
{
    return j->on || job_open(j, "mpi", e);
}

/* From here on each process may tell its own errors; progress remains the first one's. */
void job_heard(struct job *j, struct common *c)
{
    if (j->kept >= 0) {
        dup2(j->kept, STDERR_FILENO);
        close(j->kept);
        j->kept = -1;
    }
    if (j->h.rank > 0) c->quiet = true;
}

/* The byte 0 at the end keeps "ab", "c" apart from "a", "bc". */
static uint64_t mix_text(uint64_t h, const char *s)
{
    for (; *s != '\0'; s++) h = digest_mix(h, (unsigned char)*s);
    return digest_mix(h, 0);
}

/* Of the build, whose results travel as bytes, and of the runs with their order. */
static int64_t digest_of(const struct plan *p)
{
    const struct build b = store_build();
    uint64_t h = mix_text(mix_text(mix_text(DIGEST_START, b.git), b.compiler), b.flags);
    for (int i = 0; i < p->nrun; i++)
        h = digest_mix(mix_text(h, p->run[i].config_hash), (uint64_t)p->run[i].rep);
    return (int64_t)h;
}

/* Every process learns how all the others fare, so that all go on or none does. */
bool job_agree(struct job *j, const struct plan *p, bool ok, struct err *e)
{
    if (!j->on) return ok;
    /* Two numbers from each: whether it is ready, and what it would run. */
    const int64_t mine[2] = {ok, ok ? digest_of(p) : 0};
    int64_t *all = calloc((size_t)j->h.size, sizeof mine);
    CHECK(all != NULL);
    if (!j->h.call->gather(mine, 2, all))
        ok = err_set(e, ERR_INTERNAL, "%s cannot reach all processes", j->h.call->library);
    /* All come to the same verdict. The first process tells its own error, or which other one
     * has one. */
    bool equal = true;
    for (int i = 0; i < j->h.size; i++) {
        const bool same = all[2 * i] != 0 && all[2 * i + 1] == all[1];
        if (equal && !same && i > 0 && j->h.rank == 0)
            ok = err_set(e, ERR_DATA,
                         all[2 * i] == 0 ? "process %d of the job could not read the plan"
                                         : "process %d of the job has another plan or another "
                                           "build of this program",
                         i);
        equal = equal && same;
    }
    /* What went wrong on all is told once. */
    if (j->h.rank > 0 && all[0] == 0) err_clear(e);
    j->agreed = equal;
    free(all);
    return ok && equal;
}

/* The levels that the first process has settled, -1 where the plan's own holds. */
static bool share_levels(const struct job *j, const struct plan *p, struct run_spec *run,
                         struct err *e)
{
    int *level = calloc((size_t)p->nrun, sizeof *level);
    const size_t bytes = (size_t)p->nrun * sizeof *level;
    struct hosts_message m;
    bool there, ok = true;
    CHECK(level != NULL);
    /* Only what differs from the plan is sent as a level. */
    for (int i = 0; i < p->nrun; i++) {
        const enum network_level l = run[i].machine.network.level;
        level[i] = l == p->run[i].machine.network.level ? -1 : (int)l;
    }
    for (int i = 1; j->h.rank == 0 && i < j->h.size; i++)
        ok = ok && j->h.call->send(i, TAG_LEVELS, level, bytes);
    /* The size is compared: another plan would have passed the agreement only by a fault. */
    if (j->h.rank > 0)
        ok = j->h.call->look(0, TAG_LEVELS, true, &there, &m) && m.bytes == bytes &&
             j->h.call->receive(&m, level);
    /* As the first process did, so that identities and seeds follow. */
    for (int i = 0; ok && j->h.rank > 0 && i < p->nrun; i++) {
        if (level[i] < 0) continue;
        struct level_choice unused;
        struct level_error taken = {.error = 0};
        const char *name = network_level_name((enum network_level)level[i]);
        text_copy(taken.level, sizeof taken.level, name);
        level_take(&run[i], &taken, &unused, p->arena);
    }
    free(level);
    return ok || err_set(e, ERR_INTERNAL, "%s cannot reach all processes", j->h.call->library);
}

bool job_run(struct job *j, const struct plan *p, struct run_spec *run,
             const struct run_order *order, const bool *skip, const struct common *c,
             run_done_fn *done, void *context, struct err *e)
{
    j->started = true;
    return share_levels(j, p, run, e) &&
           run_campaign_hosts(&j->h, run, order, p->nrun, skip, c->jobs > 0 ? c->jobs : 1, c->quiet,
                              done, context, &j->gone, e);
}

/* One run on all processes. *gone: one of them does not answer. */
static bool spread_one(const struct job *j, const struct run_spec *run,
                       const struct run_order *order, int number, struct run_cache *cache,
                       run_done_fn *done, void *context, bool *gone)
{
    struct arena *arena = arena_create();
    struct run_result result;
    struct run_order own = *order;
    struct err why;
    err_clear(&why);
    own.hosts = &j->h;
    own.job_run = number;
    own.sums = !run_entries_ranks(run->nrank); /* what is not stored is not sent */
    /* What cannot be made is refused by all in the same words. */
    if (!run_sharing(run, &own, cache, arena, &result, &why)) {
        result = run_refused(&why);
        result.nrank = run->nrank;
    }
    /* Only the first process stores and prints. */
    *gone = result.job_broken;
    const bool ok = j->h.rank > 0 || done(context, run, &result);
    arena_destroy(arena);
    return ok;
}

bool job_spread(struct job *j, const struct plan *p, struct run_spec *run,
                const struct run_order *order, const bool *skip, job_begin_fn *begin,
                run_done_fn *done, void *context, struct err *e)
{
    bool *wanted = calloc((size_t)p->nrun, sizeof *wanted), ok = true, gone = false;
    CHECK(wanted != NULL);
    j->started = true;
    for (int i = 0; i < p->nrun; i++) wanted[i] = skip == NULL || !skip[i];
    if (!share_levels(j, p, run, e) ||
        !hosts_tell(&j->h, TAG_RUNS, wanted, (size_t)p->nrun * sizeof *wanted)) {
        free(wanted);
        return false;
    }
    /* All walk through the runs in step; each run spreads over all of them. */
    struct run_cache *cache = run_cache_create();
    for (int i = 0; i < p->nrun && ok && !gone; i++) {
        if (!wanted[i]) continue;
        ok = j->h.rank > 0 || begin(context, &run[i]);
        ok = ok && spread_one(j, &run[i], &order[i], i, cache, done, context, &gone);
    }
    run_cache_destroy(cache);
    free(wanted);
    /* Those that do not know would wait for ever. */
    if (gone || !ok) j->gone++;
    return ok;
}

int job_end(struct job *j, int status)
{
    static const struct timespec a_moment = {.tv_nsec = 100000000};
    if (!j->on) return status;
    /* Those that wait for the first process, or for one that has gone, would wait for ever. */
    if (j->h.rank == 0 && (j->gone > 0 || (j->agreed && !j->started))) {
        fflush(stdout);
        /* Launchers lose what was said just before, and MPI has no call that waits until they have
         * read it. Jobs that end well do not come here. */
        nanosleep(&a_moment, NULL);
        j->h.call->abort(status);
    }
    j->h.call->end();
    return status;
}

/* shared.c - see shared.h.
 *
 * Nothing here is in the way of the simulation: each process has kept what its own ranks left, adds
 * it up as far as that can be done there, and sends what is wanted of the rest once, in blocks.
 * Process 0 alone has room for all, as far as it is touched. */
#include "vp/shared.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/digest.h"
#include "hosts/hosts_copy.h"
#include "measure/rank_sums.h"
#include "vp/explain.h"
#include "vp/matching.h"
#include "vp/team.h"

enum tag {
    TAG_BUILT = 299,
    TAG_END,
    TAG_SIZES,
    TAG_TIMES,
    TAG_STAGES,
    TAG_DIGESTS,
    TAG_LOADS,
    TAG_OUTPUT,
    TAG_WAITING
};

bool shared_built(struct world *w, bool ok, struct err *e)
{
    return hosts_agree(w->load->hosts, TAG_BUILT, ok, e);
}

/* Sums decide, so that all processes come to the same end. */
enum shared_end shared_end(struct world *w)
{
    const struct hosts *h = w->load->hosts;
    if (w->broken) return SHARED_BROKEN;
    int64_t v[2] = {w->nfinished, w->failed || w->late};
    if (!hosts_all_sum(h, TAG_END, v, 2)) return SHARED_BROKEN;
    return v[1] ? SHARED_FAILED : v[0] == w->nrank ? SHARED_FINISHED : SHARED_DEADLOCK;
}

/* --- outputs ---------------------------------------------------------------------------------- */

/* Which elements, then the elements themselves as one array. */
static bool send_outputs(struct world *w)
{
    const struct hosts *h = w->load->hosts;
    const struct published *p = w->published;
    int64_t total = 0, at = 0;
    for (int64_t i = 0; i < p->n; i++) total += p->interval[i].count;
    double *x = calloc((size_t)total + 1, sizeof *x);
    CHECK(x);
    for (int64_t i = 0; i < p->n; at += p->interval[i++].count)
        memcpy(x + at, w->load->output[p->interval[i].output].x + p->interval[i].first,
               (size_t)p->interval[i].count * sizeof *x);
    int64_t sizes[2] = {p->n, total};
    const bool ok =
        hosts_copy_out(h, 0, TAG_SIZES, sizes, sizeof sizes) &&
        hosts_copy_out(h, 0, TAG_OUTPUT, p->interval, (size_t)p->n * sizeof *p->interval) &&
        hosts_copy_out(h, 0, TAG_OUTPUT, x, (size_t)total * sizeof *x);
    free(x);
    return ok;
}

/* Elements that several processes published would be equal (comm.h: one rank each). */
static bool receive_outputs(struct world *w, int from)
{
    const struct hosts *h = w->load->hosts;
    int64_t sizes[2], at = 0;
    if (!hosts_copy_in(h, from, TAG_SIZES, sizes, sizeof sizes)) return false;
    struct interval *interval = calloc((size_t)sizes[0] + 1, sizeof *interval);
    double *x = calloc((size_t)sizes[1] + 1, sizeof *x);
    CHECK(interval && x);
    const bool ok =
        hosts_copy_in(h, from, TAG_OUTPUT, interval, (size_t)sizes[0] * sizeof *interval) &&
        hosts_copy_in(h, from, TAG_OUTPUT, x, (size_t)sizes[1] * sizeof *x);
    for (int64_t i = 0; ok && i < sizes[0]; at += interval[i++].count)
        memcpy(w->load->output[interval[i].output].x + interval[i].first, x + at,
               (size_t)interval[i].count * sizeof *x);
    free(x);
    free(interval);
    return ok;
}

/* --- times and accounts ----------------------------------------------------------------------- */

/* The latest of all ranks, on all processes. */
static bool find_makespan(struct world *w)
{
    struct run_result *r = w->result;
    for (int i = w->first; i < w->first + w->nown; i++) {
        r->finish_ps[i] = w->vp[i].finish;
        if (r->finish_ps[i] > r->makespan_ps) r->makespan_ps = r->finish_ps[i];
    }
    return hosts_all_largest(w->load->hosts, TAG_TIMES, &r->makespan_ps, 1);
}

/* In rank order, as collect in world.c mixes it: from process to process, and back to the first. */
static bool mix_digest(struct world *w)
{
    const struct hosts *h = w->load->hosts;
    uint64_t *digest = &w->result->digest;
    *digest = digest_mix(DIGEST_START, sim_digest(w->sim));
    if (h->rank > 0 && !hosts_copy_in(h, h->rank - 1, TAG_DIGESTS, digest, sizeof *digest))
        return false;
    for (int i = w->first; i < w->first + w->nown; i++)
        *digest = digest_mix(digest_mix(*digest, w->vp[i].digest), (uint64_t)w->vp[i].finish);
    const int next = (h->rank + 1) % h->size;
    if (h->size > 1 && !hosts_copy_out(h, next, TAG_DIGESTS, digest, sizeof *digest)) return false;
    return h->rank > 0 || h->size == 1 ||
           hosts_copy_in(h, h->size - 1, TAG_DIGESTS, digest, sizeof *digest);
}

/* What each process can do for its own ranks. */
static bool add_up(struct world *w)
{
    struct run_result *r = w->result;
    int64_t sum[3] = {fiber_pool_switches(w->fibers), 0, 0};
    for (int i = w->first; i < w->first + w->nown; i++) {
        struct stage_time *row = r->stage + (size_t)i * ((size_t)w->nstage + 1);
        row[w->nstage].wait_ps += r->makespan_ps - r->finish_ps[i];
        for (int k = 0; k < w->nstage; k++) sum[1] += row[k].messages, sum[2] += row[k].bytes;
    }
    if (!hosts_sum(w->load->hosts, TAG_SIZES, sum, 3)) return false;
    r->switches = sum[0], r->messages = sum[1], r->bytes = sum[2];
    return true;
}

/* Sums and extremes of all ranks, in the order of processes; the ranks' own times are not sent. */
static bool join_sums(struct world *w)
{
    const struct hosts *h = w->load->hosts;
    struct run_result *r = w->result;
    struct rank_sums *more = TAKE(w->scratch, 1, struct rank_sums);
    r->sums = TAKE(w->arena, 1, struct rank_sums);
    rank_sums_make(r, w->first, w->first + w->nown, r->sums);
    r->stage = NULL;
    r->finish_ps = NULL;
    if (h->rank > 0) return hosts_copy_out(h, 0, TAG_STAGES, r->sums, sizeof *r->sums);
    for (int i = 1; i < h->size; i++) {
        if (!hosts_copy_in(h, i, TAG_STAGES, more, sizeof *more)) return false;
        rank_sums_add(r->sums, more);
    }
    return true;
}

/* Node i's injection port is resource i; at the level that processes share, nothing else is
 * loaded. */
static bool send_part(struct world *w)
{
    const struct hosts *h = w->load->hosts;
    const size_t n = (size_t)w->nown, row = (size_t)w->nstage + 1;
    bool ok = w->load->sums ||
              (hosts_copy_out(h, 0, TAG_TIMES, w->result->finish_ps + w->first,
                              n * sizeof(int64_t)) &&
               hosts_copy_out(h, 0, TAG_STAGES, w->result->stage + (size_t)w->first * row,
                              n * row * sizeof *w->result->stage));
    for (int i = w->first; ok && i < w->first + w->nown; i++) {
        const struct link_load *load = net_port_load(w->net, w->placement.node[i]);
        ok = load == NULL || hosts_copy_out(h, 0, TAG_LOADS, load, sizeof *load);
    }
    return ok && (w->load->keeps_outputs || send_outputs(w));
}

/* The other end of send_part, in its order. */
static bool receive_part(struct world *w, int from)
{
    const struct hosts *h = w->load->hosts;
    const size_t row = (size_t)w->nstage + 1;
    int first, end;
    team_part(w->load, from, &first, &end);
    const size_t n = (size_t)(end - first);
    bool ok = w->load->sums ||
              (hosts_copy_in(h, from, TAG_TIMES, w->result->finish_ps + first,
                             n * sizeof(int64_t)) &&
               hosts_copy_in(h, from, TAG_STAGES, w->result->stage + (size_t)first * row,
                             n * row * sizeof *w->result->stage));
    /* The network's own, of which copy_links makes the result's. */
    for (int i = first; ok && i < end; i++) {
        struct link_load *load = net_port_load(w->net, w->placement.node[i]);
        ok = load == NULL || hosts_copy_in(h, from, TAG_LOADS, load, sizeof *load);
    }
    return ok && (w->load->keeps_outputs || receive_outputs(w, from));
}

/* One process after the other: process 0 has room for one more part at a time beside the result. */
bool shared_collect(struct world *w)
{
    const struct hosts *h = w->load->hosts;
    int overflowed;
    w->result->stack_peak_bytes = fiber_pool_stack_peak(w->fibers, &overflowed);
    /* One process alone cannot end the run in good order: what it wrote over is not known. */
    if (overflowed >= 0) check_failed(__FILE__, __LINE__, "a rank's stack was not enough");
    if (!find_makespan(w) || !mix_digest(w) || !add_up(w)) return false;
    /* Stacks are no longer needed, and make room for what comes. */
    /* (A run that did not end well is explained from them, and does not come here.) */
    fiber_pool_destroy(w->fibers);
    w->fibers = NULL;
    if (w->load->sums && !join_sums(w)) return false;
    if (h->rank > 0) return send_part(w);
    for (int i = 1; i < h->size; i++)
        if (!receive_part(w, i)) return false;
    return true;
}

/* --- deadlocks -------------------------------------------------------------------------------- */

/* What deadlock_explain says of a rank that waits. */
struct waiting {
    struct comm_request request;
    int32_t rank, stage, what, line;
    sim_ps reached; /* of the last record: how far its process came */
    char file[64], request_file[64];
};

/* Texts are copied: addresses of one process mean nothing in another. */
static void describe(const struct vp *v, struct waiting *x)
{
    *x = (struct waiting){
        .rank = v->comm.rank, .stage = v->stage, .what = v->waiting_for, .line = v->comm.line};
    if (v->comm.file) strncpy(x->file, v->comm.file, sizeof x->file - 1);
    if (!v->waiting) return;
    x->request = *v->waiting;
    if (v->waiting->file) strncpy(x->request_file, v->waiting->file, sizeof x->request_file - 1);
}

/* As if it were a rank of this process. */
static void put_in_place(struct world *w, const struct waiting *x)
{
    struct vp *v = &w->vp[x->rank];
    struct comm_request *r = TAKE(w->scratch, 1, struct comm_request);
    *r = x->request;
    r->file = arena_text(w->scratch, x->request_file);
    v->comm.rank = x->rank;
    v->comm.file = arena_text(w->scratch, x->file);
    v->comm.line = x->line;
    v->stage = x->stage;
    v->waiting_for = (enum waiting_for)x->what;
    v->waiting = r;
    v->world = w;
}

/* Ranks that have finished are not sent: in fresh memory they wait for nothing, which is what they
 * are asked for. */
bool shared_gather_waiting(struct world *w)
{
    const struct hosts *h = w->load->hosts;
    int64_t inside = w->barrier_count;
    bool ok = hosts_sum(h, TAG_WAITING, &inside, 1);
    w->barrier_count = (int)inside;
    struct waiting x = {.rank = -1};
    /* A record for each rank that waits, and one that says there are no more. */
    if (h->rank > 0) {
        for (int i = w->first; ok && i < w->first + w->nown; i++) {
            if (w->vp[i].waiting_for == WAITING_NOTHING) continue;
            describe(&w->vp[i], &x);
            ok = hosts_copy_out(h, 0, TAG_WAITING, &x, sizeof x);
        }
        x.rank = -1; /* no more */
        x.reached = deadlock_reached(w, w->first, w->nown);
        return ok && hosts_copy_out(h, 0, TAG_WAITING, &x, sizeof x);
    }
    /* Every rank here tells the same count of a barrier. */
    for (int i = w->first; i < w->first + w->nown; i++) w->vp[i].world->barrier_count = (int)inside;
    sim_ps reached = deadlock_reached(w, w->first, w->nown);
    for (int from = 1; ok && from < h->size; from++) {
        while ((ok = hosts_copy_in(h, from, TAG_WAITING, &x, sizeof x)) && x.rank >= 0)
            put_in_place(w, &x);
        if (ok && x.reached > reached) reached = x.reached;
    }
    w->result->makespan_ps = reached;
    return ok;
}

/* run_row.c - sums and extremes over the ranks of a run.
 *
 * All from the times by rank and stage that the run has recorded: nothing is kept up while it runs,
 * so that measuring costs the simulation nothing. */
#include "measure/run_row.h"

#include <stdlib.h>

/* The parts of a rank's time: they do not overlap. */
int64_t stage_time_total(const struct stage_time *t)
{
    return t->compute_ps + t->send_ps + t->recv_ps + t->wait_ps + t->contention_ps;
}

/* A stage that a rank never entered: no line in tables. */
bool stage_time_idle(const struct stage_time *t)
{
    return stage_time_total(t) == 0 && t->messages == 0 && t->work.flop == 0;
}

/* The sum is dropped where it does not fit; least and most always do. */
static void spread_add(struct spread *p, int64_t v)
{
    if (__builtin_add_overflow(p->sum, v, &p->sum)) p->fits = false;
    if (v < p->min) p->min = v;
    if (v > p->max) p->max = v;
}

/* O(P): one pass over the ranks. `none` is the neutral element of sum, minimum and maximum. */
struct stage_row stage_row_make(const struct run_result *r, int stage)
{
    const struct spread none = {0, INT64_MAX, INT64_MIN, true};
    struct stage_row row = {r->stage_name[stage], none, none, none, none, none, none, {0}};
    for (int k = 0; k < r->nrank; k++) {
        const struct stage_time *t = &r->stage[(int64_t)k * r->nstage + stage];
        spread_add(&row.compute, t->compute_ps);
        spread_add(&row.send, t->send_ps);
        spread_add(&row.recv, t->recv_ps);
        spread_add(&row.wait, t->wait_ps);
        spread_add(&row.contention, t->contention_ps);
        spread_add(&row.total, stage_time_total(t));
        /* Counts cannot pass 64 bits: no run has that many messages. */
        row.all.messages += t->messages;
        row.all.bytes += t->bytes;
        work_add(&row.all.work, &t->work);
    }
    return row;
}

/* Of one rank: its computing, and whether its parts add up to the makespan: an error of the
 * simulator's accounts would show here. */
static void summarise_rank(const struct run_result *r, int rank, struct rank_summary *u)
{
    int64_t sum = 0, compute = 0;
    for (int i = 0; i < r->nstage; i++) {
        const struct stage_time *t = &r->stage[(int64_t)rank * r->nstage + i];
        sum += stage_time_total(t);
        compute += t->compute_ps;
    }
    /* Every rank's time runs to the end of the run: who ends early idles until then. */
    int64_t error = llabs(sum - r->makespan_ps);
    if (error > u->accounting_error) u->accounting_error = error;
    if (compute < u->compute_min) u->compute_min = compute;
    if (compute > u->compute_max) u->compute_max = compute;
}

/* Where no times of ranks were recorded there are no extremes to tell. */
static struct rank_summary summarise_ranks(const struct run_result *r)
{
    struct rank_summary u = {.compute_min = INT64_MAX, .finish_min = INT64_MAX};
    u.has_stages = r->stage != NULL && r->nrank > 0;
    u.has_finish = r->finish_ps != NULL && r->nrank > 0;
    for (int k = 0; k < r->nrank && u.has_stages; k++) summarise_rank(r, k, &u);
    for (int k = 0; k < r->nrank && u.has_finish; k++) {
        if (r->finish_ps[k] < u.finish_min) u.finish_min = r->finish_ps[k];
        if (r->finish_ps[k] > u.finish_max) u.finish_max = r->finish_ps[k];
    }
    return u;
}

/* What the columns read: pointers to spec and result, and what must be summed up first. */
struct run_row run_row_make(const struct run_spec *spec, const struct run_order *order,
                            const struct run_result *r)
{
    struct run_row row = {.spec = spec, .order = order, .result = r, .ranks = summarise_ranks(r)};
    /* An empty text, not NULL: nothing was left out. */
    text_add(&row.left_out, "%s", "");
    for (int i = 0; i < r->nomission; i++)
        text_add(&row.left_out, "%s%s: %s", i > 0 ? "; " : "", r->omission[i].what,
                 r->omission[i].why);
    return row;
}

void run_row_free(struct run_row *row) { text_free(&row->left_out); }

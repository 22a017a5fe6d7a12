/* rank_sums.c - see rank_sums.h.
 *
 * All from the times by rank and stage that the run has recorded: nothing is kept up while it runs,
 * so that measuring costs the simulation nothing. */
#include "measure/rank_sums.h"

#include <stdlib.h>

/* The neutral element of sum, minimum and maximum. */
static const struct spread none = {0, INT64_MAX, INT64_MIN, true};

/* The parts of a rank's time: they do not overlap. */
int64_t stage_time_total(const struct stage_time *t)
{
    return t->compute_ps + t->send_ps + t->recv_ps + t->wait_ps + t->contention_ps;
}

/* The sum is dropped where it does not fit; least and most always do. */
static void spread_add(struct spread *p, int64_t v)
{
    if (__builtin_add_overflow(p->sum, v, &p->sum)) p->fits = false;
    if (v < p->min) p->min = v;
    if (v > p->max) p->max = v;
}

/* No time is negative: what fits together has fitted in parts. */
static void spread_join(struct spread *p, const struct spread *more)
{
    if (__builtin_add_overflow(p->sum, more->sum, &p->sum) || !more->fits) p->fits = false;
    if (more->min < p->min) p->min = more->min;
    if (more->max > p->max) p->max = more->max;
}

/* O(ranks): one pass. */
static struct stage_row row_of(const struct run_result *r, int stage, int first, int end)
{
    struct stage_row row = {NULL, none, none, none, none, none, none, {0}};
    for (int k = first; k < end; k++) {
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
static struct rank_summary summarise(const struct run_result *r, int first, int end)
{
    struct rank_summary u = {.compute_min = INT64_MAX, .finish_min = INT64_MAX};
    u.has_stages = r->stage != NULL && end > first;
    u.has_finish = r->finish_ps != NULL && end > first;
    for (int k = first; k < end && u.has_stages; k++) summarise_rank(r, k, &u);
    for (int k = first; k < end && u.has_finish; k++) {
        if (r->finish_ps[k] < u.finish_min) u.finish_min = r->finish_ps[k];
        if (r->finish_ps[k] > u.finish_max) u.finish_max = r->finish_ps[k];
    }
    return u;
}

/* Stages beyond the run's own stay zero, so that the sums of two parts can be joined whole. */
void rank_sums_make(const struct run_result *r, int first, int end, struct rank_sums *s)
{
    *s = (struct rank_sums){0};
    for (int i = 0; i < r->nstage; i++) s->stage[i] = row_of(r, i, first, end);
    s->ranks = summarise(r, first, end);
}

/* Of one stage: each kind of time by itself, and what was counted. */
static void join_rows(struct stage_row *row, const struct stage_row *more)
{
    spread_join(&row->compute, &more->compute);
    spread_join(&row->send, &more->send);
    spread_join(&row->recv, &more->recv);
    spread_join(&row->wait, &more->wait);
    spread_join(&row->contention, &more->contention);
    spread_join(&row->total, &more->total);
    row->all.messages += more->all.messages;
    row->all.bytes += more->all.bytes;
    work_add(&row->all.work, &more->all.work);
}

/* Extremes of what was not recorded are the neutral ones, so that nothing has to be asked. */
void rank_sums_add(struct rank_sums *s, const struct rank_sums *more)
{
    struct rank_summary *u = &s->ranks;
    const struct rank_summary *v = &more->ranks;
    for (int i = 0; i < RUN_MAX_STAGES; i++) join_rows(&s->stage[i], &more->stage[i]);
    u->has_stages = u->has_stages || v->has_stages;
    u->has_finish = u->has_finish || v->has_finish;
    if (v->accounting_error > u->accounting_error) u->accounting_error = v->accounting_error;
    if (v->compute_min < u->compute_min) u->compute_min = v->compute_min;
    if (v->compute_max > u->compute_max) u->compute_max = v->compute_max;
    if (v->finish_min < u->finish_min) u->finish_min = v->finish_min;
    if (v->finish_max > u->finish_max) u->finish_max = v->finish_max;
}

/* Where the ranks were divided among processes, their sums are all there is. */
struct stage_row stage_row_make(const struct run_result *r, int stage)
{
    struct stage_row row = r->sums ? r->sums->stage[stage] : row_of(r, stage, 0, r->nrank);
    row.name = r->stage_name[stage];
    return row;
}

/* As stage_row_make: what was joined before, or made now of all ranks. */
struct rank_summary rank_summary_make(const struct run_result *r)
{
    return r->sums ? r->sums->ranks : summarise(r, 0, r->nrank);
}

/* accuracy_network.c - the network ladder: the same program on every level, simulated times
 * compared with the finest level's. */
#include <math.h>
#include <stdio.h>

#include "base/progress.h"
#include "base/text.h"
#include "machine/node_cost.h"
#include "machine/topology.h"
#include "run/run.h"
#include "study/accuracy_ladder.h"
#include "study/trial.h"

enum { REPEATS = 3 };

/* One level. The least host time of a few runs: the others were disturbed. The simulated times
 * of all are the same, so the first one's are kept; what takes over half a second is not
 * repeated. */
static struct trial run_level(struct ladder *l, enum network_level level)
{
    struct run_spec spec = l->spec;
    spec.machine.network.level = level;
    spec.record = (struct record_spec){0};
    struct trial t = trial_run(&spec, l->model, l->state, l->arena);
    for (int i = 1; i < REPEATS && t.answered && t.host_s < 0.5; i++) {
        struct arena_mark mark = arena_mark(l->arena);
        t.host_s = fmin(t.host_s, trial_run(&spec, l->model, l->state, l->arena).host_s);
        arena_release(l->arena, mark);
    }
    return t;
}

/* Relative error of the simulated run time; NAN when the reference has none. */
static double makespan_error(int64_t ps, const struct trial *finest)
{
    double reference = (double)finest->makespan_ps;
    return reference > 0 ? fabs((double)ps - reference) / reference : NAN;
}

/* Largest difference of a rank's finishing time over the makespan; `finish` NULL: all end at
 * `end_ps`. A makespan may agree by chance while ranks finish at other times: this error would show
 * it. */
static double finish_error(const int64_t *finish, int64_t end_ps, const struct trial *finest,
                           int nrank)
{
    double largest = 0;
    for (int i = 0; i < nrank; i++)
        largest =
            fmax(largest, fabs((double)((finish ? finish[i] : end_ps) - finest->finish_ps[i])));
    return finest->makespan_ps > 0 ? largest / (double)finest->makespan_ps : NAN;
}

/* Two rows of one level: makespan and finish times. makespan_ps < 0: the level gave no answer,
 * for the reason `why`. */
static void add_rows(struct ladder *l, const char *name, int64_t makespan_ps, const int64_t *finish,
                     double host_s, const char *why, const struct trial *finest,
                     const char *finest_name)
{
    for (int k = 0; k < 2; k++) {
        struct accuracy_rung *r =
            ladder_add(l, name, name, k == 0 ? "makespan" : "finish times", finest_name);
        text_copy(r->text, sizeof r->text, why);
        if (makespan_ps < 0) continue;
        r->host_s = host_s;
        r->machine_ps = makespan_ps;
        /* Half of the reference is still a figure to plan with; ten times as much is none. */
        ladder_grade(r, k == 0 ? makespan_error(makespan_ps, finest)
                               : finish_error(finish, makespan_ps, finest, l->spec.nrank), 0.5, 10);
    }
}

/* The formula of a textbook: mean work of a rank, plus its messages, each paid in full over the
 * mean distance. Nothing overlaps and nobody waits, so it is an upper bound in that respect and
 * a lower one where ranks wait.
 *     t = (flops c_flop + messages t_m) / P
 *     t_m = o_s + o_r + bytes (copies + max(gap, 1 / bandwidth)) + (hops + 1) t_hop + t_end */
static bool closed_form(struct ladder *l, double *seconds, double *host_s)
{
    const struct machine_spec *m = &l->spec.machine;
    struct program_estimate x = {0};
    struct err e;
    err_clear(&e);
    struct program_run r;
    double begin = host_seconds();
    /* The counts are the program's own estimate (program.h), without a simulation. */
    struct topology *t = topology_create(&m->topology, l->arena, &e);
    if (!t || !trial_open(&r, &l->spec, l->model, l->state, l->arena, &e)) return false;
    r.type->estimate(&r, &x);
    run_close(&r);
    int P = l->spec.nrank;
    double hops = 0, bytes = x.messages > 0 ? x.bytes / x.messages : 0;
    /* Mean distance from node 0 to the other nodes that hold a rank: topologies are symmetric
     * enough. */
    for (int i = 1; i < P && i < t->nnode; i++) hops += topology_distance(t, 0, i);
    hops /= P > 1 ? P - 1 : 1;
    /* The software's parameters depend on the message size: those of the mean size. */
    const struct network_spec *n = &m->network;
    struct software_segment list[SOFTWARE_MAX_SEGMENTS];
    const int nlist = software_segments(&m->software, list);
    const struct software_segment *s = software_segment_of(list, nlist, (int64_t)bytes);
    double per_byte = fmax(s->gap_per_byte, n->link_bandwidth > 0 ? 1 / n->link_bandwidth : 0);
    /* A head passes a router more than it passes links. */
    double message = s->send_overhead + s->recv_overhead +
                     bytes * (s->send_copy + s->recv_copy + per_byte) +
                     (hops + 1) * n->hop_latency + n->end_latency;
    struct node_cost cost = node_cost_make(&m->node);
    *seconds = (x.flops * cost.flop * 1e-12 + x.messages * message) / P;
    *host_s = host_seconds() - begin;
    return *seconds > 0;
}

void ladder_network(struct ladder *l)
{
    /* All levels first: which one is the finest that answers is known only then. */
    struct trial t[LEVELS];
    enum network_level fine[LEVELS];
    int finest = -1;
    network_levels_by_fineness(fine);
    for (int i = 0; i < LEVELS; i++) t[i] = run_level(l, (enum network_level)i);
    for (int i = 0; i < LEVELS && finest < 0;
         i++) /* the finest that answers is the reference of the others */
        if (t[fine[i]].answered) finest = (int)fine[i];
    const char *reference = finest >= 0 ? network_level_name((enum network_level)finest) : "none";
    double seconds, host_s;
    /* The closed form is a rung like the others: the cheapest of all, and how wrong it is. */
    if (finest >= 0 && closed_form(l, &seconds, &host_s))
        add_rows(l, "closed form", (int64_t)(seconds * 1e12), NULL, host_s,
                 "mean work and messages of a rank, no overlap", &t[finest], reference);
    for (int i = 0; i < LEVELS; i++)
        add_rows(l, network_level_name((enum network_level)i),
                 t[i].answered ? t[i].makespan_ps : -1, t[i].finish_ps, t[i].host_s, t[i].text,
                 finest >= 0 ? &t[finest] : NULL, reference);
}

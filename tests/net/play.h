/* play.h - lists of messages, played by events and in cycles, for tests of both. */
#ifndef TESTS_NET_PLAY_H
#define TESTS_NET_PLAY_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "net/traffic.h"
#include "study/netcheck_case.h"

static inline int below(struct random *r, int n) { return (int)random_below(r, (uint64_t)n); }

/* A square torus or mesh with a node at each router. */
static inline struct topology_spec square(enum topology_family family, int side)
{
    return (struct topology_spec){.family = family,
                                  .ndim = 2,
                                  .dims = {side, side},
                                  .nodes_per_router = 1,
                                  .processors_per_node = 1,
                                  .tie = TIE_RANDOM};
}

/* n messages without dependencies. */
static inline struct traffic list_of(int n, struct arena *a)
{
    return (struct traffic){.nmessage = n,
                            .src = TAKE(a, n, int),
                            .dst = TAKE(a, n, int),
                            .bytes = TAKE(a, n, int64_t),
                            .time = TAKE(a, n, sim_ps),
                            .delay = TAKE(a, n, sim_ps)};
}

/* What a replay tells, with arrays in a. */
static inline bool play(const struct machine_spec *m, const struct traffic *q, bool singly,
                        struct arena *a, struct traffic_result *r, struct err *e)
{
    struct traffic list = *q;
    const struct topology *t = topology_create(&m->topology, a, e);
    if (!t) return false;
    list.singly = singly;
    *r = (struct traffic_result){.arrival = TAKE(a, q->nmessage, sim_ps),
                                 .injected = TAKE(a, q->nmessage, sim_ps),
                                 .uncontended = TAKE(a, q->nmessage, sim_ps)};
    return traffic_run(&list, m, t, a, true, r, e);
}

/* In cycles, where the list is for that; nobody asks for loads then. */
static inline void play_in_cycles(const struct machine_spec *m, const struct traffic *q,
                                  struct arena *a, const struct traffic_result *x, int trial,
                                  int *clocked)
{
    struct err e;
    err_clear(&e);
    const struct topology *t = topology_create(&m->topology, a, &e);
    struct traffic_result z = {.arrival = TAKE(a, q->nmessage, sim_ps),
                               .injected = TAKE(a, q->nmessage, sim_ps)};
    assert_true(t && traffic_run(q, m, t, a, false, &z, &e));
    *clocked += z.clocked;
    for (int i = 0; i < q->nmessage; i++)
        if (x->arrival[i] != z.arrival[i] || x->injected[i] != z.injected[i])
            fail_msg("trial %d, message %d of %d: %lld to %lld, in cycles %lld to %lld", trial, i,
                     q->nmessage, (long long)x->injected[i], (long long)x->arrival[i],
                     (long long)z.injected[i], (long long)z.arrival[i]);
    assert_int_equal(x->makespan, z.makespan);
    assert_int_equal(x->arrived, z.arrived);
    assert_int_equal(x->deadlock, z.deadlock);
    assert_string_equal(x->text, z.text);
}

#endif

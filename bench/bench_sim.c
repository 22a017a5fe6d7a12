/* bench_sim.c - what a fiber switch and an event cost, beside the least they could cost. Prints
 * ratios. */
#include <stdio.h>
#include <stdlib.h>

#include "base/progress.h"
#include "base/random.h"
#include "sim/event_queue.h"
#include "sim/fiber.h"

struct looper {
    struct fiber *fiber;
};

static void leave_for_ever(void *argument)
{
    struct looper *l = argument;
    for (;;) fiber_leave(l->fiber);
}

/* ns for one enter and one leave, round robin over n fibers. */
static double switch_ns(int n)
{
    struct err e;
    err_clear(&e);
    struct fiber_pool *p = fiber_pool_create(n, 64 * 1024, &e);
    struct looper *l = calloc((size_t)n, sizeof *l);
    for (int i = 0; i < n; i++) {
        l[i].fiber = fiber_start(p, i, leave_for_ever, &l[i]);
        fiber_enter(l[i].fiber);
    }
    int rounds = 20000000 / n / 2;
    double begin = host_seconds();
    for (int r = 0; r < rounds; r++)
        for (int i = 0; i < n; i++) fiber_enter(l[i].fiber);
    double ns = (host_seconds() - begin) / ((double)rounds * n) * 1e9;
    free(l);
    fiber_pool_destroy(p);
    return ns;
}

/* ns to take the first event and post another one a random time later, `pending` at a time (the
 * hold model). */
static double hold_ns(int pending, uint64_t spread)
{
    enum { OPERATIONS = 4000000 };
    struct event_queue q;
    event_queue_init(&q);
    struct random r = random_make(1, 0, 0);
    for (int i = 0; i < pending; i++) {
        struct event e = {(sim_ps)random_below(&r, spread), (uint64_t)i, NULL, NULL, 0};
        event_queue_push(&q, &e);
    }
    uint64_t *later = malloc(4096 * sizeof *later);
    for (int i = 0; i < 4096; i++) later[i] = random_below(&r, 2 * spread);
    double begin = host_seconds();
    for (int i = 0; i < OPERATIONS; i++) {
        struct event e;
        event_queue_pop(&q, &e);
        e.time += (sim_ps)later[i & 4095];
        event_queue_push(&q, &e);
    }
    double ns = (host_seconds() - begin) / OPERATIONS * 1e9;
    free(later);
    event_queue_done(&q);
    return ns;
}

int main(void)
{
    static const int fibers[] = {1, 128, 1024, 16384, 131072};
    printf("fiber enter and leave (%s), raw limit about 2 x 5 ns\n", fiber_backend());
    for (int i = 0; i < 5; i++) {
        double ns = switch_ns(fibers[i]);
        printf("  %7d fibers  %7.1f ns  ratio %5.2f\n", fibers[i], ns, ns / 10);
    }
    static const int pending[] = {100, 1000, 10000, 100000, 1000000};
    printf("event taken and posted, raw limit about 80 ns for a binary heap's replace at 1000 "
           "pending\n");
    for (int i = 0; i < 5; i++) {
        double wide = hold_ns(pending[i], 1000000), narrow = hold_ns(pending[i], 64);
        printf("  %7d pending  %7.1f ns (times 1 us apart)  %7.1f ns (64 ps apart)  ratio to 80 ns "
               "%5.2f\n",
               pending[i], wide, narrow, wide / 80);
    }
    return 0;
}

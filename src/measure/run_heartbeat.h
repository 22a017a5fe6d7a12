/* run_heartbeat.h - how far a run is while it runs, for people who wait: nothing here acts on a
 * result.
 *
 * It may lie in memory that another process reads, so its members are atomic; each is right, all
 * together may not be of one moment. */
#ifndef MEASURE_RUN_HEARTBEAT_H
#define MEASURE_RUN_HEARTBEAT_H

#include <stdatomic.h>
#include <stdint.h>

struct run_heartbeat {
    _Atomic int64_t events;      /* dispatched so far; 0: the simulation has not begun */
    _Atomic int ended, nrank;    /* ranks that ended, and all */
    _Atomic double begin;        /* host_seconds when the simulation began */
    void (*beat)(void *context); /* called when there is news, NULL: who wants to know looks */
    void *context;
};

#endif

/* probe_name.c - what the quantities of probe.h are called in files. */
#include <string.h>

#include "study/probe.h"

/* In the order of enum probe_quantity. */
static const char *const names[PROBE_QUANTITIES] = {
    "one-way",      "round-trip",  "bandwidth",    "r-inf",         "n-half",      "o-send",
    "o-recv",       "latency",     "gap",          "wire",          "read",        "bisection",
    "global",       "barrier",     "exchange",     "halves",        "linpack",     "stream-copy",
    "stream-scale", "stream-add",  "stream-triad", "inner-product", "memory-copy", "broadcast",
    "reduce",       "allreduce",   "gather",       "scatter",       "allgather",   "alltoall",
    "ring",         "random-ring", "b-eff",        "put",           "get",
};

const char *probe_name(enum probe_quantity q) { return names[q]; }

/* A name of no quantity gives PROBE_QUANTITIES. */
enum probe_quantity probe_find(const char *name)
{
    int q = 0;
    while (q < PROBE_QUANTITIES && strcmp(name, names[q]) != 0) q++;
    return (enum probe_quantity)q;
}

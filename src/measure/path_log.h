/* path_log.h - the insides of the graph of what binds (path.h), for the files that read all of it.
 */
#ifndef MEASURE_PATH_LOG_H
#define MEASURE_PATH_LOG_H

#include <stdbool.h>

#include "measure/path.h"

/* `before` has a number of 32 bits: 128 GiB of nodes. */
struct path_node {
    int64_t time, count; /* of computing: the number of its work, -1: not counted */
    uint32_t before;
    int32_t rank, resource;
    uint8_t cause, stage;
};

/* What came in time and binds nobody: `joined` would be later if `loser` were later by more than
 * time(joined) - lag - time(loser). */
struct path_loser {
    uint32_t loser, joined;
    int64_t lag;
};

/* Doubling keeps the cost of a node constant; nodes are found by number, so they may move. */
struct path_log {
    struct path_node *node;
    struct work *work;
    struct path_loser *loser;
    int64_t n, capacity, nwork, work_capacity, nloser, loser_capacity;
    bool keeps_losers;
};

#endif

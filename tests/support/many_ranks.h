/* many_ranks.h - comm.h for many ranks on one host thread without any simulator: fibers, a ready
 * queue, plain copies.
 *
 * No clocks, no network: messages arrive at once. What a kernel costs here is what it costs by
 * itself. */
#ifndef TESTS_SUPPORT_MANY_RANKS_H
#define TESTS_SUPPORT_MANY_RANKS_H

#include <stdbool.h>

#include "comm/comm.h"

enum { MANY_RANKS_STAGES = 16 };

struct many_ranks_result {
    int64_t messages, bytes;
    int64_t stage_messages[MANY_RANKS_STAGES];
    int64_t stage_bytes[MANY_RANKS_STAGES];
    struct work stage_work[MANY_RANKS_STAGES]; /* all ranks */
    int64_t reports;                           /* calls of comm_work */
    int64_t unread;                            /* messages that nobody received */
    int blocked;                               /* ranks that wait forever: a deadlock unless 0 */
    int64_t stack_bytes;                       /* deepest stack */
    /* When all is done if a rank sends one message and receives one at a time, each takes one
     * round, or a unit of time for each of its bytes, and nothing else takes any. */
    int64_t rounds, path;
};

typedef void many_ranks_program(struct comm *c, void *context);

/* many_ranks_run: `program` on nrank ranks to the end (or until nothing can happen). */
struct many_ranks_result many_ranks_run(int nrank, many_ranks_program *program, void *context);

/* many_ranks_publishing: the same, with room for what the ranks publish (comm_publish). */
struct many_ranks_result many_ranks_publishing(int nrank, many_ranks_program *program,
                                               void *context, const struct comm_output *output,
                                               int noutput);

#endif

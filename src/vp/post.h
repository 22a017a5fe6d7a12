/* post.h - messages between the processes of a run that several share (team.h), and the end of it.
 *
 * Letters are collected for each process, and sent and received by one thread. The run is over when
 * no process has anything to do and no letter is under way. Process 0 asks all, again and again,
 * how many letters they have sent and received: when all have nothing to do, and the sums of two
 * waves are one and the same number, then nothing was under way between them (Mattern's four
 * counters, Distributed Computing 2, 1987). */
#ifndef VP_POST_H
#define VP_POST_H

#include <stdbool.h>
#include <stdint.h>

#include "hosts/hosts.h"
#include "sim/sim.h"

/* What travels of a message. Two letters are none: a share of a barrier, and its end. */
enum { LETTER_ENTERS = -1, LETTER_LEAVES = -2 };
struct letter {
    int64_t id, tag, bytes; /* of the message */
    sim_ps arrival, uncontended, sent;
    int32_t to;     /* rank */
    int32_t hollow; /* no data follow */
};

enum post_state { POST_GOES_ON, POST_OVER, POST_FAILED, POST_BROKEN };

struct post;
typedef void post_take_fn(void *context, const struct letter *l, const void *data);

/* post_open: for one run; `run` the same number on all processes and another for each run.
 * post_close accepts NULL. */
struct post *post_open(const struct hosts *h, int run);
void post_close(struct post *p);

/* post_put: one more letter for `process`; data are copied. Any thread. */
void post_put(struct post *p, int process, const struct letter *l, const void *data);

/* post_serve: send what is there, receive what has come and hand each letter to `take`, and take
 * part in the counting; by one thread. idle: this process has nothing to do. failed: one of its
 * ranks has failed, which ends the run on all. *busy: something has happened. Returns how the run
 * stands. */
enum post_state post_serve(struct post *p, bool idle, bool failed, post_take_fn *take,
                           void *context, bool *busy);

#endif

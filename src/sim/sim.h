/* sim.h - simulated time, the event queue and the loop.
 *
 * Time is an integer number of picoseconds. Events are dispatched in the total order (time, lane,
 * age): lane says what kind of thing happens (lower first: arrivals before starts before
 * arbitration), age is the order of posting. An action may post events at the present time in the
 * present or a later lane, never in the past (CHECK). */
#ifndef SIM_SIM_H
#define SIM_SIM_H

#include <stdbool.h>
#include <stdint.h>

typedef int64_t sim_ps; /* simulated time [ps] */

#define SIM_NEVER INT64_MAX
#define SIM_PS_PER_S 1e12

struct sim;
typedef void sim_action(void *subject, uint64_t argument, sim_ps now);

/* sim_create, sim_destroy: an empty simulation at time 0; the caller owns it. */
struct sim *sim_create(void);
void sim_destroy(struct sim *s);

/* sim_at: call action(subject, argument, time) at `time`, in `lane` (0 .. 2^16-1). subject is
 * borrowed until then.
 *
 *   key   second part of the lane: orders events of one lane at one time (for example resource and
 * message number); equal keys go by age. 0 .. 2^48-1. */
void sim_at(struct sim *s, sim_ps time, unsigned lane, uint64_t key, sim_action *action,
            void *subject, uint64_t argument);

/* sim_foresee: from now on call early(subject, argument, step) for events with `action` shortly
 * before they are due, `steps` (1 or 2) times: step 0 a few events ahead, step 1 one or two events
 * ahead. It may ask for memory that the event will need, and must change nothing. Not every event
 * is announced. */
typedef void sim_early(void *subject, uint64_t argument, int step);
void sim_foresee(struct sim *s, sim_action *action, sim_early *early, int steps);

/* sim_step: dispatch the earliest event; false when there is none, or none that is due by PS_LAST
 * (picoseconds.h). */
bool sim_step(struct sim *s);

/* sim_step_before: the same for an event earlier than `time`, at most PS_LAST; false when there is
 * none. Then nothing may be posted before `time` until sim_step was called. */
bool sim_step_before(struct sim *s, sim_ps time);

/* sim_next_time: time of the earliest event, SIM_NEVER when there is none. */
sim_ps sim_next_time(const struct sim *s);

/* sim_pending: events posted and not yet dispatched. */
int64_t sim_pending(const struct sim *s);

/* sim_beyond: whether sim_step met an event that is due later than PS_LAST. */
bool sim_beyond(const struct sim *s);

/* sim_now: time of the event being, or last, dispatched [ps]. */
sim_ps sim_now(const struct sim *s);

/* sim_events, sim_ties, sim_digest: events dispatched; those at the same time and lane as the one
 * before; and the fingerprint of (time, lane, key) of all of them in order. */
int64_t sim_events(const struct sim *s);
int64_t sim_ties(const struct sim *s);
uint64_t sim_digest(const struct sim *s);

/* sim_from_seconds: nearest picosecond of a duration in seconds, >= 0; PS_TOO_LONG when it is
 * longer than PS_LAST. */
sim_ps sim_from_seconds(double seconds);

#endif

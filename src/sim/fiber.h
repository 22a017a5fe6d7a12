/* fiber.h - functions that can be left and entered again: stackful coroutines on one host thread.
 *
 * Stacks come from one mapping, reserved and not committed: only touched pages cost memory. Below
 * each stack lies a guard page as long as the system allows more of them (guard.h), and beyond that
 * a spare page that must stay untouched. */
#ifndef SIM_FIBER_H
#define SIM_FIBER_H

#include <stdbool.h>
#include <stdint.h>

#include "base/err.h"

struct fiber_pool;
struct fiber;
typedef void fiber_fn(void *argument);

/* fiber_pool_create: room for `n` fibers with stacks of `stack_bytes` each (rounded up to pages).
 * Returns NULL with ERR_INTERNAL when the address space cannot be had. */
struct fiber_pool *fiber_pool_create(int n, int64_t stack_bytes, struct err *e);
void fiber_pool_destroy(struct fiber_pool *p);

/* fiber_pool_create_packed: as above, with stacks of one page each, side by side and in large pages
 * where the system gives them: for fibers of which is known that they leave FIBER_PACKED_SPARE
 * bytes of it. There is no guard; one that uses more than it should writes over its neighbour's,
 * which fiber_pool_stack_peak then tells. Such a pool is not used again. */
enum { FIBER_PACKED_SPARE = 64 };
struct fiber_pool *fiber_pool_create_packed(int n, struct err *e);

/* fiber_packs: whether a page may be enough for a fiber at all: where configure knows how deep
 * calls go, in a program whose functions were all found when it began, as the dynamic linker would
 * look for them on the fiber's stack, without a library in front of the system's, and while no
 * signal has a handler that would run there: each of these takes most of a page. */
bool fiber_packs(void);

/* fiber_pool_again: a pool whose fibers have all returned, for `n` others: their stacks need not be
 * mapped and touched again, but fiber_pool_stack_peak goes on from those before. False where it has
 * no room for them, or stacks of another size: nothing has changed then. */
bool fiber_pool_again(struct fiber_pool *p, int n, int64_t stack_bytes);

/* fiber_pool_fill: the fibers started from now on fill the first page of their stacks, each a
 * different part of it at a time: all stacks begin at their tops, and none is shifted to keep hot
 * lines of different fibers apart, which would cost a second page. */
void fiber_pool_fill(struct fiber_pool *p);

/* fiber_start: make fiber number i (0 .. n-1) ready to run fn(argument) at its first
 * fiber_enter. */
struct fiber *fiber_start(struct fiber_pool *p, int i, fiber_fn *fn, void *argument);

/* fiber_enter: run f until it leaves or returns; called from outside any fiber. True while f has
 * not returned. */
bool fiber_enter(struct fiber *f);

/* fiber_prefetch: ask for the memory of f; fiber_prefetch_stack: a little later, for what
 * fiber_enter(f) will touch first of its stack; no effect but on speed. */
static inline void fiber_prefetch(const struct fiber *f) { __builtin_prefetch(f); }
void fiber_prefetch_stack(const struct fiber *f);

/* fiber_leave: go back to the caller of fiber_enter; returns at the next fiber_enter. Called inside
 * f. */
void fiber_leave(struct fiber *f);

/* fiber_pool_stack_peak: deepest stack use of any fiber so far [B]: in whole resident pages, of
 * packed stacks as far down as something was written. *overflowed: the fiber whose stack was not
 * enough, which shows in its spare page, or spare bytes, where there is no guard; -1: none. */
int64_t fiber_pool_stack_peak(const struct fiber_pool *p, int *overflowed);

/* fiber_below: the fiber below whose stack `address` is, in its guard or spare page; -1: none. May
 * be called in a signal handler. */
int fiber_below(const struct fiber_pool *p, const void *address);

/* fiber_pool_switches: number of fiber_enter calls so far. */
int64_t fiber_pool_switches(const struct fiber_pool *p);

/* fiber_backend: "fcontext" or "ucontext". */
const char *fiber_backend(void);

#endif

/* schedule.h - a schedule in memory: for each rank a graph of sends, receives and computing times.
 *
 * An operation starts when all it requires have finished, and all it requires to have started
 * (irequires) have. Operations are numbered through all ranks; those of a rank follow each other.
 */
#ifndef SCHEDULE_SCHEDULE_H
#define SCHEDULE_SCHEDULE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"

enum schedule_kind { SCHEDULE_SEND, SCHEDULE_RECEIVE, SCHEDULE_COMPUTE };

enum { SCHEDULE_ANY = -1 }; /* rank or tag of a receive */

/* Limits of what is read: beyond them a file is refused. */
enum { SCHEDULE_MOST_RANKS = 1 << 20, SCHEDULE_MOST_OPERATIONS = 1 << 28 };

struct schedule_op {
    int64_t size; /* bytes, or time in units of the schedule */
    int64_t tag;
    int32_t peer;
    int32_t line;  /* in the file, 0: none */
    int32_t needs; /* operations that it requires, in either way */
    uint8_t kind, cpu;
};

struct schedule {
    int nrank, ncpu;
    int64_t nop, nedge;
    int64_t unit_ps;        /* of computing times, 0: the file does not say */
    struct schedule_op *op; /* (nop) */
    int64_t *first;         /* (nrank + 1) the operations of rank r: first[r] .. first[r + 1] - 1 */
    int64_t *edge_first;    /* (nop + 1) */
    uint32_t *edge; /* (nedge) what waits for an operation: its number within the rank times two,
                       plus one where it waits for the start alone */
};

/* What is being put together: operations rank by rank, dependencies in any order. */
struct schedule_builder {
    struct schedule s;
    int64_t *begin; /* (nrank) where each rank's operations begin, -1: it has not come */
    int64_t *end;   /* (nrank) */
    int64_t op_capacity, ndependency, dependency_capacity;
    struct schedule_dependency *dependency;
};

struct schedule_dependency {
    int64_t op, on; /* numbers through all ranks; both of one rank */
    bool start;
};

/* schedule_begin: room for nrank ranks. schedule_add_op: one more operation of the rank in
 * progress, in `begin` and `end`; its number, -1: there are too many. schedule_add_dependency: op
 * requires `on`. schedule_discard: what was built, on the heap. */
void schedule_begin(struct schedule_builder *b, int nrank);
int64_t schedule_add_op(struct schedule_builder *b, const struct schedule_op *op);
bool schedule_add_dependency(struct schedule_builder *b, int64_t op, int64_t on, bool start);
void schedule_discard(struct schedule_builder *b);

/* schedule_finish: ranks in order, dependencies by what they wait for, all in `a`. Returns NULL
 * with ERR_DATA where operations wait for each other in a circle; `path` is for messages. */
struct schedule *schedule_finish(struct schedule_builder *b, const char *path, struct arena *a,
                                 struct err *e);

/* schedule_read: the file `path`, GOAL as text or as LogGOPSim's binary form. Returns NULL with
 * ERR_NO_INPUT, ERR_IO or ERR_DATA: file, line, what was found and expected. */
struct schedule *schedule_read(const char *path, struct arena *a, struct err *e);

/* goal_read_text, goal_read_binary: one form, from memory. goal_is_binary: by the first bytes. */
struct schedule *goal_read_text(const char *text, size_t n, const char *path, struct arena *a,
                                struct err *e);
struct schedule *goal_read_binary(const char *data, size_t n, const char *path, struct arena *a,
                                  struct err *e);
bool goal_is_binary(const char *data, size_t n);

#endif

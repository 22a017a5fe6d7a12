/* run_part.h - one of several processes that make a run together, for programs that make only what
 * the ranks of this part need.
 *
 * Room program knows no processes: whoever makes the run hands over these calls. All processes call
 * the same ones in the same order. Where open divides a run, it does so on all processes; outputs
 * stay where they were published; judge, check and baselines are called on all, and what they tell
 * counts on process 0. */
#ifndef PROGRAM_RUN_PART_H
#define PROGRAM_RUN_PART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/err.h"

struct run_part {
    int first, end;  /* its ranks: first .. end - 1 */
    int number, of;  /* this process, and how many there are, in the order of their ranks */
    const void *context;
    /* sum, largest: x (n), n <= 16, over all processes, the same on all of them afterwards.
     * give, take: bytes for process `to`, from process `from`. Each returns false when a process
     * does not answer.
     * agree: whether all processes can go on; called by all. `ok`: this one can, else *e says why
     * it cannot. False: one cannot, and *e tells on all of them why, in its own words. */
    bool (*sum)(const void *context, int64_t *x, int n);
    bool (*largest)(const void *context, int64_t *x, int n);
    bool (*give)(const void *context, int to, const void *data, size_t bytes);
    bool (*take)(const void *context, int from, void *data, size_t bytes);
    bool (*agree)(const void *context, bool ok, struct err *e);
};

#endif

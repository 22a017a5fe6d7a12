/* extremes.c - the largest numbers of all ranks (extremes.h). */
#include "kernel/extremes.h"

#include <math.h>

#include "base/check.h"
#include "comm/collectives.h"
#include "kernel/scan.h"

enum { MOST = 4 };

/* Not a number fails every comparison; it counts as infinite, so that no maximum loses it. */
real largest_size(real so_far, int n, const real *x)
{
    for (int i = 0; i < n; i++) {
        const real size = real_fabs(x[i]);
        if (size > so_far) so_far = size;
        if (!(size <= so_far)) so_far = (real)INFINITY;
    }
    return so_far;
}

/* Comparisons are not counted as work. */
static void take_larger(void *into, const void *with, bool before, int64_t n, void *context,
                        struct work *w)
{
    real *x = into;
    const real *y = with;
    (void)before, (void)context, (void)w;
    for (int64_t i = 0; i < n; i++)
        if (y[i] > x[i]) x[i] = y[i];
}

void largest_everywhere(struct comm *c, int tag, int n, real *x)
{
    /* Dissemination: ceil(log2 P) rounds for any P, all ranks at once, and every rank gets the
     * result. A value may arrive twice, which does not change a maximum. */
    const struct collective_op larger = {
        .combine = take_larger, .commutative = true, .idempotent = true};
    real in[MOST];
    CHECK(n <= MOST);
    struct collective_call k = {.kind = COLLECTIVE_ALLREDUCE, .comm = c, .tag = tag, .count = n};
    k.element = sizeof(real);
    k.op = &larger;
    k.send = k.recv = x;
    k.scratch = in;
    collective_run(collective_algorithm_find(COLLECTIVE_ALLREDUCE, "dissemination"), &k);
}

/* The ranks' worst residual decides for all of them: a collective, every rank calls it. */
bool refinement_begin(struct refinement *r, struct comm *c, int tag, real residual)
{
    real worst = largest_size(0, 1, &residual);
    r->before = 1;
    largest_everywhere(c, tag, 1, &worst);
    /* 1e6 eps: below it inverse dynamics would add more rounding errors than it removes. */
    return worst > (real)1e6 * REAL_EPSILON;
}

int refinement_run(struct comm *c, int tag, int most, bool sees, real *residual, real *scale,
                   bool (*correct)(void *solver, struct refinement *course), void *solver)
{
    /* of the answer itself; a correction has a residual of its own */
    const real first = *residual, size = *scale;
    struct refinement course = {.before = 1};
    int done = 0;
    bool going = most > 0 && refinement_begin(&course, c, tag, sees ? first : (real)INFINITY);
    /* all ranks go on or stop together: correct decides by numbers that all of them know */
    for (int pass = 0; going && pass < most; pass++) {
        going = correct(solver, &course);
        done += going;
    }
    /* the error that the last pass found */
    *residual = course.before < first ? course.before : first;
    *scale = size;
    return done;
}

/* Two maxima in one message: sizes of the correction and of the answer. */
bool refinement_accept(struct refinement *r, struct comm *c, int tag, int n, const real *correction,
                       const real *answer)
{
    real size[2] = {largest_size(0, n, correction), largest_size(0, n, answer)};
    largest_everywhere(c, tag, 2, size);
    /* Relative to the answer; an answer of zeros accepts no correction but a first one of zeros. */
    const real relative = size[1] > 0 ? size[0] / size[1] : size[0] > 0;
    /* Not smaller than the one before, or not a number: refinement has stopped converging. */
    if (!(relative < r->before)) return false;
    r->before = relative;
    return true;
}

/* program.c - what programs share: outputs, checks, baselines and lists of what is left out
 * (program.h). */
#include "program/program.h"

#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

/* Room for an output that the run needs; at least one number, so that it is never NULL. */
void program_want(struct program_run *r, int output, int64_t n, struct arena *a)
{
    CHECK(output >= 0 && output < PROGRAM_OUTPUTS);
    r->output[output] = (struct comm_output){TAKE(a, n > 0 ? n : 1, double), n};
}

/* Zeros until a rank publishes its part. */
double *program_output(const struct program_run *r, int output) { return r->output[output].x; }

/* Programs without a keeping of their own have it in the run's outputs. */
const double *program_answer(const struct program_run *r, int output, int64_t *n)
{
    if (r->type->answer != NULL) return r->type->answer(r, output, n);
    const bool there =
        output >= 0 && output < PROGRAM_OUTPUTS && r->output[output].x != NULL;
    *n = there ? r->output[output].n : 0;
    return *n > 0 ? r->output[output].x : NULL;
}

/* From another process: what would be outside is a damaged message, or a program's mistake. */
bool program_take(struct program_run *r, int output, int64_t first, int64_t n, const double *data,
                  char *why, int size)
{
    if (r->type->take != NULL) return r->type->take(r, output, first, n, data, why, size);
    /* What nobody wants is not kept, as in comm_publish_here. */
    if (output < 0 || output >= PROGRAM_OUTPUTS || r->output[output].x == NULL) return true;
    const struct comm_output *o = &r->output[output];
    if (first < 0 || n < 0 || first > o->n - n) {
        snprintf(why, (size_t)size, "elements %lld to %lld of output %d, which has %lld",
                 (long long)first, (long long)((uint64_t)first + (uint64_t)n - 1), output,
                 (long long)o->n); /* numbers from elsewhere: their sum may wrap */
        return false;
    }
    if (n > 0) memcpy(o->x + first, data, (size_t)n * sizeof *data);
    return true;
}

/* What the order of the run puts back is computed, and so it is not listed. */
void leave_out_add(struct left_out *l, unsigned keep, double bound, const char *what,
                   const char *why)
{
    if (l->keep & keep) return;
    CHECK(l->n < RUN_MAX_OMISSIONS);
    struct omission *o = &l->item[l->n++];
    *o = (struct omission){.keep = keep, .bound = bound};
    text_copy(o->what, sizeof o->what, what);
    text_copy(o->why, sizeof o->why, why);
}

/* Every comparison is kept; the first one that fails says what is wrong with the run. */
void program_check_add(struct run_result *out, const char *quantity, const char *reference,
                       double relative, double tolerance)
{
    CHECK(out->nerror < RUN_MAX_ERRORS);
    struct error_check *c = &out->error[out->nerror++];
    text_copy(c->quantity, sizeof c->quantity, quantity);
    text_copy(c->reference, sizeof c->reference, reference);
    c->relative = relative;
    c->tolerance = tolerance;
    if (relative <= tolerance) return; /* a NaN does not pass */
    if (out->status == RUN_OK)
        snprintf(out->text, sizeof out->text,
                 "%s differs from %s by %.3g (relative), more than %.3g", quantity, reference,
                 relative, tolerance);
    out->status = RUN_INVALID;
}

/* A serial code's operations at the price of the machine's processor. */
void program_baseline_add(struct run_result *out, const struct work_price *price, const char *name,
                          const struct work *w)
{
    CHECK(out->nbaseline < RUN_MAX_BASELINES);
    struct baseline *b = &out->baseline[out->nbaseline++];
    text_copy(b->name, sizeof b->name, name);
    b->time_ps = price->price_ps(price->context, w);
    b->work = *w;
}

/* The denominator of the speedup: the fastest of those from `first` on, the first one among
 * equals. */
void program_fastest_add(struct run_result *out, int first)
{
    int best = first;
    for (int i = first; i < out->nbaseline; i++)
        if (out->baseline[i].time_ps < out->baseline[best].time_ps) best = i;
    /* No serial code at all: nothing to divide by. */
    if (best == out->nbaseline) return;
    struct baseline fastest = out->baseline[best];
    text_copy(fastest.name, sizeof fastest.name, "fastest serial");
    CHECK(out->nbaseline < RUN_MAX_BASELINES);
    out->baseline[out->nbaseline++] = fastest;
}

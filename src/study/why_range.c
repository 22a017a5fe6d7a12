/* why_range.c - see why_range.h.
 *
 * Without contention the makespan is the longest of all paths, each of which is a straight line
 * over the factor on a parameter's time. So it is convex, and where the line of the path at factor
 * 1 crosses the line of the path at a larger factor, either another path is longer still, or that
 * is where the first one ends (Newton's method on the difference; C. Shen et al., "LLAMP: assessing
 * network latency tolerance of HPC applications with linear programming", SC 2024, has the same
 * from a linear program). With contention the lines hold only while the order of messages does, so
 * a search that does not end has no answer. */
#include "study/why_range.h"

#include <math.h>

#include "study/why_runs.h"

enum { MOST = 16, ROUNDS = 8 };

struct search {
    struct why_parameter *parameter;
    double trial;
};

double why_crossing(double y, double own, double x1, double y1, double other)
{
    /* y + own (x - 1) = y1 + other (x - x1) */
    if (own == other) return NAN;
    return (y - own - y1 + other * x1) / (other - own);
}

/* One trial: the next one, or the end of this search. */
static void take_trial(struct search *s, const struct run_spec *spec, const struct run_result *r,
                       double plain)
{
    struct why_parameter *p = s->parameter;
    const double x = s->trial, time = (double)r->makespan_ps, own = (double)p->time_ps;
    s->trial = 0;
    if (r->status > RUN_INVALID) return;
    /* Durations are rounded to picoseconds, each on its own. */
    const double close = 1e-6 * time + 1000;
    if (fabs(time - (plain + own * (x - 1))) <= close) {
        p->range = x;
        return;
    }
    const double slope = (double)why_contribution(spec, r, p->key) / x;
    const double next = why_crossing(plain, own, x, time, slope);
    /* Not between the two: the runs are of different orders of contention. */
    if (next > 1 && next < x * (1 - 1e-9)) s->trial = next;
}

bool why_ranges(const struct run_spec *spec, int workers, bool quiet, struct arena *a,
                struct why *w, struct err *e)
{
    struct search s[MOST];
    struct run_spec run[MOST];
    struct run_result result[MOST];
    int n = 0;
    for (int i = 0; i < w->nparameter && n < MOST; i++)
        if (w->parameter[i].tolerance > 0 && !w->parameter[i].same_path)
            s[n++] = (struct search){&w->parameter[i], w->parameter[i].tolerance};
    for (int k = 0; k < ROUNDS; k++) {
        int of[MOST], m = 0;
        for (int i = 0; i < n; i++) {
            if (s[i].trial == 0) continue;
            run[m] = why_bare(spec, true);
            why_scale(&run[m].machine, s[i].parameter->key, s[i].trial);
            of[m++] = i;
        }
        if (m == 0) break;
        if (!why_batch(run, m, workers, quiet, a, result, e)) return false;
        for (int i = 0; i < m; i++)
            take_trial(&s[of[i]], &run[i], &result[i], (double)w->run.makespan_ps);
    }
    return true;
}

/* load_search.c - the load at which a network saturates, by bisection between loads that were
 * decided (load.h). */
#include <math.h>

#include "study/load.h"

static const double finest = 0.01; /* width of the bracket, relative to its upper end */

int load_side(const struct load_point *p, double empty_ps)
{
    if (p->status == LOAD_UNSTABLE || p->status == LOAD_DEADLOCK) return 1;
    /* The interval, not the mean: a mean can cross the line by chance. */
    double far = p->mean_ps - LOAD_CRITERION * empty_ps;
    return far > p->half_ps ? 1 : far < -p->half_ps ? -1 : 0;
}

/* Probe a load and count it. */
static bool ask(struct load_series *s, double load, load_probe_fn *probe, void *context, int *side,
                struct err *e)
{
    struct load_point p;
    if (!probe(context, load, &p, e)) return false;
    *side = load_side(&p, s->empty_ps);
    s->probes++;
    return true;
}

/* The bound of the routes is where most networks give in, or a little above in a finite run. */
double load_first_probe(const struct load_series *s)
{
    return isfinite(s->bound) && s->bound < 0.9 ? 1.05 * s->bound : 1;
}

bool load_saturate(struct load_series *s, load_probe_fn *probe, void *context, struct err *e)
{
    double low = 0, high = load_first_probe(s);
    int side = 0;
    s->probes = 0;
    if (!ask(s, high, probe, context, &side, e)) return false;
    /* What holds there is asked at full load, and so is what cannot be told: no bracket ends there.
     */
    if (side <= 0 && high < 1) {
        low = side < 0 ? high : 0;
        high = 1;
        if (!ask(s, high, probe, context, &side, e)) return false;
    }
    s->low = side < 0 ? high : low;
    s->high = s->saturation = NAN;
    /* At full load the network still holds, or nobody can tell: `low` is then below 1. */
    if (side <= 0) return true;
    while (high - low > finest * high) {
        double middle = (low + high) / 2;
        if (!ask(s, middle, probe, context, &side, e)) return false;
        /* The answer is near the middle, and no load beside it is easier to tell. */
        if (side == 0) break;
        if (side > 0) high = middle;
        else low = middle;
    }
    s->low = low;
    s->high = high;
    s->saturation = (low + high) / 2;
    return true;
}

/* passes.c - see passes.h. The speed of a condition is told by multiplications and additions that
 * wait for nothing: of the operations that host_speed.h has they are slowed down most where another
 * program has the other half of a core. */
#include "reality/passes.h"

#include <math.h>
#include <string.h>

#include "base/progress.h"
#include "base/sorted.h"

void passes_add(struct passes *x, int i, const struct rate_sample *again)
{
    struct rate_sample *kept = &x->kept[i];
    if (x->made == 0) {
        *kept = *again;
        x->ratio[i] = 1; /* as long as there is no other */
        return;
    }
    if (x->made == 1) x->ratio[i] = again->seconds / kept->seconds;
    if (again->seconds < kept->seconds) *kept = *again;
}

static double slower_look(const struct rate_sample *s)
{
    return fmax(s->before.time[HOST_MULTIPLY_ADD], s->after.time[HOST_MULTIPLY_ADD]);
}

double passes_least(const struct passes *x, double least)
{
    for (int i = 0; i < x->n; i++) {
        const struct rate_sample *s = &x->kept[i];
        const double look =
            fmin(s->before.time[HOST_MULTIPLY_ADD], s->after.time[HOST_MULTIPLY_ADD]);
        if (least <= 0 || look < least) least = look;
    }
    return least;
}

bool passes_again(const struct rate_sample *s, double least)
{
    return slower_look(s) > (1 + PASSES_SAME) * least;
}

/* Changes of the points of one of them, behind the n that are there. */
static int changes_of(const struct passes *x, double *off, int n)
{
    for (int i = 0; i < x->n && x->made > 1; i++) {
        const double change = exp(fabs(log(x->ratio[i]))) - 1;
        if (change > PASSES_SAME) off[n++] = change;
    }
    return n;
}

int passes_changed(const struct passes *a, const struct passes *b, double *by)
{
    double off[2 * RATES_MOST];
    const int n = changes_of(b, off, changes_of(a, off, 0));
    sort_numbers(off, (size_t)n);
    *by = n > 0 ? off[n / 2] : 0;
    return n;
}

int passes_slow(const struct passes *x, double least)
{
    int n = 0;
    for (int i = 0; i < x->n; i++) n += passes_again(&x->kept[i], least);
    return n;
}

struct host_speed passes_speed(const struct passes *x)
{
    struct host_speed out = {0};
    double look[RATES_MOST];
    for (int o = 0; o < HOST_OPERATIONS && x->n > 0; o++) {
        for (int i = 0; i < x->n; i++)
            look[i] = (x->kept[i].before.time[o] + x->kept[i].after.time[o]) / 2;
        sort_numbers(look, (size_t)x->n);
        out.time[o] = look[x->n / 2];
    }
    return out;
}

bool passes_run(struct passes *x, const struct plan *p, const char *word, int samples,
                double seconds, double least, bool quiet, struct err *e)
{
    struct host_comm *comm = host_comm_create(NULL, e);
    struct run_cache *cache = run_cache_create();
    struct progress progress = progress_make(word, p->nrun, quiet);
    bool ok = comm != NULL;
    x->n = p->nrun < RATES_MOST ? p->nrun : RATES_MOST;
    for (int i = 0; ok && i < x->n; i++) {
        struct rate_sample one;
        if (least > 0 && !passes_again(&x->kept[i], least)) continue;
        ok = rate_sample_take(&p->run[i], comm, samples, seconds, cache, &one, e);
        if (ok) passes_add(x, i, &one);
        /* A point that other programs disturb now keeps the time that it has. */
        if (!ok && x->made > 0 && e->kind == ERR_BUSY) {
            err_clear(e);
            ok = true;
        }
        progress_show(&progress, i + 1);
    }
    x->made += ok;
    progress_end(&progress);
    run_cache_destroy(cache);
    host_comm_destroy(comm);
    return ok;
}

/* load_measure.c - all points of all curves by several threads, each stored at once
 * (load_curve.h).
 *
 * A piece of work is a point, or the search for the saturation of a curve, whose probes follow each
 * other. Threads share nothing but the list of work and the database, both behind one lock; a point
 * depends on its question alone, so their number changes no result. */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#include "app/load_curve.h"
#include "base/memory.h"
#include "base/progress.h"
#include "run/interrupt.h"

enum { MOST_THREADS = 64, SEARCH_WEIGHT = 8 }; /* a search is about so many points */

struct load_work {
    struct load_curve *curve;
    int point; /* number of the rate; -1: the saturation */
};

struct team {
    pthread_mutex_t lock; /* of all below */
    struct store *store;
    const struct load_options *options;
    struct load_work *work; /* (nwork) */
    int nwork, next, done;
    struct progress progress;
    struct interrupt interrupt;
    bool failed;
    struct err *err; /* of the first failure */
};

/* One search under way. */
struct searching {
    struct team *team;
    struct load_curve *curve;
};

/* A stored point, or a measured one that is stored then. Not under the lock while it is measured.
 */
static bool find_or_measure(struct team *t, struct load_curve *x, double offered, bool probe,
                            struct load_point *p, struct err *e)
{
    bool found = false;
    pthread_mutex_lock(&t->lock);
    bool ok = load_find_point(t->store, &x->series, offered, probe, &found, p, e);
    pthread_mutex_unlock(&t->lock);
    /* seconds, during which others look up and store */
    if (!ok || found) return ok;
    if (!load_measure(&x->question, offered, probe, p, e)) return false;
    pthread_mutex_lock(&t->lock);
    ok = load_store_point(t->store, &x->series, p, e);
    pthread_mutex_unlock(&t->lock);
    return ok;
}

/* Probes are stored as points are, so that an interrupted search does not begin anew. */
static bool probe_load(void *context, double offered, struct load_point *p, struct err *e)
{
    struct searching *s = context;
    return find_or_measure(s->team, s->curve, offered, true, p, e);
}

/* The saturation of a curve, stored with its series.
 *
 * A search is one piece of work: where it looks next depends on what it found.
 * Its probes are whole points all the same, with their own intervals, and the figure shows them
 * among the others: there are most of them where the curve bends. */
static bool do_search(struct team *t, struct load_curve *x, struct err *e)
{
    struct searching s = {t, x};
    if (!load_saturate(&x->series, probe_load, &s, e)) return false;
    pthread_mutex_lock(&t->lock);
    const bool ok = load_store_series(t->store, &x->series, e);
    pthread_mutex_unlock(&t->lock);
    return ok;
}

/* Either kind; each stores what it finds. */
static bool do_work(struct team *t, const struct load_work *w, struct err *e)
{
    if (w->point < 0) return do_search(t, w->curve, e);
    return find_or_measure(t, w->curve, t->options->rate[w->point], false,
                           &w->curve->point[w->point], e);
}

/* Take work until there is none, or somebody failed. */
static void *labour(void *context)
{
    struct team *t = context;
    /* the lock is held but while work is done */
    pthread_mutex_lock(&t->lock);
    while (!t->failed && t->next < t->nwork) {
        struct load_work *w = &t->work[t->next++];
        struct err e;
        err_clear(&e);
        pthread_mutex_unlock(&t->lock);
        const bool ok = do_work(t, w, &e);
        pthread_mutex_lock(&t->lock);
        /* the first failure is told; the others end with the point they are at */
        if (!ok && !t->failed) *t->err = e;
        t->failed = t->failed || !ok;
        t->done += w->point < 0 ? SEARCH_WEIGHT : 1;
        if (ok) atomic_fetch_add(&t->interrupt.stored, 1);
        progress_show(&t->progress, t->done);
    }
    pthread_mutex_unlock(&t->lock);
    return NULL;
}

/* This thread works, too; where no other can be had it works alone. */
static void labour_together(struct team *t, int nthread)
{
    pthread_t thread[MOST_THREADS];
    int n = 0;
    while (n < nthread - 1 && pthread_create(&thread[n], NULL, labour, t) == 0) n++;
    labour(t);
    for (int i = 0; i < n; i++) pthread_join(thread[i], NULL);
}

/* Searches first: they take longest. Then the points, the highest loads first, likewise.
 * The work of a thread that ends late is what everybody waits for. */
static void list_work(struct team *t, struct load_curve *list, int n)
{
    for (int i = 0; i < n && t->options->saturation; i++)
        t->work[t->nwork++] = (struct load_work){&list[i], -1};
    for (int i = 0; i < n; i++)
        for (int k = list[i].npoint - 1; k >= 0; k--)
            t->work[t->nwork++] = (struct load_work){&list[i], k};
}

/* Rows of the series before its points, so that an interrupted curve can be drawn. */
static bool store_all_series(const struct common *c, struct load_curve *list, int n,
                             struct store *s, struct err *e)
{
    bool ok = store_begin(s, e) && store_note_build(s, e);
    for (int i = 0; ok && i < n; i++)
        ok = (!c->force || load_forget(s, &list[i].series, e)) &&
             load_add_series(s, &list[i].series, e);
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}

bool load_curves_measure(const struct common *c, const struct load_options *o,
                         struct load_curve *list, int n, struct store *s, struct err *e)
{
    if (!store_all_series(c, list, n, s, e)) return false;
    /* as campaigns do: a thread for each processor unless told otherwise */
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    /* more would only wait for each other */
    int nthread = c->jobs > 0 ? c->jobs : processors > 1 ? (int)processors : 1;
    struct team t = {.store = s, .options = o, .err = e};
    /* a search and all rates of each curve */
    t.work = memory_take((size_t)n * (size_t)(o->nrate + 1), sizeof *t.work);
    list_work(&t, list, n);
    pthread_mutex_init(&t.lock, NULL);
    /* a search shows as the points that it is likely to take */
    t.progress = progress_make("points of load curves",
                               n * (o->nrate + (o->saturation ? SEARCH_WEIGHT : 0)), c->quiet);
    interrupt_begin(&t.interrupt, c->database, t.nwork);
    labour_together(&t, nthread < MOST_THREADS ? nthread : MOST_THREADS);
    interrupt_end(&t.interrupt);
    progress_end(&t.progress);
    pthread_mutex_destroy(&t.lock);
    free(t.work);
    return !t.failed;
}

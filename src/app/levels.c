/* levels.c - see levels.h.
 *
 * 'auto-tolerance 2 %' is settled once per family of runs and tolerance, before any run: the
 * level is part of what identifies a run. */
#include "app/levels.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/memory.h"
#include "base/text.h"
#include "study/level_choice.h"

enum { MOST_LEVELS = 8, HEX = 65 }; /* rungs of a ladder; SHA-256 as text */

/* All rungs of a report, numbered in their order. */
bool ladder_store(struct store *s, const struct accuracy_report *r, struct err *e)
{
    static const char *const name[] = {"scenario", "ordinal"};
    for (int i = 0; i < r->nrung; i++) {
        const struct store_value value[] = {store_text(r->scenario), store_int(i)};
        if (!store_insert_row(s, "ladder", 2, name, value, &accuracy_rung_columns, &r->rung[i], e))
            return false;
    }
    return true;
}

/* The errors that are known of one family's levels, from earlier ladders. */
struct known {
    int n;
    struct level_error level[MOST_LEVELS]; /* (n) the largest error of each */
};

/* (level, error, where it was measured) */
static bool add_known(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct known *k = context;
    (void)ncolumn;
    (void)name;
    if (k->n == MOST_LEVELS) return false;
    struct level_error *x = &k->level[k->n++];
    text_copy(x->level, sizeof x->level, value[0]);
    x->error = strtod(value[1], NULL);
    text_copy(x->at, sizeof x->at, value[2]);
    return true;
}

/* The largest error of each level over all points where this family was measured: an error at
 * one size must not be hidden by a better one at another size. */
static bool find_known(struct store *s, const char *family, struct known *k, struct err *e)
{
    k->n = 0;
    return store_select(s,
                        "SELECT method, max(relative_error), at FROM ladder WHERE ladder = "
                        "'network' AND quantity = 'makespan' AND family = ?1 AND relative_error IS "
                        "NOT NULL GROUP BY method ORDER BY method",
                        1, &family, add_known, k, e);
}

/* Climb the network ladder of the runs of one family and store it: the next campaign finds it. */
static bool measure(struct store *s, const struct run_spec *run, int nrun, const char *family,
                    struct err *e)
{
    struct run_spec *alike = memory_zeroed((size_t)nrun, sizeof *alike);
    struct arena *a = arena_create();
    struct accuracy_report r;
    int n = 0;
    CHECK(alike);
    /* Families are compared by their hash (level_choice.h). */
    for (int i = 0; i < nrun; i++) {
        char hex[HEX];
        level_family(&run[i], hex);
        if (strcmp(hex, family) == 0) alike[n++] = run[i];
    }
    bool ok = accuracy_network(alike, n, a, &r, e) && store_begin(s, e);
    if (ok && ladder_store(s, &r, e)) ok = store_commit(s, e);
    else if (ok) ok = false, store_rollback(s);
    arena_destroy(a);
    free(alike);
    return ok;
}

/* What one family takes for one tolerance; `known` below has one of them per pair. */
struct settled {
    char family[HEX];
    double tolerance;
    struct level_error taken;
    bool stored, said; /* known before; told to the user */
};

/* Settle that of run[which]; x->family is known. Returns false when no level is accurate enough. */
static bool settle(struct store *s, const struct run_spec *run, int nrun, int which,
                   struct settled *x, struct err *e)
{
    const double tolerance = x->tolerance = run[which].machine.network.tolerance;
    struct known k;
    x->stored = true;
    if (!find_known(s, x->family, &k, e)) return false;
    /* Never measured: measure now, which takes seconds. */
    if (k.n == 0) {
        x->stored = false;
        if (!measure(s, run, nrun, x->family, e) || !find_known(s, x->family, &k, e)) return false;
    }
    /* Cheap by construction: the choice is the same on every computer. */
    int best = level_cheapest(k.level, k.n, tolerance);
    if (best < 0)
        return err_set(e, ERR_CONFIG,
                       "level 'auto-tolerance': no level of %s on %s is known to be within %.3g %%",
                       run[which].kernel.name, run[which].machine.name, 100 * tolerance);
    x->taken = k.level[best];
    return true;
}

/* Say once what a family took, as it decides how accurate all its runs are. */
static void say(const struct run_spec *run, struct settled *x)
{
    if (x->said) return;
    x->said = true;
    fprintf(stderr,
            "mimdsim: %s on %s: level %s, whose error at %s is %.2g %% (%s; %.3g %% permitted)\n",
            run->kernel.name, run->machine.name, x->taken.level, x->taken.at, 100 * x->taken.error,
            x->stored ? "stored" : "measured now", 100 * x->tolerance);
}

/* The number among `known` (*n) of what run[which] takes, settled now if it is new; -1: failed. */
static int settle_run(struct store *s, const struct run_spec *run, int nrun, int which,
                      struct settled *known, int *n, struct err *e)
{
    /* The entry behind the last one is used as a sentinel: the loop ends there at the latest. */
    struct settled *mine = &known[*n];
    level_family(&run[which], mine->family);
    int at = 0;
    while (strcmp(known[at].family, mine->family) != 0 ||
           (at < *n && known[at].tolerance != run[which].machine.network.tolerance))
        at++;
    if (at == *n && !settle(s, run, nrun, which, &known[(*n)++], e)) return -1;
    return at;
}

/* n pairs at most, one per run; one more is the sentinel. */
bool levels_settle(struct store *s, struct run_spec *run, struct run_order *order, int nrun,
                   bool quiet, struct arena *a, struct err *e)
{
    struct settled *known = memory_zeroed((size_t)nrun + 1, sizeof *known);
    int *taken = memory_zeroed((size_t)nrun + 1, sizeof *taken), n = 0;
    bool ok = true;
    /* All are settled before the first one changes: a ladder is climbed over the runs that ask. */
    for (int i = 0; i < nrun && ok; i++) {
        taken[i] = -1; /* names its level itself */
        if (run[i].machine.network.level != LEVEL_AUTO_TOLERANCE) continue;
        taken[i] = settle_run(s, run, nrun, i, known, &n, e);
        ok = taken[i] >= 0;
    }
    for (int i = 0; i < nrun && ok; i++) {
        if (taken[i] < 0) continue;
        struct settled *x = &known[taken[i]];
        level_take(&run[i], &x->taken, &order[i].level_choice, a);
        /* A run that is stored needs no remark. */
        if (!quiet && !store_has(s, &run[i])) say(&run[i], x);
    }
    free(known);
    free(taken);
    return ok;
}

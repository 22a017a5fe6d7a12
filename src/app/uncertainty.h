/* uncertainty.h - what the uncertain parameters of a machine leave open of a scenario's runs.
 *
 * For each run of the plan every uncertain parameter of its machine is drawn from its range
 * (study/uncertain.h), and the run is made again: at n points for a band, at n (k + 2) points of
 * Saltelli's design for the share of each of the k parameters (study/variance.h). What the scenario
 * sets or sweeps is given, and not drawn; neither is what does not act in the run. */
#ifndef APP_UNCERTAINTY_H
#define APP_UNCERTAINTY_H

#include "app/verb.h"
#include "store/store.h"

enum { UNCERTAINTY_MOST = 100000 }; /* runs of one call, as of a plan */

struct uncertainty_options {
    int n;       /* points of each of the two samples; 0: nothing is to be done */
    bool shares; /* else bands only */
};

/* uncertainty_take: "--uncertainty N" and "--bands-only" out of the arguments. False with
 * ERR_USAGE. */
bool uncertainty_take(int *argc, char **argv, struct uncertainty_options *o, struct err *e);

/* uncertainty_count: how many runs `o` means for the plan, before anything is built or run: more
 * than UNCERTAINTY_MOST is refused with ERR_CONFIG. */
bool uncertainty_count(const struct plan *p, const struct uncertainty_options *o, struct err *e);

/* uncertainty_run: fill the tables uncertainty_sample, uncertainty and uncertainty_share for the
 * runs of `p` that are stored and ended well. Samples that are stored already are not made again,
 * unless c->force. */
bool uncertainty_run(const struct common *c, const struct plan *p,
                     const struct uncertainty_options *o, struct store *s, struct err *e);

/* uncertainty_print: what the parameters contribute, largest first, over all runs of `p`. */
bool uncertainty_print(struct store *s, const struct plan *p, FILE *out, struct err *e);

#endif

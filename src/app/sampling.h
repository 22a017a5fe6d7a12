/* sampling.h - what remains of the claims when the uncertain machine parameters are drawn anew.
 *
 * Each sample draws every parameter that has a published range, log-uniform and seeded, for all
 * machines of the scenarios sample-*.yaml, runs those, and lets the claims' own queries judge the
 * results. */
#ifndef APP_SAMPLING_H
#define APP_SAMPLING_H

#include "app/verb.h"
#include "report/claims.h"
#include "store/store.h"

enum { SAMPLING_SAMPLES = 200 };

/* sampling_run: fill tables claim_sample and sample_setting of `s`; nothing is done when they hold
 * just that already (the same scenarios, machines and claims) unless c->force. Prints what it does
 * on stderr unless c->quiet. */
bool sampling_run(const struct common *c, const struct claim_rules *rules, int nsample,
                  struct store *s, struct err *e);

#endif

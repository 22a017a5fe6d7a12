/* explain_claims.h - what would make the paper true: the smallest change under which a failing
 * claim holds.
 *
 * The paper does not state what its code sustains, what a message cost, how its serial code was
 * written or who else used the machine. The search changes these (explain_space.h) and tells for
 * each claim that fails, and for the claims of one machine together, the smallest change under
 * which it holds, or that none was found and how that was tried. */
#ifndef APP_EXPLAIN_CLAIMS_H
#define APP_EXPLAIN_CLAIMS_H

#include "app/verb.h"
#include "report/claims.h"
#include "store/store.h"

enum { EXPLAIN_SEED = 2002 };

/* explain_claims: fill tables explain_* of `s`, whose claims have been judged; nothing is done when
 * they hold just that already (the same claims, runs and seed) unless c->force. Returns false with
 * ERR_DATA when a claim's file does not say how it can be explored, or as plan_read and
 * run_campaign. */
bool explain_claims(const struct common *c, const struct claim_rules *rules, uint64_t seed,
                    struct store *s, struct err *e);

/* explain_draw: draw figure explain of every claim that was explained into c->directory; none is no
 * mistake, and without gnuplot the tables alone are written, which is told on stderr. */
bool explain_draw(const struct common *c, struct store *s, struct err *e);

#endif

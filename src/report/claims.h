/* claims.h - the claims of the paper as questions to the database: plots/claims/ID.sql, one file a
 * claim.
 *
 * A file begins with lines "-- statement:", "test:", "unit:", "designated:" (the variant that gives
 * the verdict), "judged:" (why that one, with which tolerance: written before its value is known),
 * "points:" (the runs it takes) and "needs:" (the command that makes them); a line "--   ..."
 * continues the one above. Its query gives one row for each variant: (variant, value, threshold,
 * holds, missing, note, margin), `holds` 1, 0 or NULL (cannot be told), `missing` the runs that it
 * lacks or NULL. Its parameter ?1 is 'what-if' when runs on changed machines count, too. The same
 * files judge the stored runs, every sample of the uncertain machine parameters and every point of
 * the search for what would make a claim hold. That search needs more, which a file may leave out:
 *
 *   margin                                how far a variant is from failing (> 0) or from holding
 * (< 0), continuous in the times of the runs, of the order of a relative change
 *   -- explore: SCENARIO [KEY=VALUE...]   runs that are enough to judge the claim at one point; a
 * line a scenario
 *   -- never: REASON                      why the claim cannot hold whatever the machine is: a
 * proof in one sentence
 *
 * In it ?1 is 'explored': all runs count, those with noise and others' traffic, too. */
#ifndef REPORT_CLAIMS_H
#define REPORT_CLAIMS_H

#include <stdbool.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/err.h"
#include "store/store.h"

enum { CLAIM_MOST_EXPLORED = 8 };

struct claim_rule {
    const char *id; /* the file's stem */
    const char *statement, *test, *unit, *designated, *judged, *points, *needs;
    const char *never; /* NULL: nobody knows a reason */
    int nexplore;
    const char *explore[CLAIM_MOST_EXPLORED]; /* (nexplore) */
    const char *sql;
};

/* One row of a claim's query. */
struct judgement {
    const char *variant, *note; /* borrowed until the next row, as is all below */
    const char *missing;        /* runs that the variant lacks, NULL: none */
    struct store_value value, threshold;
    struct store_value holds; /* 0, 1 or NULL */
    double margin;            /* NaN: not told */
};

struct claim_rules {
    struct arena *arena; /* owned; everything below lives in it */
    int n;
    /* claims_decide counts runs on changed machines, too; the caller's to set, false at first */
    bool what_if;
    struct claim_rule *rule; /* (n) by id: C1, C2, ... C10, then indicators */
};

/* claims_read: every file of data_dir/plots/claims. Returns false with ERR_NO_INPUT when there is
 * none, ERR_DATA when a header line is missing; *c is then empty. */
bool claims_read(struct claim_rules *c, const char *data_dir, struct err *e);
void claims_free(struct claim_rules *c);

/* claims_judge: the rows of `rule` by the runs in `s` (`admitted` is ?1: "as shipped", "what-if" or
 * "explored"), each handed to `tell`, which returns false to stop with an error in *e. */
typedef bool judgement_fn(void *context, const struct claim_rule *rule, const struct judgement *j);
bool claims_judge(const struct claim_rule *rule, struct store *s, const char *admitted,
                  judgement_fn *tell, void *context, struct err *e);

/* claims_sample: judge all variants by the runs in `from` and keep values and verdicts as sample
 * number `sample` of `into` (table claim_sample), in one transaction. Samples are what-ifs: all
 * runs in `from` count. */
bool claims_sample(const struct claim_rules *c, struct store *from, struct store *into, int sample,
                   struct err *e);

/* claims_decide: judge the runs of `s` and fill its table claim anew, with ranges and shares of the
 * samples there. A variant whose runs are not all there is not testable; its note says which are
 * missing and what makes them. Runs count when they were made on a machine as shipped (view
 * v_machine_state), or all with c->what_if. */
bool claims_decide(const struct claim_rules *c, struct store *s, struct err *e);

/* claims_print: the table claim for people and below it how each verdict came about, or (json) an
 * array with one object a claim: id, statement, test, judged, verdict, value, share, testable,
 * holding, variants. */
bool claims_print(struct store *s, bool json, FILE *out, struct err *e);

#endif

/* how_sure.h - how far predicted times are known, in words: the errors of the network level, of
 * the parameters of the machine and of the arithmetic (view v_known_error), "not known" where they
 * are not. */
#ifndef REPORT_HOW_SURE_H
#define REPORT_HOW_SURE_H

#include "base/text.h"
#include "store/store.h"

/* Of several runs: how many there are, how many know an error, and the largest of those. */
struct how_sure {
    int runs, level, machine, arithmetic;
    double level_error, machine_low, machine_high, arithmetic_error; /* relative */
};

/* how_sure_read: of the runs in a JSON array of their numbers, NULL: of all. A database of a
 * program that did not know errors yet knows none. Returns false as store_select. */
bool how_sure_read(struct store *s, const char *run_ids, struct how_sure *out, struct err *e);

/* how_sure_join: `h` becomes what is known of its runs and of `more`, which are others. */
void how_sure_join(struct how_sure *h, const struct how_sure *more);

/* how_sure_sentence: "How sure: the network level is within 1.2 % (12 of 40 runs); ...", with the
 * command that finds out what is not known; appended. Nothing for no runs. */
void how_sure_sentence(const struct how_sure *h, struct text *out);

/* how_sure_short: "error of level <= 1.2 %, machine not known, arithmetic <= 8e-10"; appended. */
void how_sure_short(const struct how_sure *h, struct text *out);

#endif

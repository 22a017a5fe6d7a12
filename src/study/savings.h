/* savings.h - what each omission of a scenario saves, measured: the same run with it put back, less
 * the run without. */
#ifndef STUDY_SAVINGS_H
#define STUDY_SAVINGS_H

#include <stdio.h>

#include "base/json.h"
#include "measure/study_row.h"
#include "plan/plan.h"
#include "run/run.h"
#include "store/store.h"

enum { MOST_SAVINGS = 2 * RUN_MAX_OMISSIONS };

struct savings {
    char scenario[64];
    int n;
    struct saving item[MOST_SAVINGS];
};

/* savings_measure: each omission of the plan's runs once, at the largest run that has it and takes
 * a moment; shortest processor times of interleaved repeats. r (p->nrun) from run_explain. Returns
 * false as run_one does. */
bool savings_measure(const struct plan *p, const struct run_estimate *r, struct savings *out,
                     struct err *e);

/* savings_print: a line an omission. savings_json: the same as the array "savings" of an open
 * object. */
void savings_print(FILE *out, const struct savings *s);
void savings_json(struct json *j, const struct savings *s);

/* savings_store: the rows of the scenario in table omission, in place of older ones. Returns false
 * as store_insert. */
bool savings_store(struct store *s, const struct savings *all, struct err *e);

#endif

/* savings.h - what each omission of a scenario saves, measured: the same run with it put back, less the run without. */
#ifndef STUDY_SAVINGS_H
#define STUDY_SAVINGS_H

#include <stdio.h>

#include "base/json.h"
#include "plan/plan.h"
#include "run/run.h"
#include "store/store.h"

struct saving {
    struct omission omission;
    char at[48];              /* the point where it was measured: "n=P=128" */
    bool measured;            /* false: nothing brings it back */
    double host_s;            /* of the run without it, references included [s] */
    double host_saved_s;      /* below noise_s in size: cannot be told from nothing */
    double noise_s;           /* how far two such times differ by chance */
    int64_t machine_ps, machine_saved_ps; /* predicted */
};

enum { MOST_SAVINGS = 2 * RUN_MAX_OMISSIONS };

struct savings {
    char scenario[64];
    int n;
    struct saving item[MOST_SAVINGS];
};

/* savings_measure: each omission of the plan's runs once, at the largest run that has it and takes a moment; shortest
 * processor times of interleaved repeats. r (p->nrun) from run_explain. Returns false as run_one does. */
bool savings_measure(const struct plan *p, const struct run_estimate *r, struct savings *out, struct err *e);

/* savings_print: a line an omission. savings_json: the same as the array "savings" of an open object. */
void savings_print(FILE *out, const struct savings *s);
void savings_json(struct json *j, const struct savings *s);

/* savings_store: the rows of the scenario in table omission, in place of older ones. Returns false as store_insert. */
bool savings_store(struct store *s, const struct savings *all, struct err *e);

#endif

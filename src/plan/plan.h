/* plan.h - scenario and machine files, sweeps and overrides, resolved to an array of run_spec.
 * Strings end here. */
#ifndef PLAN_PLAN_H
#define PLAN_PLAN_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "base/expression.h"
#include "base/text.h"
#include "plan/range.h"
#include "spec/run_spec.h"

/* Whether machine m can be built and holds nrank ranks, or all the jobs (NULL: one program); false
 * with the reason, whose text begins with the key to blame. `work` bounds what is built for a whole
 * plan: beyond it everything fits until it runs. */
typedef bool plan_fits(const struct machine_spec *m, int nrank, const struct job_set *jobs,
                       int64_t *work, struct err *e);

struct plan_options {
    const char *machine; /* --machine NAME or file, NULL: the scenario's */
    /* --name: what the runs are called, NULL: as their files or their differences say */
    const char *name;
    int nset;
    const char *const *set; /* (nset) "key=value", applied last; keys as in files:
                               machine.network.link.bandwidth */
    int nkernel;
    const char *const *kernel; /* (nkernel) the kernels there are; none: any name will do */
    /* program: what a person's own program at `path` declares, in `a`, compiled first where it is
     * source; NULL with the error. A NULL function: programs are refused. */
    const struct program_sheet *(*program)(void *context, const char *path, struct arena *a,
                                           struct err *e);
    void *program_context;
    plan_fits *fits; /* NULL: nobody is asked */
    /* what identifies the runs (identity_of_runs), borrowed as long as the plan, and knows their
     * texts then; NULL: one of its own */
    struct identity *identity;
    bool allow_programs; /* scenarios may name programs outside their own folder */
    /* --only: a condition besides the scenario's own (condition.h), NULL: none */
    const char *only;
};

enum { PLAN_MOST_RANGES = 8 };

/* What is to be optimised (search_file.h). Listed values are points of the plan; ranges stand there
 * at their middle. */
struct plan_search {
    const struct expression *goal, *within; /* of settings and results; within NULL: no limit */
    bool greatest;
    int nrange;
    struct range range[PLAN_MOST_RANGES];
    int most; /* runs for each combination of listed values */
    const char *file;
    int line;
};

/* What its runs are compared by, for the sentence that answers the question (answer_file.h). */
struct plan_answer {
    const char *of, *over; /* full keys, or "variant"; over NULL: one choice */
    const char *of_word, *over_word; /* as the file writes them */
    const struct expression *goal;
    const char *called; /* what the goal is called, NULL: as the formula is written */
    bool greatest;
    const char *against; /* value of `of`, NULL: none */
    double within;       /* share, 0: not asked */
    const char *file;
    int line;
};

struct plan {
    struct arena *arena;  /* owned; everything below lives in it */
    char name[64];        /* stem of the scenario file */
    const char *question; /* the file's question, one line */
    int nrun;
    /* (nrun) in plan order; final, copies may become other runs (identity.h) */
    const struct run_spec *run;
    /* (nrun) number of the point in the product of the axes, before conditions */
    int64_t *point;
    const struct plan_search *search; /* what is optimised, NULL: nothing */
    const struct plan_answer *answer; /* what answers the question, NULL: the table */
    /* (nrun) of a search: runs of one group differ in what is searched; numbered from 0 */
    int *group;
    int ngroup;
    struct plan_memory *memory; /* what plan_vary needs */
    /* points that cannot run, such as more ranks than processors (run_spec.refused); never all */
    int nrefused;
    struct err refusal;   /* of the first of them */
    int nswept;
    struct plan_swept {
        const char *key; /* in full: machine.network.link.bandwidth */
        bool number;     /* its values are numbers without a unit */
    } * swept; /* (nswept) keys that points of the sweep set, in the order of the axes, each once */
    int nfigure;
    const char **figure; /* (nfigure) figures that the scenario asks for */
    int nunused;
    const char **unused; /* (nunused) "key: reason" of settings that act in no run of this plan */
};

/* plan_read: read scenario `name` (a path, or the stem of a file in scenarios/; a program makes a
 * scenario by itself). Returns false with ERR_NO_INPUT,
 * ERR_DATA (file and line), ERR_CONFIG or ERR_USAGE (`name` is a machine, a database: see
 * file_kind.h); *p is then empty. */
bool plan_read(struct plan *p, const char *name, const struct plan_options *o, struct err *e);

/* plan_free: give everything back; accepts an empty plan. */
void plan_free(struct plan *p);

/* plan_vary: run `index` of `p` with n more settings, as --set would give them, into *run, complete
 * and identified; it lives as long as `p`. A point that cannot run has run->refused. Returns false
 * with ERR_DATA. */
bool plan_vary(struct plan *p, int index, int n, const char *const *key, const char *const *text,
               struct run_spec *run, struct err *e);

/* plan_check_file: validate a scenario, a machine file (by its content) or a program without
 * running, o->fits included; `o` may be NULL. */
bool plan_check_file(const char *path, const struct plan_options *o, struct err *e);

/* Where one value of a resolved machine comes from. */
struct origin {
    const char *key;   /* network.link.bandwidth */
    const char *value; /* as printed, with its unit */
    const char *file;  /* path, "--set" or "default" */
    int line;
    const char *evidence; /* P, PR, D, E or "" */
    const char *source;   /* citation or arithmetic, "" */
    const char *validate; /* published figures: the row of published.csv that uses it, or why none
                             does; "" */
    double min, max;      /* published range in SI, both 0 when there is none */
};

/* plan_machine: read machine `name` (a path, or the stem of a file in machines/) with its bases
 * resolved.
 *
 *   origin  out  (*norigin) entries in `a`, in field order; may be NULL */
bool plan_machine(struct machine_spec *m, const char *name, const struct plan_options *o,
                  struct arena *a, struct origin **origin, int *norigin, struct err *e);

/* plan_origins: where the values of the machine of run `index` come from, as its file gives them,
 * into (*n) entries in p->arena; runs on one machine share them. */
void plan_origins(const struct plan *p, int index, const struct origin **origin, int *n);

/* plan_machine_file: the machine of run `index` as its file has it. */
const struct machine_spec *plan_machine_file(const struct plan *p, int index);

/* plan_list: stems and titles of the files in machines/ ("machines") or scenarios/ ("scenarios"),
 * sorted. */
bool plan_list(const char *what, struct arena *a, const char ***stem, const char ***title, int *n,
               struct err *e);

/* plan_data_dir: the folder that holds machines/, scenarios/ and plots/: $MIMDSIM_DATA, beside the
 * build tree's binary, or the installed one. */
const char *plan_data_dir(void);

#endif

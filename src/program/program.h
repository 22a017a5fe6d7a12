/* program.h - what any parallel program is: its name, its ranks' text, its outputs, how it is
 * judged and what it costs.
 *
 * Room run makes runs of programs and knows nothing of what they compute. A program knows its own
 * settings, scenes, outputs and references; it is one `const struct program_type` and a line in a
 * table (kernel/programs.c). Life of a run:
 *
 *     open     the scene and the settings are looked at: can the program run them, with which text?
 *     prepare  room for the outputs, tables that all ranks share
 *              (the ranks run)
 *     judge    what the program saw itself: may the answer be believed?
 *     again    other settings, where the answer asks for them: back to prepare
 *     check    the outputs against independent references; baselines: serial codes of the task
 *
 * `estimate` and `leave_out` need no more than open. */
#ifndef PROGRAM_PROGRAM_H
#define PROGRAM_PROGRAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"
#include "comm/comm.h"
#include "measure/run_result.h"
#include "program/rank_program.h"
#include "program/run_part.h"
#include "spec/run_spec.h"

enum { PROGRAM_OUTPUTS = 12 };

/* One run of a program, from open to check. The caller fills the first part, open and prepare the
 * second; after open it stays in place, since the program points into it. */
struct program_run {
    const struct program_type *type;
    struct run_spec spec; /* the settings in force, a copy: `again` may change those of the program,
                             so it may be another run than the one that its config_hash names */
    struct run_order order;      /* how it is executed, a copy; job_run counts its attempts, too */
    struct program_cache *cache; /* what runs share; NULL: nothing */
    bool packs; /* a page may be stack enough for a rank (fiber_packs); set before open */
    struct arena *arena; /* memory of open: lives as long as this struct */
    const struct run_part *part; /* what of the run this process makes, NULL: all; borrowed */
    void *own;                       /* the program's own, made by open in `arena` */
    /* set by open */
    const struct rank_program *rank;
    const void *job;                 /* what the ranks get; set by prepare */
    int nbody, nu; /* bodies and degrees of freedom of the scene; 0: it has none */
    double metre, kilogram, second;  /* its units in SI; 0: it has none */
    struct comm_output output[PROGRAM_OUTPUTS]; /* made by prepare */
    const struct text *said; /* lines of the result, see run_result.said; NULL: none */
    int exit_status;         /* of a person's program: the first that is not 0 */
    bool divided; /* run_part.h: only what the part's ranks need is there; set by open */
};

/* What a run will cost, known before it runs (mimdsim explain). */
struct program_estimate {
    double messages, bytes, flops; /* sent and computed, all ranks */
    double rank_bytes;      /* host memory that a rank works in */
    double model_bytes, reference_bytes; /* of the model; of serial codes, after the ranks */
};

/* What a run leaves out. */
struct left_out {
    unsigned keep;          /* KEEP_* of the run: what is put back is not listed */
    struct omission *item;  /* (RUN_MAX_OMISSIONS) */
    int n;
};

/* What counted work costs on the machine of the run [ps]. */
struct work_price {
    int64_t (*price_ps)(const void *context, const struct work *w);
    const void *context;
};

struct program_type {
    const char *name;
    const char *title; /* one line for people */
    bool has_scene;    /* it works on a multibody system: the model's settings act */
    bool repeats; /* its ranks do the same at any time on any machine (run/tape.h) */
    const void *context; /* the program's own constants; NULL: none */

    /* cache_create, cache_destroy: what runs of this program may share (scenes, serial answers);
     * NULL: nothing. Programs with the same cache_create share one. destroy accepts NULL. */
    struct program_cache *(*cache_create)(void);
    void (*cache_destroy)(struct program_cache *cache);

    /* open: look at r->spec and make r->own, rank, nbody, nu and units. False with ERR_CONFIG when
     * this program cannot run the settings (more ranks than bodies, a scene that it does not do),
     * other kinds when a file is bad. */
    bool (*open)(struct program_run *r, struct err *e);
    void (*close)(struct program_run *r); /* what open, even if it failed, took beside arenas */
    /* prepare: outputs, job and shared tables from `scratch`, which lives until the run has been
     * judged or, the last time, checked; costs no simulated time. */
    bool (*prepare)(struct program_run *r, struct arena *scratch, struct err *e);

    /* judge: what the program itself saw of its answer, into `out`; RUN_INVALID when it is not to
     * be trusted. NULL: nothing. */
    void (*judge)(struct program_run *r, struct run_result *out);

    /* again: whether the run is to be made once more, with settings that this call has changed.
     * Called after judge, not after a deadlock. NULL: never. */
    bool (*again)(struct program_run *r, struct run_result *out);

    /* check: outputs against independent references: out->error, RUN_INVALID beyond a tolerance.
     * NULL: no check. */
    void (*check)(struct program_run *r, struct arena *scratch, struct run_result *out);

    /* baselines: predicted times of serial codes for the same task into out->baseline; out->stage
     * is filled. NULL: there is none. */
    void (*baselines)(struct program_run *r, const struct work_price *price, struct arena *scratch,
                      struct run_result *out);

    /* estimate: counts by formula, without running; after open. */
    void (*estimate)(const struct program_run *r, struct program_estimate *out);

    /* leave_out: what the program does not compute because its scene does not need it; after open.
     * NULL: nothing. */
    void (*leave_out)(const struct program_run *r, struct left_out *l);

    /* unused: settings that act nowhere because of what the scene is, "key: reason" (constant
     * texts), into out (2); what the settings alone decide is in the fields' tables. Returns how
     * many. After open. NULL: none. */
    int (*unused)(const struct program_run *r, const char **out);

    const double *(*answer)(const struct program_run *r, int output, int64_t *n);
    bool (*take)(struct program_run *r, int output, int64_t, int64_t, const double *, char *, int);
};

/* program_want: output number `output` gathers n numbers, zero before, from `a`. program_output:
 * them, or NULL. */
void program_want(struct program_run *r, int output, int64_t n, struct arena *a);
double *program_output(const struct program_run *r, int output);

/* program_answer: the *n numbers of an output when the ranks have run, NULL: none. program_take: n
 * elements that a rank of another process published; false: a clause in `why`. */
const double *program_answer(const struct program_run *r, int output, int64_t *n);
bool program_take(struct program_run *r, int output, int64_t first, int64_t n, const double *data,
                  char *why, int size);

/* leave_out_add: one more thing left out, unless `keep` of the run puts it back. bound: largest
 * relative change of a result, 0: exact. Texts are copied. */
void leave_out_add(struct left_out *l, unsigned keep, double bound, const char *what,
                   const char *why);

/* program_check_add: one number that was compared with a reference, into out->error. A relative
 * error above the tolerance, or one that is no number, makes the run RUN_INVALID with its text. */
void program_check_add(struct run_result *out, const char *quantity, const char *reference,
                       double relative, double tolerance);

/* program_baseline_add: one serial code with its predicted time. program_fastest_add: "fastest
 * serial", the fastest of the baselines from number `first` on; nothing when there are none. */
void program_baseline_add(struct run_result *out, const struct work_price *price, const char *name,
                          const struct work *w);
void program_fastest_add(struct run_result *out, int first);

#endif

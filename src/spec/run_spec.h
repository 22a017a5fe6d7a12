/* run_spec.h - everything that one run depends on, resolved; nothing writes it after the plan. How
 * it is executed is said beside it, by struct run_order. */
#ifndef SPEC_RUN_SPEC_H
#define SPEC_RUN_SPEC_H

#include <stdbool.h>
#include <stdint.h>

#include "spec/job_spec.h"
#include "spec/kernel_spec.h"
#include "spec/machine_spec.h"
#include "spec/model_spec.h"
#include "spec/program_spec.h"

/* Serial codes that a run is held against: all, or those that can be the fastest. */
enum baseline_rule { BASELINES_ALL, BASELINES_NEEDED };

/* What to record beyond the totals. None of these changes a simulated time. */
struct record_spec {
    bool spans;  /* who did what from when to when (timeline) */
    bool links;  /* per-link busy time and queueing */
    /* what binds: the critical path (mimdsim why). No setting: whoever asks for it says so */
    bool path;
    bool slack; /* with the path: how much later everything else may be (measure/slack.h) */
    enum baseline_rule baselines;
    /* how long computing is to last, NULL: as counted; borrowed. Alone of all it changes times, and
     * only studies set it: what comes of it is never stored as the run's result */
    const struct balance *balance;
};

/* What is computed although nothing asks for it (run's --keep-all): to show that leaving it out
 * changes no result. */
enum keep_bit {
    KEEP_START_EVENTS = 1,
    KEEP_SPANS = 2,
    KEEP_LINKS = 4,
    KEEP_BASELINE = 8,
    KEEP_CONTENTION = 16,
    KEEP_EXTERNAL = 32,
    KEEP_VELOCITY = 64,
    KEEP_BASE = 128,
    KEEP_BIAS = 256,
    KEEP_FIXED = 512,
    KEEP_GENERAL = 1024,
    KEEP_BRANCHES = 2048,
    KEEP_TURN = 4096,
    KEEP_SPATIAL = 8192,
    KEEP_SCENES = 1 << 15,
    KEEP_ALL = 0xffff
};

/* How level 'auto-tolerance' was settled: the spec of the run names the level that was taken. */
struct level_choice {
    bool made;
    double tolerance;        /* what was asked for: relative error of the makespan that may be */
    double error;            /* that of the level that was taken, as measured */
    char at[64];             /* where it was measured: "n=P=128" */
};

struct balance;
struct run_heartbeat;
struct hosts;

/* run_order.threads: as many host threads as help, on `cores` processors. */
enum { RUN_THREADS_AUTO = -1 };

/* How a run is executed, beside what it is: nothing of it is a setting or part of the identity, and
 * none of it changes a result. All zero: as usual. */
struct run_order {
    unsigned keep;                   /* KEEP_*: what is computed although nothing asks for it */
    /* on this computer for real: nobody counts what computing costs, and no monitor computes */
    bool real;
    /* where the run tells how far it is, NULL: nowhere; borrowed */
    struct run_heartbeat *heartbeat;
    enum program_output output;      /* of people's own programs: their lines */
    /* of people's own programs: processor time of a run [s]; 0: PROGRAM_HOST_LIMIT */
    double host_limit;
    struct level_choice level_choice;
    int threads;                     /* host threads of the one run, RUN_THREADS_AUTO, or 0: one */
    int cores;                       /* processors that it may use; 0: all that there are */
    /* processes that share the run, NULL: this one alone; borrowed */
    const struct hosts *hosts;
    int job_run;                     /* its number among those of the processes */
    /* of such a run: sums over the ranks will do, single ranks' times are not wanted; each process
     * makes the whole scene */
    bool sums, whole;
    bool times; /* the simulated times alone are wanted: no check of the answer, no serial codes */
};

struct run_spec {
    char scenario[64];       /* stem of the scenario file */
    char label[96]; /* name that a person gave to it, "": none. For people, no part of the identity
                     */
    struct machine_spec machine;
    struct model_spec model;
    struct kernel_spec kernel;
    struct program_spec program;
    struct record_spec record;
    struct job_spec job;
    const struct job_set *jobs; /* the jobs that share the machine, NULL: one has it; borrowed */
    int nrank;               /* P */
    uint64_t seed;           /* of noise; the model has its own */
    int rep;                 /* repetition number, 0-based */
    char model_file[65]; /* SHA-256 of the file at model.path, which is part of the identity; "": no
                            file */
    /* SHA-256 of the settings above, but rep, that differ from their defaults: identity.h */
    char config_hash[65];
    const char
        *config_text; /* all settings as "key = value" lines, borrowed from the plan's arena */
    const char *machine_changes; /* JSON object of the machine's settings that are not those of the
                                    shipped machine of its name, "{}": none; NULL: none is shipped,
                                    or nobody looked. Borrowed */
    const char *machine_hash;    /* SHA-256 of that machine, "" or NULL likewise; neither is part of
                                    the identity */
    /* in tables and figures (run_label.h), NULL: as run_label says. Borrowed */
    const char *called;
    /* why the plan found that it cannot run, NULL: it can; borrowed, no part of identity */
    const char *refused;
    int refused_kind; /* err_kind of that */
};

/* run_spec_defaults: every setting at its default, all else zero; lists in `a`. */
void run_spec_defaults(struct run_spec *r, struct arena *a);

/* run_spec_is_random: whether the run's own seed is used: noise, background traffic, random routes.
 * Where not, all repetitions are alike. */
bool run_spec_is_random(const struct run_spec *r);

/* run_spec_seed: the seed of a run's random streams: a hash of its seed and its repetition, so that
 * no repetition of one seed is a run of another. */
uint64_t run_spec_seed(const struct run_spec *r);

#endif

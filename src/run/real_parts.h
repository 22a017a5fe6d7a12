/* real_parts.h - what the files of a real run share: the run that is being repeated; private to
 * real*.c. */
#ifndef RUN_REAL_PARTS_H
#define RUN_REAL_PARTS_H

#include "program/program.h"
#include "run/real.h"

/* What a process tells of a repetition, before its stages. */
enum {
    FACT_BEGIN,
    FACT_END,
    FACT_PREEMPTED,
    FACT_FAULTS,
    FACT_LATE,
    FACT_DIGEST,
    FACT_MESSAGES,
    FACT_BYTES,
    FACT_NOW,
    FACT_PROCESSOR,
    FACT_PROCESSORS,
    FACT_OWN_NS,
    FACT_STAGES,
    FACTS = FACT_STAGES + RUN_MAX_STAGES
};

/* One output as the simulated ranks published it. */
struct kept_answer {
    int64_t n;
    double *x; /* (n) owned */
};

/* A run that is being repeated. */
struct real {
    const struct run_spec *spec; /* as it was asked for */
    struct run_spec own;         /* as it runs: with the settings that the simulation ended with */
    const struct hosts *hosts;
    struct host_comm *comm;
    struct run_cache *cache;
    struct real_result *out;
    struct kept_answer simulated[PROGRAM_OUTPUTS];
    int64_t *facts; /* (P x FACTS) of the last repetition */
    int nstage, nrank;
    struct arena *memory; /* of the program, at the same addresses in each repetition */
    size_t bytes;         /* of it that a repetition takes, 0: not known yet */
    char stage_name[RUN_MAX_STAGES][24];
    double *stage[2]; /* (repetitions x (nstage + 1)) mean and largest over ranks [s] */
    uint64_t first_digest;
};

/* real_chief: whether this process has the whole result. */
bool real_chief(const struct real *r);

/* real_simulate: the first process simulates, all learn whether to go on and with which settings:
 * r->out->status, r->own.kernel. False as run_one. */
bool real_simulate(struct real *r, struct err *e);

/* real_judge: what the ranks published in the last repetition into `run` of the first process,
 * which compares it with the simulated answer and has it checked; called by all. False: a process
 * does not answer. */
bool real_judge(struct real *r, struct program_run *run, struct arena *own, struct arena *scratch);

/* real_repeat: all ranks once more, facts gathered. `judged`: the answer is gathered and checked.
 * False with an error when it cannot be made or a process does not answer. */
bool real_repeat(struct real *r, bool judged, struct err *e);

/* real_sample: repetitions until there are enough, or the time is up: r->out->sample, burst, and
 * the stages of each in r->stage; `a` has the memory. False as real_repeat. */
bool real_sample(struct real *r, const struct real_order *order, struct arena *a, struct err *e);

/* real_facts: those of a rank in the last repetition (FACTS). real_note_digest: compare the answer
 * of that repetition with the first one's. real_lost: the error of a process that does not answer,
 * false. */
const int64_t *real_facts(const struct real *r, int rank);
void real_note_digest(struct real *r, bool first);
bool real_lost(struct real *r, struct err *e);

/* real_forget: give the kept answers back. */
void real_forget(struct real *r);

#endif

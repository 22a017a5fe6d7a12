/* real_row.h - a run of a program on a real computer as plain data: times of its repetitions, its
 * answer, and what else the computer had to do.
 *
 * Times are seconds of the host's clock. A repetition is disturbed when the host took a processor
 * away from one of the ranks meanwhile, when a rank began late, or when the ranks met page faults
 * that others of the repetitions did without; statistics are over the others. */
#ifndef MEASURE_REAL_ROW_H
#define MEASURE_REAL_ROW_H

#include <stdbool.h>
#include <stdint.h>

#include "measure/column.h"
#include "measure/run_result.h"

enum { REAL_LEAST_SAMPLES = 5 }; /* fewer undisturbed ones: statistics are over all */
enum { REAL_BURSTS = 5 };        /* of one run, at most */

/* How long something took over repetitions [s]. */
struct real_times {
    double min, lower, median, upper, max; /* lower, upper: quartiles */
};

/* One stage. Its time in one repetition is the mean over the ranks, so that stages add up to the
 * run; the last stage is the idling of ranks that ended before the last one. */
struct real_stage {
    char name[24];
    double min_s, median_s; /* over repetitions, of the mean over ranks */
    double largest_s;       /* median over repetitions of the largest of all ranks */
};

/* What else the computer did: processors that other programs kept busy meanwhile, and the system's
 * load average (1 minute) before and after. NaN: not known. */
struct host_load {
    double others, before, after;
};

/* Operations by which it is told how fast a computer is just now: an addition or multiplication
 * among many that wait for nothing, a small operator that waits for the one before, an instruction
 * of a chain of additions, a byte copied, a message of 8 B. */
enum host_operation {
    HOST_MULTIPLY_ADD,
    HOST_CALL,
    HOST_CHAIN,
    HOST_COPY,
    HOST_MESSAGE,
    HOST_OPERATIONS
};

/* host_operation_name: "multiply_add", "call", "chain", "copy", "message". */
const char *host_operation_name(enum host_operation o);

/* What each takes just now [s], 0: not measured. */
struct host_speed {
    double time[HOST_OPERATIONS];
};

/* Repetitions that were made one after the other, and the computer's speed before and after. */
struct real_burst {
    int n; /* repetitions, disturbed ones included */
    struct host_speed before, after;
};

struct real_sample {
    double seconds;
    bool disturbed;
};

struct real_result {
    enum run_status status;
    /* why it is not RUN_OK; else the computer's speed, see real_bursts_text */
    char text[1024];
    char backend[8], library[24]; /* "mpi"; "MPICH", "Open MPI" */
    char host[64], processor[64], placement[64];
    int nrank, processors;      /* processors: of the first host that the job may use */
    bool oversubscribed;        /* more ranks on a host than processors: times say little */
    int nsample, disturbed;     /* repetitions; those among them that were disturbed */
    struct real_sample *sample; /* (nsample) in the arena of the run */
    struct real_times time;
    struct host_load load;
    int nburst;                           /* 0: the speed is not known */
    struct real_burst burst[REAL_BURSTS]; /* (nburst) samples in their order; stored in text */

    bool same_bits;    /* the answer is that of the simulated run, bit by bit */
    bool repeatable;   /* all repetitions gave the same bits */
    double difference; /* from the simulated answer, relative; infinite: other lengths */
    uint64_t answer;   /* fingerprint of all published numbers */
    int checks;        /* comparisons with references */
    double worst_error, worst_tolerance; /* of them, the one nearest to its tolerance; NaN: none */
    int64_t messages, bytes;             /* sent, all ranks */
    struct work work; /* counted by the simulated run, all ranks; not stored */
    int nstage;
    struct real_stage stage[RUN_MAX_STAGES + 1];
};

/* real_times_of: of n >= 1 values, which are sorted in place. */
struct real_times real_times_of(double *value, int n);

/* real_bursts_text: the bursts as JSON into `text`: {"bursts": [repetitions], "multiply_add": [ns
 * before and after the first burst, before and after the second ...], ...}; nothing where there are
 * none. */
void real_bursts_text(const struct real_result *r, char *text, size_t size);

/* The columns: of struct real_result, real_stage, real_sample. */
extern const struct column_table real_result_columns, real_stage_columns, real_sample_columns;

#endif

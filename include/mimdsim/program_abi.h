/* program_abi.h - what a program in one file and the simulator agree upon, byte by byte. Write
 * programs against mimdsim/program.h, which includes this file.
 *
 * A program's image defines one object called mimdsim_program. The simulator reads it before any of
 * the program's code runs. Calls go the other way through the table of struct comm_functions.
 * Both begin with their version and size: an image with a smaller struct is an older one, and what
 * it lacks is zero. C and C++. */
#ifndef MIMDSIM_PROGRAM_ABI_H
#define MIMDSIM_PROGRAM_ABI_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    MIMDSIM_PROGRAM_MAGIC = 0x6d696d70, /* "mimp" */
    MIMDSIM_PROGRAM_ABI = 1,
    MIMDSIM_COMM_ABI = 1,
    MIMDSIM_PARAMETERS =
        32, /* places in struct mimdsim_program; fewer are used: the first zero ends a list */
    MIMDSIM_STAGES = 15,
    MIMDSIM_OUTPUTS = 12,
    MIMDSIM_SERIALS = 4
};

/* The communicator of one rank; what is in it is the simulator's. */
struct comm;

/* --- what a program declares --- */

enum mimdsim_parameter_kind {
    MIMDSIM_WHOLE = 1, /* int64_t; with unit "B" a size such as 8 KiB */
    MIMDSIM_REAL,      /* double, in SI units */
    MIMDSIM_FLAG,      /* int: 0 or 1, in files false or true */
    MIMDSIM_CHOICE     /* int: place in `choices`, from 0 */
};

/* A parameter is a variable of the program: what it holds when the image is loaded is its default,
 * and the simulator writes the value of the run into every rank's own copy before the rank
 * begins. */
struct mimdsim_parameter {
    const char *name; /* letters, digits and _; its key in scenarios */
    int kind;         /* enum mimdsim_parameter_kind */
    int reserved;     /* 0 */
    void *at;         /* the variable */
    const char *unit; /* "", "B", "s", "B/s", "Hz", "flop/s", "m", "kg", "N", "rad", "m/s^2" or "%"
                         (a fraction) */
    const char *choices; /* MIMDSIM_CHOICE: "ring|doubling"; else NULL */
    double least, most;  /* inclusive, of numbers */
    const char *doc;     /* one line for people */
};

/* A serial code for the same task. */
struct mimdsim_serial {
    const char *name; /* "one loop" */
    void (*run)(struct comm *c);
};

/* What a run will cost, all ranks together; NaN: not known. */
struct mimdsim_estimate {
    double messages, bytes, flops;
    double rank_bytes; /* memory of one rank [B] */
};

enum mimdsim_cost {
    MIMDSIM_COST_BLOCKS =
        0, /* computing time is that of the executed blocks of machine code, as the compiler counted
              them; comm_compute and comm_counts cost nothing */
    MIMDSIM_COST_AUTHOR =
        1 /* computing time is what comm_compute and comm_count state, and nothing else */
};

struct mimdsim_program {
    uint32_t magic, abi; /* MIMDSIM_PROGRAM_MAGIC, MIMDSIM_PROGRAM_ABI; the macro PROGRAM fills the
                            first three */
    uint64_t size;       /* of this struct */

    const char *name;  /* in tables and figures; NULL: the file's name without its suffix */
    const char *title; /* what it does, one line */
    struct mimdsim_parameter parameter[MIMDSIM_PARAMETERS];
    const char *stage[MIMDSIM_STAGES];   /* names of the parts whose time is told apart; none: one
                                            stage, "program" */
    const char *output[MIMDSIM_OUTPUTS]; /* names of the results that comm_publish takes */

    /* run: what every rank does. */
    void (*run)(struct comm *c);

    /* serial: what the speedup is measured against. Each runs alone, on one processor of the same
     * machine, and its computing costs what the same computing costs in `run`. The results that the
     * first publishes are the reference of the run's. */
    struct mimdsim_serial serial[MIMDSIM_SERIALS];

    /* tolerance: largest relative error of a result, max |x - reference| / max |reference|, at
     * which a run is valid. 0: the same numbers. */
    double tolerance;

    /* check: where there is no serial code to compare with, or more to be said: looks at the
     * results of a run on comm_run_size ranks (comm_output) and states their errors (comm_error).
     * Runs alone, on one processor, after the run. NULL: none. */
    void (*check)(struct comm *c);

    /* estimate: costs by formula for `mimdsim explain`; the parameters are set. NULL: they are not
     * known. */
    void (*estimate)(int ranks, struct mimdsim_estimate *out);

    int cost;      /* enum mimdsim_cost */
    int wildcards; /* 1: it uses COMM_ANY_SOURCE, masks of tags, tests, probes or synchronous sends,
                      which take longer to simulate */
    int64_t stack_bytes; /* stack of a rank; 0: 8 MiB, of which only what is used takes memory */
};

/* --- what a program calls --- */

/* A pending operation, and after its end what it received. Zero: complete. */
struct mimdsim_request {
    int source;    /* the sender of the message that was received */
    int truncated; /* 1: the message was longer than the buffer, and what did not fit is lost */
    int64_t tag;   /* of the message */
    int64_t bytes; /* its length */
    void *reserved[28]; /* the simulator's; all zero: complete or never started */
};

/* Counted operations, in the classes that a node's cost distinguishes. */
struct mimdsim_counts {
    uint64_t flop;  /* additions, subtractions and multiplications */
    uint64_t div;   /* divisions */
    uint64_t sqrt;  /* square roots */
    uint64_t trig;  /* sines and cosines, one each */
    uint64_t bytes; /* copied from memory to memory [B] */
    uint64_t call;  /* calls of small operators */
};

enum mimdsim_collective_kind {
    MIMDSIM_BARRIER,
    MIMDSIM_BROADCAST,
    MIMDSIM_REDUCE,
    MIMDSIM_ALLREDUCE,
    MIMDSIM_GATHER,
    MIMDSIM_SCATTER,
    MIMDSIM_ALLGATHER,
    MIMDSIM_ALLTOALL,
    MIMDSIM_SCAN,
    MIMDSIM_SEARCH
};

/* One collective call; parts that a kind does not use are zero. */
struct mimdsim_collective {
    int kind; /* enum mimdsim_collective_kind */
    int root;
    int op;        /* enum comm_op of program.h; of a search enum comm_search_state */
    int exclusive; /* scan: without the own element */
    const void *send;
    void *recv;
    int64_t n; /* bytes of one block; of reductions and scans the numbers of the vector */
    const int64_t *send_bytes,
        *recv_bytes; /* alltoall: (size) bytes of each block; NULL: all of n */
};

/* Every function takes the place in the program's source that called, for messages. */
struct comm_functions {
    uint32_t abi, size; /* MIMDSIM_COMM_ABI, sizeof(struct comm_functions) */
    int (*rank)(const struct comm *c);
    int (*ranks)(const struct comm *c);
    int (*run_ranks)(const struct comm *c);
    void (*isend)(struct comm *c, int to, int64_t tag, const void *data, int64_t bytes,
                  int synchronous, struct mimdsim_request *r, const char *file, int line);
    void (*irecv)(struct comm *c, int from, int64_t tag, void *buffer, int64_t bytes,
                  struct mimdsim_request *r, const char *file, int line);
    void (*irecv_matching)(struct comm *c, int from, int64_t tag, int64_t mask, void *buffer,
                           int64_t capacity, struct mimdsim_request *r, const char *file, int line);
    void (*wait)(struct comm *c, struct mimdsim_request *r, const char *file, int line);
    int (*test)(struct comm *c, struct mimdsim_request *r, const char *file, int line);
    int (*wait_any)(struct comm *c, int n, struct mimdsim_request **r, int block, const char *file,
                    int line);
    int (*probe)(struct comm *c, int from, int64_t tag, int64_t mask, int block,
                 struct mimdsim_request *out, const char *file, int line);
    int (*cancel)(struct comm *c, struct mimdsim_request *r, const char *file, int line);
    void (*collective)(struct comm *c, const struct mimdsim_collective *k, const char *file,
                       int line);
    void (*algorithm)(struct comm *c, const char *collective, const char *name, const char *file,
                      int line);
    void (*count)(struct comm *c, const struct mimdsim_counts *w);
    void (*stage)(struct comm *c, int stage, const char *file, int line);
    int64_t (*now_ps)(struct comm *c);
    void *(*memory)(struct comm *c, int64_t bytes, const char *file, int line);
    void (*publish)(struct comm *c, int output, int64_t first, int64_t n, const double *data,
                    const char *file, int line);
    const double *(*output)(struct comm *c, int output, int64_t *n, const char *file, int line);
    void (*error)(struct comm *c, const char *quantity, double relative, const char *file,
                  int line);
    void (*fail)(struct comm *c, const char *text, const char *file, int line);
};

#ifdef __cplusplus
}
#endif

#endif

/* guest_world.h - ranks of one image: what they share, what each has; private to room guest. */
#ifndef GUEST_GUEST_WORLD_H
#define GUEST_GUEST_WORLD_H

#include <mimdsim/host.h>
#include <mimdsim/program_abi.h>

#include "base/arena.h"
#include "comm/collective_rules.h"
#include "comm/comm.h"
#include "guest/guest_lines.h"
#include "guest/guest_results.h"
#include "loader/loader.h"
#include "machine/node_cost.h"
#include "measure/run_result.h"
#include "program/program.h"
#include "spec/run_spec.h"

enum { GUEST_STACK_BYTES = 8 << 20 };

/* Which function of the image the ranks execute. */
enum guest_part { GUEST_RUN, GUEST_CHECK, GUEST_SERIAL /* and those that follow: serial codes */ };

/* All ranks of one image in one run, or one processor with a serial code. */
struct guest_world {
    const struct run_spec *spec;        /* of the run it belongs to */
    struct loader_template *image;      /* owned */
    bool alone;                         /* one processor without a network: it has one stage */
    void *owner;                        /* whoever made it, for its own use */
    int part;                           /* enum guest_part */
    int64_t stack_bytes;                /* of each rank */
    enum program_cost cost;             /* how its computing is counted */
    struct node_cost node;              /* what counted operations cost on a processor */
    const struct comm_functions *calls; /* what it may call: guest_calls */
    struct arena *memory;               /* what comm_memory takes; borrowed */
    struct guest_results *results;      /* what it publishes; borrowed */
    const struct guest_results *seen;   /* what a check looks at; NULL: nothing */
    int nrule;
    struct collective_rule rule[COLLECTIVE_MAX_RULES]; /* of the machine's software */
    struct run_result *check;                          /* where comm_error goes; NULL: nowhere */
    double tolerance;
    enum program_output output; /* what becomes of the ranks' lines */
    struct text *said;          /* where they gather; NULL: nowhere */
    double host_limit;          /* as in run_order */
    bool asked_size;            /* a rank asked how many ranks the run has */
};

/* One rank. What the program knows as struct comm is this. */
struct guest_rank {
    struct comm *comm;
    struct guest_world *world;
    struct loader_instance *instance;
    const struct mimdsim_program *declared;                         /* in this rank's own copy */
    const struct collective_algorithm *algorithm[COLLECTIVE_KINDS]; /* by comm_algorithm */
    struct guest_line line[2]; /* of standard output and error */
    double host_s;             /* cost by host time: when the rank last went on */
};

/* guest_mpi_type: programs with main. */
extern const struct program_type guest_mpi_type;

/* guest_calls: the functions behind mimdsim/program.h. */
extern const struct comm_functions guest_calls;

/* guest_declared: the declaration in an instance, as far as it is long and ours; the rest is zero.
 * Smaller ones are copied to `a`. NULL: the image declares none. */
const struct mimdsim_program *guest_declared(const struct loader_instance *i, struct arena *a);

/* guest_parameters_set: write the values of "NAME = VALUE" lines into the variables of a copy. */
void guest_parameters_set(const struct mimdsim_program *p, const char *lines, struct arena *a);

/* guest_parameter_field: a declared parameter as a field for program_parameter_text, in `a`. False
 * with a clause in `why`. */
bool guest_parameter_field(const struct mimdsim_parameter *p, struct field *f, struct arena *a,
                           char *why, int size);

/* guest_world_open: load the image, with its blocks priced for the machine of `node`, for nrank
 * ranks. False with the error; guest_world_close gives everything back, also then. */
bool guest_world_open(struct guest_world *w, const struct node_spec *node, int nrank,
                      struct err *e);
void guest_world_close(struct guest_world *w);

/* guest_rank_begin: a rank's copy of the image, of which nothing has run, with the calls of
 * program.h. */
void guest_rank_begin(struct guest_rank *g, struct comm *c, struct guest_world *w);

/* guest_rank_run: the text of one rank (rank_program.run): job is its world, workspace a
 * guest_rank. */
void guest_rank_run(struct comm *c, const void *job, void *workspace);

/* guest_rank_end_lines: lines that the rank has begun are whole. */
void guest_rank_end_lines(struct guest_rank *g);

/* guest_alone: run part `part` of the image on one processor of the run's machine.
 *
 *   out  out  as of world_run, arrays in `a`; what the part publishes is in w->results
 *
 *   Returns false with the error when it could not be made. */
bool guest_alone(struct guest_world *w, int part, int64_t stack_bytes, struct arena *a,
                 struct run_result *out, struct err *e);

#endif

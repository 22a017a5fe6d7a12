/* comm_type.h - what an implementation of comm.h provides: a struct comm and its table of
 * functions. */
#ifndef COMM_COMM_TYPE_H
#define COMM_COMM_TYPE_H

#include <stdint.h>

#include "base/work.h"

struct comm;

/* A pending operation. Zero-initialised ones are complete. Owned by the kernel, usually on its
 * stack; it must stay in place until its wait returns. */
struct comm_request {
    void *buffer;  /* receive: where the bytes go */
    int64_t bytes; /* of the message; of a receive that is pending: the room for it */
    int64_t tag;
    int peer;         /* the other rank; COMM_ANY_SOURCE while a receive from any is pending */
    int active;       /* 0: complete or never started */
    void *detail;     /* of the implementation */
    const char *file; /* where in the kernel it was posted, for the deadlock report */
    int line;
    int truncated;          /* receive: the message was longer than its room; the rest is lost */
    int64_t mask, capacity; /* receive: bits of the tag that count; room in buffer [B] */
    int64_t posted_ps;      /* receive: when it was posted */
    uint16_t kind, open;    /* of the implementation */
    uint32_t watch;         /* number under which it is watched, 0: it is not */
    /* of the implementation: what made a send complete, for critical paths */
    uint32_t path;
};

struct comm_envelope;

/* What an operation of a reduction asks of hardware, each more than the one before: nothing that it
 * could do (a program's own function, products), bits and truths, sums and extremes of whole
 * numbers, of floating-point numbers. */
enum comm_operation { COMM_OWN, COMM_LOGICAL, COMM_INTEGER, COMM_REAL };

/* What the network does by itself on all ranks of a machine. */
struct comm_hardware {
    unsigned kinds; /* bits 1 << enum collective_kind (collectives.h) */
    enum comm_operation operations; /* the most that it can combine */
    int64_t largest;                /* vector [B] */
    int eureka;                     /* a signal of one rank interrupts all (comm_search) */
};

/* What a rank says in a search of all ranks (comm_search). */
enum comm_search_state {
    COMM_SEARCH_GOES_ON,   /* nothing found yet, more to look at */
    COMM_SEARCH_FOUND,     /* this rank has found what all look for */
    COMM_SEARCH_EXHAUSTED, /* nothing left to look at */
    COMM_SEARCH_BEGIN      /* before the first step; every rank */
};

/* One rank's part in a collective of the network (comm_meet). Kind, root and bytes are the same on
 * every rank. */
struct comm_meeting {
    int kind, root;
    int64_t bytes; /* of every rank's data */
    void *data;    /* (bytes) this rank's: what it brings, then what it gets */
    /* called once, when all ranks are there, with the data of all n in their order */
    void (*act)(void *const *data, int n, void *context);
    void *context;
};

/* Where the numbers of one output gather on this host; x NULL: nobody wants them. */
struct comm_output {
    double *x; /* (n) */
    int64_t n;
};

struct comm_type {
    const char *name;
    void (*isend)(struct comm *c, int dst, int64_t tag, const void *data, int64_t bytes,
                  struct comm_request *r);
    void (*irecv)(struct comm *c, int src, int64_t tag, void *buffer, int64_t bytes,
                  struct comm_request *r);
    void (*wait)(struct comm *c, struct comm_request *r);
    void (*barrier)(struct comm *c);
    /* comm_meet; NULL: there is no such network, whatever the machine's file says */
    void (*meet)(struct comm *c, const struct comm_meeting *m);
    /* comm_search on a network with an eureka; NULL as meet */
    int (*search)(struct comm *c, int state);
    void (*work)(struct comm *c, const struct work *w);
    void (*stage)(struct comm *c, int stage);
    int64_t (*now_ps)(struct comm *c);
    void (*publish)(struct comm *c, int output, int64_t first, int64_t n, const double *data);
    void (*elapse)(struct comm *c, int64_t ps);
    void (*end_run)(struct comm *c, const char *text); /* never returns */
    /* Where time is this computer's: the program's own time begins here (1), or ends (0). NULL:
     * time is simulated. */
    void (*mark)(struct comm *c, int begin);
    /* The same for what takes no simulated time: the clock stands from 1 to 0. NULL as above. */
    void (*pause)(struct comm *c, int begin);

    /* comm_match.h */
    void (*isend_synchronous)(struct comm *c, int dst, int64_t tag, const void *data, int64_t bytes,
                              struct comm_request *r);
    void (*irecv_matching)(struct comm *c, int src, int64_t tag, int64_t mask, void *buffer,
                           int64_t capacity, struct comm_request *r);
    int (*complete_any)(struct comm *c, int n, struct comm_request *const *r, int block);
    int (*probe)(struct comm *c, int src, int64_t tag, int64_t mask, int block,
                 struct comm_envelope *out, struct comm_request *take);
    void (*receive_into)(struct comm *c, struct comm_request *r, void *buffer, int64_t capacity);
    int (*cancel)(struct comm *c, struct comm_request *r);
    void (*watch)(struct comm *c, struct comm_request *r);
    struct comm_request *(*next_complete)(struct comm *c, int64_t time_ps);
};

/* Every implementation's struct begins with this. */
struct comm {
    const struct comm_type *type;
    int rank, size;
    int noutput;
    const struct comm_hardware *hardware; /* of the network, NULL: none; borrowed */
    const struct comm_output
        *output;      /* (noutput) where comm_publish_here puts what is published; borrowed */
    const char *file; /* call site of the operation in progress, set by the macros below */
    int line;
    int keep_site; /* the caller sets file and line itself, once for all that one call of it does */
};

/* comm_site: the operations that follow are called from `file`, line `line`. */
static inline void comm_site(struct comm *c, const char *file, int line)
{
    if (c->keep_site) return;
    c->file = file;
    c->line = line;
}
#define COMM_HERE(c) comm_site((c), __FILE__, __LINE__)

#endif

/* run_parts.h - what the files of a run share: the memory, the scenes and the tapes that runs leave
 * to the next ones; private to run.c and opened.c. */
#ifndef RUN_RUN_PARTS_H
#define RUN_RUN_PARTS_H

#include "run/run.h"
#include "run/tape.h"

/* MOST_ATTEMPTS: no program asks for as many (kernel/trust.c). */
enum { MOST_CACHES = 8, MOST_ATTEMPTS = 16 };

/* One cache for all programs that make theirs with the same function, and the memory of a run:
 * `own` for the program's scene, `scratch` for workspaces and checks, `world` for the machine. */
struct run_cache {
    struct arena *own, *scratch, *world; /* owned; empty between runs */
    struct tapes *tapes; /* owned; NULL: every run is made */
    bool packs; /* fiber_packs, asked once: 64 calls of the system */
    int n;
    const struct program_type *type[MOST_CACHES]; /* (n) the first of those that share */
    struct program_cache *cache[MOST_CACHES]; /* (n) owned */
};

#endif

/* rank_program.h - what every rank of a run executes, and what it promises about it. */
#ifndef PROGRAM_RANK_PROGRAM_H
#define PROGRAM_RANK_PROGRAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "comm/comm.h"

/* `job` is the program's own, shared by all ranks and read-only to them. */
struct rank_program {
    int nstage;
    const char *const *stage_name; /* (nstage) */
    /* workspace_bytes: private memory of rank `rank`; given zeroed to run, aligned to 16. */
    size_t (*workspace_bytes)(const void *job, int rank);
    /* largest_message: no message of this job is larger [B]; -1: not known. NULL: not known. */
    int64_t (*largest_message)(const void *job);
    /* run: the program of one rank. */
    void (*run)(struct comm *c, const void *job, void *workspace);
    /* as in world_load; false for built-in programs */
    bool timed, no_synchronous, foreign, leftovers;
    int64_t stack_bytes; /* of each rank, 0: as for built-in programs */
    int depth; /* of the calls of run, as measured [B]; 0: not known. Acts on memory alone */
    /* deepest: beyond what no call of run goes with this job at level loggp [B]: measured for all
     * that the job may ask for, with the compiler and flags that configure knows (KNOWN_DEPTH), as
     * its stack may have no guard. 0: not known. NULL: not known. */
    int (*deepest)(const void *job);
};

#endif

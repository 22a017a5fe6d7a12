/* programs.c - the table of built-in programs: a new one is a line here and files of its own. */
#include "kernel/programs.h"

#include <string.h>

#include "kernel/dynamics_program.h"
#include "kernel/micro.h"
#include "kernel/micro_collective.h"

static const struct program_type *const programs[] = {
    &inverse_program,
    &forward_program,
    &dynamics_program,
    &pingpong_program,
    &shift_program,
    &bisection_program,
    &all_to_all_program,
    &hot_spot_program,
    &ring_program,
    &random_ring_program,
    &barrier_program,
    &message_barrier_program,
    &broadcast_program,
    &reduce_program,
    &allreduce_program,
    &gather_program,
    &scatter_program,
    &allgather_program,
    &alltoall_program,
    &alltoallv_program,
    &scan_program,
    &reduce_scatter_program,
};

const struct program_type *const *program_list(int *n)
{
    *n = (int)(sizeof programs / sizeof *programs);
    return programs;
}

const struct program_type *program_find(const char *name)
{
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        if (strcmp(programs[i]->name, name) == 0) return programs[i];
    return NULL;
}

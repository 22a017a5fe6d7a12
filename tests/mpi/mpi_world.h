/* mpi_world.h - MPI programs of the tests on simulated ranks, linked into the test without a
 * loader. */
#ifndef TESTS_MPI_MPI_WORLD_H
#define TESTS_MPI_MPI_WORLD_H

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include <mimdsim/mpi.h>

#include "mpi/mpi_rank.h"
#include "../vp/timed_world.h"

typedef void mpi_program(void *context);

/* mpi_go: `program` on n ranks of a crossbar, between MPI_Init and MPI_Finalize; the world's rules
 * may be NULL. */
struct outcome mpi_go(int n, mpi_program *program, void *context);

/* mpi_bare: the same without Init and Finalize, on any machine and set-up. */
struct outcome mpi_bare(const struct machine_spec *m, int n, const struct mpi_setup *setup,
                        mpi_program *program, void *context);

/* mpi_ok: mpi_go, and the run must end well. mpi_fails: it must fail with a text that has `text` in
 * it. */
void mpi_ok(int n, mpi_program *program, void *context);
void mpi_fails(int n, mpi_program *program, void *context, const char *text);

/* The own rank and the number of ranks. */
int own_rank(void);
int all_ranks(void);

/* messages_of: all that a run sent. */
int64_t messages_of(const struct outcome *o);
int64_t bytes_of(const struct outcome *o);

#endif

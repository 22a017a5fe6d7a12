/* mpi_fortran.h - how arguments of Fortran become C's: by reference, handles as integers, texts
 * with hidden lengths. */
#ifndef GUEST_MPI_FORTRAN_H
#define GUEST_MPI_FORTRAN_H

#include <stdlib.h>
#include <string.h>

#include "mpi_guest.h"

/* What a program names for "nothing" is a variable in a common block: its address is the sign. */
extern int mimdsim_mpi_bottom_, mimdsim_mpi_in_place_, mimdsim_mpi_status_ignore_[8],
    mimdsim_mpi_statuses_ignore_[8], mimdsim_mpi_unweighted_[1], mimdsim_mpi_weights_empty_[1];

static inline void *buffer_of(void *p)
{
    if (p == &mimdsim_mpi_bottom_) return MPI_BOTTOM;
    return p == &mimdsim_mpi_in_place_ ? MPI_IN_PLACE : p;
}

static inline MPI_Status *status_of(MPI_Status *s)
{
    void *p = s;
    return p == mimdsim_mpi_status_ignore_ || p == mimdsim_mpi_statuses_ignore_ ? NULL : s;
}

static inline int *weights_of(int *w)
{
    if (w == mimdsim_mpi_unweighted_) return MPI_UNWEIGHTED;
    return w == mimdsim_mpi_weights_empty_ ? MPI_WEIGHTS_EMPTY : w;
}

static inline int comm_size(MPI_Fint comm)
{
    int size = 0, inter = 0;
    MPI_Comm c = (MPI_Comm)(intptr_t)comm;
    PMPI_Comm_test_inter(c, &inter);
    if (inter) PMPI_Comm_remote_size(c, &size);
    else PMPI_Comm_size(c, &size);
    return size;
}

/* HANDLES_IN: n handles of `p` as an array p_. HANDLES_OUT: and back. */
#define HANDLES_IN(type, p, n)                                                                     \
    const int p##_n = (n);                                                                         \
    type p##_[p##_n > 0 ? p##_n : 1];                                                              \
    for (int i_ = 0; i_ < p##_n; i_++) p##_[i_] = (type)(intptr_t)(p)[i_]
#define HANDLES_OUT(p, n)                                                                          \
    for (int i_ = 0; i_ < (n); i_++) (p)[i_] = (MPI_Fint)(intptr_t)p##_[i_]

/* TEXT_IN: a text of Fortran, without the blanks behind it, as p_. */
#define TEXT_IN(p, length)                                                                         \
    char p##_[(length) + 1];                                                                       \
    text_in(p##_, p, length)
static inline void text_in(char *out, const char *in, size_t length)
{
    while (length > 0 && in[length - 1] == ' ') length--;
    memcpy(out, in, length);
    out[length] = '\0';
}

/* text_out: blanks behind it up to the variable's length. */
static inline void text_out(char *out, size_t length, const char *in)
{
    size_t n = strlen(in);
    if (n > length) n = length;
    memcpy(out, in, n);
    memset(out + n, ' ', length - n);
}

#endif

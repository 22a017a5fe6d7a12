/* mpi_status.c - statuses: source, tag, and in the internal words the number of bytes and whether
 * it was cancelled.
 *
 * Section 3.2.5 of MPI 5.0 for statuses, 5.1.11 for counts of elements, 13.3 for what the
 * program may set. */
#include "mpi/mpi_internal.h"

/* The error field belongs to calls that complete many requests: others leave it alone. */
void mpi_status_set(MPI_Status *s, int source, int tag, int64_t bytes)
{
    if (!s) return;
    s->MPI_SOURCE = source;
    s->MPI_TAG = tag;
    memcpy(s->MPI_internal, &bytes, sizeof bytes);
    s->MPI_internal[2] = 0;
}

/* Section 3.7.3: what null and inactive requests tell. Here the error field is told, too. */
void mpi_status_empty(MPI_Status *s)
{
    mpi_status_set(s, MPI_ANY_SOURCE, MPI_ANY_TAG, 0);
    if (s) s->MPI_ERROR = MPI_SUCCESS;
}

/* By memcpy: the internal words are ints and may lie on a boundary of four bytes. */
static int64_t bytes_of(const MPI_Status *s)
{
    int64_t bytes;
    memcpy(&bytes, s->MPI_internal, sizeof bytes);
    return bytes;
}

/* Bytes that are no whole number of elements have no count. A type of size 0 has 0
 * elements of any empty message. */
int mpi_get_count(struct mpi_rank *self, const MPI_Status *status, MPI_Datatype datatype,
                  MPI_Count *count)
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    if (!t) return self->code;
    int64_t bytes = bytes_of(status);
    if (t->size == 0) *count = bytes ? MPI_UNDEFINED : 0;
    else *count = bytes % t->size ? MPI_UNDEFINED : bytes / t->size;
    return MPI_SUCCESS;
}

/* elements: how many basic elements of n elements of t the first *bytes bytes hold; *bytes is what
 * is left. */
static int64_t elements(int64_t n, const struct mpi_type *t, int64_t *bytes)
{
    /* Whole elements are counted by their number of basics; of the one that is cut, each
     * piece is asked in turn. */
    int64_t whole = t->size ? *bytes / t->size : n, found;
    if (whole > n) whole = n;
    found = whole * t->basics;
    *bytes -= whole * t->size;
    if (whole == n || *bytes == 0 || !t->piece) return found;
    for (int k = 0; k<t->npiece && * bytes> 0; k++) {
        int64_t in_piece = t->piece[k].count * t->piece[k].length, before = *bytes;
        found += elements(in_piece, t->piece[k].of, bytes);
        if (*bytes == before && in_piece > 0) break; /* less than an element is left */
    }
    return found;
}

int mpi_get_elements(struct mpi_rank *self, const MPI_Status *status, MPI_Datatype datatype,
                     MPI_Count *count)
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    if (!t) return self->code;
    int64_t bytes = bytes_of(status);
    /* The type may be repeated without limit here, as only the bytes matter; the division
     * keeps the product within 64 bits. */
    *count = t->size ? elements(INT64_MAX / (t->basics ? t->basics : 1), t, &bytes) : 0;
    if (bytes > 0) *count = MPI_UNDEFINED;
    return MPI_SUCCESS;
}

int mpi_get_elements_x(struct mpi_rank *self, const MPI_Status *status, MPI_Datatype datatype,
                       MPI_Count *count)
{
    return mpi_get_elements(self, status, datatype, count);
}

/* Whole types first, so that the product does not overflow; the rest is a share of one
 * type's bytes, exact where all its basics have one size. */
int mpi_status_set_elements(struct mpi_rank *self, MPI_Status *status, MPI_Datatype datatype,
                            MPI_Count count)
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    if (!t) return self->code;
    int64_t n = t->basics ? t->basics : 1;
    int64_t bytes = count / n * t->size + count % n * t->size / n;
    memcpy(status->MPI_internal, &bytes, sizeof bytes);
    return MPI_SUCCESS;
}

int mpi_status_set_elements_x(struct mpi_rank *self, MPI_Status *status, MPI_Datatype datatype,
                              MPI_Count count)
{
    return mpi_status_set_elements(self, status, datatype, count);
}

int mpi_status_set_cancelled(struct mpi_rank *self, MPI_Status *status, int flag)
{
    (void)self;
    status->MPI_internal[2] = flag != 0;
    return MPI_SUCCESS;
}

int mpi_test_cancelled(struct mpi_rank *self, const MPI_Status *status, int *flag)
{
    (void)self;
    *flag = status->MPI_internal[2] != 0;
    return MPI_SUCCESS;
}

/* MPI 4.1 added functions for the public fields, for languages that cannot reach them. */
#define STATUS_FIELD(get, set, argument, field)                                                    \
    int get(struct mpi_rank *self, const MPI_Status *status, int *argument)                        \
    {                                                                                              \
        (void)self;                                                                                \
        *argument = status->field;                                                                 \
        return MPI_SUCCESS;                                                                        \
    }                                                                                              \
    int set(struct mpi_rank *self, MPI_Status *status, int argument)                               \
    {                                                                                              \
        (void)self;                                                                                \
        status->field = argument;                                                                  \
        return MPI_SUCCESS;                                                                        \
    }
STATUS_FIELD(mpi_status_get_error, mpi_status_set_error, error, MPI_ERROR)
STATUS_FIELD(mpi_status_get_source, mpi_status_set_source, source, MPI_SOURCE)
STATUS_FIELD(mpi_status_get_tag, mpi_status_set_tag, tag, MPI_TAG)

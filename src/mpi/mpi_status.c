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
    for (int k = 0; k < t->npiece; k++) {
        if (*bytes <= 0) break;
        int64_t in_piece = t->piece[k].count * t->piece[k].length, before = *bytes;
        found += elements(in_piece, t->piece[k].of, bytes);
        /* less than an element of this piece is left: it is none of the next one's */
        if (before - *bytes < in_piece * t->piece[k].of->size) break;
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

/* bytes_of_first: what the first n basic elements of types t take, whatever their sizes. Whole
 * types first, so that the product does not overflow; then piece by piece. */
static int64_t bytes_of_first(int64_t n, const struct mpi_type *t)
{
    int64_t most = t->basics ? t->basics : 1, bytes = n / most * t->size;
    n %= most;
    for (int k = 0; k < t->npiece && n > 0; k++) {
        const struct mpi_piece *p = &t->piece[k];
        const int64_t here = p->count * p->length * p->of->basics, some = n < here ? n : here;
        bytes += bytes_of_first(some, p->of);
        n -= some;
    }
    return bytes;
}

int mpi_status_set_elements(struct mpi_rank *self, MPI_Status *status, MPI_Datatype datatype,
                            MPI_Count count)
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    if (!t) return self->code;
    if (count < 0)
        return mpi_error(self, NULL, MPI_ERR_COUNT, "count %lld is negative", (long long)count);
    int64_t bytes = bytes_of_first(count, t);
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

/* mpi_pack.c - data from where a datatype says to bytes one behind the other, and back.
 *
 * Types are trees: a piece is blocks of another type, down to dense runs, which are moved
 * by memcpy. Packed bytes are in the order of the type map (section 5.1), without gaps
 * and without a header, as all ranks are of one host. */
#include "mpi/mpi_internal.h"

/* Bytes that are being moved between memory and a packed run; `left` stops a message that ends
 * early. */
struct mover {
    char *packed;
    int64_t left;
    bool out; /* from packed to memory */
};

static void move(struct mover *m, char *memory, int64_t bytes)
{
    /* A run is cut where the message ends; what lies behind stays as it was. */
    if (bytes > m->left) bytes = m->left;
    if (m->out) memcpy(memory, m->packed, (size_t)bytes);
    else memcpy(m->packed, memory, (size_t)bytes);
    m->packed += bytes;
    m->left -= bytes;
}

/* A dense type is one run whatever its depth, so contiguous data cost one memcpy.
 * Recursion is as deep as the program nests its types. */
static void move_type(struct mover *m, char *memory, int64_t n, const struct mpi_type *t);

static void move_piece(struct mover *m, char *memory, const struct mpi_piece *p)
{
    memory += p->at;
    /* blocks of one basic double or so are the common case: columns of a matrix */
    if (p->of->dense && p->length * p->of->size == 8 && m->left >= p->count * 8) {
        for (int64_t i = 0; i < p->count; i++, memory += p->stride, m->packed += 8)
            memcpy(m->out ? memory : m->packed, m->out ? m->packed : memory, 8);
        m->left -= p->count * 8;
        return;
    }
    for (int64_t i = 0; i < p->count && m->left > 0; i++)
        move_type(m, memory + i * p->stride, p->length, p->of);
}

static void move_type(struct mover *m, char *memory, int64_t n, const struct mpi_type *t)
{
    if (t->dense || !t->piece) {
        move(m, memory, n * t->size);
        return;
    }
    for (int64_t i = 0; i < n && m->left > 0; i++, memory += t->extent)
        for (int k = 0; k < t->npiece; k++) move_piece(m, memory, &t->piece[k]);
}

/* The cast takes const away for a mover that serves both directions. */
void mpi_pack_bytes(void *packed, const void *memory, int64_t n, const struct mpi_type *t)
{
    struct mover m = {.packed = packed, .left = n * t->size};
    move_type(&m, (char *)(uintptr_t)memory, n, t);
}

void mpi_unpack_bytes(void *memory, const void *packed, int64_t bytes, int64_t n,
                      const struct mpi_type *t)
{
    struct mover m = {.packed = (char *)(uintptr_t)packed, .left = bytes, .out = true};
    move_type(&m, memory, n, t);
}

/* Packing is charged as bytes that move through memory, at the node's rate: a library
 * that packs pays that, too. Network cards that gather by themselves are not modelled. */
void mpi_charge_copy(struct mpi_rank *r, int64_t bytes)
{
    const struct work w = {.bytes = (uint64_t)bytes};
    if (bytes > 0) comm_work(r->comm, &w);
}

/* mpi_copy_typed: as a message from a rank to itself would. */
int64_t mpi_copy_typed(struct mpi_rank *r, void *to, int64_t nto, const struct mpi_type *tto,
                       const void *from, int64_t nfrom, const struct mpi_type *tfrom)
{
    int64_t bytes = nfrom * tfrom->size, room = nto * tto->size;
    /* What does not fit is cut, as a message would be. */
    if (bytes > room) bytes = room;
    if (bytes == 0 || to == from) return bytes;
    /* Both runs may overlap in calls with one buffer, hence memmove. */
    if (tto->dense && tfrom->dense) {
        memmove(to, from, (size_t)bytes);
        return bytes;
    }
    char *packed = mpi_take(r->world, nfrom * tfrom->size);
    mpi_pack_bytes(packed, from, nfrom, tfrom);
    mpi_unpack_bytes(to, packed, bytes, nto, tto);
    mpi_give(r->world, packed);
    return bytes;
}

/* --- the program's own packing --- */

/* Section 5.2: `position` moves on, so that several calls fill one buffer. */
int mpi_pack(struct mpi_rank *self, const void *inbuf, MPI_Count incount, MPI_Datatype datatype,
             void *outbuf, MPI_Count outsize, MPI_Count *position, MPI_Comm comm)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    struct mpi_type *t = c ? mpi_type_of(self, datatype) : NULL;
    if (!t) return self->code;
    if (incount < 0)
        return mpi_error(self, c, MPI_ERR_COUNT, "count %lld is negative", (long long)incount);
    /* compared without a sum, which may be larger than any number */
    int64_t bytes = mpi_type_bytes(incount, t->size);
    if (*position < 0 || bytes > outsize || *position > outsize - bytes)
        return mpi_error(self, c, MPI_ERR_TRUNCATE, "%lld bytes at %lld do not fit in %lld",
                         (long long)bytes, (long long)*position, (long long)outsize);
    mpi_pack_bytes((char *)outbuf + *position, inbuf, incount, t);
    mpi_charge_copy(self, bytes);
    *position += bytes;
    return MPI_SUCCESS;
}

/* The type need not be that of the packing, only its bytes. */
int mpi_unpack(struct mpi_rank *self, const void *inbuf, MPI_Count insize, MPI_Count *position,
               void *outbuf, MPI_Count outcount, MPI_Datatype datatype, MPI_Comm comm)
{
    struct mpi_comm *c = mpi_comm_of(self, comm);
    struct mpi_type *t = c ? mpi_type_of(self, datatype) : NULL;
    if (!t) return self->code;
    if (outcount < 0)
        return mpi_error(self, c, MPI_ERR_COUNT, "count %lld is negative", (long long)outcount);
    /* compared without a sum, which may be larger than any number */
    int64_t bytes = mpi_type_bytes(outcount, t->size);
    if (*position < 0 || bytes > insize || *position > insize - bytes)
        return mpi_error(self, c, MPI_ERR_TRUNCATE, "%lld bytes at %lld are not in %lld",
                         (long long)bytes, (long long)*position, (long long)insize);
    mpi_unpack_bytes(outbuf, (const char *)inbuf + *position, bytes, outcount, t);
    mpi_charge_copy(self, bytes);
    *position += bytes;
    return MPI_SUCCESS;
}

/* An upper bound in the standard, the exact size here. */
int mpi_pack_size(struct mpi_rank *self, MPI_Count incount, MPI_Datatype datatype, MPI_Comm comm,
                  MPI_Count *size)
{
    struct mpi_type *t = mpi_comm_of(self, comm) ? mpi_type_of(self, datatype) : NULL;
    if (!t) return self->code;
    if (incount < 0)
        return mpi_error(self, NULL, MPI_ERR_COUNT, "count %lld is negative", (long long)incount);
    *size = mpi_type_bytes(incount, t->size);
    return MPI_SUCCESS;
}

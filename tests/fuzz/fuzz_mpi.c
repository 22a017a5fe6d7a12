/* fuzz_mpi.c - sequences of MPI calls: one to four ranks make the calls that the input lists, with
 * right and wrong handles, counts, ranks and tags. Every run ends: well, by a mistake that is told,
 * or by a deadlock that is told.
 *
 * An input is the number of ranks, whether errors return, and six bytes for each call: who makes
 * it, which call, and four choices. Programs are trusted with their own memory, so buffers are
 * large enough for what is asked. */
#include "fuzz.h"

#include <stdio.h>

#include "../mpi/mpi_world.h"

enum { AREA = 1 << 15, MIDDLE = AREA / 2, ROOM = 4096, KEPT = 8, MOST_CALLS = 64, MOST_RANKS = 4 };

/* What the input says. */
struct script {
    int nrank, ncall;
    bool errors_return;
    const uint8_t (*call)[6];
};

/* What one rank has. */
struct rank {
    char *out, *in; /* (AREA) */
    MPI_Comm comm[KEPT];
    MPI_Datatype type[KEPT];
    MPI_Group group[KEPT];
    MPI_Request request[KEPT];
    MPI_Win win[KEPT];
    const uint8_t *c;
};

static const int numbers[] = {
    0, 1, 2, 3, 4, 7, 16, 64, -1, -2, -3, -4, 255, 4096, 65536, 2147483647, -2147483647 - 1};
static int number(uint8_t x) { return numbers[x % (sizeof numbers / sizeof *numbers)]; }

static const MPI_Op ops[] = {MPI_SUM, MPI_MAX,    MPI_MIN,     MPI_BAND,
                             MPI_LOR, MPI_MAXLOC, MPI_OP_NULL, MPI_REPLACE};
static MPI_Op op_of(uint8_t x) { return ops[x % (sizeof ops / sizeof *ops)]; }

/* One in sixteen handles is a number that nobody gave out. */
static MPI_Comm comm_of(const struct rank *r, uint8_t x)
{
    return x >= 240 ? (MPI_Comm)(intptr_t)(x * 16843009u) : r->comm[x % KEPT];
}
static MPI_Datatype type_of(const struct rank *r, uint8_t x)
{
    return x >= 240 ? (MPI_Datatype)(intptr_t)(x * 16843009u) : r->type[x % KEPT];
}

/* Whether `count` of the type, `times` over, lie within the room around a buffer. A wrong type has
 * no data. */
static bool fits(const struct rank *r, uint8_t type, int count, int times)
{
    MPI_Aint low = 0, extent = 0, true_low = 0, true_extent = 0;
    MPI_Datatype t = type_of(r, type);
    if (count <= 0 || t == MPI_DATATYPE_NULL || type >= 240) return true;
    MPI_Type_get_extent(t, &low, &extent);
    MPI_Type_get_true_extent(t, &true_low, &true_extent);
    double span = (double)count * times * ((double)llabs(extent) + 1) + (double)llabs(true_low) +
                  (double)true_extent;
    return span < ROOM;
}

static void point_to_point(struct rank *r, unsigned which)
{
    const uint8_t *c = r->c;
    int count = number(c[3]), peer = number(c[4]), tag = c[5] % 5 == 4 ? number(c[5]) : c[5] % 5;
    MPI_Datatype t = type_of(r, c[2]);
    MPI_Comm comm = comm_of(r, c[5] / 5);
    MPI_Request *q = &r->request[(c[3] ^ c[4] ^ c[5]) % KEPT];
    MPI_Status status;
    int flag;
    if (!fits(r, c[2], count, 1)) return;
    switch (which) {
    case 0:
        MPI_Send(r->out + MIDDLE, count, t, peer, tag, comm);
        break;
    case 1:
        MPI_Recv(r->in + MIDDLE, count, t, peer, tag, comm, &status);
        break;
    case 2:
        MPI_Isend(r->out + MIDDLE, count, t, peer, tag, comm, q);
        break;
    case 3:
        MPI_Irecv(r->in + MIDDLE, count, t, peer, tag, comm, q);
        break;
    case 4:
        MPI_Ssend(r->out + MIDDLE, count, t, peer, tag, comm);
        break;
    case 5:
        MPI_Bsend(r->out + MIDDLE, count, t, peer, tag, comm);
        break;
    case 6:
        MPI_Sendrecv(r->out + MIDDLE, count, t, peer, tag, r->in + MIDDLE, count, t, peer, tag,
                     comm, &status);
        break;
    case 7:
        MPI_Iprobe(peer, tag, comm, &flag, &status);
        break;
    case 8:
        MPI_Send_init(r->out + MIDDLE, count, t, peer, tag, comm, q);
        break;
    default:
        MPI_Recv_init(r->in + MIDDLE, count, t, peer, tag, comm, q);
    }
}

static void collective(struct rank *r, unsigned which)
{
    const uint8_t *c = r->c;
    int count = number(c[3]), root = number(c[4]);
    MPI_Datatype t = type_of(r, c[2]);
    MPI_Comm comm = comm_of(r, c[5]);
    MPI_Op op = op_of(c[5] / 16);
    char *out = r->out + MIDDLE, *in = r->in + MIDDLE;
    if (!fits(r, c[2], count, MOST_RANKS)) return;
    switch (which) {
    case 0:
        MPI_Barrier(comm);
        break;
    case 1:
        MPI_Bcast(out, count, t, root, comm);
        break;
    case 2:
        MPI_Reduce(out, in, count, t, op, root, comm);
        break;
    case 3:
        MPI_Allreduce(out, in, count, t, op, comm);
        break;
    case 4:
        MPI_Gather(out, count, t, in, count, t, root, comm);
        break;
    case 5:
        MPI_Scatter(out, count, t, in, count, t, root, comm);
        break;
    case 6:
        MPI_Allgather(out, count, t, in, count, t, comm);
        break;
    case 7:
        MPI_Alltoall(out, count, t, in, count, t, comm);
        break;
    case 8:
        MPI_Scan(out, in, count, t, op, comm);
        break;
    case 9:
        MPI_Reduce_scatter_block(out, in, count, t, op, comm);
        break;
    case 10:
        MPI_Iallreduce(out, in, count, t, op, comm, &r->request[c[4] % KEPT]);
        break;
    default:
        MPI_Ibarrier(comm, &r->request[c[4] % KEPT]);
    }
}

/* long: a line for each call. Communicators, groups, types: made, freed, asked. */
static void objects(struct rank *r, unsigned which)
{
    const uint8_t *c = r->c;
    int a = number(c[3]), b = number(c[4]), dims[2] = {a, b}, periods[2] = {c[5] & 1, c[5] & 2}, n;
    MPI_Comm comm = comm_of(r, c[5]), *new_comm = &r->comm[c[3] % KEPT];
    MPI_Datatype t = type_of(r, c[2]), *new_type = &r->type[c[4] % KEPT];
    MPI_Group *g = &r->group[c[3] % KEPT], *h = &r->group[c[4] % KEPT];
    MPI_Aint places[2] = {a, b};
    switch (which) {
    case 0:
        MPI_Comm_dup(comm, new_comm);
        break;
    case 1:
        MPI_Comm_split(comm, a, b, new_comm);
        break;
    case 2:
        MPI_Comm_free(new_comm);
        break;
    case 3:
        MPI_Comm_group(comm, g);
        break;
    case 4:
        MPI_Group_incl(*g, c[5] % 3, dims, h);
        break;
    case 5:
        MPI_Group_union(*g, *h, g);
        break;
    case 6:
        MPI_Group_free(g);
        break;
    case 7:
        MPI_Comm_create(comm, *g, new_comm);
        break;
    case 8:
        MPI_Cart_create(comm, c[2] % 3, dims, periods, c[5] & 4, new_comm);
        break;
    case 9:
        MPI_Cart_coords(comm, a, 2, dims);
        break;
    case 10:
        MPI_Type_contiguous(a, t, new_type);
        break;
    case 11:
        MPI_Type_vector(a, b, (int)c[5] - 128, t, new_type);
        break;
    case 12:
        MPI_Type_create_hindexed(c[5] % 3, dims, places, t, new_type);
        break;
    case 13:
        MPI_Type_create_resized(t, a, b, new_type);
        break;
    case 14:
        MPI_Type_commit(new_type);
        break;
    case 15:
        MPI_Type_free(new_type);
        break;
    case 16:
        MPI_Type_size(t, &n);
        break;
    case 17:
        MPI_Comm_rank(comm, &n);
        break;
    case 18:
        MPI_Comm_set_errhandler(comm, c[3] & 1 ? MPI_ERRORS_RETURN : MPI_ERRORS_ARE_FATAL);
        break;
    default:
        MPI_Dims_create(a, 2, periods);
    }
}

static void complete(struct rank *r, unsigned which)
{
    const uint8_t *c = r->c;
    MPI_Request *q = &r->request[c[3] % KEPT];
    MPI_Status status[KEPT];
    int flag, index, n = c[4] % (KEPT - c[3] % KEPT + 1);
    switch (which) {
    case 0:
        MPI_Wait(q, status);
        break;
    case 1:
        MPI_Test(q, &flag, status);
        break;
    case 2:
        MPI_Waitall(n, q, status);
        break;
    case 3:
        MPI_Waitany(n, q, &index, status);
        break;
    case 4:
        MPI_Testall(n, q, &flag, MPI_STATUSES_IGNORE);
        break;
    case 5:
        MPI_Cancel(q);
        break;
    case 6:
        MPI_Request_free(q);
        break;
    case 7:
        MPI_Start(q);
        break;
    default:
        MPI_Startall(n, q);
    }
}

static void windows(struct rank *r, unsigned which)
{
    const uint8_t *c = r->c;
    int count = number(c[3]), target = number(c[4]);
    MPI_Win *w = &r->win[c[5] % KEPT];
    MPI_Datatype t = type_of(r, c[2]);
    MPI_Aint at = c[4];
    char *out = r->out + MIDDLE, *in = r->in + MIDDLE;
    if (!fits(r, c[2], count, 1)) return;
    switch (which) {
    case 0:
        MPI_Win_create(r->in + MIDDLE, ROOM, 1 + c[3] % 8, MPI_INFO_NULL, comm_of(r, c[4]), w);
        break;
    case 1:
        MPI_Win_fence(0, *w);
        break;
    case 2:
        MPI_Put(out, count, t, target, at, count, t, *w);
        break;
    case 3:
        MPI_Get(in, count, t, target, at, count, t, *w);
        break;
    case 4:
        MPI_Accumulate(out, count, t, target, at, count, t, op_of(c[5] / 16), *w);
        break;
    case 5:
        MPI_Win_lock(c[3] & 1 ? MPI_LOCK_SHARED : MPI_LOCK_EXCLUSIVE, target, 0, *w);
        break;
    case 6:
        MPI_Win_unlock(target, *w);
        break;
    default:
        MPI_Win_free(w);
    }
}

static void one_call(struct rank *r)
{
    unsigned which = r->c[1];
    if (which < 80) point_to_point(r, which % 10);
    else if (which < 130) collective(r, which % 12);
    else if (which < 200) objects(r, which % 20);
    else if (which < 232) complete(r, which % 9);
    else windows(r, which % 8);
}

static void prepare(struct rank *r, const struct script *s)
{
    const MPI_Datatype type[KEPT] = {MPI_INT,        MPI_DOUBLE, MPI_BYTE, MPI_DATATYPE_NULL,
                                     MPI_DOUBLE_INT, MPI_CHAR,   MPI_LONG, MPI_SHORT};
    for (int i = 0; i < KEPT; i++) {
        r->comm[i] = i == 3 ? MPI_COMM_NULL : i == 2 ? MPI_COMM_SELF : MPI_COMM_WORLD;
        r->type[i] = type[i];
        r->group[i] = i == 0 ? MPI_GROUP_NULL : MPI_GROUP_EMPTY;
        r->request[i] = MPI_REQUEST_NULL;
        r->win[i] = MPI_WIN_NULL;
    }
    if (s->errors_return) MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    if (s->errors_return) MPI_Comm_set_errhandler(MPI_COMM_SELF, MPI_ERRORS_RETURN);
}

/* Memory of a rank outlives its fiber, which a mistake of another rank may end anywhere. */
static struct rank ranks[MOST_RANKS];

static void play(void *context)
{
    const struct script *s = context;
    MPI_Init(NULL, NULL);
    int me = own_rank();
    struct rank *r = &ranks[me];
    prepare(r, s);
    for (int i = 0; i < s->ncall; i++) {
        r->c = s->call[i];
        if (r->c[0] == 0 || (r->c[0] >> me & 1) != 0) one_call(r);
    }
    MPI_Finalize();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const struct mpi_setup setup;
    if (size < 2) return -1;
    struct script s = {.nrank = 1 + data[0] % MOST_RANKS, .errors_return = data[1] & 1};
    s.ncall = (int)((size - 2) / 6);
    if (s.ncall > MOST_CALLS) s.ncall = MOST_CALLS;
    s.call = (const uint8_t(*)[6])(data + 2);
    for (int i = 0; i < s.nrank; i++) {
        if (ranks[i].out == NULL) ranks[i].out = malloc(AREA), ranks[i].in = malloc(AREA);
        CHECK(ranks[i].out != NULL && ranks[i].in != NULL);
        memset(ranks[i].out, i + 1, AREA);
        memset(ranks[i].in, 0, AREA);
    }
    struct machine_spec m = crossbar(s.nrank);
    struct outcome o = mpi_bare(&m, s.nrank, &setup, play, &s);
    CHECK(o.r.status == RUN_OK || o.r.text[0] != '\0');
    arena_destroy(o.arena);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    /* numbers of whole bytes: libFuzzer's own changes fit */
    (void)seed;
    return LLVMFuzzerMutate(data, size, most);
}

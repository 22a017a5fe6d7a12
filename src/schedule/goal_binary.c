/* goal_binary.c - schedules in the binary form that LogGOPSim reads and its txt2bin writes.
 *
 * Little-endian, nothing aligned:
 *
 *     8      4223
 *     4      number of ranks P
 *     1, 1   largest cpu, largest nic
 *     P x    8 begin, 8 end of a rank's part, counted from behind the first 8 bytes
 *     a part:
 *     4, 4   number of operations n, of those that require nothing k
 *     k x 4  these
 *     n x 39 4 how many it requires; 1 kind (1 send, 2 receive, 3 compute); 4 peer; 8 size; 4 tag;
 * 1 cpu; 1 nic; 4, 4 how many wait for its end, and where in the list these begin; 4, 4 for its
 * start the list: 4 an operation of the rank
 *
 * Peers and tags of all bits set mean any. Every number is checked before it is followed. */
#include <string.h>

#include "base/picoseconds.h"
#include "schedule/schedule.h"

enum { COOKIE = 4223, COOKIE_USED = 2342, HEAD = 8, OPERATION = 39 };

static const int64_t most_bytes = INT64_C(1) << 50;

struct binary {
    const unsigned char *data; /* behind the first 8 bytes */
    uint64_t n;
    const char *path;
    struct err *err;
    struct schedule_builder *b;
};

/* A number of `bytes` bytes at `at`, which lies in the file. */
static uint64_t get(const struct binary *f, uint64_t at, int bytes)
{
    uint64_t x = 0;
    for (int i = bytes - 1; i >= 0; i--) x = x << 8 | f->data[at + (uint64_t)i];
    return x;
}

static bool broken(struct binary *f, int rank, const char *what, uint64_t value)
{
    return err_set_at(f->err, ERR_DATA, f->path, 0, "a broken binary schedule: rank %d: %s %llu",
                      rank, what, (unsigned long long)value);
}

/* Where the parts of a rank's part are. */
struct part {
    int rank;
    uint64_t begin, end, nop, operations, list, nlist;
};

static bool find_part(struct binary *f, int rank, struct part *p)
{
    const uint64_t table = 6 + 16 * (uint64_t)rank;
    *p = (struct part){.rank = rank, .begin = get(f, table, 8), .end = get(f, table + 8, 8)};
    if (p->end > f->n || p->begin > p->end || p->end - p->begin < 8)
        return broken(f, rank, "its part ends at byte", p->end);
    const uint64_t roots = get(f, p->begin + 4, 4), room = p->end - p->begin - 8;
    p->nop = get(f, p->begin, 4);
    if (roots > p->nop || 4 * roots + OPERATION * p->nop > room)
        return broken(f, rank, "its number of operations is", p->nop);
    p->operations = p->begin + 8 + 4 * roots;
    p->list = p->operations + OPERATION * p->nop;
    p->nlist = (p->end - p->list) / 4;
    return true;
}

static bool read_op(struct binary *f, const struct part *p, uint64_t i)
{
    const uint64_t at = p->operations + OPERATION * i, kind = get(f, at + 4, 1),
                   peer = get(f, at + 5, 4);
    const uint64_t size = get(f, at + 9, 8), tag = get(f, at + 17, 4),
                   nrank = (uint64_t)f->b->s.nrank;
    struct schedule_op op = {.size = (int64_t)size, .cpu = (uint8_t)get(f, at + 21, 1)};
    if (kind < 1 || kind > 3) return broken(f, p->rank, "an operation of kind", kind);
    op.kind = kind == 1 ? SCHEDULE_SEND : kind == 2 ? SCHEDULE_RECEIVE : SCHEDULE_COMPUTE;
    if (size > (uint64_t)(op.kind == SCHEDULE_COMPUTE ? PS_LAST : most_bytes))
        return broken(f, p->rank, "an operation of size", size);
    const bool any = op.kind == SCHEDULE_RECEIVE && peer == UINT32_MAX;
    if (op.kind != SCHEDULE_COMPUTE && peer >= nrank && !any)
        return broken(f, p->rank, "a message with rank", peer);
    if (op.kind == SCHEDULE_SEND && tag == UINT32_MAX)
        return broken(f, p->rank, "a message of any tag to rank", peer);
    if (op.kind != SCHEDULE_COMPUTE) {
        op.peer = any ? SCHEDULE_ANY : (int32_t)peer;
        op.tag = tag == UINT32_MAX ? SCHEDULE_ANY : (int64_t)tag;
    }
    return schedule_add_op(f->b, &op) >= 0 ||
           broken(f, p->rank, "more operations than", SCHEDULE_MOST_OPERATIONS);
}

/* What waits for operation i, `n` from place `from` of the list on. */
static bool read_waiting(struct binary *f, const struct part *p, uint64_t i, uint64_t n,
                         uint64_t from, bool start)
{
    const int64_t first = f->b->begin[p->rank];
    if (n > 0 && (from > p->nlist || n > p->nlist - from))
        return broken(f, p->rank, "more dependencies than its list has:", n);
    for (uint64_t k = 0; k < n; k++) {
        const uint64_t op = get(f, p->list + 4 * (from + k), 4);
        if (op >= p->nop) return broken(f, p->rank, "a dependency of operation", op);
        if (!schedule_add_dependency(f->b, first + (int64_t)op, first + (int64_t)i, start))
            return broken(f, p->rank, "too many dependencies:", n);
    }
    return true;
}

static bool read_part(struct binary *f, int rank)
{
    struct part p;
    if (!find_part(f, rank, &p)) return false;
    f->b->begin[rank] = f->b->s.nop;
    for (uint64_t i = 0; i < p.nop; i++)
        if (!read_op(f, &p, i)) return false;
    f->b->end[rank] = f->b->s.nop;
    for (uint64_t i = 0; i < p.nop; i++) {
        const uint64_t at = p.operations + OPERATION * i + 23;
        if (!read_waiting(f, &p, i, get(f, at, 4), get(f, at + 4, 4), false) ||
            !read_waiting(f, &p, i, get(f, at + 8, 4), get(f, at + 12, 4), true))
            return false;
    }
    return true;
}

bool goal_is_binary(const char *data, size_t n)
{
    const struct binary f = {.data = (const unsigned char *)data};
    return n >= HEAD && (get(&f, 0, 8) == COOKIE || get(&f, 0, 8) == COOKIE_USED);
}

struct schedule *goal_read_binary(const char *data, size_t n, const char *path, struct arena *a,
                                  struct err *e)
{
    struct schedule_builder b = {0};
    struct binary f = {(const unsigned char *)data + HEAD, n - HEAD, path, e, &b};
    struct schedule *s = NULL;
    const struct binary head = {.data = (const unsigned char *)data};
    if (get(&head, 0, 8) == COOKIE_USED) {
        err_set_at(e, ERR_DATA, path, 0,
                   "this binary schedule was used up by a run of LogGOPSim with --save-mem");
        return NULL;
    }
    const uint64_t nrank = f.n >= 6 ? get(&f, 0, 4) : 0;
    if (nrank < 1 || nrank > SCHEDULE_MOST_RANKS || 16 * nrank + 6 > f.n) {
        broken(&f, 0, "the number of ranks is", nrank);
        return NULL;
    }
    schedule_begin(&b, (int)nrank);
    bool fine = true;
    for (int r = 0; fine && r < (int)nrank; r++) fine = read_part(&f, r);
    if (fine) s = schedule_finish(&b, path, a, e);
    schedule_discard(&b);
    return s;
}

/* host_warm.c - the memory of messages, before any is measured (host_parts.h).
 *
 * MPI hands messages between processes of one computer over in cells of shared memory, which it
 * uses in turn. The first use of each page of a cell is a page fault in both processes: 0.1 to
 * 12 us, where a message takes 0.7, and several of a program's first hundreds of messages meet one
 * each. A program of a few messages would be measured at two to five times its time. */
#include <stdlib.h>

#include "base/memory.h"
#include "host/host_parts.h"

/* UNDER_WAY: messages at once, as many as MPICH has cells; ROUNDS: those that wait for a cell use
 * the ones left over. LEAST, MOST: sizes, doubled, since what is too large for a cell is handed
 * over in another way, and how large a cell is nobody tells. HEADER: of a message, in its cell.
 * FEW: processes of which all pairs are prepared. */
enum { FEW = 16, UNDER_WAY = 64, ROUNDS = 2, LEAST = 4096, MOST = 65536, HEADER = 192, TAG = 1 };

/* What one exchange needs. */
struct exchange {
    struct host_comm *h;
    int to, from;
    char *out, *in;
    struct hosts_request send[UNDER_WAY];
};

/* `n` messages each way. Sends begin first: as many cells as there are messages are taken before
 * one is given back. */
static bool exchange(struct exchange *x, int n, size_t bytes)
{
    const struct lane_calls *call = x->h->hosts->call->lane;
    struct lane *lane = &x->h->lane;
    struct hosts_request r;
    bool ok = true;
    for (int i = 0; ok && i < n; i++)
        ok = call->send_begin(lane, x->to, TAG, x->out, bytes, false, &x->send[i]);
    for (int i = 0; ok && i < n; i++)
        ok = call->receive_begin(lane, x->from, TAG, x->in, bytes, &r) && call->wait(&r, NULL);
    for (int i = 0; ok && i < n; i++) ok = call->wait(&x->send[i], NULL);
    return ok;
}

/* Where processes lie `distance` apart in a ring. */
static void pair_up(struct exchange *x, int distance)
{
    const int size = x->h->comm.size, rank = x->h->comm.rank;
    x->to = (rank + distance) % size;
    x->from = (rank + size - distance) % size;
}

/* All pairs of few processes; of many, those of rings and of recursive doubling, both ways. */
static bool is_usual(int distance, int size)
{
    const int back = size - distance;
    return size <= FEW || (distance & (distance - 1)) == 0 || (back & (back - 1)) == 0;
}

bool host_warm_messages(struct host_comm *h)
{
    h->warm = memory_zeroed(2, (size_t)MOST);
    struct exchange x = {.h = h, .out = h->warm, .in = h->warm + MOST};
    bool ok = true;
    /* Each process has pages of its own of all cells. */
    for (int distance = 1; ok && distance < h->comm.size; distance++) {
        if (!is_usual(distance, h->comm.size)) continue;
        pair_up(&x, distance);
        for (size_t bytes = LEAST; ok && bytes <= MOST; bytes *= 2)
            for (int k = 0; ok && k < ROUNDS; k++) ok = exchange(&x, UNDER_WAY, bytes - HEADER);
    }
    return ok;
}

/* From what was done between two repetitions the code of MPI and of the system is in no cache. */
bool host_warm_caches(struct host_comm *h)
{
    struct exchange x = {.h = h, .out = h->warm, .in = h->warm + MOST};
    pair_up(&x, 1);
    return exchange(&x, 1, MOST) && exchange(&x, 1, MOST);
}

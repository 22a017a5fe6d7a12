/* messages.c - see messages.h.
 *
 * The two ranks do different things of one measurement, which `measure` calls once a sample,
 * between MPI's barriers. Whether the host took a processor away is asked of both; a sample counts
 * when neither was disturbed. */
#include "reality/messages.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "measure/real_row.h"
#include "reality/jumps.h"

enum {
    TAG = 3,
    ROUNDS = 4,
    TRAIN = 16,
    LARGEST = 1 << 20,
    LARGE = 100000,
    ATTEMPTS = 40,
    LEAST_PART = 10,
    LEAST_SAMPLES = 5,
    LATE_NS = 60000
};

/* No further attempt at one number after this time in samples [s]. */
#define MOST_SECONDS 1.0

struct bench {
    const struct hosts *hosts;
    struct host_comm *host;
    struct comm *c;
    int rank, samples;
    char *out, *in; /* (TRAIN x LARGEST would be too much: receives of a train share `in`) */
    int64_t bytes;
    int64_t *mine, *all; /* (2 samples), (size x 2 samples): ns and whether disturbed */
};

/* One sample on this rank [ns]; the number of rank 0 or 1 that counts is the largest of both. */
typedef int64_t sample_fn(struct bench *b);

static void spin(int64_t ns)
{
    const int64_t until = host_clock_ns() + ns;
    while (host_clock_ns() < until) continue;
}

/* --- one sample of each kind ------------------------------------------------------------------ */

/* ROUNDS times there and back; a message is half of one. Thousandths of a nanosecond are kept. */
static int64_t round_trip(struct bench *b)
{
    /* The shorter a sample, the more of them are undisturbed. */
    const int rounds = b->bytes > LARGE ? 1 : ROUNDS;
    const int64_t begin = host_clock_ns();
    if (b->rank > 1) return 0;
    for (int i = 0; i < rounds; i++) {
        if (b->rank == 0) comm_send(b->c, 1, TAG, b->out, b->bytes);
        comm_recv(b->c, 1 - b->rank, TAG, b->in, b->bytes);
        if (b->rank == 1) comm_send(b->c, 0, TAG, b->out, b->bytes);
    }
    return b->rank == 0 ? (host_clock_ns() - begin) * 1000 / (2 * rounds) : 0;
}

/* The receiver waits already; the sender has been quiet for a while. */
static int64_t isolated_send(struct bench *b)
{
    int64_t took = 0;
    if (b->rank == 0) {
        struct comm_request r;
        spin(3000);
        const int64_t begin = host_clock_ns();
        comm_isend(b->c, 1, TAG, b->out, b->bytes, &r);
        took = (host_clock_ns() - begin) * 1000;
        comm_wait(b->c, &r);
    }
    if (b->rank == 1) comm_recv(b->c, 0, TAG, b->in, b->bytes);
    return took;
}

/* The message has been there for long when its receive begins. */
static int64_t late_receive(struct bench *b)
{
    int64_t took = 0;
    if (b->rank == 0) comm_send(b->c, 1, TAG, b->out, b->bytes);
    if (b->rank == 1) {
        spin(LATE_NS + b->bytes / 4);
        const int64_t begin = host_clock_ns();
        comm_recv(b->c, 0, TAG, b->in, b->bytes);
        took = (host_clock_ns() - begin) * 1000;
    }
    return took;
}

/* TRAIN messages and an answer, less one message and an answer. */
static int64_t train_of(struct bench *b, int n)
{
    struct comm_request r[TRAIN];
    char none;
    int64_t took = 0;
    if (b->rank == 0) {
        const int64_t begin = host_clock_ns();
        for (int i = 0; i < n; i++) comm_send(b->c, 1, TAG, b->out, b->bytes);
        comm_recv(b->c, 1, TAG, &none, 0);
        took = host_clock_ns() - begin;
    }
    if (b->rank == 1) {
        for (int i = 0; i < n; i++) comm_irecv(b->c, 0, TAG, b->in, b->bytes, &r[i]);
        comm_waitall(b->c, n, r);
        comm_send(b->c, 0, TAG, &none, 0);
    }
    return took;
}

static int64_t short_train(struct bench *b) { return train_of(b, 1) * 1000; }

static int64_t long_train(struct bench *b) { return train_of(b, TRAIN) * 1000; }

/* How long the sender waits for a receiver that comes late. */
static int64_t sender_waits(struct bench *b)
{
    int64_t took = 0;
    if (b->rank == 0) {
        struct comm_request r;
        const int64_t begin = host_clock_ns();
        comm_isend(b->c, 1, TAG, b->out, b->bytes, &r);
        comm_wait(b->c, &r);
        took = (host_clock_ns() - begin) * 1000;
    }
    if (b->rank == 1) {
        spin(2 * LATE_NS + b->bytes / 4);
        comm_recv(b->c, 0, TAG, b->in, b->bytes);
    }
    return took;
}

static int64_t barrier_time(struct bench *b)
{
    const int64_t begin = host_clock_ns();
    for (int i = 0; i < ROUNDS; i++) host_comm_barrier(b->host);
    return (host_clock_ns() - begin) * 1000 / ROUNDS;
}

/* --- many samples ----------------------------------------------------------------------------- */

static bool fail(struct bench *b, struct err *e)
{
    return err_set(e, ERR_INTERNAL, "%s reports an error", b->hosts->call->library);
}

/* The undisturbed samples so far [s]. */
struct series {
    double *value; /* (n) room for ATTEMPTS series */
    int n, made;
    double spent; /* time of all, the same on all processes [s] */
};

/* One more series of samples. */
static bool one_series(struct bench *b, sample_fn *sample, struct series *s, struct err *e)
{
    for (int i = 0; i < b->samples; i++) {
        if (!host_comm_barrier(b->host)) return fail(b, e);
        const int64_t before = host_switches();
        b->mine[2 * i] = sample(b);
        b->mine[2 * i + 1] = host_switches() - before;
    }
    if (!b->hosts->call->gather(b->mine, 2 * b->samples, b->all)) return fail(b, e);
    for (int i = 0; i < b->samples; i++) {
        int64_t most = 0, disturbed = 0;
        for (int k = 0; k < b->hosts->size; k++) {
            const int64_t *one = b->all + (size_t)2 * (size_t)b->samples * (size_t)k + 2 * i;
            if (one[0] > most) most = one[0];
            disturbed += one[1];
        }
        s->spent += (double)most * 1e-12;
        if (disturbed == 0 && most > 0) s->value[s->n++] = (double)most * 1e-12;
    }
    s->made += b->samples;
    return true;
}

/* Again while too few samples are undisturbed; then it is said what the matter is. The median of
 * those that are: the least of some hundreds of times of a fifth of a microsecond is a lucky one,
 * which programs do not meet. */
static bool measure(struct bench *b, sample_fn *sample, const char *what, struct message_point *p,
                    double *out, struct err *e)
{
    int wanted = b->samples / LEAST_PART;
    if (wanted < LEAST_SAMPLES) wanted = LEAST_SAMPLES;
    struct series s = {.value = memory_zeroed((size_t)b->samples * ATTEMPTS, sizeof *s.value)};
    bool ok = true;
    for (int i = 0; ok && i < ATTEMPTS && s.n < wanted && s.spent < MOST_SECONDS; i++)
        ok = one_series(b, sample, &s, e);
    p->samples += s.made;
    p->disturbed += s.made - s.n;
    *out = s.n > 0 ? real_times_of(s.value, s.n).median : 0;
    free(s.value);
    if (!ok || s.n >= wanted) return ok;
    return err_set(e, ERR_BUSY,
                   "%s at %lld B: of %d samples only %d were undisturbed, fewer than %d: other "
                   "programs take the processors; try again when the computer is quieter",
                   what, (long long)b->bytes, s.made, s.n, wanted);
}

/* Whether a send of `bytes` waits for its receive: by the median of a few samples, whose two cases
 * lie far apart. */
static bool is_rendezvous(struct bench *b, int64_t bytes, bool *waits, struct err *e)
{
    struct message_point unused = {0};
    double least;
    b->bytes = bytes;
    const int all = b->samples;
    b->samples = all < 8 ? all : 8;
    const bool ok = measure(b, sender_waits, "waiting of a send", &unused, &least, e);
    b->samples = all;
    *waits = least > 1e-9 * LATE_NS;
    return ok;
}

/* The largest size that is sent at once, by halving: whether a send waits rises with its size. */
static bool find_eager_most(struct bench *b, int64_t *most, struct err *e)
{
    int64_t low = 0, high = LARGEST;
    bool waits;
    if (!is_rendezvous(b, high, &waits, e)) return false;
    *most = INT64_MAX;
    if (!waits) return true;
    if (!is_rendezvous(b, low, &waits, e)) return false;
    *most = -1;
    if (waits) return true;
    while (high - low > 1) {
        const int64_t middle = low + (high - low) / 2;
        if (!is_rendezvous(b, middle, &waits, e)) return false;
        if (waits) high = middle;
        else low = middle;
    }
    *most = low;
    return true;
}

/* --- all sizes -------------------------------------------------------------------------------- */

/* Powers of two and nothing, with the sizes on both sides of the switch. */
static int choose_sizes(int64_t eager_most, struct message_point *p)
{
    static const int64_t size[] = {0,    8,     64,    256,   512,    1024,   2048,   4096,
                                   8192, 16384, 32768, 65536, 131072, 262144, 524288, LARGEST};
    int n = 0;
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        const int64_t before = i > 0 ? size[i - 1] : -1;
        for (int64_t s = eager_most; s <= eager_most + 1 && eager_most < LARGEST; s++)
            if (s > before && s < size[i]) p[n++].bytes = s;
        p[n++].bytes = size[i];
    }
    for (int i = 0; i < n; i++) p[i].rendezvous = p[i].bytes > eager_most;
    return n;
}

/* The least time of a train and of one message, each on its own: the least of their differences
 * would be that of a slow one message. */
static bool measure_train(struct bench *b, struct message_point *p, struct err *e)
{
    double one, all;
    if (!measure(b, short_train, "message with its answer", p, &one, e) ||
        !measure(b, long_train, "train", p, &all, e))
        return false;
    p->train = fmax(all - one, 0) / (TRAIN - 1);
    return true;
}

static bool measure_point(struct bench *b, struct message_point *p, struct err *e)
{
    const int all = b->samples;
    b->bytes = p->bytes;
    /* Large ones take longer and vary less. */
    if (p->bytes > LARGE && all / 4 > LEAST_SAMPLES) b->samples = all / 4;
    const bool ok = measure(b, round_trip, "round trip", p, &p->one_way, e) &&
                    measure(b, isolated_send, "isolated send", p, &p->send, e) &&
                    measure(b, late_receive, "late receive", p, &p->recv, e) &&
                    (p->bytes > LARGE || measure_train(b, p, e));
    b->samples = all;
    return ok;
}

/* Between two sizes that lie on lines far apart, more sizes by halving, until it is known where the
 * one line ends. All processes have the same numbers, and so come to the same sizes. */
static bool close_jumps(struct bench *b, struct messages *out, struct err *e)
{
    for (int64_t size; out->n < MESSAGES_SIZES && (size = jumps_open(out)) >= 0;) {
        struct message_point p = {.bytes = size, .rendezvous = size > out->eager_most};
        if (!measure_point(b, &p, e)) return false;
        int i = out->n++;
        for (; i > 0 && out->point[i - 1].bytes > size; i--) out->point[i] = out->point[i - 1];
        out->point[i] = p;
    }
    return true;
}

bool messages_measure(const struct hosts *hosts, struct host_comm *comm, int samples,
                      struct messages *out, struct err *e)
{
    struct message_point unused = {0};
    struct host_times times;
    bool left;
    struct bench b = {.hosts = hosts, .host = comm, .rank = hosts->rank, .samples = samples};
    memset(out, 0, sizeof *out);
    b.c = host_comm_run_begin(comm, false, 1, NULL, 0);
    b.out = memory_zeroed(LARGEST, 1);
    b.in = memory_zeroed(LARGEST, 1);
    b.mine = memory_zeroed((size_t)samples * 2, sizeof *b.mine);
    b.all = memory_zeroed((size_t)samples * 2 * (size_t)hosts->size, sizeof *b.all);
    bool ok = find_eager_most(&b, &out->eager_most, e);
    if (ok) out->n = choose_sizes(out->eager_most, out->point);
    for (int i = 0; ok && i < out->n; i++) ok = measure_point(&b, &out->point[i], e);
    ok = ok && close_jumps(&b, out, e);
    b.bytes = 0;
    ok = ok && measure(&b, barrier_time, "barrier", &unused, &out->barrier, e);
    free(b.out);
    free(b.in);
    free(b.mine);
    free(b.all);
    return host_comm_run_end(comm, &times, &left) && ok;
}

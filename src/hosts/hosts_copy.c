/* hosts_copy.c - see hosts_copy.h. Large arrays go in pieces, whose size fits an int.
 *
 * No collective operations of MPI: they wait by spinning, which takes the processor from a process
 * of the same host that still computes, and a process that has gone would hold the others for
 * ever. */
#include "hosts/hosts_copy.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/check.h"

enum { PIECE = 1 << 26, PAUSE_US = 200, MOST_SUMS = 16 };

/* Messages of one sender with one tag come in the order sent: pieces need no numbers. */
bool hosts_copy_out(const struct hosts *h, int to, int tag, const void *data, size_t bytes)
{
    for (const char *p = data; bytes > 0;) {
        const size_t n = bytes < PIECE ? bytes : PIECE;
        if (!h->call->send(to, tag, p, n)) return false;
        p += n;
        bytes -= n;
    }
    return true;
}

/* Each piece tells its size; together they are what was asked for, or the sender has another
 * mind. */
bool hosts_copy_in(const struct hosts *h, int from, int tag, void *data, size_t bytes)
{
    for (char *p = data; bytes > 0;) {
        struct hosts_message m;
        bool there;
        if (!h->call->look(from, tag, false, &there, &m)) return false;
        if (!there) {
            usleep(PAUSE_US);
            continue;
        }
        if (m.bytes > bytes || !h->call->receive(&m, p)) return false;
        p += m.bytes;
        bytes -= m.bytes;
    }
    return true;
}

/* One after the other: what all are told is small, and told a few times a run. */
bool hosts_tell(const struct hosts *h, int tag, void *data, size_t bytes)
{
    bool ok = true;
    if (h->rank > 0) return hosts_copy_in(h, 0, tag, data, bytes);
    for (int i = 1; i < h->size; i++) ok = hosts_copy_out(h, i, tag, data, bytes) && ok;
    return ok;
}

/* On process 0 alone, which tells the others what follows from it. The values are whole numbers, so
 * the result does not depend on the order, nor on how many processes they are divided among. */
static bool reduce(const struct hosts *h, int tag, enum hosts_reduction how, int64_t *value, int n)
{
    int64_t other[MOST_SUMS];
    CHECK(n <= MOST_SUMS);
    const size_t bytes = (size_t)n * sizeof *value;
    if (h->rank > 0) return hosts_copy_out(h, 0, tag, value, bytes);
    for (int i = 1; i < h->size; i++) {
        if (!hosts_copy_in(h, i, tag, other, bytes)) return false;
        for (int k = 0; k < n; k++)
            if (how == HOSTS_SUM) value[k] += other[k];
            else if (other[k] > value[k]) value[k] = other[k];
    }
    return true;
}

bool hosts_sum(const struct hosts *h, int tag, int64_t *value, int n)
{
    return reduce(h, tag, HOSTS_SUM, value, n);
}

/* What process 0 has, on all. One tag is enough: messages between two processes keep their
 * order. */
static bool reduce_all(const struct hosts *h, int tag, enum hosts_reduction how, int64_t *value,
                       int n)
{
    return reduce(h, tag, how, value, n) && hosts_tell(h, tag, value, (size_t)n * sizeof *value);
}

bool hosts_all_sum(const struct hosts *h, int tag, int64_t *value, int n)
{
    return reduce_all(h, tag, HOSTS_SUM, value, n);
}

/* Of signed numbers, as sums are. */
bool hosts_all_largest(const struct hosts *h, int tag, int64_t *value, int n)
{
    return reduce_all(h, tag, HOSTS_LARGEST, value, n);
}

/* What a process says of itself, and process 0 of all. */
struct verdict {
    int32_t kind; /* enum err_kind; ERR_NONE: it can go on */
    char text[sizeof((struct err *)0)->text];
};

/* The first process that cannot decides: what is wrong with all of them is told once. */
static bool first_reason(const struct hosts *h, int tag, struct verdict *v)
{
    for (int i = 1; i < h->size; i++) {
        struct verdict other;
        if (!hosts_copy_in(h, i, tag, &other, sizeof other)) return false;
        if (v->kind != ERR_NONE || other.kind == ERR_NONE) continue;
        v->kind = other.kind;
        snprintf(v->text, sizeof v->text, "process %d of the job: %.*s", i,
                 (int)sizeof other.text - 40, other.text);
    }
    return true;
}

/* Every process gives its verdict before it hears that of all: none is left waiting for a message
 * of one that has turned back. */
bool hosts_agree(const struct hosts *h, int tag, bool ok, struct err *e)
{
    struct verdict v = {.kind = ok ? ERR_NONE : (int32_t)e->kind};
    if (!ok) memcpy(v.text, e->text, sizeof v.text);
    const bool heard = (h->rank == 0 ? first_reason(h, tag, &v)
                                     : hosts_copy_out(h, 0, tag, &v, sizeof v)) &&
                       hosts_tell(h, tag, &v, sizeof v);
    if (heard && v.kind == ERR_NONE) return true;
    /* Process 0 keeps the place in a file that its own reason has. */
    if (h->rank == 0 && !ok) return false;
    err_clear(e);
    return heard ? err_set(e, (enum err_kind)v.kind, "%s", v.text)
                 : err_set(e, ERR_INTERNAL, HOSTS_SILENT);
}

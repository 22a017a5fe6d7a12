/* pool.c - messages that nobody uses, by size.
 *
 * A run on one thread has one pool. Where several threads run one, each has its own, so that
 * taking and giving need no lock. A message ends at its receiver, so traffic that goes one way
 * empties the sender's pool and fills the receiver's: lists of a fixed length (magazines, after
 * Bonwick and Adams, USENIX 2001) go back through a depot, and memory stays what one thread needs
 * and a few lists. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "vp/vp.h"

/* REACH: how many classes larger the memory of a small message may be. */
enum { CLASS_BYTES = 16, SMALL_CLASSES = 257, CHUNK_MESSAGES = 64, REACH = 8 };

/* Of more than 4 KiB: the class of the next quarter of an octave, whose size *bytes
 * becomes. Quarters of an octave waste at most a quarter of a block, and 160 classes
 * reach as far as 2^52 bytes. */
static int large_class(int64_t *bytes)
{
    const int octave = 63 - __builtin_clzll((uint64_t)*bytes - 1); /* 2^octave <= bytes - 1 */
    /* 5 .. 8 */
    const int64_t quarter = (INT64_C(1) << octave) / 4, n = (*bytes + quarter - 1) / quarter;
    *bytes = n * quarter;
    return SMALL_CLASSES + (octave - 12) * 4 + (int)n - 5;
}

/* Small messages come 64 at a time from the arena of the run; a chunk is never given back
 * before the run ends. */
static struct message *refill(struct message_pool *p, int class)
{
    const size_t size = sizeof(struct message) + (size_t) class * CLASS_BYTES;
    char *chunk = arena_take(p->arena, size_product(size, CHUNK_MESSAGES));
    struct message *head = NULL;
    for (int k = CHUNK_MESSAGES - 1; k >= 0; k--) {
        struct message *m = (struct message *)(chunk + size * (size_t)k);
        m->next = head;
        head = m;
    }
    return head;
}

/* Large ones come one by one: a chunk of 64 of a megabyte would be a waste. */
static struct message *alone(struct message_pool *p, int64_t bytes)
{
    struct message *m = arena_take(p->arena, sizeof *m + (size_t)bytes);
    m->next = NULL;
    return m;
}

/* ---- several threads ---- */

/* Short lists of large messages: a list of 64 megabytes would be a waste. */
static inline int magazine_size(int class) { return class < SMALL_CLASSES ? CHUNK_MESSAGES : 4; }

struct message_depot {
    pthread_mutex_t lock;
    /* joined through the `next_magazine` of their first messages */
    struct message *magazine[MESSAGE_CLASSES];
};

/* A message that nobody uses has no sender: the place holds the next magazine. */
static inline struct message **next_magazine(struct message *m)
{
    return (struct message **)(void *)&m->from;
}

struct message_depot *message_depot_create(void)
{
    struct message_depot *d = calloc(1, sizeof *d);
    CHECK(d);
    CHECK(pthread_mutex_init(&d->lock, NULL) == 0);
    return d;
}

void message_depot_destroy(struct message_depot *d)
{
    if (d) pthread_mutex_destroy(&d->lock);
    free(d);
}

/* The list in use has as many messages as a magazine: it becomes the full one, and the one that was
 * full goes to the depot. Two lists, so that a thread that takes and gives in turns at the edge of
 * one does not go to the depot each time. */
static void put_aside(struct message_pool *p, int class)
{
    struct message *old = p->full[class];
    p->full[class] = p->free[class];
    p->free[class] = NULL;
    p->count[class] = 0;
    if (!old) return;
    struct message_depot *d = p->depot;
    pthread_mutex_lock(&d->lock);
    *next_magazine(old) = d->magazine[class];
    d->magazine[class] = old;
    pthread_mutex_unlock(&d->lock);
}

/* A whole magazine: the pool's own, or another thread's; NULL: there is none. */
static struct message *take_magazine(struct message_pool *p, int class)
{
    struct message_depot *d = p->depot;
    struct message *m = p->full[class];
    p->full[class] = NULL;
    if (m) return m;
    pthread_mutex_lock(&d->lock);
    m = d->magazine[class];
    if (m) d->magazine[class] = *next_magazine(m);
    pthread_mutex_unlock(&d->lock);
    return m;
}

/* ---- all ---- */

/* The list is empty. */
static struct message *supply(struct message_pool *p, int class, int64_t room)
{
    struct message *m = p->depot ? take_magazine(p, class) : NULL;
    p->count[class] = m || class < SMALL_CLASSES ? magazine_size(class) : 1;
    if (m) return m;
    return class < SMALL_CLASSES ? refill(p, class) : alone(p, room);
}

/* Programs send messages of one size in one part and of another in the next: those that the first
 * part has left serve the second. The class to take from, `class` if no other has any. */
static inline int serving_class(const struct message_pool *p, int class)
{
    if (class >= SMALL_CLASSES - REACH) return class;
    for (int c = class; c <= class + REACH; c++)
        if (p->free[c]) return c;
    return class;
}

struct message *message_take(struct message_pool *p, int64_t bytes)
{
    int64_t class = (bytes + CLASS_BYTES - 1) / CLASS_BYTES, room = bytes;
    struct message *m;
    if (class >= SMALL_CLASSES) class = large_class(&room);
    CHECK(class < MESSAGE_CLASSES);
    class = serving_class(p, (int)class);
    if (!p->free[class]) p->free[class] = supply(p, (int)class, room);
    m = p->free[class];
    p->free[class] = m->next;
    /* The next one to take: long unused ones are cold. */
    for (size_t line = 0; m->next && line < sizeof *m; line += 64)
        __builtin_prefetch((const char *)m->next + line, 1);
    if (p->depot) p->count[class]--;
    /* Only the head is cleared: the sender writes all of the data, or says that there are
     * none. */
    memset(m, 0, sizeof *m);
    /* The class says where it returns to, wherever it ends. */
    m->size_class = (uint16_t) class;
    m->bytes = bytes;
    return m;
}

void message_give(struct message_pool *p, struct message *m)
{
    const int class = m->size_class;
    m->next = p->free[class];
    p->free[class] = m;
    if (p->depot && ++p->count[class] == magazine_size(class)) put_aside(p, class);
}

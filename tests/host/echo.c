/* echo.c - see echo.h. */
#include "echo.h"

#include <stdlib.h>
#include <string.h>

enum { MOST = 64 };

/* A message that was sent, or a receive that waits for one. */
struct held {
    bool used;
    int tag;
    size_t bytes;
    char *data;
};
static struct {
    struct held message[MOST];
    int largest_tag, slow;
} world;

static bool lane_open(struct lane *l, int *largest_tag)
{
    *l = (struct lane){1};
    *largest_tag = world.largest_tag;
    return true;
}

static bool lane_close(struct lane *l)
{
    (void)l;
    for (int i = 0; i < MOST; i++) free(world.message[i].data);
    memset(world.message, 0, sizeof world.message);
    return true;
}

static bool send_begin(const struct lane *l, int to, int tag, const void *data, size_t bytes,
                       bool synchronous, struct hosts_request *r)
{
    (void)l, (void)synchronous;
    int i = 0;
    while (i < MOST && world.message[i].used) i++;
    if (to != 0 || tag > world.largest_tag || i == MOST) return false;
    world.message[i] = (struct held){true, tag, bytes, malloc(bytes + 1)};
    memcpy(world.message[i].data, data, bytes);
    *r = (struct hosts_request){{(uint64_t)world.slow, 0}};
    return true;
}

/* Receives are filled by wait: word 0 holds where they are kept, word 1 the tag. */
struct posted {
    void *data;
    size_t room;
};

static bool receive_begin(const struct lane *l, int from, int tag, void *data, size_t bytes,
                          struct hosts_request *r)
{
    (void)l, (void)from;
    struct posted *p = malloc(sizeof *p);
    *p = (struct posted){data, bytes};
    *r = (struct hosts_request){{(uint64_t)(uintptr_t)p, (uint64_t)tag + 1}};
    return true;
}

static bool lane_wait(struct hosts_request *r, size_t *bytes)
{
    if (bytes == NULL) return true;
    struct posted *p = (struct posted *)(uintptr_t)r->word[0];
    for (int i = 0; i < MOST; i++) {
        struct held *m = &world.message[i];
        if (!m->used || (uint64_t)m->tag + 1 != r->word[1]) continue;
        const bool fits = m->bytes <= p->room;
        if (fits) memcpy(p->data, m->data, m->bytes);
        *bytes = m->bytes;
        free(m->data);
        *m = (struct held){0};
        free(p);
        return fits;
    }
    free(p);
    return false;
}

static bool lane_test(struct hosts_request *r, bool *done)
{
    *done = r->word[0] == 0;
    if (!*done) r->word[0]--;
    return true;
}

static bool look(const struct lane *l, bool *there, struct hosts_message *m)
{
    (void)l;
    *there = false;
    for (int i = 0; i < MOST && !*there; i++) {
        *there = world.message[i].used;
        *m = (struct hosts_message){0, world.message[i].tag, world.message[i].bytes};
    }
    return true;
}

static bool receive(const struct lane *l, const struct hosts_message *m, void *data)
{
    (void)l;
    for (int i = 0; i < MOST; i++) {
        struct held *h = &world.message[i];
        if (!h->used || h->tag != m->tag) continue;
        memcpy(data, h->data, h->bytes);
        free(h->data);
        *h = (struct held){0};
        return true;
    }
    return false;
}

static bool barrier(const struct lane *l)
{
    (void)l;
    return true;
}

static bool reduce(enum hosts_reduction how, int64_t *value, int n)
{
    (void)how, (void)value, (void)n;
    return true;
}

static void abort_all(int status) { exit(status); }

struct hosts echo_hosts(int largest_tag)
{
    static const struct lane_calls lane = {lane_open,     lane_close, send_begin,
                                           receive_begin, lane_wait,  lane_test,
                                           look,          receive,    barrier};
    static const struct hosts_calls calls = {.table = HOSTS_TABLE,
                                             .library = "echo",
                                             .reduce = reduce,
                                             .abort = abort_all,
                                             .lane = &lane};
    world.largest_tag = largest_tag;
    world.slow = 0;
    return (struct hosts){0, 1, &calls};
}

int echo_under_way(void)
{
    int n = 0;
    for (int i = 0; i < MOST; i++) n += world.message[i].used;
    return n;
}

void echo_slow(int tests) { world.slow = tests; }

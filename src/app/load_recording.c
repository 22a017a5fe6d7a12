/* load_recording.c - the messages of a stored run as traffic (load_curve.h).
 *
 * A message is ready for the network when its sender's software is done with it, at the end of the
 * span of its send. What the program waited for is in these times already, as it was on the machine
 * of the run: the recording is an open load and does not slow down where the network does. */
#include <stdlib.h>
#include <string.h>

#include "app/load_curve.h"
#include "base/text.h"
#include "report/trace.h"

/* No name of a pattern has a colon, and no number in one. */
bool load_is_recording(const char *word) { return strchr(word, ':') != NULL; }

/* For qsort: by time, then sender, then the order of the spans. */
static int by_time(const void *a, const void *b)
{
    const struct span *x = *(const struct span *const *)a, *y = *(const struct span *const *)b;
    if (x->end_ps != y->end_ps) return x->end_ps < y->end_ps ? -1 : 1;
    if (x->rank != y->rank) return x->rank < y->rank ? -1 : 1;
    return x < y ? -1 : x > y;
}

/* The sends among the spans, as messages between ranks. */
static bool take_messages(const struct run_result *r, struct load_recording *x, struct arena *a,
                          const char *word, struct err *e)
{
    const struct span **send = TAKE(a, r->nspan + 1, const struct span *);
    int n = 0;
    for (int64_t i = 0; i < r->nspan && n < LOAD_MOST_MESSAGES; i++) {
        const struct span *p = &r->span[i];
        if (p->kind == SPAN_SEND && p->peer >= 0 && p->end_ps < r->makespan_ps) send[n++] = p;
    }
    if (n == 0) return err_set(e, ERR_DATA, "--traffic %.80s: the run sent no messages", word);
    /* repetitions follow each other, so the list is in the order of time */
    qsort(send, (size_t)n, sizeof *send, by_time);
    *x = (struct load_recording){.nmessage = n, .nrank = r->nrank, .period = r->makespan_ps};
    x->src = TAKE(a, n, int);
    x->dst = TAKE(a, n, int);
    x->bytes = TAKE(a, n, int64_t);
    x->time = TAKE(a, n, sim_ps);
    for (int m = 0; m < n; m++) {
        x->src[m] = send[m]->rank;
        x->dst[m] = send[m]->peer;
        x->bytes[m] = send[m]->bytes;
        x->time[m] = send[m]->end_ps;
    }
    return true;
}

/* The last colon: a path may have others. */
bool load_recording_read(const char *word, struct load_recording *x, struct arena *a, struct err *e)
{
    char *path = arena_text(a, word), *colon = strrchr(path, ':'), *end;
    *colon = '\0';
    const long long run = strtoll(colon + 1, &end, 10);
    if (colon == path || end == colon + 1 || *end != '\0' || run < 1)
        return err_set(
            e, ERR_USAGE,
            "--traffic: '%.80s'; expected a pattern, or DATABASE:RUN with the number of a "
            "run whose spans are stored",
            word);
    /* read only: a recording is not changed by being played */
    struct store *s = store_open(path, STORE_READ, e);
    if (!s) return false;
    struct run_result r = {.nrank = 0};
    bool ok = trace_read(s, run, a, &r, e) && take_messages(&r, x, a, word, e);
    store_close(s);
    return ok;
}

void load_recording_identify(const struct load_recording *x, struct text *out)
{
    /* the messages themselves: the database may be another one under the same name */
    text_add(out, "ranks = %d\nperiod = %lld\n", x->nrank, (long long)x->period);
    for (int m = 0; m < x->nmessage; m++)
        text_add(out, "%lld %d %d %lld\n", (long long)x->time[m], x->src[m], x->dst[m],
                 (long long)x->bytes[m]);
}

/* condition.c - see condition.h. */
#include "reality/condition.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "reality/predict.h"

/* --- the machine file ------------------------------------------------------------------------- */

/* Where a machine file keeps the time of which operation: behind the source of a price that it
 * stands for. Files stay as all others are, and whoever reads a price sees under which condition it
 * was measured. */
static const struct place {
    const char *key;
    enum host_operation operation;
    bool code;
} places[] = {{"node.flop_rate", HOST_MULTIPLY_ADD, false},
              {"node.sqrt", HOST_CHAIN, false},
              {"node.call", HOST_CALL, false},
              {"node.copy.bandwidth", HOST_COPY, false},
              {"network.link.bandwidth", HOST_MESSAGE, false},
              {"node.code.issue", HOST_MULTIPLY_ADD, true},
              {"node.code.chain", HOST_CHAIN, true}};
enum { PLACES = sizeof places / sizeof *places };
static const char mark[] = "; probe ";

static double *time_of(struct condition_reference *r, const struct place *p)
{
    struct host_speed *s = p->code ? &r->code : &r->rates;
    return &s->time[p->operation];
}

void condition_note(const struct condition_reference *r, const char *key, char *text, size_t size)
{
    struct condition_reference copy = *r;
    const size_t length = strlen(text);
    for (int i = 0; i < PLACES; i++) {
        const double time = *time_of(&copy, &places[i]);
        if (strcmp(places[i].key, key) == 0 && time > 0)
            snprintf(text + length, size - length, "%s%.4g ns", mark, time * 1e9);
    }
}

/* A file may be anybody's: what is no number is not known. */
bool condition_reference_of(const struct origin *o, int n, struct condition_reference *out)
{
    bool any = false;
    memset(out, 0, sizeof *out);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < PLACES; k++) {
            const char *note = strcmp(o[i].key, places[k].key) == 0 ? strstr(o[i].source, mark)
                                                                    : NULL;
            double ns;
            if (note == NULL || sscanf(note + strlen(mark), "%lf ns", &ns) != 1) continue;
            if (!(ns > 0) || !isfinite(ns)) continue;
            *time_of(out, &places[k]) = ns * 1e-9;
            any = true;
        }
    return any;
}

/* --- prices at another condition -------------------------------------------------------------- */

/* How many times as long an operation takes now; 1 where one of the two is not known. */
static double ratio(const struct host_speed *then, const struct host_speed *now,
                    enum host_operation o)
{
    return then->time[o] > 0 && now->time[o] > 0 ? now->time[o] / then->time[o] : 1;
}

/* What waits for an earlier result takes its latency, however much else the core has to do. */
static void apply_to_code(struct code_spec *c, double issue, double wait)
{
    *c = (struct code_spec){.issue = c->issue * issue,
                            .div = c->div * wait,
                            .root = c->root * wait,
                            .chain = c->chain * wait,
                            .step = c->step * wait,
                            .load = c->load * issue,
                            .whole = c->whole * issue,
                            .add = c->add * issue,
                            .multiply = c->multiply * issue,
                            .fetch = c->fetch * issue,
                            .add_latency = c->add_latency * wait,
                            .multiply_latency = c->multiply_latency * wait,
                            .window = c->window};
}

void condition_apply(struct machine_spec *m, const struct condition_reference *r,
                     const struct host_speed *now)
{
    static const enum host_operation stands_for[PRICES] = {
        [PRICE_FLOP] = HOST_MULTIPLY_ADD, [PRICE_DIV] = HOST_MULTIPLY_ADD,
        [PRICE_SQRT] = HOST_CHAIN,        [PRICE_TRIG] = HOST_MULTIPLY_ADD,
        [PRICE_CALL] = HOST_CALL,         [PRICE_COPY] = HOST_COPY,
        [PRICE_INSTRUCTION] = HOST_CHAIN, [PRICE_SEND] = HOST_MESSAGE,
        [PRICE_RECV] = HOST_MESSAGE,      [PRICE_LATENCY] = HOST_MESSAGE,
        [PRICE_BYTES] = HOST_COPY};
    for (int g = 0; g < PRICES; g++)
        if (g != PRICE_CODE)
            price_scale(m, (enum price_group)g, ratio(&r->rates, now, stands_for[g]));
    apply_to_code(&m->node.code, ratio(&r->code, now, HOST_MULTIPLY_ADD),
                  ratio(&r->code, now, HOST_CHAIN));
}

/* --- bursts ----------------------------------------------------------------------------------- */

/* Copies and messages vary from one look to the next where nothing else does. */
static bool is_steady(const struct real_burst *b)
{
    static const enum host_operation judged[] = {HOST_MULTIPLY_ADD, HOST_CALL, HOST_CHAIN};
    for (size_t i = 0; i < sizeof judged / sizeof *judged; i++) {
        const double x = b->before.time[judged[i]], y = b->after.time[judged[i]];
        if (!(x > 0) || !(y > 0) || fmax(x, y) > (1 + CONDITION_SAME) * fmin(x, y)) return false;
    }
    return true;
}

/* The undisturbed of samples first .. first + n - 1 into `time`: how many. */
static int clean_of(const struct real_result *r, int first, int n, double *time)
{
    int clean = 0;
    for (int i = first; i < first + n && i < r->nsample; i++)
        if (!r->sample[i].disturbed) time[clean++] = r->sample[i].seconds;
    return clean;
}

struct condition condition_of(const struct real_result *r)
{
    struct condition out = {0};
    double *time = memory_zeroed((size_t)r->nsample + 1, sizeof *time);
    for (int i = 0, first = 0; i < r->nburst && i < REAL_BURSTS; first += r->burst[i++].n) {
        const struct real_burst *b = &r->burst[i];
        const int clean = clean_of(r, first, b->n, time);
        if (clean < CONDITION_LEAST) continue;
        out.bursts++;
        if (!is_steady(b)) continue;
        struct condition_burst *c = &out.burst[out.steady++];
        c->seconds = real_times_of(time, clean).median;
        for (int o = 0; o < HOST_OPERATIONS; o++)
            c->speed.time[o] = (b->before.time[o] + b->after.time[o]) / 2;
    }
    free(time);
    return out;
}

bool condition_changed(const struct condition *c) { return 2 * c->steady < c->bursts; }

int condition_middle(const double *error, int n)
{
    for (int i = 0; i < n; i++) {
        int below = 0, same = 0;
        for (int k = 0; k < n; k++) {
            below += error[k] < error[i];
            same += error[k] == error[i];
        }
        if (below <= (n - 1) / 2 && (n - 1) / 2 < below + same) return i;
    }
    return 0;
}

/* netdata.c - see netdata.h. */
#include "netdata.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/check.h"
#include "base/text.h"

struct reader {
    const char *s;
    struct arena *a;
};

static void pass_blank(struct reader *r)
{
    while (*r->s && strchr(" \t\r\n,:", *r->s)) r->s++;
}

static char *read_text(struct reader *r)
{
    const char *end = ++r->s;
    while (*end && *end != '"') end += *end == '\\' ? 2 : 1;
    char *copy = TAKE(r->a, end - r->s + 1, char);
    memcpy(copy, r->s, (size_t)(end - r->s));
    r->s = end + 1;
    return copy;
}

static struct json_value read_value(struct reader *r);

static void read_items(struct reader *r, struct json_value *v, char close)
{
    int room = 0;
    struct json_value *item = NULL;
    for (r->s++, pass_blank(r); *r->s != close; pass_blank(r)) {
        CHECK(*r->s);
        if (v->count == room) {
            room = room ? 2 * room : 8;
            item = realloc(item, (size_t)room * sizeof *item);
            CHECK(item);
        }
        const char *key = NULL;
        if (close == '}') {
            key = read_text(r);
            pass_blank(r);
        }
        item[v->count] = read_value(r);
        item[v->count++].key = key;
    }
    r->s++;
    v->item = TAKE(r->a, v->count > 0 ? v->count : 1, struct json_value);
    if (v->count) memcpy(v->item, item, (size_t)v->count * sizeof *item);
    free(item);
}

static struct json_value read_value(struct reader *r)
{
    struct json_value v = {.kind = JSON_NULL};
    pass_blank(r);
    char c = *r->s, *end;
    if (c == '{' || c == '[') {
        v.kind = c == '{' ? JSON_OBJECT : JSON_LIST;
        read_items(r, &v, c == '{' ? '}' : ']');
    } else if (c == '"') {
        v.kind = JSON_TEXT;
        v.text = read_text(r);
    } else if (c == 't' || c == 'f' || c == 'n') {
        v.kind = c == 'n' ? JSON_NULL : JSON_BOOL;
        v.number = c == 't';
        r->s += c == 'f' ? 5 : 4;
    } else {
        v.kind = JSON_NUMBER;
        v.number = strtod(r->s, &end);
        CHECK(end != r->s);
        r->s = end;
    }
    return v;
}

const struct json_value *json_load(struct arena *a, const char *name)
{
    struct text t = {0};
    struct err e = {0};
    char path[1024];
    snprintf(path, sizeof path, "%s/tests/data/net/%s", MIMDSIM_SRCDIR, name);
    if (!text_read_file(&t, path, &e)) fail_msg("%s", e.text);
    struct reader r = {t.s, a};
    struct json_value *v = TAKE(a, 1, struct json_value);
    *v = read_value(&r);
    text_free(&t);
    return v;
}

const struct json_value *json_get(const struct json_value *v, const char *key)
{
    for (int i = 0; i < v->count; i++)
        if (strcmp(v->item[i].key, key) == 0) return &v->item[i];
    return NULL;
}

int64_t json_int_of(const struct json_value *v, const char *key)
{
    const struct json_value *x = json_get(v, key);
    if (!x) fail_msg("no member '%s'", key);
    return (int64_t)x->number;
}

const char *json_str_of(const struct json_value *v, const char *key)
{
    const struct json_value *x = json_get(v, key);
    if (!x) fail_msg("no member '%s'", key);
    return x->text;
}

static void topology_read(struct topology_spec *s, const char *name)
{
    *s = (struct topology_spec){.nodes_per_router = 1, .processors_per_node = 1};
    size_t letters = strcspn(name, "0123456789");
    s->family = name[0] == 'h' ? TOPOLOGY_HYPERCUBE : name[0] == 'm' ? TOPOLOGY_MESH : TOPOLOGY_TORUS;
    for (const char *p = name + letters; *p && s->ndim < MACHINE_MAX_DIMS; p += *p == 'x')
        s->dims[s->ndim++] = (int)strtol(p, (char **)&p, 10);
    if (strncmp(name, "mesh1x", 6) == 0) { /* a line */
        s->dims[0] = s->dims[1];
        s->ndim = 1;
    }
}

void netcase_machine(struct netcase *c, struct arena *a, const char *topology, int channels, int buffer, int tie,
                     enum network_level level)
{
    struct machine_spec *m = &c->machine;
    struct err e = {0};
    *m = (struct machine_spec){.name = "reference"};
    topology_read(&m->topology, topology);
    m->topology.tie = tie == 2 ? TIE_PARITY : TIE_POSITIVE;
    m->network = (struct network_spec){.level = level,
                                       .link_bandwidth = 16e9,
                                       .hop_latency = 3e-9,
                                       .end_latency = 2e-9,
                                       .credit_latency = 2e-9,
                                       .flit_bytes = NETCASE_FLIT_BYTES,
                                       .virtual_channels = channels,
                                       .buffer_flits = buffer};
    m->software.eager_bytes = -1;
    c->topology = topology_create(&m->topology, a, &e);
    if (!c->topology) fail_msg("%s", e.text);
}

static void traffic_take(struct traffic *q, struct arena *a, int n)
{
    *q = (struct traffic){.nmessage = n};
    q->src = TAKE(a, n, int);
    q->dst = TAKE(a, n, int);
    q->bytes = TAKE(a, n, int64_t);
    q->time = TAKE(a, n, sim_ps);
    q->delay = TAKE(a, n, sim_ps);
}

static void read_hand(struct traffic *q, struct arena *a, const struct json_value *list)
{
    traffic_take(q, a, list->count);
    for (int i = 0; i < list->count; i++) {
        const struct json_value *m = &list->item[i];
        q->src[i] = (int)json_int_of(m, "src");
        q->dst[i] = (int)json_int_of(m, "dst");
        q->bytes[i] = json_int_of(m, "flits") * NETCASE_FLIT_BYTES;
        q->time[i] = json_int_of(m, "t") * NETCASE_CYCLE;
    }
}

static void read_trace(struct traffic *q, struct arena *a, const struct json_value *trace)
{
    int n = json_get(trace, "src")->count, ndep = 0;
    const struct json_value *deps = json_get(trace, "deps");
    traffic_take(q, a, n);
    for (int i = 0; i < n; i++) ndep += deps->item[i].count;
    q->dep_first = TAKE(a, n + 1, int);
    q->dep = TAKE(a, ndep + 1, int);
    for (int i = 0; i < n; i++) {
        q->src[i] = (int)json_get(trace, "src")->item[i].number;
        q->dst[i] = (int)json_get(trace, "dst")->item[i].number;
        q->bytes[i] = (int64_t)json_get(trace, "flits")->item[i].number * NETCASE_FLIT_BYTES;
        q->time[i] = (sim_ps)json_get(trace, "time")->item[i].number * NETCASE_CYCLE;
        q->delay[i] = (sim_ps)json_get(trace, "delay")->item[i].number * NETCASE_CYCLE;
        q->dep_first[i + 1] = q->dep_first[i];
        for (int k = 0; k < deps->item[i].count; k++)
            q->dep[q->dep_first[i + 1]++] = (int)deps->item[i].item[k].number;
    }
}

/* every node sends one message to (i + d) mod n or to i xor d */
static void read_step(struct traffic *q, struct arena *a, const struct json_value *v, int nnode)
{
    int d = (int)json_int_of(v, "distance");
    bool xor = strcmp(json_str_of(v, "pattern"), "xor") == 0;
    traffic_take(q, a, nnode);
    for (int i = 0; i < nnode; i++) {
        q->src[i] = i;
        q->dst[i] = xor ? i ^ d : (i + d) % nnode;
        q->bytes[i] = json_int_of(v, "flits") * NETCASE_FLIT_BYTES;
    }
}

void netcase_read(struct netcase *c, struct arena *a, const struct json_value *v, enum network_level level)
{
    const struct json_value *buffer = json_get(v, "buf_flits_per_vc"), *tie = json_get(v, "tie");
    const struct json_value *most = json_get(v, "max_packet_flits"), *trace = json_get(v, "trace");
    netcase_machine(c, a, json_str_of(v, "topology"), (int)json_int_of(v, "vcs"), buffer ? (int)buffer->number : 64,
                    tie ? (int)tie->number : 0, level);
    if (most && most->kind == JSON_NUMBER) c->machine.network.packet_bytes = (int64_t)most->number * NETCASE_FLIT_BYTES;
    const struct json_value *hand = json_get(v, "messages");
    if (trace)
        read_trace(&c->traffic, a, trace);
    else if (hand && hand->kind == JSON_LIST)
        read_hand(&c->traffic, a, hand);
    else
        read_step(&c->traffic, a, v, c->topology->nnode);
    c->completion = json_get(v, "completion");
}

int64_t netcase_run(const struct netcase *c, int64_t *out, struct traffic_result *r)
{
    struct traffic_result own = {0};
    struct err e = {0};
    struct arena *a = arena_create();
    sim_ps *arrival = TAKE(a, c->traffic.nmessage, sim_ps);
    if (!r) r = &own;
    r->arrival = arrival;
    if (!traffic_run(&c->traffic, &c->machine, c->topology, a, false, r, &e)) fail_msg("%s", e.text);
    for (int i = 0; out && i < c->traffic.nmessage; i++)
        out[i] = arrival[i] == SIM_NEVER ? -1 : arrival[i] / NETCASE_CYCLE;
    arena_destroy(a);
    r->arrival = NULL;
    return r->makespan / NETCASE_CYCLE;
}

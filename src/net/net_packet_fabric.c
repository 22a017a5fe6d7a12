/* net_packet_fabric.c - the state of cut-through levels: checks of the machine, pools, messages on
 * their routes.
 *
 * Records come from chunks of the arena and go back to lists, so that a steady load allocates
 * nothing. */
#include "net/net_packet.h"

enum { CHUNK = 128, FLIGHT_STEP = 4 };

/* The keys that levels with buffers need and others do not: refused with key, value and range. */
static bool packet_config(const struct net *n, struct err *e)
{
    const struct network_spec *w = &n->machine->network;
    if (w->flit_bytes < 1)
        return err_set(e, ERR_CONFIG, "network.level: %s needs network.flit of at least 1 B",
                       n->type->name);
    if (n->link.flit < 1 || n->port[0].rate.flit < 1 || n->ejection.flit < 1)
        return err_set(e, ERR_CONFIG, "network.level: %s needs a finite network.link.bandwidth",
                       n->type->name);
    if (w->virtual_channels < 1 || w->virtual_channels > 1024)
        return err_set(e, ERR_CONFIG, "network.virtual_channels is %d; level %s needs 1 to 1024",
                       w->virtual_channels, n->type->name);
    if (w->buffer_flits < 1)
        return err_set(e, ERR_CONFIG, "network.buffer is %d; level %s needs at least 1",
                       w->buffer_flits, n->type->name);
    if (n->topology->max_hops > INT16_MAX - 2)
        return err_set(e, ERR_CONFIG, "routes of up to %d links; level %s can follow %d",
                       n->topology->max_hops, n->type->name, INT16_MAX - 2);
    return true;
}

/* Flit time of the fastest resource: the shortest time in which a flit can follow another. */
static sim_ps fastest_flit(const struct net *n)
{
    sim_ps best = n->ejection.flit;
    for (int i = 0; i < n->nport; i++)
        if (n->port[i].rate.flit < best) best = n->port[i].rate.flit;
    if (!n->link_rate) return best < n->link.flit ? best : n->link.flit;
    for (int l = 0; l < n->nlink; l++)
        if (n->link_rate[l].flit < best) best = n->link_rate[l].flit;
    return best;
}

/* The credit round trip, in flits, is what a buffer must hold for a packet to follow another
 * without a gap. Smaller buffers stall packets in mid-link, and the exact interval arithmetic of
 * the levels packet and auto ends; level flit has no such limit. */
static bool cut_through_config(const struct net *n, struct err *e)
{
    const struct network_spec *w = &n->machine->network;
    /* A flit arrives after tau, its credit comes back a credit latency after it has left. */
    sim_ps flit = fastest_flit(n), trip = n->tau + (n->credit > flit ? n->credit : flit);
    int64_t least = (trip + flit - 1) / flit;
    if (w->buffer_flits < least)
        return err_set(e, ERR_CONFIG,
                       "network.buffer is %d; level %s needs at least %lld (hop_latency + "
                       "credit_latency = %lld ps in flits of %lld ps)",
                       w->buffer_flits, n->type->name, (long long)least, (long long)trip,
                       (long long)flit);
    /* Without packets a message is cut to a buffer's size (flight_cut). */
    if (w->packet_bytes <= 0) return true;
    int64_t flits = net_flits(n, w->packet_bytes);
    if (flits > w->buffer_flits)
        return err_set(e, ERR_CONFIG,
                       "network.packet %lld with network.header %lld makes packets of "
                       "%lld flits, but network.buffer is %d; level %s needs whole packets "
                       "to fit: buffer >= %lld or packet <= %lld",
                       (long long)w->packet_bytes, (long long)w->header_bytes, (long long)flits,
                       w->buffer_flits, n->type->name, (long long)flits,
                       (long long)(w->buffer_flits * w->flit_bytes - w->header_bytes));
    return true;
}

struct fabric *fabric_create(struct net *n, size_t size, sim_action *look, struct err *e)
{
    if (!packet_config(n, e)) return NULL;
    const struct network_spec *w = &n->machine->network;
    struct fabric *f = arena_take(n->arena, size);
    f->net = n;
    f->look = look;
    n->message_bytes = sizeof(struct flight);
    n->hop_bytes = sizeof(struct pass);
    f->nprocessor = n->topology->spec->processors_per_node;
    f->nchannel = w->virtual_channels;
    /* Too few channels for the topology's deadlock classes: one class, and deadlock becomes
     * possible, as in the real machine. */
    f->nclass = f->nchannel < n->topology->nclass ? 1 : n->topology->nclass;
    /* Channels of one class; those left over by the division stay idle on links. */
    f->nlane = f->nchannel / f->nclass;
    f->buffer = w->buffer_flits;
    f->late = f->cut_bytes = -1;
    f->fastest = fastest_flit(n);
    f->first_come = w->arbitration == ARBITRATION_FIRST_COME;
    f->resource = TAKE(n->arena, n->nresource, struct resource);
    f->source = TAKE(n->arena, n->nnode, struct source);
    f->way = TAKE(n->arena, n->topology->max_hops + 2, struct hop);
    f->own_port = TAKE(n->arena, size_product(n->nnode, f->nprocessor), sim_ps);
    f->free_flight = TAKE(n->arena, (n->topology->max_hops + 2) / FLIGHT_STEP + 1, struct flight *);
    return f;
}

struct fabric *packet_fabric(struct net *n, size_t size, sim_action *look, struct err *e)
{
    struct fabric *f = fabric_create(n, size, look, e);
    if (!f || !cut_through_config(n, e)) return NULL;
    f->cuts = true;
    return f;
}

struct packet *packet_take(struct fabric *f)
{
    if (!f->free_packet) {
        struct packet *chunk = TAKE(f->net->arena, CHUNK, struct packet);
        for (int i = 0; i < CHUNK; i++) packet_return(f, &chunk[i]);
    }
    struct packet *p = f->free_packet;
    f->free_packet = p->next;
    return p;
}

void packet_return(struct fabric *f, struct packet *p)
{
    p->next = f->free_packet;
    f->free_packet = p;
}

struct credit *credit_take(struct fabric *f)
{
    if (!f->free_credit) {
        struct credit *chunk = TAKE(f->net->arena, CHUNK, struct credit);
        for (int i = 0; i < CHUNK; i++) credit_return(f, &chunk[i]);
    }
    struct credit *c = f->free_credit;
    f->free_credit = c->next;
    return c;
}

void credit_return(struct fabric *f, struct credit *c)
{
    c->next = f->free_credit;
    f->free_credit = c;
}

/* FIFOs of a resource are made at its first use: idle parts of a large machine have none. */
struct fifo *fifo_of(struct fabric *f, struct resource *r, int channel)
{
    if (!r->fifo) {
        if (f->nfree_fifo < f->nchannel) {
            int n = f->nchannel > CHUNK ? f->nchannel : CHUNK;
            f->free_fifo = TAKE(f->net->arena, n, struct fifo);
            f->nfree_fifo = n;
        }
        r->fifo = f->free_fifo;
        f->free_fifo += f->nchannel;
        f->nfree_fifo -= f->nchannel;
    }
    return &r->fifo[channel];
}

/* Flights vary in length with their routes: pools by length, rounded up to FLIGHT_STEP hops, so
 * that a record is used again for any route of its class. */
static struct flight *flight_alloc(struct fabric *f, int nhop)
{
    int kind = nhop / FLIGHT_STEP;
    struct flight *w = f->free_flight[kind];
    if (!w) {
        size_t npass = (size_t)(kind + 1) * FLIGHT_STEP,
               size = sizeof *w + npass * sizeof(struct pass);
        /* Whole cache lines; chunks of about 32 KiB. */
        size = (size + 63) / 64 * 64;
        size_t count = size > 16384 ? 1 : 32768 / size;
        char *chunk = arena_take(f->net->arena, size_product(count, size));
        for (size_t i = 0; i < count; i++) {
            w = (struct flight *)(void *)(chunk + i * size);
            w->next = f->free_flight[kind];
            f->free_flight[kind] = w;
        }
    }
    f->free_flight[kind] = w->next;
    return w;
}

void flight_return(struct fabric *f, struct flight *w)
{
    int kind = w->nhop / FLIGHT_STEP;
    w->next = f->free_flight[kind];
    f->free_flight[kind] = w;
}

/* Cut the message into packets; one that is larger than a buffer travels in pieces of a buffer's
 * size, without headers of their own. */
static void flight_cut(struct fabric *f, struct flight *w)
{
    const struct net *n = f->net;
    /* Mostly as long as the one before: divisions of 64 bits take longer than to remember. */
    if (w->m->bytes == f->cut_bytes) {
        w->npacket = f->cut_packets;
        w->full = f->cut_full;
        w->last = f->cut_last;
        return;
    }
    int64_t bytes = w->m->bytes, packets = net_packets(n, bytes);
    int64_t last = net_packet_flits(n, bytes, packets - 1),
            full = packets > 1 ? net_packet_flits(n, bytes, 0) : last;
    if (f->cuts && packets == 1 && last > f->buffer) {
        packets = (last + f->buffer - 1) / f->buffer;
        full = f->buffer;
        last -= (packets - 1) * full;
    }
    CHECK(packets <= INT32_MAX);
    w->npacket = f->cut_packets = (int)packets;
    w->full = f->cut_full = (int32_t)full;
    w->last = f->cut_last = (int32_t)last;
    f->cut_bytes = bytes;
}

/* A link offers the channels of the message's deadlock class; ports offer all of them. No flit
 * takes more than `longest`. */
static void pass_init(struct fabric *f, struct flight *w, int h, const struct hop *way,
                      sim_ps longest)
{
    struct pass *s = &w->pass[h];
    int class = way->vc_class < f->nclass ? way->vc_class : f->nclass - 1;
    *s = (struct pass){.flight = w, .hop = (int16_t)h, .resource = way->link, .port = way->port};
    bool link = h > 0 && h < w->nhop;
    s->channel = (int16_t)(link ? class * f->nlane : 0);
    s->nchannel = (int16_t)(link ? f->nlane : f->nchannel);
    const sim_ps flit = net_resource_rate(f->net, way->link, w->m->bytes).flit;
    s->flit = flit < longest ? flit : longest;
}

/* Flits so slow that the message outlasts simulated time: as slow as that takes, so that no sum of
 * times wraps. */
static sim_ps flight_longest(struct flight *w)
{
    const sim_ps longest = PS_TOO_LONG / ((int64_t)(w->npacket - 1) * w->full + w->last);
    if (w->slowest > longest) w->slowest = longest;
    return longest;
}

struct flight *flight_plain(struct fabric *f, struct net_message *m, struct net_rate slowest)
{
    struct flight *w = flight_alloc(f, 0);
    *w = (struct flight){.m = m, .slowest = slowest.flit, .arrival = SIM_NEVER, .foreseen = -1};
    flight_cut(f, w);
    flight_longest(w);
    f->nflight++;
    return w;
}

/* The route is found once, when the message is handed over; random routes by its id. */
struct flight *flight_take(struct fabric *f, struct net_message *m)
{
    struct hop *way = f->way;
    struct net_rate slowest;
    int nhop = net_route(f->net, m, way, &slowest);
    struct flight *w = flight_alloc(f, nhop);
    *w = (struct flight){
        .m = m, .nhop = nhop, .slowest = slowest.flit, .arrival = SIM_NEVER, .foreseen = -1};
    flight_cut(f, w);
    const sim_ps longest = flight_longest(w);
    for (int h = 0; h <= nhop; h++) pass_init(f, w, h, &way[h], longest);
    f->nflight++;
    return w;
}

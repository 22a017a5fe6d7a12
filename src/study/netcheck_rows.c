/* netcheck_rows.c - what the readers of all forms share: rows, settings, networks,
 * contradictions. */
#include "study/netcheck_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "study/netcheck_case.h"

enum { MOST_CHANNELS = 256, MOST_BUFFER = 1 << 20 };

/* ---- rows ---- */

/* A row of the table. It doubles when full; rows move then, so a pointer to one holds until the
 * next is added. */
static struct netcheck_row *row_add(struct netcheck_reader *r, const struct node *c,
                                    enum netcheck_form form)
{
    struct netcheck *n = r->n;
    if (n->nrow == r->capacity) {
        int capacity = 2 * r->capacity + 64;
        struct netcheck_row *row = TAKE(r->rows, capacity, struct netcheck_row);
        if (n->nrow > 0) memcpy(row, n->row, (size_t)n->nrow * sizeof *row);
        n->row = row;
        r->capacity = capacity;
    }
    struct netcheck_row *row = &n->row[n->nrow++];
    *row = (struct netcheck_row){.counted = true, .line = c->line, .form = form};
    return row;
}

/* The question is filled bit by bit while the case is read; the row exists from the start, so
 * that a case that cannot be answered has one, too. */
struct netcheck_question netcheck_begin(struct netcheck_reader *r, const struct node *c,
                                        enum netcheck_form form)
{
    struct netcheck_row *row = row_add(r, c, form);
    return (struct netcheck_question){.n = r->n, .row = row, .arena = r->arena, .rows = r->rows};
}

bool netcheck_wanted(const struct netcheck_reader *r, const struct netcheck_question *k)
{
    if (!r->filter || strstr(k->row->name, r->filter)) return true;
    /* The row is the last one: taking it back is forgetting it. */
    r->n->nrow--;
    return false;
}

void netcheck_flaw(struct netcheck_row *row, const char *what, double found, double expected)
{
    /* A thousandth is equality: files have rounded numbers. Only the first contradiction is
     * told. */
    if (row->flaw[0] || fabs(found - expected) <= 1e-3 * fmax(1, fabs(expected))) return;
    snprintf(row->flaw, sizeof row->flaw, "%s is %.10g; the case makes it %.10g", what, found,
             expected);
}

const struct node *netcheck_given(struct netcheck_row *row, const struct node *c, const char *key)
{
    const struct node *x = document_find(c, key);
    /* A number that is null was not measured. */
    if (!x || x->kind == NODE_NUMBER || x->kind == NODE_NULL)
        return x && x->kind == NODE_NUMBER ? x : NULL;
    if (!row->flaw[0]) snprintf(row->flaw, sizeof row->flaw, "%s is no number", key);
    return NULL;
}

/* A key that is missing contradicts nothing. */
void netcheck_flaw_of_key(struct netcheck_row *row, const struct node *c, const char *key,
                          double expected)
{
    const struct node *x = netcheck_given(row, c, key);
    if (x) netcheck_flaw(row, key, x->number, expected);
}

/* ---- the network ---- */

/* The settings of a case, with this program's defaults where it does not say them: as many
 * channels as the routes need, buffers of 16 flits. */
bool netcheck_setting_read(struct netcheck_reader *r, const struct node *c,
                           struct netcheck_setting *s)
{
    return netcheck_word(r, c, "topology", &s->topology) &&
           netcheck_integer(r, c, "vcs", 1, MOST_CHANNELS, 0, &s->channels) &&
           netcheck_integer(r, c, "buf_flits_per_vc", 1, MOST_BUFFER, 16, &s->buffer) &&
           netcheck_integer(r, c, "tie", 0, 2, -1, &s->tie) &&
           netcheck_integer(r, c, "max_packet_flits", 1, NETCHECK_MOST_FLITS, 0, &s->packet_flits);
}

/* By the name of its pipeline. */
int netcheck_head_cycles(struct netcheck_reader *r, const struct node *c)
{
    const char *pipeline;
    if (!netcheck_word(r, c, "pipeline", &pipeline)) return 0;
    if (!*pipeline || strcmp(pipeline, "P3") == 0) return 3;
    if (strcmp(pipeline, "P4") == 0) return 4;
    if (strcmp(pipeline, "P5") == 0) return 5;
    err_set_at(r->e, ERR_DATA, r->path, c->line, "unknown pipeline '%.64s'; expected P3, P4 or P5",
               pipeline);
    return 0;
}

/* Whether the routes are the same as here: routes that depend on the load, or on chance in
 * another way, are told by the routing's name. The reference's own dimension order on a torus
 * breaks ties by chance. */
static bool routing_is_ours(struct netcheck_reader *r, const struct node *c, const char *topology,
                            int *tie, struct err *why)
{
    static const char *const ours[] = {"", "min", "nca", "dim_order"};
    const char *routing, *other;
    if (!netcheck_word(r, c, "routing_function", &routing) ||
        !netcheck_word(r, c, "routing", &other))
        return false;
    if (!*routing) routing = other;
    for (size_t i = 0; i < sizeof ours / sizeof *ours; i++) {
        if (strcmp(routing, ours[i]) != 0) continue;
        if (*tie < 0 && strcmp(routing, "dim_order") == 0) *tie = 1;
        return true;
    }
    return err_set(why, ERR_UNAVAILABLE, "routing '%.64s' on '%.64s' is not supported", routing,
                   topology);
}

/* Machine and topology of a case. Two kinds of failure: what this program does not have is a row
 * without answers, what makes no sense is an error of the file. */
bool netcheck_network(struct netcheck_reader *r, const struct node *c,
                      const struct netcheck_setting *s, struct netcheck_question *k)
{
    struct err why;
    struct topology_spec *t = TAKE(r->arena, 1, struct topology_spec);
    struct netcheck_row *row = k->row;
    int head = netcheck_head_cycles(r, c), nodes, channels = s->channels, tie = s->tie;
    err_clear(&why);
    if (head == 0) return false;
    /* The group in which the row is counted: family, channels, buffers and pipeline. */
    snprintf(row->group, sizeof row->group, "%.*s vc=%d B=%d%s",
             (int)strcspn(s->topology, "0123456789_"), s->topology, channels, s->buffer,
             head == 3   ? ""
             : head == 4 ? " P4"
                         : " P5");
    if (routing_is_ours(r, c, s->topology, &tie, &why) &&
        netcheck_topology(s->topology, tie, t, &why))
        k->topology = topology_create(t, r->arena, &why);
    if (why.kind == ERR_UNAVAILABLE) netcheck_unanswered(row, why.text);
    else if (why.kind != ERR_NONE) err_set_at(r->e, ERR_DATA, r->path, c->line, "%s", why.text);
    if (!k->topology) return false;
    row->family = t->family;
    /* nclass: the channels that the routes need to be free of deadlock. */
    row->channels = channels = channels > 0 ? channels : k->topology->nclass;
    k->machine = netcheck_machine(t, channels, s->buffer, s->packet_flits, head);
    /* The case may say how many nodes it has; then it must be right. */
    if (!netcheck_integer(r, c, "nodes", 1, NETCHECK_MOST_NODES, k->topology->nnode, &nodes))
        return false;
    if (nodes == k->topology->nnode) return true;
    return err_set_at(r->e, ERR_DATA, r->path, document_find(c, "nodes")->line,
                      "'nodes' is %d; '%s' has %d", nodes, s->topology, k->topology->nnode);
}

bool netcheck_told(const struct netcheck_reader *r) { return r->e->kind == ERR_NONE; }

/* ---- what the reference says of itself ---- */

/* Each arrival against an empty network, in which no message is slower; the last one is the
 * makespan. Without an order of arrivals, a single one cannot be judged. */
void netcheck_check_arrivals(struct netcheck_question *k, double makespan)
{
    double last = 0;
    for (int m = 0; m < k->q.nmessage; m++) {
        double least = netcheck_empty(k, m);
        last = fmax(last, k->arrival[m]);
        if (k->arrival[m] < least - 1e-3 && !k->row->flaw[0] && !k->any_order)
            snprintf(k->row->flaw, sizeof k->row->flaw,
                     "message %d arrives at %.10g; an empty network takes until %.10g", m,
                     k->arrival[m], least);
    }
    netcheck_flaw(k->row, "makespan", makespan, last);
}

/* network_remarks.c - see network_remarks.h.
 *
 * The words on levels follow docs/network.md; the times of collectives are the functions of the
 * simulation itself. */
#include "study/network_remarks.h"

#include <math.h>
#include <string.h>

#include "base/text.h"
#include "base/units.h"
#include "kernel/micro_collective.h"
#include "machine/placement.h"
#include "measure/column.h"
#include "spec/collective_spec.h"
#include "spec/kernel_spec.h"
#include "vp/meeting.h"

/* What a level makes of a rule by load or chance, and what it leaves out of it. */
static const struct at_level {
    const char *decides, *leaves_out;
} at_level[LEVELS] = {
    [LEVEL_LOGGP] = {"a message takes the way that it would take through an empty network",
                     "all load: nobody waits for a link, so there is no queue to avoid"},
    [LEVEL_LINK] =
        {"where the head comes to a router, by the time for which links are reserved",
         "buffers, channels and credits: a queue holds up nobody behind it, and no packet "
         "needs an escape"},
    [LEVEL_PACKET] = {"in the router whose buffer the head is at the front of, by credits",
                      "flits of several packets by turns on one link: it carries whole packets"},
    [LEVEL_AUTO] = {"as packet: with a rule the two are the same", "what packet leaves out"},
    [LEVEL_FLIT] = {"in the router whose buffer the head is at the front of, by credits",
                    "nothing that the rule looks at"},
};

/* The one route at all levels: what each makes of messages that meet on it. */
static const char *const one_route[LEVELS] = {
    [LEVEL_LOGGP] = "messages that meet on a link do not wait for each other",
    [LEVEL_LINK] = "buffers have no end: a message that waits holds up nobody behind it",
    [LEVEL_PACKET] = "a link carries whole packets, not flits of several by turns",
    [LEVEL_AUTO] = "a link carries whole packets, not flits of several by turns",
    [LEVEL_FLIT] = "nothing",
};

/* A crossbar and a bus have no links, so that there is nothing to route. */
static bool has_links(const struct run_spec *r)
{
    return !topology_has(r->machine.topology.family, TOPOLOGY_NO_LINKS);
}

/* Whether two runs are told in one line. */
static bool alike(const struct run_spec *a, const struct run_spec *b)
{
    return a->machine.network.routing == b->machine.network.routing &&
           a->machine.network.level == b->machine.network.level && has_links(a) == has_links(b);
}

/* How many runs are as run i; 0 when an earlier one is, or there are no links. Runs that are alike
 * may stand anywhere in the plan. */
static int runs_as(const struct plan *p, int i)
{
    int n = 0;
    if (!has_links(&p->run[i])) return 0;
    for (int k = 0; k < p->nrun; k++) {
        if (!alike(&p->run[i], &p->run[k])) continue;
        if (k < i) return 0;
        n++;
    }
    return n;
}

/* What is said of a rule at a level: its words, what it does, where it decides at this level, what
 * the level does not know, and how many runs have both. */
struct rule_remark {
    const char *rule, *level, *what, *decides, *leaves_out;
    int runs;
};

#define RULE(member) COLUMN_STRING, .offset = offsetof(struct rule_remark, member)

static const struct column rule_column[] = {
    {"at_the_level", RULE(decides), .doc = "where it decides there"},
    {"left_out", RULE(leaves_out), .doc = "what the level does not know"},
    {"level", RULE(level), .doc = "of the network"},
    {"rule", RULE(rule), .doc = "network.routing"},
    {"runs", COLUMN_INT, .offset = offsetof(struct rule_remark, runs), .doc = "that have both"},
    {"what", RULE(what), .doc = "what it does"},
};
static const struct column_table rule_columns = COLUMNS(rule_column);

/* Levels by their own words; one that is settled later says nothing yet. */
static struct rule_remark remark_rule(const struct network_spec *n, int runs)
{
    /* auto-tolerance is no level yet: `run` measures which one will do. */
    const bool open = n->level == LEVEL_AUTO_TOLERANCE;
    const bool rule = n->routing != ROUTING_DETERMINISTIC;
    struct rule_remark x = {.rule = routing_rule_name(n->routing),
                            .level = network_level_name(n->level),
                            .what = routing_rule_doc(n->routing),
                            .decides = "known when the level is",
                            .leaves_out = "known when the level is",
                            .runs = runs};
    if (open) return x;
    x.decides = rule ? at_level[n->level].decides : "the same route at every level";
    x.leaves_out = rule ? at_level[n->level].leaves_out : one_route[n->level];
    return x;
}

/* The same as one line. */
static void print_rule(const struct rule_remark *x, int all, FILE *out)
{
    fprintf(out, "routing %s, level %s", x->rule, x->level);
    /* Of a plan whose runs are all alike the number says nothing. */
    if (x->runs < all) fprintf(out, " (%d of %d runs)", x->runs, all);
    fprintf(out, ": %s; %s; left out: %s\n", x->what, x->decides, x->leaves_out);
}

/* Levels that no run of the plan has, once, where a choice would be another there. */
static void print_other_levels(const struct plan *p, FILE *out)
{
    bool used[LEVELS] = {false}, rule = false;
    enum network_level order[LEVELS];
    for (int i = 0; i < p->nrun; i++) {
        const struct network_spec *n = &p->run[i].machine.network;
        rule = rule || (has_links(&p->run[i]) && n->routing != ROUTING_DETERMINISTIC);
        if (n->level != LEVEL_AUTO_TOLERANCE) used[n->level] = true;
    }
    /* The finest first: it leaves out least. Levels that were used have lines of their own above,
     * and the one route needs no such list: its lines say all there is. */
    network_levels_by_fineness(order);
    for (int k = 0; rule && k < LEVELS; k++)
        if (!used[order[k]])
            fprintf(out, "  at level %s: %s; left out: %s\n", network_level_name(order[k]),
                    at_level[order[k]].decides, at_level[order[k]].leaves_out);
}

/* ---- collectives of the network */

/* How many ranks are looked at for their distances, in all runs together: half a second. */
static const int64_t MOST_RANKS = 1 << 24;

/* A collective by hardware: whose it is, what it moves, over how many links, and how long. */
struct collective_remark {
    const struct run_spec *run;
    const char *what;
    int64_t bytes; /* of the vector */
    int links;
    double seconds;
};

#define CALL(member) .offset = offsetof(struct collective_remark, member)
#define OF_RUN(member)                                                                             \
    .part = PART(struct collective_remark, run), .offset = offsetof(struct run_spec, member)

static const struct column collective_column[] = {
    {"bytes", COLUMN_INT64, CALL(bytes), .doc = "of the vector"},
    {"collective", COLUMN_STRING, CALL(what), .doc = "its name"},
    {"links", COLUMN_INT, CALL(links), .doc = "of the tree, up and down"},
    {"machine", COLUMN_CHARS, OF_RUN(machine.name), .doc = "whose network does it"},
    {"ranks", COLUMN_INT, OF_RUN(nrank), .doc = "that take part"},
    {"seconds", COLUMN_REAL, CALL(seconds), .doc = "from the last rank's entry"},
};
static const struct column_table collective_columns = COLUMNS(collective_column);

/* Whether a built-in benchmark calls one of the network's, and how long that takes. *left: ranks
 * that may still be looked at; below 0: there were more. */
static bool remark_collective(const struct run_spec *r, int64_t *left, struct arena *a,
                              struct collective_remark *c)
{
    struct err ignored;
    struct placement place;
    err_clear(&ignored);
    if (r->refused || r->kernel.own || !kernel_spec_has(&r->kernel, PROGRAM_COLLECTIVE))
        return false;
    /* By name or by the machine's rules, exactly as the program will choose. */
    const struct collective_algorithm *by = micro_collective_algorithm(r, &ignored);
    if (by == NULL || !collective_by_network(by)) return false;
    const struct collective_shape shape = micro_collective_shape(r);
    *c = (struct collective_remark){
        .run = r, .what = collective_name(shape.kind), .bytes = shape.count * shape.element};
    if (shape.kind == COLLECTIVE_BARRIER) {
        c->seconds = r->machine.software.barrier_time;
        return true;
    }
    /* How far ranks are apart depends on where they are placed. */
    if (*left < 0 || (*left -= r->nrank) < 0) return false;
    const struct topology *t = topology_create(&r->machine.topology, a, &ignored);
    if (!t || !placement_create(&place, &r->machine, t, r->nrank, a, &ignored)) return false;
    /* By the simulation's own functions: no formula is written twice. */
    c->links = meeting_links(&r->machine, t, &place);
    const int64_t time = meeting_time(&r->machine.network, c->links, c->bytes);
    c->seconds = time > PS_LAST ? NAN : (double)time / SIM_PS_PER_S;
    return true;
}

/* The time is that of the formula in vp/meeting.h, to the picosecond what a run has. */
static void print_collective(const struct collective_remark *c, FILE *out)
{
    /* With the prefix that people would use. */
    char time[48];
    if (isnan(c->seconds)) snprintf(time, sizeof time, "more than simulated time holds");
    else units_print(c->seconds, UNIT_TIME, time, (int)sizeof time);
    fprintf(out, "%s of %lld B on %d ranks by the network of %s: %s after the last rank's entry",
            c->what, (long long)c->bytes, c->run->nrank, c->run->machine.name, time);
    /* A barrier has a time of its own, whatever its way. */
    if (c->links > 0) fprintf(out, ", over %d links", c->links);
    fprintf(out, "\n");
}

/* What is left out of all of them is said once, behind the last one, as it is the same for each. It
 * is what docs/collectives.md has at its end. */
static void print_collectives(const struct plan *p, FILE *out)
{
    bool any = false;
    int64_t left = MOST_RANKS;
    for (int i = 0; i < p->nrun; i++) {
        struct collective_remark c;
        struct arena *a = arena_create();
        if (remark_collective(&p->run[i], &left, a, &c)) {
            print_collective(&c, out);
            any = true;
        }
        arena_destroy(a);
    }
    if (left < 0)
        fprintf(out, "collectives by the network of further runs: not looked at, as the ranks of "
                     "the runs before are many\n");
    /* Once for all, behind the single ones. */
    if (any)
        fprintf(out,
                "left out of collectives by the network: other messages on its links, and that "
                "a rank that only gives could leave before the others\n");
}

/* Rules first, in the order in which the plan comes to them; then what is true of single runs. */
void network_remarks_print(const struct plan *p, FILE *out)
{
    int failed = 0;
    for (int i = 0; i < p->nrun; i++) {
        const struct topology_spec *t = &p->run[i].machine.topology;
        const struct rule_remark x = remark_rule(&p->run[i].machine.network, runs_as(p, i));
        if (x.runs > 0) print_rule(&x, p->nrun, out);
        /* Counted by runs: a sweep may have machines with and without failures. */
        failed += t->nfailed_link + t->nfailed_router > 0;
    }
    print_other_levels(p, out);
    if (failed > 0)
        fprintf(out,
                "routes around what network.failed names: %d of %d runs; a route that meets "
                "nothing failed stays\n",
                failed, p->nrun);
    print_collectives(p, out);
}

/* The same as rows: one for each run that calls one, since each may have another size. */
void network_collectives_json(const struct plan *p, struct json *j)
{
    int64_t left = MOST_RANKS;
    json_key(j, "collectives");
    json_array(j);
    for (int i = 0; i < p->nrun; i++) {
        struct collective_remark c;
        /* Topologies may be large: the memory of one run at a time. */
        struct arena *a = arena_create();
        if (remark_collective(&p->run[i], &left, a, &c)) columns_json(&collective_columns, &c, j);
        arena_destroy(a);
    }
    json_end(j);
}

/* One row for each pair of rule and level, as the lines for people. */
void network_routing_json(const struct plan *p, struct json *j)
{
    json_key(j, "routing");
    json_array(j);
    for (int i = 0; i < p->nrun; i++) {
        const struct rule_remark x = remark_rule(&p->run[i].machine.network, runs_as(p, i));
        /* An earlier run stands for this one. */
        if (x.runs > 0) columns_json(&rule_columns, &x, j);
    }
    json_end(j);
}

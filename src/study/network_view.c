/* network_view.c - see network_view.h.
 *
 * Prices and the floor plan are the machine file's; what it does not state is not counted. */
#include "study/network_view.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/units.h"

/* A cable within a rack, and what one between racks needs beside the way (Besta and Hoefler 2014
 * and Ahn et al. 2009 reckon alike). */
static const double in_rack = 1, overhead = 2;

double network_view_length(const struct network_view *v, int a, int b)
{
    const struct price_spec *p = &v->spec->price;
    int rack[2] = {a / p->rack_routers, b / p->rack_routers};
    if (rack[0] == rack[1]) return in_rack;
    int row = (int)ceil(sqrt(v->nrack));
    int dx = rack[0] % row - rack[1] % row, dy = rack[0] / row - rack[1] / row;
    return p->rack_pitch * (abs(dx) + abs(dy)) + overhead;
}

/* Every cable once: links there and back follow no common order, so each counts half. */
static double cable_metres(const struct network_view *v)
{
    const struct topology *t = v->topology;
    double metres = 0;
    int from, to, port;
    for (int l = 0; l < t->nlink; l++) {
        topology_link_ends(t, l, &from, &to, &port);
        metres += network_view_length(v, from, to) / 2;
    }
    /* Nodes stand in the rack of their router. */
    return metres + in_rack * t->nnode;
}

static void price(struct network_view *v)
{
    const struct price_spec *p = &v->spec->price;
    const struct topology *t = v->topology;
    v->nport = (int64_t)t->nlink + t->nnode;
    if (p->rack_routers > 0) {
        v->nrack = (t->nrouter + p->rack_routers - 1) / p->rack_routers;
        v->metres = cable_metres(v);
    }
    double cables = (double)v->measure.ncable + t->nnode;
    v->price = p->router * t->nrouter + p->port * (double)v->nport + p->cable * cables +
               p->metre * v->metres;
    v->power = p->router_power * t->nrouter + p->port_power * (double)v->nport;
}

/* Of halves that are known router by router the sum of the rates one way; else the number of cables
 * at one rate. */
static double cut_bandwidth(const struct network_view *v)
{
    const struct topology *t = v->topology;
    const double rate = v->spec->network.link_bandwidth;
    const bool *half = v->measure.half;
    if (v->measure.source == BISECTION_NONE || rate <= 0) return -1;
    if (topology_uniform(t)) return rate * (double)v->measure.bisection;
    if (!half) return -1;
    double sum = 0;
    int from, to, port;
    for (int l = 0; l < t->nlink; l++) {
        if (!topology_link_works(t, l)) continue;
        topology_link_ends(t, l, &from, &to, &port);
        if (half[from] && !half[to]) sum += rate * topology_link_bandwidth(t, l, rate);
    }
    return sum;
}

bool network_view_make(struct network_view *v, const struct machine_spec *m, struct arena *a,
                       struct err *e)
{
    static const char *const by[] = {NULL, "closed form", "partitioning"};
    *v = (struct network_view){.spec = m, .topology = topology_create(&m->topology, a, e)};
    if (!v->topology) return false;
    v->measure = topology_measure(v->topology, a);
    v->family = topology_family_name(m->topology.family);
    v->bisection_by = by[v->measure.source];
    v->bisection_bandwidth = cut_bandwidth(v);
    for (int d = 0, n = 0; d < m->topology.ndim && n < (int)sizeof v->dims - 16; d++)
        n += snprintf(v->dims + n, sizeof v->dims - (size_t)n, "%s%d", d > 0 ? " x " : "",
                      m->topology.dims[d]);
    price(v);
    return true;
}

#define VIEW(member) .offset = offsetof(struct network_view, member)
#define MEASURE(member) .offset = offsetof(struct network_view, measure.member)

static const struct column view_column[] = {
    {"bisection_B_per_s", COLUMN_REAL, VIEW(bisection_bandwidth), .absent = ABSENT_NEGATIVE,
     .doc = "rate of all cables of the cut, one way"},
    {"bisection_by", COLUMN_STRING, VIEW(bisection_by), .doc = "closed form or partitioning"},
    {"bisection_cables", COLUMN_INT64, MEASURE(bisection),
     .doc = "between two halves of the nodes; by partitioning: at most"},
    {"cables", COLUMN_INT64, MEASURE(ncable), .doc = "between routers"},
    {"diameter", COLUMN_INT, MEASURE(diameter), .doc = "most links between two nodes"},
    {"dims", COLUMN_CHARS, VIEW(dims), .doc = "topology.dims"},
    {"family", COLUMN_STRING, VIEW(family), .doc = "topology.family"},
    {"least_ways", COLUMN_REAL, MEASURE(least_ways), .doc = "fewest shortest ways of a pair"},
    {"longest_route", COLUMN_INT, MEASURE(longest_route), .doc = "links of the longest route"},
    {"mean_distance", COLUMN_REAL, MEASURE(mean), .doc = "links, over pairs of different nodes"},
    {"mean_route", COLUMN_REAL, MEASURE(mean_route), .doc = "links of the routes between them"},
    {"mean_ways", COLUMN_REAL, MEASURE(mean_ways),
     .doc = "shortest ways, over pairs of routers; null: more than 1.8e308"},
    {"metres", COLUMN_REAL, VIEW(metres), .absent = ABSENT_ZERO, .doc = "of cable"},
    {"nodes", COLUMN_INT, MEASURE(nnode), .doc = "with a port to the network each"},
    {"ports", COLUMN_INT64, VIEW(nport), .doc = "of all routers"},
    {"ports_of_router", COLUMN_INT, MEASURE(ports), .doc = "the most of one router"},
    {"power_W", COLUMN_REAL, VIEW(power), .absent = ABSENT_ZERO, .doc = "of routers and ports"},
    {"price", COLUMN_REAL, VIEW(price), .absent = ABSENT_ZERO, .doc = "by the file's prices"},
    {"racks", COLUMN_INT, VIEW(nrack), .absent = ABSENT_ZERO, .doc = "of routers"},
    {"routers", COLUMN_INT, MEASURE(nrouter), .doc = "in all"},
    {"sampled", COLUMN_BOOL, MEASURE(sampled), .doc = "distances from a part of the routers"},
};
const struct column_table network_view_columns = COLUMNS(view_column);

static void print_distances(const struct topology_measure *m, FILE *out)
{
    fprintf(out, "%-18s %d links%s\n", "diameter", m->diameter, m->sampled ? " at least" : "");
    fprintf(out, "%-18s %.6g links between two different nodes\n", "mean distance", m->mean);
    /* Routes that are as long as distances need no line of their own. */
    if (fabs(m->mean_route - m->mean) > 1e-9 * m->mean)
        fprintf(out, "%-18s %.6g links, the longest %d\n", "mean route", m->mean_route,
                m->longest_route);
    /* Between opposite corners of a mesh of 1,024 x 1,024 there are 10^614. */
    const double most = fmin(m->mean_ways, DBL_MAX), least = fmin(m->least_ways, DBL_MAX);
    fprintf(out, "%-18s %s%.4g shortest ways between two routers, %.4g at least\n",
            "path diversity", most < m->mean_ways ? "more than " : "", most, least);
    if (m->sampled)
        fprintf(out, "%-18s distances and ways are measured from %d routers\n", "", m->nsource);
}

static void print_bisection(const struct network_view *v, FILE *out)
{
    const struct topology_measure *m = &v->measure;
    char rate[64] = "";
    if (v->bisection_bandwidth >= 0) {
        char number[48];
        units_print(v->bisection_bandwidth, UNIT_BANDWIDTH, number, (int)sizeof number);
        snprintf(rate, sizeof rate, ", %s each way", number);
    }
    bool exact = m->source == BISECTION_EXACT;
    fprintf(out, "%-18s %s%lld cables%s (%s)\n", "bisection", exact ? "" : "at most ",
            (long long)m->bisection, rate, exact ? "exact, by closed form" : "by partitioning");
}

void network_view_print(const struct network_view *v, FILE *out)
{
    const struct topology_measure *m = &v->measure;
    fprintf(out, "%-18s %s %s\n", "topology", v->family, v->dims);
    fprintf(out, "%-18s %d, nodes %d, cables between routers %lld\n", "routers", m->nrouter,
            m->nnode, (long long)m->ncable);
    if (!topology_whole(v->topology))
        fprintf(out, "%-18s %d of %d routers and %d of %d cables do not work\n", "",
                v->topology->nrouter - m->nrouter, v->topology->nrouter,
                v->topology->nlink / 2 - (int)m->ncable, v->topology->nlink / 2);
    fprintf(out, "%-18s %lld in use; of one router %d", "ports", (long long)v->nport, m->ports);
    if (m->least_ports < m->ports) fprintf(out, " at most, %d at least", m->least_ports);
    fputc('\n', out);
    if (m->nrouter > 1) {
        print_distances(m, out);
        print_bisection(v, out);
    } else {
        fprintf(out, "%-18s all nodes hang on one router: there is no distance and no cut\n", "");
    }
    /* Only what the file states prices for. */
    if (v->nrack > 0)
        fprintf(out, "%-18s %.4g m, in %d racks of routers\n", "cable", v->metres, v->nrack);
    if (v->price > 0)
        fprintf(out, "%-18s %.0f, %.4g a node (prices of the machine file)\n", "price", v->price,
                v->price / m->nnode);
    if (v->power > 0)
        fprintf(out, "%-18s %.0f W, %.4g W a node\n", "power", v->power, v->power / m->nnode);
}

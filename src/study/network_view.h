/* network_view.h - a machine's network as numbers, costs and a picture, before anything runs on it.
 */
#ifndef STUDY_NETWORK_VIEW_H
#define STUDY_NETWORK_VIEW_H

#include "base/arena.h"
#include "base/err.h"
#include "machine/topology_measure.h"
#include "measure/column.h"
#include "spec/machine_spec.h"
#include "store/store.h"

/* One network. Numbers that are not known are negative or NULL. */
struct network_view {
    const struct machine_spec *spec; /* borrowed */
    const struct topology *topology;
    struct topology_measure measure;
    const char *family;
    char dims[80];              /* "8 x 4 x 4" */
    const char *bisection_by;   /* "closed form", "partitioning", NULL: nothing to cut */
    double bisection_bandwidth; /* one way, all cables of the cut [B/s]; -1: rates differ, and the
                                   cut is known by its number of cables alone */
    int64_t nport;              /* ports of all routers in use */
    int nrack;                  /* racks of routers; 0: the file has no floor plan */
    double metres;              /* cables of the floor plan [m] */
    double price;               /* of routers, ports, cables and metres, in the file's currency */
    double power;               /* of routers and ports [W] */
};

/* network_view_make: the network of `m`, measured and priced; memory from a. Returns false as
 * topology_create. */
bool network_view_make(struct network_view *v, const struct machine_spec *m, struct arena *a,
                       struct err *e);

/* network_view_columns: the numbers of a view for JSON. network_view_print: for people. */
extern const struct column_table network_view_columns;
void network_view_print(const struct network_view *v, FILE *out);

/* network_view_length: a cable between routers a and b by the floor plan [m]: routers stand in
 * racks of floor.routers_per_rack in the order of their numbers, racks floor.pitch apart in rows of
 * a square; 1 m within a rack, 2 m more than the way along the rows between racks. */
double network_view_length(const struct network_view *v, int a, int b);

/* What a picture can hold. */
enum { NETWORK_VIEW_ROUTERS = 5000, NETWORK_VIEW_PAIRS = 2500 };

/* network_view_tables: the picture as temporary tables of `s` (topology_about, topology_router,
 * topology_line), from which plots/_topology draws: where each router stands, and its cables as
 * pieces of lines. Of more than NETWORK_VIEW_PAIRS joined pairs those of every second, third, ...
 * router are drawn. Returns false with ERR_DATA for more than NETWORK_VIEW_ROUTERS routers, and
 * as store_temporary. */
bool network_view_tables(const struct network_view *v, struct store *s, struct arena *a,
                         struct err *e);

#endif

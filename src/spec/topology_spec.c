/* topology_spec.c - what is known of a family of topologies by its line of the list, and how many
 * processors a machine has. */
#include "base/size.h"
#include "spec/machine_spec.h"

/* Product of the first n dimensions; INT64_MAX where it is larger, so that no caller meets a number
 * that has wrapped. */
static int64_t product(const int *dims, int n)
{
    int64_t p = 1;
    for (int i = 0; i < n; i++) p = size_count(p, dims[i]);
    return p;
}

/* Stops when it cannot grow any more: base 0 or 1, or saturated. */
static int64_t power(int64_t base, int exponent)
{
    int64_t p = 1;
    for (int i = 0; i < exponent && base > 1 && p < INT64_MAX; i++) p = size_count(p, base);
    return p;
}

/* Each family's own formula, from its line of the list. */
static int64_t router_count(const struct topology_spec *t)
{
    switch (t->family) {
#define X(constant, word, stem, ndim, routers, traits) \
    case constant: return routers;
        TOPOLOGY_LIST(X)
#undef X
    }
    return 0;
}

/* Traits answer what other rooms would else ask by comparing families. */
bool topology_has(enum topology_family f, enum topology_trait trait)
{
    static const unsigned has[] = {
#define X(constant, word, stem, ndim, routers, traits) [constant] = traits,
        TOPOLOGY_LIST(X)
#undef X
    };
    return (has[f] & trait) != 0;
}

int topology_family_dims(enum topology_family f)
{
    static const int count[] = {
#define X(constant, word, stem, ndim, routers, traits) [constant] = ndim,
        TOPOLOGY_LIST(X)
#undef X
    };
    return count[f];
}

const char *topology_family_name(enum topology_family f)
{
    static const char *const name[] = {
#define X(constant, word, stem, ndim, routers, traits) [constant] = word,
        TOPOLOGY_LIST(X)
#undef X
    };
    return name[f];
}

/* Saturates at INT64_MAX: a mistyped dimension is refused by its size, not wrapped. */
int64_t machine_spec_processors(const struct machine_spec *m)
{
    const struct topology_spec *t = &m->topology;
    bool own_nodes = topology_has(t->family, TOPOLOGY_OWN_NODES);
    return size_count(size_count(router_count(t), own_nodes ? 1 : t->nodes_per_router),
                      t->processors_per_node);
}

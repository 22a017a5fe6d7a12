/* node_spec.c - what levels of caches are called, and the node that serial codes have. */
#include "spec/node_spec.h"

/* As in keys of files, but for their case: people write L2. The last one is no cache. */
const char *node_level_name(enum node_level level)
{
    static const char *const name[NODE_LEVELS] = {"L1", "L2", "L3", "memory"};
    return name[level];
}

struct node_spec node_spec_serial(const struct node_spec *s)
{
    struct node_spec serial = *s;
    if (s->serial_rate > 0) serial.flop_rate = s->serial_rate;
    return serial;
}

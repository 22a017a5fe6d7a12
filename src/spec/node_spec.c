/* node_spec.c - what levels of caches are called. */
#include "spec/node_spec.h"

/* As in keys of files, but for their case: people write L2. The last one is no cache. */
const char *node_level_name(enum node_level level)
{
    static const char *const name[NODE_LEVELS] = {"L1", "L2", "L3", "memory"};
    return name[level];
}

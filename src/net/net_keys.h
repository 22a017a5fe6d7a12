/* net_keys.h - in which order a network's events of one lane and time come. */
#ifndef NET_NET_KEYS_H
#define NET_NET_KEYS_H

#include <stdint.h>

/* net_event_key: by input port, then message. */
static inline uint64_t net_event_key(int port, int64_t id)
{
    return (uint64_t)(port & 0xffffff) << 24 | (uint64_t)(id & 0xffffff);
}

/* net_start_key: of starts: by id, of which the upper half names the sender. */
static inline uint64_t net_start_key(int64_t id)
{
    return (uint64_t)(id >> 32 & 0xffffff) << 24 | (uint64_t)(id & 0xffffff);
}

#endif

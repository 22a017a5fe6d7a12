/* load_options.h - what `mimdsim load` is asked: traffic, routings, levels, loads, sizes. */
#ifndef APP_LOAD_OPTIONS_H
#define APP_LOAD_OPTIONS_H

#include "app/verb.h"

enum { LOAD_MOST_WORDS = 64, LOAD_MOST_RATES = 256, LOAD_BYTES = 64 /* unless asked for */ };

struct load_options {
    int ntraffic, nrouting, nlevel, nrate; /* nrouting, nlevel 0: the machine's own */
    const char *traffic[LOAD_MOST_WORDS], *routing[LOAD_MOST_WORDS];
    enum network_level level[LEVELS];
    double rate[LOAD_MOST_RATES]; /* rising, each once */
    int64_t bytes;
    bool sized; /* `bytes` was asked for */
    uint64_t seed;
    double within;
    int most;
    bool saturation; /* look for it */
    bool software;   /* the machine's message software limits and delays messages, too */
};

/* load_options_take: the verb's own options out of the arguments; texts are copied into a. --level
 * is left (load_options_levels). Returns false with ERR_USAGE: which option, the value, what was
 * expected. */
bool load_options_take(int *argc, char **argv, struct load_options *o, struct arena *a,
                       struct err *e);

/* load_options_levels: "packet,flit" of --level (NULL: none). Returns false with ERR_USAGE. */
bool load_options_levels(const char *text, struct load_options *o, struct arena *a, struct err *e);

#endif

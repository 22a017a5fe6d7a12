/* node_spec.h - what computing costs on a processor, and the caches and memories that its data come
 * from. */
#ifndef SPEC_NODE_SPEC_H
#define SPEC_NODE_SPEC_H

#include <stdint.h>

/* How counted work becomes time (docs/nodes.md). */
enum node_model {
    NODE_RATES,    /* each class of operation at its price, one after the other */
    NODE_ROOFLINE, /* the longer one of operations and bytes moved */
    NODE_MODELS
};

/* Where data can lie, the nearest first. */
enum node_level { NODE_L1, NODE_L2, NODE_L3, NODE_MEMORY, NODE_LEVELS };

/* One cache, or the memory; zero where nothing is stated. Bandwidths count bytes that programs load
 * and store, as STREAM does. */
struct memory_level {
    int64_t bytes;    /* capacity [B]; 0: there is no such cache. Of no meaning for the memory */
    double bandwidth; /* of one processor that has it alone [B/s]; 0: no limit */
    double shared;    /* of all processors that share it together [B/s]; 0: no limit */
    int processors;   /* that share it; 0: those of a node */
};

/* What computing costs on one processor. A rate holds for small dense double-precision code. */
struct node_spec {
    double flop_rate;   /* additions and multiplications [flop/s] */
    double serial_rate; /* the same of the serial codes that speedups are held against [flop/s], 0:
                           flop_rate */
    double clock;       /* [Hz], for the cycle counts below */
    double div_cycles;  /* one division [cycles] */
    double sqrt_cycles; /* one square root [cycles] */
    double trig_cycles; /* one sine or cosine [cycles] */
    double instruction_cycles; /* one instruction of a program compiled by `mimdsim cc` [cycles], 0:
                                  node_cost.c */
    struct code_spec {
        double issue; /* one instruction that waits for nothing, 0: instruction_cycles hold */
        double div;   /* one division where none waits for the one before */
        double root;  /* one square root, likewise */
        double chain; /* floating-point addition that waits for the one before it in a loop */
        double step;  /* nominal cycle of other instructions that do */
        double load;  /* one load of a vector register, 0: loads and loops have no times of their
                         own */
        double whole; /* one instruction that computes with whole numbers */
        double add;   /* one floating-point addition that waits for nothing, 0: no bound */
        double multiply;         /* one product, likewise */
        double fetch; /* one piece of a loop's code that is fetched, 0: no bound */
        double add_latency;      /* addition that waits for something else than one, 0: chain */
        double multiply_latency; /* product that waits for what comes before, 0: 4 steps */
        double window;           /* floating-point instructions that wait at a time, 0: no limit */
    } code;           /* programs compiled by `mimdsim cc`, finer [cycles] (node_cost.h) */
    double call_time;          /* overhead of one small operator call [s] */
    double copy_bandwidth;     /* memory copies [B/s] */
    enum node_model model;
    struct memory_level level[NODE_LEVELS]; /* act with NODE_ROOFLINE alone */
};

/* node_spec_serial: the node as serial codes find it, the baselines of speedups: at serial_rate
 * where that is stated. */
struct node_spec node_spec_serial(const struct node_spec *s);

/* node_level_name: "L1", "L2", "L3", "memory". */
const char *node_level_name(enum node_level level);

#endif

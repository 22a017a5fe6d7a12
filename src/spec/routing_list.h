/* routing_list.h - the routing rules of networks, one line each.
 *
 * Columns of X: constant, word in files, whether routes depend on load or on chance (a seed then
 * matters). A rule's code is in room machine (routing_*.c), where a table says which families it is
 * for. Rules called booksim-* are those of that simulator to the letter, so that comparisons are of
 * like with like; the others are this program's own or common to both. */
#ifndef SPEC_ROUTING_LIST_H
#define SPEC_ROUTING_LIST_H

#include <stdbool.h>

#define ROUTING_LIST(X)                                                                            \
    /* the one route that the topology gives for two nodes */                                      \
    X(ROUTING_DETERMINISTIC, "deterministic", false)                                               \
    /* any link that leads nearer, by load; an escape route or classes by hop against deadlock */  \
    X(ROUTING_ADAPTIVE, "adaptive", true)                                                          \
    /* dimensions ascending or descending, by chance; by load */                                   \
    X(ROUTING_XY_YX, "xy-yx", true)                                                                \
    X(ROUTING_ADAPTIVE_XY_YX, "adaptive-xy-yx", true)                                              \
    /* through a random node; through one in the box that both ends span */                        \
    X(ROUTING_VALIANT, "valiant", true)                                                            \
    X(ROUTING_ROMM, "romm", true)                                                                  \
    /* minimal or Valiant's way, by the queues of the source's router; of all links of both */     \
    X(ROUTING_UGAL_L, "ugal-l", true)                                                              \
    X(ROUTING_UGAL_G, "ugal-g", true)                                                              \
    /* fat trees: up by chance; the emptier of two random ports */                                 \
    X(ROUTING_NCA, "nca", true)                                                                    \
    X(ROUTING_ANCA, "anca", true)                                                                  \
    X(ROUTING_BOOKSIM_DIM_ORDER, "booksim-dim-order", true)                                        \
    X(ROUTING_BOOKSIM_MIN_ADAPT, "booksim-min-adapt", true)                                        \
    X(ROUTING_BOOKSIM_VALIANT, "booksim-valiant", true)                                            \
    X(ROUTING_BOOKSIM_UGAL, "booksim-ugal", true)                                                  \
    X(ROUTING_BOOKSIM_MIN, "booksim-min", true)

enum routing_rule {
#define X(constant, word, chance) constant,
    ROUTING_LIST(X)
#undef X
        ROUTING_RULES
};

/* How heads get channels: iSLIP (McKeown 1999) that obeys the priorities of a rule's options, as
 * BookSim's allocator `select` does, or that does not know them. */
enum vc_allocator { ALLOCATOR_SELECT, ALLOCATOR_ISLIP };

/* routing_rule_name: the word in files. routing_rule_chance: whether load or chance choose. */
const char *routing_rule_name(enum routing_rule rule);
bool routing_rule_chance(enum routing_rule rule);

#endif

/* routing_list.h - the routing rules of networks, one line each.
 *
 * Columns of X: constant, word in files, whether routes depend on load or on chance (a seed then
 * matters), what it does in a few words. A rule's code is in room machine (routing_*.c), where a
 * table says which families it is for. Rules called booksim-* are those of that simulator to the
 * letter, so that comparisons are of like with like; the others are this program's own or common to
 * both. */
#ifndef SPEC_ROUTING_LIST_H
#define SPEC_ROUTING_LIST_H

#include <stdbool.h>

#define ROUTING_LIST(X)                                                                            \
    X(ROUTING_DETERMINISTIC, "deterministic", false,                                               \
      "the one route that the topology gives for two nodes")                                       \
    /* an escape route or classes by hop against deadlock */                                       \
    X(ROUTING_ADAPTIVE, "adaptive", true,                                                          \
      "any link that leads nearer, the one with the least load first")                             \
    X(ROUTING_XY_YX, "xy-yx", true, "dimensions ascending or descending, by chance")               \
    X(ROUTING_ADAPTIVE_XY_YX, "adaptive-xy-yx", true,                                              \
      "dimensions ascending or descending, by the load of both first links")                       \
    X(ROUTING_VALIANT, "valiant", true, "to the router of a random node, then on")                 \
    X(ROUTING_ROMM, "romm", true,                                                                  \
      "through a random router within the box that both ends span")                                \
    X(ROUTING_UGAL_L, "ugal-l", true,                                                              \
      "minimal, or through a random router, by the load of both first links times their lengths")  \
    X(ROUTING_UGAL_G, "ugal-g", true,                                                              \
      "minimal, or through a random router, by the load of all links of both ways")                \
    X(ROUTING_NCA, "nca", true, "up by random ports to the nearest common switch, and down")       \
    X(ROUTING_ANCA, "anca", true, "the same, by the emptier of two random ports")                  \
    X(ROUTING_BOOKSIM_DIM_ORDER, "booksim-dim-order", true, "BookSim's dimension order")           \
    X(ROUTING_BOOKSIM_MIN_ADAPT, "booksim-min-adapt", true,                                        \
      "BookSim's minimal adaptive rule, which takes the lowest dimension that is left")            \
    X(ROUTING_BOOKSIM_VALIANT, "booksim-valiant", true, "BookSim's way through a random router")   \
    X(ROUTING_BOOKSIM_UGAL, "booksim-ugal", true,                                                  \
      "BookSim's choice of the minimal way or one through a random router")                        \
    X(ROUTING_BOOKSIM_MIN, "booksim-min", true, "BookSim's minimal way")

enum routing_rule {
#define X(constant, word, chance, doc) constant,
    ROUTING_LIST(X)
#undef X
        ROUTING_RULES
};

/* How heads get channels: iSLIP (McKeown 1999) that obeys the priorities of a rule's options, as
 * BookSim's allocator `select` does, or that does not know them. */
enum vc_allocator { ALLOCATOR_SELECT, ALLOCATOR_ISLIP };

/* routing_rule_name: the word in files. routing_rule_doc: what it does, as a clause.
 * routing_rule_chance: whether load or chance choose. */
const char *routing_rule_name(enum routing_rule rule);
const char *routing_rule_doc(enum routing_rule rule);
bool routing_rule_chance(enum routing_rule rule);

#endif

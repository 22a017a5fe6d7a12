/* netcheck_accuracy.c - the table of stated accuracies: the first entry that fits a row at a level
 * holds.
 *
 * The figures are what was measured on the reference's files, and on 14,000 lists of other sizes,
 * patterns and buffers, where level flit stands for the reference (exact with one channel); both
 * widened by about a third. What is said without measurement follows from the levels: loggp has no
 * contention, so that nothing arrives later than in the reference; link has no buffers, so that it
 * saturates late. */
#include "study/netcheck_accuracy.h"

#include <math.h>
#include <stddef.h>

#define FORM(f) (1 << NETCHECK_##f)
#define FAMILY(f) (1 << TOPOLOGY_##f)
#define LEVEL(l) (1 << LEVEL_##l)

/* Bit sets of forms, families and levels; EVERY has all bits. */
enum {
    EVERY = -1,
    MESSAGES = FORM(STEP) | FORM(LIST) | FORM(HAND),
    SERIES = FORM(LOAD) | FORM(SATURATION),
    CUT_THROUGH = LEVEL(PACKET) | LEVEL(AUTO),
    ROUTERS = CUT_THROUGH | LEVEL(FLIT),
    CUBE = FAMILY(HYPERCUBE),
    NO_WRAP = CUBE | FAMILY(MESH),
    GRIDS = NO_WRAP | FAMILY(TORUS),
    TREE = FAMILY(FAT_TREE),
    DRAGONFLY = FAMILY(DRAGONFLY)
};
/* ROUTED: only series that are played by the reference's own routing rule. */
enum channels { ANY_CHANNELS, ONE_CHANNEL, MORE_CHANNELS, ROUTED };

/* The conditions of one class, and what is stated of it. The first entry whose conditions all
 * hold is taken, so the order is from special to general; the last two have no conditions on
 * network or level. */
struct entry {
    int levels, forms, families;
    enum channels channels;
    double crowding; /* loads: up to this latency over that of the empty network */
    struct netcheck_accuracy stated;
};

#define ALWAYS INFINITY
#define NONE (-1) /* messages have no reference */

/* levels, forms, networks, channels, crowding, {levels, class, mean, low, high, message} */
/* clang-format off: an entry is a line of conditions and a line of figures */
static const struct entry table[] = {
    /* lists of messages */
    {EVERY, FORM(STEP), CUBE, ANY_CHANNELS, ALWAYS,
     {"all", "one step on a hypercube", 0, 0, 0, 0}},
    {LEVEL(FLIT), MESSAGES, GRIDS, ONE_CHANNEL, ALWAYS,
     {"flit", "lists of messages, one channel", 0, 0, 0, 0}},
    {CUT_THROUGH, FORM(STEP), GRIDS, ONE_CHANNEL, ALWAYS,
     {"packet, auto", "one step, one channel, packets that fit", 0, 0, 0, 0}},
    {CUT_THROUGH, MESSAGES, GRIDS, ONE_CHANNEL, ALWAYS,
     {"packet, auto", "several steps, one channel, packets that fit", 0.01, -0.20, 0.15, 2.5}},
    {LEVEL(FLIT), MESSAGES, NO_WRAP, MORE_CHANNELS, ALWAYS,
     {"flit", "mesh or hypercube, several channels", 0.02, -0.15, 0.15, 1}},
    {LEVEL(FLIT), MESSAGES, GRIDS, MORE_CHANNELS, ALWAYS,
     {"flit", "torus, several channels", 0.04, -0.30, 0.35, 4}},
    {CUT_THROUGH, MESSAGES, NO_WRAP, MORE_CHANNELS, ALWAYS,
     {"packet, auto", "mesh or hypercube, several channels", 0.03, -0.25, 0.60, 2.5}},
    {CUT_THROUGH, MESSAGES, GRIDS, MORE_CHANNELS, ALWAYS,
     {"packet, auto", "torus, several channels", 0.05, -0.30, 0.55, 4}},
    {LEVEL(LINK), FORM(STEP), NO_WRAP, ONE_CHANNEL, ALWAYS,
     {"link", "one step on a mesh, one channel", 0.20, -0.92, 0, 1.5}},
    {LEVEL(LINK), FORM(STEP), NO_WRAP, MORE_CHANNELS, ALWAYS,
     {"link", "one step on a mesh, several channels", 0.15, -0.80, 1.30, 1.5}},
    {LEVEL(LINK), MESSAGES, NO_WRAP, ANY_CHANNELS, ALWAYS,
     {"link", "several steps on a mesh or hypercube", 0.10, -0.60, 0.12, 2.5}},
    {LEVEL(LINK), MESSAGES, GRIDS, ANY_CHANNELS, ALWAYS,
     {"link", "torus", 0.35, -0.95, 1.00, 9}},
    {LEVEL(LOGGP), MESSAGES, EVERY, ANY_CHANNELS, ALWAYS,
     {"loggp", "lists of messages", 0.50, -0.98, 0.01, 1.1}},
    /* series by the reference's routing rules */
    {LEVEL(FLIT), FORM(LOAD), EVERY, ROUTED, 1.6,
     {"flit", "by routing rules, up to 1.6 times the empty network's latency",
      0.01, -0.03, 0.03, NONE}},
    {LEVEL(FLIT), FORM(LOAD), EVERY, ROUTED, ALWAYS,
     {"flit", "by routing rules, above", 0.05, -0.15, 0.20, NONE}},
    {LEVEL(FLIT), FORM(SATURATION), EVERY, ROUTED, ALWAYS,
     {"flit", "by routing rules, load at saturation", 0.02, -0.05, 0.05, NONE}},
    {CUT_THROUGH, FORM(LOAD), EVERY, ROUTED, 1.6,
     {"packet, auto", "by routing rules, up to 1.6 times the empty network's latency",
      0.06, -0.20, 0.20, NONE}},
    {EVERY, SERIES, EVERY, ROUTED, ALWAYS,
     {"all", "by routing rules, otherwise", 0.50, -0.99, 3.00, NONE}},
    /* latency under random load */
    {LEVEL(LOGGP), FORM(LOAD), EVERY, ANY_CHANNELS, ALWAYS,
     {"loggp", "random loads", 0.35, -0.995, 0.20, NONE}},
    {EVERY, FORM(LOAD), DRAGONFLY, ANY_CHANNELS, 1.15,
     {"all", "dragonfly, up to 1.15 times the empty network's latency", 0.06, -0.20, 0.05, NONE}},
    {EVERY, FORM(LOAD), DRAGONFLY, ANY_CHANNELS, ALWAYS,
     {"all", "dragonfly, above: late credits of channels of 100 cycles are not modelled", 0.30,
      -0.70, 0.05, NONE}},
    {EVERY, FORM(LOAD), TREE, ANY_CHANNELS, 1.3,
     {"all", "fat tree, up to 1.3 times the empty network's latency", 0.05, -0.12, 0.06, NONE}},
    {EVERY, FORM(LOAD), TREE, ANY_CHANNELS, ALWAYS,
     {"all", "fat tree, above: the reference's inner limits are not modelled", 0.30, -0.62,
      0.10, NONE}},
    {ROUTERS, FORM(LOAD), GRIDS, ANY_CHANNELS, 1.3,
     {"packet, auto, flit", "random loads, up to 1.3 times the empty network's latency", 0.03,
      -0.10, 0.12, NONE}},
    {ROUTERS, FORM(LOAD), GRIDS, ANY_CHANNELS, 2,
     {"packet, auto, flit", "random loads, up to twice the empty network's latency", 0.06, -0.20,
      0.40, NONE}},
    {ROUTERS, FORM(LOAD), GRIDS, ONE_CHANNEL, 3,
     {"packet, auto, flit", "loads, up to three times the empty network's latency, one channel",
      0.20, -0.30, 0.75, NONE}},
    {ROUTERS, FORM(LOAD), GRIDS, MORE_CHANNELS, 3,
     {"packet, auto, flit",
      "loads, up to three times the empty network's latency, several channels",
      0.20, -0.60, 0.75, NONE}},
    {ROUTERS, FORM(LOAD), GRIDS, ONE_CHANNEL, ALWAYS,
     {"packet, auto, flit", "random loads at saturation, one channel", 0.30, -0.40, 0.90, NONE}},
    {ROUTERS, FORM(LOAD), GRIDS, MORE_CHANNELS, ALWAYS,
     {"packet, auto, flit", "random loads at saturation, several channels", 0.30, -0.60,
      0.90, NONE}},
    {LEVEL(LINK), FORM(LOAD), GRIDS, ANY_CHANNELS, 1.3,
     {"link", "random loads, up to 1.3 times the empty network's latency", 0.03, -0.15,
      0.12, NONE}},
    {LEVEL(LINK), FORM(LOAD), GRIDS, ANY_CHANNELS, ALWAYS,
     {"link", "random loads, above", 0.30, -0.95, 0.60, NONE}},
    /* load at saturation */
    {ROUTERS, FORM(SATURATION), GRIDS, ANY_CHANNELS, ALWAYS,
     {"packet, auto, flit", "load at saturation", 0.03, -0.10, 0.10, NONE}},
    {LEVEL(LINK), FORM(SATURATION), GRIDS, ANY_CHANNELS, ALWAYS,
     {"link", "load at saturation", 0.40, -0.10, 1.30, NONE}},
    /* networks on which no reference is known */
    {EVERY, MESSAGES, EVERY, ANY_CHANNELS, ALWAYS,
     {"all", "lists of messages on other networks", 0.40, -0.98, 1.00, 8}},
    {EVERY, SERIES, EVERY, ANY_CHANNELS, ALWAYS,
     {"all", "random loads on other networks", 0.40, -0.60, 1.00, NONE}},
};
/* clang-format on */
enum { ENTRIES = sizeof table / sizeof *table };

const struct netcheck_accuracy *netcheck_accuracies(int i)
{
    return i >= 0 && i < ENTRIES ? &table[i].stated : NULL;
}

/* Whether an entry's conditions hold for a row at a level; `level` and the row's enums count
 * bits. */
static bool fits(const struct entry *t, const struct netcheck_row *row, enum network_level level)
{
    bool channels = t->channels == ANY_CHANNELS ||
                    (t->channels == ROUTED ? row->routed
                                           : (t->channels == ONE_CHANNEL) == (row->channels == 1));
    return t->levels >> level & 1 && t->forms >> row->form & 1 && t->families >> row->family & 1 &&
           channels && row->crowding <= t->crowding;
}

const struct netcheck_accuracy *netcheck_accuracy_of(const struct netcheck_row *row,
                                                     enum network_level level)
{
    int i = 0;
    while (i < ENTRIES - 1 && !fits(&table[i], row, level)) i++;
    return &table[i].stated;
}

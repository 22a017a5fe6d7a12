/* level_list.h - the network levels, one line each. A new level is a line here and a file
 * net_STEM.c in room net that defines `net_STEM`. Columns of X: constant, word in files, stem, cost
 * (0: cheapest), fineness (0: finest; the finest that answers is the reference of the others). */
#ifndef SPEC_LEVEL_LIST_H
#define SPEC_LEVEL_LIST_H

#define LEVEL_LIST(X)                                                                              \
    X(LEVEL_LOGGP, "loggp", loggp, 0, 4)                                                           \
    X(LEVEL_LINK, "link", link, 1, 3)                                                              \
    X(LEVEL_PACKET, "packet", packet, 3, 1)                                                        \
    X(LEVEL_FLIT, "flit", flit, 4, 0)                                                              \
    /* the times of packet at a lower cost */                                                      \
    X(LEVEL_AUTO, "auto", auto, 2, 2)

#endif

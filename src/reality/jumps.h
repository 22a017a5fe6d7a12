/* jumps.h - where the time of a message changes from one line over its size to another: the sizes
 * at which a message library changes its way of sending, found from measured times alone. */
#ifndef REALITY_JUMPS_H
#define REALITY_JUMPS_H

#include "reality/messages.h"
#include "spec/software_spec.h"

/* jumps_find: the points of `m` (at least one) as at most SOFTWARE_MAX_SEGMENTS pieces, each with
 * one line; first[k] is the first point of piece k, first[0] = 0. As few pieces as keep the time of
 * every message within 5 % of its line, else as many as may be, so that the worst is least. The
 * switch to rendezvous, which is measured on its own, always divides. Returns how many. */
int jumps_find(const struct messages *m, int first[SOFTWARE_MAX_SEGMENTS]);

/* jumps_open: a size between two points of `m` at which the lines on both sides are a tenth or more
 * apart, and which lie further apart than an eighth of the larger one: where the jump is nearer is
 * not known. -1: none. */
int64_t jumps_open(const struct messages *m);

/* jumps_height: by how much the line that begins with point `i` > 0 lies above the one that ends
 * before it, at that size, relative to the latter. */
double jumps_height(const struct messages *m, int i);

#endif

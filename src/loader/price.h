/* price.h - the blocks of a loaded program, and of its own libraries, priced for a machine. */
#ifndef LOADER_PRICE_H
#define LOADER_PRICE_H

#include "loader/loader.h"
#include "machine/node_cost.h"

/* loader_price_blocks: write the cost of every counted block (block_table.h) into the template:
 * those of the program, and those of libraries that `mimdsim cc` made, too. Before loader_reserve.
 *
 *   c, factor  in  the node of the run's machine, and what its times are multiplied by
 *
 *   Returns false with the errors of block_costs_patch. */
bool loader_price_blocks(struct loader_template *t, const struct node_cost *c, double factor,
                         struct err *e);

#endif

/* swept.h - view v_swept of a database: one row a run, one column a setting that differs between
 * its runs, as a number in SI base units where it is one. */
#ifndef STORE_SWEPT_H
#define STORE_SWEPT_H

#include "store/store.h"

/* store_swept_view: make the view for the settings that differ now, called by the end of their keys
 * that no other setting has, with '_' for '.': hop_latency, link_bandwidth. Of keys whose names are
 * equal then, as of x-y and x.y, the first in the order of keys has x_y, the next x_y_2. Where
 * nothing differs there is no view. A view of that name that this program has not made stays as it
 * is. Returns false as store_exec. */
bool store_swept_view(struct store *s, struct err *e);

#endif

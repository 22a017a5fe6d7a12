/* plot_options.h - the options of mimdsim plot that say what is drawn over what. */
#ifndef APP_PLOT_OPTIONS_H
#define APP_PLOT_OPTIONS_H

#include "report/plot.h"

/* plot_options_take: remove --x, --y, --z, --by, --where, --kind, --log, --title and --as from the
 * arguments into *r, whose texts live in `a`. *given: one of the axes was there. Returns false with
 * ERR_USAGE. */
bool plot_options_take(struct plot_request *r, int *argc, char **argv, bool *given, struct arena *a,
                       struct err *e);

/* plot_options_name: the name of the files, where --as gave none: after the query's file, or what
 * is over what. */
void plot_options_name(struct plot_request *r, const char *query_file, struct arena *a);

#endif

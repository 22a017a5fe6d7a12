/* data_dir.h - where machines and scenarios lie, and which files there are. */
#ifndef PLAN_DATA_DIR_H
#define PLAN_DATA_DIR_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"

/* data_dir_find: the file that `name` means, in `a`. A name with a slash or ending in .yaml is a
 * path, relative to the folder `near` (NULL or "": the working directory). Otherwise NAME.yaml is
 * looked for in `near` (unless NULL), in the data folder's `what` ("machines", "scenarios") and in
 * $XDG_DATA_HOME/mimdsim/`what`. Returns NULL with ERR_NO_INPUT and the nearest name there is. */
const char *data_dir_find(const char *what, const char *name, const char *near, struct arena *a,
                          struct err *e);

/* data_dir_names: stems of the *.yaml files of `what` ("plots": *.sql), sorted, without repetition;
 * (*n) of them in `a`. */
const char **data_dir_names(const char *what, struct arena *a, int *n);

/* data_dir_has_figure: whether the data folder's plots/ can draw `name`; where not, ERR_DATA at
 * line `line` of `file` with the nearest name. */
bool data_dir_has_figure(const char *name, const char *file, int line, struct arena *a,
                         struct err *e);

/* data_dir_of: the folder part of `path`, "" when it has none; data_dir_stem: its last part without
 * ".yaml". In `a`. */
const char *data_dir_of(const char *path, struct arena *a);
const char *data_dir_stem(const char *path, struct arena *a);

#endif

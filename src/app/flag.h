/* flag.h - the options that a single verb has, taken out of its arguments before the common ones
 * are read. */
#ifndef APP_FLAG_H
#define APP_FLAG_H

#include <stdbool.h>

#include "base/err.h"
#include "spec/machine_spec.h"

/* take_flag: remove every `name` ("--keep-all") from argv[1..]; whether there was one. */
bool take_flag(int *argc, char **argv, const char *name);

/* take_value: remove "NAME X" or "NAME=X" from argv[1..]; X, the last one, or NULL when there is
 * none. A missing X is
 * "". */
const char *take_value(int *argc, char **argv, const char *name);

/* take_first_value: as take_value, but only the first of several is removed; for options that may
 * be repeated. */
const char *take_first_value(int *argc, char **argv, const char *name);

/* take_seconds: as take_value, a number of seconds above 0 into *seconds; 0 when the option is not
 * there. False with ERR_USAGE. */
bool take_seconds(int *argc, char **argv, const char *name, double *seconds, struct err *e);

/* take_threads: --threads N|auto as run_order.threads; auto when it is not there. False with
 * ERR_USAGE. */
bool take_threads(int *argc, char **argv, int *threads, struct err *e);

/* level_named: the network level below LEVELS that `word` is, into *level. False with ERR_USAGE:
 * the nearest, or all; `option` ("--level: ", "") stands before it. */
bool level_named(const char *option, const char *word, enum network_level *level, struct err *e);

#endif

/* programs.h - people's own programs on the command line: compiled where they are source, kept in a
 * cache, and read for what they declare. */
#ifndef APP_PROGRAMS_H
#define APP_PROGRAMS_H

#include "base/arena.h"
#include "base/err.h"
#include "spec/program_spec.h"

/* programs_sheet: what the program at `path` declares (plan_options.program); `context` is not
 * used.
 *
 * Source (.c, .cc, .f90, ...) is compiled by this program's own cc, c++ or f90 with -O2 -g, unless
 * the cache ($XDG_CACHE_HOME/mimdsim or ~/.cache/mimdsim) holds what comes out of the same text,
 * headers, compiler and flags. What the compiler says goes to standard error. Images are taken as
 * they are.
 *
 *   Returns NULL with ERR_DATA (does not compile, declares nothing), ERR_NO_INPUT, ERR_CREATE. */
const struct program_sheet *programs_sheet(void *context, const char *path, struct arena *a,
                                           struct err *e);

#endif

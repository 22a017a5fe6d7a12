/* catalogue.h - what is built in, for those who may not see rooms kernel and sim. */
#ifndef RUN_CATALOGUE_H
#define RUN_CATALOGUE_H

#include "base/arena.h"
#include "base/err.h"
#include "spec/program_spec.h"

enum { CATALOGUE_MOST = 64 };

struct catalogue {
    int n;
    const char *name[CATALOGUE_MOST], *title[CATALOGUE_MOST];
};

/* catalogue_of_kernels: every kernel with its one-line title. */
struct catalogue catalogue_of_kernels(void);

/* run_sheet: what a person's own program declares, see guest_sheet (guest/guest_program.h). */
const struct program_sheet *run_sheet(const char *image, const char *path, const char *hash,
                                      struct arena *a, struct err *e);

/* run_fibers: how virtual processors are switched in this build: "fcontext" or "ucontext". */
const char *run_fibers(void);

#endif

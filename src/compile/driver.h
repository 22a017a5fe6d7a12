/* driver.h - `mimdsim cc`, `c++`, `f90`: gcc's command line, with counted blocks in between.
 *
 * To build systems it is gcc: the same options, files, messages and statuses. What differs: code is
 * compiled through block_filter, position-independent and without register r15; the link step makes
 * an image for the loader, with the archive of guest/, that starts itself on one virtual processor
 * when it is executed. */
#ifndef COMPILE_DRIVER_H
#define COMPILE_DRIVER_H

#include "base/err.h"

enum driver_language { DRIVER_C, DRIVER_CXX, DRIVER_FORTRAN };

/* Where our own files are: in the tree where the program was built, or where it is installed. */
struct driver_places {
    const char *program;       /* the mimdsim that an image starts itself with */
    const char *include;       /* folder that holds mimdsim/program.h */
    const char *include_built; /* folder of headers that the build makes, NULL: none */
    const char *library;       /* folder that holds libmimdsim-guest.a */
};

/* driver_run: compile or link as n words say that gcc could understand.
 *
 * gcc, g++ or gfortran do the work, or what MIMDSIM_CC, MIMDSIM_CXX, MIMDSIM_FC name. Returns the
 * exit status: gcc's when it failed, having said why; 0; or -1 with *e set: ERR_USAGE (an option
 * that cannot be), ERR_DATA (register r15 in use, an object that was not compiled by us),
 * ERR_UNAVAILABLE (no compiler, or not gcc), ERR_CREATE, ERR_INTERNAL. */
int driver_run(enum driver_language language, int n, const char *const *word,
               const struct driver_places *places, struct err *e);

#endif

/* guest_program.h - people's own programs as programs of runs: what they declare, and how their
 * ranks run.
 *
 * A program is an image made by `mimdsim cc` (room loader). One that declares itself by
 * mimdsim/program.h is a kernel: its parameters are set, its results are gathered, compared with
 * its serial code and its check, and its serial codes are run on one processor of the same machine.
 * One with main is an MPI program: it gets arguments, and its exit status is its answer. The images
 * run with all rights of the user. */
#ifndef GUEST_GUEST_PROGRAM_H
#define GUEST_GUEST_PROGRAM_H

#include "base/arena.h"
#include "base/err.h"
#include "program/program.h"
#include "spec/program_spec.h"

/* guest_sheet: what the program in file `image` declares, in `a`. No code of it runs.
 *
 *   path  in  the file that the user knows, for its name and for messages
 *   hash  in  what identifies it; "": the SHA-256 of the image
 *
 *   Returns NULL with ERR_DATA: no image, or a declaration that is not sound; ERR_NO_INPUT. */
const struct program_sheet *guest_sheet(const char *image, const char *path, const char *hash,
                                        struct arena *a, struct err *e);

/* guest_program: the program_type of a kind; NULL: built in, or a schedule. */
const struct program_type *guest_program(enum program_kind kind);

#endif

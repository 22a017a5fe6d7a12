/* start_text.h - the piece of assembly that lets an image be executed as a program. */
#ifndef COMPILE_START_TEXT_H
#define COMPILE_START_TEXT_H

#include <stdbool.h>

#include "base/text.h"

/* start_text: append assembly that makes a shared object executable: the name of the system's
 * dynamic linker, and the entry mimdsim_start, which becomes `PROGRAM mpirun -n 1 IMAGE ARGUMENTS`
 * (guest/start.c), so that what a build system compiles and executes to see what a computer can do
 * runs on a virtual processor.
 *
 *   program  path of mimdsim
 *   kernel   the image declares a kernel in one file and has no main; else main must be there */
void start_text(struct text *out, const char *program, bool kernel);

#endif

/* model_file.h - files that describe multibody systems, looked at without running: what is wrong,
 * what is left out. */
#ifndef STUDY_MODEL_FILE_H
#define STUDY_MODEL_FILE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/err.h"
#include "spec/run_spec.h"

/* model_file_is: whether `path` is a robot (its name ends in .urdf) or a reference vector (.json,
 * unless it is a scenario). */
bool model_file_is(const char *path);

/* model_file_check: read such a file and make its model, a robot's with a fixed base. What a
 * robot's file says but dynamics does not follow (mimic, transmission, ...) goes to `warnings` as
 * "file:line: text"; NULL: nowhere.
 *
 *   Returns false with ERR_NO_INPUT, ERR_IO or ERR_DATA, file and line. */
bool model_file_check(const char *path, FILE *warnings, struct err *e);

/* model_file_look: every robot file among n runs, each once, before anything runs, with warnings as
 * of model_file_check. Returns false for the first that cannot be read, as model_file_check. */
bool model_file_look(const struct run_spec *run, int n, FILE *warnings, struct err *e);

#endif

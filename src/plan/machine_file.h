/* machine_file.h - a machine from its file and the files it builds on, with where each value came
 * from. */
#ifndef PLAN_MACHINE_FILE_H
#define PLAN_MACHINE_FILE_H

#include "plan/plan.h"
#include "plan/setting.h"

/* A value as the files give it; `line` 0 and file "default": nobody did. */
struct machine_value {
    const char *text;
    const char *file;
    int line;
    const char *evidence, *source;
    const char *validate; /* of a published figure, NULL of others */
    double min, max;
};

struct machine_file {
    struct machine_spec spec;
    const char *path;            /* of the file named, not of its bases */
    struct machine_value *value; /* (machine_table.nfield) */
    int norigin;
    struct origin *origin; /* (norigin) once somebody asked for them (plan_origins), else NULL */
    int npublished;
    struct machine_published { /* published figures that no run uses */
        const char *name;
        struct machine_value value;
    } * published;
};

/* machine_file_read: machine `name` (see data_dir_find with `near`) complete: bases, defaults,
 * checks. Returns false with ERR_NO_INPUT, ERR_DATA or ERR_CONFIG. */
bool machine_file_read(struct machine_file *m, const char *name, const char *near, struct arena *a,
                       struct err *e);

/* machine_file_check: whether the values fit together: dimensions of the family, placement list,
 * rates. Returns false with ERR_CONFIG at `file`:`line`. */
bool machine_file_check(const struct machine_spec *m, const char *file, int line, struct err *e);

/* machine_file_blame: the place of an error whose text begins with the key of a setting, where a
 * file of m gives that. Returns the number of the field in machine_table, -1: it is about none. */
int machine_file_blame(const struct machine_file *m, struct err *e);

#endif

/* file_kind.h - what a name on the command line is, so that a mistaken one is answered with the
 * verb that takes it. */
#ifndef PLAN_FILE_KIND_H
#define PLAN_FILE_KIND_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"

enum file_kind {
    FILE_UNKNOWN,  /* nothing is there, or something else */
    FILE_SCENARIO, /* by its keys, or by its name in scenarios/ */
    FILE_MACHINE,
    FILE_DATABASE, /* of SQLite */
    FILE_ROBOT,    /* .urdf */
    FILE_CASES     /* .json: reference vectors, or cases of netcheck */
};

struct node;

/* file_kind_of_tree: FILE_SCENARIO or FILE_MACHINE by the keys of the tree `root`, NULL or neither:
 * FILE_UNKNOWN. */
enum file_kind file_kind_of_tree(const struct node *root);

/* file_kind_of: what `name` (a path, or the stem of a file in scenarios/ or machines/) is; `a` is
 * scratch. */
enum file_kind file_kind_of(const char *name, struct arena *a);

/* file_kind_refuse: where `name` is known to be something else than `wanted`, clear *e and set it
 * to ERR_USAGE: what it is, and which verb takes it. Returns true when it did. */
bool file_kind_refuse(const char *name, enum file_kind wanted, struct err *e);

#endif

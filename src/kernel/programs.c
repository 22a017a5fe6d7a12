/* programs.c - the built-in programs by name, from their list (spec/program_list.h). */
#include "kernel/programs.h"

#include <string.h>

#include "spec/program_list.h"

/* The list is one for settings, documentation and this table (spec/program_list.h). */
#define X(word, stem, traits) extern const struct program_type stem##_program;
PROGRAM_LIST(X)
#undef X

static const struct program_type *const programs[] = {
#define X(word, stem, traits) &stem##_program,
    PROGRAM_LIST(X)
#undef X
};

const struct program_type *const *program_list(int *n)
{
    *n = (int)(sizeof programs / sizeof *programs);
    return programs;
}

/* A table without an index: it is searched once a run. */
const struct program_type *program_find(const char *name)
{
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        if (strcmp(programs[i]->name, name) == 0) return programs[i];
    return NULL;
}

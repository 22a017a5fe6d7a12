/* outcome.h - how a command has ended and what it has left: its output, names and contents of the
 * files of its folder, rows of the databases there. */
#ifndef TESTS_FAULTS_OUTCOME_H
#define TESTS_FAULTS_OUTCOME_H

#include <stdbool.h>
#include <stddef.h>

enum { OUTCOME_FILES = 1024, OUTCOME_TEXT = 1 << 16 };

struct outcome {
    int status; /* of the shell: 128 and the signal; 124: it had to be ended */
    char out[OUTCOME_TEXT], err[OUTCOME_TEXT];
    char bad[256];            /* a database that is not whole, and why; empty: none */
    unsigned long long state; /* of the bytes of all files: equal, and the folders are the same */
    int nfile;                /* in the order of their names */
    struct outcome_file {
        char name[128];
        unsigned long long print; /* of the content; of databases: of the rows */
    } file[OUTCOME_FILES];
};

/* outcome_look: fill in what the working directory holds: files, state, bad. Logs of SQLite count
 * for `state` alone. Ends the process where it cannot be read. */
void outcome_look(struct outcome *o);

/* outcome_find: the print of file `name`; NULL when it is not there. */
const unsigned long long *outcome_find(const struct outcome *o, const char *name);

/* outcome_same: whether both have the same files with the same contents. */
bool outcome_same(const struct outcome *a, const struct outcome *b);

/* ends_in: whether a name has this end. */
bool ends_in(const char *name, const char *end);

/* die: "every: WHAT: " and what errno says; the process ends with status 2. */
_Noreturn void die(const char *what);

#endif

/* command.h - a command line of gcc, read as far as a driver around it must know it. */
#ifndef COMPILE_COMMAND_H
#define COMPILE_COMMAND_H

#include <stdbool.h>

#include "base/err.h"
#include "compile/words.h"

enum command_stage {
    COMMAND_PASS,     /* nothing is compiled to code: questions, -E, -M, -fsyntax-only, headers */
    COMMAND_ASSEMBLY, /* -S */
    COMMAND_OBJECT,   /* -c */
    COMMAND_LINK
};

struct command_source {
    const char *path;     /* "-": standard input */
    const char *language; /* of -x, NULL: by its name */
    bool assembly;        /* .s, .S: written by a person, or the output of -S */
    int place;            /* its word in `link` */
};

struct command {
    enum command_stage stage;
    const char *output; /* -o, NULL: none */
    struct words
        compile; /* options of every step but those of inputs, stages, -o and dependencies */
    struct words assemble; /* -Wa,... and -Xassembler */
    struct words link; /* options and inputs of the link step in their order, sources among them */
    struct words dependencies; /* -MD, -MF and the like */
    bool writes_dependencies, names_dependency_file, names_dependency_target;
    bool shared;      /* -shared */
    bool relocatable; /* -r */
    int nsource;
    struct command_source *source; /* (nsource) */
    const char *flags;             /* those that act on code, as one text for the object's note */
};

/* command_read: the words behind `mimdsim cc`, in `a`. Returns false with ERR_USAGE for an option
 * that cannot be (the message says why), and for -o with several outputs. */
bool command_read(struct command *c, int n, const char *const *word, struct arena *a,
                  struct err *e);

/* command_dependency_words: append what makes the compiler write source i's dependencies under the
 * name that it would use without a driver between: FILE.d beside the output, with the object as
 * target. */
void command_dependency_words(const struct command *c, int i, const char *object, struct words *w);

/* command_default_output: what a source's output is called without -o: its name without folders,
 * with `ending` ("o") for its own. In `a`. */
const char *command_default_output(const char *source, const char *ending, struct arena *a);

#endif

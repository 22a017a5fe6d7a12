/* program_spec.h - a person's own program: which file, with which arguments and parameters, and
 * what its computing costs.
 *
 * The settings of table `program` are the same for all programs. What one program declares besides
 * comes from its image (struct program_sheet), and its values travel as lines of text: they are
 * part of a run's configuration and identity as "program.NAME = VALUE", as settings are. */
#ifndef SPEC_PROGRAM_SPEC_H
#define SPEC_PROGRAM_SPEC_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/text.h"

struct field;

enum program_kind {
    PROGRAM_BUILT_IN, /* kernel.name says which */
    PROGRAM_KERNEL,   /* a program in one file, include/mimdsim/program.h */
    PROGRAM_MPI,      /* a program with main, that calls MPI or nothing */
    PROGRAM_SCHEDULE  /* a list of messages and computing times in the language GOAL */
};

enum program_cost {
    PROGRAM_COST_DECLARED, /* as the program declares: blocks, unless it says otherwise */
    PROGRAM_COST_BLOCKS,   /* executed blocks of machine code, as the compiler counted them */
    PROGRAM_COST_AUTHOR,   /* what the program states that it costs */
    PROGRAM_COST_HOST,     /* the time that this computer took: another one in every run */
    PROGRAM_COST_REAL      /* it takes its time, which nobody counts: no setting (run_order.real) */
};

/* What becomes of the lines that ranks write. */
enum program_output {
    PROGRAM_OUTPUT_KEEP, /* they are part of the result */
    PROGRAM_OUTPUT_SHOW, /* and are written at once to the streams of this process */
    PROGRAM_OUTPUT_LABEL /* likewise, each with its rank before it */
};

struct program_spec {
    char file[256];      /* as it was asked for; "": a built-in program */
    char arguments[512]; /* of an MPI program, divided as a shell divides words */
    enum program_cost cost;
    double factor; /* computing time is multiplied by it */
    int64_t working_set; /* what loops of a rank pass over again and again [B]; 0: the first cache
                            holds it */
    /* What the plan found; no settings. */
    enum program_kind kind;
    char hash[65];          /* SHA-256 of the image, or of source, compiler and flags; "": none */
    const char *parameters; /* "NAME = VALUE" lines in the order declared, borrowed; NULL: none */
    const char *image;      /* the file to be loaded, borrowed; NULL: not known */
};

enum { PROGRAM_HOST_LIMIT = 600 }; /* where run_order.host_limit is 0 [s] */

/* What a program declares, read from its image before any of its code runs. */
struct program_sheet {
    enum program_kind kind;
    char name[32];     /* for tables and figures */
    const char *title; /* one line for people, "" */
    const char *image; /* the file to be loaded */
    char hash[65];     /* as in program_spec */
    int nparameter;
    int nrank;         /* ranks that it is made for, 0: any number */
    const struct field *parameter; /* (nparameter) of kinds INT64, REAL, BOOL, CHOICE; offset 0 */
};

/* A value of such a parameter; field_set and field_print with base = this. */
union program_value {
    int64_t whole;
    double real;
    bool flag;
    int choice;
};

/* program_sheet_find: the parameter `name`, NULL: it declares none. */
const struct field *program_sheet_find(const struct program_sheet *p, const char *name);

/* program_parameter_text: `text` as a value of parameter `f` in its canonical form, in `a`; NULL
 * with a clause in `why` when it is none. */
const char *program_parameter_text(const struct field *f, const char *text, struct arena *a,
                                   char *why, int size);

/* program_value_find: what "NAME = VALUE" lines say of `name`: copied into buffer; false: nothing.
 */
bool program_value_find(const char *lines, const char *name, char *buffer, int size);

/* program_lines_add: one more "NAME = VALUE" line. */
void program_lines_add(struct text *lines, const char *name, const char *value);

/* program_lines_print: the lines with "program." before each, appended to *out; `lines` may be
 * NULL. */
void program_lines_print(const char *lines, struct text *out);

#endif

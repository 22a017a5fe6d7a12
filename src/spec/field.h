/* field.h - the settings of every spec struct as tables: one row serves reading, checking, defaults
 * and printing.
 *
 * A field is one setting: its key as written in files (`network.link.bandwidth`), where it lives in
 * its struct, its unit, range, default and one line of text. Values enter as text through field_set
 * and leave as text through field_print, which field_set reads back to the same bits. The tables of
 * all structs of a run are field_tables; the full key of a row is the table's prefix, a dot, and
 * the row's key. */
#ifndef SPEC_FIELD_H
#define SPEC_FIELD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/text.h"
#include "base/units.h"
#include "spec/run_spec.h"

enum field_kind {
    FIELD_REAL,      /* double, with `unit` */
    FIELD_INT,       /* int */
    FIELD_INT64,     /* int64_t; with unit UNIT_BYTES a size, "unlimited" is -1 where min is -1 */
    FIELD_SEED,      /* uint64_t, printed exactly */
    FIELD_BOOL,      /* bool */
    FIELD_CHOICE,    /* an enum counted from 0: `choice` names its values */
    FIELD_TEXT,      /* char[capacity] */
    FIELD_INTS,      /* int[capacity], number of entries in the int at offset `count` */
    FIELD_REALS,     /* double[capacity] */
    FIELD_INT_LIST,  /* int *, length in the int at offset `count`, borrowed from an arena */
    FIELD_PAIR_LIST, /* int (*)[2], as FIELD_INT_LIST */
    FIELD_SEGMENTS   /* struct software_segment[capacity], number of entries in the int at offset
                        `count` */
};

/* Why a setting cannot act in `run` (a clause), NULL when it acts. */
typedef const char *field_idle_fn(const struct run_spec *run);

struct field {
    const char *key; /* within its table, dots separate levels */
    enum field_kind kind;
    enum unit unit;            /* of reals and sizes */
    size_t offset;             /* in the table's struct */
    size_t count;              /* offset of the number of entries of a list, 0: none */
    /* of FIELD_TEXT (bytes), FIELD_INTS, FIELD_REALS, FIELD_SEGMENTS (entries) */
    int capacity;
    int at_least;              /* FIELD_REALS: entries that have to be given; the others are 0 */
    double min, max;           /* inclusive, of every entry, SI */
    const char *const *choice; /* NULL-terminated */
    const char *fallback;      /* default as text; NULL: has to be given */
    const char *doc;           /* one line for the manual */
    const char *zero; /* FIELD_REAL: the word for 0 where that is no small number: "unlimited",
                         which field_set takes as well as 0; NULL: 0 is a number */
    const char *instead; /* FIELD_REAL: what people read where a 0 stands for another setting, as
                            files and databases write it: "as a link"; NULL: it stands for none */
    field_idle_fn *idle;       /* NULL: acts in every run */
    bool (*valid)(const char *text, char *why,
                  int size);   /* FIELD_TEXT: whether it may be this, else a clause why not;
                                  NULL: any text may */
    bool label;                /* true: for people only, no part of a run's identity */
    /* whether the field cannot act in a struct at `base`, whatever its value: then it is no part of
     * the identity; NULL: it always is */
    bool (*dormant)(const void *base);
};

/* One struct of run_spec with its fields. */
struct field_table {
    const char *prefix; /* "machine", "" for the run's own settings */
    const char *doc;
    size_t offset; /* of the struct in run_spec */
    size_t size;   /* of the struct; identical bytes print identically */
    int nfield;
    const struct field *field;
};

/* field_tables: the tables in the order of a run's configuration: run, machine, model, kernel. *n
 * pointers. */
const struct field_table *const *field_tables(int *n);

/* field_find: row of `key` (without prefix) in `t`, or -1. */
int field_find(const struct field_table *t, const char *key);

/* field_find_full: the row of a full key ("machine.network.link.bandwidth"); NULL when there is
 * none. */
const struct field *field_find_full(const char *key, const struct field_table **table);

/* field_set: read `text` into its place in `base` (the table's struct).
 *
 *   a     memory of list fields
 *   why   on failure, buffer of `size` bytes with what was expected, as a clause; with the nearest
 * valid choice
 *
 *   Returns false on a missing or wrong unit, a number out of range or not finite, an unknown
 * choice. */
bool field_set(const struct field *f, void *base, const char *text, struct arena *a, char *why,
               int size);

/* field_defaults: every field of `t` that has a default gets it; the struct is zeroed first. */
void field_defaults(const struct field_table *t, void *base, struct arena *a);

/* field_print: the value as text that field_set reads back to the same bits, appended to *out. */
void field_print(const struct field *f, const void *base, struct text *out);

/* field_number: the number that the field holds in `base`, SI ("unlimited" is -1). False: its kind
 * has no number. */
bool field_number(const struct field *f, const void *base, double *number);

/* field_show: the same for people: a 0 that has a word is that word. Identities and databases keep
 * the number. field_is_wordless_zero: whether `text`, which field_set has taken to `base`, is a 0
 * that has a word. */
void field_show(const struct field *f, const void *base, struct text *out);
bool field_is_wordless_zero(const struct field *f, const void *base, const char *text);

/* field_word: `value`, a text of field f (NULL: unknown) in a file or a database, for people: a 0
 * that has a word, or stands for another setting, is that word. */
const char *field_word(const struct field *f, const char *value);

/* fields_print: "prefix.key = value" lines of one struct, in table order, appended; `labels`: with
 * the rows that are for people only. */
void fields_print(const struct field_table *t, const void *base, bool labels, struct text *out);

/* fields_config: all settings of a run, without labels and the repetition number. identity.h: what
 * identifies it. */
void fields_config(const struct run_spec *run, struct text *out);

/* fields_document: the reference manual of all settings, in Markdown. */
void fields_document(FILE *out);

#endif

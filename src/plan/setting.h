/* setting.h - one value for one key of a run, checked where it was written and applied to as many
 * runs as need it. */
#ifndef PLAN_SETTING_H
#define PLAN_SETTING_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"
#include "io/document.h"
#include "spec/field.h"

enum setting_kind {
    SETTING_FIELD,       /* a row of a field table */
    SETTING_MACHINE,     /* which machine file */
    SETTING_RANKS_ARE_N, /* ranks: n */
    SETTING_N_OVER_P,    /* bodies per rank */
    SETTING_PARAMETER    /* what a person's own program declares: checked by program_file_check */
};

struct setting {
    enum setting_kind kind;
    const char *key;           /* in full, short names resolved */
    const struct field *field; /* SETTING_FIELD, SETTING_PARAMETER once checked */
    const struct field_table *table;
    const char *text;
    int number;       /* SETTING_N_OVER_P */
    /* a second value that was written with the first: auto-tolerance 2%; or NULL */
    const struct setting *also;
    const char *file; /* a path or "--set" */
    int line;         /* 0: none */
};

struct setting_list {
    int n;
    struct setting *at; /* (n) in the order given */
};

enum { SETTING_MOST = 512 }; /* in one list */

/* setting_key: the full key of a short one: n, level, kernel, program; others as they are. */
const char *setting_key(const char *key);

/* setting_is_key: whether `key` (full) can be set. setting_is_group: whether keys below it can be
 * ("machine.network"). */
bool setting_is_key(const char *key);
bool setting_is_group(const char *key);

/* setting_takes_maps: whether the value of `key`, in full or as in machine files, is a list of
 * mappings. */
bool setting_takes_maps(const char *key);

/* setting_make: check `text` as the value of `key`; strings are borrowed. Returns false with
 * ERR_DATA, file and line. */
bool setting_make(struct setting *s, const char *key, const char *text, const char *file, int line,
                  struct arena *a, struct err *e);

/* setting_list_add: one more setting; a key may be given once in a list. Returns false with
 * ERR_DATA. */
bool setting_list_add(struct setting_list *list, const char *key, const char *text,
                      const char *file, int line, struct arena *a, struct err *e);

/* setting_zero_remark: say on standard error that a file's 0 is read as `word`. */
void setting_zero_remark(const char *key, const char *text, const char *word, const char *file,
                         int line);

/* setting_apply: put a field's value into *run; other kinds do nothing. */
void setting_apply(const struct setting *s, struct run_spec *run, struct arena *a);

/* setting_unknown: say that `key` in group `group` ("" at the top) is unknown, with the nearest
 * key. Returns false. */
bool setting_unknown(const char *group, const char *key, const char *file, int line, struct err *e);

/* Called for every value below a mapping with its full key. */
typedef bool setting_leaf_fn(void *context, const char *key, const struct node *leaf,
                             const char *file, struct arena *a, struct err *e);

/* setting_walk: visit every value below `mapping`, whose keys continue `prefix` ("machine");
 * unknown keys are refused. */
bool setting_walk(const struct node *mapping, const char *prefix, const char *file,
                  setting_leaf_fn *leaf, void *context, struct arena *a, struct err *e);

/* setting_value: the text of a value given plainly, as a list, or as {value: ...}; NULL with
 * ERR_DATA. */
const char *setting_value(const char *key, const struct node *leaf, const char *file,
                          struct arena *a, struct err *e);

#endif

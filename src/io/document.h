/* document.h - a JSON or YAML file as a tree of nodes that know their lines.
 *
 * One document of mappings, lists and scalars. JSON is read as the subset of YAML that it is.
 * Anchors, aliases, tags, several documents, duplicate keys and files beyond the limits are
 * refused, so that reading costs time and memory in proportion to the file. Two ways to read the
 * same tree:
 *
 *   data      files of programs: numbers are converted by strtod, so that a double written with 17
 *             digits comes back bit by bit; up to 512 MiB
 *   settings  files of people: every scalar stays the text that was written, units and all; the
 * root is a mapping; up to 4 MiB */
#ifndef IO_DOCUMENT_H
#define IO_DOCUMENT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"

/* The largest file of settings [B]. */
enum { DOCUMENT_MAX_SETTINGS = 4 << 20 };

enum node_kind { NODE_TEXT, NODE_NUMBER, NODE_NULL, NODE_LIST, NODE_MAP };

struct node {
    enum node_kind kind;
    int line;           /* 1-based; in a mapping that of the key */
    int count;          /* list, map: number of children */
    double number;      /* NODE_NUMBER */
    const char *text;   /* NODE_TEXT; settings: of every scalar */
    const char *key;    /* of a map's child; NULL elsewhere */
    struct node *child; /* list, map: the first child, in the file's order; NULL when empty */
    struct node *next;  /* the next child of the same parent */
};

/* document_read: the tree of the data file `path`, in arena `a`.
 *
 *   Returns NULL with ERR_NO_INPUT, ERR_IO or ERR_DATA (file and line): syntax, a repeated key,
 * more than 64 levels, 4096 keys in a mapping or 512 MiB. */
struct node *document_read(const char *path, struct arena *a, struct err *e);

/* document_read_settings: the same of a file of settings; at most 17 levels, 2000 keys in a
 * mapping, 400000 nodes, 4 MiB. document_parse_settings: from memory; `path` is what messages call
 * it. */
struct node *document_read_settings(const char *path, struct arena *a, struct err *e);
struct node *document_parse_settings(const char *data, size_t size, const char *path,
                                     struct arena *a, struct err *e);

/* document_find: the child of `map` called `key`, or NULL; also when `map` is NULL or no map. */
struct node *document_find(const struct node *map, const char *key);

/* document_need: as document_find, but a missing key is ERR_DATA at the map's line. */
const struct node *document_need(const struct node *map, const char *key, const char *path,
                                 struct err *e);

/* document_number: the finite number `key` of `map` into *x. Returns false with ERR_DATA. */
bool document_number(const struct node *map, const char *key, const char *path, double *x,
                     struct err *e);

/* document_numbers: the list `key` of exactly n finite numbers into x (n). Returns false with
 * ERR_DATA. */
bool document_numbers(const struct node *map, const char *key, const char *path, double *x, int n,
                      struct err *e);

/* document_count: how many numbers, or what stands in their place, the nested lists under `node`
 * hold. */
int64_t document_count(const struct node *node);

/* document_flat: all n numbers of the nested lists under `node`, in the order written, into x (n).
 * Returns false with ERR_DATA when there are more or fewer, or one is no finite number. */
bool document_flat(const struct node *node, const char *what, const char *path, double *x,
                   int64_t n, struct err *e);

/* document_integer: the integer `key` of `map` in lo .. hi into *i. Returns false with ERR_DATA. */
bool document_integer(const struct node *map, const char *key, const char *path, int lo, int hi,
                      int *i, struct err *e);

/* document_text: the text `key` of `map`, "" when it is missing or no text. */
const char *document_text(const struct node *map, const char *key);

/* document_flow: of settings: a scalar's text, or a list of scalars and lists as "[a, b, [c, d]]",
 * in `a`. When there is a mapping in it, returns NULL with ERR_DATA at its line; `key` and `file`
 * are what the message calls the place. */
const char *document_flow(const struct node *node, const char *key, const char *file,
                          struct arena *a, struct err *e);

/* document_flow_maps: the same of a list of mappings of scalars: "[{a: 1, b: 2}, {a: 3}]"; NULL for
 * others. */
const char *document_flow_maps(const struct node *node, struct arena *a);

#endif

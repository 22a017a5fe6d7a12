/* document.h - a JSON or YAML file as a tree of nodes that know their lines.
 *
 * JSON is read as the subset of YAML that it is, by libyaml. Numbers are converted by strtod, so that a double written
 * with 17 digits comes back bit by bit. Aliases, anchors and several documents are refused. */
#ifndef IO_DOCUMENT_H
#define IO_DOCUMENT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"

enum node_kind { NODE_NULL, NODE_NUMBER, NODE_TEXT, NODE_LIST, NODE_MAP };

struct node {
    enum node_kind kind;
    int line;           /* 1-based */
    int count;          /* list, map: number of children */
    double number;      /* NODE_NUMBER */
    const char *text;   /* NODE_TEXT */
    const char *key;    /* of a map's child; NULL elsewhere */
    struct node *child; /* list, map: the first child */
    struct node *next;  /* the next child of the same parent */
};

/* document_read: the tree of `path`, in arena `a`.
 *
 *   Returns NULL with ERR_NO_INPUT, ERR_IO or ERR_DATA (file and line): syntax, a repeated key, more than 64 levels,
 *   more than 512 MB. */
const struct node *document_read(const char *path, struct arena *a, struct err *e);

/* document_find: the child of `map` called `key`, or NULL; also when `map` is NULL or no map. */
const struct node *document_find(const struct node *map, const char *key);

/* document_need: as document_find, but a missing key is ERR_DATA at the map's line. */
const struct node *document_need(const struct node *map, const char *key, const char *path, struct err *e);

/* document_number: the finite number `key` of `map` into *x. Returns false with ERR_DATA. */
bool document_number(const struct node *map, const char *key, const char *path, double *x, struct err *e);

/* document_numbers: the list `key` of exactly n finite numbers into x (n). Returns false with ERR_DATA. */
bool document_numbers(const struct node *map, const char *key, const char *path, double *x, int n, struct err *e);

/* document_count: how many numbers, or what stands in their place, the nested lists under `node` hold. */
int64_t document_count(const struct node *node);

/* document_flat: all n numbers of the nested lists under `node`, in the order written, into x (n). Returns false with
 * ERR_DATA when there are more or fewer, or one is no finite number. */
bool document_flat(const struct node *node, const char *what, const char *path, double *x, int64_t n,
                   struct err *e);

/* document_integer: the integer `key` of `map` in lo .. hi into *i. Returns false with ERR_DATA. */
bool document_integer(const struct node *map, const char *key, const char *path, int lo, int hi, int *i, struct err *e);

/* document_text: the text `key` of `map`, "" when it is missing or no text. */
const char *document_text(const struct node *map, const char *key);

#endif

/* yaml_tree.h - a YAML file as a small tree with the line of every node.
 *
 * One document of mappings, sequences and plain or quoted scalars. Anchors, aliases, tags, several documents,
 * duplicate keys, and files beyond the limits are refused, so reading costs time and memory in proportion to the
 * file. JSON is read as the YAML that it is. */
#ifndef PLAN_YAML_TREE_H
#define PLAN_YAML_TREE_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/err.h"

enum { YAML_MAX_BYTES = 4 << 20, YAML_MAX_DEPTH = 16, YAML_MAX_NODES = 400000, YAML_MAX_KEYS = 2000 };

enum yaml_kind { YAML_SCALAR, YAML_SEQUENCE, YAML_MAPPING };

/* Children of a mapping or sequence are chained in the file's order. */
struct yaml_node {
    enum yaml_kind kind;
    int line;         /* of the key in a mapping, else of the value; 1-based */
    const char *key;  /* in a mapping, else NULL */
    const char *text; /* of a scalar; of others NULL */
    int nchild;
    struct yaml_node *child; /* first, NULL when empty */
    struct yaml_node *next;
};

/* yaml_tree_read: the file `path` as a tree in `a`. Returns NULL with ERR_NO_INPUT, ERR_IO or ERR_DATA with the line;
 * the root of a tree is always a mapping. */
struct yaml_node *yaml_tree_read(const char *path, struct arena *a, struct err *e);

/* yaml_tree_parse: the same from memory; `path` is what messages call it. */
struct yaml_node *yaml_tree_parse(const char *data, size_t size, const char *path, struct arena *a, struct err *e);

/* yaml_node_child: the entry `key` of a mapping, NULL when it is not there. */
struct yaml_node *yaml_node_child(const struct yaml_node *mapping, const char *key);

/* yaml_node_flow: a scalar's text, or a sequence of scalars and sequences as "[a, b, [c, d]]", in `a`. When there is a
 * mapping in it, returns NULL with ERR_DATA at its line; `key` and `file` are what the message calls the place. */
const char *yaml_node_flow(const struct yaml_node *node, const char *key, const char *file, struct arena *a,
                           struct err *e);

/* yaml_node_flow_maps: the same of a sequence of mappings of scalars: "[{a: 1, b: 2}, {a: 3}]"; NULL for others. */
const char *yaml_node_flow_maps(const struct yaml_node *node, struct arena *a);

#endif

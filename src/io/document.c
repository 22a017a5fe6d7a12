/* document.c - what is asked of a tree: entries by key, numbers in lists, texts in one line. */
#include "io/document.h"

#include <math.h>
#include <string.h>

#include "base/text.h"

/* In the order of the file: mappings have few keys, and messages and canonical texts need the
 * order. */
struct node *document_find(const struct node *map, const char *key)
{
    if (!map || map->kind != NODE_MAP) return NULL;
    for (struct node *c = map->child; c; c = c->next)
        if (c->key && strcmp(c->key, key) == 0) return c;
    return NULL;
}

/* A missing key has no line of its own: that of its mapping is where to write it. */
const struct node *document_need(const struct node *map, const char *key, const char *path,
                                 struct err *e)
{
    const struct node *found = document_find(map, key);
    if (!found) err_set_at(e, ERR_DATA, path, map ? map->line : 0, "'%s' is missing", key);
    return found;
}

/* As if it were the one entry of a list, so that the messages are the same; but [1] is a list. */
bool document_number(const struct node *map, const char *key, const char *path, double *x,
                     struct err *e)
{
    const struct node *node = document_need(map, key, path, e);
    if (!node) return false;
    if (node->kind == NODE_LIST)
        return err_set_at(e, ERR_DATA, path, node->line, "'%s' must be a number, not a list", key);
    return document_flat(node, key, path, x, 1, e);
}

/* Exactly n: what is too long is as wrong as what is too short. */
bool document_numbers(const struct node *map, const char *key, const char *path, double *x, int n,
                      struct err *e)
{
    const struct node *node = document_need(map, key, path, e);
    if (!node) return false;
    if (node->kind != NODE_LIST || node->count != n)
        return err_set_at(e, ERR_DATA, path, node->line,
                          "'%s' must be a list of %d numbers; it has %d", key, n,
                          node->kind == NODE_LIST ? node->count : 0);
    /* lists among the entries could make up for each other: [[1, 2], []] has two of both */
    for (const struct node *c = node->child; c; c = c->next)
        if (c->kind == NODE_LIST)
            return err_set_at(e, ERR_DATA, path, c->line, "'%s' must hold numbers, not lists", key);
    /* n entries may still be texts */
    return document_flat(node, key, path, x, n, e);
}

/* Depth first over the nested lists; *filled counts the numbers met so far. */
static bool flat_take(const struct node *node, const char *what, const char *path, double *x,
                      int64_t n, int64_t *filled, struct err *e)
{
    /* a matrix is a list of lists in files, and one piece of memory here */
    if (node->kind == NODE_LIST) {
        for (const struct node *c = node->child; c; c = c->next)
            if (!flat_take(c, what, path, x, n, filled, e)) return false;
        return true;
    }
    /* .inf and .nan are numbers of YAML */
    if (node->kind != NODE_NUMBER || !isfinite(node->number))
        return err_set_at(e, ERR_DATA, path, node->line, "'%s' must hold finite numbers", what);
    /* checked before it is written: x has room for n */
    if (*filled == n)
        return err_set_at(e, ERR_DATA, path, node->line,
                          "'%s' has more than the %lld numbers expected", what, (long long)n);
    x[(*filled)++] = node->number;
    return true;
}

/* Whoever does not know the size asks first and takes memory for it. */
int64_t document_count(const struct node *node)
{
    /* what is no list counts, too, so that a wrong entry is found when the numbers are taken */
    int64_t n = 0;
    if (node->kind != NODE_LIST) return 1;
    for (const struct node *c = node->child; c; c = c->next) n += document_count(c);
    return n;
}

/* All of them or none: a file with too few is refused at the line of the list. */
bool document_flat(const struct node *node, const char *what, const char *path, double *x,
                   int64_t n, struct err *e)
{
    int64_t filled = 0;
    if (!flat_take(node, what, path, x, n, &filled, e)) return false;
    if (filled < n)
        return err_set_at(e, ERR_DATA, path, node->line,
                          "'%s' has %lld of the %lld numbers expected", what, (long long)filled,
                          (long long)n);
    return true;
}

/* Files of programs write integers as 3, 3.0 or 3e0: all are the same number. */
bool document_integer(const struct node *map, const char *key, const char *path, int lo, int hi,
                      int *i, struct err *e)
{
    /* a fraction or an overflow is refused with the number itself, as it was read */
    double x;
    const struct node *at = document_find(map, key);
    if (!document_number(map, key, path, &x, e) || at == NULL) return false;
    if (x < lo || x > hi || x != floor(x))
        return err_set_at(e, ERR_DATA, path, at->line,
                          "'%s' must be an integer from %d to %d, not %g", key, lo, hi, x);
    *i = (int)x;
    return true;
}

/* For texts that may be missing; those that must be there go through document_need. */
const char *document_text(const struct node *map, const char *key)
{
    const struct node *node = document_find(map, key);
    return node && node->kind == NODE_TEXT ? node->text : "";
}

/* The text of `node` onto *out; the mapping that stands in the way, or NULL. */
static const struct node *add_flow(const struct node *node, struct text *out)
{
    if (node->kind == NODE_MAP) return node;
    /* as it was written: quotes are lost, which no value of ours needs */
    if (node->kind == NODE_TEXT) return text_add(out, "%s", node->text), NULL;
    /* in flow style on one line, as a canonical configuration has it */
    text_add(out, "[");
    for (const struct node *n = node->child; n != NULL; n = n->next) {
        if (n != node->child) text_add(out, ", ");
        const struct node *mapping = add_flow(n, out);
        if (mapping != NULL) return mapping;
    }
    text_add(out, "]");
    return NULL;
}

const char *document_flow(const struct node *node, const char *key, const char *file,
                          struct arena *a, struct err *e)
{
    /* most values are single: no copy of them */
    if (node->kind == NODE_TEXT) return node->text;
    struct text t = {0};
    const struct node *mapping = add_flow(node, &t);
    const char *flow = mapping == NULL ? arena_text(a, t.s) : NULL;
    if (mapping != NULL)
        err_set_at(e, ERR_DATA, file, mapping->line,
                   "%s: a mapping '{%.80s: ...}' where a value is expected", key,
                   mapping->child != NULL ? mapping->child->key : "");
    text_free(&t);
    return flow;
}

/* A mapping of scalars onto *out; false for any other node, with part of it written. */
static bool add_flow_map(const struct node *map, struct text *out)
{
    if (map->kind != NODE_MAP) return false;
    /* "{a: 1, b: 2}" */
    text_add(out, "{");
    for (const struct node *n = map->child; n != NULL; n = n->next) {
        if (n->kind != NODE_TEXT) return false;
        text_add(out, "%s%s: %s", n != map->child ? ", " : "", n->key, n->text);
    }
    text_add(out, "}");
    return true;
}

const char *document_flow_maps(const struct node *node, struct arena *a)
{
    /* segments of message software and links of a graph are written like this */
    struct text t = {0};
    bool fine = node->kind == NODE_LIST;
    /* a mapping inside one of them, or a list, is none of a segment's values */
    text_add(&t, "[");
    for (const struct node *n = fine ? node->child : NULL; n != NULL && fine; n = n->next) {
        if (n != node->child) text_add(&t, ", ");
        fine = add_flow_map(n, &t);
    }
    text_add(&t, "]");
    const char *flow = fine ? arena_text(a, t.s) : NULL;
    text_free(&t);
    return flow;
}

/* document.c - a JSON or YAML file as a tree, from libyaml's events.
 *
 * One pass with a stack of open lists and maps; nodes are taken from the arena in slabs, as a reference vector of a
 * thousand bodies has a hundred thousand of them. */
#include "io/document.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#include "base/text.h"

enum { MAX_DEPTH = 64, MAX_KEYS = 4096, SLAB = 512, MAX_BYTES = 512 * 1024 * 1024 };

struct level {
    struct node *node;
    struct node *last;  /* child read last */
    const char *key;    /* map: key whose value comes next, NULL: a key comes next */
};

struct builder {
    const char *path;
    struct arena *arena;
    struct err *e;
    struct node *slab;
    int nfree;          /* nodes left in the slab */
    struct node *root;
    struct level level[MAX_DEPTH];
    int depth;
};

static struct node *node_take(struct builder *b, enum node_kind kind, int line)
{
    if (b->nfree == 0) {
        b->slab = TAKE(b->arena, SLAB, struct node);
        b->nfree = SLAB;
    }
    struct node *node = &b->slab[SLAB - b->nfree--];
    node->kind = kind;
    node->line = line;
    return node;
}

static bool node_add(struct builder *b, struct node *node)
{
    if (b->depth == 0) {
        if (b->root) return err_set_at(b->e, ERR_DATA, b->path, node->line, "more than one document in the file");
        b->root = node;
        return true;
    }
    struct level *top = &b->level[b->depth - 1];
    node->key = top->key;
    top->key = NULL;
    if (top->last)
        top->last->next = node;
    else
        top->node->child = node;
    top->last = node;
    top->node->count++;
    return true;
}

static bool node_open(struct builder *b, enum node_kind kind, int line)
{
    struct node *node = node_take(b, kind, line);
    if (!node_add(b, node)) return false;
    if (b->depth == MAX_DEPTH)
        return err_set_at(b->e, ERR_DATA, b->path, line, "nested deeper than %d levels", MAX_DEPTH);
    b->level[b->depth++] = (struct level){.node = node};
    return true;
}

static bool is_null(const char *s) { return s[0] == 0 || strcmp(s, "null") == 0 || strcmp(s, "~") == 0; }

/* A scalar is a key, a number, null or text. */
static bool scalar_add(struct builder *b, const yaml_event_t *event, int line)
{
    const char *s = (const char *)event->data.scalar.value;
    struct level *top = b->depth > 0 ? &b->level[b->depth - 1] : NULL;
    if (strlen(s) != event->data.scalar.length)
        return err_set_at(b->e, ERR_DATA, b->path, line, "a zero byte inside a text");
    if (top && top->node->kind == NODE_MAP && !top->key) {
        if (top->node->count == MAX_KEYS)
            return err_set_at(b->e, ERR_DATA, b->path, line, "more than %d keys in one map", MAX_KEYS);
        if (document_find(top->node, s))
            return err_set_at(b->e, ERR_DATA, b->path, line, "the key '%.80s' is given twice", s);
        top->key = arena_text(b->arena, s);
        return true;
    }
    bool plain = event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    struct node *node = node_take(b, NODE_TEXT, line);
    if (plain && is_null(s)) {
        node->kind = NODE_NULL;
    } else {
        char *end;
        double x = plain ? strtod(s, &end) : 0;
        if (plain && end != s && *end == 0) {
            node->kind = NODE_NUMBER;
            node->number = x;
        }
        node->text = node->kind == NODE_TEXT ? arena_text(b->arena, s) : NULL;
    }
    return node_add(b, node);
}

static bool event_take(struct builder *b, const yaml_event_t *event)
{
    int line = (int)event->start_mark.line + 1;
    struct level *top = b->depth > 0 ? &b->level[b->depth - 1] : NULL;
    bool opens = event->type == YAML_SEQUENCE_START_EVENT || event->type == YAML_MAPPING_START_EVENT;
    if (opens && top && top->node->kind == NODE_MAP && !top->key)
        return err_set_at(b->e, ERR_DATA, b->path, line, "a list or map cannot be a key");
    switch (event->type) {
    case YAML_ALIAS_EVENT: return err_set_at(b->e, ERR_DATA, b->path, line, "aliases (*name) are not accepted");
    case YAML_SCALAR_EVENT: return scalar_add(b, event, line);
    case YAML_SEQUENCE_START_EVENT: return node_open(b, NODE_LIST, line);
    case YAML_MAPPING_START_EVENT: return node_open(b, NODE_MAP, line);
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT: b->depth--; return true;
    default: return true;
    }
}

static bool events_read(struct builder *b, yaml_parser_t *parser)
{
    bool good = true, more = true;
    while (good && more) {
        yaml_event_t event;
        if (!yaml_parser_parse(parser, &event))
            return err_set_at(b->e, ERR_DATA, b->path, (int)parser->problem_mark.line + 1, "%s",
                              parser->problem ? parser->problem : "not a JSON or YAML file");
        more = event.type != YAML_STREAM_END_EVENT;
        good = event_take(b, &event);
        yaml_event_delete(&event);
    }
    return good;
}

const struct node *document_read(const char *path, struct arena *a, struct err *e)
{
    struct text text = {0};
    struct builder b = {.path = path, .arena = a, .e = e};
    yaml_parser_t parser;
    if (!text_read_file(&text, path, e)) return NULL;
    bool good = text.length <= MAX_BYTES || err_set_at(e, ERR_DATA, path, 0, "larger than %d bytes", MAX_BYTES);
    if (good && !yaml_parser_initialize(&parser)) {
        good = err_set(e, ERR_INTERNAL, "no memory for the YAML reader");
    } else if (good) {
        yaml_parser_set_input_string(&parser, (const unsigned char *)(text.s ? text.s : ""), text.length);
        yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
        good = events_read(&b, &parser);
        yaml_parser_delete(&parser);
    }
    if (good && !b.root) good = err_set_at(e, ERR_DATA, path, 1, "the file is empty");
    text_free(&text);
    return good ? b.root : NULL;
}

const struct node *document_find(const struct node *map, const char *key)
{
    if (!map || map->kind != NODE_MAP) return NULL;
    for (const struct node *c = map->child; c; c = c->next)
        if (strcmp(c->key, key) == 0) return c;
    return NULL;
}

const struct node *document_need(const struct node *map, const char *key, const char *path, struct err *e)
{
    const struct node *found = document_find(map, key);
    if (!found) err_set_at(e, ERR_DATA, path, map ? map->line : 0, "'%s' is missing", key);
    return found;
}

bool document_number(const struct node *map, const char *key, const char *path, double *x, struct err *e)
{
    const struct node *node = document_need(map, key, path, e);
    return node && document_flat(node, key, path, x, 1, e);
}

bool document_numbers(const struct node *map, const char *key, const char *path, double *x, int n, struct err *e)
{
    const struct node *node = document_need(map, key, path, e);
    if (!node) return false;
    if (node->kind != NODE_LIST || node->count != n)
        return err_set_at(e, ERR_DATA, path, node->line, "'%s' must be a list of %d numbers; it has %d", key, n,
                          node->kind == NODE_LIST ? node->count : 0);
    return document_flat(node, key, path, x, n, e);
}

/* Depth first over the nested lists; *filled counts the numbers met so far. */
static bool flat_take(const struct node *node, const char *what, const char *path, double *x, int64_t n,
                      int64_t *filled, struct err *e)
{
    if (node->kind == NODE_LIST) {
        for (const struct node *c = node->child; c; c = c->next)
            if (!flat_take(c, what, path, x, n, filled, e)) return false;
        return true;
    }
    if (node->kind != NODE_NUMBER || !isfinite(node->number))
        return err_set_at(e, ERR_DATA, path, node->line, "'%s' must hold finite numbers", what);
    if (*filled == n)
        return err_set_at(e, ERR_DATA, path, node->line, "'%s' has more than the %lld numbers expected",
                          what, (long long)n);
    x[(*filled)++] = node->number;
    return true;
}

int64_t document_count(const struct node *node)
{
    int64_t n = 0;
    if (node->kind != NODE_LIST) return 1;
    for (const struct node *c = node->child; c; c = c->next) n += document_count(c);
    return n;
}

bool document_flat(const struct node *node, const char *what, const char *path, double *x, int64_t n,
                   struct err *e)
{
    int64_t filled = 0;
    if (!flat_take(node, what, path, x, n, &filled, e)) return false;
    if (filled < n)
        return err_set_at(e, ERR_DATA, path, node->line, "'%s' has %lld of the %lld numbers expected", what,
                          (long long)filled, (long long)n);
    return true;
}

bool document_integer(const struct node *map, const char *key, const char *path, int lo, int hi, int *i, struct err *e)
{
    double x;
    if (!document_number(map, key, path, &x, e)) return false;
    if (x < lo || x > hi || x != floor(x))
        return err_set_at(e, ERR_DATA, path, document_find(map, key)->line,
                          "'%s' must be an integer from %d to %d, not %g", key, lo, hi, x);
    *i = (int)x;
    return true;
}

const char *document_text(const struct node *map, const char *key)
{
    const struct node *node = document_find(map, key);
    return node && node->kind == NODE_TEXT ? node->text : "";
}

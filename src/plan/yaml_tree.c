/* yaml_tree.c - libyaml's events put together as a tree, with every limit checked while it grows. */
#include "plan/yaml_tree.h"

#include <string.h>
#include <sys/stat.h>
#include <yaml.h>

#include "base/text.h"

struct builder {
    yaml_parser_t parser;
    const char *path;
    struct arena *arena;
    struct err *err;
    int nnode;
};

static bool refuse(struct builder *b, size_t line, const char *what)
{
    return err_set_at(b->err, ERR_DATA, b->path, (int)line + 1, "%s", what);
}

/* libyaml's own complaint with the line where it arose. */
static bool refuse_syntax(struct builder *b)
{
    const yaml_parser_t *p = &b->parser;
    const char *problem = p->problem != NULL ? p->problem : "cannot be read";
    if (p->error == YAML_MEMORY_ERROR) return err_set(b->err, ERR_INTERNAL, "out of memory reading %s", b->path);
    if (p->error == YAML_READER_ERROR) return refuse(b, p->mark.line, "not YAML: not a text file in UTF-8");
    return err_set_at(b->err, ERR_DATA, b->path, (int)p->problem_mark.line + 1, "not YAML: %s%s%s", problem,
                      p->context != NULL ? " " : "", p->context != NULL ? p->context : "");
}

static bool next_event(struct builder *b, yaml_event_t *event)
{
    if (!yaml_parser_parse(&b->parser, event)) return refuse_syntax(b);
    return true;
}

/* Anchors and tags of any node; a tag such as !!int would change what a plain reader sees. */
static bool check_plain(struct builder *b, const yaml_event_t *event)
{
    const yaml_char_t *anchor = NULL, *tag = NULL;
    if (event->type == YAML_ALIAS_EVENT) return refuse(b, event->start_mark.line, "aliases (*name) are not allowed");
    if (event->type == YAML_SCALAR_EVENT) anchor = event->data.scalar.anchor, tag = event->data.scalar.tag;
    if (event->type == YAML_SEQUENCE_START_EVENT)
        anchor = event->data.sequence_start.anchor, tag = event->data.sequence_start.tag;
    if (event->type == YAML_MAPPING_START_EVENT)
        anchor = event->data.mapping_start.anchor, tag = event->data.mapping_start.tag;
    if (anchor != NULL) return refuse(b, event->start_mark.line, "anchors (&name) are not allowed");
    if (tag != NULL) return refuse(b, event->start_mark.line, "tags (!name) are not allowed");
    return true;
}

static struct yaml_node *build(struct builder *b, yaml_event_t *event, int depth);

static struct yaml_node *node_make(struct builder *b, enum yaml_kind kind, size_t line)
{
    if (++b->nnode > YAML_MAX_NODES) return refuse(b, line, "too many entries"), NULL;
    struct yaml_node *n = TAKE(b->arena, 1, struct yaml_node);
    n->kind = kind;
    n->line = (int)line + 1;
    return n;
}

static struct yaml_node *build_scalar(struct builder *b, const yaml_event_t *event)
{
    const char *value = (const char *)event->data.scalar.value;
    if (strlen(value) != event->data.scalar.length)
        return refuse(b, event->start_mark.line, "a zero byte in a text"), NULL;
    struct yaml_node *n = node_make(b, YAML_SCALAR, event->start_mark.line);
    if (n != NULL) n->text = arena_text(b->arena, value);
    return n;
}

/* The key of the next entry of a mapping, into *key; *key stays NULL at its end. */
static bool take_key(struct builder *b, const struct yaml_node *mapping, const char **key, int *line)
{
    yaml_event_t event;
    bool fine;
    *key = NULL;
    if (!next_event(b, &event)) return false;
    *line = (int)event.start_mark.line + 1;
    fine = check_plain(b, &event);
    if (fine && event.type == YAML_SCALAR_EVENT) *key = arena_text(b->arena, (const char *)event.data.scalar.value);
    else if (fine && event.type != YAML_MAPPING_END_EVENT)
        fine = refuse(b, event.start_mark.line, "a key has to be a name");
    yaml_event_delete(&event);
    if (!fine || *key == NULL) return fine;
    struct yaml_node *twin = yaml_node_child(mapping, *key);
    if (twin != NULL)
        return err_set_at(b->err, ERR_DATA, b->path, *line, "duplicate key '%s'; first given in line %d", *key,
                          twin->line);
    return mapping->nchild < YAML_MAX_KEYS || refuse(b, (size_t)*line - 1, "too many keys");
}

/* Take the next child off the events; NULL at the end of the collection or, with the error set, on failure. */
static struct yaml_node *take_child(struct builder *b, const struct yaml_node *parent, int depth)
{
    const char *key = NULL;
    int key_line = 0;
    yaml_event_t event;
    if (parent->kind == YAML_MAPPING && (!take_key(b, parent, &key, &key_line) || key == NULL)) return NULL;
    if (!next_event(b, &event)) return NULL;
    struct yaml_node *child = NULL;
    if (event.type == YAML_SEQUENCE_END_EVENT) yaml_event_delete(&event);
    else child = build(b, &event, depth + 1);
    if (child == NULL || key == NULL) return child;
    child->key = key;
    child->line = key_line;
    return child;
}

/* Build the node that `event` opens; the event is given back. NULL on failure. */
static struct yaml_node *build(struct builder *b, yaml_event_t *event, int depth)
{
    struct yaml_node *n = NULL, *child, **tail;
    size_t line = event->start_mark.line;
    yaml_event_type_t type = event->type;
    if (check_plain(b, event))
        n = type == YAML_SCALAR_EVENT
                ? build_scalar(b, event)
                : node_make(b, type == YAML_MAPPING_START_EVENT ? YAML_MAPPING : YAML_SEQUENCE, line);
    yaml_event_delete(event);
    if (n == NULL || type == YAML_SCALAR_EVENT) return n;
    if (depth > YAML_MAX_DEPTH) return refuse(b, line, "nested too deeply"), NULL;
    tail = &n->child;
    while ((child = take_child(b, n, depth)) != NULL) {
        *tail = child;
        tail = &child->next;
        n->nchild++;
    }
    return b->err->kind == ERR_NONE ? n : NULL;
}

/* Pass stream and document starts, build the root, and see that nothing follows. */
static struct yaml_node *build_document(struct builder *b)
{
    yaml_event_t event;
    struct yaml_node *root = NULL;
    for (;;) {
        if (!next_event(b, &event)) return NULL;
        if (event.type != YAML_STREAM_START_EVENT && event.type != YAML_DOCUMENT_START_EVENT) break;
        yaml_event_delete(&event);
    }
    if (event.type == YAML_STREAM_END_EVENT) {
        yaml_event_delete(&event);
        return refuse(b, 0, "the file is empty; expected 'key: value' lines"), NULL;
    }
    root = build(b, &event, 0);
    if (root == NULL) return NULL;
    if (root->kind != YAML_MAPPING) return refuse(b, (size_t)root->line - 1, "expected 'key: value' lines"), NULL;
    for (int i = 0; i < 2; i++) { /* end of document, end of stream */
        if (!next_event(b, &event)) return NULL;
        yaml_event_type_t type = event.type;
        size_t line = event.start_mark.line;
        yaml_event_delete(&event);
        if (type == YAML_DOCUMENT_START_EVENT) return refuse(b, line, "a second document in one file"), NULL;
    }
    return root;
}

struct yaml_node *yaml_tree_parse(const char *data, size_t size, const char *path, struct arena *a, struct err *e)
{
    struct builder b = {.path = path, .arena = a, .err = e};
    if (size > YAML_MAX_BYTES) {
        err_set_at(e, ERR_DATA, path, 0, "larger than %d MiB; not a scenario or machine", YAML_MAX_BYTES >> 20);
        return NULL;
    }
    if (!yaml_parser_initialize(&b.parser)) {
        err_set(e, ERR_INTERNAL, "out of memory reading %s", path);
        return NULL;
    }
    yaml_parser_set_encoding(&b.parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&b.parser, (const unsigned char *)data, size);
    struct yaml_node *root = build_document(&b);
    yaml_parser_delete(&b.parser);
    return root;
}

struct yaml_node *yaml_tree_read(const char *path, struct arena *a, struct err *e)
{
    struct text file = {0};
    struct yaml_node *root = NULL;
    struct stat st;
    bool there = stat(path, &st) == 0;
    if (there && S_ISDIR(st.st_mode)) {
        err_set_at(e, ERR_DATA, path, 0, "a folder, not a file");
        return NULL;
    }
    if (there && (S_ISCHR(st.st_mode) || st.st_size > YAML_MAX_BYTES)) {
        err_set_at(e, ERR_DATA, path, 0, "not a text file of at most %d MiB", YAML_MAX_BYTES >> 20);
        return NULL;
    }
    if (text_read_file(&file, path, e)) root = yaml_tree_parse(file.s, file.length, path, a, e);
    text_free(&file);
    return root;
}

struct yaml_node *yaml_node_child(const struct yaml_node *mapping, const char *key)
{
    for (struct yaml_node *n = mapping->child; n != NULL; n = n->next)
        if (n->key != NULL && strcmp(n->key, key) == 0) return n;
    return NULL;
}

/* The text of `node` onto *out; the mapping that stands in the way, or NULL. */
static const struct yaml_node *add_flow(const struct yaml_node *node, struct text *out)
{
    if (node->kind == YAML_MAPPING) return node;
    if (node->kind == YAML_SCALAR) return text_add(out, "%s", node->text), NULL;
    text_add(out, "[");
    for (const struct yaml_node *n = node->child; n != NULL; n = n->next) {
        if (n != node->child) text_add(out, ", ");
        const struct yaml_node *mapping = add_flow(n, out);
        if (mapping != NULL) return mapping;
    }
    text_add(out, "]");
    return NULL;
}

const char *yaml_node_flow(const struct yaml_node *node, const char *key, const char *file, struct arena *a,
                           struct err *e)
{
    if (node->kind == YAML_SCALAR) return node->text;
    struct text t = {0};
    const struct yaml_node *mapping = add_flow(node, &t);
    const char *flow = mapping == NULL ? arena_text(a, t.s) : NULL;
    if (mapping != NULL)
        err_set_at(e, ERR_DATA, file, mapping->line, "%s: a mapping '{%.80s: ...}' where a value is expected", key,
                   mapping->child != NULL ? mapping->child->key : "");
    text_free(&t);
    return flow;
}

static bool add_flow_map(const struct yaml_node *map, struct text *out)
{
    if (map->kind != YAML_MAPPING) return false;
    text_add(out, "{");
    for (const struct yaml_node *n = map->child; n != NULL; n = n->next) {
        if (n->kind != YAML_SCALAR) return false;
        text_add(out, "%s%s: %s", n != map->child ? ", " : "", n->key, n->text);
    }
    text_add(out, "}");
    return true;
}

const char *yaml_node_flow_maps(const struct yaml_node *node, struct arena *a)
{
    struct text t = {0};
    bool fine = node->kind == YAML_SEQUENCE;
    text_add(&t, "[");
    for (const struct yaml_node *n = fine ? node->child : NULL; n != NULL && fine; n = n->next) {
        if (n != node->child) text_add(&t, ", ");
        fine = add_flow_map(n, &t);
    }
    text_add(&t, "]");
    const char *flow = fine ? arena_text(a, t.s) : NULL;
    text_free(&t);
    return flow;
}

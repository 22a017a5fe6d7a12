/* document_read.c - a tree out of libyaml's events, every limit checked while it grows.
 *
 * One pass with a stack of open lists and maps, so that no file nests deeper than our own stack;
 * nodes are taken from the arena in slabs, since a reference vector of a thousand bodies has a
 * hundred thousand of them. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <yaml.h>

#include "base/text.h"
#include "io/document.h"

enum { MIB = 1 << 20, MAX_LEVELS = 64, SLAB = 512 };

/* The two ways to read (document.h). */
struct form {
    const char *expected; /* what a message says that the file is not */
    bool settings;
    size_t bytes;
    int levels, keys, nodes;
};
static const struct form data_form = {"JSON or YAML", false, 512u * MIB,
                                      MAX_LEVELS,     4096,  INT32_MAX};
static const struct form settings_form = {"YAML", true, DOCUMENT_MAX_SETTINGS, 17, 2000, 400000};

/* An open list or map. */
struct level {
    struct node *node;
    struct node *last; /* child read last */
    const char *key;   /* map: key whose value comes next, NULL: a key comes next */
    int line;          /* of that key */
};

struct builder {
    const struct form *form;
    const char *path, *data; /* the file and its text (size bytes) */
    size_t size;
    struct arena *arena;
    struct err *e;
    struct node *slab;
    int nfree; /* nodes left in the slab */
    int nnode;
    struct node *root;
    struct level level[MAX_LEVELS];
    int depth;
};

static bool refuse(struct builder *b, int line, const char *what)
{
    return err_set_at(b->e, ERR_DATA, b->path, line, "%s", what);
}

/* The line of a byte of the file. libyaml reads ahead: where it stands in a line is not where a
 * wrong byte is. */
static int line_at(const struct builder *b, size_t offset)
{
    int line = 1;
    for (size_t i = 0; i < offset && i < b->size; i++) line += b->data[i] == '\n';
    return line;
}

/* libyaml's own complaint, with the line where it arose. */
static bool refuse_syntax(struct builder *b, const yaml_parser_t *p)
{
    const char *problem = p->problem ? p->problem : "cannot be read";
    if (p->error == YAML_MEMORY_ERROR)
        return err_set(b->e, ERR_INTERNAL, "out of memory reading %s", b->path);
    /* a reader's error has no problem_mark: what is wrong are bytes, not the structure */
    if (p->error == YAML_READER_ERROR)
        return err_set_at(b->e, ERR_DATA, b->path, line_at(b, p->problem_offset),
                          "not %s: not a text file in UTF-8", b->form->expected);
    return err_set_at(b->e, ERR_DATA, b->path, (int)p->problem_mark.line + 1, "not %s: %s%s%s",
                      b->form->expected, problem, p->context ? " " : "",
                      p->context ? p->context : "");
}

/* Anchors and tags of any node: a tag such as !!int would change what a plain reader sees. */
static bool check_plain(struct builder *b, const yaml_event_t *event, int line)
{
    const yaml_char_t *anchor = NULL, *tag = NULL;
    /* libyaml keeps them in a member of their own for each kind of event */
    switch (event->type) {
    case YAML_ALIAS_EVENT:
        return refuse(b, line, "aliases (*name) are not allowed");
    case YAML_SCALAR_EVENT:
        anchor = event->data.scalar.anchor, tag = event->data.scalar.tag;
        break;
    case YAML_SEQUENCE_START_EVENT:
        anchor = event->data.sequence_start.anchor, tag = event->data.sequence_start.tag;
        break;
    case YAML_MAPPING_START_EVENT:
        anchor = event->data.mapping_start.anchor, tag = event->data.mapping_start.tag;
        break;
    default:
        return true;
    }
    if (anchor) return refuse(b, line, "anchors (&name) are not allowed");
    return !tag || refuse(b, line, "tags (!name) are not allowed");
}

static struct node *node_take(struct builder *b, enum node_kind kind, int line)
{
    /* people's files are small; what is not was made to exhaust memory */
    if (++b->nnode > b->form->nodes) {
        refuse(b, line, "too many entries");
        return NULL;
    }
    /* the arena aligns and counts every piece: a slab costs that once for all of its nodes */
    if (b->nfree == 0) {
        b->slab = TAKE(b->arena, SLAB, struct node);
        b->nfree = SLAB;
    }
    struct node *node = &b->slab[SLAB - b->nfree--];
    node->kind = kind;
    node->line = line;
    return node;
}

/* The list or map that is open, NULL outside the root. */
static struct level *top_of(struct builder *b)
{
    return b->depth > 0 ? &b->level[b->depth - 1] : NULL;
}

/* Whether the next event belongs to a key: in a map, keys and values take turns. */
static bool wants_key(const struct level *top)
{
    return top && top->node->kind == NODE_MAP && !top->key;
}

/* `node` becomes the next child of what is open, or the root. */
static void node_add(struct builder *b, struct node *node)
{
    struct level *top = top_of(b);
    if (!top) {
        b->root = node;
        return;
    }
    /* people look for the key, not for where its value begins */
    if (top->key) node->line = top->line;
    node->key = top->key;
    top->key = NULL;
    /* the last child is remembered, so that long lists grow in constant time */
    if (top->last) top->last->next = node;
    else top->node->child = node;
    top->last = node;
    top->node->count++;
}

/* A list or map begins: it is a child of what is open, and open itself. */
static bool node_open(struct builder *b, enum node_kind kind, int line)
{
    struct node *node = node_take(b, kind, line);
    if (!node) return false;
    /* on our own stack of levels, before anything is written there */
    if (b->depth == b->form->levels)
        return err_set_at(b->e, ERR_DATA, b->path, line, "nested deeper than %d levels",
                          b->form->levels);
    node_add(b, node);
    b->level[b->depth++] = (struct level){.node = node};
    return true;
}

/* The key of the next entry of the map on top. */
static bool key_add(struct builder *b, struct level *top, const char *key, int line)
{
    /* the later one would win silently, and most readers take the first for the true one */
    const struct node *twin = document_find(top->node, key);
    if (twin)
        return err_set_at(b->e, ERR_DATA, b->path, line,
                          "duplicate key '%.80s'; first given in line %d", key, twin->line);
    if (top->node->count == b->form->keys)
        return err_set_at(b->e, ERR_DATA, b->path, line, "more than %d keys in one mapping",
                          b->form->keys);
    /* the event is given back before the value comes */
    top->key = arena_text(b->arena, key);
    top->line = line;
    return true;
}

/* As YAML 1.2 has it; Null and NULL are texts. */
static bool is_null(const char *s)
{
    return s[0] == 0 || strcmp(s, "null") == 0 || strcmp(s, "~") == 0;
}

/* What a plain scalar of data is: null, a number, or else a text. Quoted ones are texts. */
static void data_scalar(struct node *node, const char *s, bool plain)
{
    char *end;
    if (!plain) return;
    /* nothing, null and ~ are the same to YAML */
    if (is_null(s)) {
        node->kind = NODE_NULL;
        return;
    }
    /* the whole text must be a number: 12a is a text, and so is 2024-01-01 */
    const double x = strtod(s, &end);
    if (end == s || *end != 0) return;
    node->kind = NODE_NUMBER;
    node->number = x;
}

/* A scalar is a key, or a value. */
static bool scalar_add(struct builder *b, const yaml_event_t *event, int line)
{
    const char *s = (const char *)event->data.scalar.value;
    struct level *top = top_of(b);
    /* "a\0b" would be cut short by everything that follows */
    if (strlen(s) != event->data.scalar.length) return refuse(b, line, "a zero byte in a text");
    if (wants_key(top)) return key_add(b, top, s, line);
    struct node *node = node_take(b, NODE_TEXT, line);
    if (!node) return false;
    /* of settings even 8 stays a text, which the table of fields reads with its unit */
    if (!b->form->settings)
        data_scalar(node, s, event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE);
    /* numbers of data keep no text: there may be a hundred million of them */
    if (node->kind == NODE_TEXT) node->text = arena_text(b->arena, s);
    node_add(b, node);
    return true;
}

/* One event of libyaml; those of streams and of a document's end say nothing more. */
static bool event_take(struct builder *b, const yaml_event_t *event)
{
    const int line = (int)event->start_mark.line + 1;
    const bool opens =
        event->type == YAML_SEQUENCE_START_EVENT || event->type == YAML_MAPPING_START_EVENT;
    /* first what holds for every kind of event */
    if (!check_plain(b, event, line)) return false;
    /* YAML allows any node as a key; no file of ours has one */
    if (opens && wants_key(top_of(b))) return refuse(b, line, "a key has to be a name");
    switch (event->type) {
    case YAML_DOCUMENT_START_EVENT:
        return !b->root || refuse(b, line, "a second document in one file");
    case YAML_SCALAR_EVENT:
        return scalar_add(b, event, line);
    case YAML_SEQUENCE_START_EVENT:
        return node_open(b, NODE_LIST, line);
    case YAML_MAPPING_START_EVENT:
        return node_open(b, NODE_MAP, line);
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        b->depth--;
        return true;
    default:
        return true;
    }
}

static bool events_read(struct builder *b, yaml_parser_t *parser)
{
    bool good = true, more = true;
    /* an event owns memory even when it is refused, so it is given back in any case */
    while (good && more) {
        yaml_event_t event;
        if (!yaml_parser_parse(parser, &event)) return refuse_syntax(b, parser);
        more = event.type != YAML_STREAM_END_EVENT;
        good = event_take(b, &event);
        yaml_event_delete(&event);
    }
    return good;
}

/* What a tree must be as a whole. */
static bool root_check(struct builder *b)
{
    const bool settings = b->form->settings;
    /* comments alone are an empty file, too */
    if (!b->root)
        return refuse(b, 1,
                      settings ? "the file is empty; expected 'key: value' lines"
                               : "the file is empty");
    return !settings || b->root->kind == NODE_MAP ||
           refuse(b, b->root->line, "expected 'key: value' lines");
}

/* In MiB, as limits are thought of; a file has no line to blame for its size. */
static bool refuse_size(const struct form *form, const char *path, struct err *e)
{
    return err_set_at(e, ERR_DATA, path, 0, "not a text file of at most %d MiB",
                      (int)(form->bytes / MIB));
}

static struct node *parse(const struct form *form, const char *data, size_t size, const char *path,
                          struct arena *a, struct err *e)
{
    /* the parser is given back whatever happens: the tree has copies of all texts */
    struct builder b = {
        .form = form, .path = path, .data = data, .size = size, .arena = a, .e = e};
    yaml_parser_t parser;
    if (size > form->bytes) return refuse_size(form, path, e), NULL;
    if (!yaml_parser_initialize(&parser))
        return err_set(e, ERR_INTERNAL, "out of memory reading %s", path), NULL;
    yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser, (const unsigned char *)data, size);
    const bool good = events_read(&b, &parser) && root_check(&b);
    yaml_parser_delete(&parser);
    return good ? b.root : NULL;
}

static struct node *read_as(const struct form *form, const char *path, struct arena *a,
                            struct err *e)
{
    struct text file = {0};
    struct node *root = NULL;
    struct stat st;
    /* before it is opened: files beyond the limit need not be read */
    if (stat(path, &st) == 0 && S_ISREG(st.st_mode) && (uint64_t)st.st_size > form->bytes)
        return refuse_size(form, path, e), NULL;
    if (text_read_file(&file, path, e))
        root = parse(form, file.s ? file.s : "", file.length, path, a, e);
    text_free(&file);
    return root;
}

struct node *document_read(const char *path, struct arena *a, struct err *e)
{
    return read_as(&data_form, path, a, e);
}

struct node *document_read_settings(const char *path, struct arena *a, struct err *e)
{
    return read_as(&settings_form, path, a, e);
}

struct node *document_parse_settings(const char *data, size_t size, const char *path,
                                     struct arena *a, struct err *e)
{
    return parse(&settings_form, data, size, path, a, e);
}

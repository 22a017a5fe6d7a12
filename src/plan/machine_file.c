/* machine_file.c - machines/NAME.yaml: plain values or {value, min, max, class, source}, on top
 * of a base.
 *
 * A file says only what differs from its base; every value remembers which file and line it came
 * from, with its evidence. Values are checked one by one as they are read, and the whole machine
 * at the end. */
#include "plan/machine_file.h"

#include <string.h>

#include "base/text.h"
#include "plan/data_dir.h"
#include "spec/collective_spec.h"
#include "spec/spec_fields.h"

/* More bases than this are a mistake; figures of one machine. */
enum { MAX_BASES = 8, MAX_PUBLISHED = 256 };

/* Reading one file of the chain of bases. */
struct reader {
    struct machine_file *machine; /* filled from base to file */
    const char *path; /* of the file that is being read, for messages */
};

/* The evidence classes of docs/machines: one, or several with slashes where a value mixes them. */
static bool is_evidence(const char *s)
{
    /* PR before P, which it begins with. */
    static const char *const classes[] = {"measured", "PR", "P", "D", "E"};
    for (;;) {
        size_t i = 0, n = 0;
        for (; i < 5 && n == 0; i++)
            if (strncmp(s, classes[i], strlen(classes[i])) == 0) n = strlen(classes[i]);
        if (n == 0) return false;
        s += n;
        if (*s == '\0') return true;
        if (*s++ != '/') return false;
    }
}

/* `published`: the entry is a published figure, which says what validate does with it. */
static bool read_evidence(struct machine_value *v, const char *key, const struct node *leaf,
                          bool published, struct err *e)
{
    for (const struct node *n = leaf->child; n != NULL; n = n->next) {
        /* `validate`, the last one, belongs to published figures only. */
        static const char *const known[] = {"value", "min", "max", "class", "source", "validate"};
        bool is_known = false;
        for (int i = 0; i < 5 + published; i++)
            is_known = is_known || strcmp(n->key, known[i]) == 0;
        if (!is_known)
            return err_set_at(e, ERR_DATA, v->file, n->line,
                              "%s: unknown key '%.80s'; expected value, min, max, %s",
                              key, n->key,
                              published ? "class, source or validate" : "class or source");
        /* read by setting_value */
        if (strcmp(n->key, "value") == 0) continue;
        if (n->kind != NODE_TEXT)
            return err_set_at(e, ERR_DATA, v->file, n->line, "%s: '%s' must be a single value", key,
                              n->key);
        if (strcmp(n->key, "class") == 0) v->evidence = n->text;
        if (strcmp(n->key, "source") == 0) v->source = n->text;
        if (strcmp(n->key, "validate") == 0) v->validate = n->text;
    }
    if (!is_evidence(v->evidence) && v->evidence[0] != '\0')
        return err_set_at(e, ERR_DATA, v->file, v->line,
                          "%s: class '%.20s'; expected P (published), PR (published, recalled), D "
                          "(derived), E (estimated) or measured (on this or another computer)",
                          key, v->evidence);
    return true;
}

/* The published range of a number; it has to hold the value. */
static bool read_range(struct machine_value *v, const struct field *f, const char *key,
                       const struct node *leaf, const struct machine_spec *spec, struct err *e)
{
    static const char *const names[] = {"min", "max"};
    double *const bound[] = {&v->min, &v->max}, value = 0;
    const void *place = (const char *)spec + f->offset;
    char why[256];
    /* Either bound is enough: the other one is then the value itself. */
    const struct node *range = document_find(leaf, "min");
    if (range == NULL) range = document_find(leaf, "max");
    if (range == NULL) return true;
    if (f->kind == FIELD_REAL) value = *(const double *)place;
    else if (f->kind == FIELD_INT64) value = (double)*(const int64_t *)place;
    else if (f->kind == FIELD_INT) value = *(const int *)place;
    else return err_set_at(e, ERR_DATA, v->file, range->line, "%s: only numbers have a range", key);
    v->min = v->max = value;
    for (int i = 0; i < 2; i++) {
        const struct node *n = document_find(leaf, names[i]);
        if (n != NULL && !units_parse(n->text, f->unit, bound[i], why, (int)sizeof why))
            return err_set_at(e, ERR_DATA, v->file, n->line, "%s: %s '%.80s': %s", key, names[i],
                              n->text, why);
    }
    /* A value outside of its own range is a mistake in one of the three. */
    if (v->min > value || v->max < value)
        return err_set_at(e, ERR_DATA, v->file, v->line,
                          "%s: the value is outside its own range min .. max", key);
    /* An empty range is none. */
    if (v->min == v->max) v->min = v->max = 0;
    return true;
}

/* What one segment says of its evidence, added to *class and *source; *class names each class
 * once. */
static bool add_evidence(const struct node *n, const char *key, const char *file,
                         struct text *class, struct text *source, struct err *e)
{
    /* "from 8 KiB: source" for each segment that has one. */
    const struct node *from = document_find(n, "from"), *c = document_find(n, "class");
    const struct node *s = document_find(n, "source");
    if (c != NULL && (c->text == NULL || !is_evidence(c->text)))
        return err_set_at(e, ERR_DATA, file, c->line, "%s: class '%.20s'; expected P, PR, D or E",
                          key, c->text != NULL ? c->text : "");
    if (c != NULL && (class->s == NULL || strstr(class->s, c->text) == NULL))
        text_add(class, "%s%s", class->s != NULL ? "/" : "", c->text);
    if (s != NULL && s->text != NULL)
        text_add(source, "%sfrom %s: %s", source->s != NULL ? "; " : "",
                 from != NULL && from->text != NULL ? from->text : "?", s->text);
    return true;
}

/* Class and source of each segment of `leaf` go to *v; returns the leaf without them, NULL when a
 * class is none. */
static const struct node *take_evidence(struct machine_value *v, const char *key,
                                             const struct node *leaf, const char *file,
                                             struct arena *a, struct err *e)
{
    struct text class = {0}, source = {0};
    struct node *bare = TAKE(a, 1, struct node), **tail = &bare->child;
    bool fine = true;
    /* A copy of the list without class and source: the tree itself stays as it was read. */
    *bare = *leaf;
    bare->child = NULL;
    for (const struct node *n = leaf->child; n != NULL && fine; n = n->next) {
        struct node *copy = *tail = TAKE(a, 1, struct node), **end = &copy->child;
        *copy = *n;
        copy->child = copy->next = NULL;
        tail = &copy->next;
        for (const struct node *k = n->child; k != NULL; k = k->next) {
            if (k->key != NULL && (strcmp(k->key, "class") == 0 || strcmp(k->key, "source") == 0))
                continue;
            *end = TAKE(a, 1, struct node);
            **end = *k;
            (*end)->next = NULL;
            end = &(*end)->next;
        }
        if (n->kind == NODE_MAP) fine = add_evidence(n, key, file, &class, &source, e);
    }
    v->evidence = class.s != NULL ? arena_text(a, class.s) : "";
    v->source = source.s != NULL ? arena_text(a, source.s) : "";
    text_free(&class);
    text_free(&source);
    return fine ? bare : NULL;
}

/* One value of the file. `full` is its whole key; a file may not give one twice, a base may. */
static bool read_leaf(void *context, const char *full, const struct node *leaf,
                      const char *file, struct arena *a, struct err *e)
{
    struct reader *r = context;
    const char *key = full + strlen("machine.");
    int row = strncmp(full, "machine.", 8) == 0 ? field_find(&machine_table, key) : -1;
    /* The name is the file's; any other key must be a row of the table. */
    if (row < 0 || strcmp(key, "name") == 0)
        return setting_unknown("machine", full, file, leaf->line, e);
    const struct field *f = &machine_table.field[row];
    struct machine_value *v = &r->machine->value[row];
    if (v->line != 0 && strcmp(v->file, file) == 0)
        return err_set_at(e, ERR_DATA, file, leaf->line,
                          "duplicate key '%s'; first given in line %d", key, v->line);
    /* Segments have their evidence inside the list; other values beside them. */
    struct machine_value fresh = {.file = file, .line = leaf->line, .evidence = "", .source = ""};
    if (f->kind == FIELD_SEGMENTS && leaf->kind == NODE_LIST &&
        (leaf = take_evidence(&fresh, key, leaf, file, a, e)) == NULL)
        return false;
    fresh.text = setting_value(key, leaf, file, a, e);
    if (fresh.text == NULL) return false;
    const char *text = fresh.text;
    *v = fresh;
    char why[512];
    if (!field_set(f, &r->machine->spec, text, a, why, (int)sizeof why))
        return err_set_at(e, ERR_DATA, file, leaf->line, "%s: '%.80s': %s", key, text, why);
    if (field_is_wordless_zero(f, &r->machine->spec, text))
        setting_zero_remark(key, text, f->zero, file, leaf->line);
    /* A plain value has no evidence. */
    if (leaf->kind != NODE_MAP) return true;
    if (!read_evidence(v, key, leaf, false, e)) return false;
    return read_range(v, f, key, leaf, &r->machine->spec, e);
}

/* Figures that are known of the machine and that no run uses: any name, value as text. */
static bool read_published(struct machine_file *m, const struct node *list, const char *file,
                           struct arena *a, struct err *e)
{
    if (list->kind != NODE_MAP)
        return err_set_at(e, ERR_DATA, file, list->line,
                          "published: expected 'name: {value, class, source}' lines");
    for (const struct node *n = list->child; n != NULL; n = n->next) {
        int i = 0;
        /* A figure replaces the base's of the same name. */
        while (i < m->npublished && strcmp(m->published[i].name, n->key) != 0) i++;
        if (i == MAX_PUBLISHED)
            return err_set_at(e, ERR_DATA, file, n->line, "more than %d published figures", i);
        struct machine_value v = {
            .file = file, .line = n->line, .evidence = "", .source = "", .validate = ""};
        v.text = setting_value(n->key, n, file, a, e);
        if (v.text == NULL || (n->kind == NODE_MAP && !read_evidence(&v, n->key, n, true, e)))
            return false;
        m->published[i] = (struct machine_published){.name = n->key, .value = v};
        /* a new name; else it took the place of the base's */
        if (i == m->npublished) m->npublished++;
    }
    return true;
}

/* Files of another version might mean something else by the same keys. */
static bool check_version(const struct node *root, const char *file, struct err *e)
{
    const struct node *n = document_find(root, "schema_version");
    if (n == NULL) return err_set_at(e, ERR_DATA, file, 1,
                                     "schema_version is missing; expected 'schema_version: 1'");
    if (n->text != NULL && strcmp(n->text, "1") == 0) return true;
    return err_set_at(e, ERR_DATA, file, n->line,
                      "schema_version: '%.20s'; this program reads version 1",
                      n->text != NULL ? n->text : "");
}

/* Texts for people, `key` "title" or "label": they have no unit and no evidence. */
static bool read_title(struct machine_file *m, const char *key, const struct node *n,
                       const char *file, struct arena *a, struct err *e)
{
    int row = field_find(&machine_table, key);
    char why[256];
    if (m->value[row].line != 0 && strcmp(m->value[row].file, file) == 0)
        return err_set_at(e, ERR_DATA, file, n->line, "duplicate key '%s'; first given in line %d",
                          n->key, m->value[row].line);
    if (n->text == NULL ||
        !field_set(&machine_table.field[row], &m->spec, n->text, a, why, (int)sizeof why))
        return err_set_at(e, ERR_DATA, file, n->line, "%s: %s", n->key,
                          n->text == NULL ? "expected one line of text" : why);
    m->value[row] = (struct machine_value){
        .text = n->text, .file = file, .line = n->line, .evidence = "", .source = ""};
    return true;
}

/* Keys that are no settings are taken out; the rest is walked as settings. */
static bool read_tree(struct reader *r, struct node *root, struct arena *a, struct err *e)
{
    static const char *const known[] = {"schema_version", "base"};
    struct node rest = *root, **tail = &rest.child;
    if (!check_version(root, r->path, e)) return false;
    rest.child = NULL;
    for (struct node *n = root->child, *next; n != NULL; n = next) {
        next = n->next;
        bool ok = true;
        if (strcmp(n->key, known[0]) == 0 || strcmp(n->key, known[1]) == 0)
            ;
        else if (strcmp(n->key, "title") == 0)
            ok = read_title(r->machine, "title", n, r->path, a, e);
        else if (strcmp(n->key, "name") == 0 || strcmp(n->key, "label") == 0)
            ok = read_title(r->machine, "label", n, r->path, a, e);
        else if (strcmp(n->key, "published") == 0)
            ok = read_published(r->machine, n, r->path, a, e);
        /* what is left is chained anew, without those keys */
        else *tail = n, tail = &n->next;
        if (!ok) return false;
    }
    *tail = NULL;
    return setting_walk(&rest, "machine", r->path, read_leaf, r, a, e);
}

/* Base first, then the file itself. `chain` holds the files that led here. */
static bool read_chain(struct machine_file *m, const char *path, const char **chain, int depth,
                       struct arena *a, struct err *e)
{
    /* The file is in its own chain: it would be read for ever. */
    for (int i = 0; i < depth; i++)
        if (strcmp(chain[i], path) == 0)
            return err_set_at(e, ERR_DATA, chain[depth - 1], 0, "base: %s is based on itself",
                              data_dir_stem(path, a));
    if (depth == MAX_BASES)
        return err_set_at(e, ERR_DATA, path, 0, "a chain of more than %d base files", depth);
    struct node *root = document_read_settings(path, a, e);
    if (root == NULL) return false;
    chain[depth] = path;
    const struct node *base = document_find(root, "base");
    if (base != NULL) {
        if (base->text == NULL)
            return err_set_at(e, ERR_DATA, path, base->line, "base: expected a machine's name");
        struct err why;
        err_clear(&why);
        /* A base is looked up beside the file that names it. */
        const char *below = data_dir_find("machines", base->text, data_dir_of(path, a), a, &why);
        if (below == NULL) return err_set_at(e, why.kind, path, base->line, "base: %s", why.text);
        if (!read_chain(m, below, chain, depth + 1, a, e)) return false;
    }
    /* The file itself comes last, so that it has the last word. */
    struct reader r = {.machine = m, .path = path};
    return read_tree(&r, root, a, e);
}

/* Values without a default must come from a file. */
static bool check_complete(const struct machine_file *m, struct err *e)
{
    for (int i = 0; i < machine_table.nfield; i++)
        if (machine_table.field[i].fallback == NULL && m->value[i].line == 0)
            return err_set_at(e, ERR_DATA, m->path, 0, "%s is missing: %s",
                              machine_table.field[i].key, machine_table.field[i].doc);
    return true;
}

/* Defaults, the chain of bases, then the file; what has no default must have come from one of
 * them. */
bool machine_file_read(struct machine_file *m, const char *name, const char *near, struct arena *a,
                       struct err *e)
{
    const char *chain[MAX_BASES];
    *m = (struct machine_file){.path = data_dir_find("machines", name, near, a, e)};
    if (m->path == NULL) return false;
    /* Defaults first: a file changes what it names. */
    field_defaults(&machine_table, &m->spec, a);
    m->value = TAKE(a, machine_table.nfield, struct machine_value);
    m->published = TAKE(a, MAX_PUBLISHED, struct machine_published);
    for (int i = 0; i < machine_table.nfield; i++)
        m->value[i] = (struct machine_value){.text = machine_table.field[i].fallback,
                                             .file = "default",
                                             .evidence = "",
                                             .source = ""};
    if (!read_chain(m, m->path, chain, 0, a, e) || !check_complete(m, e)) return false;
    /* The file's name is the machine's, whatever its base is called; a base's name for people is
     * the base's alone. */
    text_copy(m->spec.name, sizeof m->spec.name, data_dir_stem(m->path, a));
    const struct machine_value *label = &m->value[field_find(&machine_table, "label")];
    if (label->line != 0 && strcmp(label->file, m->path) != 0)
        memset(m->spec.label, 0, sizeof m->spec.label);
    /* The whole is checked at the place of its size, which is where it usually goes wrong. */
    int dims = field_find(&machine_table, "topology.dims");
    return machine_file_check(&m->spec, m->value[dims].file, m->value[dims].line, e);
}

/* What no field can check by itself. Also asked after --set and for every run of a sweep over
 * machines, with the place that is to blame. */
bool machine_file_check(const struct machine_spec *m, const char *file, int line, struct err *e)
{
    const struct topology_spec *t = &m->topology;
    const int expected = topology_family_dims(t->family);
    /* 0: a family of any number of dimensions. */
    if (expected != 0 && t->ndim != expected)
        return err_set_at(e, ERR_CONFIG, file, line,
                          "machine %s: topology.dims has %d numbers; its family takes %d",
                          m->name, t->ndim, expected);
    /* Ranks are int, and the simulator has arrays of nodes: 2^24 at most. */
    int64_t n = machine_spec_processors(m);
    if (n < 1 || n > 1 << 24)
        return err_set_at(e, ERR_CONFIG, file, line,
                          "machine %s: topology.dims gives %s than %d processors", m->name,
                          n < 1 ? "less" : "more", n < 1 ? 1 : 1 << 24);
    /* A topology given link by link may name routers that do not exist. */
    for (int i = 0; i < t->nlink; i++)
        if (t->link[i][0] >= t->dims[0] || t->link[i][1] >= t->dims[0])
            return err_set_at(e, ERR_CONFIG, file, line,
                              "machine %s: topology.links names router %d; there are %d",
                              m->name, t->link[i][t->link[i][0] < t->dims[0]], t->dims[0]);
    char why[320];
    if (!collective_rules_fit(m, why, (int)sizeof why))
        return err_set_at(e, ERR_CONFIG, file, line, "%s", why);
    if (topology_has(t->family, TOPOLOGY_LISTED) && t->nlink == 0 && t->dims[0] > 1)
        return err_set_at(e, ERR_CONFIG, file, line,
                          "machine %s: family 'graph' needs topology.links", m->name);
    return true;
}

int machine_file_blame(const struct machine_file *m, struct err *e)
{
    const char *text = e->text + (strncmp(e->text, "machine.", 8) == 0 ? 8 : 0);
    for (int i = 0; i < machine_table.nfield; i++) {
        const char *key = machine_table.field[i].key;
        const size_t length = strlen(key);
        if (strncmp(text, key, length) != 0 || text[length] == '\0' ||
            strchr(": ", text[length]) == NULL)
            continue;
        if (m->value[i].line > 0) {
            text_copy(e->file, sizeof e->file, m->value[i].file);
            e->line = m->value[i].line;
        }
        return i;
    }
    return -1;
}

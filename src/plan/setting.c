/* setting.c - keys of files and of --set find their field; values are tried before they are
 * kept.
 *
 * A setting is a key, a text and the place where it was written; the field tables (room spec)
 * say what it means. The text is tried on a spare run at once, while file and line are at hand,
 * and applied to each run later, when it cannot fail any more. */
#include "plan/setting.h"

#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"
#include "spec/spec_fields.h"

enum { KEY_LENGTH = 256, MAX_CANDIDATES = 256 };

/* Short names of the most used keys. */
const char *setting_key(const char *key)
{
    static const char *const shorts[][2] = {{"n", "model.n"},
                                            {"level", "machine.network.level"},
                                            {"kernel", "kernel.name"},
                                            {"machine", "machine.name"},
                                            {"name", "label"},
                                            {"program", "program.file"}};
    for (size_t i = 0; i < sizeof shorts / sizeof *shorts; i++)
        if (strcmp(key, shorts[i][0]) == 0) return shorts[i][1];
    return key;
}

/* A row that scenarios and --set may touch: not what the plan fills in itself, nor a machine's
 * title. */
static const struct field *settable(const char *key, const struct field_table **table)
{
    const struct field *f = field_find_full(key, table);
    /* Prices are for people, too, but they are numbers. */
    const bool title =
        f != NULL && f->label && f->kind == FIELD_TEXT && strcmp(key, "label") != 0;
    /* What `jobs:` makes. */
    const bool made = f != NULL && *table == &job_table;
    return f == NULL || title || made || strcmp(key, "scenario") == 0 ? NULL : f;
}

/* "program.NAME", which is no setting of all programs: one that a program may declare. */
static bool is_parameter(const char *key)
{
    const size_t n = strlen(program_table.prefix);
    if (strncmp(key, program_table.prefix, n) != 0 || key[n] != '.') return false;
    return key[n + 1] != '\0' && strchr(key + n + 1, '.') == NULL;
}

/* Whether the key sets something, as opposed to a group of settings. */
bool setting_is_key(const char *key)
{
    const struct field_table *t;
    if (is_parameter(key)) return true;
    return strcmp(key, "n_over_p") == 0 || settable(key, &t) != NULL;
}

/* Only segments of message software are lists of mappings; a mapping anywhere else is a group. */
bool setting_takes_maps(const char *key)
{
    const struct field_table *t;
    const struct field *f = field_find_full(key, &t);
    const int row = f == NULL ? field_find(&machine_table, key)
                              : -1; /* machine files name it without "machine." */
    if (row >= 0) f = &machine_table.field[row];
    return f != NULL && f->kind == FIELD_SEGMENTS;
}

/* Whether `key` is the beginning, up to a dot, of some field's key: "machine.network". */
bool setting_is_group(const char *key)
{
    int ntable;
    size_t length = strlen(key);
    const struct field_table *const *tables = field_tables(&ntable);
    for (int i = 0; i < ntable; i++) {
        /* A table is a group itself; groups below it are parts of its keys. */
        size_t prefix = strlen(tables[i]->prefix);
        if (prefix > 0 && strcmp(tables[i]->prefix, key) == 0) return true;
        bool below =
            prefix == 0 || (strncmp(key, tables[i]->prefix, prefix) == 0 && key[prefix] == '.');
        const char *rest = prefix == 0 ? key : key + prefix + 1;
        size_t n = prefix == 0 ? length : length - prefix - 1;
        /* A group ends at a dot of the key: "machine.net" is none. */
        for (int j = 0; below && j < tables[i]->nfield; j++)
            if (strncmp(tables[i]->field[j].key, rest, n) == 0 && tables[i]->field[j].key[n] == '.')
                return true;
    }
    return false;
}

/* n_over_p is no field: it becomes n when the number of ranks is known. */
static bool make_number(struct setting *s, struct err *e)
{
    /* as a field, for its checks and messages */
    static const struct field count = {
        .key = "n_over_p", .kind = FIELD_INT, .min = 1, .max = 1 << 20};
    char why[256];
    if (field_set(&count, &s->number, s->text, NULL, why, (int)sizeof why)) return true;
    return err_set_at(e, ERR_DATA, s->file, s->line, "%s: '%.80s': %s", s->key, s->text, why);
}

static const char tolerance_word[] = "auto-tolerance";

/* What follows the level in "auto-tolerance 2%"; NULL: not such a text. */
static const char *tolerance_of(const struct setting *s)
{
    const size_t n = sizeof tolerance_word - 1;
    if (strcmp(s->key, "machine.network.level") != 0 || strncmp(s->text, tolerance_word, n) != 0)
        return NULL;
    /* A blank must follow the word, and something the blank. */
    const char *rest = s->text + n + strspn(s->text + n, " ");
    return rest > s->text + n && *rest ? rest : NULL;
}

/* Files of earlier versions say 0 where there is no limit; they are read as they were meant. */
void setting_zero_remark(const char *key, const char *text, const char *word, const char *file,
                         int line)
{
    fprintf(stderr, "mimdsim: %s:%d: %s: '%.80s' is read as '%s', which it is called now\n", file,
            line, key, text, word);
}

/* What kind of setting it is, and whether its value makes sense. 'auto-tolerance 2 %' is two
 * settings in one text: the second hangs on the first. */
bool setting_make(struct setting *s, const char *key, const char *text, const char *file, int line,
                  struct arena *a, struct err *e)
{
    struct run_spec trial;
    char why[512];
    *s = (struct setting){.key = setting_key(key), .text = text, .file = file, .line = line};
    if (strcmp(s->key, "machine.name") == 0) return s->kind = SETTING_MACHINE, true;
    if (strcmp(s->key, "n_over_p") == 0) return s->kind = SETTING_N_OVER_P, make_number(s, e);
    if (strcmp(s->key, "ranks") == 0 && strcmp(text, "n") == 0)
        return s->kind = SETTING_RANKS_ARE_N, true;
    const char *tolerance = tolerance_of(s);
    if (tolerance != NULL) {
        struct setting *also = TAKE(a, 1, struct setting);
        if (!setting_make(also, "machine.network.tolerance", tolerance, file, line, a, e))
            return false;
        s->also = also;
        s->text = text = tolerance_word;
    }
    s->field = settable(s->key, &s->table);
    if (s->field == NULL && is_parameter(s->key)) return s->kind = SETTING_PARAMETER, true;
    /* Not a field: a parameter that a program may declare, or nothing. */
    if (s->field == NULL) return setting_unknown("", key, file, line, e);
    /* Only a trial: what it allocates goes again. */
    struct arena_mark mark = arena_mark(a);
    char *base = (char *)&trial + s->table->offset;
    bool fine = field_set(s->field, base, text, a, why, (int)sizeof why);
    const bool zero = fine && field_is_wordless_zero(s->field, base, text);
    arena_release(a, mark);
    /* Files may be old ones; what is typed now is not. */
    if (zero && line > 0) setting_zero_remark(s->key, text, s->field->zero, file, line);
    else if (zero)
        return err_set_at(e, ERR_DATA, file, line,
                          "%s: '%.80s' would be no rate at all; write '%s'", s->key, text,
                          s->field->zero);
    return fine || err_set_at(e, ERR_DATA, file, line, "%s: '%.80s': %s", s->key, text, why);
}

/* Add a setting; a key may be given only once in a list. */
bool setting_list_add(struct setting_list *list, const char *key, const char *text,
                      const char *file, int line, struct arena *a, struct err *e)
{
    struct setting s;
    if (!setting_make(&s, key, text, file, line, a, e)) return false;
    for (int i = 0; i < list->n; i++)
        if (strcmp(list->at[i].key, s.key) == 0)
            return err_set_at(e, ERR_DATA, file, line, "duplicate key '%s'; first given in line %d",
                              s.key, list->at[i].line);
    if (list->n == SETTING_MOST)
        return err_set_at(e, ERR_DATA, file, line, "too many settings");
    if ((list->n & (list->n - 1)) == 0) { /* full: room for twice as many */
        struct setting *at = TAKE(a, size_sum(size_product(2, list->n), 1), struct setting);
        if (list->n > 0) memcpy(at, list->at, (size_t)list->n * sizeof *at);
        list->at = at;
    }
    list->at[list->n++] = s;
    return true;
}

/* Cannot fail: setting_make has tried the same text. */
void setting_apply(const struct setting *s, struct run_spec *run, struct arena *a)
{
    char why[512];
    if (s->kind == SETTING_FIELD)
        CHECK(
            field_set(s->field, (char *)run + s->table->offset, s->text, a, why, (int)sizeof why));
    if (s->also != NULL) setting_apply(s->also, run, a);
}

/* The distinct names that may follow group `group` ("" or "machine.network"). */
static int candidates(const char *group, char name[][KEY_LENGTH], const char **list)
{
    static const char *const top[] = {"machine", "model", "kernel",  "program",
                                      "n",       "level", "n_over_p"};
    int n = 0, ntable;
    size_t length = strlen(group);
    const struct field_table *const *tables = field_tables(&ntable);
    for (size_t i = 0; length == 0 && i < sizeof top / sizeof *top; i++)
        snprintf(name[n++], KEY_LENGTH, "%s", top[i]);
    for (int i = 0; i < ntable; i++) {
        for (int j = 0; j < tables[i]->nfield && n < MAX_CANDIDATES; j++) {
            char full[KEY_LENGTH];
            snprintf(full, sizeof full, "%s%s%s", tables[i]->prefix,
                     tables[i]->prefix[0] ? "." : "", tables[i]->field[j].key);
            if (length > 0 && (strncmp(full, group, length) != 0 || full[length] != '.')) continue;
            snprintf(name[n], KEY_LENGTH, "%s", full + length + (length > 0));
            /* Inside a group only the next word; equal ones follow each other in the table. */
            if (length > 0) name[n][strcspn(name[n], ".")] = '\0';
            if (n == 0 || strcmp(name[n], name[n - 1]) != 0) n++;
        }
    }
    for (int i = 0; i < n; i++) list[i] = name[i];
    return n;
}

/* Whether `key` is the last words of `f`'s own key, and something stands before them. */
static bool ends_in(const struct field_table *t, const struct field *f, const char *key)
{
    const size_t m = strlen(key), length = strlen(f->key);
    return t->prefix[0] != '\0' && m <= length && strcmp(f->key + length - m, key) == 0 &&
           (m == length || f->key[length - m - 1] == '.') && !f->label;
}

/* Whole keys that end in the words of `key`: "bandwidth" and "link.bandwidth" are ends of some. As
 * many as a message has room for; those that do nothing until another setting wakes them come last.
 * How many there are. */
static int ends_of_keys(const char *key, struct text *out)
{
    enum { MOST_TOLD = 4 };
    int ntable, n = 0;
    const struct field_table *const *tables = field_tables(&ntable);
    for (int dormant = 0; dormant < 2; dormant++)
        for (int i = 0; i < ntable; i++)
            for (int j = 0; j < tables[i]->nfield; j++) {
                const struct field *f = &tables[i]->field[j];
                if ((f->dormant != NULL) != dormant || !ends_in(tables[i], f, key)) continue;
                if (n++ < MOST_TOLD)
                    text_add(out, "%s'%s.%s'", n > 1 ? " or " : "", tables[i]->prefix, f->key);
            }
    if (n > MOST_TOLD) text_add(out, " or %d others (`mimdsim keys %s`)", n - MOST_TOLD, key);
    return n;
}

/* The last word of a key that is nearest to that of `key`; NULL: none is near. */
static const char *nearest_end(const char *key)
{
    const char *word[MAX_CANDIDATES], *dot = strrchr(key, '.');
    int ntable, n = 0;
    const struct field_table *const *tables = field_tables(&ntable);
    for (int i = 0; i < ntable; i++)
        for (int j = 0; j < tables[i]->nfield && n < MAX_CANDIDATES; j++) {
            const char *own = tables[i]->field[j].key, *last = strrchr(own, '.');
            /* Short words are near to everything. */
            if (last != NULL && strlen(last + 1) > 4) word[n++] = last + 1;
        }
    return text_nearest(dot != NULL ? dot + 1 : key, word, n);
}

/* The message of a key that is none: what was meant, or what there is. Returns false. */
bool setting_unknown(const char *group, const char *key, const char *file, int line, struct err *e)
{
    char name[MAX_CANDIDATES][KEY_LENGTH];
    const char *list[MAX_CANDIDATES];
    char in[KEY_LENGTH + 8] = "";
    int n = candidates(group, name, list);
    const char *near = text_nearest(key, list, n);
    /* The key exists, but not here: a machine's title, or what the plan fills in itself. */
    if (near != NULL && strcmp(near, key) == 0)
        return err_set_at(e, ERR_DATA, file, line, "unknown key '%.120s' here: it cannot be set",
                          key);
    if (group[0] != '\0') snprintf(in, sizeof in, " in '%.240s'", group);
    /* The end of a key is what people remember: they are told the whole. */
    struct text whole = {0};
    const char *end = near == NULL && group[0] == '\0' ? nearest_end(key) : NULL;
    if (group[0] == '\0' && (ends_of_keys(key, &whole) > 0 ||
                             (end != NULL && ends_of_keys(end, &whole) > 0))) {
        err_set_at(e, ERR_DATA, file, line, "unknown key '%.120s'; did you mean %s?", key, whole.s);
        text_free(&whole);
        return false;
    }
    if (near != NULL)
        return err_set_at(e, ERR_DATA, file, line, "unknown key '%.120s'%s; did you mean '%s'?",
                          key, in, near);
    /* No near name: list what the group has; of all settings that would be too long. */
    struct text all = {0};
    for (int i = 0; i < n && group[0] != '\0'; i++)
        text_add(&all, "%s %s", i > 0 ? "," : "; expected one of", list[i]);
    err_set_at(e, ERR_DATA, file, line, "unknown key '%.120s'%s%s", key, in,
               all.s != NULL ? all.s : "; expected ranks, seed, record.*, machine.*, model.*, "
                                       "kernel.* or program.*");
    text_free(&all);
    return false;
}

/* The text of a value, plain or in {value: ...}; NULL with *e set. */
const char *setting_value(const char *key, const struct node *leaf, const char *file,
                          struct arena *a, struct err *e)
{
    const struct node *value = leaf;
    if (leaf->kind == NODE_MAP) value = document_find(leaf, "value");
    /* A list of mappings has a form of its own as text. */
    bool maps = value != NULL && value->child != NULL && value->child->kind == NODE_MAP;
    if (maps && value->kind == NODE_LIST && setting_takes_maps(key)) {
        const char *text = document_flow_maps(value, a);
        if (text == NULL)
            err_set_at(
                e, ERR_DATA, file, leaf->line,
                "%s: expected a list of mappings such as '- {from: 0 B, send.overhead: 1 us}'",
                key);
        return text;
    }
    if (value != NULL && value->kind != NODE_MAP) return document_flow(value, key, file, a, e);
    err_set_at(e, ERR_DATA, file, leaf->line,
               "%s: expected a value or {value: ..., class: ..., source: ...}", key);
    return NULL;
}

/* Keys may be nested or dotted, "kernel: {solver: cr}" or "kernel.solver: cr"; `prefix` is what
 * stands above. Each value is handed to `leaf` with its whole key. */
bool setting_walk(const struct node *mapping, const char *prefix, const char *file,
                  setting_leaf_fn *leaf, void *context, struct arena *a, struct err *e)
{
    char key[KEY_LENGTH];
    for (const struct node *n = mapping->child; n != NULL; n = n->next) {
        int length =
            snprintf(key, sizeof key, "%s%s%s", prefix, prefix[0] != '\0' ? "." : "", n->key);
        if (length >= (int)sizeof key) return setting_unknown(prefix, n->key, file, n->line, e);
        /* Short names count at the top only, and not where a group of the same name is meant
         * (kernel, machine). */
        bool may_be_short =
            prefix[0] == '\0' && (n->kind != NODE_MAP || !setting_is_group(key));
        const char *full = may_be_short ? setting_key(key) : key;
        bool ok;
        if (setting_is_key(full))
            ok = leaf(context, full == key ? arena_text(a, key) : full, n, file, a, e);
        else if (!setting_is_group(key)) ok = setting_unknown(prefix, n->key, file, n->line, e);
        else if (n->kind != NODE_MAP)
            ok = err_set_at(e, ERR_DATA, file, n->line,
                            "'%s' is a group of settings; expected keys below it", key);
        else ok = setting_walk(n, key, file, leaf, context, a, e);
        if (!ok) return false;
    }
    return true;
}

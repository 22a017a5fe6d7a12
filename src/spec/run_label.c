/* run_label.c - names of runs, made from what differs; see run_label.h.
 *
 * The differences come as the JSON object that is stored with a run, so that an older database gets
 * the same names as a new one. */
#include "spec/run_label.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/digest.h"
#include "spec/spec_fields.h"

/* A legend has room for three changes and for short values; an end of a key that is shorter than
 * this ("kind", "dims") says nothing by itself. */
enum { MOST_CHANGES = 3, MOST_LETTERS = 28, LEAST_LETTERS = 8 };

/* Whether `key` ends with the whole words `end`. */
static bool ends_in(const char *key, const char *end)
{
    const size_t n = strlen(key), m = strlen(end);
    return m <= n && strcmp(key + n - m, end) == 0 && (m == n || key[n - m - 1] == '.');
}

const char *field_short_key(const struct field_table *t, const char *key)
{
    const char *end = key + strlen(key);
    /* One word more to the left each time, until nothing else ends so. */
    while (end > key) {
        do end--;
        while (end > key && end[-1] != '.');
        int others = 0;
        for (int i = 0; i < t->nfield; i++) others += ends_in(t->field[i].key, end);
        if (others <= 1 && strlen(end) >= LEAST_LETTERS) break;
    }
    return end;
}

/* The text of the JSON string at *from, which stands behind its quote; *from goes behind its end.
 * False: it does not end. Escapes are those that machine_changes.c writes. */
static bool take_string(const char **from, struct text *out)
{
    const char *s = *from;
    for (; *s != '"'; s++) {
        if (*s == '\0') return false;
        if (*s != '\\') {
            text_add_bytes(out, s, 1);
            continue;
        }
        s++;
        /* \u00xx: a control sign, which has no place in a name. */
        if (*s == 'u' && strlen(s) > 4) s += 4, text_add(out, " ");
        else if (*s == '"' || *s == '\\') text_add_bytes(out, s, 1);
        else return false;
    }
    *from = s + 1;
    text_add(out, "%s", "");
    return true;
}

/* The next "key": "value" of the object at *from. False behind the last one. */
static bool take_change(const char **from, struct text *key, struct text *value)
{
    key->length = value->length = 0;
    const char *s = *from + strspn(*from, " ,{");
    if (*s++ != '"' || !take_string(&s, key)) return false;
    s += strspn(s, ": ");
    if (*s++ != '"' || !take_string(&s, value)) return false;
    *from = s;
    return true;
}

/* "[8, 4, 4]" is read as 8x4x4; what is too long for a legend as its fingerprint. */
static void add_value(const char *value, struct text *out)
{
    const bool list = value[0] == '[' && value[1] != '[' && value[1] != '{';
    if (strlen(value) > MOST_LETTERS) {
        char hex[65];
        digest_sha256_hex(value, strlen(value), hex);
        text_add(out, "changed (%.4s)", hex);
        return;
    }
    for (const char *s = value; *s != '\0'; s++)
        if (!list) text_add_bytes(out, s, 1);
        else if (*s == ',') text_add(out, "x");
        else if (*s != '[' && *s != ']' && *s != ' ') text_add_bytes(out, s, 1);
}

void run_label_changed(const char *name, const char *changes, struct text *out)
{
    struct text key = {0}, value = {0};
    int n = 0;
    text_add(out, "%s", name);
    for (const char *s = changes; s != NULL && take_change(&s, &key, &value); n++) {
        if (n >= MOST_CHANGES) continue;
        /* A key that this version does not know any more is told in full. */
        const int row = field_find(&machine_table, key.s);
        const struct field *f = row >= 0 ? &machine_table.field[row] : NULL;
        text_add(out, ", %s ", f ? field_short_key(&machine_table, key.s) : key.s);
        add_value(field_word(f, value.s), out);
    }
    if (n > MOST_CHANGES) {
        char hex[65];
        digest_sha256_hex(changes, strlen(changes), hex);
        text_add(out, " and %d more (%.4s)", n - MOST_CHANGES, hex);
    }
    text_free(&key);
    text_free(&value);
}

void run_label_made(const struct run_spec *run, const char *changes, struct text *out)
{
    const struct machine_spec *m = &run->machine;
    /* Jobs of one machine would all be called alike. */
    if (run->job.number > 0)
        text_add(out, run->job.beside[0] != '\0' ? "%s beside %s, " : "%s alone, ",
                 run->job.name, run->job.beside);
    run_label_changed(m->label[0] != '\0' ? m->label : m->name, changes, out);
}

void run_label(const struct run_spec *run, struct text *out)
{
    if (run->called != NULL) text_add(out, "%s", run->called);
    else if (run->label[0] != '\0') text_add(out, "%s", run->label);
    else run_label_made(run, run->machine_changes, out);
}

/* The lines of the canonical text that begin with "machine.", but for two questions, which are no
 * part of a machine. */
void machine_fingerprint(const char *config, char hex[LABEL_KEY_LENGTH + 1])
{
    static const char machine[] = "machine.", level[] = "machine.network.level = ",
                      tolerance[] = "machine.network.tolerance = ";
    struct text lines = {0};
    char whole[65];
    for (const char *line = config; line != NULL && *line != '\0';) {
        const char *end = strchrnul(line, '\n');
        end += *end != '\0';
        if (strncmp(line, machine, sizeof machine - 1) == 0 &&
            strncmp(line, level, sizeof level - 1) != 0 &&
            strncmp(line, tolerance, sizeof tolerance - 1) != 0)
            text_add_bytes(&lines, line, (size_t)(end - line));
        line = end;
    }
    digest_sha256_hex(lines.s != NULL ? lines.s : "", lines.length, whole);
    text_copy(hex, LABEL_KEY_LENGTH + 1, whole);
    text_free(&lines);
}

struct run_size run_size(const struct run_spec *run, int nrank)
{
    struct run_size size;
    char n[32]; /* as text; run->model.nbody is its number */
    const bool sized = run->kernel.own
                           ? program_value_find(run->program.parameters, "n", n, sizeof n)
                           : kernel_spec_needs_model(&run->kernel);
    if (sized) snprintf(size.s, sizeof size.s, ", n = %d, P = %d", run->model.nbody, nrank);
    else snprintf(size.s, sizeof size.s, ", P = %d", nrank);
    return size;
}

/* field_tables.c - all tables of a run: looked up, printed as the canonical configuration, and as
 * the manual.
 *
 * To add a setting: a member of the spec struct, a row in its table, a line in
 * tests/golden/defaults.txt. Everything else (files, command line, sweeps, identity, store, manual)
 * goes by the tables. */
#include <math.h>
#include <string.h>

#include "spec/spec_fields.h"

/* In the order of a configuration's text: the run first, since its table holds the whole struct. */
static const struct field_table *const tables[] = {&run_table, &machine_table, &model_table,
                                                   &kernel_table, &program_table, &job_table};

/* Every loop over all settings goes by this list: reading, printing, identity, manual. */
const struct field_table *const *field_tables(int *n)
{
    *n = (int)(sizeof tables / sizeof *tables);
    return tables;
}

/* Zero where no table has anything: labels made by the plan, digests, what is borrowed. */
void run_spec_defaults(struct run_spec *r, struct arena *a)
{
    memset(r, 0, sizeof *r);
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++)
        field_defaults(tables[i], (char *)r + tables[i]->offset, a);
}

/* Tables have some tens of rows: a search costs less than an index to be kept. Most rows are passed
 * by their first letter. */
int field_find(const struct field_table *t, const char *key)
{
    for (int i = 0; i < t->nfield; i++)
        if (t->field[i].key[0] == key[0] && strcmp(t->field[i].key, key) == 0) return i;
    return -1;
}

/* The run's own table has no prefix: its keys are looked up as they are. */
const struct field *field_find_full(const char *key, const struct field_table **table)
{
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        size_t length = strlen(tables[i]->prefix);
        /* "machine.network.link" belongs to table "machine", "machines" does not. */
        bool dotted =
            length > 0 && strncmp(key, tables[i]->prefix, length) == 0 && key[length] == '.';
        if (length > 0 && !dotted) continue;
        int row = field_find(tables[i], key + length + dotted);
        if (row < 0) continue;
        *table = tables[i];
        return &tables[i]->field[row];
    }
    return NULL;
}

/* Bytes and not formats: identities of large campaigns spend their time here. */
void fields_print(const struct field_table *t, const void *base, bool labels, struct text *out)
{
    size_t prefix = strlen(t->prefix);
    for (int i = 0; i < t->nfield; i++) {
        /* Titles and the like are for people: no part of what a run is. */
        if (t->field[i].label && !labels) continue;
        /* prefix.key = value */
        text_add_bytes(out, t->prefix, prefix);
        if (prefix > 0) text_add_bytes(out, ".", 1);
        text_add_bytes(out, t->field[i].key, strlen(t->field[i].key));
        text_add_bytes(out, " = ", 3);
        field_print(&t->field[i], base, out);
        text_add_bytes(out, "\n", 1);
    }
}

/* The order of tables and rows is the order of the stored text; the identity does not depend on it
 * (identity.c sorts). */
void fields_config(const struct run_spec *run, struct text *out)
{
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++)
        fields_print(tables[i], (const char *)run + tables[i]->offset, false, out);
}

/* What the manual says a value is. "one of" is followed by the choices, "a list, each" by the unit
 * of its entries. */
static const char *kind_name(const struct field *f)
{
    switch (f->kind) {
    /* A real is described by its unit: "a time", "a rate". */
    case FIELD_REAL:
        return units_name(f->unit);
    case FIELD_INT:
        return "a whole number";
    case FIELD_INT64:
        return f->unit == UNIT_BYTES ? "a size" : "a whole number";
    case FIELD_SEED:
        return "a whole number below 2^64";
    case FIELD_BOOL:
        return "true or false";
    /* Words and lists; the choices follow in document_field. */
    case FIELD_CHOICE:
        return "one of";
    case FIELD_TEXT:
        return "text";
    case FIELD_INTS:
    case FIELD_INT_LIST:
        return "a list of whole numbers";
    case FIELD_REALS:
        return "a list, each";
    case FIELD_PAIR_LIST:
        return "a list of pairs";
    case FIELD_SEGMENTS:
        return "a list of segments";
    }
    return "";
}

/* Ranges in the unit of the field; only numbers have one. */
static void document_range(const struct field *f, FILE *out)
{
    char bound[64];
    /* Choices and texts have no range to tell. */
    bool number = f->kind == FIELD_REAL || f->kind == FIELD_REALS || f->kind == FIELD_INT ||
                  f->kind == FIELD_INT64;
    if (!number) return;
    enum unit unit = f->unit;
    units_print(f->min, unit, bound, (int)sizeof bound);
    fprintf(out, ", %s", bound);
    units_print(f->max, unit, bound, (int)sizeof bound);
    fprintf(out, " to %s", bound);
}

/* No default: the key is required. An empty default is told as nothing. */
/* No default: the key is required. An empty default is told as nothing. One line a setting:
 *
 *     - `machine.node.clock`: processor clock, ... *a frequency, 1 Hz to 10 THz; required* */
static void document_field(const struct field_table *t, const struct field *f, FILE *out)
{
    fprintf(out, "- `%s%s%s`: %s.", t->prefix, t->prefix[0] != '\0' ? "." : "", f->key, f->doc);
    /* Kind, choices, range, default: the line is in italics behind the description. */
    fprintf(out, " *%s%s", kind_name(f), f->kind == FIELD_REALS ? " " : "");
    if (f->kind == FIELD_REALS) fprintf(out, "%s", units_name(f->unit));
    for (int i = 0; f->choice != NULL && f->choice[i] != NULL; i++)
        fprintf(out, "%s %s", i > 0 ? "," : "", f->choice[i]);
    document_range(f, out);
    if (f->fallback == NULL) fprintf(out, "; required*\n");
    else if (f->fallback[0] == '\0') fprintf(out, "*\n");
    else fprintf(out, "; default %s*\n", f->fallback);
}

/* The manual is printed from the tables: it cannot disagree with what is read. */
void fields_document(FILE *out)
{
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        const struct field_table *t = tables[i];
        fprintf(out, "%s## `%s`: %s\n\n", i > 0 ? "\n" : "",
                t->prefix[0] != '\0' ? t->prefix : "run", t->doc);
        for (int j = 0; j < t->nfield; j++) document_field(t, &t->field[j], out);
    }
}

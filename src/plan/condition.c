/* condition.c - names of settings as values of formulas; see condition.h.
 *
 * A value is read out of the resolved run through the tables of fields, so that a condition sees
 * what will run: defaults, what the machine's file says, and what follows from other settings. */
#include "plan/condition.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "plan/setting.h"
#include "spec/field.h"

/* What no table has: sizes, and what follows from them. */
static const char *const derived[] = {"P",        "n",          "ranks",
                                      "n_over_p", "processors", "level",
                                      "kernel",   "machine",    "machine.processors"};
enum { DERIVED = sizeof derived / sizeof *derived, MOST_NAMES = 512 };

/* Sizes as the run has them, whichever of them the scenario gives. */
static bool look_up_derived(const struct run_spec *run, const char *name, double *value)
{
    if (strcmp(name, "P") == 0 || strcmp(name, "ranks") == 0) *value = run->nrank;
    else if (strcmp(name, "n") == 0) *value = run->model.nbody;
    else if (strcmp(name, "n_over_p") == 0)
        *value = run->nrank > 0 ? (double)run->model.nbody / run->nrank : 0;
    else if (strcmp(name, "processors") == 0 || strcmp(name, "machine.processors") == 0)
        *value = (double)machine_spec_processors(&run->machine);
    else return false;
    return true;
}

/* Numbers as numbers, everything else as the text that identifies it: "[8, 4, 4]", "torus". */
static void read_field(const struct field *f, const void *base, struct arena *a,
                       struct expression_value *v)
{
    *v = (struct expression_value){.unit = f->unit};
    if (field_number(f, base, &v->number)) return;
    /* in the canonical form, whatever the file wrote */
    struct text t = {0};
    field_print(f, base, &t);
    *v = (struct expression_value){.text = arena_text(a, t.s != NULL ? t.s : "")};
    text_free(&t);
}

/* The nearest of all names, in full as the message shows them. Returns false. */
static bool unknown(const char *name, char *why, int size)
{
    /* a few hundred names, once, for a message */
    char full[MOST_NAMES][96];
    const char *list[MOST_NAMES];
    int n = 0, ntable;
    const struct field_table *const *table = field_tables(&ntable);
    for (int i = 0; i < DERIVED; i++) list[n++] = derived[i];
    for (int i = 0; i < ntable; i++)
        for (int k = 0; k < table[i]->nfield && n < MOST_NAMES; k++, n++) {
            snprintf(full[n], sizeof full[n], "%s%s%s", table[i]->prefix,
                     table[i]->prefix[0] ? "." : "", table[i]->field[k].key);
            list[n] = full[n];
        }
    /* none near: where all of them stand */
    static const char all[] =
        "; names are n, P, processors and the keys of scenarios (`mimdsim keys`)";
    snprintf(why, (size_t)size, "unknown name '%.80s'%s", name, text_hint(name, list, n, all).s);
    return false;
}

/* What a person's own program declares: "NAME = VALUE" lines of the run. */
static bool look_up_parameter(const struct condition_scope *s, const char *name,
                              struct expression_value *v)
{
    const char *line = s->run->program.parameters;
    if (strncmp(name, "program.", 8) != 0) return false;
    const size_t n = strlen(name + 8);
    for (; line != NULL && *line != '\0';
         line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL) {
        if (strncmp(line, name + 8, n) != 0 || strncmp(line + n, " = ", 3) != 0) continue;
        char *text = arena_text(s->arena, line + n + 3), *end;
        text[strcspn(text, "\n")] = '\0';
        v->number = strtod(text, &end);
        if (*end != '\0' || end == text) v->text = text;
        return true;
    }
    return false;
}

/* Short names are those of scenarios: level, n, kernel. */
bool condition_lookup(void *context, const char *name, struct expression_value *v, char *why,
                      int size)
{
    const struct condition_scope *s = context;
    const struct field_table *t;
    *v = (struct expression_value){0};
    if (look_up_derived(s->run, name, &v->number)) return true;
    if (look_up_parameter(s, name, v)) return true;
    /* a key of the tables, as scenarios write it */
    const struct field *f = field_find_full(setting_key(name), &t);
    if (f == NULL) return unknown(name, why, size);
    read_field(f, (const char *)s->run + t->offset, s->arena, v);
    return true;
}

/* A condition of a file is bad data, one of the command line wrong usage. */
static bool refuse(const struct condition *c, const char *text, const char *why, struct err *e)
{
    return err_set_at(e, c->line > 0 ? ERR_DATA : ERR_USAGE, c->file, c->line,
                      "condition '%.120s': %s", text, why);
}

/* Names are looked up later, when there is a run to look at. */
bool condition_read(struct condition *c, const char *text, const char *file, int line,
                    struct arena *a, struct err *e)
{
    char why[256];
    *c = (struct condition){.file = file, .line = line};
    c->formula = expression_read(text, a, why, (int)sizeof why);
    return c->formula != NULL || refuse(c, text, why, e);
}

/* The texts that a lookup prints are passing. */
bool condition_holds(const struct condition *c, const struct run_spec *run, bool *holds,
                     struct err *e)
{
    char why[256];
    struct expression_value v;
    struct condition_scope scope = {run, arena_create()};
    bool fine = expression_value(c->formula, condition_lookup, &scope, &v, why, (int)sizeof why);
    arena_destroy(scope.arena);
    if (fine && !v.truth) {
        fine = false;
        snprintf(why, sizeof why, "a value, not a condition; expected one such as 'n >= ranks'");
    }
    if (!fine) return refuse(c, expression_text(c->formula), why, e);
    *holds = v.number != 0;
    return true;
}

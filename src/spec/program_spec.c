/* program_spec.c - the settings of people's own programs, and the parameters that these declare.
 *
 * Declared parameters have rows too (struct program_sheet), made from the image: they are read,
 * checked and printed by the same functions as built-in settings, but live in text lines instead of
 * a struct. */
#include "spec/program_spec.h"

#include <string.h>

#include "spec/machine_idle.h"
#include "spec/spec_fields.h"

#define AT(member) .offset = offsetof(struct program_spec, member)

/* In the order of enum program_cost. */
static const char *const costs[] = {"declared", "blocks", "author", "host", NULL};

/* Built-in programs count their operations themselves and take no arguments. */
static const char *idle_unless_own(const struct run_spec *r)
{
    return r->program.file[0] != '\0' ? NULL : "no program of your own is given (program: FILE)";
}

/* Only a program with main has argv; one that declares parameters takes keys. */
static const char *idle_unless_arguments(const struct run_spec *r)
{
    const char *why = idle_unless_own(r);
    if (why != NULL) return why;
    return r->program.kind == PROGRAM_MPI ? NULL : "only programs with main have arguments";
}

/* A schedule states each computing time: there is nothing to be costed. */
static const char *idle_unless_computing(const struct run_spec *r)
{
    const char *why = idle_unless_own(r);
    if (why != NULL) return why;
    return r->program.kind != PROGRAM_SCHEDULE ? NULL : "a schedule says what its computing costs";
}

/* Rates do not ask where data lie. */
static const char *idle_unless_roofline(const struct run_spec *r)
{
    const char *why = idle_unless_computing(r);
    return why != NULL ? why : machine_idle_unless_roofline(r);
}

static const struct field fields[] = {
    {.key = "file",
     .kind = FIELD_TEXT,
     AT(file),
     .capacity = 256,
     .fallback = "",
     .doc = "a program of your own instead of a built-in one: source (.c, .cc, .f90), what "
            "`mimdsim cc` made of it, or a schedule (.goal)"},
    /* Divided into words as a shell does, without its variables. */
    {.key = "arguments",
     .kind = FIELD_TEXT,
     AT(arguments),
     .capacity = 512,
     .fallback = "",
     .idle = idle_unless_arguments,
     .doc = "arguments of a program with main, as in a shell"},
    /* How the time between two calls of the machine is found. */
    {.key = "cost",
     .kind = FIELD_CHOICE,
     AT(cost),
     .choice = costs,
     .fallback = "declared",
     .idle = idle_unless_computing,
     .doc = "what computing costs: as the program declares, executed blocks of machine code, what "
            "the program states, or the time on this computer (then no two runs are alike)"},
    /* Calibration: one number, found by measuring the same code on the real machine. */
    {.key = "factor",
     .kind = FIELD_REAL,
     .unit = UNIT_NONE,
     AT(factor),
     .min = 1e-6,
     .max = 1e6,
     .fallback = "1",
     .idle = idle_unless_computing,
     .doc =
         "computing time is multiplied by it: measured time over predicted time of the same code"},
    /* Where the data of its loops lie: nothing in its code says how often they come back. */
    {.key = "working_set",
     .kind = FIELD_INT64,
     .unit = UNIT_BYTES,
     AT(working_set),
     .min = 0,
     .max = 1e15,
     .fallback = "0 B",
     .idle = idle_unless_roofline,
     .doc = "bytes that the loops of a rank pass over again and again, for the caches of "
            "machine.node.model 'roofline'; 0 B: the first cache holds them"},
};

const struct field_table program_table = {
    .prefix = "program",
    .doc = "a program of your own; its own parameters are keys here, too",
    .offset = offsetof(struct run_spec, program),
    .size = sizeof(struct program_spec),
    .nfield = (int)(sizeof fields / sizeof *fields),
    .field = fields,
};

/* What the program itself declares, read from its image. */
const struct field *program_sheet_find(const struct program_sheet *p, const char *name)
{
    for (int i = 0; i < p->nparameter; i++)
        if (strcmp(p->parameter[i].key, name) == 0) return &p->parameter[i];
    return NULL;
}

/* The same reader as for built-in settings: unit, range and choices are checked. */
const char *program_parameter_text(const struct field *f, const char *text, struct arena *a,
                                   char *why, int size)
{
    union program_value value = {0};
    if (!field_set(f, &value, text, a, why, size)) return NULL;
    /* Printed again, so that 8 KiB and 8192 B are one value. */
    struct text out = {0};
    field_print(f, &value, &out);
    const char *canonical = arena_text(a, out.s);
    text_free(&out);
    return canonical;
}

/* Values travel as "name = value" lines: the text is what identity and store keep anyway. One that
 * does not fit into the buffer is cut. */
bool program_value_find(const char *lines, const char *name, char *buffer, int size)
{
    /* A name matches whole: " = " must follow at once. */
    const size_t n = strlen(name);
    for (const char *s = lines; s != NULL && *s != '\0';) {
        const char *end = strchrnul(s, '\n');
        if (strncmp(s, name, n) == 0 && strncmp(s + n, " = ", 3) == 0) {
            snprintf(buffer, (size_t)size, "%.*s", (int)(end - s - (long)n - 3), s + n + 3);
            return true;
        }
        s = *end != '\0' ? end + 1 : end;
    }
    return false;
}

/* The form in which values travel: one line each, in the order declared. */
void program_lines_add(struct text *lines, const char *name, const char *value)
{
    text_add(lines, "%s = %s\n", name, value);
}

/* With the table's prefix they look like settings of the built-in tables. */
void program_lines_print(const char *lines, struct text *out)
{
    for (const char *s = lines; s != NULL && *s != '\0';) {
        const char *end = strchrnul(s, '\n');
        text_add(out, "%s.%.*s\n", program_table.prefix, (int)(end - s), s);
        s = *end != '\0' ? end + 1 : end;
    }
}

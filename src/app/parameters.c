/* parameters.c - from the origins of machine files to rows of a table; see parameters.h.
 *
 * Only values with a class of evidence are listed: the others are defaults of this program, of
 * which the manual of keys tells. */
#include "app/parameters.h"

#include <string.h>

#include "base/text.h"
#include "base/units.h"
#include "spec/field.h"

enum { MOST_MACHINES = 64 }; /* of a study; those beyond are not listed */

/* The machines of all runs, each once, in their order. */
static int machines_of(const struct plan *plan, int nplan, const char **name)
{
    int n = 0;
    for (int i = 0; i < nplan; i++)
        for (int k = 0; k < plan[i].nrun; k++) {
            const char *machine = plan[i].run[k].machine.name;
            int j = 0;
            while (j < n && strcmp(name[j], machine) != 0) j++;
            if (j == n && n < MOST_MACHINES) name[n++] = machine;
        }
    return n;
}

/* The published range with units, "" without one. A published figure is no field and has no
 * unit. */
const char *parameters_range(const struct origin *o, struct arena *a)
{
    if (!(o->max > o->min)) return "";
    /* The unit is that of the field of the same name. */
    struct text key = {0}, range = {0};
    text_add(&key, "machine.%s", o->key);
    const struct field_table *table;
    const struct field *f = field_find_full(key.s, &table);
    char low[64], high[64];
    units_print(o->min, f ? f->unit : UNIT_NONE, low, sizeof low);
    units_print(o->max, f ? f->unit : UNIT_NONE, high, sizeof high);
    text_add(&range, "%s to %s", low, high);
    const char *s = arena_text(a, range.s);
    text_free(&key);
    text_free(&range);
    return s;
}

/* Two passes: origins of all machines, then rows for those with evidence. Values without are
 * defaults. */
bool parameters_gather(const struct plan *plan, int nplan, struct arena *a,
                       const struct document_parameter **out, int *n, struct err *e)
{
    const char *name[MOST_MACHINES];
    struct origin *origin[MOST_MACHINES];
    int norigin[MOST_MACHINES], nmachine = machines_of(plan, nplan, name), total = 0;
    struct plan_options none = {0};
    struct machine_spec m;
    for (int i = 0; i < nmachine; i++) {
        if (!plan_machine(&m, name[i], &none, a, &origin[i], &norigin[i], e)) return false;
        total += norigin[i];
    }
    struct document_parameter *p = TAKE(a, total + 1, struct document_parameter);
    *n = 0;
    for (int i = 0; i < nmachine; i++)
        for (int k = 0; k < norigin[i]; k++) {
            const struct origin *o = &origin[i][k];
            if (!*o->evidence) continue;
            p[(*n)++] = (struct document_parameter){arena_text(a, name[i]), o->key,      o->value,
                                                    parameters_range(o, a), o->evidence, o->source};
        }
    *out = p;
    return true;
}

/* call.c - names of runs for people; see call.h.
 *
 * A what-if that is called like the machine it started from misleads whoever reads the figure. So a
 * run on a changed machine never has the plain name of the machine, unless a person gave it one. */
#include "plan/call.h"

#include <string.h>

#include "base/text.h"
#include "plan/machine_changes.h"
#include "spec/run_label.h"
#include "spec/spec_fields.h"

/* Whether an axis gives its points names. */
static bool names_itself(const struct call_point *p)
{
    for (int i = 0; i < p->n; i++)
        if (strcmp(p->at[i].key, "label") == 0) return true;
    return false;
}

/* What one setting of the sweep makes of the machine, as a part of a name. Level and tolerance ask
 * something of a machine and are no part of it. */
static void add_change(const struct setting *s, struct text *out)
{
    static const char prefix[] = "machine.";
    const size_t n = sizeof prefix - 1;
    if (strncmp(s->key, prefix, n) != 0 || strcmp(s->key, "machine.network.level") == 0 ||
        strcmp(s->key, "machine.network.tolerance") == 0)
        return;
    if (s->kind == SETTING_MACHINE) text_add(out, ", %s", s->text);
    else text_add(out, ", %s %s", field_short_key(&machine_table, s->key + n), s->text);
}

/* A given name, with what distinguishes the points of the sweep that share it. */
static void given_name(const char *label, const struct call_point *point, int npoint,
                       struct text *out)
{
    text_add(out, "%s", label);
    for (int i = 0; i < npoint; i++)
        for (int j = 0; j < point[i].n; j++)
            if (point[i].swept && !names_itself(&point[i])) add_change(&point[i].at[j], out);
}

void call_run(struct calls *c, struct run_spec *run, const struct machine_spec *file,
              const struct call_point *point, int npoint)
{
    struct text t = {0};
    if (run->label[0] != '\0') {
        given_name(run->label, point, npoint, &t);
    } else {
        /* A machine that is not shipped is compared with its own file. */
        struct text own = {0};
        if (run->machine_changes == NULL) machine_changes_between(file, &run->machine, &own);
        const char *changes = own.s != NULL ? own.s : run->machine_changes;
        run_label_made(run, changes, &t);
        text_free(&own);
    }
    if (c->last == NULL || strcmp(c->last, t.s) != 0) c->last = arena_text(c->arena, t.s);
    run->called = c->last;
    text_free(&t);
}

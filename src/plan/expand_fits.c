/* expand_fits.c - the settings of a point, and whether they make a machine that can be built and
 * holds the ranks: asked above this room (plan_options.fits), where networks are. */
#include <string.h>

#include "base/text.h"
#include "plan/expand_parts.h"
#include "spec/spec_fields.h"

int expand_lists(const struct expansion *x, const struct setting_list *list[EXPAND_LISTS])
{
    const struct scenario *s = x->scenario;
    int n = 0;
    /* base, then one point of each axis, the job, then the command line: the last one wins */
    list[n++] = &s->base;
    for (int i = 0; i < s->naxis; i++) list[n++] = &s->axis[i].point[x->point[i]];
    if (x->job != NULL) list[n++] = x->job;
    list[n++] = &s->set;
    return n;
}

/* Where the setting stands that the text of *e begins with: in the scenario, on the command line,
 * else in the files of the machine. */
static void blame(struct expansion *x, const struct machine_file *machine, struct err *e)
{
    const struct setting_list *list[EXPAND_LISTS];
    const int n = expand_lists(x, list), field = machine_file_blame(machine, e);
    if (e->line == 0) text_copy(e->file, sizeof e->file, x->scenario->path);
    if (field < 0) return;
    /* The last one wins, as where they act. */
    for (int i = 0; i < n; i++)
        for (int k = 0; k < list[i]->n; k++) {
            const struct setting *s = &list[i]->at[k];
            if (s->field != &machine_table.field[field]) continue;
            text_copy(e->file, sizeof e->file, s->file);
            e->line = s->line;
        }
}

bool expand_fits(struct expansion *x, const struct machine_spec *m, int nrank,
                 const struct job_set *jobs, struct err *e)
{
    struct asked *last = &x->asked;
    if (x->scenario->fits == NULL) return true;
    /* Runs that follow each other are mostly on one machine with as many ranks. */
    const bool same = jobs == NULL && last->nrank == nrank &&
                      memcmp(&last->machine, m, sizeof last->machine) == 0;
    if (!same) {
        last->machine = *m;
        last->nrank = jobs == NULL ? nrank : 0;
        err_clear(&last->why);
        last->fits = x->scenario->fits(m, nrank, jobs, &x->work, &last->why);
        if (!last->fits) blame(x, &x->present->whole, &last->why);
    }
    if (!last->fits) *e = last->why;
    return last->fits;
}

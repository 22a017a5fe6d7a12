/* scenario_lists.c - every list of settings of a scenario; scenario_file.h. A file of its own: what
 * the reader of scenarios calls needs it, too, and calls nothing back. */
#include "base/arena.h"
#include "plan/jobs_file.h"
#include "plan/scenario_file.h"

int scenario_lists(struct scenario *s, struct arena *a, struct setting_list ***list)
{
    int n = 2 + (s->jobs != NULL ? s->jobs->n : 0);
    for (int i = 0; i < s->naxis; i++) n += s->axis[i].npoint;
    struct setting_list **at = *list = TAKE(a, n, struct setting_list *);
    *at++ = &s->base;
    for (int i = 0; i < s->naxis; i++)
        for (int j = 0; j < s->axis[i].npoint; j++) *at++ = &s->axis[i].point[j];
    for (int i = 0; s->jobs != NULL && i < s->jobs->n; i++) *at++ = &s->jobs->job[i].set;
    *at = &s->set;
    return n;
}

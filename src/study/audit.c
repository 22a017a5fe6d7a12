/* audit.c - a database compared with itself: the order of the parts, and the list of what they
 * find (audit.h). */
#include "study/audit.h"

#include <string.h>

#include "study/audit_rules.h"

static bool take_count(void *context, int ncolumn, const char *const *name,
                       const struct store_value *value)
{
    (void)ncolumn, (void)name;
    *(int64_t *)context = value[0].integer;
    return true;
}

bool audit_database(struct store *s, const struct audit_options *o, struct arena *a,
                    struct audit_report *r, struct err *e)
{
    memset(r, 0, sizeof *r);
    r->arena = a;
    if (!store_query(s, "SELECT count(*) FROM run", 0, NULL, NULL, take_count, &r->nrun, e))
        return false;
    /* Cheap rules first: rows of one run with each other, then each run with its configuration.
     * To make runs again takes as long as the campaign did. */
    return audit_rows(s, r, e) && audit_settings(s, r, e) && audit_configurations(s, r, e) &&
           (o->again == 0 || audit_again(s, o, r, e));
}

/* cmd_merge.c - mimdsim merge: databases that several hosts or shards made, joined to one.
 *
 * Merging is safe to repeat, and refuses what cannot be right: one run with two results. */
#include "app/arguments.h"
#include "app/verb.h"
#include "base/json.h"
#include "store/merge.h"
#include "store/swept.h"

static const char doc[] =
    "Put the runs of the databases IN... into OUT, which is made where there is none.\n\n"
    "Example: mimdsim merge fig6.db one.db two.db\n"
    "\vA run is known by its settings, seed and repetition. A run that OUT holds already stays; "
    "one that did not end ok there is replaced by one that did. Merging the same databases again "
    "changes nothing. When the same run has two different digests, nothing is merged from that "
    "database, and the message names both builds (exit 65). Verdicts on claims and explanations "
    "are not merged, because they judge all runs together: make them again with `mimdsim claims`.";

/* One line, or one object, for a database that was merged. */
static void tell(const struct common *c, struct json *j, const char *from,
                 const struct store_merged *m)
{
    if (c->json) {
        json_object(j);
        json_key_text(j, "from", from);
        json_key_int(j, "added", m->added);
        json_key_int(j, "replaced", m->replaced);
        json_key_int(j, "present", m->present);
        json_key_int(j, "study_rows_added", m->studies);
        json_end(j);
        return;
    }
    printf("%s: %lld runs added, %lld replaced, %lld were there", from, (long long)m->added,
           (long long)m->replaced, (long long)m->present);
    if (m->studies > 0) printf("; %lld rows of studies added", (long long)m->studies);
    printf("\n");
}

/* Databases in the order of the command line; each in a transaction of its own. */
int cmd_merge(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, 0, "OUT IN...", doc, 2, 64);
    struct err e;
    err_clear(&e);
    /* OUT is made where there is none. */
    struct store *s = arguments_store(&c, c.arg[0], &e);
    bool ok = s != NULL;
    struct json j = json_make(stdout);
    /* Databases are merged one by one in the order given; those before the first that is refused
     * stay merged. */
    if (ok && c.json) json_array(&j);
    for (int i = 1; ok && i < c.narg; i++) {
        struct store_merged m;
        ok = store_merge(s, c.arg[i], &m, &e);
        if (ok) tell(&c, &j, c.arg[i], &m);
    }
    /* Other settings differ now than in any of them; also of those before one that was refused. */
    struct err ignored;
    err_clear(&ignored);
    if (s != NULL && !store_swept_view(s, ok ? &e : &ignored)) ok = false;
    /* Those that were merged before a failure are in the document. */
    if (s != NULL && c.json) json_end(&j), json_finish(&j);
    store_close(s);
    return ok ? 0 : common_fail(&c, &e);
}

/* known_error.c - see known_error.h.
 *
 * A ladder is measured at one or a few points of a scenario, and holds for all runs that are alike
 * but for their size: the digest of what they have in common is kept with each run. */
#include "app/known_error.h"

#include "spec/identity.h"
#include "study/level_choice.h"

/* A run keeps its family: it is made once. */
static bool add_row(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn, (void)name, (void)value;
    *(bool *)context = true;
    return false;
}

/* Whether the run has its family already. */
static bool is_noted(struct store *s, int64_t id, bool *there, struct err *e)
{
    char text[24];
    snprintf(text, sizeof text, "%lld", (long long)id);
    /* by number: the run is stored */
    const char *const bound[] = {text};
    *there = false;
    return store_select(s, "SELECT 1 FROM run_family WHERE run_id = ?1", 1, bound, add_row, there,
                        e);
}

/* In one transaction: a plan may have thousands of runs. */
bool known_error_note(struct store *s, struct identity *by, const struct run_spec *run, int n,
                      struct err *e)
{
    static const char *const name[] = {"run_id", "family"};
    if (!store_begin(s, e)) return false;
    /* Runs of one plan are alike in most of what makes a family. */
    struct identity *x = identity_or_own(by);
    bool ok = true;
    for (int i = 0; i < n && ok; i++) {
        const int64_t id = store_run_id(s, &run[i]);
        bool there;
        ok = id == 0 || is_noted(s, id, &there, e);
        if (!ok || id == 0 || there) continue;
        /* a hash of the whole configuration */
        char family[65];
        level_family_by(x, &run[i], family);
        const struct store_value value[] = {store_int(id), store_text(family)};
        ok = store_insert(s, "run_family", 2, name, value, e);
    }
    identity_back(x, by);
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}

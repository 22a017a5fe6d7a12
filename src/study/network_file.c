/* network_file.c - see network_file.h. */
#include "study/network_file.h"

#include <string.h>

#include "base/text.h"
#include "machine/routing.h"
#include "plan/file_kind.h"

/* Nothing but that it can be built is asked, with any number of channels: how many a rule needs
 * depends on the level. */
static bool can_be_built(const struct machine_spec *m, struct err *e)
{
    struct arena *a = arena_create();
    const struct topology *t = topology_create(&m->topology, a, e);
    const enum routing_rule rule = m->network.routing;
    const bool fine =
        t != NULL && (rule == ROUTING_DETERMINISTIC || routing_create(t, rule, 0, a, e) != NULL);
    arena_destroy(a);
    return fine;
}

/* The place of an error: where the setting stands that its text begins with, which may be in a base
 * of the machine. */
static void place(struct err *e, const char *path, const struct origin *origin, int n)
{
    text_copy(e->file, sizeof e->file, path);
    for (int i = 0; i < n; i++) {
        const size_t length = strlen(origin[i].key);
        if (strncmp(e->text, origin[i].key, length) != 0 || origin[i].line == 0 ||
            strchr(": ", e->text[length]) == NULL)
            continue;
        text_copy(e->file, sizeof e->file, origin[i].file);
        e->line = origin[i].line;
    }
}

static bool check_machine(const char *path, struct err *e)
{
    struct arena *a = arena_create();
    struct machine_spec m;
    struct origin *origin = NULL;
    struct text as_path = {0};
    int n = 0;
    /* "./" in front: a name without a slash would be looked up among the shipped machines. */
    text_add(&as_path, "%s%s", strchr(path, '/') == NULL ? "./" : "", path);
    bool fine = plan_machine(&m, as_path.s, NULL, a, &origin, &n, e);
    if (fine && !can_be_built(&m, e)) place(e, path, origin, n), fine = false;
    text_free(&as_path);
    arena_destroy(a);
    return fine;
}

static bool check_scenario(const char *path, const struct plan_options *o, struct err *e)
{
    struct plan p;
    bool fine = plan_read(&p, path, o, e);
    /* Runs of a sweep mostly share their machine: only another one than the last is built. */
    const struct machine_spec *last = NULL;
    for (int i = 0; i < p.nrun && fine; i++) {
        const struct machine_spec *m = &p.run[i].machine;
        if (last != NULL && last->network.routing == m->network.routing &&
            memcmp(&last->topology, &m->topology, sizeof m->topology) == 0)
            continue;
        last = m;
        if (!can_be_built(m, e)) place(e, path, NULL, 0), fine = false;
    }
    plan_free(&p);
    return fine;
}

bool network_file_check(const char *path, const struct plan_options *o, struct err *e)
{
    struct arena *a = arena_create();
    const enum file_kind kind = file_kind_of(path, a);
    arena_destroy(a);
    return kind == FILE_MACHINE    ? check_machine(path, e)
           : kind == FILE_SCENARIO ? check_scenario(path, o, e)
                                   : true;
}

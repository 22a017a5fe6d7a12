/* cmd_netcheck.c - mimdsim netcheck: the network levels against files of reference answers. */
#include <stdlib.h>
#include <string.h>

#include "app/verb.h"
#include "base/text.h"
#include "run/netcheck.h"

static const char doc[] =
    "Run the cases of each FILE (makespans, collectives, latency against load, hand cases) through the network levels "
    "and "
    "print the error of each case and statistics.\n\n"
    "Example: mimdsim netcheck tests/data/net/makespan.json --level packet\n\v"
    "With --json one FILE gives one object, several give a list of objects. What a level cannot run is counted as "
    "skipped, with the reason.";

static bool level_of(const char *word, enum network_level *level, struct err *e)
{
    const char *name[NETCHECK_LEVELS];
    for (int l = 0; l < NETCHECK_LEVELS; l++) {
        name[l] = netcheck_level_name((enum network_level)l);
        if (strcmp(word, name[l]) == 0) *level = (enum network_level)l;
        if (strcmp(word, name[l]) == 0) return true;
    }
    const char *near = text_nearest(word, name, NETCHECK_LEVELS);
    return near ? err_set(e, ERR_USAGE, "there is no level '%s'; did you mean '%s'?", word, near)
                : err_set(e, ERR_USAGE, "there is no level '%s'; there are: loggp, link, packet, flit, auto", word);
}

static void print_one(const struct netcheck *n, const struct common *c, struct json *j)
{
    if (c->json) {
        netcheck_json_object(n, j);
        return;
    }
    if (c->narg > 1) printf("%s\n", n->path);
    netcheck_print(n, c->brief, stdout);
    if (c->narg > 1) putchar('\n');
}

/* Every file is read before anything is printed, so that a wrong one leaves no half answer. */
static bool check_files(const struct common *c, const bool *wanted, struct arena *a, struct err *e)
{
    struct netcheck *n = TAKE(a, c->narg, struct netcheck);
    for (int i = 0; i < c->narg; i++)
        if (!netcheck_run(&n[i], c->arg[i], wanted, NULL, c->quiet, a, e)) return false;
    struct json j = json_make(stdout);
    if (c->json && c->narg > 1) json_array(&j);
    for (int i = 0; i < c->narg; i++) print_one(&n[i], c, &j);
    if (c->json && c->narg > 1) json_end(&j);
    if (c->json) json_finish(&j);
    return true;
}

int cmd_netcheck(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, TAKES_LEVEL, "FILE...", doc, 1, 64);
    struct err e;
    err_clear(&e);
    enum network_level level = LEVEL_LOGGP;
    bool wanted[NETCHECK_LEVELS] = {false};
    bool ok = !c.level || level_of(c.level, &level, &e);
    if (ok && c.level) wanted[level] = true;
    struct arena *a = arena_create();
    ok = ok && check_files(&c, c.level ? wanted : NULL, a, &e);
    arena_destroy(a);
    return ok ? 0 : common_fail(&c, &e);
}

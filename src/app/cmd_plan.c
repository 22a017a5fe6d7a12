/* cmd_plan.c - mimdsim plan: the runs of a scenario, one a line, for engines that hand out work.
 *
 * The first column names a run for `mimdsim run SCENARIO --point`: hash of the settings and
 * repetition. */
#include <stdio.h>
#include <string.h>

#include "app/flag.h"
#include "app/shard.h"
#include "app/verb.h"
#include "base/json.h"

static const char doc[] = "List the runs of SCENARIO without running them: identity, kernel, "
                          "machine, n, P, seed and repetition.\n\n"
                          "Example: mimdsim plan fig6 --shards 4\n"
                          "         mimdsim plan fig6 | tail -n +2 | cut -f 1 | parallel mimdsim "
                          "run fig6 --point {} -o {}.db\n"
                          "\v--shards N adds the shard of N that each run belongs to (`mimdsim run "
                          "SCENARIO --shard K/N`). Columns are "
                          "separated by tabs, and the first line names them. --json, or "
                          "--format json, writes one document. `mimdsim run SCENARIO --point ID` "
                          "makes one of these runs, and `mimdsim merge` joins the databases.";

/* One run, columns separated by tabs for `cut`; the reason of a point that cannot run comes
 * last. */
static void line(const struct run_spec *r, int shards)
{
    char id[RUN_NAME];
    run_name(r, id);
    printf("%s\t%s\t%s\t%d\t%d\t%llu\t%d", id, r->kernel.name, r->machine.name, r->model.nbody,
           r->nrank, (unsigned long long)r->seed, r->rep);
    if (shards > 0) printf("\t%d", shard_of(r, shards));
    printf("%s%s\n", r->refused != NULL ? "\trefused: " : "", r->refused != NULL ? r->refused : "");
}

/* The same as an object of the document. */
static void row(struct json *j, const struct run_spec *r, int shards)
{
    char id[RUN_NAME];
    run_name(r, id);
    json_object(j);
    json_key_text(j, "id", id); /* the name that --point takes */
    json_key_text(j, "config_hash", r->config_hash);
    json_key_text(j, "kernel", r->kernel.name);
    json_key_text(j, "machine", r->machine.name);
    json_key_int(j, "n", r->model.nbody);
    json_key_int(j, "P", r->nrank);
    json_key_int(j, "seed", (int64_t)r->seed);
    json_key_int(j, "rep", r->rep);
    if (shards > 0) json_key_int(j, "shard", shard_of(r, shards));
    if (r->refused != NULL) json_key_text(j, "refused", r->refused);
    json_end(j);
}

/* A head and a line a run, or one list. Nothing is run, so nothing is stored. */
static void list(const struct common *c, const struct plan *p, int shards)
{
    struct json j = json_make(stdout);
    if (c->json) json_array(&j);
    else printf("id\tkernel\tmachine\tn\tP\tseed\trep%s\n", shards > 0 ? "\tshard" : "");
    for (int i = 0; i < p->nrun; i++)
        if (c->json) row(&j, &p->run[i], shards);
        else line(&p->run[i], shards);
    if (c->json) json_end(&j), json_finish(&j);
}

/* --shards N, 0 without it; checked by the parser of --shard. */
static bool read_shards(const char *text, int *shards, struct err *e)
{
    char whole[64];
    struct shard s;
    *shards = 0; /* without the option: no column */
    if (text == NULL) return true;
    snprintf(whole, sizeof whole, "1/%s", text);
    if (strlen(text) > 20 || !shard_parse(whole, &s, e))
        return err_set(e, ERR_USAGE, "--shards '%.40s': expected a number of shards, such as 8",
                       text);
    *shards = s.of;
    return true;
}

/* --format lines (the usual one) or json, which is --json by another name. */
static bool read_format(const char *text, bool *json, struct err *e)
{
    if (text == NULL || strcmp(text, "lines") == 0) return true;
    if (strcmp(text, "json") != 0)
        return err_set(e, ERR_USAGE, "--format '%.40s': expected lines or json", text);
    *json = true;
    return true;
}

/* Nothing is run and nothing stored. */
int cmd_plan(int argc, char **argv)
{
    struct common c;
    struct err e;
    struct plan p = {0};
    int shards; /* 0: not asked for */
    err_clear(&e);
    const char *text = take_value(&argc, argv, "--shards"),
               *format = take_value(&argc, argv, "--format");
    common_parse(&c, argc, argv, TAKES_PLAN, "SCENARIO", doc, 1, 1);
    const struct plan_options o = common_plan(&c);
    const bool ok = read_format(format, &c.json, &e) && read_shards(text, &shards, &e) &&
                    plan_read(&p, c.arg[0], &o, &e);
    if (ok) list(&c, &p, shards);
    plan_free(&p);
    return ok ? 0 : common_fail(&c, &e);
}

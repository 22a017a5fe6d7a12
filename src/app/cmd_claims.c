/* cmd_claims.c - mimdsim claims: the claims of the paper, judged by what a database holds. */
#include "app/arguments.h"
#include "app/explain_claims.h"
#include "app/flag.h"
#include "app/verb.h"
#include "report/claims.h"
#include "report/explanations.h"

static const char doc[] =
    "Judge the claims of the paper by the runs in DB (default paper.db) and print the table.\n"
    "--explain: search what the paper does not state (rates, overheads, operators, serial\n"
    "baseline, others' load) for the smallest change under which each claim that fails holds,\n"
    "and all together; answer in sentences, and draw explain-CLAIM.\n\n"
    "Example: mimdsim claims paper.db --json\n"
    "         mimdsim claims --explain paper.db\n\v"
    "The search is seeded, its points are stored: killed, it goes on where it was.\n"
    "--what-if: runs on changed machines (--set, a file of one's own) count, too; without\n"
    "it only runs on machines as shipped do. A claim whose runs are not all there is not\n"
    "testable; the text says which are missing and which command makes them.\n"
    "A claim that fails is a result, not an error: the exit status is 0 when all could be judged.";

static bool tell_explanations(const struct common *c, const struct claim_rules *rules, struct store *s, struct err *e)
{
    return explain_claims(c, rules, EXPLAIN_SEED, s, e) && explain_draw(c, s, e) &&
           explanations_print(s, c->json, stdout, e);
}

int cmd_claims(int argc, char **argv)
{
    struct common c;
    bool what_if = take_flag(&argc, argv, "--what-if");
    bool explain = take_flag(&argc, argv, "--explain");
    common_parse(&c, argc, argv, explain ? TAKES_STORE | TAKES_JOBS | TAKES_DIR : 0, "[DB]", doc, 0, 1);
    const char *path = c.narg ? c.arg[0] : "paper.db";
    struct err e;
    err_clear(&e);
    struct claim_rules rules = {0};
    /* a database that is not there is not made */
    struct store *s = arguments_database(&c, "paper.db", &e);
    bool ok = s != NULL && claims_read(&rules, plan_data_dir(), &e);
    rules.what_if = what_if;
    store_close(s);
    s = ok ? store_open(path, STORE_WRITE, &e) : NULL;
    ok = ok && s && claims_decide(&rules, s, &e) &&
         (explain ? tell_explanations(&c, &rules, s, &e) : claims_print(s, c.json, stdout, &e));
    store_close(s);
    claims_free(&rules);
    return ok ? 0 : common_fail(&c, &e);
}

/* cmd_claims.c - mimdsim claims: the claims of the paper, judged by what a database holds.
 *
 * A verdict is a row of table claim, written again each time: the rules or the runs may have
 * changed. */
#include "app/arguments.h"
#include "app/explain_claims.h"
#include "app/flag.h"
#include "app/verb.h"
#include "report/claims.h"
#include "report/explanations.h"

static const char doc[] =
    "Judge the claims of the paper by the runs in DB (default paper.db) and print the table.\n"
    "--explain: vary what the paper leaves open (rates, overheads, operators, serial baseline,\n"
    "load by others). Find the smallest change under which each failed claim holds, and under\n"
    "which all hold together; print the result as text, and draw explain-CLAIM.\n\n"
    "Example: mimdsim claims paper.db --json\n"
    "         mimdsim claims --explain paper.db\n"
    "\vThe search is seeded and its points are stored: after an interruption it continues.\n"
    "--what-if: include runs on changed machines (--set, or your own file of the same name);\n"
    "without it only runs on machines as shipped count. A claim is not testable if some of its\n"
    "runs are missing; the text names them and the command that makes them.\n"
    "A claim that fails is a result, not an error: the exit status is 0 if all could be judged.";

/* Searches, maps, then the sentences: these come from the table that the search filled. */
static bool tell_explanations(const struct common *c, const struct claim_rules *rules,
                              struct store *s, struct err *e)
{
    return explain_claims(c, rules, EXPLAIN_SEED, s, e) && explain_draw(c, s, e) &&
           explanations_print(s, c->json, stdout, e);
}

/* Verdicts go to the database and to standard output. Status 0 whatever they are: a claim that
 * fails is a result. */
int cmd_claims(int argc, char **argv)
{
    struct common c;
    bool what_if = take_flag(&argc, argv, "--what-if");
    bool explain = take_flag(&argc, argv, "--explain");
    /* Only --explain runs anything, so only then are jobs and folders options. */
    common_parse(&c, argc, argv, explain ? TAKES_STORE | TAKES_JOBS | TAKES_DIR : 0, "[DB]", doc, 0,
                 1);
    const char *path = c.narg ? c.arg[0] : "paper.db"; /* the study's own, by default */
    struct err e;
    err_clear(&e);
    /* Opened for reading first: a misspelt name must not make an empty database. */
    struct claim_rules rules = {0};
    struct store *s = arguments_look(&c, "paper.db", &e);
    bool ok = s != NULL && claims_read(&rules, plan_data_dir(), &e);
    rules.what_if = what_if; /* runs on changed machines count, too */
    store_close(s);
    s = ok ? arguments_store(&c, path, &e) : NULL;
    ok = ok && s && claims_decide(&rules, s, &e) &&
         (explain ? tell_explanations(&c, &rules, s, &e) : claims_print(s, c.json, stdout, &e));
    store_close(s);
    claims_free(&rules);
    return ok ? 0 : common_fail(&c, &e);
}

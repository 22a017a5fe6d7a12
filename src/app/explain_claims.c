/* explain_claims.c - which claims fail, searches for each and for all together, answers; see
 * explain_claims.h.
 *
 * For each failed claim: which of the numbers that the paper leaves open would have to be
 * different, and by how much. The search is over simulated points, so it takes minutes;
 * everything that it makes is stored. */
#include "app/explain_claims.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/explain_answer.h"
#include "app/explain_search.h"
#include "app/stored.h"
#include "base/check.h"
#include "base/progress.h"
#include "base/text.h"
#include "report/report.h"

enum { MOST_CLAIMS = 24, GOALS = 3, MOST_SEARCHES = GOALS * MOST_CLAIMS }; /* see add_searches */

/* One failing claim. */
struct inquiry {
    struct explain_subject subject;
    const struct claim_rule *rule; /* borrowed */
    int first, ngoal;                   /* its searches: the claim's own variant first */
    const struct explain_search *shown; /* the search that answers for it */
};

struct inquest {
    struct explain_bench bench;
    const struct claim_rules *rules; /* all claims, as read from plots/claims */
    uint64_t seed;
    bool failing[MOST_CLAIMS], judged[MOST_CLAIMS]; /* of rules->rule; judged: can be told at all */
    int n;
    struct inquiry claim[MOST_CLAIMS]; /* (n) those that fail */
    struct explain_search *search; /* (nsearch) */
    int nsearch; /* at most GOALS for each */
};

/* --- which claims ----------------------------------------------------------------------------- */

/* Verdicts of the claims themselves (variant ''). */
static bool take_verdict(void *context, int ncolumn, const char *const *name,
                         const char *const *value)
{
    struct inquest *q = context;
    (void)ncolumn;
    (void)name;
    for (int i = 0; i < q->rules->n && i < MOST_CLAIMS; i++)
        if (strcmp(q->rules->rule[i].id, value[0]) == 0) {
            q->failing[i] = strcmp(value[1], "fail") == 0;
            q->judged[i] = strcmp(value[1], "not-testable") != 0;
        }
    return true;
}

/* Each failed claim becomes a subject: its runs, its parameters, its known points. */
static bool find_failing(struct inquest *q)
{
    if (!store_select(q->bench.store, "SELECT id, verdict FROM claim WHERE variant = ''", 0, NULL,
                      take_verdict, q, q->bench.e))
        return false;
    for (int i = 0; i < q->rules->n && i < MOST_CLAIMS; i++) {
        const struct claim_rule *rule = &q->rules->rule[i];
        if (!q->failing[i]) continue;
        struct inquiry *c = &q->claim[q->n++];
        c->rule = rule;
        if (!explain_subject_make(&c->subject, &q->bench, rule->id, &rule, 1)) return false;
    }
    return true;
}

/* --- searches --------------------------------------------------------------------------------- */

/* More starts where the runs of a point are small, so that every claim takes about as long. */
static int starts_of(const struct explain_subject *s)
{
    enum { PROCESSORS = 1800 };
    int all = 1;
    for (int i = 0; i < s->nspec; i++) all += s->spec[i].nrank;
    int starts = PROCESSORS / all;
    return starts < 2 ? 2 : starts > EXPLAIN_STARTS ? EXPLAIN_STARTS : starts;
}

/* Only where the claim has runs with these operators. */
static void add_search(struct inquest *q, struct explain_subject *s, enum operators operators,
                       bool own, int starts, int steps)
{
    if (!s->has[operators]) return;
    q->search[q->nsearch++] =
        (struct explain_search){.goal = {.subject = s,
                                         .operators = operators,
                                         .own = own,
                                         .seed = q->seed,
                                         .starts = starts,
                                         .steps = steps,
                                         /* The last start may use parameters that are slow to
                                          * simulate, if the claim is cheap to run. */
                                         .dear = starts_of(s) == EXPLAIN_STARTS && own}};
}

/* Three searches: the claim as it is judged; then with either style of operators and any
 * baseline. A claim that is known never to hold is looked at along each axis alone, as a check
 * of the reason. */
static void add_searches(struct inquest *q, struct inquiry *c)
{
    enum { STEPS = 60 };
    int starts = c->rule->never ? 0 : starts_of(&c->subject);
    enum operators own = OPERATORS_STRUCTURED;
    if (!explain_own_operators(c->rule, own) || !c->subject.has[own]) own = OPERATORS_DENSE;
    c->first = q->nsearch;
    add_search(q, &c->subject, own, true, starts, STEPS);
    add_search(q, &c->subject, own, false, starts ? 1 : 0, STEPS);
    add_search(q, &c->subject, own == OPERATORS_DENSE ? OPERATORS_STRUCTURED : OPERATORS_DENSE,
               false, starts ? 1 : 0, STEPS);
    c->ngoal = q->nsearch - c->first;
}

/* All searches of all claims side by side: points of different claims fill the same batch. */
static bool search_claims(struct inquest *q)
{
    q->search = TAKE(q->bench.arena, MOST_SEARCHES, struct explain_search);
    for (int i = 0; i < q->n; i++) add_searches(q, &q->claim[i]);
    return explain_search_all(&q->bench, q->search, q->nsearch);
}

/* --- answers ---------------------------------------------------------------------------------- */

/* The best of a claim's searches. */
static struct explain_search *best_of(struct explain_search *search, int n)
{
    struct explain_search *best = NULL;
    for (int i = 0; i < n; i++)
        if (!best || explain_better(&search[i].best.grade, &best->best.grade)) best = &search[i];
    return best;
}

/* The claim's own variant first. Another one is told only where it holds and is the smaller
 * change. */
static bool answer_claim(struct inquest *q, struct inquiry *c)
{
    struct explain_search *own = &q->search[c->first], *any = best_of(own, c->ngoal);
    if (!explain_answer(&q->bench, own, "own", c->rule->never)) return false;
    c->shown = own->best.grade.holds || !any->best.grade.holds ? own : any;
    if (any != own && any->best.grade.holds &&
        !explain_answer(&q->bench, any, "any", c->rule->never))
        return false;
    return explain_map(&q->bench, c->shown);
}

/* --- all together ----------------------------------------------------------------------------- */

/* Where the searches of single claims ended, as one point: of each axis the largest change.
 * Claims of another machine have other axes. */
static void merge(const struct inquest *q, const struct explain_subject *s, double *u)
{
    for (int k = 0; k < q->n; k++) {
        const struct explain_search *x = q->claim[k].shown;
        if (!x || !x->best.grade.holds ||
            strcmp(x->goal.subject->space.machine, s->space.machine) != 0)
            continue;
        for (int i = 0; i < s->space.n; i++)
            if (!s->space.axis[i].dear && fabs(x->best.u[i]) > fabs(u[i])) u[i] = x->best.u[i];
    }
}

/* Whether claim i can be asked for together with others: it is judged, and alone it can hold. */
static bool can_hold(const struct inquest *q, int i)
{
    if (!q->judged[i] || q->rules->rule[i].nexplore == 0) return false;
    for (int k = 0; k < q->n; k++)
        if (q->claim[k].rule == &q->rules->rule[i]) return q->claim[k].shown->best.grade.holds;
    return true;
}

/* One point for all claims of a machine that can hold: a change that helps one may break
 * another. */
static bool answer_together(struct inquest *q)
{
    const struct claim_rule *rule[EXPLAIN_MOST_RULES];
    struct text without = {0};
    int n = 0;
    if (q->n == 0) return true;
    const char *machine = q->claim[0].subject.space.machine;
    for (int i = 0; i < q->rules->n && i < MOST_CLAIMS; i++) {
        char own[64];
        if (!q->judged[i] || q->rules->rule[i].nexplore == 0) continue;
        if (!explain_machine(&q->bench, &q->rules->rule[i], own)) return false;
        /* Only the machine of the first failed claim. */
        bool same = strcmp(own, machine) == 0;
        if (same && can_hold(q, i)) rule[n++] = &q->rules->rule[i];
        else if (same) text_add(&without, "%s%s", without.length ? ", " : "", q->rules->rule[i].id);
    }
    /* With each style of operators: one point for all must have one of them. */
    struct explain_subject *all = TAKE(q->bench.arena, 1, struct explain_subject);
    struct explain_search *search = TAKE(q->bench.arena, 2, struct explain_search);
    /* One claim is not "together". */
    bool ok = n < 2 || explain_subject_make(all, &q->bench, "together", rule, n);
    int nsearch = 0;
    for (int operators = 0; ok && n >= 2 && operators < 2; operators++) {
        if (!all->has[operators]) continue;
        struct explain_search *s = &search[nsearch++];
        s->goal = (struct explain_goal){.subject = all,
                                        .operators = (enum operators)operators,
                                        .seed = q->seed,
                                        .starts = 1,
                                        .steps = 30,
                                        .nfrom = 1};
        merge(q, all, s->goal.from[0]);
    }
    ok = ok && (nsearch == 0 ||
                (explain_search_all(&q->bench, search, nsearch) &&
                 explain_answer_together(&q->bench, best_of(search, nsearch), without.s)));
    text_free(&without);
    return ok;
}

/* --- the whole -------------------------------------------------------------------------------- */

/* What the answers depend on: seed, claims, their runs, and which claims are judged at all. */
static void identity(const struct inquest *q, char hex[65])
{
    struct text all = {0};
    text_add(&all, "%llu\n", (unsigned long long)q->seed);
    for (int i = 0; i < q->n; i++)
        text_add(&all, "%s %s\n", q->claim[i].rule->id, q->claim[i].subject.identity);
    for (int i = 0; i < q->rules->n && i < MOST_CLAIMS; i++)
        text_add(&all, "%d%s\n", q->judged[i], q->rules->rule[i].sql);
    stored_digest(&all, hex);
}

/* Remove what was answered before, also of claims that hold by now. */
static bool clear_answers(struct inquest *q)
{
    if (!store_begin(q->bench.store, q->bench.e)) return false;
    bool ok = store_delete(q->bench.store, "meta", "key", store_text("explain"), q->bench.e);
    for (int i = 0; ok && i <= q->rules->n; i++) {
        struct store_value subject =
            store_text(i < q->rules->n ? q->rules->rule[i].id : "together");
        ok = store_delete(q->bench.store, "explain_answer", "subject", subject, q->bench.e) &&
             store_delete(q->bench.store, "explain_map", "subject", subject, q->bench.e);
    }
    if (ok) return store_commit(q->bench.store, q->bench.e);
    store_rollback(q->bench.store);
    return false;
}

/* Clear, search, answer, and only then store the hash: an interrupted search begins again, with
 * the points that it made. */
static bool inquire(struct inquest *q)
{
    char hex[65], took[32];
    double began = host_seconds();
    if (!find_failing(q)) return false;
    identity(q, hex);
    /* Answered before, from the same runs and rules. */
    if (!q->bench.common->force && stored_is(q->bench.store, "explain", hex)) return true;
    if (!store_note_build(q->bench.store, q->bench.e) || !clear_answers(q) || !search_claims(q))
        return false;
    for (int i = 0; i < q->n; i++)
        if (!answer_claim(q, &q->claim[i])) return false;
    if (!answer_together(q)) return false;
    snprintf(took, sizeof took, "%.2f", host_seconds() - began);
    return stored_keep(q->bench.store, "explain_s", took, q->bench.e) &&
           stored_keep(q->bench.store, "explain", hex, q->bench.e);
}

bool explain_claims(const struct common *c, const struct claim_rules *rules, uint64_t seed,
                    struct store *s, struct err *e)
{
    struct inquest q = {.rules = rules, .seed = seed};
    q.bench = (struct explain_bench){.common = c,
                                     .store = s,
                                     .arena = arena_create(),
                                     .cache = run_cache_create(),
                                     .e = e};
    run_cache_repeat(q.bench.cache, true);
    bool ok = inquire(&q);
    store_close(q.bench.passing);
    run_cache_destroy(q.bench.cache);
    arena_destroy(q.bench.arena);
    return ok;
}

/* The maps. Without gnuplot, or without any map, that is no error. */
bool explain_draw(const struct common *c, struct store *s, struct err *e)
{
    struct err own;
    err_clear(&own);
    if (report_figure(s, plan_data_dir(), "explain", c->directory, &own) ||
        own.kind == ERR_NO_INPUT)
        return true;
    if (own.kind != ERR_UNAVAILABLE) return *e = own, false;
    err_print(&own);
    return true;
}

/* explain_points.c - subjects, their runs, and the points that were made; see explain_points.h.
 *
 * A point is judged by many runs. Each is therefore made once in the life of a
 * database: a hash table in memory finds it, table explain_point keeps it. */
#include "app/explain_points.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/stored.h"
#include "base/check.h"
#include "base/digest.h"
#include "base/text.h"
#include "run/run.h"

/* --- the cache -------------------------------------------------------------------------------- */

/* u in millionths: snapped points differ by more, and rounding by less. */
static uint64_t key_of(const struct explain_subject *s, enum operators operators, const double *u)
{
    uint64_t h = digest_mix(DIGEST_START, (uint64_t)operators);
    for (int i = 0; i < s->space.n; i++) h = digest_mix(h, (uint64_t)llround(1e6 * u[i]));
    return h;
}

/* Open addressing with linear probing: the place of the key, or the empty one where it belongs. */
static struct explain_point **slot_of(const struct explain_subject *s, uint64_t key)
{
    size_t mask = (size_t)s->capacity - 1, at = (size_t)key & mask;
    while (s->slot[at] && s->slot[at]->key != key) at = (at + 1) & mask;
    return &s->slot[at];
}

/* Four times as large each time; the old array stays in the arena. */
static void grow(struct explain_subject *s, struct arena *a)
{
    int old = s->capacity;
    struct explain_point **was = s->slot;
    s->capacity = old ? 4 * old : 1024; /* a power of two, as slot_of masks with it */
    s->slot = TAKE(a, s->capacity, struct explain_point *);
    for (int i = 0; i < old; i++)
        if (was[i]) *slot_of(s, was[i]->key) = was[i];
}

static void remember(struct explain_subject *s, struct explain_point *p, struct arena *a)
{
    /* At most half full, so that probing stays short. */
    if (2 * (s->npoint + 1) > s->capacity) grow(s, a);
    *slot_of(s, p->key) = p;
    s->npoint++;
}

const struct explain_point *explain_known(const struct explain_subject *s, enum operators operators,
                                          const double *u)
{
    return s->capacity ? *slot_of(s, key_of(s, operators, u)) : NULL;
}

/* --- subjects --------------------------------------------------------------------------------- */

/* The runs of "SCENARIO KEY=VALUE ...", appended to *spec. Their texts are copied into the
 * arena, as the plan is freed. */
static bool read_runs(struct explain_bench *b, const char *line, struct run_spec **spec, int *n)
{
    enum { MOST_WORDS = 16 };
    const char *word[MOST_WORDS];
    int nword = 0;
    /* Words are parts of a copy: strtok_r writes into it. */
    char *rest = arena_text(b->arena, line), *save = NULL;
    for (char *w = strtok_r(rest, " ", &save); w && nword < MOST_WORDS;
         w = strtok_r(NULL, " ", &save))
        word[nword++] = w;
    if (nword == 0) return err_set(b->e, ERR_DATA,
                                   "a line -- explore: or -- study: of a claim names no scenario");
    struct plan plan = {0};
    /* the words behind the scenario are its --set */
    struct plan_options o = {.nset = nword - 1, .set = word + 1};
    if (!plan_read(&plan, word[0], &o, b->e)) return false;
    struct run_spec *all = TAKE(b->arena, *n + plan.nrun, struct run_spec);
    if (*n) memcpy(all, *spec, (size_t)*n * sizeof *all);
    for (int i = 0; i < plan.nrun; i++) {
        all[*n + i] = plan.run[i];
        all[*n + i].config_text = arena_text(b->arena, plan.run[i].config_text);
        /* the plan's */
        all[*n + i].machine_changes = all[*n + i].machine_hash = all[*n + i].called = NULL;
    }
    *spec = all;
    *n += plan.nrun;
    plan_free(&plan);
    return true;
}

/* Runs that several lines name are made once: they are equal by their identity. */
static void drop_doubles(struct run_spec *spec, int *n)
{
    int kept = 0;
    for (int i = 0; i < *n; i++) {
        bool seen = false;
        for (int k = 0; k < kept; k++)
            seen = seen || strcmp(spec[k].config_hash, spec[i].config_hash) == 0;
        if (!seen) spec[kept++] = spec[i];
    }
    *n = kept;
}

/* A point changes one machine's parameters. */
static bool one_machine(const struct explain_subject *s, struct err *e)
{
    for (int i = 1; i < s->nspec; i++)
        if (strcmp(s->spec[i].machine.name, s->spec[0].machine.name) != 0)
            return err_set(e, ERR_DATA, "claim %s explores two machines, %s and %s", s->name,
                           s->spec[0].machine.name, s->spec[i].machine.name);
    return true;
}

/* One line is enough: a claim's lines are of one machine. */
bool explain_machine(struct explain_bench *b, const struct claim_rule *rule, char machine[64])
{
    struct run_spec *spec = NULL;
    int n = 0;
    CHECK(rule->nexplore > 0);
    if (!read_runs(b, rule->explore[0], &spec, &n)) return false;
    text_copy(machine, 64, spec[0].machine.name);
    return true;
}

/* The runs of all rules, each once, with either style of operators noted. */
static bool read_subject(struct explain_subject *s, struct explain_bench *b)
{
    for (int i = 0; i < s->nrule; i++) {
        if (s->rule[i]->nexplore == 0)
            return err_set(b->e, ERR_DATA,
                           "claim %s has no line -- explore: and cannot be explained",
                           s->rule[i]->id);
        for (int k = 0; k < s->rule[i]->nexplore; k++)
            if (!read_runs(b, s->rule[i]->explore[k], &s->spec, &s->nspec)) return false;
    }
    drop_doubles(s->spec, &s->nspec);
    for (int i = 0; i < s->nspec; i++)
        s->has[s->spec[i].kernel.operators == OPERATORS_DENSE] = true;
    return one_machine(s, b->e);
}

/* Points of other runs or of a changed claim are worth nothing. */
static void identify(struct explain_subject *s)
{
    struct text all = {0};
    stored_add_runs(&all, s->spec, s->nspec);
    for (int i = 0; i < s->nrule; i++) stored_add_claim(&all, s->rule[i]);
    stored_digest(&all, s->identity);
}

/* --- stored points ---------------------------------------------------------------------------- */

/* The state of reading stored points back. */
struct loading {
    struct explain_subject *subject; /* whose points are read */
    struct explain_bench *bench;
    struct explain_point *point; /* whose verdicts are being read */
};

/* A claim that is not asked for is -1. */
static int rule_of(const struct explain_subject *s, const char *id)
{
    for (int i = 0; i < s->nrule; i++)
        if (strcmp(s->rule[i]->id, id) == 0) return i;
    return -1;
}

enum { MOST_VERDICTS = 512 }; /* of one point: claims times variants */

/* To the verdicts of the point. */
static void add_verdict(struct explain_point *p, const struct explain_verdict *v, struct arena *a)
{
    /* Verdicts of a point come one after the other: the array grows in steps. */
    if (p->nverdict % 16 == 0) {
        struct explain_verdict *more = TAKE(a, p->nverdict + 16, struct explain_verdict);
        if (p->nverdict) memcpy(more, p->verdict, (size_t)p->nverdict * sizeof *more);
        p->verdict = more;
    }
    CHECK(p->nverdict < MOST_VERDICTS);
    p->verdict[p->nverdict++] = *v;
}

/* One row: (point id, key, claim, variant, value, margin, holds), ordered by point. A point
 * without verdicts has NULL as its claim. */
static bool load_row(void *context, int ncolumn, const char *const *name,
                     const struct store_value *value)
{
    struct loading *l = context;
    struct arena *a = l->bench->arena;
    (void)ncolumn;
    (void)name;
    if (!l->point || l->point->id != value[0].integer) {
        l->point = TAKE(a, 1, struct explain_point);
        l->point->id = value[0].integer;
        l->point->key = strtoull(value[1].text, NULL, 16);
        remember(l->subject, l->point, a);
    }
    struct explain_verdict v = {
        .rule = value[2].kind == STORE_TEXT ? rule_of(l->subject, value[2].text) : -1};
    /* A point with a verdict of another claim only is known all the same. */
    if (v.rule < 0) return true;
    v.variant = arena_text(a, value[3].text);
    v.value = value[4].kind == STORE_REAL ? value[4].real : NAN;
    v.margin = value[5].kind == STORE_REAL ? value[5].real : NAN;
    v.told = value[6].kind == STORE_INT;
    v.holds = v.told && value[6].integer;
    add_verdict(l->point, &v, a);
    return true;
}

/* The last number in use; 0 in an empty table. */
static bool take_id(void *context, int ncolumn, const char *const *name,
                    const struct store_value *value)
{
    (void)ncolumn;
    (void)name;
    *(int64_t *)context = value[0].kind == STORE_INT ? value[0].integer : 0;
    return false;
}

/* Answers, maps and points of an older identity go together, and the new identity is noted. */
static bool forget(struct explain_subject *s, struct explain_bench *b, const char *meta)
{
    struct store_value subject = store_text(s->name);
    if (!store_begin(b->store, b->e)) return false;
    bool ok = store_delete(b->store, "explain_answer", "subject", subject, b->e) &&
              store_delete(b->store, "explain_map", "subject", subject, b->e) &&
              store_delete(b->store, "explain_point", "subject", subject, b->e) &&
              stored_keep(b->store, meta, s->identity, b->e);
    if (ok) return store_commit(b->store, b->e);
    store_rollback(b->store);
    return false;
}

/* Points that are stored already are taken over; --force and a changed identity forget them. */
static bool load(struct explain_subject *s, struct explain_bench *b)
{
    struct text meta = {0};
    char stored[65];
    text_add(&meta, "explain.%s", s->name);
    const char *const subject[] = {s->name};
    bool ok = stored_note(b->store, meta.s, stored, b->e);
    if (ok && (b->common->force || strcmp(stored, s->identity) != 0)) ok = forget(s, b, meta.s);
    text_free(&meta);
    struct loading l = {s, b, NULL};
    return ok &&
           store_query(b->store,
                       "SELECT p.id, p.key, j.claim, j.variant, j.value, j.margin, j.holds FROM "
                       "explain_point p LEFT JOIN explain_judged j ON j.point_id = p.id WHERE "
                       "p.subject = ?1 ORDER BY p.id",
                       1, subject, NULL, load_row, &l, b->e) &&
           store_query(b->store, "SELECT max(id) FROM explain_point", 0, NULL, NULL, take_id,
                       &b->last_id, b->e);
}

/* Runs, axes, identity, stored points. */
bool explain_subject_make(struct explain_subject *s, struct explain_bench *b, const char *name,
                          const struct claim_rule *const *rule, int nrule)
{
    CHECK(nrule <= EXPLAIN_MOST_RULES);
    *s = (struct explain_subject){.name = arena_text(b->arena, name), .nrule = nrule};
    memcpy(s->rule, rule, (size_t)nrule * sizeof *rule);
    grow(s, b->arena);
    if (!read_subject(s, b) ||
        !explain_space_make(&s->space, s->spec[0].machine.name, b->arena, b->e))
        return false;
    identify(s);
    return load(s, b);
}

/* --- making points ---------------------------------------------------------------------------- */

/* One batch: the runs of all its points, point by point. */
struct batch {
    struct explain_bench *bench;
    const struct explain_request *request; /* (n) the points, in their order */
    struct run_spec *spec; /* (nspec) the runs of all points */
    int *of, nspec, kept; /* of: (nspec + 1) whose runs they are */
    struct explain_point *point; /* in the making */
    struct text runs; /* their hashes, for table explain_point */
    bool keep; /* false: for a look, nothing is stored */
};

/* One variant's verdict at the point in the making. */
static bool judge_variant(void *context, const struct claim_rule *rule, const struct judgement *j)
{
    struct batch *t = context;
    struct explain_subject *s = t->request[t->of[t->kept - 1]].subject;
    struct explain_verdict v = {.rule = rule_of(s, rule->id), .told = j->holds.kind == STORE_INT};
    v.variant = arena_text(t->bench->arena, j->variant);
    v.value = j->value.kind == STORE_REAL ? j->value.real : NAN;
    v.margin = j->margin;
    v.holds = v.told && j->holds.integer;
    add_verdict(t->point, &v, t->bench->arena);
    return true;
}

/* Verdicts of a point, with the point's transaction. */
static bool keep_verdicts(struct batch *t)
{
    static const char *const name[] = {"point_id", "claim", "variant", "value", "margin", "holds"};
    struct explain_subject *s = t->request[t->of[t->kept - 1]].subject;
    for (int i = 0; i < t->point->nverdict; i++) {
        const struct explain_verdict *v = &t->point->verdict[i];
        const struct store_value value[] = {
            store_int(t->point->id), store_text(s->rule[v->rule]->id),
            store_text(v->variant),  store_real(v->value),
            store_real(v->margin),   v->told ? store_int(v->holds) : store_null()};
        if (!store_insert(t->bench->store, "explain_judged", 6, name, value, t->bench->e))
            return false;
    }
    return true;
}

/* A point with its verdicts is one transaction: a search that is killed leaves whole points. */
static bool keep_point(struct batch *t)
{
    static const char *const name[] = {"id",       "subject",  "key",       "operators",
                                       "settings", "distance", "published", "runs"};
    const struct explain_request *q = &t->request[t->of[t->kept - 1]];
    char key[20];
    struct text settings = {0};
    /* As text, since SQLite's integers are signed. */
    snprintf(key, sizeof key, "%016" PRIx64, t->point->key);
    explain_space_settings(&q->subject->space, q->u, &settings);
    const struct store_value value[] = {
        store_int(t->point->id),
        store_text(q->subject->name),
        store_text(key),
        store_text(q->operators == OPERATORS_DENSE ? "dense" : "structured"),
        store_text(settings.s ? settings.s : ""),
        store_real(explain_space_distance(&q->subject->space, q->u)),
        store_int(explain_space_published(&q->subject->space, q->u)),
        store_text(t->runs.s)};
    struct err *e = t->bench->e;
    bool ok = store_begin(t->bench->store, e);
    if (ok) {
        ok = store_insert(t->bench->store, "explain_point", 8, name, value, e) && keep_verdicts(t);
        if (ok) ok = store_commit(t->bench->store, e);
        else store_rollback(t->bench->store);
    }
    text_free(&settings);
    return ok;
}

/* All runs of a point are there: judge it, store it, and empty the database for the next one. */
static bool finish_point(struct batch *t)
{
    const struct explain_request *q = &t->request[t->of[t->kept - 1]];
    struct explain_bench *b = t->bench;
    /* The point lives as long as the search; its runs end here. */
    struct explain_point *p = t->point = TAKE(b->arena, 1, struct explain_point);
    p->key = key_of(q->subject, q->operators, q->u);
    p->operators = q->operators;
    memcpy(p->u, q->u, sizeof p->u);
    for (int i = 0; i < q->subject->nrule; i++)
        if (!claims_judge(q->subject->rule[i], b->passing, "explored", judge_variant, t, b->e))
            return false;
    if (!store_clear(b->passing, b->e)) return false;
    /* A look (explain_confirm) uses other runs: its point must not be mixed with those of the
     * search. */
    if (t->keep) {
        p->id = ++b->last_id;
        if (!keep_point(t)) return false;
        remember(q->subject, p, b->arena);
        b->made++;
    }
    text_free(&t->runs);
    return true;
}

/* Results come in the order of the runs: a point is complete when the next run belongs to
 * another. */
static bool keep_result(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct batch *t = context;
    struct explain_bench *b = t->bench;
    int mine = t->of[t->kept]; /* the point that this run belongs to */
    if (!b->passing) b->passing = store_open("points", STORE_MEMORY, b->e);
    if (!b->passing || !store_put(b->passing, spec, NULL, r, b->e)) return false;
    text_add(&t->runs, "%s%.12s", t->runs.length ? " " : "", spec->config_hash);
    t->kept++;
    return t->of[t->kept] == mine || finish_point(t);
}

/* The runs of `from` with these operators, at a point: settings changed, identity anew. */
static void add_runs(struct batch *t, int request, const struct run_spec *from, int n,
                     struct arena *a)
{
    const struct explain_request *q = &t->request[request];
    for (int i = 0; i < n; i++) {
        if (from[i].kernel.operators != q->operators) continue;
        t->spec[t->nspec] = from[i];
        explain_space_apply(&q->subject->space, q->u, &t->spec[t->nspec], a);
        t->of[t->nspec++] = request;
    }
}

/* The entry behind the last run ends the last point. */
static bool run_batch(struct batch *t)
{
    t->of[t->nspec] = -1;
    struct explain_bench *b = t->bench;
    bool ok =
        run_campaign_again(t->spec, t->nspec, b->common->jobs, b->cache, keep_result, t, b->e);
    text_free(&t->runs);
    return ok;
}

/* The runs at the nominal point, in this process: what ranks do is the same at every point, and
 * workers, which are new in every batch, begin with it. What is wrong with a run shows there. */
static void warm_up(struct explain_bench *b, struct explain_subject *s)
{
    for (int i = 0; i < s->nspec && !s->warm; i++) {
        struct arena *a = arena_create();
        struct run_result *ignored = TAKE(a, 1, struct run_result);
        struct err refused;
        err_clear(&refused);
        run_sharing(&s->spec[i], NULL, b->cache, a, ignored, &refused);
        arena_destroy(a);
    }
    s->warm = true;
}

/* All points in one campaign: workers are busy until the last run. */
bool explain_make(struct explain_bench *b, const struct explain_request *request, int n)
{
    struct batch t = {.bench = b, .request = request, .keep = true};
    struct arena *a = arena_create();
    int most = 1;
    for (int i = 0; i < n; i++) most += request[i].subject->nspec;
    /* Room for all runs of all points, though only those with the right operators are made. */
    t.spec = TAKE(a, most, struct run_spec);
    t.of = TAKE(a, most, int);
    for (int i = 0; i < n; i++) {
        warm_up(b, request[i].subject);
        add_runs(&t, i, request[i].subject->spec, request[i].subject->nspec, a);
    }
    bool ok = run_batch(&t);
    arena_destroy(a);
    return ok;
}

/* The runs of the command that the rule needs, "mimdsim paper fig6"; none where it names no such
 * command. */
static bool read_study(struct explain_bench *b, const struct claim_rule *rule,
                       struct run_spec **spec, int *n)
{
    static const char *const verb[] = {"mimdsim paper ", "mimdsim run "};
    for (int i = 0; i < 2; i++)
        if (strncmp(rule->needs, verb[i], strlen(verb[i])) == 0)
            return read_runs(b, rule->needs + strlen(verb[i]), spec, n);
    return true;
}

/* The same point with the study's own runs, which are more than the search can afford. */
bool explain_confirm(struct explain_bench *b, struct explain_subject *s, enum operators operators,
                     const double *u, struct explain_point *out, int *nrun)
{
    struct explain_request q = {.subject = s, .operators = operators};
    struct batch t = {.bench = b, .request = &q};
    struct run_spec *study = NULL;
    int n = 0;
    memcpy(q.u, u, sizeof q.u);
    for (int i = 0; i < s->nrule; i++)
        if (!read_study(b, s->rule[i], &study, &n)) return false;
    drop_doubles(study, &n);
    t.spec = TAKE(b->arena, n + 1, struct run_spec);
    t.of = TAKE(b->arena, n + 1, int);
    *out = (struct explain_point){0};
    add_runs(&t, 0, study, n, b->arena);
    *nrun = t.nspec;
    if (t.nspec == 0) return true; /* no command is named: nothing to confirm with */
    bool ok = run_batch(&t);
    if (ok) *out = *t.point;
    return ok;
}

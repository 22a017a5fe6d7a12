/* sampling.c - drawing parameters, running the samples as one campaign, judging each; see
 * sampling.h.
 *
 * How much of a verdict hangs on numbers that nobody knows exactly? Each sample is the study in
 * small (the scenarios sample-*), with every uncertain parameter of its machine drawn from its
 * published range (study/uncertain.h, as `mimdsim run --uncertainty` does). */
#include "app/sampling.h"

#include <stdlib.h>
#include <string.h>

#include "app/stored.h"
#include "base/check.h"
#include "base/digest.h"
#include "base/progress.h"
#include "base/random.h"
#include "base/text.h"
#include "base/units.h"
#include "run/run.h"
#include "study/uncertain.h"

/* Fixed: samples are the same in every study, and stored ones are found again. */
enum { SAMPLING_SEED = 2002 };

/* A parameter with a published range. */
struct drawn {
    const char *machine; /* whose */
    struct uncertain parameter;
};

struct scene {
    const char *name; /* of the scenario */
    char machine[64];
};

struct sampler {
    const struct common *common;
    const struct claim_rules *rules;
    struct store *store;
    struct err *e;
    struct arena *arena;
    int nscene, nuncertain, nsample;
    struct scene *scene;
    struct drawn *uncertain;
    double *drawn;         /* (nsample x nuncertain) */
    struct plan *plan;     /* (nsample x nscene) */
    struct run_spec *spec; /* all of them, sample by sample */
    int nspec, *sample_of; /* (nspec) */
    struct store *passing; /* results of the sample in progress */
    int kept;              /* specs handed over so far */
};

/* All uncertain parameters of a machine, once, however many scenes it has. */
static bool add_machine(struct sampler *p, const char *machine)
{
    struct origin *origin;
    int n;
    struct machine_spec m;
    struct plan_options none = {0};
    for (int i = 0; i < p->nuncertain; i++)
        if (strcmp(p->uncertain[i].machine, machine) == 0) return true;
    if (!plan_machine(&m, machine, &none, p->arena, &origin, &n, p->e)) return false;
    struct uncertain *list;
    n = uncertain_list(origin, n, &m, UNCERTAIN_PRINTED, p->arena, &list);
    /* The whole list is copied for each machine. */
    struct drawn *u = TAKE(p->arena, p->nuncertain + n, struct drawn);
    if (p->nuncertain) memcpy(u, p->uncertain, (size_t)p->nuncertain * sizeof *u);
    p->uncertain = u;
    for (int i = 0; i < n; i++)
        u[p->nuncertain++] = (struct drawn){arena_text(p->arena, machine), list[i]};
    return true;
}

/* Scenarios called sample-*: a new one takes part without a line here. */
static bool find_scenes(struct sampler *p)
{
    const char **stem, **title;
    int n;
    if (!plan_list("scenarios", p->arena, &stem, &title, &n, p->e)) return false;
    p->scene = TAKE(p->arena, n + 1, struct scene);
    for (int i = 0; i < n; i++) {
        if (strncmp(stem[i], "sample-", 7) != 0) continue;
        struct plan plan = {0};
        struct plan_options none = {0};
        if (!plan_read(&plan, stem[i], &none, p->e)) return false;
        struct scene *scene = &p->scene[p->nscene++];
        scene->name = stem[i];
        text_copy(scene->machine, sizeof scene->machine, plan.run[0].machine.name);
        plan_free(&plan);
        if (!add_machine(p, scene->machine)) return false;
    }
    return p->nscene > 0 || err_set(p->e, ERR_NO_INPUT,
                                    "there is no scenario sample-*.yaml to sample with");
}

/* Every parameter has a random stream of its own, so a new one does not change the others'
 * draws. */
static double draw(const struct drawn *u, int sample)
{
    uint64_t name = DIGEST_START;
    for (const char *s = u->parameter.key; *s; s++) name = digest_mix(name, (unsigned char)*s);
    for (const char *s = u->machine; *s; s++) name = digest_mix(name, (unsigned char)*s);
    struct random r = random_make(SAMPLING_SEED, (uint64_t)sample, name);
    return uncertain_value(&u->parameter, random_uniform(&r, 0, 1));
}

/* "machine.KEY=VALUE", as --set takes it: the value is read back with all its digits. */
static const char *setting(struct sampler *p, const struct drawn *u, double value)
{
    struct text t = {0};
    char number[64];
    units_print(value, u->parameter.field->unit, number, sizeof number);
    text_add(&t, "machine.%s=%s", u->parameter.key, number);
    const char *s = arena_text(p->arena, t.s);
    text_free(&t);
    return s;
}

/* One scenario in one sample: only the parameters of its own machine are set. */
static bool read_plan(struct sampler *p, int sample, int scene)
{
    const char **set = TAKE(p->arena, p->nuncertain + 1, const char *);
    int n = 0;
    for (int i = 0; i < p->nuncertain; i++)
        if (strcmp(p->uncertain[i].machine, p->scene[scene].machine) == 0)
            set[n++] = setting(p, &p->uncertain[i], p->drawn[sample * p->nuncertain + i]);
    struct plan_options o = {.nset = n, .set = set};
    return plan_read(&p->plan[sample * p->nscene + scene], p->scene[scene].name, &o, p->e);
}

/* Draws, plans, then all runs in one array, sample by sample. */
static bool read_plans(struct sampler *p)
{
    p->drawn = TAKE(p->arena, size_sum(size_product(p->nsample, p->nuncertain), 1), double);
    p->plan = TAKE(p->arena, size_product(p->nsample, p->nscene), struct plan);
    for (int s = 0; s < p->nsample; s++)
        for (int i = 0; i < p->nuncertain; i++)
            p->drawn[s * p->nuncertain + i] = draw(&p->uncertain[i], s);
    for (int s = 0; s < p->nsample; s++)
        for (int k = 0; k < p->nscene; k++) {
            if (!read_plan(p, s, k)) return false;
            p->nspec += p->plan[s * p->nscene + k].nrun;
        }
    p->spec = TAKE(p->arena, p->nspec, struct run_spec);
    p->sample_of = TAKE(p->arena, p->nspec + 1, int);
    int at = 0;
    for (int i = 0; i < p->nsample * p->nscene; i++)
        for (int k = 0; k < p->plan[i].nrun; k++) {
            p->spec[at] = p->plan[i].run[k];
            p->sample_of[at++] = i / p->nscene;
        }
    /* ends the last sample */
    p->sample_of[at] = -1;
    return true;
}

/* What the samples depend on: every configuration and every claim. A changed claim is judged
 * anew. */
static void identity(const struct sampler *p, char hex[65])
{
    struct text all = {0};
    stored_add_runs(&all, p->spec, p->nspec);
    for (int i = 0; i < p->rules->n; i++) stored_add_claim(&all, &p->rules->rule[i]);
    stored_digest(&all, hex);
}

/* What was drawn, for figures that show a verdict against a parameter. */
static bool keep_settings(struct sampler *p, int sample)
{
    static const char *const name[] = {"sample", "key", "value"};
    for (int i = 0; i < p->nuncertain; i++) {
        struct text key = {0};
        text_add(&key, "%s.%s", p->uncertain[i].machine, p->uncertain[i].parameter.key);
        const struct store_value value[] = {store_int(sample), store_text(key.s),
                                            store_real(p->drawn[sample * p->nuncertain + i])};
        bool ok = store_insert(p->store, "sample_setting", 3, name, value, p->e);
        text_free(&key);
        if (!ok) return false;
    }
    return true;
}

/* All runs of a sample are there: judge all claims by them, then forget the runs. */
static bool finish_sample(struct sampler *p, int sample)
{
    return store_commit(p->passing, p->e) &&
           claims_sample(p->rules, p->passing, p->store, sample, p->e) &&
           store_clear(p->passing, p->e);
}

/* Results come in the order of the runs, whatever worker made them: a sample is complete when
 * the next run belongs to another. */
static bool keep_result(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct sampler *p = context;
    int sample = p->sample_of[p->kept];
    const bool first = p->kept == 0 || p->sample_of[p->kept - 1] != sample;
    if (!p->passing) p->passing = store_open("samples", STORE_MEMORY, p->e);
    if (!p->passing || (first && !store_begin(p->passing, p->e))) return false;
    if (!store_put(p->passing, spec, NULL, r, p->e)) return false;
    p->kept++;
    return p->sample_of[p->kept] == sample || finish_sample(p, sample);
}

/* In one transaction: no verdict of old samples stays beside new ones. */
static bool clear_tables(struct sampler *p)
{
    bool ok = store_begin(p->store, p->e);
    if (!ok) return false;
    ok = store_delete(p->store, "meta", "key", store_text("samples"), p->e);
    for (int i = 0; ok && i < p->rules->n; i++)
        ok = store_delete(p->store, "claim_sample", "id", store_text(p->rules->rule[i].id), p->e);
    for (int i = 0; ok && i < p->nsample; i++)
        ok = store_delete(p->store, "sample_setting", "sample", store_int(i), p->e) &&
             keep_settings(p, i);
    if (ok) return store_commit(p->store, p->e);
    store_rollback(p->store);
    return false;
}

/* The hash is stored last: an interrupted sampling begins again. */
static bool run_samples(struct sampler *p)
{
    char hex[65];
    identity(p, hex);
    if (!p->common->force && stored_is(p->store, "samples", hex)) return true;
    if (!p->common->quiet)
        fprintf(stderr, "mimdsim: %d samples of %d uncertain parameters, %d runs\n", p->nsample,
                p->nuncertain, p->nspec);
    double began = host_seconds();
    char took[32];
    bool ok = clear_tables(p) && run_campaign(p->spec, NULL, p->nspec, NULL, p->common->jobs,
                                              p->common->quiet, keep_result, p, p->e);
    snprintf(took, sizeof took, "%.2f", host_seconds() - began);
    return ok && stored_keep(p->store, "samples_s", took, p->e) &&
           stored_keep(p->store, "samples", hex, p->e);
}

/* Scenes, draws and plans, then one campaign of all samples. */
bool sampling_run(const struct common *c, const struct claim_rules *rules, int nsample,
                  struct store *s, struct err *e)
{
    struct sampler p = {.common = c,
                        .rules = rules,
                        .store = s,
                        .e = e,
                        .arena = arena_create(),
                        .nsample = nsample};
    bool ok = find_scenes(&p) && read_plans(&p) && run_samples(&p);
    for (int i = 0; p.plan && i < p.nsample * p.nscene; i++) plan_free(&p.plan[i]);
    store_close(p.passing);
    arena_destroy(p.arena);
    return ok;
}

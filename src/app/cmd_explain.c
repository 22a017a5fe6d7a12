/* cmd_explain.c - mimdsim explain: what will be run, what is left out and why, what it will cost. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/flag.h"
#include "app/verb.h"
#include "base/check.h"
#include "base/json.h"
#include "base/units.h"
#include "run/run.h"

static const char doc[] =
    "Show what SCENARIO will run, without running it: points, messages, operations, and the time and\n"
    "memory they will take on this computer.\n\n"
    "Example: mimdsim explain scenarios/speedup-t3e.yaml\n\v"
    "--measure: run the largest point with each of the omissions put back, and tell what it saves.";

enum { MOST_KINDS = 4 * RUN_MAX_OMISSIONS };

struct totals {
    double host_s, host_bytes;
};

static void add(struct totals *t, const struct run_estimate *r)
{
    t->host_s += r->host_s;
    if (r->host_bytes > t->host_bytes) t->host_bytes = r->host_bytes;
}

/* The omissions of a plan's runs, each kind once. */
struct kinds {
    int n;
    struct kind {
        struct omission omission;
        int runs; /* that leave it out */
    } kind[MOST_KINDS];
};

static struct kinds *kinds_of(const struct plan *p, const struct run_estimate *r)
{
    struct kinds *k = calloc(1, sizeof *k);
    CHECK(k);
    for (int i = 0; i < p->nrun; i++)
        for (int j = 0; j < r[i].nomission; j++) {
            const struct omission *o = &r[i].omission[j];
            int at = 0;
            while (at < k->n && (strcmp(k->kind[at].omission.what, o->what) != 0 ||
                                 strcmp(k->kind[at].omission.why, o->why) != 0))
                at++;
            if (at == MOST_KINDS) continue;
            if (at == k->n) k->kind[k->n++].omission = *o;
            k->kind[at].runs++;
            if (o->bound > k->kind[at].omission.bound) k->kind[at].omission.bound = o->bound;
        }
    return k;
}

static void print_text(const struct plan *p, const struct run_estimate *r)
{
    struct totals t = {0};
    printf("%s\n%d runs\n\n%-10s %-12s %8s %8s %12s %12s %12s %10s %10s\n", p->question, p->nrun, "kernel",
           "formulation", "n", "P", "messages", "MB sent", "Mflop", "host s", "host MB");
    for (int i = 0; i < p->nrun; i++) {
        const struct run_spec *s = &p->run[i];
        printf("%-10s %-12s %8lld %8d %12.0f %12.3f %12.3f %10.4f %10.1f\n", s->kernel.name,
               s->kernel.formulation == FORMULATION_PAPER ? "paper" : "direct", (long long)r[i].nbody, s->nrank,
               r[i].messages, r[i].bytes / 1e6, r[i].flops / 1e6, r[i].host_s, r[i].host_bytes / 1e6);
        add(&t, &r[i]);
    }
    if (p->nrun && r[0].metre > 0 && (r[0].metre != 1 || r[0].kilogram != 1 || r[0].second != 1))
        printf("\nthe model computes in units of %.9g m, %.9g kg, %.9g s\n", r[0].metre, r[0].kilogram, r[0].second);
    printf("\nestimated: %.2f s of one processor, %.0f MB at most\n", t.host_s, t.host_bytes / 1e6);
    struct kinds *k = kinds_of(p, r);
    for (int i = 0; i < k->n; i++) {
        const struct omission *o = &k->kind[i].omission;
        printf("left out (");
        if (o->bound > 0) printf("bounded by %.1e", o->bound);
        else printf("exact");
        printf("%s", k->kind[i].runs < p->nrun ? ", " : "");
        if (k->kind[i].runs < p->nrun) printf("in %d of %d runs", k->kind[i].runs, p->nrun);
        printf("): %s: %s\n", o->what, o->why);
    }
    free(k);
    for (int i = 0; i < p->nunused; i++) printf("unused: %s\n", p->unused[i]);
}

static void json_pair(struct json *j, const char *key, double value)
{
    json_key(j, key);
    json_real(j, value);
}

static void json_kinds(struct json *j, const struct plan *p, const struct run_estimate *r)
{
    struct kinds *k = kinds_of(p, r);
    json_key(j, "omissions");
    json_array(j);
    for (int i = 0; i < k->n; i++) {
        const struct omission *o = &k->kind[i].omission;
        json_object(j);
        json_key(j, "bound");
        if (o->bound > 0) json_real(j, o->bound);
        else json_null(j);
        json_key(j, "class");
        json_text(j, o->bound > 0 ? "bounded" : "exact");
        json_pair(j, "runs", k->kind[i].runs);
        json_key(j, "what");
        json_text(j, o->what);
        json_key(j, "why");
        json_text(j, o->why);
        json_end(j);
    }
    json_end(j);
    free(k);
}

static void print_json(const struct plan *p, const struct run_estimate *r)
{
    struct json j = json_make(stdout);
    json_object(&j);
    json_kinds(&j, p, r);
    json_key(&j, "question");
    json_text(&j, p->question);
    json_key(&j, "runs");
    json_array(&j);
    for (int i = 0; i < p->nrun; i++) {
        json_object(&j);
        json_pair(&j, "bodies", (double)r[i].nbody);
        json_pair(&j, "bytes", r[i].bytes);
        json_pair(&j, "flops", r[i].flops);
        json_pair(&j, "host_bytes", r[i].host_bytes);
        json_pair(&j, "host_s", r[i].host_s);
        json_key(&j, "kernel");
        json_text(&j, p->run[i].kernel.name);
        json_pair(&j, "messages", r[i].messages);
        json_pair(&j, "ranks", p->run[i].nrank);
        json_end(&j);
    }
    json_end(&j);
    json_key(&j, "unused");
    json_array(&j);
    for (int i = 0; i < p->nunused; i++) json_text(&j, p->unused[i]);
    json_end(&j);
    json_end(&j);
    json_finish(&j);
}

/* The point with the most messages: where leaving out saves most. */
static int largest_point(const struct plan *p, const struct run_estimate *r)
{
    int best = 0;
    for (int i = 1; i < p->nrun; i++)
        if (r[i].messages > r[best].messages) best = i;
    return best;
}

/* The shortest host time of a few runs, whole runs with their references, and what they predict. */
static bool time_run(const struct run_spec *spec, double *host_s, int64_t *machine_ps, struct err *e)
{
    *host_s = INFINITY;
    for (int i = 0; i < 3; i++) {
        struct arena *a = arena_create();
        struct run_result result;
        bool ok = run_one(spec, a, &result, e);
        if (ok && result.host_total_s < *host_s) *host_s = result.host_total_s;
        if (ok) *machine_ps = result.makespan_ps;
        arena_destroy(a);
        if (!ok) return false;
    }
    return true;
}

/* What each omission saves: the same run with it put back, less the run without. */
static bool print_savings(const struct plan *p, const struct run_estimate *r, struct err *e)
{
    int at = p->nrun > 0 ? largest_point(p, r) : 0;
    struct run_spec spec = p->nrun > 0 ? p->run[at] : (struct run_spec){0};
    double host_s, with_s;
    int64_t machine_ps, with_ps;
    if (p->nrun == 0) return true;
    if (!time_run(&spec, &host_s, &machine_ps, e)) return false;
    printf("\nmeasured with P = %d: %.3f ms of this computer, %.3f us of the machine\n", spec.nrank, host_s * 1e3,
           (double)machine_ps * 1e-6);
    for (int k = 0; k < r[at].nomission; k++) {
        const struct omission *o = &r[at].omission[k];
        spec.keep = o->keep;
        if (o->keep == 0) {
            printf("  %-40s cannot be put back\n", o->what);
            continue;
        }
        if (!time_run(&spec, &with_s, &with_ps, e)) return false;
        printf("  %-40s saves %+.3f ms and %+.3f us\n", o->what, (with_s - host_s) * 1e3,
               (double)(with_ps - machine_ps) * 1e-6);
    }
    return true;
}

static bool estimate_all(const struct plan *p, struct run_estimate *r, struct err *e)
{
    for (int i = 0; i < p->nrun; i++)
        if (!run_explain(&p->run[i], &r[i], e)) return false;
    return true;
}

int cmd_explain(int argc, char **argv)
{
    struct common c;
    bool measure = take_flag(&argc, argv, "--measure");
    common_parse(&c, argc, argv, TAKES_PLAN, "SCENARIO", doc, 1, 1);
    struct err e;
    err_clear(&e);
    struct plan p = {0};
    struct plan_options o = common_plan(&c);
    bool ok = plan_read(&p, c.arg[0], &o, &e);
    struct run_estimate *r = calloc(ok && p.nrun ? (size_t)p.nrun : 1, sizeof *r);
    ok = ok && r && estimate_all(&p, r, &e);
    if (ok && c.json) print_json(&p, r);
    else if (ok) print_text(&p, r);
    if (ok && measure && !c.json) ok = print_savings(&p, r, &e);
    free(r);
    plan_free(&p);
    return ok ? 0 : common_fail(&c, &e);
}

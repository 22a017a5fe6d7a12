/* stability.c - walks through the scenes; see stability.h. */
#include "study/stability.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/json.h"
#include "base/progress.h"
#include "base/text.h"
#include "study/stability_scene.h"

const char *stability_word(enum stability_status s)
{
    static const char *const word[] = {"ok", "degraded", "failed"};
    return word[s];
}

/* Points of a scenario by what their models have: bodies as built, a base that is not fixed. */
static void name_scene(const struct stability_scene *c, const struct model *m, char *name, int size)
{
    static const char *const base[] = {"", ", moving", ", floating"};
    if (!c->complete) snprintf(name, (size_t)size, "%s", c->name);
    else snprintf(name, (size_t)size, "%.40s, n = %d%s", c->name, m->nbody, base[c->spec.base]);
}

static bool measure_scene(struct stability_report *r, const struct stability_scene *c, int most_bodies, struct err *e)
{
    struct arena *a = arena_create();
    struct model *m;
    struct state *s;
    bool good = (most_bodies > 0 && c->spec.nbody > most_bodies);
    if (!good) {
        good = scene_build(c, a, &m, &s, e);
        char name[64] = "";
        if (good) name_scene(c, m, name, (int)sizeof name);
        if (good) stability_accelerations(r, name, m, s, true, a);
        if (good && c->moves) stability_motion(r, name, m, s, c->spec.damping > 0, a);
        else if (good) stability_energy(r, name, m, s, a);
    }
    arena_destroy(a);
    return good;
}

static bool measure_suite(struct stability_report *r, int most_bodies, bool quiet, struct err *e)
{
    int n;
    const struct stability_scene *c = scene_list(&n);
    struct progress p = progress_make("scenes", n, quiet);
    for (int i = 0; i < n; i++) {
        if (!measure_scene(r, &c[i], most_bodies, e)) return false;
        progress_show(&p, i + 1);
    }
    progress_end(&p);
    return true;
}

/* The points of a scenario that are different scenes: kernels, levels and processors make no other. */
static bool measure_points(struct stability_report *r, const struct run_spec *spec, int nspec, int most_bodies,
                           bool quiet, struct err *e)
{
    struct progress p = progress_make("scenes", nspec, quiet);
    for (int i = 0; i < nspec; i++) {
        bool seen = false;
        for (int k = 0; k < i && !seen; k++) seen = memcmp(&spec[k].model, &spec[i].model, sizeof spec[i].model) == 0;
        if (seen) continue;
        if (!kernel_spec_needs_model(&spec[i].kernel))
            return err_set(e, ERR_CONFIG, "kernel '%s' has no scene", spec[i].kernel.name);
        char name[64];
        snprintf(name, sizeof name, "%.28s point %d", spec[i].scenario, i + 1);
        struct stability_scene c = {.name = name, .spec = spec[i].model, .complete = true};
        c.moves = c.spec.stiffness > 0 || c.spec.damping > 0;
        if (!measure_scene(r, &c, most_bodies, e)) return false;
        progress_show(&p, i + 1);
    }
    progress_end(&p);
    return true;
}

bool stability_measure(const struct run_spec *spec, int nspec, int most_bodies, bool quiet, struct arena *a,
                       struct stability_report *r, struct err *e)
{
    double begin = host_seconds();
    *r = (struct stability_report){.arena = a, .suite = "suite"};
    if (nspec > 0) text_copy(r->suite, sizeof r->suite, spec[0].scenario);
    bool good = nspec > 0 ? measure_points(r, spec, nspec, most_bodies, quiet, e)
                          : measure_suite(r, most_bodies, quiet, e);
    r->host_s = host_seconds() - begin;
    return good;
}

/* --- printing --------------------------------------------------------------------------------------------------- */

static void print_number(FILE *out, double x)
{
    if (isfinite(x)) fprintf(out, "%9.1e", x);
    else fprintf(out, "%9s", "-");
}

static void print_row(FILE *out, const struct stability_row *x)
{
    fprintf(out, "%-27s %-22s %-7s %-9s", x->subject, x->algorithm, x->precision, stability_word(x->status));
    print_number(out, x->error);
    print_number(out, x->residual);
    print_number(out, x->condition);
    print_number(out, x->growth);
    if (x->refinements >= 0) fprintf(out, "%4d", x->refinements);
    else fprintf(out, "%4s", "-");
    print_number(out, x->energy_drift);
    print_number(out, x->step_s);
    fprintf(out, "  %s\n", x->reason);
}

void stability_print(FILE *out, const struct stability_report *r)
{
    int count[3] = {0}, by_algorithm = 0;
    fprintf(out, "%-27s %-22s %-7s %-9s%9s%9s%9s%9s%4s%9s%9s\n", "case", "algorithm", "prec", "status", "error",
            "residual", "cond", "growth", "ref", "energy", "step");
    for (int i = 0; i < r->nrow; i++) {
        print_row(out, &r->row[i]);
        count[r->row[i].status]++;
        by_algorithm += r->row[i].cause == CAUSE_ALGORITHM;
    }
    fprintf(out, "\n%d ok, %d degraded, %d failed of %d; %d not by rounding: the algorithm fails\n", count[0], count[1],
            count[2], r->nrow, by_algorithm);
}

static void json_number(struct json *j, const char *key, double value)
{
    json_key(j, key);
    json_real(j, value);
}

static void json_pair(struct json *j, const char *key, const char *value)
{
    json_key(j, key);
    json_text(j, value);
}

void stability_print_json(FILE *out, const struct stability_report *r)
{
    static const char *const cause[] = {"", "rounding", "algorithm-fails"};
    struct json j = json_make(out);
    json_object(&j);
    json_key(&j, "rows");
    json_array(&j);
    for (int i = 0; i < r->nrow; i++) {
        const struct stability_row *x = &r->row[i];
        json_object(&j);
        json_pair(&j, "algorithm", x->algorithm);
        json_pair(&j, "case", x->subject);
        json_pair(&j, "cause", cause[x->cause]);
        json_number(&j, "condition", x->condition);
        json_number(&j, "energy_drift", x->energy_drift);
        json_number(&j, "error", x->error);
        json_number(&j, "growth", x->growth);
        json_pair(&j, "precision", x->precision);
        json_pair(&j, "reason", x->reason);
        json_number(&j, "refinements", x->refinements >= 0 ? (double)x->refinements : (double)NAN);
        json_number(&j, "residual", x->residual);
        json_pair(&j, "status", stability_word(x->status));
        json_number(&j, "step_s", x->step_s);
        json_end(&j);
    }
    json_end(&j);
    json_pair(&j, "suite", r->suite);
    json_end(&j);
    json_finish(&j);
}

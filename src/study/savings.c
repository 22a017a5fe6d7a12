/* savings.c - see savings.h. Times are compared only with times taken in turn with them: what
 * disturbs one round of runs disturbs all that are compared. */
#include "study/savings.h"

#include <math.h>
#include <string.h>

#include "base/progress.h"
#include "base/text.h"
#include "measure/run_row.h"

/* Rounds of runs, the time after which no more are begun, and the least that counts as noise: 1
 * %. */
enum { LEAST_ROUNDS = 5, MOST_ROUNDS = 200 };
static const double longest_run_s = 0.25, round_budget_s = 1.0, least_noise = 0.01;

/* The three shortest of some times, in order. The shortest is what the run takes when nothing
 * disturbs it; the third shows how well it is known. */
struct shortest {
    double time[3];
};

/* Insertion into three places: the longer time moves on. */
static void shortest_add(struct shortest *s, double x)
{
    for (int i = 0; i < 3; i++)
        if (x < s->time[i]) {
            double longer = s->time[i];
            s->time[i] = x;
            x = longer;
        }
}

/* What chance does to the shortest: how far apart three runs of the same kind are. */
static double spread_of(const struct shortest *s) { return s->time[2] - s->time[0]; }

/* One run as part of a campaign: what runs share is in the cache, and is not timed again.
 * Processor time, not wall time: other programs of the computer do not count. */
static bool time_run(const struct run_spec *spec, unsigned keep, struct run_cache *cache,
                     struct shortest *host, int64_t *machine_ps, struct err *e)
{
    /* `keep` has a bit for each omission that is to be undone. */
    const struct run_order order = {.keep = keep};
    struct run_result result;
    struct arena *a = arena_create();
    double begin = host_processor_seconds();
    bool ok = run_sharing(spec, &order, cache, a, &result, e);
    shortest_add(host, host_processor_seconds() - begin);
    if (ok) *machine_ps = result.makespan_ps;
    arena_destroy(a);
    return ok;
}

/* The omissions that are measured at one point, each undone alone, and in turn with them the
 * point without any undone, twice a round: what differs between these two halves is chance. */
static bool measure_point(const struct run_spec *spec, struct savings *all, const int *item, int n,
                          struct run_cache *cache, struct err *e)
{
    const struct shortest none = {{INFINITY, INFINITY, INFINITY}};
    struct shortest base[2] = {none, none}, with[MOST_SAVINGS];
    int64_t base_ps = 0, with_ps[MOST_SAVINGS] = {0};
    double begin = host_seconds();
    for (int i = 0; i < n; i++) with[i] = none;
    /* Rounds interleave what is compared: a slow second slows all of it. */
    for (int round = 0; round < MOST_ROUNDS; round++) {
        if (round >= LEAST_ROUNDS && host_seconds() - begin > round_budget_s) break;
        if (!time_run(spec, 0, cache, &base[0], &base_ps, e)) return false;
        for (int i = 0; i < n; i++)
            if (!time_run(spec, all->item[item[i]].omission.keep, cache, &with[i], &with_ps[i], e))
                return false;
        if (!time_run(spec, 0, cache, &base[1], &base_ps, e)) return false;
    }
    /* Noise: the difference of the two halves, their spreads, and at least 1 %. */
    double least = fmin(base[0].time[0], base[1].time[0]);
    double chance = fmax(fabs(base[0].time[0] - base[1].time[0]), least_noise * least);
    chance = fmax(chance, fmax(spread_of(&base[0]), spread_of(&base[1])));
    for (int i = 0; i < n; i++) {
        struct saving *s = &all->item[item[i]];
        s->measured = true;
        s->host_s = least;
        /* With the omission undone minus with it made. */
        s->host_saved_s = with[i].time[0] - least;
        s->noise_s = fmax(chance, spread_of(&with[i]));
        s->machine_ps = base_ps;
        s->machine_saved_ps = with_ps[i] - base_ps;
    }
    return true;
}

/* Whether run a tells more than run b: the larger of those that take a moment, otherwise the
 * shorter. */
static bool tells_more(const struct run_estimate *a, const struct run_estimate *b)
{
    /* Estimates of host time: nothing is run to choose a point. */
    bool a_short = a->host_s <= longest_run_s, b_short = b->host_s <= longest_run_s;
    if (a_short != b_short) return a_short;
    return a_short ? a->messages > b->messages : a->host_s < b->host_s;
}

/* An omission is known by what it leaves out. */
static int find(const struct savings *all, const char *what)
{
    for (int i = 0; i < all->n; i++)
        if (strcmp(all->item[i].omission.what, what) == 0) return i;
    return -1;
}

/* Each omission once, with the run that shows it best in point[]: the same one occurs at most
 * points of a scenario. */
static void collect(const struct plan *p, const struct run_estimate *r, struct savings *all,
                    int *point)
{
    for (int i = 0; i < p->nrun; i++)
        for (int k = 0; k < r[i].nomission; k++) {
            const struct omission *o = &r[i].omission[k];
            int at = find(all, o->what);
            /* More kinds of omissions than the table holds would be a new program; the first
             * ones stay. */
            if (at < 0 && all->n == MOST_SAVINGS) continue;
            /* Seen before at a point that shows it better. */
            if (at >= 0 && !tells_more(&r[i], &r[point[at]])) continue;
            if (at < 0) at = all->n++;
            all->item[at] =
                (struct saving){.omission = *o, .host_s = NAN, .host_saved_s = NAN, .noise_s = NAN};
            point[at] = i;
        }
}

/* The point as in all reports: bodies and processors, or one number when they are equal. */
static void name_point(const struct run_spec *spec, int64_t nbody, struct saving *s)
{
    if (nbody == spec->nrank) snprintf(s->at, sizeof s->at, "n=P=%d", spec->nrank);
    else if (nbody > 0) snprintf(s->at, sizeof s->at, "n=%lld P=%d", (long long)nbody, spec->nrank);
    else snprintf(s->at, sizeof s->at, "P=%d", spec->nrank);
}

bool savings_measure(const struct plan *p, const struct run_estimate *r, struct savings *out,
                     struct err *e)
{
    int point[MOST_SAVINGS], item[MOST_SAVINGS];
    *out = (struct savings){0};
    if (p->nrun == 0) return true;
    text_copy(out->scenario, sizeof out->scenario, p->run[0].scenario);
    collect(p, r, out, point);
    for (int i = 0; i < out->n; i++)
        name_point(&p->run[point[i]], r[point[i]].nbody, &out->item[i]);
    /* All omissions of one point are measured together; `measured` keeps them from a second
     * turn. What has no bit to undo it (keep == 0) is only listed. */
    for (int i = 0; i < out->n; i++) {
        int n = 0;
        for (int k = 0; k < out->n; k++)
            if (point[k] == point[i] && !out->item[k].measured && out->item[k].omission.keep)
                item[n++] = k;
        /* A cache per point: what its runs share stays for all rounds. */
        struct run_cache *cache = run_cache_create();
        bool ok = n == 0 || measure_point(&p->run[point[i]], out, item, n, cache, e);
        run_cache_destroy(cache);
        if (!ok) return false;
    }
    return true;
}

/* --- telling ---------------------------------------------------------------------------------- */

/* What the omission saves on this computer. A difference below the noise is told as such: either
 * sign would be chance. */
static void print_host(FILE *out, const struct saving *s)
{
    char text[64];
    /* The share of the run with the omission undone: that is the whole that it saves from. */
    double share = 100 * s->host_saved_s / (s->host_s + s->host_saved_s);
    if (fabs(s->host_saved_s) <= s->noise_s)
        snprintf(text, sizeof text, "less than the noise, %.3f ms", s->noise_s * 1e3);
    else if (s->host_saved_s > 0)
        snprintf(text, sizeof text, "saves %.3f ms of %.3f, %.0f %%", s->host_saved_s * 1e3,
                 (s->host_s + s->host_saved_s) * 1e3, share);
    else snprintf(text, sizeof text, "undone it takes %.3f ms less", -s->host_saved_s * 1e3);
    fprintf(out, "%-38s", text);
}

/* What it saves of the predicted time. Simulated times have no noise: any difference is real. */
static void print_machine(FILE *out, const struct saving *s)
{
    double with = (double)(s->machine_ps + s->machine_saved_ps);
    if (s->machine_saved_ps == 0) fprintf(out, "  nothing");
    else
        fprintf(out, "  %s %.3f us of %.3f, %.2g %%",
                s->machine_saved_ps > 0 ? "saves" : "takes more:",
                fabs((double)s->machine_saved_ps) * 1e-6, with * 1e-6,
                100 * fabs((double)s->machine_saved_ps) / with);
}

void savings_print(FILE *out, const struct savings *all)
{
    fprintf(out, "\nmeasured, each undone alone\n  %-40s %-14s %-8s %-38s  %s\n", "what", "at",
            "class", "this computer", "the machine, predicted");
    for (int i = 0; i < all->n; i++) {
        const struct saving *s = &all->item[i];
        fprintf(out, "  %-40s %-14s %-8s ", s->omission.what, s->at, omission_class(&s->omission));
        if (s->measured) {
            print_host(out, s);
            print_machine(out, s);
        } else {
            fprintf(out, "cannot be undone");
        }
        fprintf(out, "\n");
    }
}


void savings_json(struct json *j, const struct savings *all)
{
    json_key(j, "savings");
    columns_json_list(&saving_columns, all->item, all->n, sizeof *all->item, j);
}

/* The rows of a scenario replace its old ones, in one transaction. */
bool savings_store(struct store *s, const struct savings *all, struct err *e)
{
    static const char *const name[] = {"scenario", "ordinal"};
    /* All or nothing: a list with some omissions missing would look complete. */
    if (!store_begin(s, e)) return false;
    bool ok = store_note_build(s, e) &&
              store_delete(s, "omission", "scenario", store_text(all->scenario), e);
    for (int i = 0; ok && i < all->n; i++) {
        const struct saving *x = &all->item[i];
        const struct store_value value[] = {store_text(all->scenario), store_int(i)};
        ok = store_insert_row(s, "omission", 2, name, value, &saving_columns, x, e);
    }
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}

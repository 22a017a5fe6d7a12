/* why_beside.c - see why_beside.h. */
#include "app/why_beside.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* Everything here comes from the one run that recorded its path: no further simulation. What the
 * terminal shows is cut to what fits a page; nothing is left out of JSON and the database. */

/* Of the longest lists; JSON and the database have all of them. */
enum { ROWS = 10 };

const char *why_duration(double ps, char *buffer, size_t size)
{
    static const struct {
        double ps;
        const char *unit;
    } unit[] = {{1e12, "s"}, {1e9, "ms"}, {1e6, "us"}, {1e3, "ns"}, {1, "ps"}};
    /* The largest unit that leaves a number of at least 1. */
    int k = 0;
    while (k < 4 && fabs(ps) < unit[k].ps) k++;
    snprintf(buffer, size, "%.4g %s", ps / unit[k].ps, unit[k].unit);
    return buffer;
}

/* Of the makespan, 0 .. 1. */
static double share_of(const struct why *w, int64_t ps)
{
    return w->run.makespan_ps > 0 ? (double)ps / (double)w->run.makespan_ps : 0;
}

/* ---- slack of the ranks ---- */

/* Of the ranks in one stage, or in all of them. Counts of ranks come beside times: one rank that is
 * critical alone is another finding than all of them. */
struct spread {
    int active, critical;
    int64_t least, median, largest; /* of those that have slack [ps] */
};

/* For qsort. */
static int by_size(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return x < y ? -1 : x > y;
}

/* stage -1: of each rank its worst place, since a rank that is late anywhere is late. That is
 * of each rank the least of all stages. */
static int64_t slack_of_rank(const struct run_result *r, int rank, int stage)
{
    const int64_t *row = r->rank_slack + (int64_t)rank * r->nstage;
    int64_t least = INT64_MAX;
    if (stage >= 0) return row[stage];
    for (int k = 0; k < r->nstage; k++)
        if (row[k] < least) least = row[k];
    return least;
}

/* The median tells more than a mean: a few ranks that end early have very much. */
static struct spread spread_of(const struct why *w, int stage)
{
    const struct run_result *r = &w->run;
    struct spread s = {0};
    int64_t *found = memory_take((size_t)r->nrank, sizeof *found);
    int n = 0;
    for (int i = 0; i < r->nrank; i++) {
        const int64_t slack = slack_of_rank(r, i, stage);
        if (slack == INT64_MAX) continue;
        s.active++;
        if (slack == 0) s.critical++;
        else found[n++] = slack;
    }
    qsort(found, (size_t)n, sizeof *found, by_size);
    if (n > 0) s.least = found[0], s.median = found[n / 2], s.largest = found[n - 1];
    free(found);
    return s;
}

void why_slack_sentence(const struct why *w, FILE *out)
{
    char least[32], median[32], largest[32];
    if (w->run.rank_slack == NULL) return;
    const struct spread s = spread_of(w, -1);
    const int others = s.active - s.critical;
    /* A program of alike ranks that wait for each other may have nobody to spare. */
    if (others <= 0) {
        fprintf(out,
                "Every rank is on a critical path: a delay of any of them is one of the run.\n");
        return;
    }
    fprintf(out,
            "Beside it %d %s slack: %s at least, %s in the median, %s at most.\n", others,
            others == 1 ? "rank has" : "ranks have",
            why_duration((double)s.least, least, sizeof least),
            why_duration((double)s.median, median, sizeof median),
            why_duration((double)s.largest, largest, sizeof largest));
}

/* Where everybody is critical there is no slack to tell. */
static const char *or_dash(bool there, int64_t ps, char *buffer, size_t size)
{
    if (!there) return "-";
    return why_duration((double)ps, buffer, size);
}

/* A stage in which few are critical is one to look at: what they do there binds all. */
static void print_rank_slack(const struct why *w, FILE *out)
{
    char least[32], median[32], largest[32];
    fprintf(out,
            "\nSlack of the ranks: how much later each may be in a stage, and the run as long:\n"
            "%22s  %6s  %8s  %12s  %12s  %12s\n",
            "stage", "ranks", "critical", "least", "median", "largest");
    for (int k = 0; k < w->run.nstage; k++) {
        const struct spread s = spread_of(w, k);
        const bool some = s.active > s.critical;
        /* nobody does anything in the stage that the run ends by */
        if (s.active == 0) continue;
        fprintf(out, "%22s  %6d  %8d  %12s  %12s  %12s\n", w->run.stage_name[k], s.active,
                s.critical, or_dash(some, s.least, least, sizeof least),
                or_dash(some, s.median, median, sizeof median),
                or_dash(some, s.largest, largest, sizeof largest));
    }
}

/* Over all ranks and messages, so that what is nearly critical shows beside what is. */
static void print_cause_slack(const struct why *w, FILE *out)
{
    char time[32], least[32];
    fprintf(out,
            "\nThe largest parts of all ranks' time and messages, with their slack:\n"
            "%22s  %22s  %12s  %9s  %12s  %12s\n",
            "stage", "cause", "time", "critical", "within 5 %", "next slack");
    for (int i = 0; i < w->run.nslack && i < ROWS; i++) {
        const struct slack_row *s = &w->run.slack[i];
        const double all = (double)s->time_ps;
        fprintf(out, "%22s  %22s  %12s  %7.1f %%  %10.1f %%  %12s\n", w->run.stage_name[s->stage],
                path_cause_word(s->cause), why_duration(all, time, sizeof time),
                100 * (double)s->critical_ps / all, 100 * (double)s->near_ps / all,
                or_dash(s->least_ps < INT64_MAX, s->least_ps, least, sizeof least));
    }
}

/* ---- links ---- */

/* As mimdsim links names them: a link leads from router to router, a port has no router at one end.
 * "link 3 -> 7", "injection port of node 5" */
static const char *resource_name(const struct link_load *l, char *buffer, size_t size)
{
    if (l->from >= 0 && l->to >= 0) snprintf(buffer, size, "link %d -> %d", l->from, l->to);
    else
        snprintf(buffer, size, "%s port of node %d", l->from < 0 ? "injection" : "ejection",
                 l->node);
    return buffer;
}

/* Which link, so that placement or another route can be tried. */
static void print_resources(const struct why *w, FILE *out)
{
    char time[32], name[48];
    if (w->nresource == 0) return;
    fprintf(out, "\nLinks and ports that the path passes:\n%28s  %12s  %7s\n", "between routers",
            "time", "share");
    for (int i = 0; i < w->nresource; i++)
        fprintf(out, "%28s  %12s  %5.1f %%\n",
                resource_name(&w->run.link[w->resource[i].resource], name, sizeof name),
                why_duration((double)w->resource[i].time_ps, time, sizeof time),
                100 * share_of(w, w->resource[i].time_ps));
}

/* ---- computing against communication ---- */

/* The first row stands for all stages. */
static const char *stage_of(const struct why *w, const struct roofline_row *r)
{
    return r->stage < 0 ? "whole run" : w->run.stage_name[r->stage];
}

/* The rate that the lowest roof allows: what the stage would reach if it did this one thing alone
 * and never waited for anybody. */
static double roof_of(const struct roofline_row *r)
{
    return fmin(r->computing, fmin(r->bandwidth, r->software));
}

/* In millions, as flop rates of the machines that the paper is about; "-" where there is no such
 * roof. */
static const char *mega(double rate, char *buffer, size_t size)
{
    if (isinf(rate)) return "-";
    snprintf(buffer, size, "%.4g", rate / 1e6);
    return buffer;
}

/* Three roofs side by side: which one is lowest, and how far below it the stage is. */
static void print_roofline(const struct why *w, FILE *out)
{
    char ops[32], attained[32], computing[32], bandwidth[32], software[32];
    if (w->nroof == 0) return;
    fprintf(out,
            "\nComputing against communication, Mflop/s of one processor (roofline):\n"
            "%22s  %10s  %9s  %10s  %10s  %10s  %s\n",
            "stage", "flop/B", "attained", "computing", "bandwidth", "software", "lowest roof");
    for (int i = 0; i < w->nroof; i++) {
        const struct roofline_row *r = &w->roof[i];
        snprintf(ops, sizeof ops, "%.4g", r->intensity);
        fprintf(out, "%22s  %10s  %9s  %10s  %10s  %10s  %s (%.0f %% of it)\n", stage_of(w, r),
                isinf(r->intensity) ? "-" : ops, mega(r->attained, attained, sizeof attained),
                mega(r->computing, computing, sizeof computing),
                mega(r->bandwidth, bandwidth, sizeof bandwidth),
                mega(r->software, software, sizeof software), roofline_word(r->lowest),
                100 * r->attained / roof_of(r));
    }
}

/* Slack is not asked for by --brief. */
void why_beside_print(const struct why *w, FILE *out)
{
    print_resources(w, out);
    if (w->run.rank_slack != NULL) {
        print_rank_slack(w, out);
        print_cause_slack(w, out);
    }
    print_roofline(w, out);
}

/* ---- JSON ---- */

/* All rows and all ranks, in picoseconds. */
static void json_slack(const struct why *w, struct json *j)
{
    json_key(j, "slack");
    json_array(j);
    for (int i = 0; i < w->run.nslack; i++) {
        const struct slack_row *s = &w->run.slack[i];
        json_object(j);
        json_key_text(j, "stage", w->run.stage_name[s->stage]);
        json_key_text(j, "cause", path_cause_word(s->cause));
        json_key_int(j, "steps", s->steps);
        json_key_int(j, "time_ps", s->time_ps);
        json_key_int(j, "critical_ps", s->critical_ps);
        json_key_int(j, "near_ps", s->near_ps);
        if (s->least_ps < INT64_MAX) json_key_int(j, "least_ps", s->least_ps);
        json_end(j);
    }
    json_end(j);
    json_key(j, "rank_slack_ps");
    json_array(j);
    for (int i = 0; w->run.rank_slack != NULL && i < w->run.nrank; i++) {
        const int64_t slack = slack_of_rank(&w->run, i, -1);
        if (slack == INT64_MAX) json_null(j); /* the run does not end by it */
        else json_int(j, slack);
    }
    json_end(j);
}

static void json_resources(const struct why *w, struct json *j)
{
    char name[48];
    json_key(j, "resources");
    json_array(j);
    for (int i = 0; i < w->nresource; i++) {
        json_object(j);
        json_key_text(j, "resource",
                      resource_name(&w->run.link[w->resource[i].resource], name, sizeof name));
        json_key_int(j, "time_ps", w->resource[i].time_ps);
        json_end(j);
    }
    json_end(j);
}

/* An infinite number is null. */
static double or_nan(double x) { return isinf(x) ? NAN : x; }

void why_beside_json(const struct why *w, struct json *j)
{
    json_slack(w, j);
    json_resources(w, j);
    json_key(j, "roofline");
    json_array(j);
    for (int i = 0; i < w->nroof; i++) {
        const struct roofline_row *r = &w->roof[i];
        json_object(j);
        json_key_text(j, "stage", stage_of(w, r));
        json_key_real(j, "flops", r->flops);
        json_key_real(j, "sent_bytes", r->sent_bytes);
        json_key_real(j, "flops_per_byte", or_nan(r->intensity));
        json_key_real(j, "attained_flop_per_s", r->attained);
        json_key_real(j, "computing_flop_per_s", or_nan(r->computing));
        json_key_real(j, "bandwidth_flop_per_s", or_nan(r->bandwidth));
        json_key_real(j, "software_flop_per_s", or_nan(r->software));
        json_key_text(j, "lowest_roof", roofline_word(r->lowest));
        json_end(j);
    }
    json_end(j);
}

/* ---- rows ---- */

/* A roof that is not there is NULL. */
static struct store_value real_or_null(double x)
{
    return isfinite(x) ? store_real(x) : store_null();
}

static bool put_slack(struct store *s, int64_t run, const struct why *w, struct err *e)
{
    static const char *const name[] = {"run_id",      "stage",   "cause",   "steps",
                                       "time_ps",     "critical_ps", "near_ps", "least_ps"};
    static const char *const of_rank[] = {"run_id", "rank", "stage", "slack_ps"};
    bool ok = true;
    for (int i = 0; ok && i < w->run.nslack; i++) {
        const struct slack_row *x = &w->run.slack[i];
        const struct store_value v[] = {
            store_int(run),         store_text(w->run.stage_name[x->stage]),
            store_text(path_cause_word(x->cause)),
            store_int(x->steps),    store_int(x->time_ps),
            store_int(x->critical_ps), store_int(x->near_ps),
            x->least_ps < INT64_MAX ? store_int(x->least_ps) : store_null()};
        ok = store_insert(s, "slack", 8, name, v, e);
    }
    /* Of each rank the stage in which it has least: a row a rank, of thousands of ranks too. */
    for (int i = 0; ok && w->run.rank_slack != NULL && i < w->run.nrank; i++) {
        const int64_t *row = w->run.rank_slack + (int64_t)i * w->run.nstage;
        int stage = 0;
        for (int k = 1; k < w->run.nstage; k++)
            if (row[k] < row[stage]) stage = k;
        if (row[stage] == INT64_MAX) continue;
        const struct store_value v[] = {store_int(run), store_int(i),
                                        store_text(w->run.stage_name[stage]),
                                        store_int(row[stage])};
        ok = store_insert(s, "rank_slack", 4, of_rank, v, e);
    }
    return ok;
}

/* By number, as in view link_load, and by name for people. */
static bool put_resources(struct store *s, int64_t run, const struct why *w, struct err *e)
{
    static const char *const name[] = {"run_id", "link", "name", "time_ps"};
    char text[48];
    bool ok = true;
    for (int i = 0; ok && i < w->nresource; i++) {
        const int resource = w->resource[i].resource;
        resource_name(&w->run.link[resource], text, sizeof text);
        const struct store_value v[] = {store_int(run), store_int(resource), store_text(text),
                                        store_int(w->resource[i].time_ps)};
        ok = store_insert(s, "path_resource", 4, name, v, e);
    }
    return ok;
}

/* Times of all ranks have been summed: what is stored are rates. */
static bool put_roofline(struct store *s, int64_t run, const struct why *w, struct err *e)
{
    static const char *const name[] = {"run_id",   "ordinal",   "stage",     "flops",
                                       "messages", "sent_bytes", "attained", "computing",
                                       "bandwidth", "software", "lowest"};
    bool ok = true;
    for (int i = 0; ok && i < w->nroof; i++) {
        const struct roofline_row *r = &w->roof[i];
        const struct store_value v[] = {store_int(run),          store_int(i),
                                        store_text(stage_of(w, r)), store_real(r->flops),
                                        store_real(r->messages), store_real(r->sent_bytes),
                                        store_real(r->attained), real_or_null(r->computing),
                                        real_or_null(r->bandwidth), real_or_null(r->software),
                                        store_text(roofline_word(r->lowest))};
        ok = store_insert(s, "roofline", 11, name, v, e);
    }
    return ok;
}

/* Within the transaction of the whole explanation. */
bool why_beside_put(struct store *s, int64_t run, const struct why *w, struct err *e)
{
    static const char *const table[] = {"slack", "rank_slack", "path_resource", "roofline"};
    bool ok = true;
    for (int i = 0; ok && i < 4; i++) ok = store_delete(s, table[i], "run_id", store_int(run), e);
    return ok && put_slack(s, run, w, e) && put_resources(s, run, w, e) &&
           put_roofline(s, run, w, e);
}

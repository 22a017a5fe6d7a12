/* why_print.c - see why_print.h. The first sentences answer; the tables behind them give the
 * numbers. */
#include "app/why_print.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/why_beside.h"
#include "base/json.h"
#include "spec/field.h"
#include "spec/run_label.h"

/* Of the longest list; JSON and the database have all of it. */
enum { ROWS = 10 };

/* Of the makespan, 0 .. 1. */
static double share_of(const struct why *w, int64_t ps)
{
    return w->run.makespan_ps > 0 ? (double)ps / (double)w->run.makespan_ps : 0;
}

/* ---- words ---- */

/* Time and steps of one cause, summed over the stages: steps tell how often, times how long. */
struct sum {
    int64_t time_ps, steps;
    enum path_cause cause;
};

/* For qsort; equal times in the order of the causes, so that the answer is always the same. */
static int longer(const void *a, const void *b)
{
    const struct sum *x = a, *y = b;
    if (x->time_ps != y->time_ps) return x->time_ps < y->time_ps ? 1 : -1;
    return (int)x->cause - (int)y->cause;
}

/* Causes over all stages, the longest first, without those that the path does not have; returns
 * how many. Shares are by stage and cause, so one cause may have several. */
static int sums_of(const struct why *w, struct sum *of)
{
    for (int c = 0; c < PATH_CAUSES; c++) of[c] = (struct sum){.cause = (enum path_cause)c};
    for (int i = 0; i < w->nshare; i++) {
        of[w->share[i].cause].time_ps += w->share[i].time_ps;
        of[w->share[i].cause].steps += w->share[i].steps;
    }
    qsort(of, PATH_CAUSES, sizeof *of, longer);
    int n = 0;
    while (n < PATH_CAUSES && of[n].time_ps > 0) n++;
    return n;
}

/* What to do about it: a reader who stops here knows where an improvement would count at all.
 * Which of the idealised machines would gain most, and what an even share of the work would. */
static void print_help(const struct why *w, FILE *out)
{
    const struct why_limit *best = NULL, *last = NULL;
    for (int i = 0; i < w->nlimit; i++) {
        const struct why_limit *l = &w->limit[i];
        if (l->makespan_ps > 0 && (best == NULL || l->makespan_ps < best->makespan_ps)) best = l;
        if (l->makespan_ps > 0) last = l;
    }
    if (best == NULL) return;
    fprintf(out, "Of the idealised machines '%s' helps most: %.4g times as fast", best->name,
            (double)w->run.makespan_ps / (double)best->makespan_ps);
    /* The last one changes the program's shares of work, not the machine. */
    if (last != best)
        fprintf(out, "; '%s': %.4g times", last->name,
                (double)w->run.makespan_ps / (double)last->makespan_ps);
    fprintf(out, ".\n");
}

/* "machine.network.hop_latency" -> its value times `factor`, with its unit: four digits are enough.
 */
static const char *scaled_value(const struct why_parameter *p, double factor, char *buffer,
                                int size)
{
    const struct field_table *table;
    const struct field *f = p->value > 0 ? field_find_full(p->key, &table) : NULL;
    char digits[32];
    if (f == NULL) return NULL;
    snprintf(digits, sizeof digits, "%.4g", p->rate ? p->value / factor : p->value * factor);
    units_print(strtod(digits, NULL), f->unit, buffer, size);
    return buffer;
}

/* How much room the most important parameters have, as values with units: "up to 7.9 us" is what a
 * designer can hold a data sheet against, a factor is not. */
static void print_room(const struct why *w, FILE *out)
{
    char value[64];
    int told = 0;
    for (int i = 0; i < w->nparameter && told < 3; i++) {
        const struct why_parameter *p = &w->parameter[i];
        const char *to =
            p->tolerance > 0 ? scaled_value(p, p->tolerance, value, sizeof value) : NULL;
        if (to == NULL) continue;
        fprintf(out, "%s %s may %s to %s", told++ ? ";" : "Before the run is 5 % longer,",
                p->key + strlen("machine."), p->rate ? "fall" : "rise", to);
    }
    if (told > 0) fprintf(out, ".\n");
}

/* The main part of each of them is named, so that the reader knows where to look. */
static void print_sentences(const struct run_spec *spec, const struct why *w, FILE *out)
{
    char time[32];
    struct sum sum[PATH_CAUSES];
    const int n = sums_of(w, sum);
    struct text name = {0};
    run_label(spec, &name);
    fprintf(out, "%s on %s%s: %s, of which\n", spec->kernel.name, name.s,
            run_size(spec, spec->nrank).s,
            why_duration((double)w->run.makespan_ps, time, sizeof time));
    text_free(&name);
    /* Three causes say most of it; the table has the others. */
    for (int i = 0; i < n && i < 3; i++) {
        /* Shares come longest first, so the first one of a cause is its largest part. */
        const struct why_share *most = NULL;
        for (int k = 0; k < w->nshare && !most; k++)
            if (w->share[k].cause == sum[i].cause) most = &w->share[k];
        fprintf(out, "  %5.1f %% is %s", 100 * share_of(w, sum[i].time_ps),
                path_cause_word(sum[i].cause));
        fprintf(out, ", most of it in stage %s (%.1f %%)\n", w->run.stage_name[most->stage],
                100 * share_of(w, most->time_ps));
    }
    fprintf(out,
            "The critical path follows %lld message%s over %d of %d ranks and ends on rank %d.\n",
            (long long)w->messages, w->messages == 1 ? "" : "s", w->ranks, w->run.nrank,
            w->run.npath > 0 ? w->run.path[w->run.npath - 1].rank : 0);
    why_slack_sentence(w, out);
    print_help(w, out);
    print_room(w, out);
}

/* ---- tables ---- */

/* First by cause alone, then the parts by stage and cause, then who carries the path. */
static void print_causes(const struct why *w, FILE *out)
{
    char time[32];
    struct sum sum[PATH_CAUSES];
    const int n = sums_of(w, sum);
    fprintf(out, "\nThe path by cause:\n%22s  %12s  %7s  %8s\n", "cause", "time", "share", "steps");
    for (int i = 0; i < n; i++)
        fprintf(out, "%22s  %12s  %5.1f %%  %8lld\n", path_cause_word(sum[i].cause),
                why_duration((double)sum[i].time_ps, time, sizeof time),
                100 * share_of(w, sum[i].time_ps), (long long)sum[i].steps);
    fprintf(out, "\nThe largest parts:\n%22s  %22s  %12s  %7s\n", "stage", "cause", "time",
            "share");
    for (int i = 0; i < w->nshare && i < ROWS; i++)
        fprintf(out, "%22s  %22s  %12s  %5.1f %%\n", w->run.stage_name[w->share[i].stage],
                path_cause_word(w->share[i].cause),
                why_duration((double)w->share[i].time_ps, time, sizeof time),
                100 * share_of(w, w->share[i].time_ps));
    fprintf(out, "\nRanks with the most of it:");
    for (int i = 0; i < w->nrank; i++)
        /* Several ranks carry parts of the path; their shares are of the whole makespan, as
         * everywhere in this table. */
        fprintf(out, "%s %d (%.1f %%)", i ? "," : "", w->rank[i].rank,
                100 * share_of(w, w->rank[i].time_ps));
    fprintf(out, "\n");
}

/* A parameter without a count is one of several by message size: its value is no single number. */
static void print_parameters(const struct why *w, FILE *out)
{
    char time[32], count[32], change[64];
    fprintf(
        out,
        "\nWhat parameters of the machine stand for, and which change makes the run 5 %% longer:\n"
        "%36s  %12s  %7s  %10s  %s\n",
        "parameter", "time", "share", "count", "5 % longer");
    for (int i = 0; i < w->nparameter; i++) {
        const struct why_parameter *p = &w->parameter[i];
        if (p->count > 0) snprintf(count, sizeof count, "%.6g", p->count);
        else snprintf(count, sizeof count, "-");
        /* A tolerance of 0 was not asked for (--brief), or no factor up to 1000 makes the run
         * 5 % longer. */
        if (p->tolerance <= 0) snprintf(change, sizeof change, "-");
        else
            /* A rate is made worse by dividing it, a duration by multiplying. */
            snprintf(change, sizeof change, "%s %.4g%s", p->rate ? "divided by" : "times",
                     p->tolerance, p->same_path ? "" : ", on another path");
        if (p->range > 0)
            snprintf(change + strlen(change), sizeof change - strlen(change), " from %.4g",
                     p->range);
        fprintf(out, "%36s  %12s  %5.1f %%  %10s  %s\n", p->key,
                why_duration((double)p->time_ps, time, sizeof time), 100 * share_of(w, p->time_ps),
                count, change);
    }
}

/* An idealised machine that a level cannot run keeps its row, with a dash. */
static void print_limits(const struct why *w, FILE *out)
{
    char time[32];
    if (w->nlimit == 0) return;
    fprintf(out, "\nIdealised machines, simulated:\n%22s  %12s  %8s  %s\n", "machine", "time",
            "faster", "what that is");
    for (int i = 0; i < w->nlimit; i++) {
        const struct why_limit *l = &w->limit[i];
        if (l->makespan_ps <= 0) fprintf(out, "%22s  %12s  %8s  %s\n", l->name, "-", "-", l->what);
        else
            fprintf(out, "%22s  %12s  %7.2fx  %s\n", l->name,
                    why_duration((double)l->makespan_ps, time, sizeof time),
                    /* The largest gain that any improvement of this kind can give. */
                    (double)w->run.makespan_ps / (double)l->makespan_ps, l->what);
    }
}

/* Words first, numbers behind them: the answer is read on the first lines, and the tables are for
 * whoever wants to know where it comes from. */
void why_print(const struct run_spec *spec, const struct why *w, const char *sure, FILE *out)
{
    print_sentences(spec, w, out);
    fprintf(out, "%s\n", sure);
    print_causes(w, out);
    print_parameters(w, out);
    print_limits(w, out);
    why_beside_print(w, out);
}

/* ---- JSON ---- */

/* What the terminal shows with units and in percent is here in picoseconds and as a share. */
static void json_parameters(struct json *j, const struct why *w)
{
    json_key(j, "parameters");
    json_array(j);
    for (int i = 0; i < w->nparameter; i++) {
        const struct why_parameter *p = &w->parameter[i];
        json_object(j);
        json_key_text(j, "key", p->key);
        json_key_bool(j, "rate", p->rate);
        json_key_int(j, "time_ps", p->time_ps);
        json_key_real(j, "share", share_of(w, p->time_ps));
        json_key_real(j, "count", p->count);
        json_key_real(j, "factor_5_percent", p->tolerance > 0 ? p->tolerance : NAN);
        json_key_bool(j, "same_path", p->same_path);
        json_key_real(j, "other_path_at", p->range > 0 ? p->range : NAN);
        json_end(j);
    }
    json_end(j);
}

/* Every part of the path, not the ten largest alone. */
static void json_shares(struct json *j, const struct why *w)
{
    json_key(j, "critical_path");
    json_array(j);
    for (int i = 0; i < w->nshare; i++) {
        json_object(j);
        json_key_text(j, "stage", w->run.stage_name[w->share[i].stage]);
        json_key_text(j, "cause", path_cause_word(w->share[i].cause));
        json_key_int(j, "time_ps", w->share[i].time_ps);
        json_key_int(j, "steps", w->share[i].steps);
        json_end(j);
    }
    json_end(j);
}

/* makespan_ps 0: the level cannot run that machine. */
static void json_limits(struct json *j, const struct why *w)
{
    json_key(j, "limits");
    json_array(j);
    for (int i = 0; i < w->nlimit; i++) {
        json_object(j);
        json_key_text(j, "machine", w->limit[i].name);
        json_key_text(j, "what", w->limit[i].what);
        json_key_int(j, "makespan_ps", w->limit[i].makespan_ps);
        json_end(j);
    }
    json_end(j);
}

/* The same order as on the terminal. */
void why_print_json(const struct run_spec *spec, const struct why *w, const char *sure, FILE *out)
{
    struct text name = {0};
    run_label(spec, &name);
    struct json j = json_make(out);
    json_object(&j);
    json_key_text(&j, "kernel", spec->kernel.name);
    json_key_text(&j, "machine", spec->machine.name);
    json_key_text(&j, "name", name.s);
    text_free(&name);
    json_key_int(&j, "n", spec->model.nbody);
    json_key_int(&j, "P", spec->nrank);
    json_key_int(&j, "makespan_ps", w->run.makespan_ps);
    json_key_text(&j, "how_sure", sure);
    json_key_int(&j, "messages", w->messages);
    json_key_int(&j, "ranks", w->ranks);
    json_shares(&j, w);
    json_parameters(&j, w);
    json_limits(&j, w);
    why_beside_json(w, &j);
    json_end(&j);
    json_finish(&j);
}

/* netcheck_print.c - statistics of the answers to reference cases, as tables and as JSON. */
#include <math.h>
#include <string.h>

#include "base/json.h"
#include "base/text.h"
#include "study/netcheck_verdict.h"

const char *netcheck_level_name(enum network_level level) { return network_level_name(level); }

struct netcheck_total netcheck_total(const struct netcheck *n, const char *group, enum network_level level)
{
    struct netcheck_total t = {0};
    int compared = 0;
    for (int i = 0; i < n->nrow; i++) {
        const struct netcheck_row *row = &n->row[i];
        const struct netcheck_answer *a = &row->answer[level];
        if (!netcheck_in_group(row, group) || row->played) continue;
        t.skipped += !a->ran;
        if (!a->ran) continue;
        t.cases++;
        t.exact_cases += fabs(a->error) * row->high < 1e-3;
        t.mean += fabs(a->error);
        if (fabs(a->error) > fabs(t.worst)) t.worst = a->error;
        if (!row->compared || a->deadlock) continue;
        compared++;
        t.messages += row->nmessage;
        t.exact += row->nmessage - a->differing;
        t.message_error += a->message_error;
    }
    if (t.cases > 0) t.mean /= t.cases;
    if (compared > 0) t.message_error /= compared;
    return t;
}

static void print_heads(const struct netcheck *n, const char *first, const char *second, FILE *out)
{
    fprintf(out, "%-66s %9s", first, second);
    for (int l = 0; l < LEVELS; l++)
        if (n->level[l]) fprintf(out, " %10s", network_level_name((enum network_level)l));
    fprintf(out, "\n");
}

/* one row: errors in percent, a ! behind those that break the stated accuracy */
static void print_cases(const struct netcheck *n, double within, FILE *out)
{
    print_heads(n, "case (errors in % of the reference, ! not as stated)", "reference", out);
    for (int i = 0; i < n->nrow; i++) {
        const struct netcheck_row *row = &n->row[i];
        if (row->played) continue;
        fprintf(out, "%-66s %9.6g", row->name, row->high);
        for (int l = 0; l < LEVELS; l++) {
            const struct netcheck_answer *a = &row->answer[l];
            if (!n->level[l]) continue;
            char mark = netcheck_row_fails(row, (enum network_level)l, within, NULL) ? '!' : ' ';
            if (!a->ran || !row->counted) fprintf(out, " %10s", "-");
            else if (a->deadlock) fprintf(out, " %9s%c", "deadlock", mark);
            else fprintf(out, " %+9.2f%c", 100 * a->error, mark);
        }
        fprintf(out, "\n");
    }
}

static void print_time(const struct netcheck_answer *a, double time, FILE *out)
{
    if (!a->ran) fprintf(out, " %10s", "-");
    else if (a->deadlock && !(time < 1e15)) fprintf(out, " %10s", "deadlock");
    else fprintf(out, " %10.10g", time);
}

/* cases without reference answers: makespans, and the arrival of each message */
static void print_played(const struct netcheck *n, bool brief, FILE *out)
{
    char name[80];
    print_heads(n, "case without a reference (times in cycles)", "messages", out);
    for (int i = 0; i < n->nrow; i++) {
        const struct netcheck_row *row = &n->row[i];
        if (!row->played) continue;
        fprintf(out, "%-66s %9d", row->name, row->nmessage);
        for (int l = 0; l < LEVELS; l++)
            if (n->level[l]) print_time(&row->answer[l], row->answer[l].found, out);
        fprintf(out, "\n");
        for (int m = 0; !brief && row->src && m < row->nmessage; m++) {
            snprintf(name, sizeof name, "  message %d: %d -> %d, %d flits", m, row->src[m], row->dst[m], row->flits[m]);
            fprintf(out, "%-66s %9s", name, "");
            for (int l = 0; l < LEVELS; l++)
                if (n->level[l])
                    print_time(&row->answer[l], row->answer[l].arrival ? row->answer[l].arrival[m] : 0, out);
            fprintf(out, "\n");
        }
    }
}

static void print_total(const struct netcheck *n, const char *group, double within, FILE *out)
{
    for (int l = 0; l < LEVELS; l++) {
        struct netcheck_total t = netcheck_total(n, group, (enum network_level)l);
        struct netcheck_verdict v = netcheck_verdict(n, group, (enum network_level)l, within);
        if (!n->level[l] || t.cases == 0) continue;
        fprintf(out, "%-30s %-7s %6d %7d %7d %9.3f %+9.2f %9.3f ", group ? group : "all",
                network_level_name((enum network_level)l), t.cases, t.skipped, t.exact_cases, 100 * t.mean,
                100 * t.worst, 100 * t.message_error);
        if (t.messages > 0) fprintf(out, "%9.3f ", 100.0 * (double)t.exact / (double)t.messages);
        else fprintf(out, "%9s ", "-");
        if (!group) fprintf(out, "\n");
        else
            fprintf(out, "%7.1f %+6.0f %+6.0f  %s\n", 100 * v.mean_limit, 100 * v.low, 100 * v.high,
                    v.pass ? "pass" : "FAIL");
    }
}

/* why cases could not be answered, each reason once per level */
static void print_reasons(const struct netcheck *n, FILE *out)
{
    for (int l = 0; l < LEVELS; l++) {
        const char *last = "";
        for (int i = 0; n->level[l] && i < n->nrow; i++) {
            const struct netcheck_answer *a = &n->row[i].answer[l];
            if (a->ran || strcmp(a->why, last) == 0) continue;
            fprintf(out, "%s skipped %s: %s\n", network_level_name((enum network_level)l), n->row[i].name, a->why);
            last = a->why;
        }
    }
}

/* the first reason of each verdict that is FAIL, contradictions of the file, and what was compared with nothing */
static void print_findings(const struct netcheck *n, double within, FILE *out)
{
    int silent = 0;
    for (int i = 0; i < n->nrow; i++) {
        bool any = false;
        for (int l = 0; l < LEVELS; l++) any = any || n->row[i].answer[l].ran;
        silent += !any;
        if (n->row[i].flaw[0])
            fprintf(out, "FAIL %s:%d: %s: %s\n", n->path, n->row[i].line, n->row[i].name, n->row[i].flaw);
        for (int l = 0; netcheck_opens_group(n, i) && l < LEVELS; l++) {
            struct netcheck_verdict v = netcheck_verdict(n, n->row[i].group, (enum network_level)l, within);
            if (n->level[l] && !v.pass)
                fprintf(out, "FAIL %s, %s: %d of %d cases; %s\n", n->row[i].group,
                        network_level_name((enum network_level)l), v.failed, v.cases, v.why);
        }
    }
    if (silent > 0) fprintf(out, "not judged: %d of %d cases, which no level answered\n", silent, n->nrow);
    for (int i = 0; i < n->nignored; i++) fprintf(out, "%s%s", i ? ", " : "compared with nothing: ", n->ignored[i]);
    if (n->nignored > 0) fprintf(out, "\n");
}

void netcheck_print(const struct netcheck *n, double within, bool brief, FILE *out)
{
    int played = 0;
    for (int i = 0; i < n->nrow; i++) played += n->row[i].played;
    if (!brief && played < n->nrow) print_cases(n, within, out);
    if (played > 0) print_played(n, brief, out);
    if (!brief) print_reasons(n, out);
    if (played < n->nrow) {
        fprintf(out, "%s%-30s %-7s %6s %7s %7s %9s %9s %9s %9s %7s %6s %6s  %s\n", brief ? "" : "\n", "group", "level",
                "cases", "skipped", "exact", "mean|e|%", "worst %", "message %", "exact m %", "mean to", "from", "to",
                "verdict");
        for (int i = 0; i < n->nrow; i++)
            if (netcheck_opens_group(n, i) && !n->row[i].played) print_total(n, n->row[i].group, within, out);
        print_total(n, NULL, within, out);
    }
    print_findings(n, within, out);
}

/* Keys are sorted, in every object. */
static void key_int(struct json *j, const char *key, int64_t value)
{
    json_key(j, key);
    json_int(j, value);
}

static void key_real(struct json *j, const char *key, double value)
{
    json_key(j, key);
    json_real(j, value);
}

static void key_text(struct json *j, const char *key, const char *value)
{
    json_key(j, key);
    json_text(j, value);
}

static void json_arrivals(struct json *j, const struct netcheck_row *row, const struct netcheck_answer *a)
{
    json_key(j, "arrival");
    json_array(j);
    for (int m = 0; m < row->nmessage; m++)
        if (a->arrival[m] < 1e15) json_real(j, a->arrival[m]);
        else json_null(j);
    json_end(j);
}

static void json_answer(struct json *j, const struct netcheck_row *row, enum network_level level, double within)
{
    const struct netcheck_answer *a = &row->answer[level];
    bool compared = a->ran && row->compared && !a->deadlock;
    json_object(j);
    if (a->arrival) json_arrivals(j, row, a);
    if (a->ran) {
        json_key(j, "deadlock");
        json_bool(j, a->deadlock);
    }
    if (compared) key_int(j, "differing_messages", a->differing);
    if (a->ran && !row->played) key_real(j, "error", a->error);
    if (a->ran) key_int(j, "events", a->events);
    if (a->ran) key_real(j, "found", a->found);
    if (compared) key_real(j, "mean_message_error", a->message_error);
    json_key(j, "ran");
    json_bool(j, a->ran);
    if (a->ran && row->counted && !row->played)
        key_text(j, "verdict", netcheck_row_fails(row, level, within, NULL) ? "FAIL" : "pass");
    if (a->why[0]) key_text(j, "why", a->why);
    if (compared) key_real(j, "worst_message_error", a->message_worst);
    json_end(j);
}

static void json_rows(const struct netcheck *n, double within, struct json *j)
{
    static const enum network_level by_name[] = {LEVEL_AUTO, LEVEL_FLIT, LEVEL_LINK, LEVEL_LOGGP, LEVEL_PACKET};
    json_array(j);
    for (int i = 0; i < n->nrow; i++) {
        const struct netcheck_row *row = &n->row[i];
        json_object(j);
        key_text(j, "case", row->name);
        json_key(j, "counted");
        json_bool(j, row->counted && !row->played);
        if (row->flaw[0]) key_text(j, "flaw", row->flaw);
        key_text(j, "group", row->group);
        json_key(j, "levels");
        json_object(j);
        for (int l = 0; l < LEVELS; l++) {
            if (!n->level[by_name[l]]) continue;
            json_key(j, network_level_name((enum network_level)by_name[l]));
            json_answer(j, row, by_name[l], within);
        }
        json_end(j);
        key_int(j, "line", row->line);
        key_int(j, "messages", row->nmessage);
        if (!row->played) key_real(j, "reference_high", row->high);
        if (!row->played) key_real(j, "reference_low", row->low);
        json_end(j);
    }
    json_end(j);
}

static void json_total(const struct netcheck *n, const char *group, double within, struct json *j)
{
    for (int l = 0; l < LEVELS; l++) {
        struct netcheck_total t = netcheck_total(n, group, (enum network_level)l);
        struct netcheck_verdict v = netcheck_verdict(n, group, (enum network_level)l, within);
        if (!n->level[l]) continue;
        json_object(j);
        key_int(j, "cases", t.cases);
        key_int(j, "exact_cases", t.exact_cases);
        key_int(j, "exact_messages", t.exact);
        key_int(j, "failed", v.failed);
        key_text(j, "group", group ? group : "all");
        key_text(j, "level", network_level_name((enum network_level)l));
        key_real(j, "mean_error", t.mean);
        if (group) key_real(j, "mean_limit", v.mean_limit);
        key_real(j, "mean_message_error", t.message_error);
        key_int(j, "messages", t.messages);
        key_int(j, "skipped", t.skipped);
        if (group && v.cases > 0) key_text(j, "verdict", v.pass ? "pass" : "FAIL");
        if (group && !v.pass) key_text(j, "why", v.why);
        key_real(j, "worst_error", t.worst);
        if (group) key_real(j, "worst_high", v.high);
        if (group) key_real(j, "worst_low", v.low);
        json_end(j);
    }
}

void netcheck_json_object(const struct netcheck *n, double within, struct json *j)
{
    json_object(j);
    json_key(j, "cases");
    json_rows(n, within, j);
    json_key(j, "compared_with_nothing");
    json_array(j);
    for (int i = 0; i < n->nignored; i++) json_text(j, n->ignored[i]);
    json_end(j);
    key_text(j, "file", n->path);
    json_key(j, "totals");
    json_array(j);
    for (int i = 0; i < n->nrow; i++)
        if (netcheck_opens_group(n, i) && !n->row[i].played) json_total(n, n->row[i].group, within, j);
    json_total(n, NULL, within, j);
    json_end(j);
    bool any = false;
    for (int i = 0; i < n->nrow; i++) any = any || (n->row[i].counted && !n->row[i].played);
    key_text(j, "verdict", !any ? "not judged" : netcheck_pass(n, within) ? "pass" : "FAIL");
    json_end(j);
}

static void print_percent(double x, FILE *out)
{
    if (x == 0) fprintf(out, " 0 |");
    else fprintf(out, " %+.3g |", 100 * x);
}

void netcheck_print_stated(FILE *out)
{
    fprintf(out, "| level | cases | mean of absolute errors, %% | a case from, %% | to, %% | a message, %% |\n"
                 "| --- | --- | --- | --- | --- | --- |\n");
    const struct netcheck_accuracy *s;
    for (int i = 0; (s = netcheck_accuracies(i)); i++) {
        fprintf(out, "| %s | %s | %.3g |", s->levels, s->cases, 100 * s->mean);
        print_percent(s->low, out);
        print_percent(s->high, out);
        if (s->message < 0) fprintf(out, " - |\n");
        else fprintf(out, " %.3g |\n", 100 * s->message);
    }
}

void netcheck_json_stated(FILE *out)
{
    struct json j = json_make(out);
    const struct netcheck_accuracy *s;
    json_array(&j);
    for (int i = 0; (s = netcheck_accuracies(i)); i++) {
        json_object(&j);
        key_text(&j, "cases", s->cases);
        key_text(&j, "levels", s->levels);
        key_real(&j, "mean", s->mean);
        if (s->message >= 0) key_real(&j, "message", s->message);
        key_real(&j, "worst_high", s->high);
        key_real(&j, "worst_low", s->low);
        json_end(&j);
    }
    json_end(&j);
    json_finish(&j);
}

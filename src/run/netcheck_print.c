/* netcheck_print.c - statistics of the answers to reference cases, as tables and as JSON. */
#include <math.h>
#include <string.h>

#include "base/json.h"
#include "base/text.h"
#include "run/netcheck.h"

static const char *const level_names[] = {"loggp", "link", "packet", "flit", "auto"};

const char *netcheck_level_name(enum network_level level) { return level_names[level]; }

static bool in_group(const struct netcheck_row *row, const char *group)
{
    return row->counted && (!group || strcmp(row->group, group) == 0);
}

struct netcheck_total netcheck_total(const struct netcheck *n, const char *group, enum network_level level)
{
    struct netcheck_total t = {0};
    int compared = 0;
    for (int i = 0; i < n->nrow; i++) {
        const struct netcheck_row *row = &n->row[i];
        const struct netcheck_answer *a = &row->answer[level];
        if (!in_group(row, group)) continue;
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

/* the rows that open a group that no earlier row belongs to */
static bool opens_group(const struct netcheck *n, int i)
{
    if (!n->row[i].counted) return false;
    for (int j = 0; j < i; j++)
        if (n->row[j].counted && strcmp(n->row[j].group, n->row[i].group) == 0) return false;
    return true;
}

static void print_cases(const struct netcheck *n, FILE *out)
{
    fprintf(out, "%-66s %9s", "case (errors in % of the reference)", "cycles");
    for (int l = 0; l < NETCHECK_LEVELS; l++)
        if (n->level[l]) fprintf(out, " %9s", level_names[l]);
    fprintf(out, "\n");
    for (int i = 0; i < n->nrow; i++) {
        const struct netcheck_row *row = &n->row[i];
        fprintf(out, "%-66s %9.6g", row->name, row->high);
        for (int l = 0; l < NETCHECK_LEVELS; l++) {
            const struct netcheck_answer *a = &row->answer[l];
            if (!n->level[l]) continue;
            if (!a->ran || !row->counted) fprintf(out, " %9s", "-");
            else if (a->deadlock) fprintf(out, " %9s", "deadlock");
            else fprintf(out, " %+9.2f", 100 * a->error);
        }
        fprintf(out, "\n");
    }
}

static void print_total(const struct netcheck *n, const char *group, FILE *out)
{
    for (int l = 0; l < NETCHECK_LEVELS; l++) {
        struct netcheck_total t = netcheck_total(n, group, (enum network_level)l);
        if (!n->level[l] || t.cases == 0) continue;
        fprintf(out, "%-30s %-7s %6d %7d %7d %9.3f %+9.2f %9.3f ", group ? group : "all", level_names[l], t.cases,
                t.skipped, t.exact_cases, 100 * t.mean, 100 * t.worst, 100 * t.message_error);
        if (t.messages > 0) fprintf(out, "%9.3f\n", 100.0 * (double)t.exact / (double)t.messages);
        else fprintf(out, "%9s\n", "-");
    }
}

/* why cases could not be answered, each reason once per level */
static void print_reasons(const struct netcheck *n, FILE *out)
{
    for (int l = 0; l < NETCHECK_LEVELS; l++) {
        const char *last = "";
        for (int i = 0; n->level[l] && i < n->nrow; i++) {
            const struct netcheck_answer *a = &n->row[i].answer[l];
            if (a->ran || strcmp(a->why, last) == 0) continue;
            fprintf(out, "%s skipped %s: %s\n", level_names[l], n->row[i].name, a->why);
            last = a->why;
        }
    }
}

void netcheck_print(const struct netcheck *n, bool brief, FILE *out)
{
    if (!brief) print_cases(n, out);
    if (!brief) print_reasons(n, out);
    fprintf(out, "%s%-30s %-7s %6s %7s %7s %9s %9s %9s %9s\n", brief ? "" : "\n", "group", "level", "cases", "skipped",
            "exact", "mean|e|%", "worst %", "message %", "exact m %");
    for (int i = 0; i < n->nrow; i++)
        if (opens_group(n, i)) print_total(n, n->row[i].group, out);
    print_total(n, NULL, out);
}

/* Keys are sorted, in every object. */
static void json_answer(struct json *j, const struct netcheck_row *row, const struct netcheck_answer *a)
{
    bool compared = a->ran && row->compared && !a->deadlock;
    json_object(j);
    if (a->ran) {
        json_key(j, "deadlock");
        json_bool(j, a->deadlock);
    }
    if (compared) {
        json_key(j, "differing_messages");
        json_int(j, a->differing);
    }
    if (a->ran) {
        json_key(j, "error");
        json_real(j, a->error);
        json_key(j, "events");
        json_int(j, a->events);
        json_key(j, "found");
        json_real(j, a->found);
    }
    if (compared) {
        json_key(j, "mean_message_error");
        json_real(j, a->message_error);
    }
    json_key(j, "ran");
    json_bool(j, a->ran);
    if (a->why[0]) {
        json_key(j, "why");
        json_text(j, a->why);
    }
    json_end(j);
}

static void json_rows(const struct netcheck *n, struct json *j)
{
    static const enum network_level by_name[] = {LEVEL_AUTO, LEVEL_FLIT, LEVEL_LINK, LEVEL_LOGGP, LEVEL_PACKET};
    json_array(j);
    for (int i = 0; i < n->nrow; i++) {
        const struct netcheck_row *row = &n->row[i];
        json_object(j);
        json_key(j, "case");
        json_text(j, row->name);
        json_key(j, "counted");
        json_bool(j, row->counted);
        json_key(j, "group");
        json_text(j, row->group);
        json_key(j, "levels");
        json_object(j);
        for (int l = 0; l < NETCHECK_LEVELS; l++) {
            if (!n->level[by_name[l]]) continue;
            json_key(j, level_names[by_name[l]]);
            json_answer(j, row, &row->answer[by_name[l]]);
        }
        json_end(j);
        json_key(j, "messages");
        json_int(j, row->nmessage);
        json_key(j, "reference_high");
        json_real(j, row->high);
        json_key(j, "reference_low");
        json_real(j, row->low);
        json_end(j);
    }
    json_end(j);
}

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

static void json_total(const struct netcheck *n, const char *group, struct json *j)
{
    for (int l = 0; l < NETCHECK_LEVELS; l++) {
        struct netcheck_total t = netcheck_total(n, group, (enum network_level)l);
        if (!n->level[l]) continue;
        json_object(j);
        key_int(j, "cases", t.cases);
        key_int(j, "exact_cases", t.exact_cases);
        key_int(j, "exact_messages", t.exact);
        json_key(j, "group");
        json_text(j, group ? group : "all");
        json_key(j, "level");
        json_text(j, level_names[l]);
        key_real(j, "mean_error", t.mean);
        key_real(j, "mean_message_error", t.message_error);
        key_int(j, "messages", t.messages);
        key_int(j, "skipped", t.skipped);
        key_real(j, "worst_error", t.worst);
        json_end(j);
    }
}

void netcheck_json_object(const struct netcheck *n, struct json *j)
{
    json_object(j);
    json_key(j, "cases");
    json_rows(n, j);
    json_key(j, "file");
    json_text(j, n->path);
    json_key(j, "totals");
    json_array(j);
    for (int i = 0; i < n->nrow; i++)
        if (opens_group(n, i)) json_total(n, n->row[i].group, j);
    json_total(n, NULL, j);
    json_end(j);
    json_end(j);
}

void netcheck_json(const struct netcheck *n, FILE *out)
{
    struct json j = json_make(out);
    netcheck_json_object(n, &j);
    json_finish(&j);
}

bool netcheck_file(const char *path, const enum network_level *level, bool json, bool brief, bool quiet, FILE *out,
                   struct err *e)
{
    struct netcheck n;
    bool wanted[NETCHECK_LEVELS] = {false};
    struct arena *a = arena_create();
    if (level) wanted[*level] = true;
    bool ok = netcheck_run(&n, path, level ? wanted : NULL, NULL, quiet, a, e);
    if (ok && json) netcheck_json(&n, out);
    else if (ok) netcheck_print(&n, brief, out);
    arena_destroy(a);
    return ok;
}

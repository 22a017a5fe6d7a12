/* netcheck_print.c - statistics of the answers to reference cases, as tables and as JSON. */
#include <math.h>
#include <string.h>

#include "base/json.h"
#include "base/text.h"
#include "measure/column.h"
#include "study/netcheck_verdict.h"

const char *netcheck_level_name(enum network_level level) { return network_level_name(level); }

/* One pass over the rows. Errors are averaged over cases, messages over all cases together. */
struct netcheck_total netcheck_total(const struct netcheck *n, const char *group,
                                     enum network_level level)
{
    struct netcheck_total t = {0};
    int compared = 0;
    for (int i = 0; i < n->nrow; i++) {
        const struct netcheck_row *row = &n->row[i];
        const struct netcheck_answer *a = &row->answer[level];
        if (!netcheck_in_group(row, group) || row->played) continue;
        t.skipped += !a->ran;
        /* What a level cannot run counts as skipped, not as wrong. */
        if (!a->ran) continue;
        t.cases++;
        /* Exact: within a thousandth of a cycle. */
        t.exact_cases += fabs(a->error) * row->high < 1e-3;
        t.mean += fabs(a->error);
        if (fabs(a->error) > fabs(t.worst)) t.worst = a->error;
        /* After a deadlock some messages have no arrival. */
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

/* The head of both tables of cases: two columns, then one for each level that was asked for. */
static void print_heads(const struct netcheck *n, const char *first, const char *second, FILE *out)
{
    fprintf(out, "%-66s %9s", first, second);
    for (int l = 0; l < LEVELS; l++)
        if (n->level[l]) fprintf(out, " %10s", network_level_name((enum network_level)l));
    fprintf(out, "\n");
}

/* One line per case: errors in per cent, with a ! where the stated accuracy is broken. */
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

/* A message that never arrived has an infinite time. */
static void print_time(const struct netcheck_answer *a, double time, FILE *out)
{
    if (!a->ran) fprintf(out, " %10s", "-");
    else if (a->deadlock && !(time < 1e15)) fprintf(out, " %10s", "deadlock");
    else fprintf(out, " %10.10g", time);
}

/* Cases without reference answers: makespans and, unless brief, the arrival of each message. */
static void print_played(const struct netcheck *n, bool brief, FILE *out)
{
    char name[80];
    print_heads(n, "case without a reference (times in cycles)", "messages", out);
    for (int i = 0; i < n->nrow; i++) {
        const struct netcheck_row *row = &n->row[i];
        if (!row->played) continue;
        /* the makespan at each level */
        fprintf(out, "%-66s %9d", row->name, row->nmessage);
        for (int l = 0; l < LEVELS; l++)
            if (n->level[l]) print_time(&row->answer[l], row->answer[l].found, out);
        fprintf(out, "\n");
        /* and when each message arrives */
        for (int m = 0; !brief && row->src && m < row->nmessage; m++) {
            snprintf(name, sizeof name, "  message %d: %d -> %d, %d flits", m, row->src[m],
                     row->dst[m], row->flits[m]);
            fprintf(out, "%-66s %9s", name, "");
            for (int l = 0; l < LEVELS; l++)
                if (n->level[l])
                    print_time(&row->answer[l],
                               row->answer[l].arrival ? row->answer[l].arrival[m] : 0, out);
            fprintf(out, "\n");
        }
    }
}

/* The lines of one group, one per level that answered any of its cases: statistics of the
 * errors, then what is stated of them. group NULL: all cases, for which nothing is stated. */
static void print_total(const struct netcheck *n, const char *group, double within, FILE *out)
{
    for (int l = 0; l < LEVELS; l++) {
        struct netcheck_total t = netcheck_total(n, group, (enum network_level)l);
        /* both are made of the rows each time: a file has hundreds, not millions */
        struct netcheck_verdict v = netcheck_verdict(n, group, (enum network_level)l, within);
        if (!n->level[l] || t.cases == 0) continue;
        fprintf(out, "%-30s %-7s %6d %7d %7d %9.3f %+9.2f %9.3f ", group ? group : "all",
                network_level_name((enum network_level)l), t.cases, t.skipped, t.exact_cases,
                100 * t.mean, 100 * t.worst, 100 * t.message_error);
        /* the share of messages with the reference's arrival */
        if (t.messages > 0) fprintf(out, "%9.3f ", 100.0 * (double)t.exact / (double)t.messages);
        else fprintf(out, "%9s ", "-");
        if (!group) fprintf(out, "\n");
        else
            fprintf(out, "%7.1f %+6.0f %+6.0f  %s\n", 100 * v.mean_limit, 100 * v.low, 100 * v.high,
                    v.pass ? "pass" : "FAIL");
    }
}

/* Why cases could not be answered, level by level; of equal reasons in a row only the first is
 * printed. */
static void print_reasons(const struct netcheck *n, FILE *out)
{
    for (int l = 0; l < LEVELS; l++) {
        const char *last = "";
        for (int i = 0; n->level[l] && i < n->nrow; i++) {
            const struct netcheck_answer *a = &n->row[i].answer[l];
            if (a->ran || strcmp(a->why, last) == 0) continue;
            fprintf(out, "%s skipped %s: %s\n", network_level_name((enum network_level)l),
                    n->row[i].name, a->why);
            last = a->why;
        }
    }
}

/* What a reader must know of a file that fails: the first reason of each verdict, contradictions
 * of the file in itself, how many cases no level could run, and keys that nothing was compared
 * with. */
static void print_findings(const struct netcheck *n, double within, FILE *out)
{
    int silent = 0;
    for (int i = 0; i < n->nrow; i++) {
        bool any = false;
        for (int l = 0; l < LEVELS; l++) any = any || n->row[i].answer[l].ran;
        silent += !any;
        if (n->row[i].flaw[0])
            fprintf(out, "FAIL %s:%d: %s: %s\n", n->path, n->row[i].line, n->row[i].name,
                    n->row[i].flaw);
        for (int l = 0; netcheck_opens_group(n, i) && l < LEVELS; l++) {
            struct netcheck_verdict v =
                netcheck_verdict(n, n->row[i].group, (enum network_level)l, within);
            if (n->level[l] && !v.pass)
                fprintf(out, "FAIL %s, %s: %d of %d cases; %s\n", n->row[i].group,
                        network_level_name((enum network_level)l), v.failed, v.cases, v.why);
        }
    }
    /* A file whose cases no level can run would otherwise look like one that passed. */
    if (silent > 0)
        fprintf(out, "not judged: %d of %d cases, which no level can run\n", silent, n->nrow);
    for (int i = 0; i < n->nignored; i++)
        fprintf(out, "%s%s", i ? ", " : "compared with nothing: ", n->ignored[i]);
    if (n->nignored > 0) fprintf(out, "\n");
}

/* Tables only of what is there: a file has cases with answers or cases to play, never both. */
void netcheck_print(const struct netcheck *n, double within, bool brief, FILE *out)
{
    int played = 0;
    for (int i = 0; i < n->nrow; i++) played += n->row[i].played;
    if (!brief && played < n->nrow) print_cases(n, within, out);
    if (played > 0) print_played(n, brief, out);
    if (!brief) print_reasons(n, out);
    if (played < n->nrow) {
        fprintf(out, "%s%-30s %-7s %6s %7s %7s %9s %9s %9s %9s %7s %6s %6s  %s\n",
                brief ? "" : "\n", "group", "level", "cases", "skipped", "exact", "mean|e|%",
                "worst %", "message %", "exact m %", "mean to", "from", "to", "verdict");
        for (int i = 0; i < n->nrow; i++)
            if (netcheck_opens_group(n, i) && !n->row[i].played)
                print_total(n, n->row[i].group, within, out);
        print_total(n, NULL, within, out);
    }
    print_findings(n, within, out);
}

/* --- JSON ------------------------------------------------------------------------------------- */

/* What the columns are of: a case, its answer at a level, or the statistics of a group at a
 * level. */
struct shown {
    const struct netcheck *all;
    const struct netcheck_row *row;
    const struct netcheck_answer *answer;
    enum network_level level;
    double within;
    const char *group; /* NULL: all */
    struct netcheck_total total;
    struct netcheck_verdict verdict;
};

/* Names for the conditions of the columns below: `known` gets a row of any type. */
static const struct shown *shown(const void *row) { return row; }

/* An answer that exists; the conditions below build on each other. */
static bool ran(const void *x) { return shown(x)->answer->ran; }

static bool was_played(const void *x) { return shown(x)->answer->arrival != NULL; }

static bool has_reference(const void *x) { return !shown(x)->row->played; }

static bool has_error(const void *x) { return ran(x) && has_reference(x); }

static bool is_judged(const void *x) { return has_error(x) && shown(x)->row->counted; }

static bool is_compared(const void *x)
{
    return ran(x) && shown(x)->row->compared && !shown(x)->answer->deadlock;
}

static bool says_why(const void *x) { return shown(x)->answer->why[0]; }

/* The arrivals of a played list; null for a message that never arrived. */
static void write_arrivals(const struct column *c, const void *x, struct json *j)
{
    const double *arrival = shown(x)->answer->arrival;
    (void)c;
    json_array(j);
    for (int m = 0; m < shown(x)->row->nmessage; m++)
        if (arrival[m] < 1e15) json_real(j, arrival[m]);
        else json_null(j);
    json_end(j);
}

/* A constant text as the value of a column. */
static void set_word(struct column_value *v, const char *s)
{
    v->kind = VALUE_TEXT;
    v->text = s;
}

/* pass or FAIL of one case at one level. */
static void read_row_verdict(const struct column *c, const void *x, struct column_value *v)
{
    (void)c;
    set_word(v, netcheck_row_fails(shown(x)->row, shown(x)->level, shown(x)->within, NULL)
                    ? "FAIL"
                    : "pass");
}

/* A key that is there when `test` holds; a number that is not finite is null then. */
#define WHEN(test) .known = (test), .flags = COLUMN_OPTIONAL
#define ANSWER(member)                                                                             \
    .part = PART(struct shown, answer), .offset = offsetof(struct netcheck_answer, member)

/* What one level says of one case. Keys are there only when they mean something: a level that
 * cannot run the case has `why` and no error. */
static const struct column answer_column[] = {
    {"arrival", COLUMN_STRING, .json = write_arrivals, .known = was_played,
     .doc = "of each message [cycles]"},
    {"deadlock", COLUMN_BOOL, ANSWER(deadlock), WHEN(ran), .doc = "the network was stuck"},
    {"differing_messages", COLUMN_INT, ANSWER(differing), WHEN(is_compared),
     .doc = "arrivals that are not the same"},
    {"error", COLUMN_REAL, ANSWER(error), WHEN(has_error), .doc = "relative to the reference"},
    {"events", COLUMN_INT64, ANSWER(events), WHEN(ran), .doc = "dispatched by the simulator"},
    {"found", COLUMN_REAL, ANSWER(found), WHEN(ran), .doc = "time [cycles], or load at saturation"},
    {"mean_message_error", COLUMN_REAL, ANSWER(message_error), WHEN(is_compared),
     .doc = "of arrivals, relative"},
    {"ran", COLUMN_BOOL, ANSWER(ran), .doc = "whether the level can run the case"},
    {"verdict", COLUMN_STRING, .value = read_row_verdict, WHEN(is_judged),
     .doc = "by the stated accuracy"},
    {"why", COLUMN_CHARS, ANSWER(why), WHEN(says_why), .doc = "it cannot"},
    {"worst_message_error", COLUMN_REAL, ANSWER(message_worst), WHEN(is_compared),
     .doc = "the largest of them"},
};
static const struct column_table answer_columns = COLUMNS(answer_column);

/* An object of levels: its keys in the order of the alphabet, as in all JSON of this program. */
static void write_levels(const struct column *c, const void *x, struct json *j)
{
    enum network_level by_name[LEVELS];
    (void)c;
    network_levels_by_name(by_name);
    json_object(j);
    for (int l = 0; l < LEVELS; l++) {
        struct shown at = *shown(x);
        if (!at.all->level[by_name[l]]) continue;
        at.level = by_name[l];
        at.answer = &at.row->answer[at.level];
        json_key(j, network_level_name(at.level));
        columns_json(&answer_columns, &at, j);
    }
    json_end(j);
}

/* A played case has no reference: it is never counted. */
static void read_counted(const struct column *c, const void *x, struct column_value *v)
{
    (void)c;
    v->kind = VALUE_BOOL;
    v->integer = shown(x)->row->counted && !shown(x)->row->played;
}

static bool has_flaw(const void *x) { return shown(x)->row->flaw[0]; }

#define CASE(member)                                                                               \
    .part = PART(struct shown, row), .offset = offsetof(struct netcheck_row, member)

/* One case: its name and reference, and under `levels` an object of answers. */
static const struct column case_column[] = {
    {"case", COLUMN_CHARS, CASE(name), .doc = "its name"},
    {"counted", COLUMN_BOOL, .value = read_counted,
     .doc = "whether there is something to compare with"},
    {"flaw", COLUMN_CHARS, CASE(flaw), WHEN(has_flaw),
     .doc = "in what the reference contradicts itself"},
    {"group", COLUMN_CHARS, CASE(group), .doc = "what it is counted with"},
    {"levels", COLUMN_STRING, .json = write_levels, .doc = "an answer for each level"},
    {"line", COLUMN_INT, CASE(line), .doc = "in the file"},
    {"messages", COLUMN_INT, CASE(nmessage), .doc = "of the case"},
    {"reference_high", COLUMN_REAL, CASE(high), WHEN(has_reference),
     .doc = "largest right answer [cycles]"},
    {"reference_low", COLUMN_REAL, CASE(low), WHEN(has_reference),
     .doc = "least right answer [cycles]"},
};
static const struct column_table case_columns = COLUMNS(case_column);

/* The totals of all cases together have no limits: groups differ in what is stated of them. */
static bool is_group(const void *x) { return shown(x)->group != NULL; }

static bool group_judged(const void *x) { return is_group(x) && shown(x)->verdict.cases > 0; }

static bool group_fails(const void *x) { return is_group(x) && !shown(x)->verdict.pass; }

static void read_group(const struct column *c, const void *x, struct column_value *v)
{
    (void)c;
    set_word(v, is_group(x) ? shown(x)->group : "all");
}

static void read_level(const struct column *c, const void *x, struct column_value *v)
{
    (void)c;
    set_word(v, network_level_name(shown(x)->level));
}

static void read_group_verdict(const struct column *c, const void *x, struct column_value *v)
{
    (void)c;
    set_word(v, shown(x)->verdict.pass ? "pass" : "FAIL");
}

#define TOTAL(member) .offset = offsetof(struct shown, total.member)
#define VERDICT(member) .offset = offsetof(struct shown, verdict.member)

/* The statistics of a group at a level, and its verdict where there is one. */
static const struct column total_column[] = {
    {"cases", COLUMN_INT, TOTAL(cases), .doc = "answered"},
    {"exact_cases", COLUMN_INT, TOTAL(exact_cases), .doc = "with the reference's time"},
    {"exact_messages", COLUMN_INT64, TOTAL(exact), .doc = "with the reference's arrival"},
    {"failed", COLUMN_INT, VERDICT(failed), .doc = "cases that break the stated accuracy"},
    {"group", COLUMN_STRING, .value = read_group, .doc = "of cases"},
    {"level", COLUMN_STRING, .value = read_level, .doc = "of the network"},
    {"mean_error", COLUMN_REAL, TOTAL(mean), .doc = "of its size, relative"},
    {"mean_limit", COLUMN_REAL, VERDICT(mean_limit), WHEN(is_group), .doc = "what it may be"},
    {"mean_message_error", COLUMN_REAL, TOTAL(message_error), .doc = "over the cases"},
    {"messages", COLUMN_INT64, TOTAL(messages), .doc = "compared"},
    {"skipped", COLUMN_INT, TOTAL(skipped), .doc = "cases that the level cannot run"},
    {"verdict", COLUMN_STRING, .value = read_group_verdict, WHEN(group_judged),
     .doc = "by the stated accuracy"},
    {"why", COLUMN_CHARS, VERDICT(why), WHEN(group_fails), .doc = "it fails"},
    {"worst_error", COLUMN_REAL, TOTAL(worst), .doc = "with its sign"},
    {"worst_high", COLUMN_REAL, VERDICT(high), WHEN(is_group), .doc = "the largest that it may be"},
    {"worst_low", COLUMN_REAL, VERDICT(low), WHEN(is_group), .doc = "the least that it may be"},
};
static const struct column_table total_columns = COLUMNS(total_column);

/* The statistics of one group at each level asked for; group NULL: of all cases. */
static void json_totals(const struct netcheck *n, const char *group, double within, struct json *j)
{
    for (int l = 0; l < LEVELS; l++) {
        struct shown x = {
            .all = n, .level = (enum network_level)l, .within = within, .group = group};
        if (!n->level[l]) continue;
        x.total = netcheck_total(n, group, x.level);
        x.verdict = netcheck_verdict(n, group, x.level, within);
        columns_json(&total_columns, &x, j);
    }
}

/* One document: cases, what was compared with nothing, totals, verdict. Keys by alphabet. */
void netcheck_json_object(const struct netcheck *n, double within, struct json *j)
{
    json_object(j);
    json_key(j, "cases");
    json_array(j);
    for (int i = 0; i < n->nrow; i++)
        columns_json(&case_columns, &(struct shown){.all = n, .row = &n->row[i], .within = within},
                     j);
    json_end(j);
    /* keys of the file that this program does not know */
    json_key(j, "compared_with_nothing");
    json_array(j);
    for (int i = 0; i < n->nignored; i++) json_text(j, n->ignored[i]);
    json_end(j);
    json_key_text(j, "file", n->path);
    json_key(j, "totals");
    json_array(j);
    for (int i = 0; i < n->nrow; i++)
        if (netcheck_opens_group(n, i) && !n->row[i].played)
            json_totals(n, n->row[i].group, within, j);
    json_totals(n, NULL, within, j);
    json_end(j);
    /* A file without anything to compare neither passes nor fails. */
    bool any = false;
    for (int i = 0; i < n->nrow; i++) any = any || (n->row[i].counted && !n->row[i].played);
    json_key_text(j, "verdict", !any ? "not judged" : netcheck_pass(n, within) ? "pass" : "FAIL");
    json_end(j);
}

/* A limit in per cent with its sign; 0 stands for equality. */
static void print_percent(double x, FILE *out)
{
    if (x == 0) fprintf(out, " 0 |");
    else fprintf(out, " %+.3g |", 100 * x);
}

/* The same table as in docs/network.md, written from the figures that judge. */
void netcheck_print_stated(FILE *out)
{
    fprintf(out, "| level | cases | mean of absolute errors, %% | a case from, %% | to, %% | a "
                 "message, %% |\n| --- | --- | --- | --- | --- | --- |\n");
    const struct netcheck_accuracy *s;
    for (int i = 0; (s = netcheck_accuracies(i)); i++) {
        fprintf(out, "| %s | %s | %.3g |", s->levels, s->cases, 100 * s->mean);
        print_percent(s->low, out);
        print_percent(s->high, out);
        /* -1: the messages of such cases have no reference. */
        if (s->message < 0) fprintf(out, " - |\n");
        else fprintf(out, " %.3g |\n", 100 * s->message);
    }
}

static bool has_message(const void *row)
{
    return ((const struct netcheck_accuracy *)row)->message >= 0;
}

#define STATED(member) .offset = offsetof(struct netcheck_accuracy, member)

/* An entry of the table of stated accuracies: fractions of the reference, not per cent. */
static const struct column stated_column[] = {
    {"cases", COLUMN_STRING, STATED(cases), .doc = "the class of cases in words"},
    {"levels", COLUMN_STRING, STATED(levels), .doc = "for which it holds"},
    {"mean", COLUMN_REAL, STATED(mean), .doc = "largest mean of |error| over many cases"},
    {"message", COLUMN_REAL, STATED(message), WHEN(has_message),
     .doc = "largest |error| of one message's arrival"},
    {"worst_high", COLUMN_REAL, STATED(high), .doc = "largest error of one case"},
    {"worst_low", COLUMN_REAL, STATED(low), .doc = "least error of one case"},
};
static const struct column_table stated_columns = COLUMNS(stated_column);

/* The same table for programs: a list of objects. */
void netcheck_json_stated(FILE *out)
{
    struct json j = json_make(out);
    const struct netcheck_accuracy *s;
    json_array(&j);
    for (int i = 0; (s = netcheck_accuracies(i)); i++) columns_json(&stated_columns, s, &j);
    json_end(&j);
    json_finish(&j);
}

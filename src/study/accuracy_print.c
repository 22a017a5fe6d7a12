/* accuracy_print.c - ladders as tables and as JSON. */
#include <math.h>
#include <string.h>

#include "base/json.h"
#include "study/accuracy.h"

#define RUNG(member) .offset = offsetof(struct accuracy_rung, member)

static const char *const status_word[] = {"ok", "degraded", "failed"};

/* A network level is method and rung at once: its name is not printed a second time. */
static void read_rung(const struct column *c, const void *row, struct column_value *v)
{
    const struct accuracy_rung *x = row;
    (void)c;
    v->kind = VALUE_TEXT;
    v->text = strcmp(x->method, x->rung) == 0 ? "" : x->rung;
}

/* Columns of a rung: the table of the database, the list in JSON, and the terminal's columns
 * (those with a title). */
static const struct column rung_column[] = {
    {"ladder", COLUMN_CHARS, RUNG(ladder), .doc = "network, arithmetic or integration"},
    {"at", COLUMN_CHARS, RUNG(at), .doc = "point of the scenario: \"n=P=128\""},
    {"family", COLUMN_CHARS, RUNG(family), .flags = COLUMN_NO_JSON,
     .doc = "SHA-256 of the settings without sizes, level and seeds: what it holds for"},
    {"method", COLUMN_CHARS, RUNG(method), .title = "method", .before = "  ", .width = -24,
     .doc = "a curve"},
    {"rung", COLUMN_CHARS, RUNG(rung), .doc = "a point on it: level, step size, tolerance"},
    {"rung_shown", COLUMN_STRING, .value = read_rung, .flags = COLUMN_NO_SQL | COLUMN_NO_JSON,
     .title = "rung", .before = " ", .width = -18,
     .doc = "as `rung`, blank where that is the method"},
    {"quantity", COLUMN_CHARS, RUNG(quantity), .doc = "what was compared"},
    {"reference", COLUMN_CHARS, RUNG(reference), .doc = "with what"},
    {"status", COLUMN_WORD, RUNG(status), WORDS(status_word), .title = "status", .before = " ",
     .width = -9, .doc = "whether it is good enough, poor, or no answer"},
    {"relative_error", COLUMN_REAL, RUNG(error), .flags = COLUMN_NULL, .key = "error",
     .title = "error", .width = 10, .style = 'e', .digits = 2,
     .doc = "NULL: failed, or not finite"},
    {"host_s", COLUMN_REAL, RUNG(host_s), .flags = COLUMN_NULL, .title = "host_ms", .width = 12,
     .style = 'f', .digits = 4, .scale = 1e3, .doc = "time on this computer"},
    {"machine_ps", COLUMN_INT64, RUNG(machine_ps), .flags = COLUMN_NULL, .absent = ABSENT_NEGATIVE,
     .key = "machine_s", .json_scale = 1e-12, .title = "machine_us", .width = 14, .style = 'f',
     .digits = 3, .scale = 1e-6, .doc = "predicted time on the machine"},
    {"text", COLUMN_CHARS, RUNG(text), .title = "", .before = "  ",
     .doc = "why it failed; processors used"},
};
const struct column_table accuracy_rung_columns = COLUMNS(rung_column);

#define CHOICE(member) .offset = offsetof(struct accuracy_choice, member)
/* A column that lies in the chosen rung; absent where none is within the tolerance. */
#define CHOSEN(member)                                                                             \
    .part = PART(struct accuracy_choice, rung), .offset = offsetof(struct accuracy_rung, member),  \
    .known = has_rung

/* Whether any rung is within the tolerance. */
static bool has_rung(const void *row)
{
    return ((const struct accuracy_choice *)row)->rung != NULL;
}

/* Columns of a choice: what was asked, the cheapest rung within the tolerance, and what the most
 * accurate one would cost. */
static const struct column choice_column[] = {
    {"ladder", COLUMN_STRING, CHOICE(ladder), .doc = "network, arithmetic or integration"},
    {"at", COLUMN_STRING, CHOICE(at), .flags = COLUMN_NO_JSON, .doc = "point of the scenario"},
    {"quantity", COLUMN_STRING, CHOICE(quantity), .doc = "what was compared"},
    {"tolerance", COLUMN_REAL, CHOICE(tolerance), .doc = "largest error asked for"},
    {"method", COLUMN_CHARS, CHOSEN(method), .flags = COLUMN_NULL, .doc = "NULL: no rung is within the tolerance"},
    {"rung", COLUMN_CHARS, CHOSEN(rung), .flags = COLUMN_NULL, .doc = "the cheapest that is"},
    {"relative_error", COLUMN_REAL, CHOSEN(error), .flags = COLUMN_NULL, .key = "error", .doc = "of that rung"},
    {"cost_ratio", COLUMN_REAL, CHOICE(cost_ratio), .known = has_rung, .flags = COLUMN_NULL,
     .doc = "of the finest rung's cost to this one's"},
};
const struct column_table accuracy_choice_columns = COLUMNS(choice_column);

/* One line of a rung: columns for its first quantity x[0], the errors of the other quantities
 * (x[1] to x[n - 1]) behind them. */
static void print_rung(FILE *out, const struct accuracy_rung *x, int n)
{
    columns_cells(&accuracy_rung_columns, x, out);
    /* A failed rung has no errors, but the reason instead. */
    for (int i = 1; i < n && isfinite(x->error); i++)
        fprintf(out, "%s%s %.1e", i > 1 || x->text[0] ? ", " : "", x[i].quantity, x[i].error);
    fprintf(out, "\n");
}

/* How many rows from i on are of the same rung. */
/* The rows of a rung follow each other in the report, one per quantity. */
static int rung_length(const struct accuracy_report *r, int i)
{
    int n = 1;
    while (i + n < r->nrung && strcmp(r->rung[i + n].ladder, r->rung[i].ladder) == 0 &&
           strcmp(r->rung[i + n].method, r->rung[i].method) == 0 &&
           strcmp(r->rung[i + n].rung, r->rung[i].rung) == 0)
        n++;
    return n;
}

/* The choice as one sentence; there are three: no result at all, none within the tolerance, or
 * the cheapest with what the most accurate would cost. */
static void print_choice(FILE *out, const struct accuracy_choice *c)
{
    fprintf(out, "%s (%s%s%s within %.2g): ", c->ladder, c->at, c->at[0] ? ", " : "", c->quantity,
            c->tolerance);
    if (!c->finest) {
        fprintf(out, "no method has a result\n");
        return;
    }
    if (!c->rung) {
        fprintf(out, "no method is within the tolerance; the most accurate, %s %s, has an error of "
                     "%.1e\n", c->finest->method,
                c->finest->rung, c->finest->error);
        return;
    }
    /* A network level has one name, a stepper two: "rk4" and "64 steps". */
    /* "link" alone, but "rk4, 64 steps" */
    bool same = strcmp(c->rung->method, c->rung->rung) == 0;
    fprintf(out, "%s%s%s, error %.1e", c->rung->method, same ? "" : ", ", same ? "" : c->rung->rung,
            c->rung->error);
    /* For network levels the host's time was compared; the machine's is the result itself. */
    if (c->rung->machine_ps >= 0 && strcmp(c->ladder, "network") != 0)
        fprintf(out, ", %.3f us on the machine", (double)c->rung->machine_ps * 1e-6);
    same = strcmp(c->finest->method, c->finest->rung) == 0;
    fprintf(out, "%s%s; the most accurate (%s%s%s) costs %.3g times as much\n",
            strcmp(c->ladder, "integration") == 0 ? ", " : "",
            strcmp(c->ladder, "integration") == 0 ? c->rung->text : "", c->finest->method,
            same ? "" : ", ", same ? "" : c->finest->rung, c->cost_ratio);
}

void accuracy_print(FILE *out, const struct accuracy_report *r)
{
    const char *ladder = "";
    /* Rungs of all quantities lie behind each other: one line for each group of them. */
    for (int i = 0, n; i < r->nrung; i += n) {
        const struct accuracy_rung *x = &r->rung[i];
        n = rung_length(r, i);
        /* The title again for every ladder, which differ in their references. */
        if (strcmp(ladder, x->ladder) != 0) {
            fprintf(out, "%s%s, %s: %s against %s\n", i > 0 ? "\n" : "", x->ladder, x->at,
                    x->quantity, x->reference);
            columns_title(&accuracy_rung_columns, out);
        }
        ladder = x->ladder;
        print_rung(out, x, n);
    }
    fprintf(out, "\n");
    for (int i = 0; i < r->nchoice; i++) print_choice(out, &r->choice[i]);
}

/* The same as one document; keys in the order of the alphabet. */
void accuracy_print_json(FILE *out, const struct accuracy_report *r)
{
    struct json j = json_make(out);
    json_object(&j);
    json_key(&j, "choices");
    columns_json_list(&accuracy_choice_columns, r->choice, r->nchoice, sizeof *r->choice, &j);
    json_key(&j, "rungs");
    columns_json_list(&accuracy_rung_columns, r->rung, r->nrung, sizeof *r->rung, &j);
    json_key_text(&j, "scenario", r->scenario);
    json_end(&j);
    json_finish(&j);
}

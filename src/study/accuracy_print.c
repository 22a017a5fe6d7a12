/* accuracy_print.c - ladders as tables and as JSON. */
#include <math.h>
#include <string.h>

#include "base/json.h"
#include "study/accuracy.h"

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

/* How many rows from i on are of the same rung. The rows of a rung follow each other in the report,
 * one per quantity. */
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
    /* A network level has one name, "link", a stepper two: "rk4, 64 steps". */
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

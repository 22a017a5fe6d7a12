/* accuracy_print.c - ladders as tables and as JSON. */
#include <math.h>
#include <string.h>

#include "base/json.h"
#include "study/accuracy.h"

static void print_number(FILE *out, const char *format, int width, double x)
{
    if (isfinite(x)) fprintf(out, format, width, x);
    else fprintf(out, "%*s", width, "-");
}

/* One rung, whose first quantity is x[0] and whose others follow. */
static void print_rung(FILE *out, const struct accuracy_rung *x, int n)
{
    fprintf(out, "  %-24s %-18s %-9s", x->method, strcmp(x->method, x->rung) == 0 ? "" : x->rung,
            rung_status_word(x->status));
    print_number(out, "%*.2e", 10, x->error);
    print_number(out, "%*.4f", 12, x->host_s * 1e3);
    print_number(out, "%*.3f", 14, x->machine_ps >= 0 ? (double)x->machine_ps * 1e-6 : NAN);
    fprintf(out, "  %s", x->text);
    for (int i = 1; i < n && isfinite(x->error); i++)
        fprintf(out, "%s%s %.1e", i > 1 || x->text[0] ? ", " : "", x[i].quantity, x[i].error);
    fprintf(out, "\n");
}

/* How many rows from i on are of the same rung. */
static int rung_length(const struct accuracy_report *r, int i)
{
    int n = 1;
    while (i + n < r->nrung && strcmp(r->rung[i + n].ladder, r->rung[i].ladder) == 0 &&
           strcmp(r->rung[i + n].method, r->rung[i].method) == 0 && strcmp(r->rung[i + n].rung, r->rung[i].rung) == 0)
        n++;
    return n;
}

static void print_choice(FILE *out, const struct accuracy_choice *c)
{
    fprintf(out, "%s (%s%s%s within %.2g): ", c->ladder, c->at, c->at[0] ? ", " : "", c->quantity, c->tolerance);
    if (!c->finest) {
        fprintf(out, "no rung has an answer\n");
        return;
    }
    if (!c->rung) {
        fprintf(out, "no rung is good enough; the finest, %s %s, has an error of %.1e\n", c->finest->method,
                c->finest->rung, c->finest->error);
        return;
    }
    bool same = strcmp(c->rung->method, c->rung->rung) == 0;
    fprintf(out, "%s%s%s, error %.1e", c->rung->method, same ? "" : ", ", same ? "" : c->rung->rung, c->rung->error);
    if (c->rung->machine_ps >= 0 && strcmp(c->ladder, "network") != 0)
        fprintf(out, ", %.3f us of the machine", (double)c->rung->machine_ps * 1e-6);
    same = strcmp(c->finest->method, c->finest->rung) == 0;
    fprintf(out, "%s%s; the finest (%s%s%s) costs %.3g times as much\n",
            strcmp(c->ladder, "integration") == 0 ? ", " : "",
            strcmp(c->ladder, "integration") == 0 ? c->rung->text : "", c->finest->method, same ? "" : ", ",
            same ? "" : c->finest->rung, c->cost_ratio);
}

void accuracy_print(FILE *out, const struct accuracy_report *r)
{
    const char *ladder = "";
    for (int i = 0, n; i < r->nrung; i += n) {
        const struct accuracy_rung *x = &r->rung[i];
        n = rung_length(r, i);
        if (strcmp(ladder, x->ladder) != 0) {
            fprintf(out, "%s%s, %s: %s against %s\n", i > 0 ? "\n" : "", x->ladder, x->at, x->quantity, x->reference);
            fprintf(out, "  %-24s %-18s %-9s%10s%12s%14s\n", "method", "rung", "status", "error", "host_ms",
                    "machine_us");
        }
        ladder = x->ladder;
        print_rung(out, x, n);
    }
    fprintf(out, "\n");
    for (int i = 0; i < r->nchoice; i++) print_choice(out, &r->choice[i]);
}

static void json_pair(struct json *j, const char *key, const char *value)
{
    json_key(j, key);
    json_text(j, value);
}

static void json_number(struct json *j, const char *key, double value)
{
    json_key(j, key);
    json_real(j, value);
}

static void json_rung(struct json *j, const struct accuracy_rung *x)
{
    json_object(j);
    json_pair(j, "at", x->at);
    json_number(j, "error", x->error);
    json_number(j, "host_s", x->host_s);
    json_pair(j, "ladder", x->ladder);
    json_number(j, "machine_s", x->machine_ps >= 0 ? (double)x->machine_ps * 1e-12 : NAN);
    json_pair(j, "method", x->method);
    json_pair(j, "quantity", x->quantity);
    json_pair(j, "reference", x->reference);
    json_pair(j, "rung", x->rung);
    json_pair(j, "status", rung_status_word(x->status));
    json_pair(j, "text", x->text);
    json_end(j);
}

static void json_choice(struct json *j, const struct accuracy_choice *c)
{
    json_object(j);
    json_number(j, "cost_ratio", c->rung ? c->cost_ratio : NAN);
    json_number(j, "error", c->rung ? c->rung->error : NAN);
    json_pair(j, "ladder", c->ladder);
    json_key(j, "method");
    if (c->rung) json_text(j, c->rung->method);
    else json_null(j);
    json_pair(j, "quantity", c->quantity);
    json_key(j, "rung");
    if (c->rung) json_text(j, c->rung->rung);
    else json_null(j);
    json_number(j, "tolerance", c->tolerance);
    json_end(j);
}

void accuracy_print_json(FILE *out, const struct accuracy_report *r)
{
    struct json j = json_make(out);
    json_object(&j);
    json_key(&j, "choices");
    json_array(&j);
    for (int i = 0; i < r->nchoice; i++) json_choice(&j, &r->choice[i]);
    json_end(&j);
    json_key(&j, "rungs");
    json_array(&j);
    for (int i = 0; i < r->nrung; i++) json_rung(&j, &r->rung[i]);
    json_end(&j);
    json_pair(&j, "scenario", r->scenario);
    json_end(&j);
    json_finish(&j);
}

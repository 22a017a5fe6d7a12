/* verify_print.c - reports of verify as tables for people and as JSON for machines. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/json.h"
#include "study/verify.h"

const char *verify_verdict_word(enum verify_verdict v)
{
    static const char *const word[] = {"pass", "rounding", "algorithm-fails", "fail", "not-applicable"};
    return word[v];
}

static void print_heading(FILE *out, const struct verify_report *r)
{
    fprintf(out, "%s: %d bod%s, %d degrees of freedom", r->name, r->nbody, r->nbody == 1 ? "y" : "ies", r->nu);
    if (r->nrow_loop > 0) fprintf(out, ", %d loop constraints", r->nrow_loop);
    fprintf(out, ": %s%s%s\n", r->passed ? "pass" : "FAIL", r->passed ? "" : ": ", r->text);
    if (isfinite(r->floor_fd) || isfinite(r->peer_fd))
        fprintf(out, "  inputs rounded: tau %.1e, qdd %.1e; best library: tau %.1e (%s), qdd %.1e (%s)\n", r->floor_id,
                r->floor_fd, r->peer_id, r->peer_id_name, r->peer_fd, r->peer_fd_name);
}

static void print_row(FILE *out, const struct verify_row *row)
{
    char ranks[48] = "";
    if (row->ranks[0]) snprintf(ranks, sizeof ranks, "P=%s", row->ranks);
    if (row->verdict == VERIFY_NOT_APPLICABLE) {
        fprintf(out, "  %-40s %-16s %-20s %8s %8s  not-applicable: %s\n", row->algorithm, row->quantity, ranks, "-",
                "-", row->note);
        return;
    }
    fprintf(out, "  %-40s %-16s %-20s %8.1e %8.1e  %s%s%s%s%s\n", row->algorithm, row->quantity, ranks, row->error,
            row->tolerance, row->verdict == VERIFY_FAIL ? "FAIL" : verify_verdict_word(row->verdict),
            row->note[0] ? ": " : "", row->note, row->remedy[0] ? "; use " : "", row->remedy);
}

void verify_print(FILE *out, const struct verify_report *r, bool brief)
{
    print_heading(out, r);
    if (!brief)
        fprintf(out, "  %-40s %-16s %-20s %8s %8s  %s\n", "algorithm", "quantity", "ranks", "error", "at most",
                "verdict");
    for (int i = 0; i < r->nrow; i++)
        if (!brief || (r->row[i].verdict != VERIFY_PASS && r->row[i].verdict != VERIFY_NOT_APPLICABLE))
            print_row(out, &r->row[i]);
}

void verify_print_summary(FILE *out, const struct verify_report *r, int n)
{
    int count[VERIFY_VERDICTS] = {0}, failed = 0, rows = 0;
    for (int i = 0; i < n; i++) {
        failed += !r[i].passed;
        rows += r[i].nrow;
        for (int k = 0; k < r[i].nrow; k++) count[r[i].row[k].verdict]++;
    }
    fprintf(out,
            "%d case%s, %d failed; %d rows: %d pass, %d rounding, %d algorithm-fails, %d fail, %d not-applicable\n", n,
            n == 1 ? "" : "s", failed, rows, count[VERIFY_PASS], count[VERIFY_ROUNDING], count[VERIFY_ALGORITHM_FAILS],
            count[VERIFY_FAIL], count[VERIFY_NOT_APPLICABLE]);
}

/* A column of the matrix: rows whose algorithm begins with `algorithm`, in the quantity. */
struct column {
    const char *title, *algorithm, *quantity;
};

static const struct column column_table[] = {
    {"RNEA", "rnea", "tau_id"},
    {"parallel", "parallel inverse", "tau_id"},
    {"ABA", "aba", "qdd_fd"},
    {"CRBA", "crba", "qdd_fd"},
    {"CFA paper", "cfa-paper", "qdd_fd"},
    {"CFA direct", "cfa-direct", "qdd_fd"},
    {"CFA robust", "cfa-robust", "qdd_fd"},
    {"parallel paper", "parallel forward paper", "qdd_fd"},
    {"parallel direct", "parallel forward direct", "qdd_fd"},
    {"parallel refined", "parallel forward refined", "qdd_fd"},
    {"parallel robust", "parallel forward robust", "qdd_fd"},
};
enum { COLUMNS = sizeof column_table / sizeof *column_table };

/* The largest error in the column, "-" when nothing there applies. */
static void print_cell(FILE *out, const struct verify_report *r, const struct column *column)
{
    double largest = -1;
    for (int i = 0; i < r->nrow; i++) {
        const struct verify_row *row = &r->row[i];
        bool here = strncmp(row->algorithm, column->algorithm, strlen(column->algorithm)) == 0 &&
                    strcmp(row->quantity, column->quantity) == 0 && row->verdict != VERIFY_NOT_APPLICABLE;
        if (here) largest = fmax(largest, row->plain);
    }
    if (largest < 0)
        fprintf(out, " - |");
    else
        fprintf(out, " %.0e |", largest);
}

void verify_print_matrix(FILE *out, const struct verify_report *r, int n)
{
    fprintf(out, "| case | bodies |");
    for (int k = 0; k < COLUMNS; k++) fprintf(out, " %s |", column_table[k].title);
    fprintf(out, " best library | verdict |\n|---|--:|");
    for (int k = 0; k < COLUMNS; k++) fprintf(out, "--:|");
    fprintf(out, "--:|---|\n");
    for (int i = 0; i < n; i++) {
        fprintf(out, "| %s | %d |", r[i].name, r[i].nbody);
        for (int k = 0; k < COLUMNS; k++) print_cell(out, &r[i], &column_table[k]);
        if (isfinite(r[i].peer_fd))
            fprintf(out, " %.0e |", r[i].peer_fd);
        else
            fprintf(out, " - |");
        fprintf(out, " %s |\n", r[i].passed ? "pass" : "FAIL");
    }
}

static void key_text(struct json *j, const char *key, const char *s)
{
    json_key(j, key);
    json_text(j, s);
}

static void key_real(struct json *j, const char *key, double x)
{
    json_key(j, key);
    json_real(j, x);
}

static void key_int(struct json *j, const char *key, int x)
{
    json_key(j, key);
    json_int(j, x);
}

/* Keys in alphabetical order, here and below. */
static void json_row(struct json *j, const struct verify_row *row)
{
    bool applies = row->verdict != VERIFY_NOT_APPLICABLE;
    json_object(j);
    key_text(j, "algorithm", row->algorithm);
    key_real(j, "error", applies ? row->error : NAN);
    key_real(j, "error_of_largest", applies ? row->plain : NAN);
    key_text(j, "note", row->note);
    json_key(j, "parallel");
    json_bool(j, row->parallel);
    key_text(j, "quantity", row->quantity);
    key_text(j, "ranks", row->ranks);
    key_text(j, "remedy", row->remedy);
    key_real(j, "tolerance", applies ? row->tolerance : NAN);
    key_text(j, "verdict", verify_verdict_word(row->verdict));
    key_int(j, "worst_rank_count", row->worst_rank);
    json_end(j);
}

static void json_case(struct json *j, const struct verify_report *r)
{
    json_object(j);
    key_int(j, "bodies", r->nbody);
    key_int(j, "degrees_of_freedom", r->nu);
    key_text(j, "file", r->path);
    key_text(j, "group", r->group);
    key_real(j, "input_rounding_qdd", r->floor_fd);
    key_real(j, "input_rounding_tau", r->floor_id);
    key_int(j, "loop_constraints", r->nrow_loop);
    key_text(j, "name", r->name);
    json_key(j, "passed");
    json_bool(j, r->passed);
    key_real(j, "peer_qdd", r->peer_fd);
    key_text(j, "peer_qdd_name", r->peer_fd_name);
    key_real(j, "peer_tau", r->peer_id);
    key_text(j, "peer_tau_name", r->peer_id_name);
    json_key(j, "rows");
    json_array(j);
    for (int i = 0; i < r->nrow; i++) json_row(j, &r->row[i]);
    json_end(j);
    key_text(j, "text", r->text);
    json_end(j);
}

void verify_print_json(FILE *out, const struct verify_report *r, int n)
{
    struct json j = json_make(out);
    int failed = 0;
    for (int i = 0; i < n; i++) failed += !r[i].passed;
    json_object(&j);
    json_key(&j, "cases");
    json_array(&j);
    for (int i = 0; i < n; i++) json_case(&j, &r[i]);
    json_end(&j);
    key_int(&j, "failed", failed);
    key_int(&j, "total", n);
    json_end(&j);
    json_finish(&j);
}

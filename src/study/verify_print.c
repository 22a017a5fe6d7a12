/* verify_print.c - reports of verify as tables for people and as JSON for machines. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/json.h"
#include "measure/column.h"
#include "study/verify.h"

/* In the order of enum verify_verdict. */
static const char *const verdict_word[] = {"pass", "rounding", "algorithm-fails", "fail",
                                           "not-applicable"};

const char *verify_verdict_word(enum verify_verdict v) { return verdict_word[v]; }

#define ROW(member) .offset = offsetof(struct verify_row, member)

/* A row that was left out has no error: the columns are absent, not 0. */
static bool applies(const void *row)
{
    return ((const struct verify_row *)row)->verdict != VERIFY_NOT_APPLICABLE;
}

/* The numbers of ranks as people read them: "P=1,2,3". */
static void read_ranks(const struct column *c, const void *row, struct column_value *v)
{
    const struct verify_row *x = row;
    (void)c;
    snprintf(v->buffer, sizeof v->buffer, "%s%s", x->ranks[0] ? "P=" : "", x->ranks);
    v->kind = VALUE_TEXT;
    v->text = v->buffer;
}

/* The verdict as people read it. FAIL in capitals: a reader looks for it among hundreds of rows. */
static void read_verdict(const struct column *c, const void *row, struct column_value *v)
{
    const enum verify_verdict verdict = ((const struct verify_row *)row)->verdict;
    v->kind = VALUE_TEXT;
    v->text = verdict == VERIFY_FAIL ? "FAIL" : c->word[verdict];
}

/* One row: the JSON keys are for programs, the *_shown columns for the terminal. An error is
 * measured by the scales of the numbers (verify_answers.h), and in the usual way over the
 * largest number. */
static const struct column row_column[] = {
    {"algorithm", COLUMN_CHARS, ROW(algorithm), .title = "algorithm", .before = "  ", .width = -40,
     .doc = "under test"},
    {"quantity", COLUMN_CHARS, ROW(quantity), .title = "quantity", .before = " ", .width = -16,
     .doc = "the field of the reference"},
    {"parallel", COLUMN_BOOL, ROW(parallel), .doc = "whether it runs on several ranks"},
    {"ranks", COLUMN_CHARS, ROW(ranks), .doc = "numbers of ranks that were tried"},
    {"ranks_shown", COLUMN_STRING, .value = read_ranks, .flags = COLUMN_NO_JSON, .title = "ranks",
     .before = " ", .width = -20, .doc = "the same for people"},
    {"worst_rank_count", COLUMN_INT, ROW(worst_rank),
     .doc = "with how many of them the error was largest"},
    {"error", COLUMN_REAL, ROW(error), .known = applies, .title = "error", .before = " ",
     .width = 8, .style = 'e', .digits = 1, .doc = "by the numbers' own scales"},
    {"error_of_largest", COLUMN_REAL, ROW(plain), .known = applies,
     .doc = "over the largest number of the reference"},
    {"tolerance", COLUMN_REAL, ROW(tolerance), .known = applies, .title = "at most", .before = " ",
     .width = 8, .style = 'e', .digits = 1, .doc = "largest error that passes"},
    {"verdict", COLUMN_WORD, ROW(verdict), WORDS(verdict_word), .doc = "what the comparison says"},
    {"verdict_shown", COLUMN_WORD, .value = read_verdict, WORDS(verdict_word),
     .flags = COLUMN_NO_JSON, .title = "verdict", .before = "  ", .doc = "the same for people"},
    {"note", COLUMN_CHARS, ROW(note), .doc = "why"},
    {"remedy", COLUMN_CHARS, ROW(remedy), .doc = "what answers this quantity of this case"},
};
static const struct column_table row_columns = COLUMNS(row_column);

#define CASE(member) .offset = offsetof(struct verify_report, member)

/* The rows of a case as a list inside its object. */
static void write_rows(const struct column *c, const void *row, struct json *j)
{
    const struct verify_report *r = row;
    (void)c;
    columns_json_list(&row_columns, r->row, r->nrow, sizeof *r->row, j);
}

/* One case. input_rounding and peer come from the file: how far one rounding of the inputs moves
 * the answers, and how close the best of other libraries comes. */
static const struct column case_column[] = {
    {"bodies", COLUMN_INT, CASE(nbody), .doc = "of the model"},
    {"degrees_of_freedom", COLUMN_INT, CASE(nu), .doc = "of the model"},
    {"file", COLUMN_STRING, CASE(path), .doc = "with the reference"},
    {"group", COLUMN_STRING, CASE(group), .doc = "what it is counted with"},
    {"input_rounding_qdd", COLUMN_REAL, CASE(floor_fd),
     .doc = "change of accelerations when inputs are rounded"},
    {"input_rounding_tau", COLUMN_REAL, CASE(floor_id),
     .doc = "change of joint forces when inputs are rounded"},
    {"loop_constraints", COLUMN_INT, CASE(nrow_loop), .doc = "of the model"},
    {"name", COLUMN_STRING, CASE(name), .doc = "of the case"},
    {"passed", COLUMN_BOOL, CASE(passed), .doc = "whether no row fails"},
    {"peer_qdd", COLUMN_REAL, CASE(peer_fd), .doc = "error of the best library's accelerations"},
    {"peer_qdd_name", COLUMN_STRING, CASE(peer_fd_name), .doc = "which library"},
    {"peer_tau", COLUMN_REAL, CASE(peer_id), .doc = "error of the best library's joint forces"},
    {"peer_tau_name", COLUMN_STRING, CASE(peer_id_name), .doc = "which library"},
    {"rows", COLUMN_STRING, .json = write_rows, .doc = "one for each algorithm and quantity"},
    {"text", COLUMN_CHARS, CASE(text), .doc = "why it did not pass"},
};
static const struct column_table case_columns = COLUMNS(case_column);

/* Name, size and verdict of a case, and the two yardsticks of its file where it has them. */
static void print_heading(FILE *out, const struct verify_report *r)
{
    fprintf(out, "%s: %d bod%s, %d degrees of freedom", r->name, r->nbody,
            r->nbody == 1 ? "y" : "ies", r->nu);
    if (r->nrow_loop > 0) fprintf(out, ", %d loop constraints", r->nrow_loop);
    fprintf(out, ": %s%s%s\n", r->passed ? "pass" : "FAIL", r->passed ? "" : ": ", r->text);
    /* Either of the two is enough: the other prints as nan. */
    if (isfinite(r->floor_fd) || isfinite(r->peer_fd))
        fprintf(
            out,
            "  inputs rounded: tau %.1e, qdd %.1e; best library: tau %.1e (%s), qdd %.1e (%s)\n",
            r->floor_id, r->floor_fd, r->peer_id, r->peer_id_name, r->peer_fd, r->peer_fd_name);
}

/* The columns, then why and what to use instead. */
static void print_row(FILE *out, const struct verify_row *row)
{
    columns_cells(&row_columns, row, out);
    fprintf(out, "%s%s%s%s\n", row->note[0] ? ": " : "", row->note, row->remedy[0] ? "; use " : "",
            row->remedy);
}

/* brief: only rows that are neither right nor left out. */
void verify_print(FILE *out, const struct verify_report *r, bool brief)
{
    print_heading(out, r);
    if (!brief) columns_title(&row_columns, out);
    for (int i = 0; i < r->nrow; i++)
        if (!brief ||
            (r->row[i].verdict != VERIFY_PASS && r->row[i].verdict != VERIFY_NOT_APPLICABLE))
            print_row(out, &r->row[i]);
}

/* Counts over all cases. rounding and algorithm-fails are excused by another row (verify.c). */
void verify_print_summary(FILE *out, const struct verify_report *r, int n)
{
    int count[VERIFY_VERDICTS] = {0}, failed = 0, rows = 0;
    for (int i = 0; i < n; i++) {
        failed += !r[i].passed;
        rows += r[i].nrow;
        for (int k = 0; k < r[i].nrow; k++) count[r[i].row[k].verdict]++;
    }
    fprintf(out,
            "%d case%s, %d failed; %d rows: %d pass, %d rounding, %d algorithm-fails, %d fail, %d "
            "not-applicable\n",
            n, n == 1 ? "" : "s", failed, rows, count[VERIFY_PASS], count[VERIFY_ROUNDING],
            count[VERIFY_ALGORITHM_FAILS], count[VERIFY_FAIL], count[VERIFY_NOT_APPLICABLE]);
}

/* A column of the matrix: rows whose algorithm begins with `algorithm`, in the quantity. */
struct matrix_column {
    const char *title, *algorithm, *quantity;
};

/* A prefix stands for a family: "parallel forward paper" for that form with every solver. */
static const struct matrix_column column_table[] = {
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
static void print_cell(FILE *out, const struct verify_report *r, const struct matrix_column *column)
{
    /* negative: no row so far */
    double largest = -1;
    for (int i = 0; i < r->nrow; i++) {
        const struct verify_row *row = &r->row[i];
        bool here = strncmp(row->algorithm, column->algorithm, strlen(column->algorithm)) == 0 &&
                    strcmp(row->quantity, column->quantity) == 0 &&
                    row->verdict != VERIFY_NOT_APPLICABLE;
        /* The measure is the usual one, so that the column compares with `best library`. */
        /* An answer that is no number is the worst of all: fmax would pass over it. */
        if (here && !(largest > row->plain) && !isnan(largest)) largest = row->plain;
    }
    if (largest < 0)
        fprintf(out, " - |");
    else
        fprintf(out, " %.0e |", largest);
}

/* The matrix of cases and algorithms, in Markdown: errors over the largest number, as other
 * libraries' errors are quoted. */
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

void verify_print_json(FILE *out, const struct verify_report *r, int n)
{
    struct json j = json_make(out);
    int failed = 0;
    /* The exit status of the verb follows from this number. */
    for (int i = 0; i < n; i++) failed += !r[i].passed;
    json_object(&j);
    json_key(&j, "cases");
    columns_json_list(&case_columns, r, n, sizeof *r, &j);
    json_key_int(&j, "failed", failed);
    json_key_int(&j, "total", n);
    json_end(&j);
    json_finish(&j);
}

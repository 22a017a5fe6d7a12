/* cmd_lab.c - mimdsim lab: lessons to work through; checking attempts. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/flag.h"
#include "app/lab_report.h"
#include "app/verb.h"
#include "lab/lab.h"
#include "measure/column.h"
#include "report/csv.h"

static const char doc[] =
    "Without an argument: list the lessons. With one: copy it into a folder of your own, to work "
    "through.\n\n"
    "Example: mimdsim lab ring\n"
    "\vEach lesson has a text (README.md), a program with a gap, and questions whose answers you "
    "predict in answers.yaml before you run anything.\n\n"
    "mimdsim lab NAME [FOLDER]: makes FOLDER (default: NAME). --variant STUDENT: other numbers for "
    "each name, the same ones every time. --mpi: the program is an ordinary MPI program in C, not "
    "a "
    "kernel in one file.\n\n"
    "mimdsim lab check [FOLDER...]: runs the program in each FOLDER (default: here), and compares "
    "your predictions, what your program did, and the closed form, as whole numbers. What was "
    "simulated is shown once the prediction is right. The exit status is 1 unless all is right.\n\n"
    "mimdsim lab draw [FOLDER]: runs the program and draws the lesson's picture into FOLDER.\n\n"
    "mimdsim lab report [FOLDER]: makes FOLDER/report.html, one page to hand in: predictions and "
    "verdicts, a timeline to explore, what the run would take on other machines, the program, and "
    "what you wrote in notes.md. The exit status is that of check.\n\n"
    "mimdsim lab grade FOLDER..., or --grade FOLDER...: one line for each attempt; with --csv for "
    "spreadsheets.";

/* --- the list --- */

/* Names and titles, as of machines and scenarios. */
static int list_labs(const struct common *c, struct arena *a)
{
    struct err e;
    err_clear(&e);
    const char **name;
    const int n = lab_names(a, &name);
    const char **title = TAKE(a, n + 1, const char *);
    for (int i = 0; i < n; i++) {
        struct lab l;
        struct text t = {0};
        /* A damaged lesson is told at once, not when a student chooses it. */
        if (!lab_read(&l, name[i], "", false, a, &e)) return common_fail(c, &e);
        text_add(&t, "%s (%s minutes)", l.title, l.minutes);
        title[i] = arena_text(a, t.s);
        text_free(&t);
    }
    common_print_pairs(c, n, name, title);
    return 0;
}

/* --- a copy --- */

/* The student's folder, and what to do there. */
static int copy_lab(const struct common *c, const char *student, bool mpi, struct arena *a)
{
    struct err e;
    struct lab l;
    err_clear(&e);
    const char *folder = c->narg > 1 ? c->arg[1] : c->arg[0];
    /* More than one folder is a mistake, not a wish for several copies. */
    if (c->narg > 2) {
        err_set(&e, ERR_USAGE, "lab %s: expected at most one folder", c->arg[0]);
        return common_fail(c, &e);
    }
    if (!lab_read(&l, c->arg[0], student, mpi, a, &e) || !lab_copy(&l, folder, &e))
        return common_fail(c, &e);
    /* The four steps of every lesson. */
    if (!c->quiet)
        printf("%s: %s\nRead %s/README.md, fill in %s/answers.yaml, complete %s/%s, then:\n"
               "    mimdsim lab check %s\n",
               l.name, l.title, folder, folder, folder, l.program, folder);
    return 0;
}

/* --- checking --- */

/* The row of one question. Numbers that are not there are absent. */
#define ANSWER(member) .offset = offsetof(struct lab_answer, member)
static bool was_given(const void *row) { return ((const struct lab_answer *)row)->given; }
static bool is_shown(const void *row) { return ((const struct lab_answer *)row)->shown; }
static const struct column answer_column[] = {
    {"question", COLUMN_STRING, ANSWER(name), .title = "question", .width = -17,
     .doc = "its name in answers.yaml"},
    {"unit", COLUMN_STRING, ANSWER(unit), .title = "unit", .width = -9, .doc = "of the numbers"},
    {"predicted", COLUMN_INT64, ANSWER(predicted), .known = was_given, .title = "predicted",
     .width = 14, .doc = "by the student"},
    {"simulated", COLUMN_INT64, ANSWER(simulated), .known = is_shown, .title = "simulated",
     .width = 14, .doc = "by the student's program; not before the prediction is right"},
    {"verdict", COLUMN_STRING, ANSWER(verdict), .title = "verdict", .before = "  ",
     .doc = "against the closed form"},
};
static const struct column_table answer_columns = COLUMNS(answer_column);

/* An attempt as a line of a teacher's table, or whole in JSON. */
#define RESULT(member) .offset = offsetof(struct lab_result, member)
/* All questions, right or not. */
static void json_answers(const struct column *c, const void *row, struct json *j)
{
    (void)c;
    const struct lab_result *r = row;
    columns_json_list(&answer_columns, r->answer, r->nanswer, sizeof *r->answer, j);
}
static const struct column result_column[] = {
    {"folder", COLUMN_STRING, RESULT(folder), .title = "folder", .width = -24,
     .doc = "of the attempt"},
    {"lab", COLUMN_STRING, RESULT(lab), .title = "lab", .width = -16, .doc = "its name"},
    {"student", COLUMN_STRING, RESULT(student), .title = "student", .width = -16,
     .doc = "the variant"},
    {"right", COLUMN_INT, RESULT(right), .title = "right", .width = 5,
     .doc = "questions that are right"},
    {"questions", COLUMN_INT, RESULT(nanswer), .title = "of", .width = 3,
     .doc = "how many there are"},
    {"program", COLUMN_STRING, RESULT(program), .title = "program", .before = "  ",
     .doc = "ok, or how its run ended"},
    {"answers", COLUMN_STRING, .json = json_answers, .doc = "question by question"},
};
static const struct column_table result_columns = COLUMNS(result_column);

/* One attempt in full. */
static void print_result(const struct lab_result *r)
{
    printf("%s: lab %s%s%s\nprogram: %s\n\n", r->folder, r->lab, r->student[0] ? ", variant " : "",
           r->student, r->program);
    columns_title(&answer_columns, stdout);
    bool hidden = false;
    for (int i = 0; i < r->nanswer; i++) {
        columns_print(&answer_columns, &r->answer[i], stdout);
        hidden = hidden || (r->answer[i].ran && !r->answer[i].shown);
    }
    printf("\n%d of %d right\n", r->right, r->nanswer);
    if (hidden) puts("A simulated number is shown once its prediction is right.");
}

/* One cell of a teacher's spreadsheet. What begins like a formula would be one there, and a name is
 * a student's text: an apostrophe makes it text again. */
static void csv_text(const char *s, bool last)
{
    struct text t = {0};
    text_add(&t, "%s%s", s[0] != '\0' && strchr("=+-@", s[0]) != NULL ? "'" : "", s);
    csv_cell(stdout, t.s, last);
    text_free(&t);
}

/* The same columns as the table of grade. */
static void csv_result(const struct lab_result *r)
{
    char number[2][16];
    snprintf(number[0], sizeof number[0], "%d", r->right);
    snprintf(number[1], sizeof number[1], "%d", r->nanswer);
    csv_text(r->folder, false);
    csv_text(r->lab, false);
    csv_text(r->student, false);
    csv_cell(stdout, number[0], false);
    csv_cell(stdout, number[1], false);
    csv_text(r->program, true);
}

/* How attempts are shown. */
enum form { FORM_WHOLE, FORM_TABLE, FORM_CSV, FORM_JSON };

/* All folders, one after the other; one that cannot be checked does not keep the others from it. */
static int check_all(int n, const char *const *folder, enum form form)
{
    int status = 0;
    struct json j = json_make(stdout);
    /* One document for all attempts, or a table, or one attempt after the other. */
    if (form == FORM_JSON) json_array(&j);
    else if (form == FORM_TABLE) columns_title(&result_columns, stdout);
    else if (form == FORM_CSV) fputs("folder,lab,student,right,questions,program\r\n", stdout);
    for (int i = 0; i < n; i++) {
        struct arena *a = arena_create();
        struct err e;
        struct lab_result r;
        err_clear(&e);
        /* The worst that was found is the exit status; a wrong answer is less than a broken file.
         */
        if (!lab_check(&r, folder[i], a, &e)) {
            if (form == FORM_JSON) common_error_json(&j, folder[i], &e);
            err_print(&e);
            if (status < ERR_USAGE_STATUS) status = err_exit_status(e.kind);
        } else {
            if (form == FORM_JSON) columns_json(&result_columns, &r, &j);
            else if (form == FORM_CSV) csv_result(&r);
            else if (form == FORM_TABLE) columns_print(&result_columns, &r, stdout);
            else print_result(&r);
            if (status == 0 && r.right < r.nanswer) status = 1;
        }
        arena_destroy(a);
    }
    if (form == FORM_JSON) {
        json_end(&j);
        json_finish(&j);
    }
    return status;
}

/* `check` and `grade`, as a word before the folders or as an option. */
static int check_folders(const struct common *c, bool word, bool table, bool csv)
{
    static const char *const here[] = {"."};
    const int n = word ? c->narg - 1 : c->narg;
    const enum form form = c->json ? FORM_JSON : !table ? FORM_WHOLE : csv ? FORM_CSV : FORM_TABLE;
    return n > 0 ? check_all(n, word ? &c->arg[1] : c->arg, form) : check_all(1, here, form);
}

/* The picture of one attempt, and where it is. */
static int draw(const struct common *c, struct arena *a)
{
    struct err e;
    err_clear(&e);
    const char *file;
    int status;
    if (c->narg > 2) err_set(&e, ERR_USAGE, "lab draw: expected at most one folder");
    if (e.kind != ERR_NONE || !lab_draw(c->narg > 1 ? c->arg[1] : ".", &file, &status, a, &e))
        return common_fail(c, &e);
    if (status == 0 && !c->quiet) printf("%s.png\n", file);
    return status;
}

/* The page of one attempt, and where it is. */
static int report(const struct common *c, struct arena *a)
{
    struct err e;
    err_clear(&e);
    /* The status is that of check, so that a script may hand in what is right. */
    const char *path;
    bool right;
    if (c->narg > 2) err_set(&e, ERR_USAGE, "lab report: expected at most one folder");
    if (e.kind != ERR_NONE || !lab_report(c, c->narg > 1 ? c->arg[1] : ".", a, &path, &right, &e))
        return common_fail(c, &e);
    if (!c->quiet) printf("%s\n", path);
    return right ? 0 : err_exit_status(ERR_CHECK);
}

/* A name is written into files of the attempt: one line, no quotes. */
static bool is_student(const char *s, struct err *e)
{
    bool fine = s[0] != '\0' && strlen(s) <= 60;
    for (const char *p = s; fine && *p; p++)
        fine = (unsigned char)*p >= ' ' && *p != '"' && *p != '\\' && *p != 127;
    return fine || err_set(e, ERR_USAGE,
                           "--variant: expected a name of at most 60 letters, without quotes");
}

/* A lesson called "check" would not be reachable: the two words come first. */
int cmd_lab(int argc, char **argv)
{
    struct common c;
    struct err e;
    err_clear(&e);
    /* The option of this verb alone is taken before argp reads the rest. */
    const char *variant = take_value(&argc, argv, "--variant");
    const bool mpi = take_flag(&argc, argv, "--mpi"), csv = take_flag(&argc, argv, "--csv");
    const bool grade = take_flag(&argc, argv, "--grade");
    common_parse(
        &c, argc, argv, 0,
        "[NAME [FOLDER] | check [FOLDER...] | draw [FOLDER] | report [FOLDER] | grade FOLDER...]",
        doc, 0, 64);
    if (variant != NULL && !is_student(variant, &e)) return common_fail(&c, &e);
    if (grade) return check_folders(&c, false, true, csv);
    if (c.narg > 0 && strcmp(c.arg[0], "check") == 0) return check_folders(&c, true, false, csv);
    if (c.narg > 0 && strcmp(c.arg[0], "grade") == 0) return check_folders(&c, true, true, csv);
    /* Everything else is the name of a lesson. */
    struct arena *a = arena_create();
    int status;
    if (c.narg == 0) status = list_labs(&c, a);
    else if (strcmp(c.arg[0], "draw") == 0) status = draw(&c, a);
    else if (strcmp(c.arg[0], "report") == 0) status = report(&c, a);
    else status = copy_lab(&c, variant != NULL ? variant : "", mpi, a);
    arena_destroy(a);
    return status;
}

/* lab_check.c - a student's attempt: the program is run, and three numbers are compared for each
 * question: the prediction, what the run says, and the closed form.
 *
 * All three are whole numbers (picoseconds, messages, bytes, rounds), so that right is equal and no
 * tolerance has to be agreed on. The run is made in a process of its own, by the command that the
 * student would type: a program that crashes takes no teacher's table with it. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/process.h"
#include "io/document.h"
#include "lab/lab.h"
#include "store/store.h"

/* The one value that a query gives, in memory of its own. */
static bool take_value(void *context, int ncolumn, const char *const *name,
                       const char *const *value)
{
    (void)ncolumn, (void)name;
    struct text *t = context;
    t->length = 0;
    if (value[0] != NULL) text_add(t, "%s", value[0]);
    return false;
}

/* A whole number that fits into 64 bits: strtoll gives the nearest one for what does not, which
 * would then be compared as if the student had written it. */
static bool read_whole(const char *text, int64_t *x)
{
    char *end;
    errno = 0;
    *x = strtoll(text, &end, 10);
    return end != text && *end == '\0' && errno == 0;
}

/* An SQL query of one whole number; false with ERR_DATA where it gives none. */
static bool whole_number(struct store *s, const char *sql, int64_t *x, struct err *e)
{
    struct text t = {0};
    bool ok = store_select(s, sql, 0, NULL, take_value, &t, e);
    if (ok && !read_whole(t.length > 0 ? t.s : "", x))
        ok = err_set(e, ERR_DATA, "'%s' gives '%s', not a whole number", sql,
                     t.length > 0 ? t.s : "");
    text_free(&t);
    return ok;
}

/* The closed forms are expressions of whole numbers; SQLite evaluates them exactly in 64 bits. */
static bool evaluate_theory(const struct lab *l, struct lab_result *r, struct err *e)
{
    struct store *s = store_open("theory", STORE_MEMORY, e);
    bool ok = s != NULL;
    for (int i = 0; ok && i < l->nquestion; i++) {
        struct text sql = {0};
        text_add(&sql, "SELECT %s", l->question[i].theory);
        ok = whole_number(s, sql.s, &r->answer[i].theory, e);
        text_free(&sql);
    }
    store_close(s);
    return ok;
}

/* The student's predictions, of which each belongs to a question by its name: their order is free.
 * What is left empty is not answered; what is no number is a mistake that the message shows. */
static bool read_answers(struct lab_result *r, const struct lab *l, const struct node *root,
                         const char *path, struct err *e)
{
    /* A file without the word "answers" was damaged, and would else count as one without any. */
    const struct node *answers = document_need(root, "answers", path, e);
    if (answers == NULL) return false;
    for (const struct node *n = answers->child; n != NULL; n = n->next) {
        int i = 0;
        while (i < l->nquestion && strcmp(l->question[i].name, n->key) != 0) i++;
        if (i == l->nquestion)
            return err_set_at(e, ERR_DATA, path, n->line, "'%s' is no question of this lab",
                              n->key);
        /* "bytes:" with nothing behind it: a question for later. */
        if (n->text == NULL || n->text[0] == '\0') continue;
        if (!read_whole(n->text, &r->answer[i].predicted))
            return err_set_at(e, ERR_DATA, path, n->line,
                              "%s: '%.40s' is not a whole number of at most 18 digits [%s]", n->key,
                              n->text, l->question[i].unit);
        r->answer[i].given = true;
    }
    return true;
}

/* Whether the attempt's scenario is that of the lesson: on another machine the closed forms are
 * wrong, and a machine could be chosen that makes a wrong program right. */
static bool same_scenario(const struct lab *l, const char *folder, enum lab_scenario which,
                          bool *same, struct err *e)
{
    struct text path = {0}, template = {0}, wanted = {0}, found = {0};
    text_add(&path, "%s/%s", l->folder, lab_scenario_file(which));
    bool ok = text_read_file(&template, path.s, e);
    path.length = 0;
    text_add(&path, "%s/%s", folder, lab_scenario_file(which));
    ok = ok && text_read_file(&found, path.s, e);
    if (ok) lab_fill(l, template.s != NULL ? template.s : "", &wanted);
    *same = ok && wanted.length == found.length &&
            (found.length == 0 || memcmp(wanted.s, found.s, found.length) == 0);
    struct text *const mine[] = {&path, &template, &wanted, &found};
    for (int i = 0; i < 4; i++) text_free(mine[i]);
    return ok;
}

/* Run the attempt's scenario in a process of its own, as the student would; its table is not
 * shown, and its messages are collected in *said. */
static bool run_scenario(const char *folder, enum lab_scenario which, const char *database,
                         struct text *said, int *status, struct err *e)
{
    struct text scenario = {0};
    text_add(&scenario, "%s/%s", folder, lab_scenario_file(which));
    const char *const word[] = {"/proc/self/exe", "run",     scenario.s, "-o",
                                database,         "--quiet", "--force",  NULL};
    const bool ok = process_said(word, said, status, e);
    text_free(&scenario);
    return ok;
}

/* Of a program that does not compile, or a scenario that is refused, there is no row. */
static const char not_run[] = "the program could not be run";

/* How the run ended, in a word and its reason. */
static const char *outcome(struct store *s, struct arena *a)
{
    struct err e;
    struct text t = {0};
    err_clear(&e);
    /* Of several runs one that failed is told; where all are well, the word is "ok". The reason of
     * a deadlock begins with that word. */
    static const char sql[] = "SELECT CASE WHEN text LIKE status || ':%' THEN text WHEN text <> '' "
                              "THEN status || ': ' || text ELSE status END "
                              "FROM run ORDER BY status = 'ok', id LIMIT 1";
    const bool ok = store_select(s, sql, 0, NULL, take_value, &t, &e);
    const char *word = arena_text(a, ok && t.length > 0 ? t.s : not_run);
    text_free(&t);
    return word;
}

/* How the runs of measure.yaml ended, told as theirs. */
static const char *measuring_ended(const char *ended, struct arena *a)
{
    struct text t = {0};
    text_add(&t, "measure.yaml: %s", ended);
    const char *kept = arena_text(a, t.s);
    text_free(&t);
    return kept;
}

/* What the run of a scenario says of each of its questions, where it ended without an error. How
 * the first one ended is how the attempt did; of the second one it is told where the first was
 * well. */
static bool look(const struct lab *l, struct lab_result *r, enum lab_scenario which,
                 const char *database, const struct text *said, struct arena *a, struct err *e)
{
    struct err missing;
    err_clear(&missing);
    /* A program that does not compile leaves no database; the compiler's messages tell why. */
    struct store *s = store_open(database, STORE_READ, &missing);
    const char *ended = s != NULL ? outcome(s, a) : not_run;
    /* Where the end of a run stands behind `program:`, its messages say the same, once a run. */
    if (said->length > 0 && (strcmp(ended, "ok") == 0 || strcmp(ended, not_run) == 0))
        fputs(said->s, stderr);
    if (which == LAB_SCENARIO) r->program = ended;
    else if (strcmp(r->program, "ok") == 0 && strcmp(ended, "ok") != 0)
        r->program = measuring_ended(ended, a);
    if (s == NULL) return true;
    bool ok = true;
    /* Of a run that went wrong nothing is asked: its numbers would be taken for answers. A query
     * that gives no whole number is a mistake of the lesson, and is told as such. */
    for (int i = 0; ok && i < l->nquestion && strcmp(ended, "ok") == 0; i++) {
        if (!r->answer[i].asked || l->question[i].scenario != which) continue;
        ok = whole_number(s, l->question[i].simulated, &r->answer[i].simulated, e);
        /* A number that is to be measured is shown to who has written one. */
        r->answer[i].ran = ok && (which == LAB_SCENARIO || r->answer[i].given);
    }
    store_close(s);
    return ok;
}

/* How far a prediction is off, so that the mistake may be found and the number not be read off:
 * the unit that was mistaken, or the order of magnitude of the difference. A percentage would give
 * a small whole number away, and two of them most large ones. */
static const char *difference(const struct lab_answer *x, struct arena *a)
{
    enum { SMALL = 1000 }; /* of such a number even the order of magnitude says too much */
    static const double most[] = {0.1, 1, 10, 50};
    const int nmost = (int)(sizeof most / sizeof most[0]);
    struct text t = {0};
    const char *side = x->predicted < x->theory ? "small" : "large";
    const double ratio = x->theory != 0 ? (double)x->predicted / (double)x->theory : 0;
    bool unit = false;
    /* Nanoseconds for picoseconds, kilobytes for bytes: the commonest mistake has its own words. */
    for (double power = 1e3; power <= 1e12; power *= 1e3)
        unit = unit || ratio == power || ratio * power == 1;
    const double percent = 100 * (ratio > 1 ? ratio - 1 : 1 - ratio);
    int i = 0;
    while (i < nmost && percent >= most[i]) i++;
    text_add(&t, "wrong: too %s", side);
    if (unit) text_add(&t, " by a power of 1000; which unit?");
    else if (llabs(x->theory) >= SMALL)
        text_add(&t, ", by %s than %g %%", i < nmost ? "less" : "more",
                 most[i < nmost ? i : nmost - 1]);
    const char *kept = arena_text(a, t.s);
    text_free(&t);
    return kept;
}

/* The verdict of one question. A prediction is compared with the theory; where the program does
 * something else than the theory says, that is told, too. */
static const char *verdict_of(const struct lab_answer *x, struct arena *a)
{
    if (x->ran && x->simulated != x->theory)
        return x->given && x->predicted == x->theory
                   ? "prediction right; the program does something else"
                   : "the program does something else than the theory";
    if (!x->given) return "no prediction yet";
    if (x->predicted != x->theory) return difference(x, a);
    return x->ran || !x->asked ? "right" : "right, but the program did not end well";
}

/* A simulated number that agrees with the theory is the answer: who has not found it yet does not
 * see it. One that differs is shown, as it tells what the program does. */
static bool may_see(const struct lab_answer *x)
{
    return x->ran && (x->simulated != x->theory || (x->given && x->predicted == x->theory));
}

/* Runs a scenario of the attempt and looks at what came of it. */
static bool run_and_look(const struct lab *l, struct lab_result *r, const char *folder,
                         enum lab_scenario which, struct arena *a, struct err *e)
{
    struct text path = {0}, said = {0};
    int status;
    text_add(&path, "%s/%s", folder, which == LAB_MEASURE ? "measure.db" : "lab.db");
    /* The database of an earlier attempt would answer for this one. */
    unlink(path.s);
    const bool ok = run_scenario(folder, which, path.s, &said, &status, e) &&
                    look(l, r, which, path.s, &said, a, e);
    text_free(&path);
    text_free(&said);
    return ok;
}

/* Every scenario that questions are about, or none where one of them is not the lesson's. */
static bool run_all(const struct lab *l, struct lab_result *r, const char *folder, struct arena *a,
                    struct err *e)
{
    const enum lab_scenario last = l->measures ? LAB_MEASURE : LAB_SCENARIO;
    /* Looked at before anything is run: half of an attempt would be judged by other rules. */
    for (enum lab_scenario s = LAB_SCENARIO; s <= last; s++) {
        bool same;
        if (!same_scenario(l, folder, s, &same, e)) return false;
        if (same) continue;
        r->program = s == LAB_MEASURE
                         ? "not run: measure.yaml is not the lesson's, copy the lesson again"
                         : "not run: scenario.yaml is not the lesson's, copy the lesson again";
        return true;
    }
    for (enum lab_scenario s = LAB_SCENARIO; s <= last; s++)
        if (!run_and_look(l, r, folder, s, a, e)) return false;
    return true;
}

bool lab_attempt(struct lab *l, const char *folder, const struct node **answers, struct arena *a,
                 struct err *e)
{
    struct text path = {0};
    text_add(&path, "%s/answers.yaml", folder);
    const struct node *root = document_read_settings(path.s, a, e);
    text_free(&path);
    if (root == NULL) return false;
    *answers = root;
    return lab_read(l, document_text(root, "lab"), document_text(root, "student"),
                    strstr(document_text(root, "program"), "-mpi.c") != NULL, a, e);
}

bool lab_check(struct lab_result *r, const char *folder, struct arena *a, struct err *e)
{
    struct lab l;
    struct text path = {0};
    const struct node *root;
    *r = (struct lab_result){.folder = arena_text(a, folder), .program = ""};
    if (!lab_attempt(&l, folder, &root, a, e)) return false;
    text_add(&path, "%s/answers.yaml", folder);
    const bool read = read_answers(r, &l, root, path.s, e);
    text_free(&path);
    if (!read) return false;
    /* All questions stand in the result, answered or not. */
    r->lab = l.name;
    r->student = l.student;
    r->nanswer = l.nquestion;
    for (int i = 0; i < l.nquestion; i++) {
        r->answer[i].name = l.question[i].name;
        r->answer[i].unit = l.question[i].unit;
        r->answer[i].asked = l.question[i].simulated[0] != '\0';
    }
    if (!evaluate_theory(&l, r, e) || !run_all(&l, r, folder, a, e)) return false;
    /* Right is what the program and the student both have as the closed form has it. */
    for (int i = 0; i < r->nanswer; i++) {
        r->answer[i].verdict = verdict_of(&r->answer[i], a);
        r->answer[i].shown = may_see(&r->answer[i]);
        r->right += strcmp(r->answer[i].verdict, "right") == 0;
    }
    return true;
}

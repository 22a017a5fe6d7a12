/* lab_check.c - a student's attempt: the program is run, and three numbers are compared for each
 * question: the prediction, what the run says, and the closed form. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "compile/process.h"
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

/* An SQL query of one whole number; false with ERR_DATA where it gives none. */
static bool whole_number(struct store *s, const char *sql, int64_t *x, struct err *e)
{
    struct text t = {0};
    bool ok = store_select(s, sql, 0, NULL, take_value, &t, e);
    char *end = NULL;
    if (ok) *x = t.length > 0 ? strtoll(t.s, &end, 10) : 0;
    if (ok && (end == NULL || *end != '\0'))
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

/* The student's predictions. What is left empty is not answered; what is no number is a mistake
 * that the message shows. */
static bool read_answers(struct lab_result *r, const struct lab *l, const struct node *root,
                         const char *path, struct err *e)
{
    const struct node *answers = document_need(root, "answers", path, e);
    if (answers == NULL) return false;
    for (const struct node *n = answers->child; n != NULL; n = n->next) {
        int i = 0;
        while (i < l->nquestion && strcmp(l->question[i].name, n->key) != 0) i++;
        if (i == l->nquestion)
            return err_set_at(e, ERR_DATA, path, n->line, "'%s' is no question of this lab",
                              n->key);
        if (n->text == NULL || n->text[0] == '\0') continue;
        char *end;
        r->answer[i].predicted = strtoll(n->text, &end, 10);
        if (*end != '\0')
            return err_set_at(e, ERR_DATA, path, n->line,
                              "%s: '%.40s' is not a whole number [%s]", n->key, n->text,
                              l->question[i].unit);
        r->answer[i].given = true;
    }
    return true;
}

/* Run the attempt's scenario in a process of its own, as the student would; its table is not
 * shown, its messages are. */
static bool run_scenario(const char *folder, const char *database, int *status, struct err *e)
{
    struct text scenario = {0}, table = {0};
    text_add(&scenario, "%s/scenario.yaml", folder);
    const char *const word[] = {"/proc/self/exe", "run",    scenario.s, "-o",
                                database,         "--quiet", "--force",  NULL};
    const bool ok = process_run(word, NULL, &table, status, e);
    text_free(&scenario);
    text_free(&table);
    return ok;
}

/* How the run ended, in a word and its reason. */
static const char *outcome(struct store *s, struct arena *a)
{
    struct err e;
    struct text t = {0};
    err_clear(&e);
    static const char sql[] = "SELECT status || CASE WHEN text <> '' THEN ': ' || text ELSE '' END "
                              "FROM run ORDER BY status = 'ok', id LIMIT 1";
    const bool ok = store_select(s, sql, 0, NULL, take_value, &t, &e);
    const char *word = arena_text(a, ok && t.length > 0 ? t.s : "the program could not be run");
    text_free(&t);
    return word;
}

/* What the run says of each question, where it ended without an error. */
static bool look(const struct lab *l, struct lab_result *r, const char *database, struct arena *a,
                 struct err *e)
{
    struct err missing;
    err_clear(&missing);
    struct store *s = store_open(database, STORE_READ, &missing);
    r->program = "the program could not be run";
    if (s == NULL) return true;
    r->program = outcome(s, a);
    bool ok = true;
    for (int i = 0; ok && i < l->nquestion && strcmp(r->program, "ok") == 0; i++) {
        if (!r->answer[i].asked) continue;
        ok = whole_number(s, l->question[i].simulated, &r->answer[i].simulated, e);
        r->answer[i].ran = ok;
    }
    store_close(s);
    return ok;
}

/* The verdict of one question. A prediction is compared with the theory; where the program does
 * something else than the theory says, that is told, too. */
static const char *verdict_of(const struct lab_answer *x)
{
    if (x->ran && x->simulated != x->theory)
        return x->given && x->predicted == x->theory
                   ? "prediction right; the program does something else"
                   : "the program does something else than the theory";
    if (!x->given) return "no prediction yet";
    if (x->predicted != x->theory) return "wrong";
    return x->ran || !x->asked ? "right" : "right, but the program did not end";
}

bool lab_check(struct lab_result *r, const char *folder, struct arena *a, struct err *e)
{
    struct text path = {0};
    *r = (struct lab_result){.folder = arena_text(a, folder), .program = ""};
    text_add(&path, "%s/answers.yaml", folder);
    const char *file = arena_text(a, path.s);
    path.length = 0;
    text_add(&path, "%s/lab.db", folder);
    const char *database = arena_text(a, path.s);
    text_free(&path);
    const struct node *root = document_read_settings(file, a, e);
    if (root == NULL) return false;
    struct lab l;
    r->lab = document_text(root, "lab");
    r->student = document_text(root, "student");
    if (!lab_read(&l, r->lab, r->student, a, e) || !read_answers(r, &l, root, file, e))
        return false;
    r->nanswer = l.nquestion;
    for (int i = 0; i < l.nquestion; i++) {
        r->answer[i].name = l.question[i].name;
        r->answer[i].unit = l.question[i].unit;
        r->answer[i].asked = l.question[i].simulated[0] != '\0';
    }
    /* The database of an earlier attempt would answer for this one. */
    int status;
    unlink(database);
    if (!evaluate_theory(&l, r, e) || !run_scenario(folder, database, &status, e) ||
        !look(&l, r, database, a, e))
        return false;
    for (int i = 0; i < r->nanswer; i++) {
        r->answer[i].verdict = verdict_of(&r->answer[i]);
        r->right += strcmp(r->answer[i].verdict, "right") == 0;
    }
    return true;
}

/* lab.c - reading a lesson and making a student's copy of it. */
#include "lab/lab.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/new_file.h"
#include "io/document.h"
#include "plan/plan.h"

/* FNV-1a, 64 bits (Fowler, Noll, Vo), of a name and of what is chosen by it: the same name has the
 * same numbers on every computer. */
static uint64_t hash(const char *name, const char *what)
{
    uint64_t h = UINT64_C(0xcbf29ce484222325);
    for (const char *s = name; *s; s++) h = (h ^ (unsigned char)*s) * UINT64_C(0x100000001b3);
    h = (h ^ '/') * UINT64_C(0x100000001b3);
    for (const char *s = what; *s; s++) h = (h ^ (unsigned char)*s) * UINT64_C(0x100000001b3);
    return h ^ h >> 32;
}

void lab_fill(const struct lab *l, const char *template, struct text *out)
{
    const char *s = template;
    while (*s != '\0') {
        const size_t plain = strcspn(s, "@");
        text_add_bytes(out, s, plain);
        s += plain;
        if (*s == '\0') break;
        /* Between two marks: a number of the lab, its student, or text as it is. */
        const char *close = strchr(s + 1, '@'), *value = NULL;
        const size_t n = close != NULL ? (size_t)(close - s - 1) : 0;
        for (int i = 0; i < l->nnumber && close != NULL; i++)
            if (strlen(l->number[i].name) == n && memcmp(l->number[i].name, s + 1, n) == 0)
                value = l->number[i].value;
        if (n == 7 && memcmp(s + 1, "student", n) == 0) value = l->student;
        if (value != NULL) text_add(out, "%s", value);
        else text_add_bytes(out, s, 1);
        s += value != NULL ? n + 2 : 1;
    }
}

static const char *filled(const struct lab *l, const char *template, struct arena *a)
{
    struct text t = {0};
    lab_fill(l, template, &t);
    const char *kept = arena_text(a, t.s != NULL ? t.s : "");
    text_free(&t);
    return kept;
}

/* One entry of the list, chosen by the name. */
static bool take_number(struct lab *l, const struct node *list, const char *path, struct err *e)
{
    if (l->nnumber == LAB_NUMBERS || list->kind != NODE_LIST || list->count == 0)
        return err_set_at(e, ERR_DATA, path, list->line, "%s: expected a list of numbers",
                          list->key);
    const uint64_t place =
        l->student[0] != '\0' ? hash(l->student, list->key) % (uint64_t)list->count : 0;
    const struct node *chosen = list->child;
    for (uint64_t i = 0; i < place; i++) chosen = chosen->next;
    l->number[l->nnumber++] = (struct lab_number){list->key, chosen->text};
    return true;
}

static bool take_question(struct lab *l, const struct node *q, const char *path, struct arena *a,
                          struct err *e)
{
    static const char *const wanted[] = {"text", "unit", "theory", "simulated"};
    if (l->nquestion == LAB_QUESTIONS)
        return err_set_at(e, ERR_DATA, path, q->line, "more than %d questions", LAB_QUESTIONS);
    const char *value[4];
    for (int i = 0; i < 4; i++) {
        value[i] = document_text(q, wanted[i]);
        /* A question may be one of theory alone. */
        if (value[i][0] == '\0' && strcmp(wanted[i], "simulated") != 0)
            return err_set_at(e, ERR_DATA, path, q->line, "question '%s' has no '%s'", q->key,
                              wanted[i]);
    }
    l->question[l->nquestion++] = (struct lab_question){.name = q->key,
                                                        .text = filled(l, value[0], a),
                                                        .unit = value[1],
                                                        .theory = filled(l, value[2], a),
                                                        .simulated = filled(l, value[3], a)};
    return true;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

int lab_names(struct arena *a, const char ***name)
{
    enum { MOST = 256 };
    struct text path = {0};
    text_add(&path, "%s/labs", plan_data_dir());
    DIR *folder = opendir(path.s);
    int n = 0;
    *name = TAKE(a, MOST, const char *);
    /* Every folder in it with a lab.yaml; solutions have none. */
    for (struct dirent *d; folder != NULL && n < MOST && (d = readdir(folder)) != NULL;) {
        struct text file = {0};
        text_add(&file, "%s/%s/lab.yaml", path.s, d->d_name);
        if (d->d_name[0] != '.' && access(file.s, R_OK) == 0)
            (*name)[n++] = arena_text(a, d->d_name);
        text_free(&file);
    }
    if (folder != NULL) closedir(folder);
    text_free(&path);
    if (n > 0) qsort(*name, (size_t)n, sizeof **name, by_name);
    return n;
}

/* The nearest lab, for a name that is none. */
static bool no_such_lab(const char *name, struct arena *a, struct err *e)
{
    const char **names;
    const int n = lab_names(a, &names);
    const char *near = text_nearest(name, names, n);
    return err_set(e, ERR_NO_INPUT, "'%.60s' is not a lab%s%s%s; `mimdsim lab` lists them", name,
                   near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "");
}

bool lab_read(struct lab *l, const char *name, const char *student, struct arena *a, struct err *e)
{
    struct text path = {0};
    *l = (struct lab){.name = arena_text(a, name), .student = arena_text(a, student)};
    if (strchr(name, '/') != NULL || name[0] == '.') return no_such_lab(name, a, e);
    text_add(&path, "%s/labs/%s", plan_data_dir(), name);
    l->folder = arena_text(a, path.s);
    text_add(&path, "/lab.yaml");
    const char *file = arena_text(a, path.s);
    text_free(&path);
    if (access(file, R_OK) != 0) return no_such_lab(name, a, e);
    const struct node *root = document_read_settings(file, a, e);
    if (root == NULL) return false;
    l->title = document_text(root, "title");
    l->goal = document_text(root, "goal");
    l->minutes = document_text(root, "minutes");
    /* Numbers first: questions are made of them. */
    const struct node *numbers = document_need(root, "numbers", file, e);
    const struct node *questions = document_need(root, "questions", file, e);
    if (numbers == NULL || questions == NULL) return false;
    for (const struct node *n = numbers->child; n != NULL; n = n->next)
        if (!take_number(l, n, file, e)) return false;
    for (const struct node *q = questions->child; q != NULL; q = q->next)
        if (!take_question(l, q, file, a, e)) return false;
    return true;
}

/* --- the copy --- */

/* answers.yaml: a place for each prediction, under its question. */
static void write_answers(const struct lab *l, struct text *out)
{
    text_add(out,
             "# Predict first: fill in whole numbers, times in picoseconds. Then complete the\n"
             "# program, and let `mimdsim lab check` compare both with the simulation.\n"
             "lab: %s\nstudent: \"%s\"\nanswers:\n",
             l->name, l->student);
    for (int i = 0; i < l->nquestion; i++)
        text_add(out, "  # %s [%s]\n  %s:\n", l->question[i].text, l->question[i].unit,
                 l->question[i].name);
}

/* One file of the lab into the folder. */
static bool copy_file(const struct lab *l, const char *file, const char *folder, struct err *e)
{
    struct text from = {0}, to = {0}, template = {0}, content = {0};
    text_add(&from, "%s/%s", l->folder, file);
    text_add(&to, "%s/%s", folder, file);
    bool fine = text_read_file(&template, from.s, e);
    if (fine) lab_fill(l, template.s != NULL ? template.s : "", &content);
    fine = fine && new_file_write(to.s, &content, e);
    text_free(&from);
    text_free(&to);
    text_free(&template);
    text_free(&content);
    return fine;
}

bool lab_copy(const struct lab *l, const char *folder, struct err *e)
{
    const char *const suffix[] = {"README.md", "scenario.yaml"};
    struct text program = {0}, answers = {0}, path = {0};
    text_add(&program, "%s.c", l->name);
    text_add(&path, "%s/answers.yaml", folder);
    write_answers(l, &answers);
    if (mkdir(folder, 0777) != 0) {
        const bool there = errno == EEXIST;
        err_set(e, ERR_CREATE,
                there ? "%s is there already; name another folder, or move it away" : "%s: %s",
                folder, strerror(errno));
        text_free(&program);
        text_free(&answers);
        text_free(&path);
        return false;
    }
    bool fine = copy_file(l, program.s, folder, e) && new_file_write(path.s, &answers, e);
    for (int i = 0; fine && i < 2; i++) fine = copy_file(l, suffix[i], folder, e);
    /* All or nothing: a student with half of a lesson would not know what is missing. */
    const char *const made[] = {program.s, "answers.yaml", suffix[0], suffix[1]};
    for (int i = 0; !fine && i < 4; i++) {
        path.length = 0;
        text_add(&path, "%s/%s", folder, made[i]);
        unlink(path.s);
    }
    if (!fine) rmdir(folder);
    text_free(&program);
    text_free(&answers);
    text_free(&path);
    return fine;
}

/* lab.c - reading a lesson and making a student's copy of it.
 *
 * Nothing of a lesson is code here: its numbers, its closed forms and what the run is asked are
 * texts of lab.yaml, filled in by the same marks as the files that the student gets. So a new
 * lesson is a folder, and no line of this program. */
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

/* The word between two marks that begin at `s`: "@P@" is P, 1 letter long; NULL: it is none. An
 * address with one @ in it is text, too, unless another mark follows; then its word is unknown. */
static const char *marked(const char *s, size_t *n)
{
    const char *close = strchr(s + 1, '@');
    *n = close != NULL ? (size_t)(close - s - 1) : 0;
    return close != NULL ? s + 1 : NULL;
}

/* Whether a marked word is `wanted`. Words are not ended by NUL: they stand in the template. */
static bool is_word(const char *word, size_t n, const char *wanted)
{
    return strlen(wanted) == n && memcmp(word, wanted, n) == 0;
}

/* What stands for a marked word; NULL: it is text as any other. The mark of the own kind of program
 * is empty: its line stays, and the mark goes. */
static const char *value_of(const struct lab *l, const char *word, size_t n)
{
    for (int i = 0; i < l->nnumber; i++)
        if (is_word(word, n, l->number[i].name)) return l->number[i].value;
    if (is_word(word, n, "student")) return l->student;
    if (is_word(word, n, "program")) return l->program;
    if (is_word(word, n, l->mpi ? "mpi" : "kernel")) return "";
    return NULL;
}

/* The table of predictions: what is asked beside the name under which answers.yaml has it. */
static void add_questions(const struct lab *l, struct text *out)
{
    text_add(out, "| in answers.yaml | question | unit | your formula | your number |\n"
                  "|---|---|---|---|--:|\n");
    for (int i = 0; i < l->nquestion; i++)
        text_add(out, "| %s | %s | %s | | |\n", l->question[i].name, l->question[i].text,
                 l->question[i].unit);
}

void lab_fill(const struct lab *l, const char *template, struct text *out)
{
    const char *s = template;
    while (*s != '\0') {
        const size_t plain = strcspn(s, "@");
        text_add_bytes(out, s, plain);
        s += plain;
        if (*s == '\0') break;
        size_t n;
        const char *word = marked(s, &n), *value = word != NULL ? value_of(l, word, n) : NULL;
        /* A line of the other kind of program goes as a whole. */
        if (word != NULL && is_word(word, n, l->mpi ? "kernel" : "mpi")) {
            s += strcspn(s, "\n");
            s += *s == '\n';
            continue;
        }
        /* In a file of the copy alone: questions are filled in one by one before all are known. */
        if (word != NULL && is_word(word, n, "questions")) {
            add_questions(l, out);
            s += n + 2;
            s += *s == '\n';
            continue;
        }
        if (value != NULL) text_add(out, "%s", value);
        else text_add_bytes(out, s, 1);
        s += value != NULL ? n + 2 : 1;
    }
}

/* Names of files are the same in the lesson and in the attempt. */
const char *lab_scenario_file(enum lab_scenario s)
{
    return s == LAB_MEASURE ? "measure.yaml" : "scenario.yaml";
}

/* A text of lab.yaml with its numbers, kept as long as the lab. */
static const char *filled(const struct lab *l, const char *template, struct arena *a)
{
    struct text t = {0};
    lab_fill(l, template, &t);
    const char *kept = arena_text(a, t.s != NULL ? t.s : "");
    text_free(&t);
    return kept;
}

/* A number that follows from another one, before it in the file: `{of: P, 8: 3, 16: 4}`. */
static bool follow_number(const struct lab *l, const struct node *map, const char *path,
                          const char **value, struct err *e)
{
    const char *of = document_text(map, "of"), *given = NULL;
    for (int i = 0; i < l->nnumber; i++)
        if (strcmp(l->number[i].name, of) == 0) given = l->number[i].value;
    if (given == NULL)
        return err_set_at(e, ERR_DATA, path, map->line, "%s: of '%s', which is no number before it",
                          map->key, of);
    /* A value that is missing would otherwise be found by one student in ten. */
    const struct node *found = document_find(map, given);
    if (found == NULL)
        return err_set_at(e, ERR_DATA, path, map->line, "%s: nothing for %s = %s", map->key, of,
                          given);
    *value = found->text;
    return true;
}

/* One entry of the list, chosen by the name, or the one that follows from another number. */
static bool take_number(struct lab *l, const struct node *list, const char *path, struct err *e)
{
    const char *value = NULL;
    if (l->nnumber == LAB_NUMBERS)
        return err_set_at(e, ERR_DATA, path, list->line, "more than %d numbers", LAB_NUMBERS);
    if (list->kind == NODE_MAP) {
        if (!follow_number(l, list, path, &value, e)) return false;
    } else {
        if (list->kind != NODE_LIST || list->count == 0)
            return err_set_at(e, ERR_DATA, path, list->line, "%s: expected a list of numbers",
                              list->key);
        /* The name of the number is part of it, so that the lists are chosen from independently;
         * who has no name gets the first of each. */
        const uint64_t place =
            l->student[0] != '\0' ? hash(l->student, list->key) % (uint64_t)list->count : 0;
        const struct node *chosen = list->child;
        for (uint64_t i = 0; i < place; i++) chosen = chosen->next;
        value = chosen->text;
    }
    if (value == NULL)
        return err_set_at(e, ERR_DATA, path, list->line, "%s: expected numbers", list->key);
    l->number[l->nnumber++] = (struct lab_number){list->key, value};
    return true;
}

/* A question with its closed form and what the run is asked. Both are SQL, because that is exact in
 * 64 bits, and can look at every row and column that a run has. */
static bool take_question(struct lab *l, const struct node *q, const char *path, struct arena *a,
                          struct err *e)
{
    static const char *const wanted[] = {"text", "unit", "theory", "simulated"};
    const char *run = document_text(q, "run");
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
    /* There is one more scenario and no list of them: lessons stay folders of five files. */
    if (run[0] != '\0' && strcmp(run, "measure") != 0)
        return err_set_at(e, ERR_DATA, path, q->line,
                          "question '%s': run '%.40s': expected measure", q->key, run);
    /* A lesson has the second scenario because a question asks for it, and for no other reason. */
    const enum lab_scenario scenario = run[0] != '\0' ? LAB_MEASURE : LAB_SCENARIO;
    l->measures = l->measures || scenario == LAB_MEASURE;
    l->question[l->nquestion++] = (struct lab_question){.name = q->key,
                                                        .scenario = scenario,
                                                        .text = filled(l, value[0], a),
                                                        .unit = value[1],
                                                        .theory = filled(l, value[2], a),
                                                        .simulated = filled(l, value[3], a)};
    return true;
}

/* The order of the list must not depend on the file system. */
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
    /* Every folder in it with a lab.yaml; solutions have none. Where there is no folder of lessons
     * at all, there are none. */
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

/* The picture: with an x it is a curve, and then y is needed. Kernels and MPI programs may differ
 * in what tells their curves apart, as parameters of the one are arguments of the other. */
static bool take_picture(struct lab *l, const struct node *root, const char *path, struct arena *a,
                         struct err *e)
{
    const struct node *p = document_find(root, "picture");
    const struct node *set = p != NULL ? document_find(p, l->mpi ? "set-mpi" : "set") : NULL;
    /* Where the two kinds do not differ, the lesson says it once. */
    if (p != NULL && set == NULL) set = document_find(p, "set");
    l->picture = (struct lab_picture){.x = document_text(p, "x"),
                                      .y = document_text(p, "y"),
                                      .by = document_text(p, l->mpi ? "by-mpi" : "by")};
    if ((l->picture.x[0] == '\0') != (l->picture.y[0] == '\0'))
        return err_set_at(e, ERR_DATA, path, p->line, "picture: expected x and y");
    for (const struct node *n = set != NULL ? set->child : NULL; n != NULL; n = n->next) {
        if (l->picture.nset == LAB_SETS)
            return err_set_at(e, ERR_DATA, path, n->line, "more than %d settings", LAB_SETS);
        if (n->text == NULL)
            return err_set_at(e, ERR_DATA, path, n->line, "picture: expected KEY=VALUE");
        l->picture.set[l->picture.nset++] = filled(l, n->text, a);
    }
    return true;
}

/* The values of a slider by size. They are numbers with one unit, which is written once in the
 * lesson and stands behind each of them here. */
static int by_size(const void *a, const void *b)
{
    const double x = atof(*(const char *const *)a), y = atof(*(const char *const *)b);
    return (x > y) - (x < y);
}

/* One slider: the values of the lesson and the student's own one, each once, in their order. The
 * own one is the number of the slider's name, or stands there as `own`. */
static bool take_slider(struct lab *l, const struct node *n, const char *path, struct arena *a,
                        struct err *e)
{
    const struct node *values = document_find(n, "values");
    const char *own = document_text(n, "own"), *unit = document_text(n, "unit");
    const char *number[LAB_VALUES];
    /* Students differ in their numbers, so the scale of a slider does as well. */
    if (own[0] == '\0') own = value_of(l, n->key, strlen(n->key));
    if (l->nslider == LAB_SLIDERS || values == NULL || values->count >= LAB_VALUES || own == NULL)
        return err_set_at(e, ERR_DATA, path, n->line,
                          "slider '%s': expected own or a number of that name, fewer than %d "
                          "values, and at most %d sliders",
                          n->key, LAB_VALUES, LAB_SLIDERS);
    struct lab_slider *s = &l->slider[l->nslider++];
    *s = (struct lab_slider){.text = document_text(n, "text"), .key = document_text(n, "key")};
    number[s->nvalue++] = own;
    for (const struct node *v = values->child; v != NULL; v = v->next) {
        if (v->text == NULL)
            return err_set_at(e, ERR_DATA, path, v->line, "slider '%s': expected a list of numbers",
                              n->key);
        if (atof(v->text) != atof(own)) number[s->nvalue++] = v->text;
    }
    /* From small to large, whatever the student's own number is. */
    qsort(number, (size_t)s->nvalue, sizeof *number, by_size);
    for (int i = 0; i < s->nvalue; i++) {
        struct text t = {0};
        text_add(&t, "%s%s%s", number[i], unit[0] ? " " : "", unit);
        s->value[i] = arena_text(a, t.s);
        text_free(&t);
        if (number[i] == own) s->own = i;
    }
    return true;
}

/* At most 8^4; lessons keep it below 200, as each place is a run. */
int lab_points(const struct lab *l)
{
    int n = 1;
    for (int i = 0; i < l->nslider; i++) n *= l->slider[i].nvalue;
    return n;
}

/* The nearest lab, for a name that is none: students type names, and folders are not listed for
 * them. */
static bool no_such_lab(const char *name, struct arena *a, struct err *e)
{
    const char **names;
    const int n = lab_names(a, &names);
    /* A mistyped "check" is looked for among the words that stand in a lab's place, too. */
    static const char *const word[] = {"check", "draw", "report", "grade"};
    struct text_hint hint = text_hint(name, names, n, "");
    if (hint.s[0] == '\0') hint = text_hint(name, word, 4, "");
    return err_set(e, ERR_NO_INPUT, "'%.60s' is not a lab%s; `mimdsim lab` lists them", name,
                   hint.s);
}

bool lab_read(struct lab *l, const char *name, const char *student, bool mpi, struct arena *a,
              struct err *e)
{
    struct text path = {0};
    text_add(&path, "%s%s.c", name, mpi ? "-mpi" : "");
    *l = (struct lab){.name = arena_text(a, name),
                      .student = arena_text(a, student),
                      .program = arena_text(a, path.s),
                      .mpi = mpi};
    /* A name is that of a folder in labs/, and no way to another one: answers.yaml, which comes
     * from a student, names it, too. */
    path.length = 0;
    text_add(&path, "%s/labs/%s", plan_data_dir(), name);
    l->folder = arena_text(a, path.s);
    text_add(&path, "/lab.yaml");
    const char *file = arena_text(a, path.s);
    text_free(&path);
    if (strchr(name, '/') != NULL || name[0] == '.' || access(file, R_OK) != 0)
        return no_such_lab(name, a, e);
    const struct node *root = document_read_settings(file, a, e);
    if (root == NULL) return false;
    l->title = document_text(root, "title");
    l->goal = document_text(root, "goal");
    l->minutes = document_text(root, "minutes");
    /* Numbers first: questions are made of them, and the picture's settings, too. A lesson without
     * numbers would be the same for everybody, and one without questions has nothing to check: both
     * are mistakes of the lesson's author. */
    const struct node *numbers = document_need(root, "numbers", file, e);
    const struct node *questions = document_need(root, "questions", file, e);
    if (numbers == NULL || questions == NULL) return false;
    for (const struct node *n = numbers->child; n != NULL; n = n->next)
        if (!take_number(l, n, file, e)) return false;
    for (const struct node *q = questions->child; q != NULL; q = q->next)
        if (!take_question(l, q, file, a, e)) return false;
    const struct node *sliders = document_find(root, "sliders");
    for (const struct node *s = sliders != NULL ? sliders->child : NULL; s != NULL; s = s->next)
        if (!take_slider(l, s, file, a, e)) return false;
    return take_picture(l, root, file, a, e);
}

/* --- the copy --- */

/* The file in which the student works first, answers.yaml: a place for each prediction, under its
 * question. It also tells whose numbers these are and which program it is about, so that a folder
 * can be moved, renamed and handed in. */
static void write_answers(const struct lab *l, struct text *out)
{
    text_add(out,
             "# Predict first: whole numbers behind colon and space (`messages: 3`), times in ps.\n"
             "# Then complete the program, and let `mimdsim lab check` compare both.\n"
             "lab: %s\nstudent: \"%s\"\nprogram: %s\nanswers:\n",
             l->name, l->student, l->program);
    for (int i = 0; i < l->nquestion; i++)
        text_add(out, "  # %s [%s]\n  %s:\n", l->question[i].text, l->question[i].unit,
                 l->question[i].name);
}

/* One file of the lab into the folder, filled in, under the name that it has there. It must be new:
 * a student's work is never written over. */
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
    const char *const suffix[] = {"README.md", lab_scenario_file(LAB_SCENARIO),
                                  lab_scenario_file(LAB_MEASURE)};
    const int files = l->measures ? 3 : 2;
    struct text answers = {0}, path = {0};
    /* The folder is made here, so that it is empty; one that is there is left as it is. */
    text_add(&path, "%s/answers.yaml", folder);
    write_answers(l, &answers);
    if (mkdir(folder, 0777) != 0) {
        const bool there = errno == EEXIST;
        err_set(e, ERR_CREATE,
                there ? "%s is there already; name another folder, or move it away" : "%s: %s",
                folder, strerror(errno));
        text_free(&answers);
        text_free(&path);
        return false;
    }
    /* The program first: it is what may be missing of a lesson that is being written. */
    bool fine = copy_file(l, l->program, folder, e) && new_file_write(path.s, &answers, e);
    for (int i = 0; fine && i < files; i++) fine = copy_file(l, suffix[i], folder, e);
    /* All or nothing: a student with half of a lesson would not know what is missing, and a second
     * try would find the folder there already. */
    const char *const made[] = {l->program, "answers.yaml", suffix[0], suffix[1], suffix[2]};
    for (int i = 0; !fine && i < 2 + files; i++) {
        path.length = 0;
        text_add(&path, "%s/%s", folder, made[i]);
        unlink(path.s);
    }
    if (!fine) rmdir(folder);
    text_free(&answers);
    text_free(&path);
    return fine;
}

/* lab.h - lessons: a program to complete, numbers to predict, and an exact check of both.
 *
 * A lab is a folder labs/NAME with lab.yaml (title, goal, numbers, questions), README.md, a program
 * NAME.c with a gap, and scenario.yaml. `@NUMBER@` in any of them stands for a number that the
 * student's name chooses from a list, so that neighbours have different ones. An attempt is a copy
 * of that folder with answers.yaml, where the student writes predictions. */
#ifndef LAB_LAB_H
#define LAB_LAB_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"
#include "base/text.h"

enum { LAB_NUMBERS = 16, LAB_QUESTIONS = 16 };

/* What the student's name chose. */
struct lab_number {
    const char *name, *value;
};

/* A question with its numbers filled in. */
struct lab_question {
    const char *name, *text, *unit;
    const char *theory;    /* an SQL expression: the closed form */
    const char *simulated; /* an SQL query of one value: what the student's run says; "": nothing */
};

struct lab {
    const char *name, *folder, *title, *goal, *minutes, *student;
    int nnumber, nquestion;
    struct lab_number number[LAB_NUMBERS];
    struct lab_question question[LAB_QUESTIONS];
};

/* One question of an attempt that was checked. */
struct lab_answer {
    const char *name, *unit;
    bool given; /* the student wrote a prediction */
    int64_t predicted, theory, simulated;
    bool asked; /* the run is asked, too */
    bool ran;   /* `simulated` is there: the program ended without an error */
    const char *verdict;
};

/* An attempt that was checked. */
struct lab_result {
    const char *folder, *lab, *student;
    const char *program; /* "ok", or how the run ended */
    int right, nanswer;
    struct lab_answer answer[LAB_QUESTIONS];
};

/* lab_names: the names of all labs, sorted, in `a`; returns how many (0 where no labs are
 * installed). */
int lab_names(struct arena *a, const char ***name);

/* lab_read: the lab called `name`, with the numbers of `student` ("": the first of each list).
 * Texts lie in `a`. Returns false with ERR_NO_INPUT (no such lab, with the nearest name), ERR_DATA
 * (lab.yaml is damaged). */
bool lab_read(struct lab *l, const char *name, const char *student, struct arena *a, struct err *e);

/* lab_fill: `template` with the lab's numbers in the place of every @NUMBER@, appended to *out. */
void lab_fill(const struct lab *l, const char *template, struct text *out);

/* lab_copy: the student's folder `folder`, which must not exist, with every file filled in and an
 * empty answers.yaml. Returns false with ERR_CREATE or ERR_IO; then nothing of it is left. */
bool lab_copy(const struct lab *l, const char *folder, struct err *e);

/* lab_check: runs the attempt in `folder` and compares predictions, run and theory, as integers.
 * Texts lie in `a`. Returns false with ERR_NO_INPUT or ERR_DATA when answers.yaml cannot be used; a
 * program that fails is a result, not an error. */
bool lab_check(struct lab_result *r, const char *folder, struct arena *a, struct err *e);

#endif

/* lab.h - lessons: a program to complete, numbers to predict, and an exact check of both.
 *
 * A lab is a folder labs/NAME with lab.yaml (title, goal, numbers, questions), README.md, the
 * program with a gap, NAME.c as a kernel and NAME-mpi.c as an ordinary MPI program, and
 * scenario.yaml. Questions with `run: measure` are about the runs of measure.yaml, a second
 * scenario of the same program.
 * `@NUMBER@` in any of them stands for a number that the student's name chooses from a list, so
 * that neighbours have different ones; a number may follow from another (`k: {of: P, 8: 3, 16:
 * 4}`).
 * `@program@` is the file of the program, `@questions@` a table of all questions. Lines that begin
 * with `@kernel@` or `@mpi@` are for attempts of that kind alone. An attempt is a copy of that
 * folder with answers.yaml, where the student writes predictions. */
#ifndef LAB_LAB_H
#define LAB_LAB_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/err.h"
#include "base/text.h"

enum { LAB_NUMBERS = 16, LAB_QUESTIONS = 16, LAB_SETS = 4, LAB_SLIDERS = 4, LAB_VALUES = 8 };

/* What the student's name chose. */
struct lab_number {
    const char *name, *value;
};

/* A question with its numbers filled in. */
struct lab_question {
    const char *name, *text, *unit;
    const char *theory;    /* an SQL expression: the closed form */
    const char *simulated; /* an SQL query of one value: what the student's run says; "": nothing */
    enum lab_scenario { LAB_SCENARIO, LAB_MEASURE } scenario; /* whose run is asked */
};

/* What `mimdsim lab draw` draws: with x a curve of y over x, for each value of `by`, of the
 * scenario's runs with the settings of `set`; else the timeline of the first run. */
struct lab_picture {
    const char *x, *y, *by;
    int nset;
    const char *set[LAB_SETS]; /* "ranks=2,4,8" */
};

/* A setting that the report varies: which values, and the one that the student's scenario has. */
struct lab_slider {
    const char *text, *key;
    int nvalue, own;
    const char *value[LAB_VALUES]; /* with their unit, from small to large */
};

struct lab {
    const char *name, *folder, *title, *goal, *minutes, *student;
    const char *program; /* the file that the student completes */
    bool mpi;            /* it is the MPI program, not the kernel */
    int nnumber, nquestion;
    struct lab_number number[LAB_NUMBERS];
    struct lab_question question[LAB_QUESTIONS];
    struct lab_picture picture;
    int nslider;
    struct lab_slider slider[LAB_SLIDERS];
    bool measures; /* a question is about measure.yaml */
};

/* One question of an attempt that was checked. */
struct lab_answer {
    const char *name, *unit;
    bool given; /* the student wrote a prediction */
    int64_t predicted, theory, simulated;
    bool asked; /* the run is asked, too */
    bool ran;   /* `simulated` is there: the program ended without an error */
    bool shown; /* ... and may be seen: it is not the answer that is still to be found */
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

/* lab_read: the lab called `name`, with the numbers of `student` ("": the first of each list), for
 * a kernel or for an MPI program. Texts lie in `a`. Returns false with ERR_NO_INPUT (no such lab,
 * with the nearest name), ERR_DATA (lab.yaml is damaged). */
bool lab_read(struct lab *l, const char *name, const char *student, bool mpi, struct arena *a,
              struct err *e);

/* lab_scenario_file: "scenario.yaml" or "measure.yaml". */
const char *lab_scenario_file(enum lab_scenario s);

/* lab_fill: `template` with the lab's numbers in the place of every @NUMBER@, and without the lines
 * of the other kind of program, appended to *out. */
void lab_fill(const struct lab *l, const char *template, struct text *out);

/* lab_points: how many places the sliders have together. */
int lab_points(const struct lab *l);

/* lab_copy: the student's folder `folder`, which must not exist, with every file filled in and an
 * empty answers.yaml. Returns false with ERR_CREATE or ERR_IO; then nothing of it is left. */
bool lab_copy(const struct lab *l, const char *folder, struct err *e);

/* lab_check: runs the attempt in `folder` and compares predictions, run and theory, as integers.
 * Texts lie in `a`. Returns false with ERR_NO_INPUT or ERR_DATA when answers.yaml cannot be used; a
 * program that fails is a result, not an error. */
bool lab_check(struct lab_result *r, const char *folder, struct arena *a, struct err *e);

/* lab_attempt: the lab of the attempt in `folder`, with its student's numbers, and in *answers what
 * the student wrote in answers.yaml. Texts lie in `a`. Returns false with ERR_NO_INPUT or ERR_DATA.
 */
struct node;
bool lab_attempt(struct lab *l, const char *folder, const struct node **answers, struct arena *a,
                 struct err *e);

/* lab_draw: runs the attempt in `folder` and draws the lab's picture into the folder, as *file with
 * the endings .png and .svg. *status becomes the exit status of what was started for it: not 0 when
 * the program failed or there is no gnuplot, which has then been told. Returns false as
 * lab_attempt, or when nothing could be started. */
bool lab_draw(const char *folder, const char **file, int *status, struct arena *a, struct err *e);

#endif

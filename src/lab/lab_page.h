/* lab_page.h - the report of an attempt as one HTML file: what was predicted, the runs as a
 * timeline that can be explored, and what they would take on other machines. */
#ifndef LAB_LAB_PAGE_H
#define LAB_LAB_PAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/err.h"
#include "lab/lab.h"
#include "measure/run_result.h"

/* What one run takes, and of what: [0] its makespan, [1 + cause] the time of its critical path that
 * each cause has, all in ps; makespan 0: it cannot be made. */
typedef int64_t lab_shares[1 + PATH_CAUSES];

/* lab_shares_of: of a run with its path. */
void lab_shares_of(const struct run_result *r, lab_shares out);

/* One run of the attempt's scenario, with spans and path. */
struct lab_page_run {
    const char *title;
    const struct run_result *result;
    const lab_shares *point; /* (lab_points) for each place of the sliders, the last one fastest */
};

struct lab_page {
    const struct lab *lab;
    const struct lab_result *check;
    const char *source; /* the student's program */
    const char *notes;  /* what the student wrote in notes.md; NULL: nothing */
    int nrun;           /* 0: the program did not end well */
    const struct lab_page_run *run;
};

enum { LAB_PAGE_SPANS = 20000 };

/* lab_page_write: the page as the file `path`, complete in itself: no other file, no network; the
 * one script in it is ours (plots/lab.js), and the page says so to the browser. Of a run with more
 * than LAB_PAGE_SPANS spans the page has the critical path alone, and says so. Texts of students
 * are escaped. Returns false with ERR_NO_INPUT (plots are missing), ERR_CREATE or ERR_IO. */
bool lab_page_write(const struct lab_page *p, const char *path, struct err *e);

#endif

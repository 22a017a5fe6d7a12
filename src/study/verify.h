/* verify.h - every algorithm held against reference vectors computed by others.
 *
 * A row is one algorithm and one quantity of one case. Its error is the largest difference from the
 * reference, each number by its own scale: how far the exact answer moves when the inputs move by
 * one rounding, in units of that rounding (verify_answers.h). Neither the largest number beside it
 * nor what the file says of other programs excuses an error.
 *
 *   pass             the error is within the tolerance
 *   rounding         it is not, but the same algorithm in quad precision is, and by the tolerance
 * of the row algorithm-fails  quad precision does not mend it; articulated bodies in quad precision
 * confirm the file's answer, and the algorithm is right about the same scene with even masses and
 * inertias. `remedy`: what works fail everything else not-applicable   the note says why
 *
 * A case passes when no row fails and every quantity that was compared has a row that passes. */
#ifndef STUDY_VERIFY_H
#define STUDY_VERIFY_H

#include <stdbool.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/err.h"
#include "spec/kernel_spec.h"
#include "spec/machine_spec.h"

struct verify_options {
    /* everything but accelerations and loop forces; 0: 1e-12, in single precision 1e-4 */
    double tolerance_inverse;
    /* accelerations and loop forces; 0: 1e-10, in single precision 1e-3 */
    double tolerance_forward;
    enum precision precision;  /* of the algorithms under test */
    bool parallel;             /* the parallel kernels too */
    /* that they run on; NULL: a crossbar of as many nodes as there are ranks */
    const struct machine_spec *machine;
    /* large cases too on P = 1, 2, 3, n/2, n, otherwise on 3 and n; and by their mass matrix */
    bool all_ranks;
};

enum verify_verdict {
    VERIFY_PASS,
    VERIFY_ROUNDING,
    VERIFY_ALGORITHM_FAILS,
    VERIFY_FAIL,
    VERIFY_NOT_APPLICABLE,
    VERIFY_VERDICTS
};

struct verify_row {
    char algorithm[48];    /* "rnea", "aba", "forward direct pcr-symmetric" */
    char quantity[24];     /* the field of the reference: "tau_id", "qdd_fd", ... */
    bool parallel;
    char ranks[32];        /* parallel: the numbers of ranks tried, "1,2,3,8,16" */
    int worst_rank;        /* parallel: with how many the error was largest */
    double error;          /* by the numbers' own scales; INFINITY: an answer that is no number */
    /* max |x - ref| / max |ref|, as libraries quote theirs; says nothing of the verdict */
    double plain;
    double quad;           /* rows above the tolerance: the error in quad precision */
    double tolerance;
    enum verify_verdict verdict;
    char note[160];
    char remedy[80];       /* algorithm-fails: what answers this quantity of this case */
};

struct verify_report {
    const char *path, *name, *group;
    int nbody, nu, nrow_loop;
    double floor_id, floor_fd; /* change of the answers when inputs are rounded, NAN: unknown */
    double peer_id, peer_fd;   /* error of the best library, NAN: unknown */
    const char *peer_id_name, *peer_fd_name;
    int nrow, row_room;
    struct verify_row *row;    /* in the arena */
    bool passed;
    char text[160];            /* why it did not pass */
    double host_s;             /* wall time, for progress only */
    struct arena *arena;       /* borrowed */
};

/* verify_file: all applicable algorithms on one reference vector or trajectory.
 *
 *   a    in   memory of the report
 *   r    out  filled when true is returned, r->passed or not
 *
 *   Returns false when the file cannot be used: ERR_NO_INPUT, ERR_IO, ERR_DATA (file and line). */
bool verify_file(const char *path, const struct verify_options *o, struct arena *a,
                 struct verify_report *r, struct err *e);

/* verify_print: one case as a table. `brief` prints the heading and only rows that do not pass. */
void verify_print(FILE *out, const struct verify_report *r, bool brief);

/* verify_print_matrix: one line for each of n reports, as a Markdown table: the largest error of
 * each serial algorithm, of the parallel kernels by formulation (over all solvers and numbers of
 * ranks), and of the best library. */
void verify_print_matrix(FILE *out, const struct verify_report *r, int n);

/* verify_print_summary: the counts over n reports, by verdict. */
void verify_print_summary(FILE *out, const struct verify_report *r, int n);

/* verify_print_json: n reports as one document, keys sorted, numbers that are not finite as
 * null. */
void verify_print_json(FILE *out, const struct verify_report *r, int n);

/* verify_verdict_word: "pass", "rounding", "algorithm-fails", "fail", "not-applicable". */
const char *verify_verdict_word(enum verify_verdict v);

#endif

/* explain_search.h - the smallest change under which a claim, or several together, hold: GSL's
 * simplex over points.
 *
 * A search is a pure function of the points that are known: it is begun anew each round, takes
 * values from the points that were made, and where one is missing it asks for it and waits. So all
 * searches advance side by side on all processors, the outcome depends on the seed alone, and a
 * search that was killed goes on where it was. */
#ifndef APP_EXPLAIN_SEARCH_H
#define APP_EXPLAIN_SEARCH_H

#include "app/explain_points.h"

enum { EXPLAIN_STARTS = 6, EXPLAIN_BASELINES = 6 };

/* explain_baseline: the i-th serial baseline that a speedup may be meant against (i <
 * EXPLAIN_BASELINES). Inverse dynamics alone is none: it answers half of the question. */
const char *explain_baseline(int i);

/* explain_variant: the variant of a claim with this baseline and these operators, appended: its
 * designated variant with both exchanged where it names them. baseline NULL: its own. */
void explain_variant(const struct claim_rule *rule, const char *baseline, enum operators operators,
                     struct text *out);

/* explain_own: whether these operators are those of the claim's designated variant; true where it
 * names none. */
bool explain_own_operators(const struct claim_rule *rule, enum operators operators);

/* explain_baseline_of: the baseline that the designated variant names, NULL when it names none. */
const char *explain_baseline_of(const struct claim_rule *rule);

/* What is looked for. */
struct explain_goal {
    struct explain_subject *subject;
    enum operators operators;
    bool own; /* the claims' designated variants alone; otherwise with any baseline */
    uint64_t seed;
    bool dear;  /* the last start moves along the dear axes, too */
    int starts; /* of the simplex, <= EXPLAIN_STARTS */
    int steps;  /* of each simplex at most */
    int nfrom;  /* starts that are given; then come half-way to where each axis alone is best,
                   nothing changed, and  points that are drawn */
    double from[EXPLAIN_STARTS][EXPLAIN_MOST_AXES];
};

/* A point as a goal sees it. */
struct explain_grade {
    bool holds;
    double margin;        /* of the worst claim; NaN: not told */
    double distance;      /* with ln 2 for each choice that is not the claims' own */
    double value;         /* of the worst claim */
    int rule;             /* the worst */
    const char *baseline; /* NULL: own or none */
};

/* explain_grade_point: the point for the goal, with the best baseline. */
struct explain_grade explain_grade_point(const struct explain_goal *g,
                                         const struct explain_point *p, const double *u);

/* explain_better: whether a is the better answer: it holds with the smaller change, or is nearer to
 * holding. */
bool explain_better(const struct explain_grade *a, const struct explain_grade *b);

/* The best of many points; `any` false: none was looked at. */
struct explain_best {
    bool any;
    double u[EXPLAIN_MOST_AXES];
    struct explain_grade grade;
};

/* One search with what of it is finished. Start from {.goal = ...}. */
struct explain_search {
    struct explain_goal goal;
    bool scanned, done;
    /* starts whose simplex has come to its end; the last is the answer so far */
    bool ended[EXPLAIN_STARTS + 1];
    bool beside;                       /* the dear axes have been tried beside the best of these */
    int begun, polished;               /* times that changes have been taken back */
    struct explain_best single;        /* the smallest change of one axis alone */
    double nominal;                    /* margin where nothing is changed */
    /* how much an axis alone adds to it at the better of its ends, >= 0 */
    double gain[EXPLAIN_MOST_AXES];
    double swing[EXPLAIN_MOST_AXES];   /* how much it changes it at most */
    double end[EXPLAIN_MOST_AXES];     /* that better end, 0 where neither is better */
    struct explain_best best;          /* of all */
    /* the best when the dear axes were tried, and changes were taken back */
    double from[3][EXPLAIN_MOST_AXES];
};

/* explain_search_all: run n searches to their ends, making the points they ask for. */
bool explain_search_all(struct explain_bench *b, struct explain_search *search, int n);

#endif

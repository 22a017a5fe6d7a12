/* explain_points.h - points of the space of unstated parameters: run, judged by the claims' own
 * queries, kept.
 *
 * A point of a subject (one claim, or several together) is judged by the runs that the claims' "--
 * explore:" lines name, with the point's settings, in a passing database. Points are stored as they
 * are made and never made twice. */
#ifndef APP_EXPLAIN_POINTS_H
#define APP_EXPLAIN_POINTS_H

#include "app/explain_space.h"
#include "app/verb.h"
#include "report/claims.h"
#include "run/run.h"
#include "store/store.h"

enum { EXPLAIN_MOST_RULES = 32 };

/* What one variant of one claim came to at a point. */
struct explain_verdict {
    int rule; /* of the subject's */
    const char *variant;
    double value, margin; /* NaN: not told */
    bool holds, told;
};

struct explain_point {
    int64_t id; /* in table explain_point */
    uint64_t key;
    enum operators operators;
    double u[EXPLAIN_MOST_AXES];
    int nverdict;
    struct explain_verdict *verdict;
};

/* A set of runs with a choice of operators in which every run of a point is found. */
struct explain_subject {
    const char *name; /* "C2", "together" */
    int nrule;
    const struct claim_rule *rule[EXPLAIN_MOST_RULES];
    struct explain_space space;
    int nspec;
    struct run_spec *spec; /* (nspec) at the nominal point */
    bool has[2];           /* whether there are runs with structured, with dense operators */
    char identity[65];     /* of runs and claims: points of another one are worth nothing */
    bool warm; /* the bench's cache has what its runs share */
    int npoint, capacity;
    struct explain_point **slot; /* (capacity) open addressing by key */
};

struct explain_request {
    struct explain_subject *subject;
    enum operators operators;
    double u[EXPLAIN_MOST_AXES]; /* snapped */
};

/* What the functions below share. */
struct explain_bench {
    const struct common *common;
    struct store *store;
    struct store *passing; /* the runs of one point at a time, NULL until the first */
    struct arena *arena; /* of all subjects and points */
    struct err *e;
    struct run_cache *cache; /* what runs of all points share, owned by who makes the bench */
    int64_t last_id; /* of a stored point */
    int made;        /* points that were run by this program */
};

/* explain_subject_make: a subject of these rules: their runs read from the scenarios, points that
 * are stored already taken from the database, those of another identity removed from it. Returns
 * false with ERR_DATA (no "-- explore:" line; runs of several machines) or as plan_read. */
bool explain_subject_make(struct explain_subject *s, struct explain_bench *b, const char *name,
                          const struct claim_rule *const *rule, int nrule);

/* explain_machine: the machine of the first scenario that a rule explores. Returns false as
 * plan_read. */
bool explain_machine(struct explain_bench *b, const struct claim_rule *rule, char machine[64]);

/* explain_known: the point of a request, NULL when it has not been made. */
const struct explain_point *explain_known(const struct explain_subject *s, enum operators operators,
                                          const double *u);

/* explain_make: make all n points, on worker processes; the outcome does not depend on how many.
 * Points made before a failure stay. */
bool explain_make(struct explain_bench *b, const struct explain_request *request, int n);

/* explain_confirm: judge the subject's rules at a point by the runs of the study's own scenarios;
 * *nrun of them were made. The verdicts are in b->arena. */
bool explain_confirm(struct explain_bench *b, struct explain_subject *s, enum operators operators,
                     const double *u, struct explain_point *out, int *nrun);

#endif

/* verb.h - the verbs of the command line: one file each, one table. */
#ifndef APP_VERB_H
#define APP_VERB_H

#include <argp.h>
#include <stdbool.h>
#include <stdio.h>

#include "app/verb_list.h"
#include "base/err.h"
#include "base/json.h"
#include "plan/plan.h"
#include "run/catalogue.h"

struct verb {
    const char *name;
    const char *title;                 /* one line for `mimdsim --help` */
    int (*run)(int argc, char **argv); /* argv[0] is "mimdsim VERB"; returns the exit status */
};

/* verb_list: all verbs, ended by a NULL name. */
extern const struct verb verb_list[];

/* The verbs. Each reads its command line (argv[0] is "mimdsim VERB") and returns the exit
 * status. */
#define X(function, word, title) int function(int argc, char **argv);
VERB_LIST(X)
#undef X

enum { COMMON_MOST_SETS = 256, COMMON_MOST_ARGUMENTS = 64 };

/* What most verbs take: --machine, --set, --json, --quiet, -o, --force, --jobs. */
struct common {
    const char *verb; /* "mimdsim VERB" */
    const char *machine;
    const char *name;      /* --name, NULL: made from what differs */
    const char *set[COMMON_MOST_SETS]; /* (nset) */
    int nset;
    bool json, quiet, force;
    const char *database;  /* -o */
    bool database_given;   /* -o was there */
    const char *directory; /* --dir */
    const char *level;     /* --level, NULL: all */
    const char *format;    /* --format, NULL: the usual ones */
    bool brief, compare;
    bool allow_programs;   /* --allow-programs */
    const char *only;      /* --only, NULL: all points */
    int jobs;              /* 0: as many as processors */
    struct catalogue kernel; /* the kernels there are */
    int narg;
    const char *arg[COMMON_MOST_ARGUMENTS]; /* what is not an option */
};

/* Which of the common options a verb takes. */
enum {
    TAKES_PLAN = 1,
    TAKES_STORE = 2,
    TAKES_DIR = 4,
    TAKES_JOBS = 8,
    TAKES_LEVEL = 16,
    TAKES_COMPARE = 32,
    TAKES_FORMAT = 64
};

/* common_parse: read the command line of a verb.
 *
 *   takes       in  which options it has, TAKES_*; --json, --quiet and --help always
 *   args, doc   in  for --help: the arguments, and what the verb does, with an example first
 *   least,most  in  how many arguments; outside: message and exit status 64
 *
 * Ends the process on a wrong option (64; with --json, with a document) and after --help (0). */
void common_parse(struct common *c, int argc, char **argv, unsigned takes, const char *args,
                  const char *doc, int least, int most);

/* common_plan: the plan options among them, and the names of the kernels; borrowed from *c. */
struct plan_options common_plan(const struct common *c);

/* common_print_pairs: n names with their titles, as lines or as a JSON array of {name, title}. */
void common_print_pairs(const struct common *c, int n, const char *const *name,
                        const char *const *title);

/* common_fail: print *e (as JSON on stdout with --json, always on stderr) and return its exit
 * status. */
int common_fail(const struct common *c, const struct err *e);

/* common_error_json: the object {exit_status, file, kind, line, text} of an error; of none, kind
 * ERR_NONE. */
void common_error_json(struct json *j, const char *file, const struct err *e);

/* common_wants_json: whether --json stands among the options. */
bool common_wants_json(int argc, char **argv);

#endif

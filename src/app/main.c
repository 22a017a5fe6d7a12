/* main.c - choose the verb.
 *
 * `mimdsim VERB ...`: the table of verbs is the whole interface; each verb reads the rest of the
 * command line by itself and returns the exit status. */
#include "config.h"

#include <argp.h>
#include <gsl/gsl_errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "app/verb.h"
#include "base/escape.h"
#include "base/gsl_errors.h"
#include "base/large_pages.h"
#include "base/text.h"
#include "run/catalogue.h"
#include "store/build.h"

enum { MOST_VERBS = 64 }; /* candidates for the nearest name */

/* Verbs and their titles come from the list of verbs. */
static void print_help(FILE *out)
{
    fprintf(
        out,
        "Usage: mimdsim VERB [OPTION...] [ARGUMENT...]\n"
        "Predict how a parallel algorithm will run on a machine you do not have.\n\n"
        "  mimdsim run scenarios/speedup-t3e.yaml     run a scenario, store it, print the "
        "table\n  mimdsim plot mimdsim.db fig6               draw a figure from the database\n\n");
    for (const struct verb *v = verb_list; v->name; v++)
        fprintf(out, "  %-12s %s\n", v->name, v->title);
    fprintf(
        out,
        "\n'mimdsim VERB --help' describes a verb, with an example. Exit statuses: mimdsim(1).\n");
}

/* Everything that a result may depend on beside the settings: version, commit, compiler, flags. */
static void print_version(void)
{
    struct build b = store_build();
#ifdef SANITIZERS
    static const char sanitizers[] = "; with sanitizers";
#else
    static const char sanitizers[] = "";
#endif
    printf("mimdsim %s (%s)\nbuilt by %s %s; fibers by %s%s\n", b.version, b.git, b.compiler,
           b.flags, run_fibers(), sanitizers);
}

/* The nearest verb; options of the program itself are candidates, too. */
static int unknown_verb(int argc, char **argv)
{
    const char *word = argv[1];
    const struct common c = {.json = common_wants_json(argc, argv)};
    const char *name[MOST_VERBS] = {"--help", "--version"};
    int n = 2;
    for (const struct verb *v = verb_list; v->name; v++) name[n++] = v->name;
    struct err e;
    err_clear(&e);
    err_set(&e, ERR_USAGE, "'%s' is not a verb%s; 'mimdsim --help' lists them", word,
            text_hint(word, name, n, "").s);
    return common_fail(&c, &e);
}

/* An answer that could not be written is none, whatever the verb found: a full disk or a closed
 * pipe must not end with status 0. */
static int finish(int status)
{
    if (fflush(stdout) == 0 && !ferror(stdout)) return status;
    struct err e;
    err_clear(&e);
    err_set(&e, ERR_IO, "the output cannot be written");
    if (status == 0) err_print(&e);
    return status ? status : err_exit_status(ERR_IO);
}

/* Their command lines are gcc's, where -h is the name of a shared library. */
static bool takes_compiler_options(const struct verb *v)
{
    return v->run == cmd_cc || v->run == cmd_cxx || v->run == cmd_f90;
}

/* argp prints argv[0] in messages: "mimdsim run". "-h" is no option of argp's. */
static int run_verb(const struct verb *v, int argc, char **argv)
{
    static const char prefix[] = "mimdsim ";
    char name[sizeof prefix + 32], help[] = "--help";
    snprintf(name, sizeof name, "%s%s", prefix, v->name);
    argv[0] = name;
    large_pages_for_heap();
    for (int i = 1; !takes_compiler_options(v) && i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], "-h") == 0) argv[i] = help;
    return finish(v->run(argc, argv));
}

/* The verb whose command this is when it was started as mimdsim-cc, mimdsim-c++ or mimdsim-f90,
 * links to this program for build systems that take one word as a compiler; NULL: started as
 * itself. */
static const struct verb *verb_of_name(const char *program)
{
    static const char prefix[] = "mimdsim-";
    const char *slash = strrchr(program, '/'), *name = slash != NULL ? slash + 1 : program;
    if (strncmp(name, prefix, sizeof prefix - 1) != 0) return NULL;
    for (const struct verb *v = verb_list; v->name; v++)
        if (takes_compiler_options(v) && strcmp(name + sizeof prefix - 1, v->name) == 0) return v;
    return NULL;
}

/* Help, version, or a verb. */
int main(int argc, char **argv)
{
    char help_word[] = "--help";
    escape_terminal();
    /* A limit on the size of files is an error of a write, told as such, and not the end. */
    signal(SIGXFSZ, SIG_IGN);
    /* What calls GSL looks at its status. */
    gsl_set_error_handler(gsl_errors_returned);
    /* argp's own errors end with the status for wrong usage. */
    argp_err_exit_status = err_exit_status(ERR_USAGE);
    const struct verb *named = argc > 0 ? verb_of_name(argv[0]) : NULL;
    if (named != NULL) return run_verb(named, argc, argv);
    /* Nothing was asked for: help, but as an error. */
    if (argc < 2) {
        print_help(stderr);
        return err_exit_status(ERR_USAGE);
    }
    bool help = strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 ||
                strcmp(argv[1], "help") == 0;
    if (help && argc < 3) { /* not of a verb */
        print_help(stdout);
        return finish(0);
    }
    if (help) { /* "help VERB" is "VERB --help" */
        argv[1] = argv[2];
        argv[2] = help_word;
        argc = 3;
    }
    if (strcmp(argv[1], "--version") == 0) {
        print_version();
        return finish(0);
    }
    for (const struct verb *v = verb_list; v->name; v++)
        if (strcmp(argv[1], v->name) == 0) return run_verb(v, argc - 1, argv + 1);
    return unknown_verb(argc, argv);
}

/* common.c - the options that verbs share, by argp.
 *
 * An option has one meaning in all verbs that take it. A verb says which groups it takes
 * (TAKES_*); the others do not exist for it, neither in --help nor on the command line. With
 * --json a failure is a document, too, so that a program reads one form. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "app/own_option_list.h"
#include "app/programs.h"
#include "app/verb.h"
#include "base/check.h"
#include "base/json.h"
#include "run/run.h"

/* Keys of long options without a letter. */
enum {
    KEY_JSON = 0x100,
    KEY_LEVEL,
    KEY_BRIEF,
    KEY_COMPARE,
    KEY_FORCE,
    KEY_DIR,
    KEY_FORMAT,
    KEY_ALLOW,
    KEY_NAME,
    KEY_ONLY,
    KEY_OWN
};

/* The last number is the group: it orders --help and decides which verbs have the option. */
static const struct argp_option option_table[] = {
    {"machine", 'm', "NAME", 0, "machine to use instead of the scenario's (a name or a file)", 1},
    {"set", 's', "KEY=VALUE", 0,
     "override one value, e.g. machine.network.link.bandwidth=\"960 MB/s\"; "
     "several values, as in n=16,32, are a sweep; may be repeated", 1},
    {"name", KEY_NAME, "TEXT", 0,
     "what these runs are called in tables and figures (default: the machine with what was changed "
     "of it)", 1},
    {"only", KEY_ONLY, "CONDITION", 0,
     "only the points that satisfy it, e.g. \"n >= 64 and level == link\"", 1},
    {"allow-programs", KEY_ALLOW, NULL, 0,
     "run also programs that the scenario names outside its own folder: they run with all your "
     "rights", 1},
    {"output", 'o', "DB", 0, "database (default mimdsim.db; for paper: paper.db)", 2},
    {"force", KEY_FORCE, NULL, 0, "repeat runs that are already stored", 2},
    {"dir", KEY_DIR, "DIR", 0, "folder for figures (default figures)", 3},
    {"jobs", 'j', "N", 0, "number of worker processes (default: one per processor)", 4},
    {"level", KEY_LEVEL, "LEVEL", 0, "only this level: loggp, link, packet, flit or auto", 6},
    {"brief", KEY_BRIEF, NULL, 0, "statistics only", 6},
    {"compare", KEY_COMPARE, NULL, 0, "show the differences between two machines", 7},
    {"format", KEY_FORMAT, "FORMAT", 0, 
     "write only picture, text, chrome, paje, csv or goal (default: all but csv and goal)", 8},
    {"json", KEY_JSON, NULL, 0, "write one JSON document to standard output", 5},
    {"quiet", 'q', NULL, 0, "no progress and no remarks on standard error", 5},
    {0},
};

/* Options of single verbs, which these take out of their arguments themselves: here for --help. */
static const struct own_option {
    const char *verb;
    struct argp_option option;
} own_table[] = {
#define X(verb, name, value, text) {verb, {name, KEY_OWN, value, 0, text, 9}},
    OWN_OPTION_LIST(X)
#undef X
};
enum {
    MOST_OPTIONS = sizeof option_table / sizeof *option_table + sizeof own_table / sizeof *own_table
};

/* Groups 0 and 5 belong to every verb. */
static unsigned group_of(int group)
{
    static const unsigned takes[] = {0, TAKES_PLAN,  TAKES_STORE,   TAKES_DIR,   TAKES_JOBS,
                                     0, TAKES_LEVEL, TAKES_COMPARE, TAKES_FORMAT};
    return takes[group];
}

/* What argp's parser needs: least and most arguments. */
struct parse {
    struct common *common;
    int least, most; /* arguments that are not options */
    const char *words; /* what they are, as --help shows it; alternatives on lines of their own */
    struct err error; /* what was wrong, for the document */
};

/* Say what is wrong with the command line. argp_error ends the process, unless a document is
 * wanted first: then the error is kept for it. */
static error_t refuse(struct argp_state *state, const char *format, const char *arg)
{
    struct parse *p = state->input;
    char text[512];
    snprintf(text, sizeof text, format, arg);
    err_set(&p->error, ERR_USAGE, "%s", text);
    argp_error(state, "%s", text);
    return EINVAL;
}

/* Who has typed the verb alone is told what it takes: the next thing to type, without a look at the
 * manual. Alternatives stand on lines of their own in --help, and with commas here. */
static error_t refuse_few(struct argp_state *state, const char *words)
{
    char one[256];
    size_t n = 0;
    for (; words != NULL && words[n] != '\0' && n < sizeof one - 1; n++)
        one[n] = words[n] == '\n' ? ',' : words[n];
    one[n] = '\0';
    return refuse(state, n > 0 ? "an argument is missing; expected %s" : "an argument is missing%s",
                  one);
}

/* Values are only collected: their keys are checked when the plan is read, with file and line. */
static void add_set(struct common *c, const char *text, struct argp_state *state)
{
    if (c->nset == COMMON_MOST_SETS)
        argp_error(state, "more than %d times --set", COMMON_MOST_SETS);
    c->set[c->nset++] = text;
}

/* More workers than 256 would be a typing mistake. */
static error_t set_jobs(struct common *c, const char *arg, struct argp_state *state)
{
    char *end;
    long n = strtol(arg, &end, 10);
    if (*end || end == arg || n < 1 || n > 256)
        return refuse(state, "--jobs: '%s' is not a number from 1 to 256", arg);
    c->jobs = (int)n;
    return 0;
}

/* A name must say something, of a run as of a file. */
static error_t set_name(const char **place, const char *arg, const char *format,
                        struct argp_state *state)
{
    *place = arg;
    return arg[0] ? 0 : refuse(state, format, arg);
}

/* Where an option whose value is kept as it is has its place; NULL: it is none of these. */
static const char **place_of(struct common *c, int key)
{
    switch (key) {
    case 'm': return &c->machine;
    case KEY_ONLY: return &c->only;
    case KEY_DIR: return &c->directory;
    case KEY_LEVEL: return &c->level;
    case KEY_FORMAT: return &c->format;
    default: return NULL;
    }
}

/* Called by argp for each option and argument, and at the end. */
static error_t parse_option(int key, char *arg, struct argp_state *state)
{
    struct parse *p = state->input;
    struct common *c = p->common;
    const char **place = place_of(c, key);
    if (place != NULL) return *place = arg, 0;
    /* Each option is a field of struct common; what it means is the verb's matter. */
    switch (key) {
    case 's':
        add_set(c, arg, state);
        break;
    case 'o':
        /* Whether it was given decides the default of `paper`. */
        c->database_given = true;
        return set_name(&c->database, arg, "--output: '%s' is not the name of a file", state);
    case 'q':
        c->quiet = true;
        break;
    case 'j':
        return set_jobs(c, arg, state);
    case KEY_NAME:
        return set_name(&c->name, arg, "--name: '%s' is no name", state);
    case KEY_ALLOW:
        c->allow_programs = true;
        break;
    case KEY_FORCE:
        c->force = true;
        break;
    case KEY_BRIEF:
        c->brief = true;
        break;
    case KEY_COMPARE:
        c->compare = true;
        break;
    case KEY_JSON:
        c->json = true;
        break;
    case ARGP_KEY_ARG:
        if (c->narg >= p->most || c->narg >= COMMON_MOST_ARGUMENTS)
            return refuse(state, c->narg < COMMON_MOST_ARGUMENTS
                                     ? "unexpected argument '%s'"
                                     : "argument '%s' is one too many: 64 are taken",
                          arg);
        c->arg[c->narg++] = arg;
        break;
    case ARGP_KEY_END: /* all words have been seen */
        return c->narg < p->least ? refuse_few(state, p->words) : 0;
    case KEY_OWN:
        /* A verb has taken out its own options by their whole names: this was the beginning of
         * one. */
        /* As if it were unknown: to guess here and not there would be worse. */
        return refuse(state, "write the option in full%s", "");
    default:
        /* argp's own keys: initialisation, errors */
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

/* Keys of the failure of one file, in the order of the alphabet; also used by `check` for files
 * in order. */
void common_error_json(struct json *j, const char *file, const struct err *e)
{
    json_object(j);
    json_key_int(j, "exit_status", err_exit_status(e->kind));
    json_key_text(j, "file", file);
    json_key_text(j, "kind", err_word(e->kind));
    json_key_int(j, "line", e->line);
    json_key_text(j, "text", e->kind == ERR_NONE ? "" : e->text);
    json_end(j);
}

/* The document of a failure: {"error": {...}}. */
static void print_error(const struct err *e)
{
    struct json j = json_make(stdout);
    json_object(&j);
    json_key(&j, "error");
    common_error_json(&j, e->file, e);
    json_end(&j);
    json_finish(&j);
}

/* The first word of the command line that looks like a long option and is none, NULL: all are.
 * The value of an option is skipped, so that it may begin with hyphens. */
static const char *unknown_option(int argc, char **argv, const struct argp_option *option)
{
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++) {
        if (strncmp(argv[i], "--", 2) != 0) continue;
        size_t length = strcspn(argv[i] + 2, "=");
        const struct argp_option *o = option;
        /* argp accepts the beginning of a name, so this does, too. */
        while (o->name && strncmp(o->name, argv[i] + 2, length) != 0)
            o++; /* the beginning of a name will do */
        bool ours = o->name || strncmp("help", argv[i] + 2, length) == 0 ||
                    strncmp("usage", argv[i] + 2, length) == 0;
        if (!ours) return argv[i];
        if (o->name && o->arg && argv[i][2 + length] == '\0') i++;
    }
    return NULL;
}

/* argp would name the option, but not the one that may have been meant. Ends the process. */
static void refuse_option(const char *verb, const char *word, const struct argp_option *option,
                          bool document)
{
    const char *name[MOST_OPTIONS], *given;
    int n = 0;
    char text[128];
    for (const struct argp_option *o = option; o->name; o++) name[n++] = o->name;
    snprintf(text, sizeof text, "%.*s", (int)strcspn(word, "="), word);
    given = text_nearest(text + 2, name, n);
    struct err e;
    err_clear(&e);
    err_set(&e, ERR_USAGE, "unknown option '%s'%s%s%s; `%s --help` lists them", text,
            given ? "; did you mean '--" : "", given ? given : "", given ? "'?" : "", verb);
    if (document) print_error(&e);
    err_print(&e);
    exit(err_exit_status(ERR_USAGE));
}

/* Before argp: how errors are told depends on it. Help is text whatever else is asked for. */
bool common_wants_json(int argc, char **argv)
{
    bool wants = false;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-?") == 0 ||
            strcmp(argv[i], "--usage") == 0)
            return false;
        wants = wants || strcmp(argv[i], "--json") == 0;
    }
    return wants;
}

/* Defaults, the verb's options, then argp. Returns only if the command line is right. */
void common_parse(struct common *c, int argc, char **argv, unsigned takes, const char *args,
                  const char *doc, int least, int most)
{
    /* What a verb does not take keeps its default: the default database and folder are the same
     * for all. */
    memset(c, 0, sizeof *c);
    c->verb = argv[0]; /* "mimdsim run", for messages */
    c->database = "mimdsim.db";
    c->directory = "figures";
    c->kernel = catalogue_of_kernels();
    struct argp_option option[MOST_OPTIONS] = {{0}};
    int n = 0;
    for (const struct argp_option *o = option_table; o->name; o++)
        /* The verb's own table of options. */
        if (!group_of(o->group) || takes & group_of(o->group)) option[n++] = *o;
    /* Behind them those of the verb alone; argv[0] is "mimdsim VERB". */
    for (size_t i = 0; i < sizeof own_table / sizeof *own_table; i++)
        if (strcmp(argv[0] + strcspn(argv[0], " ") + 1, own_table[i].verb) == 0)
            option[n++] = own_table[i].option;
    struct parse p = {.common = c, .least = least, .most = most, .words = args};
    struct argp argp = {.options = option, .parser = parse_option, .args_doc = args, .doc = doc};
    bool document = common_wants_json(argc, argv);
    /* Looked at first, since argp ends the process at an unknown option. */
    const char *unknown = unknown_option(argc, argv, option);
    if (unknown) refuse_option(argv[0], unknown, option, document);
    const int code = argp_parse(&argp, argc, argv, document ? ARGP_NO_EXIT : 0, NULL, &p);
    if (code == 0) return;
    if (code == ENOMEM) check_memory(0);
    err_set(&p.error, ERR_USAGE, "unknown option, or one without its value; `%s --help` lists them",
            argv[0]);
    print_error(&p.error);
    exit(err_exit_status(ERR_USAGE));
}

/* What a plan takes from the command line; the built-in programs are known by name. */
struct plan_options common_plan(const struct common *c)
{
    return (struct plan_options){.machine = c->machine,
                                 .name = c->name,
                                 .nset = c->nset,
                                 .set = c->set,
                                 .nkernel = c->kernel.n,
                                 .kernel = c->kernel.name,
                                 .program = programs_sheet,
                                 .fits = run_fits,
                                 .allow_programs = c->allow_programs,
                                 .only = c->only};
}

/* The end of a failed verb: document, text, exit status. */
int common_fail(const struct common *c, const struct err *e)
{
    /* The document on standard output, the text on standard error: both readers are served. */
    if (c->json) print_error(e);
    err_print(e);
    return err_exit_status(e->kind);
}

/* A list of names and titles, as verbs without arguments print it. */
void common_print_pairs(const struct common *c, int n, const char *const *name,
                        const char *const *title)
{
    struct json j = json_make(stdout);
    int wide = 0;
    if (c->json) json_array(&j);
    /* The titles stand below each other, behind the longest name. */
    for (int i = 0; i < n; i++)
        if ((int)strlen(name[i]) > wide) wide = (int)strlen(name[i]);
    for (int i = 0; i < n; i++) {
        if (!c->json) {
            printf("%-*s  %s\n", wide, name[i], title[i]);
            continue;
        }
        json_object(&j);
        json_key_text(&j, "name", name[i]);
        json_key_text(&j, "title", title[i]);
        json_end(&j);
    }
    if (c->json) {
        json_end(&j);
        json_finish(&j);
    }
}

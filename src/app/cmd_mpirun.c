/* cmd_mpirun.c - mimdsim mpirun: a program on virtual processors, as mpirun would run it: its lines
 * on our streams, its exit status ours. Nothing is stored. */
#include <stdlib.h>
#include <string.h>

#include "app/debugger.h"
#include "app/flag.h"
#include "app/verb.h"
#include "base/text.h"
#include "base/argument_line.h"
#include "run/run.h"

static const char doc[] =
    "Run PROGRAM on virtual processors of a machine, and show what its ranks write.\n\n"
    "Example: mimdsim mpirun -n 64 -m t3e-300 ./heat -steps 100\n"
    "\vPROGRAM is an image of mimdsim cc, c++ or f90, or its source; it runs with all your rights. "
    "What follows it are its arguments. MPI_Wtime and all clocks show simulated time. The exit "
    "status is that of the first rank that does not end with 0, or of MPI_Abort. Nothing is "
    "stored: `mimdsim run` with `program: PROGRAM` in a scenario does that.\n\n"
    "-n N: number of ranks (default 1). --level LEVEL: of the network. -l: each line with its rank "
    "before it. --limit SECONDS: processor time after which it has failed (default 600 s). --debug "
    "RANK: that rank's program under gdb, stopped where its main begins. With -n above 1, or with "
    "-m, the predicted time is written to standard error, unless --quiet is given.";

/* What mpirun has of its own, and where its arguments end. */
struct own {
    const char *ranks, *level;
    bool label, machine;
    double limit;
    int program; /* place of PROGRAM in argv */
};

/* Options that take a value as the next word: where it stands by itself it is not the program. A
 * new option with a value has to be named here. */
static bool takes_word(const char *option)
{
    static const char *const list[] = {"-n",      "-np",   "-m", "--machine", "--level",
                                       "--limit", "--set", "-s", "--debug"};
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        if (strcmp(option, list[i]) == 0) return true;
    return false;
}

/* The first word that is no option and no option's value. "--" is accepted before it, as everywhere
 * else; a lone "-" is a name. The search does not know which options exist: argp refuses those that
 * do not. */
static int find_program(int argc, char **argv)
{
    /* As the shell's mpirun: options of ours come before the program, all behind it are its own. */
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--") == 0) return i + 1;
        if (argv[i][0] != '-' || argv[i][1] == '\0') return i;
        if (takes_word(argv[i])) i++;
    }
    return argc;
}

/* The run's one answer, as its text and status. */
struct end {
    struct run_result result;
    bool made;
};

/* The arrays of the result are not ours to keep; its text and numbers are. */
static bool take_result(void *context, const struct run_spec *spec, const struct run_result *r)
{
    struct end *end = context;
    (void)spec;
    end->result = *r;
    end->made = true;
    return true;
}

/* As a shell sees it: eight bits, and never 0 for a program that did not end with 0. A run that
 * ended otherwise has the status that `mimdsim run` gives it. */
static int status_of(const struct run_result *r)
{
    if (r->exit_status != 0) return r->exit_status & 255 ? r->exit_status & 255 : 1;
    if (r->refusal) return err_exit_status((enum err_kind)r->refusal);
    if (r->status == RUN_DEADLOCK) return err_exit_status(ERR_DEADLOCK);
    return r->status == RUN_OK ? 0 : err_exit_status(ERR_CHECK);
}

/* What the program wrote is on standard output; what we have to say of it is not. An image that
 * a configure script executes has one rank and no machine: nothing is added to what it says. */
static void tell(const struct common *c, const struct own *own, const struct run_spec *spec,
                 const struct run_result *r)
{
    fflush(stdout);
    if (r->status != RUN_OK) fprintf(stderr, "mimdsim: %s: %s\n", spec->kernel.name, r->text);
    else if (!c->quiet && (own->machine || spec->nrank > 1))
        fprintf(stderr, "mimdsim: %d rank%s on %s: %.9g s, %lld messages, %lld bytes\n",
                spec->nrank, spec->nrank > 1 ? "s" : "", spec->machine.name,
                (double)r->makespan_ps * 1e-12, (long long)r->messages, (long long)r->bytes);
}

/* The plan of the one run, PROGRAM with its settings: machine, level, settings and limits are
 * checked as those of a scenario are. */
static bool make_plan(const struct common *c, const struct own *own, const char *program,
                      const char *arguments, struct plan *p, struct err *e)
{
    struct plan_options o = common_plan(c);
    const char *set[COMMON_MOST_SETS + 3];
    char ranks[64], level[64];
    struct text line = {0};
    int n = 0;
    snprintf(ranks, sizeof ranks, "ranks=%.40s", own->ranks != NULL ? own->ranks : "1");
    set[n++] = ranks;
    snprintf(level, sizeof level, "level=%.40s", own->level != NULL ? own->level : "");
    if (own->level != NULL) set[n++] = level;
    text_add(&line, "program.arguments=%s", arguments);
    set[n++] = line.s;
    for (int i = 0; i < c->nset; i++) set[n++] = c->set[i];
    o.set = set;
    o.nset = n;
    bool fine = plan_read(p, program, &o, e);
    if (fine && p->nrun != 1)
        fine = err_set(e, ERR_USAGE, "mpirun makes one run; several values are for `mimdsim run`");
    text_free(&line);
    if (!fine) plan_free(p);
    return fine;
}

/* One worker process, so that a crash of the program is not ours; its lines come through as
 * they are written. */
static int run_here(const struct common *c, const struct own *own, const char *program,
                    const char *arguments)
{
    struct plan p = {0};
    struct end end = {0};
    struct err e;
    err_clear(&e);
    if (!make_plan(c, own, program, arguments, &p, &e)) return common_fail(c, &e);
    /* Shown at once: what a program wrote before it crashed is what its author looks for. */
    const struct run_order order = {.host_limit = own->limit,
                                    .output =
                                        own->label ? PROGRAM_OUTPUT_LABEL : PROGRAM_OUTPUT_SHOW};
    fflush(stdout);
    const bool fine = run_campaign(p.run, &order, 1, NULL, 1, true, take_result, &end, &e);
    if (fine && end.made) tell(c, own, p.run, &end.result);
    const int status = fine ? status_of(&end.result) : common_fail(c, &e);
    plan_free(&p);
    return status;
}

/* argp is shown what stands before the program, and the program: the rest would look like
 * options to it. */
int cmd_mpirun(int argc, char **argv)
{
    struct common c;
    struct own own = {.program = find_program(argc, argv)};
    struct text arguments = {0};
    struct err e;
    err_clear(&e);
    /* What follows the program is its own: it is not looked at here. */
    const int at = own.program, debug = debugger_wanted(at, argv);
    if (debug) {
        debugger_run(argc, argv, debug, &e);
        common_parse(&c, 1, argv, TAKES_PLAN, "PROGRAM [ARGUMENT...]", doc, 0, 1);
        return common_fail(&c, &e);
    }
    char *program = at < argc ? argv[at] : NULL;
    text_add(&arguments, "%s", "");
    for (int i = at + 1; i < argc; i++) argument_line_add(&arguments, argv[i]);
    int n = at < argc ? at + 1 : argc;
    argv[n < argc ? n : argc] = NULL;
    own.ranks = take_value(&n, argv, "-n");
    const char *np = take_value(&n, argv, "-np"), *level = take_value(&n, argv, "--level");
    if (np != NULL) own.ranks = np;
    own.level = level;
    own.label = take_flag(&n, argv, "-l");
    const bool limited = take_seconds(&n, argv, "--limit", &own.limit, &e);
    common_parse(&c, n, argv, TAKES_PLAN, "PROGRAM [ARGUMENT...]", doc, 1, 1);
    own.machine = c.machine != NULL;
    const int status = limited ? run_here(&c, &own, program, arguments.s) : common_fail(&c, &e);
    text_free(&arguments);
    return status;
}

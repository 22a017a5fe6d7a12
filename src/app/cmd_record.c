/* cmd_record.c - mimdsim record: times of an MPI program of its own, beside those of real runs.
 *
 * The program runs by its own mpirun; a small library that is loaded before it (hosts/record_mpi.c)
 * takes the time from the end of MPI_Init to the beginning of MPI_Finalize on each rank. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/arguments.h"
#include "app/flag.h"
#include "app/verb.h"
#include "base/digest.h"
#include "base/process.h"
#include "base/progress.h"
#include "host/host_load.h"
#include "hosts/hosts.h"
#include "store/real_rows.h"

static const char doc[] =
    "Run an MPI program of your own on this computer several times, and store its times as mimdsim "
    "run --backend mpi does.\n\n"
    "Example: mimdsim record -n 2 --samples 10 -- ./stencil 1000\n"
    "\vPROGRAM is built by its own mpicc, not by mimdsim cc, and is started by mpirun. Its time is "
    "that from the end of MPI_Init to the beginning of MPI_Finalize; a barrier is added at both "
    "ends. "
    "Repetitions in which the system took a processor away from a rank are not counted. What the "
    "program writes to standard output is not shown. It runs with all your rights.\n\n"
    "-n N: processes (default 2). --samples N: repetitions (default 10). --mpirun COMMAND: the "
    "launcher with its options, divided at blanks (default mpirun of the program's MPI).";

enum { MOST_RANKS = 1024, MOST_SAMPLES = 2500, MOST_WORDS = 256 };

/* What is asked for, and what the program is. Words that are made for the command line live here,
 * as long as the command does. */
struct record {
    int nrank, samples;
    char *launcher;                         /* NULL: by the program's library */
    char **program;                         /* with its arguments, NULL behind the last */
    const char *library, *module, *starter; /* "MPICH", the file loaded before, "mpirun.mpich" */
    char preload[4200], log[64], log_word[96], number[16];
};

/* --- the program's MPI ------------------------------------------------------------------------ */

/* By what its loader would load: ldd says it. Names of files are not enough, since one mpicc may
 * build for either; and a library that is loaded before must be of the same MPI. */
static bool find_library(struct record *r, struct err *e)
{
    const char *const words[] = {"ldd", r->program[0], NULL};
    struct text said = {0};
    int status;
    if (access(r->program[0], X_OK) != 0)
        return err_set(e, ERR_NO_INPUT, "there is no program '%.200s' that can be run: %s",
                       r->program[0], strerror(errno));
    if (!process_run(words, NULL, &said, &status, e)) return false;
    const char *s = said.s != NULL ? said.s : "";
    /* MPICH's library is called libmpi.so.12 by others that keep to its interface. */
    if (strstr(s, "libmpich.so") != NULL || strstr(s, "libmpi.so.12") != NULL) {
        r->library = "MPICH";
        r->module = "mimdsim-record-mpich.so";
        r->starter = "mpirun.mpich";
    } else if (strstr(s, "libmpi.so.") != NULL) {
        r->library = "Open MPI";
        r->module = "mimdsim-record-openmpi.so";
        r->starter = "mpirun.openmpi";
    }
    text_free(&said);
    return r->library != NULL ||
           err_set(e, ERR_DATA,
                   "'%.200s' is not linked with the shared library of MPICH or Open MPI; build it "
                   "by their mpicc",
                   r->program[0]);
}

/* Beside this program, as in a build tree, or where it is installed: as the modules of hosts.c are
 * found. */
static bool find_module(struct record *r, struct err *e)
{
    char folder[2048];
    const ssize_t n = readlink("/proc/self/exe", folder, sizeof folder - 1);
    folder[n > 0 ? n : 0] = '\0';
    char *slash = strrchr(folder, '/');
    if (slash != NULL) *slash = '\0';
    const char *const place[] = {folder, MIMDSIM_PKGLIBDIR};
    for (int i = 0; i < 2; i++) {
        snprintf(r->preload, sizeof r->preload, "LD_PRELOAD=%s/%s", place[i], r->module);
        if (access(strchr(r->preload, '=') + 1, R_OK) == 0) return true;
    }
    return err_set(
        e, ERR_UNAVAILABLE,
        "this mimdsim was built without %s; install its compiler (mpicc) and build again: "
        "configure --with-mpi",
        r->library);
}

/* --- repetitions ------------------------------------------------------------------------------ */

/* The launcher's words, those that load the library on each rank alone, the program's. Debian has
 * both launchers under names of their own; elsewhere there is one mpirun. */
static void make_command(struct record *r, bool own_name, const char **word)
{
    int n = 0;
    /* The launcher's text is cut at its blanks: it is a copy of the option's. */
    char *rest = r->launcher;
    for (char *w; rest != NULL && (w = strsep(&rest, " ")) != NULL && n < MOST_WORDS / 2;)
        if (*w != '\0') word[n++] = w;
    if (n == 0) word[n++] = own_name ? r->starter : "mpirun";
    snprintf(r->number, sizeof r->number, "%d", r->nrank);
    snprintf(r->log_word, sizeof r->log_word, "MIMDSIM_RECORD=%s", r->log);
    const char *const own[] = {"-n", r->number, "env", r->preload, r->log_word};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) word[n++] = own[i];
    for (char **p = r->program; *p != NULL && n < MOST_WORDS - 1; p++) word[n++] = *p;
    word[n] = NULL;
}

/* What the ranks of one repetition wrote: the longest time counts, since all begin and end with a
 * barrier; one rank that was disturbed has disturbed all. */
static bool read_log(const struct record *r, struct real_sample *s, double *used_s,
                     struct real_result *out, struct err *e)
{
    FILE *in = fopen(r->log, "r");
    int ranks = 0, rank, size, processor;
    long long wall, taken, used;
    *s = (struct real_sample){0};
    while (in != NULL && fscanf(in, "%d %d %lld %lld %lld %d", &rank, &size, &wall, &taken, &used,
                                &processor) == 6) {
        ranks++;
        s->seconds = fmax(s->seconds, (double)wall * 1e-9);
        s->disturbed = s->disturbed || taken > 0;
        *used_s += (double)used * 1e-9;
        out->nrank = size;
    }
    if (in != NULL) fclose(in);
    return ranks == r->nrank ||
           err_set(
               e, ERR_DATA,
               "'%.200s': %d of %d ranks called MPI_Init and MPI_Finalize; their time is what is "
               "recorded",
               r->program[0], ranks, r->nrank);
}

/* The log is emptied first, so that lines of an earlier repetition are never read as this one's. */
static bool repeat(struct record *r, const char *const *word, struct real_sample *s, double *used_s,
                   struct real_result *out, struct err *e)
{
    struct text said = {0};
    int status = 0;
    if (truncate(r->log, 0) != 0) return err_set(e, ERR_IO, "%s: %s", r->log, strerror(errno));
    const bool ok = process_run(word, NULL, &said, &status, e);
    text_free(&said);
    if (!ok) return false;
    if (status != 0)
        return err_set(e, ERR_CHECK, "'%.200s' on %d processes ended with status %d", r->program[0],
                       r->nrank, status);
    return read_log(r, s, used_s, out, e);
}

/* All repetitions, then statistics over those that count, by the same rule as for real runs: over
 * all where too few are undisturbed. */
static bool measure(struct record *r, bool quiet, struct arena *a, struct real_result *out,
                    struct err *e)
{
    const char *word[MOST_WORDS];
    double *room = TAKE(a, r->samples, double), used = 0;
    struct progress progress = progress_make("record", r->samples, quiet);
    const struct host_load_begin load = host_load_start();
    /* The name of its own, where there is such a launcher. */
    const char *const look[] = {"sh", "-c", "command -v \"$0\" >/dev/null", r->starter, NULL};
    int status = 1;
    struct text none = {0};
    if (!process_run(look, NULL, &none, &status, e)) return false;
    text_free(&none);
    make_command(r, status == 0, word);
    out->sample = TAKE(a, r->samples, struct real_sample);
    for (int i = 0; i < r->samples; i++) {
        if (!repeat(r, word, &out->sample[i], &used, out, e)) return false;
        out->nsample++;
        out->disturbed += out->sample[i].disturbed;
        progress_show(&progress, i + 1);
    }
    progress_end(&progress);
    /* The samples themselves stay in the order made. */
    const bool all = out->nsample - out->disturbed < REAL_LEAST_SAMPLES;
    int n = 0;
    for (int i = 0; i < out->nsample; i++)
        if (all || !out->sample[i].disturbed) room[n++] = out->sample[i].seconds;
    out->time = real_times_of(room, n);
    out->load = host_load_read(&load, used);
    return true;
}

/* --- the command ------------------------------------------------------------------------------ */

/* A program of its own has no answer that could be looked at: those columns stay empty. */
static void describe(const struct record *r, struct real_result *out)
{
    text_copy(out->backend, sizeof out->backend, "record");
    text_copy(out->library, sizeof out->library, r->library);
    text_copy(out->placement, sizeof out->placement, "as its launcher has it");
    host_name(out->host, (int)sizeof out->host);
    host_processor_name(out->processor, (int)sizeof out->processor);
    out->nrank = r->nrank;
    out->processors = host_processors(host_processor_set());
    out->oversubscribed = out->nrank > out->processors;
    out->repeatable = true;
    out->difference = out->worst_error = out->worst_tolerance = NAN;
}

/* The row's identity: the program's bytes, its arguments, the number of ranks. A program that was
 * built anew is another task, wherever it lies. */
static bool identify(const struct record *r, struct text *arguments, char hash[65], struct err *e)
{
    struct text bytes = {0};
    if (!text_read_file(&bytes, r->program[0], e)) return false;
    for (int i = 0; r->program[i] != NULL; i++)
        text_add(arguments, "%s%s", i > 0 ? " " : "", r->program[i]);
    text_add(&bytes, "\n%s\n%d", arguments->s, r->nrank);
    digest_sha256_hex(bytes.s, bytes.length, hash);
    text_free(&bytes);
    return true;
}

/* Everything that can be refused is refused before the program runs for the first time; the
 * database is opened when there is something to be stored. */
static bool record(struct record *r, const struct common *c, struct err *e)
{
    char hash[65];
    struct arena *a = arena_create();
    struct text arguments = {0};
    struct real_result *out = TAKE(a, 1, struct real_result);
    struct store *s = NULL;
    bool ok = find_library(r, e) && find_module(r, e) && identify(r, &arguments, hash, e);
    text_copy(r->log, sizeof r->log, "mimdsim-record-XXXXXX");
    const int file = ok ? mkstemp(r->log) : -1;
    if (ok && file < 0) ok = err_set(e, ERR_CREATE, "no temporary file here: %s", strerror(errno));
    if (file >= 0) close(file);
    if (ok) describe(r, out);
    ok = ok && measure(r, c->quiet, a, out, e);
    if (file >= 0) unlink(r->log);
    if (ok) s = arguments_store(c, c->database, e);
    const char *slash = strrchr(r->program[0], '/');
    const struct real_task task = {hash, arguments.s, slash != NULL ? slash + 1 : r->program[0], 0,
                                   arguments.s};
    ok = ok && s != NULL && store_put_real(s, &task, out, e);
    if (ok)
        printf("%s: P = %d, min %.3f, median %.3f, upper %.3f us; %d repetitions, %d disturbed; "
               "load %.2f\n",
               task.program, out->nrank, out->time.min * 1e6, out->time.median * 1e6,
               out->time.upper * 1e6, out->nsample, out->disturbed, out->load.others);
    store_close(s);
    text_free(&arguments);
    arena_destroy(a);
    return ok;
}

/* A whole number within bounds, or the default where the option is not there. The message has the
 * bounds, as those of all options. */
static bool take_number(int *argc, char **argv, const char *name, int most, int *value,
                        struct err *e)
{
    const char *text = take_value(argc, argv, name);
    char *end = NULL;
    if (text == NULL) return true;
    const long n = strtol(text, &end, 10);
    if (end == text || *end != '\0' || n < 1 || n > most)
        return err_set(e, ERR_USAGE, "%s '%.40s': expected a number from 1 to %d", name, text,
                       most);
    *value = (int)n;
    return true;
}

/* What stands behind "--" is the program's, options included; everything before it is ours, so that
 * a program may have an option -n of its own. */
int cmd_record(int argc, char **argv)
{
    struct common c;
    struct record r = {.nrank = 2, .samples = 10};
    struct err e;
    int own = 1;
    err_clear(&e);
    while (own < argc && strcmp(argv[own], "--") != 0) own++;
    r.program = own < argc ? argv + own + 1 : argv + argc;
    if (own < argc) argv[own] = NULL;
    argc = own;
    bool ok = take_number(&argc, argv, "--samples", MOST_SAMPLES, &r.samples, &e);
    ok = take_number(&argc, argv, "-n", MOST_RANKS, &r.nrank, &e) && ok;
    const char *launcher = take_value(&argc, argv, "--mpirun");
    common_parse(&c, argc, argv, TAKES_STORE, "-- PROGRAM [ARGUMENT...]", doc, 0, 0);
    if (ok && r.program[0] == NULL)
        ok = err_set(&e, ERR_USAGE, "expected -- PROGRAM: mimdsim record -n 2 -- ./program");
    r.launcher = launcher != NULL ? strdup(launcher) : NULL;
    ok = ok && record(&r, &c, &e);
    free(r.launcher);
    return ok ? 0 : common_fail(&c, &e);
}

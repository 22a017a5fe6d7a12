/* every.c - lets every call of a kind fail, one after the other, in short commands of the real
 * program, and judges what is left: a message, a documented status, no half-written file, a
 * database that is whole.
 *
 *     every PROGRAM LIBRARY DATA [--branches|--thin] [--each] [--most N] [--step N] [--kind KIND]
 *         [COMMAND...]
 *
 * PROGRAM is mimdsim, LIBRARY the one of fail.c, DATA the folder with tests/. --step N: one call of
 * N is let fail;
 * --most N: at most N of each kind in each command; --kind: only this kind; otherwise all.
 * --branches: allocations fail in branches of one process instead of each in a process that begins
 * anew (branch.h), which takes a tenth of the time and needs the right to mount; --thin: likewise,
 * and of many from one place some. --each: a line for each; --first N: from the N-th. What a
 * command does without a failure is the measure: where one is survived, with status 0, everything
 * must be as without it; else the command must work when it is given again. */
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "branch.h"
#include "outcome.h"

enum { MOST_WORDS = 20, PATIENCE_S = 60 };

/* What is let fail, and how: the statuses that may come of it beside 0. */
static const struct fault {
    const char *kind, *as;
    bool survived; /* it has to be: the call is to be made again, or goes on */
    const char *statuses;
} faults[] = {
    {"malloc", "ENOMEM", false, "71"},
    {"write", "ENOSPC", false, "71 73 74"},
    {"write", "EIO", false, "71 73 74"},
    {"write", "EINTR", false, "74"},
    {"write", "SHORT", true, ""},
    {"read", "EIO", false, "65 66 71 74"},
    {"read", "EINTR", true, ""},
    {"read", "SHORT", true, ""},
    {"sync", "EIO", false, "73 74"},
    {"name", "EACCES", false, "73 74"},
    {"name", "ENOSPC", false, "73 74"},
    {"open", "EACCES", false, "65 66 71 73 74"},
    {"open", "EMFILE", false, "65 66 71 73 74"},
    {"process", "EAGAIN", false, "69 71"},
    {"pipe", "EMFILE", false, "71"},
    {"map", "ENOMEM", false, "71 74"},
    {"lock", "EIO", false, "74 75"},
};
enum { FAULTS = sizeof faults / sizeof *faults };

/* The commands, each in a folder with what `before` has made of the files of the one above. */
static const struct command {
    const char *name, *before, *line;
} commands[] = {
    {"run", "", "run small.yaml -o out.db --jobs 1 --quiet"},
    {"more", "run small.yaml -o out.db --jobs 1 --quiet",
     "run small.yaml -o out.db --jobs 1 --quiet --set n=3"},
    {"campaign", "", "run small.yaml -o out.db --jobs 2 --quiet --set ranks=1,2"},
    {"query", "run small.yaml -o out.db --jobs 1 --quiet", "query out.db SELECT*FROM(v_speedup)"},
    {"plot", "stability small.yaml -o out.db --quiet", "plot out.db stability --dir figures"},
    {"report", "stability small.yaml -o out.db --quiet;run small.yaml -o out.db --jobs 1 --quiet",
     "report out.db --dir figures"},
    {"verify", "", "verify vector.json"},
    {"merge",
     "run small.yaml -o out.db --jobs 1 --quiet;run small.yaml -o from.db --jobs 1 --quiet --set "
     "n=3",
     "merge out.db from.db"},
    {"load", "",
     "load what-if-torus --set machine.topology.dims=[2,2] --traffic uniform --rates 0.1 --level "
     "packet --messages 10000 --no-saturation --jobs 1 -o out.db --quiet"},
    {"stability", "", "stability small.yaml -o out.db --quiet"},
    {"accuracy", "", "accuracy small.yaml -o out.db --quiet --set n=2 --set ranks=1"},
};
enum { COMMANDS = sizeof commands / sizeof *commands };

static struct {
    const char *program, *library, *data, *kind;
    char folder[64], gnuplot[96];
    bool branches, thin, each;
    long first, step, most;
    long made, survived, told, wrong;
} all = {.step = 1};

static struct outcome usual, now, again;

static void shell(const char *format, const char *a, const char *b)
{
    char line[1024];
    snprintf(line, sizeof line, format, a, b);
    if (system(line) != 0) die(line);
}

/* --- a command -------------------------------------------------------------------------------- */

static void read_back(const char *path, char text[OUTCOME_TEXT])
{
    FILE *in = fopen(path, "r");
    if (!in) die(path);
    text[fread(text, 1, OUTCOME_TEXT - 1, in)] = '\0';
    fclose(in);
}

/* In the child: the words of `line`, with the failure that `f` says at call `at` (f NULL: none; at
 * 0: counted). */
static _Noreturn void become(const char *line, const struct fault *f, long at)
{
    static char copy[512], number[32];
    char *word[MOST_WORDS] = {(char *)all.program};
    int n = 1;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *w = strtok(copy, " "); w && n + 1 < MOST_WORDS; w = strtok(NULL, " ")) word[n++] = w;
    if (f) {
        setenv("FAULT_PROGRAM", "mimdsim", 1);
        setenv("FAULT", f->kind, 1);
        setenv("FAULT_AS", f->as, 1);
        snprintf(number, sizeof number, "%ld", at);
        setenv("FAULT_AT", number, 1);
        if (at == 0) setenv("FAULT_COUNT", "../count", 1);
        setenv("LD_PRELOAD", all.library, 1);
    }
    int out = open("../out", O_CREAT | O_TRUNC | O_WRONLY, 0600),
        err = open("../err", O_CREAT | O_TRUNC | O_WRONLY, 0600);
    dup2(out, 1);
    dup2(err, 2);
    dup2(open("/dev/null", O_RDONLY), 0);
    execv(all.program, word);
    _exit(126);
}

static int shell_status(int status)
{
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/* What a command has left that has ended with `status`. */
static void read_outcome(struct outcome *o, int status)
{
    o->status = status;
    read_back("../out", o->out);
    read_back("../err", o->err);
    outcome_look(o);
}

static void give(const char *line, const struct fault *f, long at, struct outcome *o)
{
    pid_t child = fork();
    if (child == 0) become(line, f, at);
    int status = 0, waited = 0;
    /* A command that waits for ever is a finding of its own. */
    while (waitpid(child, &status, WNOHANG) == 0 && waited++ < PATIENCE_S * 1000) usleep(1000);
    if (waited >= PATIENCE_S * 1000) kill(child, SIGKILL), waitpid(child, &status, 0);
    read_outcome(o, waited >= PATIENCE_S * 1000 ? 124 : shell_status(status));
}

/* --- the judgement ---------------------------------------------------------------------------- */

static bool is_one_of(int status, const char *statuses)
{
    char word[16];
    snprintf(word, sizeof word, "%d", status);
    return strstr(statuses, word) != NULL;
}

/* Whether it tells times of this computer, which are others each time. */
static bool is_timed(const struct command *c) { return strcmp(c->name, "accuracy") == 0; }

/* What a failed command may leave: files as they were before it, or as they are after it; of a
 * process that ended at once also some that never got their names. */
static const char *judge_files(const struct command *c, const struct outcome *before)
{
    static char why[512];
    if (now.bad[0]) return now.bad;
    for (int i = 0; i < now.nfile; i++) {
        const char *name = now.file[i].name;
        const unsigned long long *old = outcome_find(before, name),
                                 *new = outcome_find(&usual, name);
        if (old && *old == now.file[i].print) continue;
        if (new && (*new == now.file[i].print || is_timed(c))) continue;
        /* A report tells which figures could not be drawn, and leaves out what cannot be read, with
         * a word. */
        if (now.err[0] && (ends_in(name, ".md") || ends_in(name, ".html"))) continue;
        if (ends_in(name, ".db") || (now.status == 71 && strstr(name, ".part")))
            continue; /* looked at; removed later */
        snprintf(why, sizeof why, "%s is neither the old nor the new one", name);
        return why;
    }
    return NULL;
}

/* The same command in what the failed one has left. Most leave the same as others, byte by byte:
 * that is tried once. */
static const char *judge_again(const struct command *c)
{
    enum { KEPT = 4096 };
    static struct {
        const struct command *command;
        unsigned long long state;
        char why[128];
    } kept[KEPT];
    const size_t at = now.state % KEPT;
    if (kept[at].command != c || kept[at].state != now.state) {
        kept[at].command = c, kept[at].state = now.state;
        kept[at].why[0] = '\0';
        give(c->line, NULL, 0, &again);
        if (again.status != usual.status)
            snprintf(kept[at].why, sizeof kept[at].why, "given again it does not work");
        else if (!is_timed(c) && !outcome_same(&again, &usual))
            snprintf(kept[at].why, sizeof kept[at].why,
                     "given again it leaves other files (%d, usually %d)", again.nfile,
                     usual.nfile);
    }
    return kept[at].why[0] ? kept[at].why : NULL;
}

static const char *judge(const struct command *c, const struct fault *f,
                         const struct outcome *before)
{
    if (now.status == 124) return "it does not end";
    if (now.status >= 128) return "a signal has ended it";
    if (strstr(now.err, "internal error")) return "an internal error";
    const char *files = judge_files(c, before);
    if (files) return files;
    if (now.status == usual.status) {
        if (is_timed(c)) return NULL;
        if (strcmp(now.out, usual.out) != 0) return "status 0, but another output";
        if (!outcome_same(&now, &usual) && !(now.err[0] && strcmp(c->name, "report") == 0))
            return "status 0, but other files";
        return NULL;
    }
    if (f->survived) return "it is to be tried again, or to go on";
    /* A run of a campaign whose worker could do nothing has failed: that is its result. */
    const bool run_failed = now.status == 1 && strcmp(c->name, "campaign") == 0;
    if (!is_one_of(now.status, f->statuses) && !run_failed) return "its status says something else";
    if (!strstr(now.err, "mimdsim: ")) return "no message";
    return judge_again(c);
}

/* --- a failure ------------------------------------------------------------------------------- */

static void prepare(void)
{
    shell("rm -rf '%s/work' && cp -r '%s/before' work", all.folder, all.folder);
    if (chdir("work") != 0) die("work");
}

static void leave(void)
{
    if (chdir(all.folder) != 0) die(all.folder);
}

/* What the commands of `before` leave. */
static void make_before(const struct command *c)
{
    char lines[512];
    setenv("MIMDSIM_GNUPLOT", all.gnuplot, 1);
    shell("rm -rf '%s/before' && mkdir '%s/before'", all.folder, all.folder);
    shell("cp '%s/tests/faults/small.yaml' '%s/before'", all.data, all.folder);
    shell("cp '%s/tests/data/vectors/closed_slidercrank.json' '%s/before/vector.json'", all.data,
          all.folder);
    if (chdir("before") != 0) die("before");
    snprintf(lines, sizeof lines, "%s", c->before);
    for (char *rest = lines, *line; (line = strsep(&rest, ";")) != NULL;) {
        if (*line == '\0') continue;
        give(line, NULL, 0, &now);
        if (now.status != 0) fprintf(stderr, "every: %s: %s", line, now.err), exit(2);
    }
    leave();
}

static long count_calls(const struct command *c, const struct fault *f)
{
    long n = -1;
    prepare();
    unlink("../count");
    give(c->line, f, 0, &usual);
    FILE *in = fopen("../count", "r");
    if (in && fscanf(in, "%ld", &n) != 1) n = -1;
    if (in) fclose(in);
    leave();
    return n;
}

/* One kind of failure in one command. */
struct trial {
    const struct command *command;
    const struct fault *fault;
    const struct outcome *before;
    long calls, made, survived, wrong;
};

/* Judges `now`, in which call `at` has failed. */
static void count_one(struct trial *t, long at)
{
    const bool well = now.status == usual.status;
    const int status = now.status;
    const char *why = judge(t->command, t->fault, t->before);
    t->made++;
    t->survived += !why && well;
    if (all.each)
        printf("%s %s %s %ld: %d, %s\n", t->command->name, t->fault->kind, t->fault->as, at, status,
               why ? why : "right");
    if (why && t->wrong++ < 10)
        printf("%s, %s %ld of %ld, %s: status %d: %s\n    %.600s\n", t->command->name,
               t->fault->kind, at, t->calls, t->fault->as, status, why, now.err);
}

/* In a process of its own. */
static void try_one(struct trial *t, long at)
{
    prepare();
    give(t->command->line, t->fault, at, &now);
    count_one(t, at);
    leave();
}

/* --- in branches ------------------------------------------------------------------------------ */

static int remove_entry(const char *path, const struct stat *s, int kind, struct FTW *w)
{
    (void)s, (void)kind, (void)w;
    return remove(path);
}

/* What a branch has changed is of no more use. */
static void forget_copy(long at)
{
    static const char *const layers[] = {"upper", "work"};
    for (int i = 0; i < 2; i++) {
        char path[128];
        snprintf(path, sizeof path, "%s.%s-%ld", all.folder, layers[i], at);
        nftw(path, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
    }
}

/* From one mount namespace to the working directory as another one has it. */
static void step_into(int space)
{
    char work[96];
    snprintf(work, sizeof work, "%s/work", all.folder);
    if (setns(space, CLONE_NEWNS) != 0 || chdir(work) != 0) die(work);
}

static int space_of(int process)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/%d/ns/mnt", process);
    const int space = open(path, O_RDONLY | O_CLOEXEC);
    if (space < 0) die(path);
    return space;
}

/* The next word; false when nobody is left to say one. A branch that waits for ever is ended, which
 * its parent tells then. */
static bool hear(int socket, struct branch_word *w, int child, bool *late)
{
    struct pollfd ready = {socket, POLLIN, 0};
    while (poll(&ready, 1, PATIENCE_S * 1000) == 0) {
        if (child == 0 || *late) return false;
        *late = kill(child, SIGKILL) == 0;
    }
    return recv(socket, w, sizeof *w, 0) == sizeof *w;
}

/* Starts the command that forks at call `first` and each `step` calls later; its end of `pair`. */
static pid_t start_branches(const struct trial *t, long first, long step, int pair[2])
{
    if (socketpair(AF_UNIX, SOCK_SEQPACKET, 0, pair) != 0) die("socketpair");
    fcntl(pair[0], F_SETFD, FD_CLOEXEC);
    const pid_t process = fork();
    if (process == 0) {
        char number[32];
        snprintf(number, sizeof number, "%d", pair[1]);
        setenv("FAULT_SOCKET", number, 1);
        snprintf(number, sizeof number, "%ld", step);
        setenv("FAULT_STEP", number, 1);
        setenv("FAULT_FOLDER", all.folder, 1);
        if (all.thin) setenv("FAULT_THIN", "1", 1);
        become(t->command->line, t->fault, first);
    }
    close(pair[1]);
    return process;
}

/* Every `step`-th call in a branch of one process; those that it had to pass by are put into
 * `passed`, of as many as there are calls. Returns how many. */
static long try_branches(struct trial *t, long first, long step, long *passed)
{
    long npassed = 0, heard = 0;
    int pair[2], status = 0, space = -1, home = space_of(getpid()), child = 0;
    bool late = false;
    prepare();
    const pid_t process = start_branches(t, first, step, pair);
    for (struct branch_word w; hear(pair[0], &w, child, &late); heard += w.what != BRANCH_BORN) {
        if (w.what == BRANCH_BORN) space = space_of(child = w.child);
        else if (w.what == BRANCH_PASSED || child != w.child) passed[npassed++] = w.at;
        else {
            step_into(space);
            read_outcome(&now, late ? 124 : shell_status(w.status));
            count_one(t, w.at);
            step_into(home);
            close(space);
            forget_copy(w.at);
            late = false;
        }
        if (w.what != BRANCH_PASSED && send(pair[0], "", 1, MSG_NOSIGNAL) != 1) break;
    }
    close(pair[0]);
    kill(process, SIGKILL); /* it has ended, or it never will */
    waitpid(process, &status, 0);
    const long expected = all.thin ? heard : (t->calls - first) / step + 1;
    if (shell_status(status) != usual.status || heard != expected) {
        printf("%s: of %ld branches the process told %ld and ended with status %d\n",
               t->command->name, expected, heard, shell_status(status));
        t->wrong++;
    }
    close(home);
    leave();
    return npassed;
}

/* --- all of them ------------------------------------------------------------------------------ */

/* The calls that are to fail, each in its way. */
static void try_calls(struct trial *t)
{
    const long n = t->calls,
               step = all.most > 0 && n / all.most >= all.step ? n / all.most + 1 : all.step,
               first = all.first > 0 ? all.first
                       : n > 0       ? 1 + step / 2 % n
                                     : 1;
    if (!all.branches || strcmp(t->fault->kind, "malloc") != 0) {
        for (long at = first; at <= n; at += step) try_one(t, at);
        return;
    }
    long *passed = malloc((size_t)n * sizeof *passed + 1);
    if (!passed) die("calls");
    const long npassed = try_branches(t, first, step, passed);
    if (npassed > 0) printf("%s: %ld not in branches\n", t->command->name, npassed);
    for (long i = 0; i < npassed; i++) try_one(t, passed[i]);
    free(passed);
}

static void try_all(const struct command *c, const struct fault *f, const struct outcome *before)
{
    /* No program can be started whose reads end in signals before it is ready for them. */
    setenv("MIMDSIM_GNUPLOT", strcmp(f->kind, "read") == 0 ? "/nowhere/gnuplot" : all.gnuplot, 1);
    struct trial t = {c, f, before, count_calls(c, f), 0, 0, 0};
    if (usual.status == 99) {
        printf("%-9s %-8s %-7s skipped: this system has no filters of system calls\n", c->name,
               f->kind, f->as);
        return;
    }
    if (t.calls < 0 || (usual.status != 0 && usual.status != 69)) {
        printf("%-9s %-8s %-7s cannot be counted (status %d): %s\n", c->name, f->kind, f->as,
               usual.status, usual.err);
        all.wrong++;
        return;
    }
    try_calls(&t);
    const long told = t.made - t.survived - t.wrong;
    printf("%-9s %-8s %-7s %6ld calls, %6ld failed: %6ld survived, %6ld told, %ld wrong\n", c->name,
           f->kind, f->as, t.calls, t.made, t.survived, told, t.wrong);
    fflush(stdout);
    all.made += t.made, all.survived += t.survived, all.told += told, all.wrong += t.wrong;
}

static bool wanted(int argc, char **argv, const char *name)
{
    for (int i = 0; i < argc; i++)
        if (strcmp(argv[i], name) == 0) return true;
    return argc == 0;
}

int main(int argc, char **argv)
{
    if (argc < 4)
        return fprintf(stderr, "usage: every PROGRAM LIBRARY DATA [--branches|--thin] [--each] "
                               "[--most N] [--step N] [--kind KIND] [COMMAND...]\n"),
               2;
    all.program = argv[1], all.library = argv[2], all.data = argv[3];
    int i = 4;
    for (; i < argc; i++)
        if (strcmp(argv[i], "--branches") == 0) all.branches = true;
        else if (strcmp(argv[i], "--thin") == 0) all.branches = all.thin = true;
        else if (strcmp(argv[i], "--each") == 0) all.each = true;
        else break;
    for (; i + 1 < argc && strncmp(argv[i], "--", 2) == 0; i += 2) {
        if (strcmp(argv[i], "--step") == 0) all.step = atol(argv[i + 1]);
        if (strcmp(argv[i], "--first") == 0) all.first = atol(argv[i + 1]);
        if (strcmp(argv[i], "--most") == 0) all.most = atol(argv[i + 1]);
        if (strcmp(argv[i], "--kind") == 0) all.kind = argv[i + 1];
    }
    snprintf(all.folder, sizeof all.folder, "%s/mimdsim-faults-XXXXXX",
             getenv("TMPDIR") ? getenv("TMPDIR") : P_tmpdir);
    if (!mkdtemp(all.folder) || chdir(all.folder) != 0) die(all.folder);
    setenv("HOME", all.folder, 1);
    setenv("MIMDSIM_DATA", all.data, 1);
    /* A program in gnuplot's place: drawing takes seconds, and is not what is tried here. */
    shell(
        "printf '#!/bin/sh\\nn=${2%%%%.gp}; echo \"<svg></svg>\" >\"$n.svg\"\\n' >'%s/gnuplot' && "
        "chmod +x '%s/gnuplot'",
        all.folder, all.folder);
    snprintf(all.gnuplot, sizeof all.gnuplot, "%s/gnuplot", all.folder);
    setenv("MIMDSIM_GNUPLOT", all.gnuplot, 1);
    for (int c = 0; c < COMMANDS; c++) {
        if (!wanted(argc - i, argv + i, commands[c].name)) continue;
        static struct outcome before;
        make_before(&commands[c]);
        if (chdir("before") != 0) die("before");
        outcome_look(&before);
        leave();
        for (int f = 0; f < FAULTS; f++)
            if (!all.kind || strcmp(all.kind, faults[f].kind) == 0)
                try_all(&commands[c], &faults[f], &before);
    }
    printf("%ld failures: %ld survived, %ld told, %ld wrong\n", all.made, all.survived, all.told,
           all.wrong);
    if (chdir("/") == 0) shell("rm -rf '%s'%s", all.folder, "");
    return all.wrong > 0;
}

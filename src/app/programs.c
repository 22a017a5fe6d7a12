/* programs.c - see programs.h. The compiler is this program's own verb, run as a process: what
 * it says is what people see when they call it themselves.
 *
 * Compiling takes longer than most runs, so images are kept. The key is everything that the
 * image depends on: content, compiler, flags, and this build. */
#include "app/programs.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/text.h"
#include "run/catalogue.h"
#include "store/build.h"

/* Endings of source, and the verb that compiles each. */
static const struct {
    const char *ending, *verb;
} languages[] = {{".c", "cc"},    {".cc", "c++"},  {".cpp", "c++"}, {".cxx", "c++"},
                 {".C", "c++"},   {".f", "f90"},   {".F", "f90"},   {".f90", "f90"},
                 {".F90", "f90"}, {".f95", "f90"}, {".f03", "f90"}, {".f08", "f90"}};

/* -g: crashes are told by function and line. As people compile for speed, with lines for messages.
 * Part of the identity of a program. */
static const char flags[][8] = {"-O2", "-g"};

/* NULL: no source, so an image or a schedule. By the ending alone, as gcc chooses a language. */
static const char *verb_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot != NULL && i < sizeof languages / sizeof *languages; i++)
        if (strcmp(dot, languages[i].ending) == 0) return languages[i].verb;
    return NULL;
}

/* --- processes -------------------------------------------------------------------------------- */

/* Run argv with standard output into *out (NULL: into ours). Returns the exit status, -1: none. */
static int run_process(const char *const *argv, struct text *out)
{
    /* Standard error stays ours: the compiler's messages belong to the user. */
    int ends[2] = {-1, -1}, status = -1;
    if (out != NULL && pipe(ends) != 0) return -1;
    /* What is in our buffers would be written twice. */
    fflush(NULL);
    const pid_t pid = fork();
    if (pid == 0) {
        if (out != NULL) dup2(ends[1], STDOUT_FILENO), close(ends[0]), close(ends[1]);
        execv(argv[0], (char *const *)argv);
        _exit(127);
    }
    if (out != NULL) close(ends[1]);
    /* Read to the end before waiting: a full pipe would stop the child. */
    for (char part[4096]; out != NULL && pid > 0;) {
        const ssize_t n = read(ends[0], part, sizeof part);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) break;
        text_add_bytes(out, part, (size_t)n);
    }
    if (out != NULL) close(ends[0]);
    while (pid > 0 && waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    return pid > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* This program itself, whatever it was called as: a verb of its own is called as a process, so
 * that what people get from `mimdsim cc` and what `mimdsim run my.c` makes are the same. */
static const char *own_path(struct arena *a)
{
    char path[4096];
    const ssize_t n = readlink("/proc/self/exe", path, sizeof path - 1);
    path[n > 0 ? n : 0] = '\0';
    return arena_text(a, path);
}

/* --- what identifies a source ----------------------------------------------------------------- */

/* By content and not by name or date: a copy elsewhere is the same program. The content of one file
 * into the digest's text. */
static bool add_file(struct text *all, const char *path, struct err *e)
{
    struct text file = {0};
    char hash[65];
    if (!text_read_file(&file, path, e)) return false;
    digest_sha256_hex(file.s, file.length, hash);
    text_add(all, "%s\n", hash);
    text_free(&file);
    return true;
}

/* The files of a rule of make, "x.o: x.c a.h \\\n b.h", in its order; spaces in names are
 * escaped. */
static bool add_files(struct text *all, const char *rule, struct err *e)
{
    const char *s = strchr(rule, ':');
    char name[4096];
    for (s = s != NULL ? s + 1 : ""; *s != '\0';) {
        /* One name up to a blank; a backslash before a line's end continues the rule. */
        size_t n = 0;
        while (*s == ' ' || *s == '\n' || (*s == '\\' && s[1] == '\n')) s++;
        while (*s != '\0' && *s != ' ' && *s != '\n' && n < sizeof name - 1) {
            if (*s == '\\' && s[1] == '\n') break;
            if (*s == '\\' && s[1] != '\0') s++;
            name[n++] = *s++;
        }
        name[n] = '\0';
        if (n > 0 && !add_file(all, name, e)) return false;
    }
    return true;
}

/* Compiler, flags and the content of the source with all headers of its own, system headers left
 * out: the same text gives the same runs wherever it lies. */
static bool identify(const char *self, const char *verb, const char *path, char hash[65],
                     struct err *e)
{
    struct text all = {0}, said = {0};
    const char *const version[] = {self, verb, "-dumpfullversion", NULL};
    const char *const headers[] = {self, verb, "-MM", path, NULL};
    text_add(&all, "mimdsim %s ", verb);
    /* The compiler's version first: another one may count other operations. */
    bool fine = run_process(version, &said) == 0;
    text_add(&all, "%s", said.s != NULL ? said.s : "");
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) text_add(&all, "%s\n", flags[i]);
    said.length = 0;
    /* gfortran has no -MM: then the file alone identifies the program. */
    if (fine) fine = strcmp(verb, "f90") == 0 || run_process(headers, &said) == 0;
    if (!fine) err_set_at(e, ERR_DATA, path, 0, "the program does not compile");
    if (fine) fine = said.length > 0 ? add_files(&all, said.s, e) : add_file(&all, path, e);
    if (fine) digest_sha256_hex(all.s, all.length, hash);
    text_free(&all);
    text_free(&said);
    return fine;
}

/* --- the cache -------------------------------------------------------------------------------- */

/* $XDG_CACHE_HOME/mimdsim/programs, made where it is missing. */
static const char *cache_folder(struct arena *a, struct err *e)
{
    const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    struct text t = {0};
    /* The XDG base directory specification: a relative path there is ignored. */
    const bool given = cache != NULL && cache[0] == '/', at_home = home != NULL && home[0] == '/';
    if (!given && !at_home) {
        err_set(e, ERR_CONFIG,
                "no folder to keep compiled programs in: neither XDG_CACHE_HOME nor HOME is set to "
                "one");
        return NULL;
    }
    text_add(&t, "%s%s/mimdsim/programs", given ? cache : home, given ? "" : "/.cache");
    /* Each folder on the way; those that are there already are no failure. */
    for (char *slash = strchr(t.s + 1, '/');; slash = strchr(slash + 1, '/')) {
        if (slash != NULL) *slash = '\0';
        if (mkdir(t.s, 0700) != 0 && errno != EEXIST) {
            err_set(e, ERR_CREATE, "the cache of programs cannot be made: %s: %s", t.s,
                    strerror(errno));
            text_free(&t);
            return NULL;
        }
        if (slash == NULL) break;
        *slash = '/';
    }
    const char *folder = arena_text(a, t.s);
    text_free(&t);
    return folder;
}

/* Code of others is not run because it lies in our cache. */
static bool is_ours(const char *path)
{
    struct stat info;
    return lstat(path, &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == geteuid() &&
           (info.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

/* Compiled beside its place and then moved there: whoever looks finds all of it or nothing. A
 * process that is killed on the way leaves a file that nobody takes for an image. */
static bool compile(const char *self, const char *verb, const char *path, const char *image,
                    struct err *e)
{
    struct text part = {0};
    text_add(&part, "%s.XXXXXX", image);
    const int fd = mkstemp(part.s);
    if (fd < 0) {
        err_set(e, ERR_CREATE, "%s: %s", part.s, strerror(errno));
        text_free(&part);
        return false;
    }
    close(fd);
    const char *const argv[] = {self, verb, flags[0], flags[1], "-o", part.s, path, NULL};
    bool fine = run_process(argv, NULL) == 0;
    if (!fine) err_set_at(e, ERR_DATA, path, 0, "the program does not compile");
    else if (chmod(part.s, 0700) != 0 || rename(part.s, image) != 0)
        fine = err_set(e, ERR_CREATE, "%s: %s", image, strerror(errno));
    if (!fine) unlink(part.s);
    text_free(&part);
    return fine;
}

/* The image of a source; `hash` is what identifies the source. */
static const char *image_of(const char *path, const char *verb, char hash[65], struct arena *a,
                            struct err *e)
{
    const char *self = own_path(a), *folder = cache_folder(a, e);
    const struct build build = store_build();
    char key[65];
    struct text t = {0};
    if (folder == NULL || !identify(self, verb, path, hash, e)) return NULL;
    /* Another build of this program may link other functions into it. */
    text_add(&t, "%s %s %s", hash, build.version, build.git);
    struct stat info;
    if (stat(self, &info) == 0)
        text_add(&t, " %lld %lld", (long long)info.st_mtime, (long long)info.st_size);
    digest_sha256_hex(t.s, t.length, key);
    t.length = 0;
    text_add(&t, "%s/%s.so", folder, key);
    const char *image = arena_text(a, t.s);
    text_free(&t);
    return is_ours(image) || compile(self, verb, path, image, e) ? image : NULL;
}

/* Opened by the plan for every program that a scenario names; an image is taken as it is. */
const struct program_sheet *programs_sheet(void *context, const char *path, struct arena *a,
                                           struct err *e)
{
    const char *verb = verb_of(path), *image = path;
    char hash[65] = "";
    (void)context;
    if (verb != NULL) image = image_of(path, verb, hash, a, e);
    return image != NULL ? run_sheet(image, path, hash, a, e) : NULL;
}

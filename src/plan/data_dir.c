/* data_dir.c - machines/ and scenarios/ beside the build tree's binary, installed, or the user's
 * own.
 *
 * What was found is remembered in the environment as MIMDSIM_DATA, so that programs started from
 * here look in the same place.
 *
 * A name without a slash and without .yaml is looked up in these folders, anything else is a
 * path. So, on the command line, a file in the working directory cannot take the place of a
 * shipped one by its name alone. */
#include "plan/data_dir.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "plan/plan.h"

/* Longer paths of the folders of data are not found; more files of one kind are not listed. */
enum { PATH_LENGTH = 1024, MAX_NAMES = 4096 };

/* Whether `dir` is such a folder: it has both. */
static bool holds_data(const char *dir)
{
    char path[PATH_LENGTH + 16];
    snprintf(path, sizeof path, "%s/machines", dir);
    if (access(path, R_OK | X_OK) != 0) return false;
    snprintf(path, sizeof path, "%s/scenarios", dir);
    return access(path, R_OK | X_OK) == 0;
}

/* The running binary's folder or one or two above it (src/mimdsim of a build in or below the source
 * tree). */
static bool beside_binary(char dir[PATH_LENGTH])
{
    ssize_t n = readlink("/proc/self/exe", dir, PATH_LENGTH - 1);
    if (n <= 0) return false;
    dir[n] = '\0';
    for (int up = 0; up < 3; up++) {
        char *slash = strrchr(dir, '/');
        if (slash == NULL || slash == dir) return false;
        *slash = '\0';
        if (holds_data(dir)) return true;
    }
    return false;
}

/* Found once per process: the environment has it from then on. The folder exists when this
 * program was built or installed, so there is no error. */
const char *plan_data_dir(void)
{
    char dir[PATH_LENGTH];
    const char *given = getenv("MIMDSIM_DATA");
    if (given != NULL && given[0] != '\0') return given;
    /* Order: the environment, beside the binary, the source tree that it was built from,
     * installed. */
    const char *found = MIMDSIM_DATADIR;
    if (beside_binary(dir)) found = dir;
    else if (holds_data(MIMDSIM_SRCDIR)) found = MIMDSIM_SRCDIR;
    setenv("MIMDSIM_DATA", found, 1);
    /* The environment owns the text: `dir` ends with this function. */
    const char *kept = getenv("MIMDSIM_DATA");
    return kept != NULL ? kept : MIMDSIM_DATADIR;
}

/* $XDG_DATA_HOME/mimdsim or its usual place; "" without a home. */
static void user_dir(char *dir, size_t size)
{
    const char *xdg = getenv("XDG_DATA_HOME"), *home = getenv("HOME");
    dir[0] = '\0';
    /* The XDG base directory specification: a relative path there is ignored. */
    if (xdg != NULL && xdg[0] == '/') snprintf(dir, size, "%s/mimdsim", xdg);
    else if (home != NULL && home[0] == '/') snprintf(dir, size, "%s/.local/share/mimdsim", home);
}

/* By its form: whether there is such a file does not matter. */
static bool is_path(const char *name)
{
    size_t n = strlen(name);
    return strchr(name, '/') != NULL || (n > 5 && strcmp(name + n - 5, ".yaml") == 0) ||
           (n > 4 && strcmp(name + n - 4, ".yml") == 0);
}

const char *data_dir_of(const char *path, struct arena *a)
{
    const char *slash = strrchr(path, '/');
    if (slash == NULL) return "";
    char *dir = arena_text(a, path);
    dir[slash == path ? 1 : slash - path] = '\0';
    return dir;
}

/* What a scenario or a machine is called: its file without folder and ending. */
const char *data_dir_stem(const char *path, struct arena *a)
{
    const char *slash = strrchr(path, '/');
    char *stem = arena_text(a, slash != NULL ? slash + 1 : path);
    /* only these endings: "a.b" is the stem of a.b.yaml */
    char *dot = strrchr(stem, '.');
    if (dot != NULL && dot != stem && (strcmp(dot, ".yaml") == 0 || strcmp(dot, ".yml") == 0))
        *dot = '\0';
    return stem;
}

/* DIR/[WHAT/]NAME[.yaml] when it is there, in `a`; `dir` "" is the working directory. */
static const char *probe(const char *dir, const char *what, const char *name, const char *ending,
                         struct arena *a)
{
    struct text path = {0};
    /* Both slashes only where something stands before them. */
    text_add(&path, "%s%s%s%s%s%s", dir, dir[0] != '\0' ? "/" : "", what,
             what[0] != '\0' ? "/" : "", name, ending);
    const char *found = access(path.s, F_OK) == 0 ? arena_text(a, path.s) : NULL;
    /* For who tells why nothing was found. */
    const int reason = errno;
    text_free(&path);
    errno = reason;
    return found;
}

/* The name of a file in WHAT/ that `name` may have meant, NULL when none is near; `name` itself
 * when there is one. */
static const char *nearest_name(const char *what, const char *name, struct arena *a)
{
    int n;
    const char **names = data_dir_names(what, a, &n);
    return text_nearest(name, names, n);
}

/* A path: beside the file that names it (`near`), or from the working directory on the command
 * line. */
static const char *find_path(const char *what, const char *name, const char *near, struct arena *a,
                             struct err *e)
{
    errno = 0;
    const char *path = name[0] == '/' || near == NULL ? NULL : probe(near, "", name, "", a);
    if (path == NULL && (name[0] == '/' || near == NULL || near[0] == '\0'))
        path = probe("", "", name, "", a);
    if (path != NULL) return path;
    /* Too long, or a folder that may not be entered: "no file" would be wrong. */
    if (errno != 0 && errno != ENOENT && errno != ENOTDIR) {
        err_set(e, ERR_NO_INPUT, "cannot open '%s': %s", name, strerror(errno));
        return NULL;
    }
    /* Perhaps the name of a shipped file was meant. */
    const char *meant = nearest_name(what, data_dir_stem(name, a), a);
    if (meant == NULL) err_set(e, ERR_NO_INPUT, "no file '%s'", name);
    else
        err_set(e, ERR_NO_INPUT, "no file '%s'; did you mean '%s', the %.*s of that name?", name,
                meant, (int)strlen(what) - 1, what);
    return NULL;
}

/* Why `name` was not found. A file of that name in the working directory is the usual reason. */
static void not_found(const char *what, const char *name, struct arena *a, struct err *e)
{
    const char *near = nearest_name(what, name, a);
    int singular = (int)strlen(what) - 1;
    if (name[0] != '\0' && access(name, F_OK) == 0)
        err_set(e, ERR_NO_INPUT, "no %.*s '%s'; to mean the file or folder here write './%s', and "
                                 "a %.*s ends in .yaml",
                singular, what, name, name, singular, what);
    else if (near != NULL)
        err_set(e, ERR_NO_INPUT, "no %.*s '%s'; did you mean '%s'?", singular, what, name, near);
    else
        err_set(e, ERR_NO_INPUT, "no %.*s '%s' in %s/%s; `mimdsim %s` lists them", singular, what,
                name, plan_data_dir(), what, what);
}

/* The file that `name` means, or NULL with *e set: what is near, and which verb lists what there
 * is. */
const char *data_dir_find(const char *what, const char *name, const char *near, struct arena *a,
                          struct err *e)
{
    char user[PATH_LENGTH];
    if (is_path(name)) return find_path(what, name, near, a, e);
    /* A name: beside the file that names it, shipped, then the user's own. Shipped names cannot
     * be replaced. */
    const char *path = near != NULL && name[0] != '\0' ? probe(near, "", name, ".yaml", a) : NULL;
    if (path == NULL && name[0] != '\0') path = probe(plan_data_dir(), what, name, ".yaml", a);
    user_dir(user, sizeof user);
    if (path == NULL && user[0] != '\0' && name[0] != '\0')
        path = probe(user, what, name, ".yaml", a);
    if (path == NULL) not_found(what, name, a, e);
    return path;
}

/* For qsort. */
static int compare_names(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Add the stems of DIR/WHAT to names[0 .. n-1]; returns the new number. */
static int add_names(const char *dir, const char *what, const char **names, int n, struct arena *a)
{
    char path[2 * PATH_LENGTH];
    if (snprintf(path, sizeof path, "%s/%s", dir, what) >= (int)sizeof path) return n;
    /* figures are queries */
    const char *ending = strcmp(what, "plots") == 0 ? ".sql" : ".yaml";
    DIR *d = opendir(path);
    if (d == NULL) return n;
    for (struct dirent *entry; n < MAX_NAMES && (entry = readdir(d)) != NULL;) {
        size_t length = strlen(entry->d_name);
        size_t end = strlen(ending);
        /* Hidden files, and what is no file of this kind. */
        if (entry->d_name[0] == '.' || length <= end ||
            strcmp(entry->d_name + length - end, ending) != 0)
            continue;
        char *stem = arena_text(a, entry->d_name);
        stem[length - end] = '\0';
        names[n++] = stem;
    }
    closedir(d);
    return n;
}

const char **data_dir_names(const char *what, struct arena *a, int *n)
{
    char user[PATH_LENGTH];
    /* Shipped and own names together, sorted, each once. */
    const char **names = TAKE(a, MAX_NAMES, const char *);
    int count = add_names(plan_data_dir(), what, names, 0, a), kept = 0;
    user_dir(user, sizeof user);
    if (user[0] != '\0') count = add_names(user, what, names, count, a);
    qsort(names, (size_t)count, sizeof *names, compare_names);
    for (int i = 0; i < count; i++)
        if (kept == 0 || strcmp(names[kept - 1], names[i]) != 0) names[kept++] = names[i];
    *n = kept;
    return names;
}

/* A scenario names figures before any is drawn: a misspelt name is told with its line. */
bool data_dir_has_figure(const char *name, const char *file, int line, struct arena *a,
                         struct err *e)
{
    int n;
    /* Mostly it is one that is shipped, and the folder need not be read for it. */
    const bool plain = name[0] != '\0' && name[0] != '.' && strchr(name, '/') == NULL;
    if (plain && probe(plan_data_dir(), "plots", name, ".sql", a) != NULL) return true;
    const char **names = data_dir_names("plots", a, &n);
    for (int i = 0; i < n; i++)
        if (strcmp(names[i], name) == 0) return true;
    return err_set_at(e, ERR_DATA, file, line, "no figure '%.80s'%s; `mimdsim plot` lists them",
                      name, text_hint(name, names, n, "").s);
}

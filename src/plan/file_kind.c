/* file_kind.c - see file_kind.h. Content decides, not the ending, save for robots and cases,
 * which other rooms read.
 *
 * It is asked after something went wrong: a user who gives a database where a scenario belongs
 * is told what the file is, and which verb takes it. */
#include "plan/file_kind.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/text.h"
#include "plan/data_dir.h"
#include "io/document.h"

static bool ends_with(const char *name, const char *ending)
{
    size_t n = strlen(name), m = strlen(ending);
    return n > m && strcmp(name + n - m, ending) == 0;
}

/* The first 16 bytes of a file of SQLite, with the zero at their end
 * (sqlite.org/fileformat2.html, 1.3). */
static bool is_database(const char *path)
{
    char head[16] = "";
    struct err unread = {0};
    FILE *f = text_open_file(path, &unread);
    bool yes = f != NULL && fread(head, 1, sizeof head, f) == sizeof head &&
               memcmp(head, "SQLite format 3", 16) == 0;
    if (f != NULL) fclose(f);
    return yes;
}

/* Whether the file has any of these keys at its top. */
static bool has_any(const struct node *root, const char *const *key, int n)
{
    for (int i = 0; i < n; i++)
        if (document_find(root, key[i]) != NULL) return true;
    return false;
}

/* A machine file describes a machine and asks no question. One with keys of both is told of the key
 * that is wrong. */
enum file_kind file_kind_of_tree(const struct node *root)
{
    static const char *const scenario_keys[] = {"question", "machine", "kernel",
                                                "ranks",    "sweep",   "model"};
    static const char *const machine_keys[] = {"topology", "network", "node",
                                               "software", "base",    "title"};
    if (root == NULL || root->kind != NODE_MAP) return FILE_UNKNOWN;
    bool asks = has_any(root, scenario_keys, 6), describes = has_any(root, machine_keys, 6);
    /* Keys of neither, or of both: no guess. */
    if (asks == describes) return FILE_UNKNOWN;
    return asks ? FILE_SCENARIO : FILE_MACHINE;
}

/* Whether a shipped or own file has this name. */
static bool is_stem_of(const char *what, const char *name, struct arena *a)
{
    int n;
    const char **names = data_dir_names(what, a, &n);
    for (int i = 0; i < n; i++)
        if (strcmp(names[i], name) == 0) return true;
    return false;
}

/* A name may be a file or that of a shipped scenario or machine. */
enum file_kind file_kind_of(const char *name, struct arena *a)
{
    struct stat info;
    struct err ignored;
    err_clear(&ignored);
    /* A file first: a path is more than a name. Then names of scenarios, then of machines. */
    if (stat(name, &info) == 0 && S_ISREG(info.st_mode)) {
        if (is_database(name)) return FILE_DATABASE;
        if (ends_with(name, ".urdf")) return FILE_ROBOT;
        if (ends_with(name, ".json")) return FILE_CASES;
        if (ends_with(name, ".yaml") || ends_with(name, ".yml"))
            return file_kind_of_tree(document_read_settings(name, a, &ignored));
    }
    if (is_stem_of("scenarios", name, a)) return FILE_SCENARIO;
    return is_stem_of("machines", name, a) ? FILE_MACHINE : FILE_UNKNOWN;
}

/* Replaces *e by what the file is and what to do with it; true when it did. */
bool file_kind_refuse(const char *name, enum file_kind wanted, struct err *e)
{
    /* "X is a machine, not a scenario" */
    static const char *const word[] = {
        [FILE_SCENARIO] = "a scenario",
        [FILE_MACHINE] = "a machine",
        [FILE_DATABASE] = "a database",
        [FILE_ROBOT] = "a robot",
        [FILE_CASES] = "a file of reference cases",
    };
    struct arena *a = arena_create();
    enum file_kind kind = file_kind_of(name, a);
    arena_destroy(a);
    /* The file is what it should be, or nobody knows: then the first error stands. */
    if (kind == FILE_UNKNOWN || kind == wanted) return false;
    err_clear(e);
    struct text use = {0};
    /* The command that takes such a file. */
    if (kind == FILE_SCENARIO) text_add(&use, "`mimdsim run %s` runs it", name);
    if (kind == FILE_MACHINE)
        text_add(&use,
                 "`mimdsim machines %s` shows it, `mimdsim run SCENARIO --machine %s` uses it",
                 name, name);
    if (kind == FILE_DATABASE)
        text_add(&use,
                 "`mimdsim plot %s` lists the figures that can be drawn from it, `mimdsim run "
                       "SCENARIO -o %s` adds to it", name,
                 name);
    if (kind == FILE_ROBOT)
        text_add(&use, "a scenario names it by `model: {generator: urdf, path: %s}`", name);
    if (kind == FILE_CASES)
        text_add(&use, "`mimdsim verify %s` or `mimdsim netcheck %s` takes it", name, name);
    err_set(e, ERR_USAGE, "%s is %s, not %s: %s", name, word[kind], word[wanted], use.s);
    text_free(&use);
    return true;
}

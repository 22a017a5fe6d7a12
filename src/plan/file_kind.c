/* file_kind.c - see file_kind.h. Content decides, not the ending, save for robots and cases, which
 * other rooms read. */
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

static bool is_database(const char *path)
{
    char head[16] = "";
    FILE *f = fopen(path, "rb");
    bool yes = f != NULL && fread(head, 1, sizeof head, f) == sizeof head &&
               memcmp(head, "SQLite format 3", 16) == 0;
    if (f != NULL) fclose(f);
    return yes;
}

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
    if (asks == describes) return FILE_UNKNOWN;
    return asks ? FILE_SCENARIO : FILE_MACHINE;
}

static bool is_stem_of(const char *what, const char *name, struct arena *a)
{
    int n;
    const char **names = data_dir_names(what, a, &n);
    for (int i = 0; i < n; i++)
        if (strcmp(names[i], name) == 0) return true;
    return false;
}

enum file_kind file_kind_of(const char *name, struct arena *a)
{
    struct stat info;
    struct err ignored;
    err_clear(&ignored);
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

bool file_kind_refuse(const char *name, enum file_kind wanted, struct err *e)
{
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
    if (kind == FILE_UNKNOWN || kind == wanted) return false;
    err_clear(e);
    struct text use = {0};
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

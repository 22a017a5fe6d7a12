/* cmd_programs.c - mimdsim programs: what can be run: built in, as an example, and in this folder.
 */
#include <dirent.h>
#include <stdlib.h>
#include <string.h>

#include "app/verb.h"
#include "base/arena.h"
#include "base/text.h"

static const char doc[] =
    "List the programs there are: those built in (`kernel: NAME` in a scenario), the examples with "
    "their source, and the programs of your own in this folder (`program: FILE`).\n\n"
    "Example: mimdsim programs\n"
    "\vNothing is compiled or loaded: titles are read from the sources.";

/* What is found, in the order in which it is shown; all texts in the arena. */
struct list {
    struct arena *arena;
    int n, capacity;
    const char **name, **title, **where;
};

/* The arena gives nothing back, but doubling keeps what is lost below what is used. */
static void add(struct list *l, const char *name, const char *title, const char *where)
{
    if (l->n == l->capacity) {
        const int capacity = 2 * l->capacity + 64;
        const char **place[3] = {l->name, l->title, l->where};
        for (int i = 0; i < 3; i++) {
            const char **larger = TAKE(l->arena, capacity, const char *);
            if (l->n > 0) memcpy(larger, place[i], (size_t)l->n * sizeof *larger);
            place[i] = larger;
        }
        l->name = place[0], l->title = place[1], l->where = place[2];
        l->capacity = capacity;
    }
    l->name[l->n] = name, l->title[l->n] = title, l->where[l->n] = where;
    l->n++;
}

/* What stands between the quotes after `.title =` of a source that declares a program; NULL: it
 * declares none. A title that is made of several pieces is told as far as the first. */
static const char *title_of(const char *path, struct arena *a)
{
    struct text source = {0};
    struct err ignored;
    const char *title = NULL;
    err_clear(&ignored);
    if (text_read_file(&source, path, &ignored) && strstr(source.s, "mimdsim/program.h") != NULL &&
        strstr(source.s, "PROGRAM(") != NULL) {
        const char *at = strstr(source.s, ".title"), *quote = at != NULL ? strchr(at, '"') : NULL;
        char *copy = arena_text(a, quote != NULL ? quote + 1 : "");
        copy[strcspn(copy, "\"\n")] = '\0';
        title = copy;
    }
    text_free(&source);
    return title;
}

/* Languages in which program.h can be included. Sources with main are not told apart from any other
 * file, so they are not listed. */
static int is_source(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return dot != NULL &&
           (strcmp(dot, ".c") == 0 || strcmp(dot, ".cc") == 0 || strcmp(dot, ".cpp") == 0);
}

/* The sources of a folder that declare programs; `show`: with the folder before their names. */
static void add_folder(struct list *l, const char *folder, bool show, const char *where)
{
    struct dirent **entry;
    /* Sorted, so that the list is the same in any file system; a folder that is not there has none.
     */
    const int n = scandir(folder, &entry, is_source, alphasort);
    for (int i = 0; i < n; i++) {
        struct text path = {0};
        text_add(&path, "%s/%s", folder, entry[i]->d_name);
        const char *title = title_of(path.s, l->arena);
        if (title != NULL)
            add(l, arena_text(l->arena, show ? path.s : entry[i]->d_name), title, where);
        text_free(&path);
        free(entry[i]);
    }
    if (n >= 0) free(entry);
}

/* For people: a heading where the kind of place changes. */
static void print_text(const struct list *l)
{
    for (int i = 0; i < l->n; i++) {
        if (i == 0 || strcmp(l->where[i], l->where[i - 1]) != 0)
            printf("%s%s:\n", i > 0 ? "\n" : "", l->where[i]);
        printf("  %-20s %s\n", l->name[i], l->title[i]);
    }
}

/* For programs: one flat list, each row with its place. */
static void print_json(const struct list *l)
{
    struct json j = json_make(stdout);
    json_array(&j);
    for (int i = 0; i < l->n; i++) {
        json_object(&j);
        json_key_text(&j, "name", l->name[i]);
        json_key_text(&j, "title", l->title[i]);
        json_key_text(&j, "where", l->where[i]);
        json_end(&j);
    }
    json_end(&j);
    json_finish(&j);
}

/* Built-in programs first: they need no file. The other two are found by looking into sources,
 * never by loading them. */
int cmd_programs(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, 0, "", doc, 0, 0);
    struct list l = {.arena = arena_create()};
    const struct catalogue k = catalogue_of_kernels();
    for (int i = 0; i < k.n; i++) add(&l, k.name[i], k.title[i], "built in");
    struct text examples = {0};
    text_add(&examples, "%s/examples", plan_data_dir());
    /* Examples with their folder: that is what `program:` and `mimdsim run` take. */
    add_folder(&l, examples.s, true, "examples");
    add_folder(&l, ".", false, "yours, in this folder");
    if (c.json) print_json(&l);
    else print_text(&l);
    text_free(&examples);
    arena_destroy(l.arena);
    return 0;
}

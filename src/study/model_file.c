/* model_file.c - robots and reference vectors looked at without running (model_file.h). */
#include "study/model_file.h"

#include <string.h>

#include "base/arena.h"
#include "base/text.h"
#include "model/urdf_model.h"
#include "model/vector_model.h"

/* Kinds of files are told by their names, as the user writes them. */
static bool ends_in(const char *path, const char *end)
{
    const size_t n = strlen(path), m = strlen(end);
    return n >= m && strcmp(path + n - m, end) == 0;
}

/* Whether `word` stands in the first bytes of the file. */
static bool begins_with(const char *path, const char *word)
{
    /* A scenario in JSON says schema_version near its top; 4 KiB are enough for it. */
    char head[4096];
    struct err unread = {0};
    FILE *file = text_open_file(path, &unread);
    if (!file) return false;
    /* A shorter file is read as far as it goes. */
    head[fread(head, 1, sizeof head - 1, file)] = '\0';
    fclose(file);
    return strstr(head, word) != NULL;
}

bool model_file_is(const char *path)
{
    /* A .json file is a reference vector unless it is a scenario. */
    return ends_in(path, ".urdf") ||
           (ends_in(path, ".json") && !begins_with(path, "schema_version"));
}

/* warnings NULL: the caller wants none. */
static void print_warnings(const struct urdf_robot *robot, FILE *out)
{
    for (int i = 0; out && i < robot->nwarning; i++)
        fprintf(out, "mimdsim: %s:%d: warning: %s\n", robot->path, robot->warning[i].line,
                robot->warning[i].text);
}

/* A robot must be read and become a model: joints that form no tree show up only in the second
 * step. Gravity is any; the base is fixed. */
static bool check_robot(const char *path, FILE *warnings, struct arena *a, struct err *e)
{
    const struct urdf_options fixed = {.gravity = {0, 0, -9.81}};
    struct urdf_robot robot;
    if (!urdf_read(path, &robot, a, e)) return false;
    print_warnings(&robot, warnings);
    return urdf_model(&robot, &fixed, a, e) != NULL;
}

/* The same two steps for a reference vector. */
static bool check_vector(const char *path, struct arena *a, struct err *e)
{
    struct vector_case c;
    return vector_read(path, &c, a, e) && vector_model(&c, a, e) != NULL;
}

/* Reads and builds the model, and throws it away. */
bool model_file_check(const char *path, FILE *warnings, struct err *e)
{
    struct arena *a = arena_create();
    /* the arena dies with the check: only the verdict and the warnings leave it */
    const bool fine =
        ends_in(path, ".urdf") ? check_robot(path, warnings, a, e) : check_vector(path, a, e);
    arena_destroy(a);
    return fine;
}

/* Whether an earlier run has the same file: a sweep of 100 runs warns once. */
static bool seen(const struct run_spec *run, int i)
{
    for (int k = 0; k < i; k++)
        if (run[k].model.generator == MODEL_URDF &&
            strcmp(run[k].model.path, run[i].model.path) == 0)
            return true;
    return false;
}

/* Before the first run: a campaign of hours should not end at a file that cannot be read. */
bool model_file_look(const struct run_spec *run, int n, FILE *warnings, struct err *e)
{
    bool fine = true;
    for (int i = 0; i < n && fine; i++) {
        if (run[i].model.generator != MODEL_URDF || (i > 0 && seen(run, i))) continue;
        /* An arena of each file's own: nothing of the robot is kept. */
        struct arena *a = arena_create();
        struct urdf_robot robot;
        fine = urdf_read(run[i].model.path, &robot, a, e);
        if (fine) print_warnings(&robot, warnings);
        arena_destroy(a);
    }
    return fine;
}

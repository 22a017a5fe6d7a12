/* cmd_new.c - mimdsim new: a parallel program to begin with, and its scenario. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/verb.h"
#include "base/new_file.h"
#include "base/text.h"

static const char doc[] =
    "Write NAME.c, a small parallel program with everything it needs, and NAME.yaml, a scenario "
    "that runs it on three machines.\n\n"
    "Example: mimdsim new heat\n"
    "\vThe program compiles and runs as it is (`mimdsim run NAME.c`); its comments say what to "
    "change. Files that are there already are never overwritten. docs/own-program.md is the guide.";

/* A name that can be a file's in any folder, a word in a database and a title in a figure. No
 * slash: a program belongs into the folder where its author is, and beside its scenario. */
static bool is_name(const char *s)
{
    const size_t n = strlen(s);
    if (n == 0 || n > 24 || !isalpha((unsigned char)s[0])) return false;
    for (; *s != '\0'; s++)
        if (!isalnum((unsigned char)*s) && *s != '-' && *s != '_') return false;
    return true;
}

/* The template with the name in the place of every @NAME@. One mark only, so that nothing else of a
 * program can be taken for one. */
static void fill(struct text *out, const char *template, const char *name)
{
    static const char mark[] = "@NAME@";
    for (const char *s = template, *at; *s != '\0'; s = at + (*at != '\0' ? sizeof mark - 1 : 0)) {
        at = strstr(s, mark);
        if (at == NULL) at = s + strlen(s);
        text_add_bytes(out, s, (size_t)(at - s));
        if (*at != '\0') text_add(out, "%s", name);
    }
}

/* The template lies in the data folder, where whoever teaches may put another one. */
static bool make_file(const char *name, const char *ending, struct err *e)
{
    struct text path = {0}, template = {0}, content = {0};
    text_add(&path, "%s/templates/program%s", plan_data_dir(), ending);
    /* A template without marks is taken as it is. */
    bool fine = text_read_file(&template, path.s, e);
    if (fine) fill(&content, template.s, name);
    path.length = 0;
    text_add(&path, "%s%s", name, ending);
    fine = fine && new_file_write(path.s, &content, e);
    text_free(&path);
    text_free(&template);
    text_free(&content);
    return fine;
}

/* Both or neither: who runs the verb again after a mistake finds the folder as it was. */
static bool make_both(const char *name, struct err *e)
{
    struct text scenario = {0}, source = {0};
    text_add(&source, "%s.c", name);
    text_add(&scenario, "%s.yaml", name);
    /* The second file is looked for first: a source without its scenario would be half a start. */
    bool fine = access(scenario.s, F_OK) != 0 ||
                err_set(e, ERR_CREATE, "%s is there already; choose another name, or move it away",
                        scenario.s);
    fine = fine && make_file(name, ".c", e);
    /* The scenario failed: its program, made a moment ago, goes with it. */
    if (fine && !make_file(name, ".yaml", e)) {
        unlink(source.s);
        fine = false;
    }
    text_free(&source);
    text_free(&scenario);
    return fine;
}

/* What was written, and what to do next: who runs this verb has read nothing yet. */
int cmd_new(int argc, char **argv)
{
    struct common c;
    struct err e;
    err_clear(&e);
    common_parse(&c, argc, argv, 0, "NAME", doc, 1, 1);
    const char *name = c.arg[0];
    bool fine =
        is_name(name) ||
        err_set(
            &e, ERR_USAGE,
            "'%.60s' is not a name; expected letters, digits, - and _, at most 24, a letter first",
            name);
    fine = fine && make_both(name, &e);
    if (!fine) return common_fail(&c, &e);
    if (!c.quiet)
        printf("%s.c     a parallel program: read its comments, change it, run it by `mimdsim run "
               "%s.c`\n"
               "%s.yaml  a scenario: `mimdsim run %s.yaml` runs it on three machines,\n"
               "%*s        `mimdsim plot mimdsim.db speedup` draws its speedup\n",
               name, name, name, name, (int)strlen(name) - 2, "");
    return 0;
}

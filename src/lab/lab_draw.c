/* lab_draw.c - the picture of an attempt: its timeline, or a curve over what the lab varies.
 *
 * Both are drawn by commands of this program that the student knows, with the options of the lab:
 * what they say of a program that does not run, or of a missing gnuplot, is said here as well. */
#include <string.h>
#include <unistd.h>

#include "base/process.h"
#include "lab/lab.h"

enum { MOST_WORDS = 24 };

/* A command of this program, in a process of its own, as the student would type it. */
struct command {
    const char *word[MOST_WORDS];
    int n;
};

/* The array ends with NULL; there are fewer words than places, whatever a lab sets (LAB_SETS). */
static void add(struct command *c, const char *word)
{
    if (c->n < MOST_WORDS - 1) c->word[c->n++] = word;
}

/* An option with its value, where the lab gives one. */
static void add_pair(struct command *c, const char *option, const char *value)
{
    if (value[0] == '\0') return;
    add(c, option);
    add(c, value);
}

/* What it prints on standard output is not the student's question here; its messages are shown. */
static bool start(struct command *c, int *status, struct err *e)
{
    struct text unused = {0};
    const bool ok = process_run(c->word, NULL, &unused, status, e);
    text_free(&unused);
    return ok;
}

/* A file of the attempt. */
static const char *in_folder(const char *folder, const char *file, struct arena *a)
{
    struct text t = {0};
    text_add(&t, "%s/%s", folder, file);
    const char *path = arena_text(a, t.s);
    text_free(&t);
    return path;
}

/* Who does what when, in the scenario's first run. */
static bool draw_timeline(const char *folder, const char *scenario, int *status, struct err *e)
{
    struct command c = {{"/proc/self/exe", "timeline", scenario, "--format", "picture", "--quiet"},
                        6};
    add_pair(&c, "--dir", folder);
    return start(&c, status, e);
}

/* A curve: all runs of the sweep, and then the figure of them. */
static bool draw_curve(const struct lab_picture *p, const char *folder, const char *scenario,
                       int *status, struct arena *a, struct err *e)
{
    const char *database = in_folder(folder, "picture.db", a);
    struct command run = {{"/proc/self/exe", "run", scenario, "--quiet", "-o", database}, 6};
    for (int i = 0; i < p->nset; i++) add_pair(&run, "--set", p->set[i]);
    /* Runs of an earlier version of the program would be drawn with the others. */
    unlink(database);
    if (!start(&run, status, e) || *status != 0) return e->kind == ERR_NONE;
    struct command plot = {{"/proc/self/exe", "plot", database, "--quiet", "--as", "picture"}, 6};
    add_pair(&plot, "--x", p->x);
    add_pair(&plot, "--y", p->y);
    add_pair(&plot, "--by", p->by);
    add_pair(&plot, "--dir", folder);
    return start(&plot, status, e);
}

bool lab_draw(const char *folder, const char **file, int *status, struct arena *a, struct err *e)
{
    struct lab l;
    const struct node *answers;
    if (!lab_attempt(&l, folder, &answers, a, e)) return false;
    /* A lab that varies something shows what that changes; one run is best shown as it went. */
    const bool curve = l.picture.x[0] != '\0';
    const char *scenario = in_folder(folder, "scenario.yaml", a);
    *file = in_folder(folder, curve ? "picture" : "timeline", a);
    return curve ? draw_curve(&l.picture, folder, scenario, status, a, e)
                 : draw_timeline(folder, scenario, status, e);
}

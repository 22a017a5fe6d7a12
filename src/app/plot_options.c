/* plot_options.c - see plot_options.h.
 *
 * What a column is called is not known here: the database knows. Only words that are the program's
 * own are checked. */
#include "app/plot_options.h"

#include <stdlib.h>
#include <string.h>

#include "app/flag.h"
#include "report/figure_text.h"

/* The number of `word` in a list that ends with NULL; -1 with the nearest one told. */
static int word_of(const char *option, const char *word, const char *const *list, struct err *e)
{
    /* The list is told when no word of it is near. */
    int n = 0;
    struct text all = {0};
    for (; list[n] != NULL; n++) {
        if (strcmp(list[n], word) == 0) return text_free(&all), n;
        text_add(&all, "%s%s", n > 0 ? ", " : "", list[n]);
    }
    const char *near = text_nearest(word, list, n);
    if (near != NULL)
        err_set(e, ERR_USAGE, "%s: '%.40s'; did you mean '%s'?", option, word, near);
    else err_set(e, ERR_USAGE, "%s: '%.40s'; expected one of %s", option, word, all.s);
    text_free(&all);
    return -1;
}

/* Which of the kinds of picture; the order is that of enum plot_kind. */
static bool take_kind(struct plot_request *r, const char *word, struct err *e)
{
    static const char *const kinds[] = {"auto", "lines", "bars", "heat", NULL};
    const int at = word != NULL ? word_of("--kind", word, kinds, e) : PLOT_AUTO;
    r->kind = (enum plot_kind)(at < 0 ? PLOT_AUTO : at);
    return at >= 0;
}

/* Which axes are logarithmic; without the option each is where its range asks for it. */
static bool take_log(struct plot_request *r, const char *word, struct err *e)
{
    static const char *const axes[] = {"none", "x", "y", "xy", NULL};
    if (word == NULL) return true;
    /* Two bits: x and y. */
    const int at = word_of("--log", word, axes, e);
    r->x_scale = at & 1 ? PLOT_SCALE_LOG : PLOT_SCALE_LINEAR;
    r->y_scale = at & 2 ? PLOT_SCALE_LOG : PLOT_SCALE_LINEAR;
    return at >= 0;
}

/* Every --where; all of them must hold. */
static bool take_conditions(struct plot_request *r, int *argc, char **argv, struct arena *a,
                            struct err *e)
{
    const char *text;
    while ((text = take_first_value(argc, argv, "--where")) != NULL) {
        if (r->nwhere == MOST_CONDITIONS)
            return err_set(e, ERR_USAGE, "more than %d times --where", MOST_CONDITIONS);
        if (!plot_where_parse(&r->where[r->nwhere++], text, a, e)) return false;
    }
    return true;
}

/* Words first, then what has to be read. Only --by may be empty: everything on one curve. */
bool plot_options_take(struct plot_request *r, int *argc, char **argv, bool *given, struct arena *a,
                       struct err *e)
{
    *r = (struct plot_request){0};
    const struct {
        const char *option, **place;
    } text[] = {{"--x", &r->x},         {"--y", &r->y},   {"--z", &r->z}, {"--by", &r->by},
                {"--title", &r->title}, {"--as", &r->as}};
    for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
        *text[i].place = take_value(argc, argv, text[i].option);
        if (*text[i].place != NULL && **text[i].place == '\0' &&
            strcmp(text[i].option, "--by") != 0)
            return err_set(e, ERR_USAGE, "%s: a value is missing", text[i].option);
    }
    *given = r->x != NULL || r->y != NULL || r->z != NULL;
    return take_kind(r, take_value(argc, argv, "--kind"), e) &&
           take_log(r, take_value(argc, argv, "--log"), e) && take_conditions(r, argc, argv, a, e);
}

/* "speedup-over-n", so that two requests do not write the same files. */
void plot_options_name(struct plot_request *r, const char *query_file, struct arena *a)
{
    struct text t = {0};
    if (r->as != NULL) text_add(&t, "%s", r->as);
    else if (query_file != NULL) {
        const char *slash = strrchr(query_file, '/'),
                   *stem = slash != NULL ? slash + 1 : query_file;
        text_add(&t, "%.*s", (int)(strlen(stem) - strlen(".sql")), stem);
    } else {
        text_add(&t, "%s-over-%s", r->z != NULL ? r->z : r->y != NULL ? r->y : "y",
                 r->x != NULL ? r->x : "x");
        if (r->z != NULL) text_add(&t, "-%s", r->y != NULL ? r->y : "y");
    }
    /* The name of its files holds nothing that means something in a path or to gnuplot. */
    char *name = figure_file_name(t.s, t.s);
    r->as = arena_text(a, name);
    free(name);
    text_free(&t);
}

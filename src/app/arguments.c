/* arguments.c - see arguments.h.
 *
 * People mix up what they have: a scenario where a database belongs, or both in the wrong order.
 * Each of these has a message that says what was given and writes the right command. */
#include "app/arguments.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "plan/file_kind.h"

/* Another argument than the first that is a database, 0: none is. */
static int database_behind(const struct common *c)
{
    struct arena *a = arena_create();
    int at = 0; /* 0: none, as the first argument is not looked at */
    for (int i = 1; i < c->narg && at == 0; i++)
        if (file_kind_of(c->arg[i], a) == FILE_DATABASE) at = i;
    arena_destroy(a);
    return at;
}

/* The command as it should have been written, with quotes where a shell needs them. */
static void say_order(const struct common *c, int at, struct err *e)
{
    struct text t = {0};
    text_add(&t, "%s %s", c->verb, c->arg[at]);
    for (int i = 0; i < c->narg; i++)
        if (i != at) text_add(&t, strpbrk(c->arg[i], " *'") ? " \"%s\"" : " %s", c->arg[i]);
    err_clear(e);
    err_set(e, ERR_USAGE, "'%s' is not a database; the database comes first: `%s`", c->arg[0], t.s);
    text_free(&t);
}

/* How the database was opened, where there is something to say. */
static struct store *with_remark(const struct common *c, struct store *s)
{
    if (s != NULL && store_remark(s) != NULL && !c->quiet)
        fprintf(stderr, "mimdsim: %s\n", store_remark(s));
    return s;
}

/* For writing: made where there is none, upgraded where it is older. */
struct store *arguments_store(const struct common *c, const char *path, struct err *e)
{
    return with_remark(c, store_open(path, STORE_WRITE, e));
}

struct store *arguments_store_whole(const struct common *c, const char *path, struct err *e)
{
    return with_remark(c, store_open(path, STORE_WHOLE, e));
}

struct store *arguments_database(const struct common *c, const char *otherwise, struct err *e)
{
    return with_remark(c, arguments_look(c, otherwise, e));
}

/* For reading. Only when it cannot be opened it is asked what else the argument may be: that
 * reads files. */
struct store *arguments_look(const struct common *c, const char *otherwise, struct err *e)
{
    const char *path = c->narg > 0 ? c->arg[0] : otherwise;
    if (*path == '\0') return err_set(e, ERR_USAGE, "'' is not the name of a database"), NULL;
    struct store *s = store_open(path, STORE_READ, e);
    if (s != NULL || c->narg == 0) return s;
    int at = e->kind == ERR_NO_INPUT || e->kind == ERR_DATA ? database_behind(c) : 0;
    if (at > 0) say_order(c, at, e);
    else file_kind_refuse(c->arg[0], FILE_DATABASE, e);
    return NULL;
}

/* Digits only: "12x" is no run, and neither are "-1" and " 12", nor a number that no row can have.
 */
bool arguments_run_number(const char *text, struct err *e)
{
    const size_t digits = strspn(text, "0123456789");
    errno = 0;
    strtoll(text, NULL, 10);
    if (digits > 0 && text[digits] == '\0' && errno == 0) return true;
    return err_set(e, ERR_USAGE,
                   "'%s' is not the number of a run; "
                   "`mimdsim query DB 'SELECT id, scenario, n, P FROM run'` lists them",
                   text);
}

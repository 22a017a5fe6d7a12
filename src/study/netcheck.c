/* netcheck.c - goes through the cases of a reference file, each by the reader of its form.
 *
 * A reader makes rows; a row has the reference's answer and one answer per network level. The
 * reference is checked as strictly as the levels: its own numbers must agree with each other
 * before they judge. */
#include "study/netcheck.h"

#include <string.h>

#include "base/progress.h"
#include "io/document.h"
#include "study/netcheck_rows.h"

/* The rows of one case: which form it has, whether its answers are there when those of earlier
 * cases are, then the reader of that form. */
static bool case_rows(struct netcheck_reader *r, const struct node *c)
{
    enum netcheck_form form = NETCHECK_STEP;
    bool referred = false;
    /* ncase counts cases read before: the first one decides whether the file has answers at all. */
    if (!netcheck_form_of(r, c, &form, &referred)) return false;
    if (r->ncase++ > 0 && r->referred != referred)
        return err_set_at(r->e, ERR_DATA, r->path, c->line,
                          "the case has %s results, but earlier cases have %s",
                          referred ? "reference" : "no", referred ? "none" : "some");
    /* A file is either a reference or a list to play: a case that lost its answers would pass
     * unnoticed. */
    r->referred = referred;
    switch (form) {
    case NETCHECK_STEP:
        return netcheck_step_rows(r, c, referred);
    case NETCHECK_LIST:
        return netcheck_list_rows(r, c, referred);
    case NETCHECK_HAND:
        return netcheck_hand_rows(r, c, referred);
    case NETCHECK_LOAD:
        return netcheck_is_series(c) ? netcheck_series_rows(r, c) : netcheck_load_rows(r, c);
    /* the last form, after the switch: the compiler warns if one is missing here */
    case NETCHECK_SATURATION:
    case NETCHECK_FORMS:
        break;
    }
    return netcheck_saturation_rows(r, c);
}

/* Whether any level answered any row: is there anything to judge? */
static bool any_answer(const struct netcheck *n)
{
    for (int i = 0; i < n->nrow; i++)
        for (int l = 0; l < LEVELS; l++)
            if (n->row[i].answer[l].ran) return true;
    return false;
}

/* A file of which nothing could be compared is no success: the first reason is told, and so the
 * file differs from one whose rows were all filtered away. */
static bool nothing_answered(const struct netcheck *n, struct err *e)
{
    for (int i = 0; i < n->nrow; i++)
        for (int l = 0; l < LEVELS; l++)
            if (n->level[l] && n->row[i].answer[l].why[0])
                return err_set_at(e, ERR_DATA, n->path, n->row[i].line,
                                  "none of its cases (%d) can be run; %s: %s",
                                  n->nrow, n->row[i].name, n->row[i].answer[l].why);
    return err_set_at(e, ERR_DATA, n->path, 1, "no case could be run");
}

bool netcheck_run(struct netcheck *n, const char *path, const bool *level, const char *filter,
                  bool quiet, struct arena *a, struct err *e)
{
    const struct node *root = document_read(path, a, e);
    if (!root) return false;
    /* A file may be one case without a list around it. Read the whole file first: a mistake at its
     * end should not come after minutes of simulation. */
    bool one = root->kind == NODE_MAP;
    if (!one && (root->kind != NODE_LIST || root->count == 0))
        return err_set_at(e, ERR_DATA, path, root->line, "expected a list of reference cases");
    *n = (struct netcheck){.path = path};
    /* Levels NULL: all. */
    for (int l = 0; l < LEVELS; l++) n->level[l] = !level || level[l];
    struct netcheck_reader r = {
        .n = n, .path = path, .filter = filter, .rows = a, .arena = arena_create(), .e = e};
    struct progress p = progress_make("reference cases", one ? 1 : root->count, quiet);
    bool ok = true;
    int done = 0;
    /* A step of this loop is one case; the arena is released after each, rows live in `a`. */
    for (const struct node *c = one ? root : root->child; ok && c; c = one ? NULL : c->next) {
        struct arena_mark mark = arena_mark(r.arena);
        ok = case_rows(&r, c);
        arena_release(r.arena, mark);
        progress_show(&p, ++done);
    }
    progress_end(&p);
    arena_destroy(r.arena);
    return ok && (filter || any_answer(n) || nothing_answered(n, e));
}

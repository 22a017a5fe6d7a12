/* document_fixture.h - files of data and texts of settings read as trees, in a folder and an arena
 * that the tests of one program share.
 *
 * To be included behind cmocka.h, by the file that has main. */
#ifndef IO_DOCUMENT_FIXTURE_H
#define IO_DOCUMENT_FIXTURE_H

#include <stdio.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "../support/scratch.h"
#include "io/document.h"

static char folder[256], path[512];

static int begin(void **state)
{
    scratch_make(folder, sizeof folder);
    scratch_path(path, sizeof path, folder, "x.json");
    return make_arena(state);
}

static int end(void **state)
{
    scratch_remove(folder);
    return drop_arena(state);
}

static struct node *read_bytes(const char *s, size_t n, struct err *e)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(s, 1, n, f), n);
    fclose(f);
    err_clear(e);
    return document_read(path, arena, e);
}
static struct node *read_data(const char *s, struct err *e) { return read_bytes(s, strlen(s), e); }

static struct node *read_settings(const char *s, struct err *e)
{
    err_clear(e);
    return document_parse_settings(s, strlen(s), "x.yaml", arena, e);
}

/* The tree of a text that must be good. */
static struct node *good_data(const char *s)
{
    struct err e;
    struct node *n = read_data(s, &e);
    if (!n) fail_msg("%s: %d: %s", s, e.line, e.text);
    return n;
}
static struct node *good_settings(const char *s)
{
    struct err e;
    struct node *n = read_settings(s, &e);
    if (!n) fail_msg("%s: %d: %s", s, e.line, e.text);
    return n;
}

static void expect_error(const struct err *e, int line, const char *said)
{
    if (e->kind != ERR_DATA || e->line != line || !strstr(e->text, said))
        fail_msg("kind %d, line %d: '%s' instead of line %d: '%s'", (int)e->kind, e->line, e->text,
                 line, said);
}

#endif

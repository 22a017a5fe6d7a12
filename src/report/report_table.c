/* report_table.c - the rows of a query as an aligned table, as wide as there is room.
 *
 * A table is for eyes: six digits, "-" for NULL. Where it is too wide for a terminal, names of
 * columns are broken first, then what is the same in all rows goes above it, and in the end columns
 * are left out, which is said. */
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/memory.h"
#include "base/text.h"
#include "report/report.h"

/* A table on its way to the terminal. */
struct grid {
    struct arena *a;
    int ncolumn;
    int *width;   /* (ncolumn) [characters] */
    bool *number; /* (ncolumn) no text in it: aligned to the right */
    bool *hidden; /* (ncolumn) not printed */
    int64_t nrow, capacity;
    char **cell; /* (capacity x ncolumn), row 0: the names */
};

/* Characters of UTF-8 text: bytes that do not continue one. */
static int text_width(const char *s)
{
    int n = 0;
    for (; *s; s++) n += ((unsigned char)*s & 0xC0) != 0x80;
    return n;
}

/* A value as people read it; what could move the cursor becomes a blank. */
static char *readable(struct arena *a, const struct store_value *v)
{
    char buffer[40];
    switch (v->kind) {
    case STORE_NULL:
        return arena_text(a, "-");
    case STORE_INT:
        snprintf(buffer, sizeof buffer, "%lld", (long long)v->integer);
        break;
    case STORE_REAL:
        snprintf(buffer, sizeof buffer, "%.6g", v->real);
        break;
    case STORE_TEXT: {
        char *s = arena_text(a, v->text);
        for (char *c = s; *c; c++)
            if ((unsigned char)*c < ' ' || *c == 127) *c = ' ';
        return s;
    }
    }
    return arena_text(a, buffer);
}

/* A row takes the widths of its columns with it, so that printing needs no second look at all
 * cells. */
static void grid_add(struct grid *g, char *const *cell)
{
    if (g->nrow == g->capacity) {
        g->capacity = g->capacity ? 2 * g->capacity : 64;
        g->cell = memory_resize(g->cell, (size_t)(g->capacity * g->ncolumn), sizeof *g->cell);
    }
    for (int i = 0; i < g->ncolumn; i++) {
        int width = text_width(cell[i]);
        if (width > g->width[i]) g->width[i] = width;
        g->cell[g->nrow * g->ncolumn + i] = cell[i];
    }
    g->nrow++;
}

/* Columns of numbers are aligned to the right until a text is seen in them. */
static bool grid_header(void *context, int ncolumn, const char *const *name,
                        const struct store_value *value)
{
    struct grid *g = context;
    (void)value;
    g->ncolumn = ncolumn;
    /* The names are row 0 and widen the columns like any row. */
    g->width = TAKE(g->a, ncolumn, int);
    g->number = TAKE(g->a, ncolumn, bool);
    g->hidden = TAKE(g->a, ncolumn, bool);
    char **cell = TAKE(g->a, ncolumn, char *);
    for (int i = 0; i < ncolumn; i++) {
        g->number[i] = true;
        cell[i] = arena_text(g->a, name[i]);
    }
    grid_add(g, cell);
    return true;
}

static bool grid_row(void *context, int ncolumn, const char *const *name,
                     const struct store_value *value)
{
    struct grid *g = context;
    (void)name;
    char **cell = TAKE(g->a, ncolumn, char *);
    for (int i = 0; i < ncolumn; i++) {
        if (value[i].kind == STORE_TEXT) g->number[i] = false;
        cell[i] = readable(g->a, &value[i]);
    }
    grid_add(g, cell);
    return true;
}

/* ---- what is shown */

/* Row 0 holds the names. */
static const char *cell_at(const struct grid *g, int64_t row, int column)
{
    return g->cell[row * g->ncolumn + column];
}

/* A column without any value says nothing. */
static bool is_empty(const struct grid *g, int column)
{
    for (int64_t r = 1; r < g->nrow; r++)
        if (strcmp(cell_at(g, r, column), "-") != 0) return false;
    return true;
}

/* Of one row nothing can be said to be the same in all. */
static bool is_constant(const struct grid *g, int column)
{
    for (int64_t r = 2; r < g->nrow; r++)
        if (strcmp(cell_at(g, r, column), cell_at(g, 1, column)) != 0) return false;
    return g->nrow > 2;
}

/* Characters of a line, with two blanks between columns. */
static int total_width(const struct grid *g)
{
    int n = -2;
    for (int i = 0; i < g->ncolumn; i++)
        if (!g->hidden[i]) n += g->width[i] + 2;
    return n;
}

/* The part of a name from `at` to behind its next underscore; its length. */
static int name_part(const char *at)
{
    const char *end = strchr(at, '_');
    return (int)(end != NULL && end[1] != '\0' ? (size_t)(end + 1 - at) : strlen(at));
}

/* Columns become as narrow as their values and the longest part of their names. */
static void break_names(struct grid *g)
{
    for (int i = 0; i < g->ncolumn; i++) {
        int width = 0;
        for (const char *s = cell_at(g, 0, i); *s != '\0'; s += name_part(s))
            width = name_part(s) > width ? name_part(s) : width;
        for (int64_t r = 1; r < g->nrow; r++)
            width = text_width(cell_at(g, r, i)) > width ? text_width(cell_at(g, r, i)) : width;
        g->width[i] = width;
    }
}

/* Columns go, from the first or the last, until the table fits; their names are gathered. */
static void hide(struct grid *g, int most, bool constant, struct text *names)
{
    /* the first and the last stay: which row it is, and how it ended */
    for (int k = 0; k < g->ncolumn && total_width(g) > most; k++) {
        const int i = constant ? k : g->ncolumn - 2 - k;
        if (i < 0 || g->hidden[i] || (constant && !is_constant(g, i))) continue;
        if (!constant && i == 0) break;
        g->hidden[i] = true;
        text_add(names, "%s%s", names->length > 0 ? ", " : "", cell_at(g, 0, i));
        if (constant) text_add(names, " %s", cell_at(g, 1, i));
    }
}

/* Words of a text in lines of at most `most` characters. */
static void print_lines(const char *text, int most, FILE *out)
{
    int at = 0;
    for (const char *s = text; *s != '\0';) {
        const int n = (int)strcspn(s, " ");
        const bool first = at == 0;
        if (!first && at + 1 + n > most) fputs("\n  ", out), at = 2;
        else if (!first) fputc(' ', out), at++;
        fprintf(out, "%.*s", n, s);
        at += n;
        s += n + (s[n] == ' ');
    }
    fputc('\n', out);
}

/* What does not fit goes above the table. */
static void fit(struct grid *g, int most, FILE *out)
{
    struct text same = {0}, left_out = {0}, line = {0};
    break_names(g);
    hide(g, most, true, &same);
    hide(g, most, false, &left_out);
    if (same.length > 0) text_add(&line, "in all rows: %s", same.s);
    if (left_out.length > 0)
        text_add(&line, "%sleft out for the width: %s (--columns shows them)",
                 line.length ? "; " : "", left_out.s);
    if (line.length > 0) print_lines(line.s, most, out);
    text_free(&same);
    text_free(&left_out);
    text_free(&line);
}

/* ---- lines */

/* The column that ends the line. */
static int last_shown(const struct grid *g)
{
    int last = g->ncolumn - 1;
    while (last > 0 && g->hidden[last]) last--;
    return last;
}

/* One cell, of `length` bytes; the last column is not padded: no line ends in blanks. */
static void print_cell(const struct grid *g, int column, const char *s, int length, int last,
                       FILE *out)
{
    char *cell = arena_text(g->a, s);
    cell[length] = '\0';
    const int pad = g->width[column] > text_width(cell) ? g->width[column] - text_width(cell) : 0;
    if (g->number[column]) fprintf(out, "%*s%s", pad, "", cell);
    else fprintf(out, "%s%*s", cell, column < last ? pad : 0, "");
    fputs(column < last ? "  " : "\n", out);
}

/* Names in as many lines as the one with most parts needs, their last parts in the last line. */
static void print_names(const struct grid *g, int last, bool broken, FILE *out)
{
    int lines = 1;
    for (int i = 0; i <= last && broken; i++) {
        int parts = 0;
        for (const char *s = cell_at(g, 0, i); *s != '\0'; s += name_part(s)) parts++;
        /* a name that fits stays whole */
        if (text_width(cell_at(g, 0, i)) <= g->width[i]) parts = 1;
        if (!g->hidden[i] && parts > lines) lines = parts;
    }
    for (int line = 0; line < lines; line++)
        for (int i = 0; i <= last; i++) {
            const char *s = cell_at(g, 0, i);
            const bool whole = text_width(s) <= g->width[i];
            int parts = 0;
            if (g->hidden[i]) continue;
            for (const char *p = s; *p != '\0' && !whole; p += name_part(p)) parts++;
            if (whole) parts = 1;
            const int skip = line - (lines - parts);
            for (int k = 0; k < skip && !whole; k++) s += name_part(s);
            const int length = skip < 0 ? 0 : whole ? (int)strlen(s) : name_part(s);
            print_cell(g, i, s, length, last, out);
        }
}

/* Names are broken only where the table would be too wide. */
static void grid_print(struct grid *g, const struct report_look *look, FILE *out)
{
    for (int i = 0; look->compact && i < g->ncolumn; i++)
        g->hidden[i] = g->nrow > 1 && is_empty(g, i);
    const bool wide = look->width > 0 && total_width(g) > look->width;
    if (wide) fit(g, look->width, out);
    const int last = last_shown(g);
    if (g->nrow > 0) print_names(g, last, wide, out);
    for (int64_t r = 1; r < g->nrow; r++)
        for (int i = 0; i <= last; i++)
            if (!g->hidden[i])
                print_cell(g, i, cell_at(g, r, i), (int)strlen(cell_at(g, r, i)), last, out);
}

/* All rows in memory: a database of reports has thousands, not millions. */
bool report_table(struct store *s, const char *sql, int nparam, const char *const *param,
                  const struct report_look *look, FILE *out, struct err *e)
{
    struct grid g = {.a = arena_create()};
    bool ok = store_query(s, sql, nparam, param, grid_header, grid_row, &g, e);
    if (ok) grid_print(&g, look, out);
    free(g.cell);
    arena_destroy(g.a);
    /* A full disk shows up when the buffer is flushed. */
    if (ok && (fflush(out) != 0 || ferror(out)))
        return err_set(e, ERR_IO, "the output cannot be written");
    return ok;
}

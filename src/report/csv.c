/* csv.c - tables as comma-separated values after RFC 4180. */
#include "report/csv.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"

/* Where the rows go, and whom to tell about run ids. */
struct writer {
    FILE *out;
    int64_t nrow;
    void (*run_id)(void *context, int64_t id);
    void *context;
};

/* RFC 4180: a cell with a comma, a quote or a line break stands in quotes, and quotes in it are
 * doubled. Outer blanks are quoted as well, since gnuplot and spreadsheets drop them. */
void csv_cell(FILE *out, const char *s, bool last)
{
    if (s == NULL) s = "";
    size_t n = strlen(s);
    bool outer_blank = n > 0 && (s[0] == ' ' || s[n - 1] == ' ');
    if (!outer_blank && strpbrk(s, "\",\r\n") == NULL) fputs(s, out);
    else {
        putc('"', out);
        for (; *s; s++) {
            if (*s == '"') putc('"', out);
            putc(*s, out);
        }
        putc('"', out);
    }
    fputs(last ? "\r\n" : ",", out);
}

/* Gnuplot cannot read a quote inside a quoted cell, and control characters could move the
 * cursor. */
void csv_plain(char *s)
{
    for (; *s; s++)
        if ((unsigned char)*s < ' ' || *s == 127) *s = ' ';
        else if (*s == '"') *s = '\'';
}

/* A text of the database, which may hold anything. */
static void plain_cell(FILE *out, const char *s, bool last)
{
    /* a copy: the row's text belongs to SQLite */
    char *copy = memory_text(s);
    csv_plain(copy);
    csv_cell(out, copy, last);
    free(copy);
}

/* Names of columns: of this program's queries, so they need no cleaning. */
static bool header(void *context, int ncolumn, const char *const *name,
                   const struct store_value *value)
{
    struct writer *w = context;
    (void)value;
    for (int i = 0; i < ncolumn; i++) csv_cell(w->out, name[i], i + 1 == ncolumn);
    return true;
}

/* One row. Reals have all digits that tell them apart; NULL is an empty cell. */
static bool row(void *context, int ncolumn, const char *const *name,
                const struct store_value *value)
{
    struct writer *w = context;
    for (int i = 0; i < ncolumn; i++) {
        char buffer[40] = "";
        if (value[i].kind == STORE_INT)
            snprintf(buffer, sizeof buffer, "%lld", (long long)value[i].integer);
        else if (value[i].kind == STORE_REAL) text_real(buffer, value[i].real);
        if (value[i].kind == STORE_TEXT) plain_cell(w->out, value[i].text, i + 1 == ncolumn);
        else csv_cell(w->out, buffer, i + 1 == ncolumn);
        /* A column run_id says whose numbers these are: the figure's provenance collects them. */
        if (w->run_id != NULL && value[i].kind == STORE_INT && strcmp(name[i], "run_id") == 0)
            w->run_id(w->context, value[i].integer);
    }
    w->nrow++;
    return true;
}

/* The header is written even if no row follows. */
bool csv_write(struct store *s, const char *sql, int nparam, const char *const *param, FILE *out,
               void (*run_id)(void *context, int64_t id), void *context, int64_t *nrow,
               struct err *e)
{
    struct writer w = {out, 0, run_id, context};
    bool ok = store_query(s, sql, nparam, param, header, row, &w, e);
    *nrow = w.nrow;
    return ok;
}

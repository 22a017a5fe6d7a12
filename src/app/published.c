/* published.c - machines/published.csv into records (published.h). */
#include "app/published.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

enum { COLUMNS = 14, MOST_SETS = 8 };

static const char header[] = "id,machine,quantity,at,value,low,high,unit,class,calibrated,add,set,source,cause";

static const struct {
    const char *name;
    double scale;
} units[] = {{"s", 1}, {"us", 1e-6}, {"ns", 1e-9}, {"B", 1}, {"MB/s", 1e6}, {"GB/s", 1e9}, {"TB/s", 1e12},
             {"Mflop/s", 1e6}, {"Gflop/s", 1e9}};

static char *copied(struct arena *a, const char *s, size_t n)
{
    char *c = arena_take(a, n + 1);
    memcpy(c, s, n);
    c[n] = '\0';
    return c;
}

/* The cells of one line; a quoted cell may hold commas. Returns how many there are. */
static int split(char *line, char *cell[COLUMNS])
{
    int n = 0;
    for (char *at = line; n < COLUMNS; n++) {
        bool quoted = *at == '"';
        cell[n] = at + quoted;
        char *end = quoted ? strchr(at + 1, '"') : strchrnul(at, ',');
        if (!end) return -1;
        char *next = quoted ? end + 1 : end;
        bool more = *next == ',';
        *end = '\0';
        at = next + 1;
        if (!more) return n + 1;
    }
    return n + 1;
}

/* A row without a cause may end before it. */
static bool split_row(char *line, char *cell[COLUMNS])
{
    cell[COLUMNS - 1] = line + strlen(line);
    int n = split(line, cell);
    return n == COLUMNS || n == COLUMNS - 1;
}

static bool number(const char *s, double scale, double otherwise, double *value)
{
    char *end;
    *value = *s ? strtod(s, &end) * scale : otherwise;
    return !*s || *end == '\0';
}

static void split_sets(struct published *p, const char *s, struct arena *a)
{
    p->set = TAKE(a, MOST_SETS, const char *);
    while (*s && p->nset < MOST_SETS) {
        size_t n = strcspn(s, ";");
        struct text t = {0};
        text_add(&t, "machine.%.*s", (int)n, s);
        p->set[p->nset++] = copied(a, t.s, t.length);
        text_free(&t);
        s += n;
        s += strspn(s, "; ");
    }
}

static const char *const uses[] = {"yes", "no", "other"};

const char *published_use_name(enum published_use use) { return uses[use]; }

static bool read_use(struct published *p, const char *s, struct err *e)
{
    for (int i = 0; i < 3; i++) {
        p->use = (enum published_use)i;
        if (strcmp(s, uses[i]) == 0) return true;
    }
    return err_set(e, ERR_DATA, "calibrated: '%s'; expected yes, no or other", s);
}

/* A point that cannot be tested says why. */
static bool check_cause(const struct published *p, struct err *e)
{
    return p->use != USE_OTHER || *p->cause ||
           err_set(e, ERR_DATA, "%s: calibrated is 'other', and no cause is given", p->id);
}

/* "1024@16": 1024 bytes on 16 ranks. */
static bool take_ranks(struct published *p, struct err *e)
{
    const char *ranks = strchr(p->at_text, '@');
    char *end;
    if (!ranks) return true;
    long n = strtol(ranks + 1, &end, 10);
    if (end == ranks + 1 || *end || n < 1 || n > 1 << 24)
        return err_set(e, ERR_DATA, "%s: '%s'; expected bytes@ranks such as 1024@16", p->id, p->at_text);
    p->ranks = (int)n;
    return true;
}

static bool record(struct published *p, char *cell[COLUMNS], struct arena *a, struct err *e)
{
    *p = (struct published){.id = cell[0],
                            .machine = cell[1],
                            .at_text = cell[3],
                            .unit = cell[7],
                            .evidence = cell[8],
                            .source = cell[12],
                            .cause = cell[13]};
    p->quantity = probe_find(cell[2]);
    if (p->quantity == PROBE_QUANTITIES) return err_set(e, ERR_DATA, "no quantity is called '%s'", cell[2]);
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(cell[7], units[i].name) == 0) p->scale = units[i].scale;
    if (p->scale == 0) return err_set(e, ERR_DATA, "unknown unit '%s'", cell[7]);
    if (!read_use(p, cell[9], e)) return false;
    if (!take_ranks(p, e)) return false;
    char at[32];
    snprintf(at, sizeof at, "%.*s", (int)strcspn(p->at_text, "@"), p->at_text);
    if (!*cell[4] || !number(at, 1, 0, &p->at) || !number(cell[4], p->scale, 0, &p->value) ||
        !number(cell[5], p->scale, p->value, &p->low) || !number(cell[6], p->scale, p->value, &p->high) ||
        !number(cell[10], p->scale, 0, &p->add))
        return err_set(e, ERR_DATA, "%s: not a number", cell[0]);
    split_sets(p, cell[11], a);
    return check_cause(p, e);
}

static bool read_lines(const char *path, char *s, struct arena *a, struct published *row, int *n, struct err *e)
{
    int line = 0;
    for (char *next; *s; s = next) {
        char *cell[COLUMNS];
        size_t length = strcspn(s, "\r\n");
        next = s + length;
        next += strspn(next, "\r");
        next += *next == '\n';
        s[length] = '\0';
        line++;
        bool ok = line == 1 ? strcmp(s, header) == 0 || err_set(e, ERR_DATA, "the header is not '%s'", header)
                            : split_row(s, cell) || err_set(e, ERR_DATA, "expected %d cells, or one less", COLUMNS);
        if (ok && line > 1) ok = record(&row[(*n)++], cell, a, e);
        if (ok) continue;
        text_copy(e->file, sizeof e->file, path);
        e->line = line;
        return false;
    }
    return true;
}

bool published_read(const char *path, struct arena *a, struct published **row, int *n, struct err *e)
{
    struct text t = {0};
    if (!text_read_file(&t, path, e)) return false;
    int lines = 1;
    for (const char *c = t.s; *c; c++) lines += *c == '\n';
    char *s = copied(a, t.s, t.length);
    *row = TAKE(a, lines, struct published);
    *n = 0;
    text_free(&t);
    return read_lines(path, s, a, *row, n, e);
}

/* published.c - machines/published.csv into records (published.h).
 *
 * The file is data that other people check and extend: every mistake in it is refused with its
 * line, what was expected, and the nearest valid word. */
#include "app/published.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

enum { COLUMNS = 14, MOST_SETS = 8 }; /* cells of a row; settings of a machine */

/* Columns of the file; docs/machines.md says what they mean. */
static const char header[] =
    "id,machine,quantity,at,value,low,high,unit,class,calibrated,add,set,source,cause";

/* What a unit is a unit of: a time in MB/s is a mistake in the file. */
enum dimension { TIME, SIZE, RATE, FLOPS };
static const struct {
    const char *name;
    double scale;
    enum dimension of;
} units[] = {{"s", 1, TIME},      {"us", 1e-6, TIME},   {"ns", 1e-9, TIME},       {"B", 1, SIZE},
             {"MB/s", 1e6, RATE}, {"GB/s", 1e9, RATE},  {"TB/s", 1e12, RATE},     {"Mflop/s",
              1e6, FLOPS},
             {"Gflop/s", 1e9, FLOPS}};

/* Time, but for the quantities named here. */
static enum dimension dimension_of(enum probe_quantity q)
{
    switch (q) {
    /* a message size [B] */
    case PROBE_N_HALF: return SIZE;
    case PROBE_LINPACK:
    case PROBE_INNER_PRODUCT: return FLOPS;
    case PROBE_BANDWIDTH:
    case PROBE_R_INF:
    case PROBE_BISECTION:
    case PROBE_GLOBAL:
    case PROBE_EXCHANGE:
    case PROBE_HALVES:
    case PROBE_STREAM_COPY:
    case PROBE_STREAM_SCALE:
    case PROBE_STREAM_ADD:
    case PROBE_STREAM_TRIAD:
    case PROBE_MEMORY_COPY:
    case PROBE_RING:
    case PROBE_RANDOM_RING:
    case PROBE_B_EFF: return RATE;
    default: return TIME;
    }
}

/* With its end, as cells are parts of a line. */
static char *copied(struct arena *a, const char *s, size_t n)
{
    char *c = arena_take(a, n + 1);
    memcpy(c, s, n);
    c[n] = '\0';
    return c;
}

/* The cells of one line, in place; a quoted cell may have commas but no quotes. Returns how many
 * there are, -1: a quote has no end. */
static int split(char *line, char *cell[COLUMNS])
{
    int n = 0;
    for (char *at = line; n < COLUMNS; n++) {
        bool quoted = *at == '"'; /* commas in it belong to the cell */
        cell[n] = at + quoted;
        char *end = quoted ? strchr(at + 1, '"') : strchrnul(at, ',');
        if (!end) return -1; /* a quote has no end */
        char *next = quoted ? end + 1 : end;
        bool more = *next == ','; /* else the line ends here */
        *end = '\0';
        at = next + 1;
        if (!more) return n + 1;
    }
    return n + 1;
}

/* A row without a cause may end before it: the last cell is then empty. */
static bool split_row(char *line, char *cell[COLUMNS])
{
    cell[COLUMNS - 1] = line + strlen(line);
    int n = split(line, cell);
    return n == COLUMNS || n == COLUMNS - 1;
}

/* An empty cell is `otherwise`; a number below 0 is refused. */
static bool number(const char *s, double scale, double otherwise, double *value)
{
    char *end;
    *value = *s ? strtod(s, &end) * scale : otherwise;
    return !*s || (*end == '\0' && isfinite(*value) && *value >= 0);
}

/* "key=value; key=value" as settings of the machine. */
static bool split_sets(struct published *p, const char *s, struct arena *a, struct err *e)
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
    return !*s || err_set(e, ERR_DATA, "%s: more than %d settings", p->id, MOST_SETS);
}

static const char *const uses[] = {"yes", "no", "other"}; /* in the order of enum published_use */

const char *published_use_name(enum published_use use) { return uses[use]; }

/* `other`: published, but not of what is simulated; its cause says why. */
static bool read_use(struct published *p, const char *s, struct err *e)
{
    for (int i = 0; i < 3; i++) {
        p->use = (enum published_use)i;
        if (strcmp(s, uses[i]) == 0) return true;
    }
    return err_set(e, ERR_DATA, "calibrated: '%s'; expected yes, no or other", s);
}

/* The unit must be known and fit the quantity. */
static bool read_unit(struct published *p, struct err *e)
{
    const char *name[sizeof units / sizeof *units];
    const int n = sizeof units / sizeof *units;
    for (int i = 0; i < n; i++) {
        name[i] = units[i].name;
        if (strcmp(p->unit, name[i]) != 0) continue;
        p->scale = units[i].scale;
        return units[i].of == dimension_of(p->quantity) ||
               err_set(e, ERR_DATA, "%s: '%s' is no unit of %s", p->id, p->unit,
                       probe_name(p->quantity));
    }
    return err_set(e, ERR_DATA, "unknown unit '%s'%s", p->unit, text_hint(p->unit, name, n, "").s);
}

/* The nearest name of a quantity where there is one. */
static bool read_quantity(struct published *p, const char *s, struct err *e)
{
    const char *name[PROBE_QUANTITIES];
    for (int i = 0; i < PROBE_QUANTITIES; i++) name[i] = probe_name((enum probe_quantity)i);
    p->quantity = probe_find(s);
    if (p->quantity != PROBE_QUANTITIES) return true;
    return err_set(e, ERR_DATA, "no quantity is called '%s'%s", s,
                   text_hint(s, name, PROBE_QUANTITIES, "").s);
}

/* What every row has: a name, a known class of evidence, a source, a value above 0 that lies in
 * its own range. */
static bool check_row(const struct published *p, struct err *e)
{
    static const char *const class[] = {"P", "PR", "D", "E"};
    bool known = false;
    for (int i = 0; i < 4; i++) known = known || strcmp(p->evidence, class[i]) == 0;
    if (!*p->id || !*p->machine) return err_set(e, ERR_DATA, "a row without id or machine");
    if (!known)
        return err_set(e, ERR_DATA, "%s: class '%s'; expected P, PR, D or E", p->id, p->evidence);
    if (!*p->source) return err_set(e, ERR_DATA, "%s: no source is given", p->id);
    if (p->value <= 0) return err_set(e, ERR_DATA, "%s: the value is not above 0", p->id);
    return (p->low <= p->value && p->value <= p->high) ||
           err_set(e, ERR_DATA, "%s: the value %g is not within its range, %g to %g", p->id,
                   p->value / p->scale, p->low / p->scale, p->high / p->scale);
}

/* "+40 %: reason" as a cause: the error that the reason explains. NAN: no number. */
static void read_missed(struct published *p)
{
    char *end;
    const double percent = strtod(p->cause, &end);
    const bool named =
        (*p->cause == '+' || *p->cause == '-') && strncmp(end, " %: ", 4) == 0 && percent > -100;
    p->missed = named && isfinite(percent) ? percent / 100 : NAN;
}

/* A point that cannot be tested says why. */
static bool check_cause(const struct published *p, struct err *e)
{
    return p->use != USE_OTHER || *p->cause ||
           err_set(e, ERR_DATA, "%s: calibrated is 'other', and no cause is given", p->id);
}

/* "1024@16" as the place: 1024 bytes on 16 ranks. Without @ the quantity's own number of ranks. */
static bool take_ranks(struct published *p, struct err *e)
{
    const char *ranks = strchr(p->at_text, '@');
    char *end;
    if (!ranks) return true;
    long n = strtol(ranks + 1, &end, 10);
    if (end == ranks + 1 || *end || n < 1 || n > 1 << 24)
        return err_set(e, ERR_DATA, "%s: '%s'; expected bytes@ranks such as 1024@16", p->id,
                       p->at_text);
    p->ranks = (int)n;
    return true;
}

/* One row from its cells; reading goes on only while everything is right. */
static bool record(struct published *p, char *cell[COLUMNS], struct arena *a, struct err *e)
{
    *p = (struct published){.id = cell[0],
                            .machine = cell[1],
                            .at_text = cell[3],
                            .unit = cell[7],
                            .evidence = cell[8],
                            .source = cell[12],
                            .cause = cell[13]};
    if (!read_quantity(p, cell[2], e) || !read_unit(p, e)) return false;
    if (!read_use(p, cell[9], e)) return false;
    if (!take_ranks(p, e)) return false;
    /* All numbers of the row; empty ones have the value that stands for "not given": the range
     * is then the value itself. */
    char at[32];
    /* The number in front of @. */
    snprintf(at, sizeof at, "%.*s", (int)strcspn(p->at_text, "@"), p->at_text);
    if (!*cell[4] || !number(at, 1, 0, &p->at) || !number(cell[4], p->scale, 0, &p->value) ||
        !number(cell[5], p->scale, p->value, &p->low) ||
        !number(cell[6], p->scale, p->value, &p->high) || !number(cell[10], p->scale, 0, &p->add))
        return err_set(e, ERR_DATA, "%s: not a number, or below 0", cell[0]);
    read_missed(p);
    return split_sets(p, cell[11], a, e) && check_row(p, e) && check_cause(p, e);
}

/* Ids are quoted in reports: they must be unique. */
static bool is_new(const struct published *row, int n, struct err *e)
{
    for (int i = 0; i < n; i++)
        if (strcmp(row[i].id, row[n].id) == 0)
            return err_set(e, ERR_DATA, "%s: a second row of this id", row[n].id);
    return true;
}

/* Line by line, in place; \r\n and \n both end a line. The first mistake ends it, with file and
 * line. */
static bool read_lines(const char *path, char *s, struct arena *a, struct published *row, int *n,
                       struct err *e)
{
    int line = 0;
    /* A line ends at \r\n or \n; the last one may have no end. */
    for (char *next; *s; s = next) {
        char *cell[COLUMNS];
        size_t length = strcspn(s, "\r\n");
        next = s + length;
        next += strspn(next, "\r");
        next += *next == '\n';
        s[length] = '\0';
        line++;
        /* The header is compared as a whole: columns that were moved would be read wrongly
         * without a sign. */
        bool ok = line == 1 ? strcmp(s, header) == 0 ||
                                  err_set(e, ERR_DATA, "the header is not '%s'", header)
                            : split_row(s, cell) ||
                                  err_set(e, ERR_DATA, "expected %d cells, or one less", COLUMNS);
        if (ok && line > 1) ok = record(&row[*n], cell, a, e) && is_new(row, *n, e) && ++*n;
        if (ok) continue;
        text_copy(e->file, sizeof e->file, path);
        e->line = line;
        return false;
    }
    return true;
}

/* As many records as lines are enough. The text is copied: records point into it. */
bool published_read(const char *path, struct arena *a, struct published **row, int *n,
                    struct err *e)
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

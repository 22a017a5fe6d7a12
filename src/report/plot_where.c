/* plot_where.c - conditions that users write about rows; see plot_where.h.
 *
 * A condition is read here and evaluated here. It does not reach the database, so nothing that is
 * written in it can change what is asked there. */
#include "report/plot_where.h"

#include <fnmatch.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

enum { MOST_TOLD = 12 }; /* values that a message names */

/* The longer ones first, since they begin like the others. */
static const struct {
    const char *word;
    enum plot_operator operator;
} operators[] = {
    {"!=", PLOT_NOT_EQUAL}, {"<=", PLOT_AT_MOST}, {">=", PLOT_AT_LEAST}, {"==", PLOT_EQUAL},
    {"<", PLOT_LESS},       {">", PLOT_MORE},     {"=", PLOT_EQUAL},     {"~", PLOT_LIKE},
};

/* A copy without blanks at either end. */
static const char *trimmed(const char *s, size_t n, struct arena *a)
{
    while (n > 0 && (*s == ' ' || *s == '\t')) s++, n--;
    while (n > 0 && (s[n - 1] == ' ' || s[n - 1] == '\t')) n--;
    char *copy = TAKE(a, n + 1, char);
    memcpy(copy, s, n);
    return copy;
}

/* KEY OPERATOR VALUE, blanks around each of them as one likes. */
bool plot_where_parse(struct plot_condition *c, const char *text, struct arena *a, struct err *e)
{
    /* The first operator in the text divides it: a value may hold others. */
    const size_t at = strcspn(text, "!<>=~");
    for (size_t i = 0; i < sizeof operators / sizeof *operators; i++) {
        const size_t n = strlen(operators[i].word);
        if (strncmp(text + at, operators[i].word, n) != 0) continue;
        *c = (struct plot_condition){.key = trimmed(text, at, a),
                                     .operator = operators[i].operator,
                                     .value = trimmed(text + at + n, strlen(text + at + n), a)};
        if (c->key[0] != '\0') return true;
        break;
    }
    return err_set(e, ERR_USAGE,
                   "--where '%.80s': expected KEY=VALUE (or !=, <, <=, >, >=, ~), such as "
                   "level=link or \"hop_latency<1 us\"",
                   text);
}

/* The number that a condition names, in the column's base unit. A plain number is taken as it is:
 * columns are in base units, too. */
static bool number_of(const char *text, enum unit unit, double *number, char *why, int size)
{
    char *end;
    *number = strtod(text, &end);
    if (end != text && *end == '\0' && isfinite(*number)) return true;
    return units_parse(text, unit, number, why, size);
}

/* Equal but for rounding: a value that was typed has few digits. */
static bool same(double a, double b) { return fabs(a - b) <= 1e-9 * (fabs(a) + fabs(b)); }

/* Whether the cell is one of the values between bars. */
static bool is_one_of(const struct plot_cell *cell, const struct plot_column *column,
                      const char *values)
{
    /* A longer value than that is cut, and then equals nothing. */
    char one[256], why[160];
    for (const char *s = values;; s++) {
        /* Compared as texts first: "16" is also the name of something. */
        const size_t n = strcspn(s, "|");
        double number;
        snprintf(one, sizeof one, "%.*s", (int)n, s);
        if (strcmp(cell->text, one) == 0) return true;
        if (!isnan(cell->number) &&
            number_of(one, column->unit, &number, why, (int)sizeof why) &&
            same(cell->number, number))
            return true;
        s += n;
        if (*s == '\0') return false;
    }
}

/* A row without a number fulfils no order: comparisons with NAN are false. */
static bool fulfils(const struct plot_cell *cell, const struct plot_column *column,
                    const struct plot_condition *c, double number)
{
    switch (c->operator) {
    case PLOT_EQUAL: return is_one_of(cell, column, c->value);
    case PLOT_NOT_EQUAL: return !is_one_of(cell, column, c->value);
    /* "*" is any value, but not none */
    case PLOT_LIKE: return cell->text[0] != '\0' && fnmatch(c->value, cell->text, 0) == 0;
    case PLOT_LESS: return cell->number < number;
    case PLOT_AT_MOST: return cell->number < number || same(cell->number, number);
    case PLOT_MORE: return cell->number > number;
    case PLOT_AT_LEAST: return cell->number > number || same(cell->number, number);
    }
    return false;
}

/* Which values column `at` has, for whoever asked for none of them. Returns false. */
static bool nothing_left(const struct plot_sheet *sheet, int at, const struct plot_condition *c,
                         struct err *e)
{
    const char *told[MOST_TOLD];
    struct text values = {0};
    int n = 0;
    for (int i = 0; i < sheet->nrow && n < MOST_TOLD; i++) {
        const char *value = plot_sheet_at(sheet, i, at)->text;
        /* Each value once, and no more than a line holds. */
        bool known = false;
        for (int k = 0; k < n; k++) known = known || strcmp(told[k], value) == 0;
        if (known) continue;
        text_add(&values, "%s%.60s", n > 0 ? "; " : "", value[0] != '\0' ? value : "(none)");
        told[n++] = value;
    }
    err_set(e, ERR_NO_INPUT, "no row fulfils the condition on %s (%.60s); its values are: %s%s",
            c->key, c->value, values.s != NULL ? values.s : "none", n == MOST_TOLD ? "; ..." : "");
    text_free(&values);
    return false;
}

/* One condition: the rows that stay move up. */
static bool keep(struct plot_sheet *sheet, const struct plot_condition *c, struct err *e)
{
    const int at = plot_sheet_find(sheet, c->key, e);
    if (at < 0) return false;
    /* Only numbers have an order; equality and patterns hold for words, too. */
    const struct plot_column *column = &sheet->column[at];
    const bool ordered = c->operator >= PLOT_LESS && c->operator <= PLOT_AT_LEAST;
    double number = 0;
    char why[200] = "its values are words";
    if (ordered && (!column->number ||
                    !number_of(c->value, column->unit, &number, why, (int)sizeof why)))
        return err_set(e, ERR_USAGE, "--where %s: '%.60s': %s", c->key, c->value, why);
    /* Counted before anything moves: the message of an empty choice needs all rows. */
    int n = 0;
    for (int i = 0; i < sheet->nrow; i++)
        n += fulfils(plot_sheet_at(sheet, i, at), column, c, number);
    if (n == 0) return nothing_left(sheet, at, c, e);
    const size_t width = (size_t)sheet->ncolumn;
    n = 0;
    for (int i = 0; i < sheet->nrow; i++) {
        if (!fulfils(plot_sheet_at(sheet, i, at), column, c, number)) continue;
        memmove(&sheet->cell[(size_t)n * width], &sheet->cell[(size_t)i * width],
                width * sizeof *sheet->cell);
        sheet->run_id[n++] = sheet->run_id[i];
    }
    sheet->nrow = n;
    return true;
}

/* One after the other, so that a message can name the condition that left nothing. */
bool plot_where_keep(struct plot_sheet *sheet, int n, const struct plot_condition *c, struct err *e)
{
    if (sheet->nrow == 0)
        return err_set(e, ERR_NO_INPUT, "there is no row to draw: no run ended well");
    for (int i = 0; i < n; i++)
        if (!keep(sheet, &c[i], e)) return false;
    return true;
}

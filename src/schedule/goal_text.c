/* goal_text.c - schedules in the language GOAL: "rank 0 { a: send 8b to 1 tag 3 \n b requires a }".
 *
 * The language of LogGOPSim's txt2bin (Hoefler, Schneider and Lumsdaine, 2010): one operation or
 * dependency to a line, comments as in C++. Stricter: every rank comes once, labels are unique
 * within a rank, peers exist, what follows an operation on its line belongs to it.
 *
 * docs/schedules.md has the language for people. One pass, one token of look-ahead and no
 * recursion, so that nothing in a file sets a depth. Words are kept as places in the
 * file's text, which outlives the reader. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/picoseconds.h"
#include "base/size.h"
#include "schedule/schedule.h"

enum token { TOKEN_END, TOKEN_LINE, TOKEN_WORD, TOKEN_NUMBER, TOKEN_SIGN };

static const int64_t most_bytes = INT64_C(1) << 50; /* of one message: no sum of them wraps */

/* A label; one of an earlier rank is a free place. So the table need not be cleared for
 * each rank. */
struct label {
    const char *s;
    int length, rank; /* rank: how many came before it in the file, counted from 1 */
    int64_t op;
};

struct reader {
    const char *at, *end; /* what is left of the file */
    const char *path;
    struct err *err;
    int line;
    /* the token in hand */
    enum token token;
    const char *s;
    int length;
    int64_t number;
    bool negative;
    /* what it has become */
    struct schedule_builder *b;
    int64_t unit_ps;
    struct label *label; /* (capacity, a power of two) */
    int64_t nlabel, label_capacity;
    int rank; /* the rank in progress: how many came */
};

/* ---- words ---- */

/* By hand and not by ctype.h: what a letter is must not depend on the user's locale. */
static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/* Every refusal names line, what was found and what was expected; it returns false, so
 * that callers can hand it on. */
static bool refuse(struct reader *g, const char *expected)
{
    char found[64] = "the end of the line";
    if (g->token == TOKEN_END) snprintf(found, sizeof found, "the end of the file");
    else if (g->token != TOKEN_LINE)
        snprintf(found, sizeof found, "'%.*s'", g->length < 40 ? g->length : 40, g->s);
    return err_set_at(g->err, ERR_DATA, g->path, g->line, "%s where %s is expected", found,
                      expected);
}

/* A remark that other readers pass over says what the unit of computing times is.
 * LogGOPSim's computing times have no unit in the file. A remark keeps the file readable
 * for it. */
static bool read_unit(struct reader *g, const char *s, const char *end)
{
    static const char head[] = " mimdsim time unit:";
    static const struct {
        const char *word;
        int64_t ps;
    } units[] = {{"1 ps", 1}, {"1 ns", 1000}, {"1 us", 1000000}};
    if ((size_t)(end - s) < sizeof head - 1 || memcmp(s, head, sizeof head - 1) != 0) return true;
    s += sizeof head - 1;
    while (s < end && (*s == ' ' || *s == '\t')) s++;
    while (end > s && (end[-1] == ' ' || end[-1] == '\t' || end[-1] == '\r')) end--;
    for (int i = 0; i < 3; i++)
        if ((size_t)(end - s) == strlen(units[i].word) &&
            memcmp(s, units[i].word, (size_t)(end - s)) == 0) {
            g->unit_ps = units[i].ps;
            return true;
        }
    return err_set_at(g->err, ERR_DATA, g->path, g->line,
                      "a time unit of '%.*s'; expected 1 ps, 1 ns or 1 us",
                      (int)(end - s < 40 ? end - s : 40), s);
}

/* Past blanks and remarks; false: a remark does not end, or says something wrong. */
static bool skip(struct reader *g)
{
    while (g->at < g->end) {
        /* Lines within a remark count, so that messages name the right one. */
        const char *s = g->at;
        if (*s == ' ' || *s == '\t' || *s == '\r') {
            g->at++;
        } else if (g->end - s >= 2 && s[0] == '/' && s[1] == '/') {
            const char *stop = memchr(s, '\n', (size_t)(g->end - s));
            g->at = stop ? stop : g->end;
            if (!read_unit(g, s + 2, g->at)) return false;
        } else if (g->end - s >= 2 && s[0] == '/' && s[1] == '*') {
            const char *stop = memmem(s + 2, (size_t)(g->end - s - 2), "*/", 2);
            if (!stop)
                return err_set_at(g->err, ERR_DATA, g->path, g->line, "a remark that does not end");
            for (; s < stop; s++) g->line += *s == '\n';
            g->at = stop + 2;
        } else {
            break;
        }
    }
    return true;
}

/* Built-ins notice an overflow before it happens; the sign is kept apart, as -1 is the
 * only negative number that means anything. */
static bool read_number(struct reader *g)
{
    g->negative = *g->at == '-';
    g->at += g->negative;
    g->number = 0;
    for (; g->at < g->end && is_digit(*g->at); g->at++)
        if (__builtin_mul_overflow(g->number, 10, &g->number) ||
            __builtin_add_overflow(g->number, *g->at - '0', &g->number))
            return err_set_at(g->err, ERR_DATA, g->path, g->line, "a number of more than 63 bits");
    g->length = (int)(g->at - g->s);
    return true;
}

/* The next token; a line's end counts once, however many empty lines follow. */
static bool next(struct reader *g)
{
    /* The line moves on when its end is left behind, not when it is seen: errors at the
     * end of a line belong to it. */
    if (g->token == TOKEN_LINE) g->line++;
    if (!skip(g)) return false;
    g->s = g->at;
    g->length = 1;
    if (g->at == g->end) {
        g->token = TOKEN_END;
        return true;
    }
    const char c = *g->at;
    if (is_digit(c) || (c == '-' && g->end - g->at >= 2 && is_digit(g->at[1]))) {
        g->token = TOKEN_NUMBER;
        return read_number(g);
    }
    if (is_letter(c)) {
        g->token = TOKEN_WORD;
        while (g->at < g->end && (is_letter(*g->at) || is_digit(*g->at))) g->at++;
        if (g->at - g->s > 255)
            return err_set_at(g->err, ERR_DATA, g->path, g->line, "a word of over 255 letters");
        g->length = (int)(g->at - g->s);
        return true;
    }
    g->token = c == '\n' ? TOKEN_LINE : TOKEN_SIGN;
    g->at++;
    return true;
}

/* Where the language does not care about line ends. */
static bool next_but_lines(struct reader *g)
{
    do {
        if (!next(g)) return false;
    } while (g->token == TOKEN_LINE);
    return true;
}

static bool is(const struct reader *g, const char *word)
{
    return g->token >= TOKEN_WORD && g->length == (int)strlen(word) &&
           memcmp(g->s, word, (size_t)g->length) == 0;
}

/* The token in hand must be `word`; then the next. */
static bool expect(struct reader *g, const char *word)
{
    char expected[40];
    if (is(g, word)) return next(g);
    snprintf(expected, sizeof expected, "'%s'", word);
    return refuse(g, expected);
}

/* A number 0 .. most, or -1 where `any`; then the next token. */
static bool number(struct reader *g, int64_t most, bool any, const char *what, int64_t *out)
{
    char expected[80];
    snprintf(expected, sizeof expected, "%s from %d to %lld", what, any ? -1 : 0, (long long)most);
    if (g->token != TOKEN_NUMBER) return refuse(g, expected);
    const bool fine = g->negative ? any && g->number == 1 : g->number <= most;
    if (!fine) return refuse(g, expected);
    *out = g->negative ? -1 : g->number;
    return next(g);
}

/* ---- labels ---- */

static bool is_free(const struct reader *g, const struct label *l) { return l->rank != g->rank; }

/* Open addressing with linear steps; the table is at most half full (read_labelled), so a
 * free place is always near. */
static struct label *place_of(struct reader *g, const char *s, int length)
{
    uint64_t hash = UINT64_C(14695981039346656037); /* FNV-1a */
    for (int i = 0; i < length; i++) hash = (hash ^ (unsigned char)s[i]) * UINT64_C(1099511628211);
    for (;; hash++) {
        struct label *l = &g->label[hash & (uint64_t)(g->label_capacity - 1)];
        if (is_free(g, l) || (l->length == length && memcmp(l->s, s, (size_t)length) == 0))
            return l;
    }
}

/* Only labels of the rank in progress move to the new table. */
static void more_labels(struct reader *g)
{
    struct label *old = g->label;
    const int64_t n = g->label_capacity;
    g->label_capacity = n > 0 ? 2 * n : 1024;
    g->label = memory_zeroed((size_t)g->label_capacity, sizeof *g->label);
    for (int64_t i = 0; i < n; i++)
        if (!is_free(g, &old[i])) *place_of(g, old[i].s, old[i].length) = old[i];
    free(old);
}

/* ---- operations ---- */

/* "tag 3 cpu 0 nic 1" in this order, each at most once; a computing time has a cpu alone. */
static bool read_options(struct reader *g, struct schedule_op *op)
{
    /* Defaults are GOAL's: tag 0, processor 0. `nic` is checked and forgotten, as ports
     * are the machine's (docs/schedules.md). */
    int64_t cpu = 0, nic;
    const bool message = op->kind != SCHEDULE_COMPUTE;
    if (message && is(g, "tag") &&
        (!next(g) || !number(g, UINT32_MAX - 1, op->kind == SCHEDULE_RECEIVE, "a tag", &op->tag)))
        return false;
    if (is(g, "cpu") && (!next(g) || !number(g, UINT8_MAX, false, "a processor", &cpu)))
        return false;
    if (message && is(g, "nic") &&
        (!next(g) || !number(g, UINT8_MAX, false, "a network interface", &nic)))
        return false;
    op->cpu = (uint8_t)cpu;
    return true;
}

static bool read_message(struct reader *g, struct schedule_op *op)
{
    /* Receives alone may name anybody. */
    int64_t peer;
    const bool receive = op->kind == SCHEDULE_RECEIVE;
    if (!number(g, most_bytes, false, "a number of bytes", &op->size) || !expect(g, "b") ||
        !expect(g, receive ? "from" : "to") ||
        !number(g, g->b->s.nrank - 1, receive, "a rank", &peer))
        return false;
    op->peer = (int32_t)peer;
    return true;
}

static bool read_operation(struct reader *g, int64_t *number_of)
{
    struct schedule_op op = {.line = g->line};
    op.kind = is(g, "send") ? SCHEDULE_SEND : is(g, "recv") ? SCHEDULE_RECEIVE : SCHEDULE_COMPUTE;
    /* The kind decides what follows, in the order that GOAL fixes. */
    if (op.kind == SCHEDULE_COMPUTE && !is(g, "calc")) return refuse(g, "'send', 'recv' or 'calc'");
    if (!next(g)) return false;
    if (op.kind == SCHEDULE_COMPUTE ? !number(g, PS_LAST, false, "a time", &op.size)
                                    : !read_message(g, &op))
        return false;
    if (!read_options(g, &op)) return false;
    *number_of = schedule_add_op(g->b, &op);
    if (*number_of >= 0) return true;
    return err_set_at(g->err, ERR_DATA, g->path, g->line, "more than %d operations",
                      SCHEDULE_MOST_OPERATIONS);
}

/* Operations must stand above what refers to them: a single pass knows all it needs, and
 * most mistakes are found where they are made. */
static bool label_of(struct reader *g, int64_t *op)
{
    if (g->token != TOKEN_WORD) return refuse(g, "a label");
    struct label *l = place_of(g, g->s, g->length);
    if (is_free(g, l))
        return err_set_at(g->err, ERR_DATA, g->path, g->line,
                          "no operation above has the label '%.*s'",
                          g->length < 80 ? g->length : 80, g->s);
    *op = l->op;
    return next(g);
}

/* "label: operation" */
static bool read_labelled(struct reader *g, const char *s, int length)
{
    int64_t op;
    const int line = g->line;
    if (!next(g) || !read_operation(g, &op)) return false;
    /* The table grows before the search: growing moves its places. */
    if (2 * g->nlabel >= g->label_capacity) more_labels(g);
    struct label *l = place_of(g, s, length);
    if (!is_free(g, l))
        return err_set_at(g->err, ERR_DATA, g->path, line,
                          "a second operation with the label '%.*s'", length < 80 ? length : 80, s);
    *l = (struct label){s, length, g->rank, op};
    g->nlabel++;
    return true;
}

/* "label requires label" */
static bool read_dependency(struct reader *g, const char *s, int length)
{
    int64_t op, on = 0;
    const bool start = is(g, "irequires");
    const struct label *l = place_of(g, s, length);
    if (is_free(g, l))
        return err_set_at(g->err, ERR_DATA, g->path, g->line,
                          "no operation above has the label '%.*s'", length < 80 ? length : 80, s);
    /* The label's operation waits for the one that is named behind the word. */
    op = l->op;
    if (!next(g) || !label_of(g, &on)) return false;
    return schedule_add_dependency(g->b, op, on, start) ||
           err_set_at(g->err, ERR_DATA, g->path, g->line, "too many dependencies");
}

static bool read_statement(struct reader *g)
{
    int64_t op;
    const char *s = g->s;
    const int length = g->length;
    if (g->token != TOKEN_WORD) return refuse(g, "an operation, a label or '}'");
    /* Three kinds of line; a label may not be called like an operation. */
    if (is(g, "send") || is(g, "recv") || is(g, "calc")) {
        if (!read_operation(g, &op)) return false;
    } else {
        if (!next(g)) return false;
        if (is(g, ":")) {
            if (!read_labelled(g, s, length)) return false;
        } else if (is(g, "requires") || is(g, "irequires")) {
            if (!read_dependency(g, s, length)) return false;
        } else {
            return refuse(g, "':', 'requires' or 'irequires'");
        }
    }
    return g->token == TOKEN_LINE || is(g, "}") || refuse(g, "the end of the line");
}

/* ---- ranks ---- */

static bool read_rank(struct reader *g)
{
    int64_t rank;
    const int line = g->line;
    if (!expect(g, "rank") || !number(g, g->b->s.nrank - 1, false, "a rank", &rank)) return false;
    /* Ranks come in any order, each once. A new number of the rank makes all labels
     * before it free places. */
    if (g->b->begin[rank] >= 0)
        return err_set_at(g->err, ERR_DATA, g->path, line, "rank %lld a second time",
                          (long long)rank);
    if (!is(g, "{")) return refuse(g, "'{'");
    g->b->begin[rank] = g->b->s.nop;
    g->nlabel = 0;
    g->rank++;
    if (!next_but_lines(g)) return false;
    while (!is(g, "}")) {
        if (!read_statement(g)) return false;
        if (g->token == TOKEN_LINE && !next_but_lines(g)) return false;
    }
    g->b->end[rank] = g->b->s.nop;
    return next_but_lines(g);
}

static bool read_ranks(struct reader *g)
{
    int64_t nrank;
    if (!next_but_lines(g)) return false;
    if (!is(g, "num_ranks")) return refuse(g, "'num_ranks'");
    if (!next(g) || !number(g, SCHEDULE_MOST_RANKS, false, "a number of ranks", &nrank))
        return false;
    if (nrank == 0) return err_set_at(g->err, ERR_DATA, g->path, g->line, "a schedule of 0 ranks");
    /* A rank without operations has to be there, too: one that is missing is more often a
     * file that was cut off. */
    schedule_begin(g->b, (int)nrank);
    if (g->token == TOKEN_LINE && !next_but_lines(g)) return false;
    while (g->token != TOKEN_END)
        if (!read_rank(g)) return false;
    for (int i = 0; i < nrank; i++)
        if (g->b->begin[i] < 0)
            return err_set_at(g->err, ERR_DATA, g->path, g->line,
                              "no schedule of rank %d; expected %lld ranks, each once",
                              i, (long long)nrank);
    return true;
}

struct schedule *goal_read_text(const char *text, size_t n, const char *path, struct arena *a,
                                struct err *e)
{
    struct schedule_builder b = {0};
    struct reader g = {.at = text,
                       .end = text + n,
                       .path = path,
                       .err = e,
                       .line = 1,
                       .b = &b,
                       .token = TOKEN_END};
    struct schedule *s = NULL;
    /* The first call makes the table. */
    more_labels(&g);
    if (read_ranks(&g)) s = schedule_finish(&b, path, a, e);
    if (s) s->unit_ps = g.unit_ps;
    free(g.label);
    schedule_discard(&b);
    return s;
}

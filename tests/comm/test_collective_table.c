/* test_collective_table.c - the table of algorithms in docs/collectives.md says what the code
 * says. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "comm/collectives.h"

/* The letters of the formulas. */
struct letters {
    int64_t value[128];
};

static struct letters letters_of(int P, int64_t m, int64_t n)
{
    struct letters l = {{0}};
    int64_t Q = 1, q = 0, L = 0, B = 0, D = 0;
    for (; 2 * Q <= P; Q *= 2) q++;
    for (; 1 << L < P; L++) D += P - (1 << L) + (P > 3 << L ? P - (3 << L) : 0);
    for (int d = 1; d < P; d++) B += __builtin_popcount((unsigned)d);
    l.value['P'] = P, l.value['Q'] = Q, l.value['q'] = q, l.value['R'] = P - Q, l.value['L'] = L,
    l.value['B'] = B;
    l.value['D'] = D, l.value['S'] = (n + 8191) / 8192, l.value['m'] = m, l.value['n'] = n;
    return l;
}

static int64_t sum(const char **s, const struct letters *l);

static int64_t atom(const char **s, const struct letters *l)
{
    int64_t x = 0;
    if (**s == '(') {
        (*s)++;
        x = sum(s, l);
        if (**s == '>') {
            (*s)++;
            x = x > sum(s, l);
        }
        assert_int_equal(**s, ')');
        (*s)++;
    } else if (**s >= '0' && **s <= '9') {
        while (**s >= '0' && **s <= '9') x = 10 * x + *(*s)++ - '0';
    } else {
        assert_non_null(strchr("PQqRLBDSmn", **s));
        x = l->value[(int)*(*s)++];
    }
    if (**s != '^') return x;
    (*s)++;
    int64_t power = 1;
    for (int64_t k = atom(s, l); k > 0; k--) power *= x;
    return power;
}

static int64_t product(const char **s, const struct letters *l)
{
    int64_t x = atom(s, l);
    while (**s == '*' || **s == '/') {
        bool times = *(*s)++ == '*';
        int64_t y = atom(s, l);
        if (!times) assert_int_equal(x % y, 0);
        x = times ? x * y : x / y;
    }
    return x;
}

static int64_t sum(const char **s, const struct letters *l)
{
    int64_t x = product(s, l);
    while (**s == '+' || **s == '-') {
        bool plus = *(*s)++ == '+';
        int64_t y = product(s, l);
        x += plus ? y : -y;
    }
    return x;
}

static void formula(const char *cell, const struct letters *l, int64_t wanted, const char *row)
{
    const char *s = cell;
    assert_int_equal(*s++, '`');
    int64_t found = sum(&s, l);
    if (*s != '`' || found != wanted)
        fail_msg("P = %d: %s is %lld, the code says %lld, in: %s", (int)l->value['P'], cell,
                 (long long)found, (long long)wanted, row);
}

enum { CELLS = 8 };

/* At every number of ranks at which the algorithm applies. */
static void check_row(char *cell[CELLS], const char *row)
{
    enum collective_kind kind = collective_find(cell[0]);
    assert_int_not_equal(kind, COLLECTIVE_KINDS);
    const struct collective_algorithm *a = collective_algorithm_find(kind, cell[1]);
    if (!a) fail_msg("no such algorithm: %s", row);
    assert_string_equal(cell[2], a->needs ? a->needs : "-");
    for (int P = 2; P <= 40; P++) {
        const int64_t m = kind == COLLECTIVE_BARRIER ? 0 : (int64_t)1024 * P * 32;
        const struct collective_shape s = {kind, P, 0, m, m * P, 8, false, true, true, false,
                                            COMM_OWN, NULL};
        const struct letters l = letters_of(P, m, 8 * m);
        struct collective_cost c;
        if (!collective_applies(a, &s)) continue;
        a->cost(&s, &c);
        formula(cell[3], &l, c.messages, row);
        formula(cell[4], &l, c.bytes, row);
        formula(cell[5], &l, c.rounds, row);
        if (c.path >= 0) formula(cell[6], &l, c.path, row);
        formula(cell[7], &l, c.combined, row);
    }
}

/* The cells of "| a | b | ... |"; false for other lines. */
static bool cells(char *line, char *cell[CELLS])
{
    char *s = line;
    if (*s++ != '|') return false;
    for (int i = 0; i < CELLS; i++) {
        char *end = strstr(s, " |");
        if (!end) return false;
        cell[i] = s + strspn(s, " ");
        *end = '\0';
        s = end + 2;
    }
    return true;
}

static void the_documents_table_is_the_codes(void **state)
{
    (void)state;
    char path[4096], line[1024], row[1024], *cell[CELLS];
    const char *source = getenv("srcdir");
    int rows = 0, known = 0;
    snprintf(path, sizeof path, "%s/docs/collectives.md", source ? source : "..");
    FILE *f = fopen(path, "r");
    if (!f) fail_msg("%s cannot be read", path);
    while (fgets(line, sizeof line, f)) {
        strcpy(row, line);
        if (!cells(line, cell) || strcmp(cell[0], "collective") == 0 ||
            strncmp(cell[0], "---", 3) == 0)
            continue;
        check_row(cell, row);
        rows++;
    }
    fclose(f);
    for (int kind = 0; kind < COLLECTIVE_KINDS; kind++) {
        int n;
        collective_algorithms((enum collective_kind)kind, &n);
        known += n;
    }
    assert_int_equal(rows, known);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_documents_table_is_the_codes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_mutants.c - the check of reference files is itself checked: seeded faults are put into their
 * answers and keys.
 *
 * Each mutant is one case of a file with one fault: a digit, the sign or the factor 3 of a number,
 * two answers exchanged, a key dropped or misspelt. It is killed when the file is refused or a
 * verdict is FAIL. Those that change an answer by more than ten times its tolerance must all be
 * killed; so must all keys that are dropped or misspelt. */
#include "config.h"

#include <ctype.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/scratch.h"
#include "base/arena.h"
#include "base/random.h"
#include "base/text.h"
#include "study/netcheck_verdict.h"

#define DATA MIMDSIM_SRCDIR "/tests/data/net/"

#ifdef SANITIZERS /* slow, and every kind of fault is in each case */
enum { SHARE = 4, MUTANTS = 6 };
#else
enum { SHARE = 1, MUTANTS = 12 };
#endif
enum { SEED = 20261122, MOST_PLACES = 8192, MOST_CASES = 1024 };
enum fault { DIGIT, SIGN, TRIPLE, EXCHANGE, DROP, MISSPELL, FAULTS };
static const char *const fault_names[] = {"digit",    "sign",        "factor 3",
                                          "exchange", "dropped key", "misspelt key"};

/* A number of a case: where it stands, and the keys above it. */
struct place {
    int begin, end;
    char key[48]; /* of the innermost map that holds it */
    char outer[48];
    int list; /* number of the innermost list, 0: none */
};

struct key_place {
    int begin, end; /* "key": value with the comma behind it or before it */
    int name;       /* where its first letter is */
    char key[48];
};

struct sample {
    const char *text; /* one case */
    int length;
    struct place place[MOST_PLACES];
    struct key_place key[256];
    int nplace, nkey;
    double tolerance; /* of a makespan, a latency or a load */
    double message;   /* of one arrival */
};

struct tally {
    int made[FAULTS], killed[FAULTS], must[FAULTS], must_killed[FAULTS];
};

/* ---- reading a case as text ---- */

struct scan {
    char key[32][48];
    bool map[32];
    int list[32], nlist, depth;
};

static int string_end(const char *s, int i)
{
    for (i++; s[i] != '"'; i++) i += s[i] == '\\';
    return i + 1;
}

/* the value that begins at i ends there */
static int value_end(const char *s, int i)
{
    int depth = 0;
    do {
        if (s[i] == '"') {
            i = string_end(s, i);
            continue;
        }
        depth += (s[i] == '{' || s[i] == '[') - (s[i] == '}' || s[i] == ']');
        i++;
    } while (depth > 0 || (s[i] != ',' && s[i] != '}' && s[i] != ']'));
    return i;
}

static void note_number(struct sample *c, struct scan *scan, int begin, int end)
{
    if (c->nplace == MOST_PLACES) return;
    struct place *p = &c->place[c->nplace++];
    int d = scan->depth;
    *p = (struct place){.begin = begin, .end = end, .list = scan->map[d] ? 0 : scan->list[d]};
    text_copy(p->key, sizeof p->key, scan->key[d]);
    while (d > 0 && !scan->map[d]) d--;
    text_copy(p->outer, sizeof p->outer, d > 1 ? scan->key[d - 1] : "");
}

static int note_key(struct sample *c, struct scan *scan, int i)
{
    int end = string_end(c->text, i), value = end;
    snprintf(scan->key[scan->depth], sizeof scan->key[0], "%.*s", end - i - 2, c->text + i + 1);
    while (c->text[value] == ':' || isspace((unsigned char)c->text[value])) value++;
    if (scan->depth == 1 && c->nkey < 256) {
        struct key_place *k = &c->key[c->nkey++];
        *k = (struct key_place){.begin = i, .end = value_end(c->text, value), .name = i + 1};
        text_copy(k->key, sizeof k->key, scan->key[1]);
        if (c->text[k->end] == ',') k->end++;
        else
            while (c->text[k->begin - 1] == ' ' || c->text[k->begin - 1] == ',') k->begin--;
    }
    return value;
}

/* numbers and keys of the case */
static void scan_case(struct sample *c)
{
    struct scan scan = {.depth = 0};
    bool expect_key = false;
    for (int i = 0; i < c->length;) {
        char x = c->text[i];
        if (x == '{' || x == '[') {
            scan.depth++;
            scan.map[scan.depth] = x == '{';
            scan.list[scan.depth] = ++scan.nlist;
            text_copy(scan.key[scan.depth], sizeof scan.key[0],
                      x == '[' ? scan.key[scan.depth - 1] : "");
            expect_key = x == '{';
            i++;
        } else if (x == '"' && expect_key) {
            i = note_key(c, &scan, i);
            expect_key = false;
        } else if (x == '"') {
            i = string_end(c->text, i);
        } else if (isdigit((unsigned char)x) || x == '-') {
            int begin = i;
            while (strchr("+-.eE0123456789", c->text[i])) i++;
            note_number(c, &scan, begin, i);
        } else {
            if (x == '}' || x == ']') scan.depth--;
            if (x == ',') expect_key = scan.map[scan.depth];
            i++;
        }
    }
}

/* the cases of a file: text between the brackets of the outermost list */
static int cases_of(const char *s, const char *begin[MOST_CASES], int length[MOST_CASES])
{
    int n = 0, i = 0;
    while (s[i] != '[') i++;
    for (i++; s[i]; i++) {
        if (s[i] != '{' || n == MOST_CASES) continue;
        int end = value_end(s, i);
        begin[n] = s + i;
        length[n++] = end - i;
        i = end - 1;
    }
    return n;
}

/* ---- faults ---- */

/* what is said of a file with this case, and another one `with` it (NULL: none): refused or FAIL;
 * the tightest tolerances when `c` wants them */
static bool killed(const char *text, const char *with, const char *path, struct sample *c)
{
    struct arena *a = arena_create();
    struct netcheck n;
    struct err e;
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "[%s%s%s]\n", text, with ? ",\n" : "", with ? with : "");
    fclose(f);
    err_clear(&e);
    bool read = netcheck_run(&n, path, NULL, NULL, true, a, &e),
         good = read && netcheck_pass(&n, -1);
    if (c) c->tolerance = c->message = good ? INFINITY : 0;
    for (int i = 0; c && good && i < n.nrow; i++)
        for (int l = 0; l < LEVELS; l++) {
            const struct netcheck_accuracy *s =
                netcheck_accuracy_of(&n.row[i], (enum network_level)l);
            if (!n.row[i].counted || !n.row[i].answer[l].ran) continue;
            c->tolerance = fmin(c->tolerance, fmax(-s->low, s->high));
            if (s->message >= 0) c->message = fmin(c->message, s->message);
        }
    arena_destroy(a);
    return !good;
}

enum answer { NO_ANSWER, WHOLE, MESSAGE, VARIANT, DERIVED };

/* which keys hold answers, and of what kind */
static enum answer answer_of(const struct place *p)
{
    static const struct {
        const char *key;
        enum answer answer;
    } known[] = {{"makespan", WHOLE},
                 {"completion", MESSAGE},
                 {"plat", WHOLE},
                 {"saturation_low", WHOLE},
                 {"saturation_high", WHOLE},
                 {"expected_vct", MESSAGE},
                 {"messages", DERIVED},
                 {"zero_load_makespan", DERIVED},
                 {"mean_completion", DERIVED},
                 {"max_hops", DERIVED},
                 {"mean_hops", DERIVED},
                 {"nodes", DERIVED},
                 {"packets", DERIVED},
                 {"flit_hops", DERIVED},
                 {"channel_bound", DERIVED},
                 {"max_channel_load_per_unit_injection", DERIVED}};
    if (strcmp(p->outer, "booksim") == 0 || strcmp(p->outer, "expected_wormhole") == 0)
        return MESSAGE;
    if (strcmp(p->outer, "makespan_by_variant") == 0) return VARIANT;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(p->key, known[i].key) == 0) return known[i].answer;
    return NO_ANSWER;
}

static double number_at(const struct sample *c, const struct place *p)
{
    return strtod(c->text + p->begin, NULL);
}

static void put(struct text *t, const struct sample *c, const struct place *p, double x)
{
    char number[32];
    text_real(number, x);
    text_add_bytes(t, c->text, (size_t)p->begin);
    text_add(t, "%s", number);
    text_add_bytes(t, c->text + p->end, (size_t)(c->length - p->end));
}

/* one digit becomes another; the new number */
static double other_digit(const struct sample *c, const struct place *p, struct random *r)
{
    char number[40];
    int n = p->end - p->begin, at;
    snprintf(number, sizeof number, "%.*s", n, c->text + p->begin);
    do at = (int)random_below(r, (uint64_t)n);
    while (!isdigit((unsigned char)number[at]));
    number[at] = (char)('0' + (number[at] - '0' + 1 + (int)random_below(r, 9)) % 10);
    return strtod(number, NULL);
}

/* the change of an answer in units of its tolerance; exact ones change infinitely */
static double change_of(const struct sample *c, const struct place *p, double from, double to)
{
    enum answer answer = answer_of(p);
    double tolerance = answer == WHOLE     ? c->tolerance
                       : answer == MESSAGE ? c->message
                       : answer == VARIANT ? 0.3 /* 15 % about a spread of 2 */
                                           : 1e-3;
    if (answer == NO_ANSWER || from == to) return 0;
    return tolerance > 0 ? fabs(to - from) / fmax(fabs(from), 1e-9) / tolerance : INFINITY;
}

static bool mutate_number(struct sample *c, enum fault fault, struct random *r, struct text *t,
                          double *change)
{
    const struct place *p = &c->place[random_below(r, (uint64_t)c->nplace)];
    double from = number_at(c, p), to = fault == SIGN     ? -from
                                        : fault == TRIPLE ? 3 * from
                                                          : other_digit(c, p, r);
    if (answer_of(p) == NO_ANSWER || to == from) return false;
    *change = change_of(c, p, from, to);
    put(t, c, p, to);
    return true;
}

static bool mutate_exchange(struct sample *c, struct random *r, struct text *t, double *change)
{
    const struct place *p = &c->place[random_below(r, (uint64_t)c->nplace)], *q = NULL;
    for (int i = 0; !q && i < 64; i++) {
        const struct place *other = &c->place[random_below(r, (uint64_t)c->nplace)];
        if (other->list == p->list && other->begin > p->begin) q = other;
    }
    if (strstr(c->text, "\"order_free\": true")) return false; /* they are a set */
    if (!q || p->list == 0 || answer_of(p) != MESSAGE || number_at(c, p) == number_at(c, q))
        return false;
    double x = number_at(c, p), y = number_at(c, q);
    *change = fmax(change_of(c, p, x, y), change_of(c, q, y, x));
    text_add_bytes(t, c->text, (size_t)p->begin);
    text_add(t, "%.*s", q->end - q->begin, c->text + q->begin);
    text_add_bytes(t, c->text + p->end, (size_t)(q->begin - p->end));
    text_add(t, "%.*s", p->end - p->begin, c->text + p->begin);
    text_add_bytes(t, c->text + q->end, (size_t)(c->length - q->end));
    return true;
}

/* Keys without which nothing changes: remarks, and what only some cases have. */
static bool key_matters(const char *key)
{
    static const char *const without[] = {"log2_distance",
                                          "S",
                                          "o",
                                          "smax",
                                          "booksim_cpu_s",
                                          "distance",
                                          "split",
                                          "agree",
                                          "derivation",
                                          "criterion",
                                          "pipeline",
                                          "order_free",
                                          "overdriven_accepted",
                                          "expected_wormhole",
                                          "expected",
                                          "name"};
    for (size_t i = 0; i < sizeof without / sizeof *without; i++)
        if (strcmp(key, without[i]) == 0) return false;
    return true;
}

static bool mutate_key(struct sample *c, enum fault fault, struct random *r, struct text *t,
                       double *change)
{
    const struct key_place *k = &c->key[random_below(r, (uint64_t)c->nkey)];
    int length = (int)strlen(k->key);
    if (fault == MISSPELL && length < 3) return false;
    *change = key_matters(k->key) ? INFINITY : 0;
    if (fault == DROP) {
        text_add_bytes(t, c->text, (size_t)k->begin);
        text_add_bytes(t, c->text + k->end, (size_t)(c->length - k->end));
        return true;
    }
    /* two letters change places */
    int at = k->name + 1 + (int)random_below(r, (uint64_t)(length - 2));
    if (c->text[at] == c->text[at + 1]) return false;
    text_add_bytes(t, c->text, (size_t)at);
    text_add(t, "%c%c", c->text[at + 1], c->text[at]);
    text_add_bytes(t, c->text + at + 2, (size_t)(c->length - at - 2));
    return true;
}

static bool mutate(struct sample *c, enum fault fault, struct random *r, struct text *t,
                   double *change)
{
    *change = 0;
    if (fault == DROP || fault == MISSPELL) return mutate_key(c, fault, r, t, change);
    if (fault == EXCHANGE) return mutate_exchange(c, r, t, change);
    return mutate_number(c, fault, r, t, change);
}

static void try_case(struct sample *c, int mutants, const char *path, struct random *r,
                     struct tally *tally)
{
    for (int i = 0; i < mutants; i++) {
        enum fault fault = (enum fault)(i % FAULTS);
        struct text t = {0};
        double change;
        bool made = false;
        for (int k = 0; !made && k < 200; k++) {
            text_free(&t);
            made = mutate(c, fault, r, &t, &change);
        }
        if (made) {
            bool dead = killed(t.s, fault == DROP ? c->text : NULL, path, NULL), must = change > 10;
            tally->made[fault]++;
            tally->killed[fault] += dead;
            tally->must[fault] += must;
            tally->must_killed[fault] += must && dead;
            if (must && !dead) print_message("alive (%s): %.300s\n", fault_names[fault], t.s);
        }
        text_free(&t);
    }
}

/* `ncase` cases of the file, or their share, drawn, with MUTANTS faults each */
static void mutants_die(const char *file, int ncase)
{
    char folder[256], path[300];
    struct err e;
    struct text text = {0};
    struct tally tally = {.made = {0}};
    const char *begin[MOST_CASES];
    int length[MOST_CASES];
    struct random r = random_make(SEED, 0, 0);
    struct sample *c = malloc(sizeof *c);
    err_clear(&e);
    assert_non_null(c);
    scratch_make(folder, sizeof folder);
    scratch_path(path, sizeof path, folder, "mutant.json");
    assert_true(text_read_file(&text, file, &e));
    int n = cases_of(text.s, begin, length);
    assert_true(n > 0);
    for (int i = 0; i < ncase; i += SHARE) {
        int at = (int)random_below(&r, (uint64_t)n);
        char *one = strndup(begin[at], (size_t)length[at]);
        *c = (struct sample){.text = one, .length = length[at]};
        scan_case(c);
        if (killed(one, NULL, path, c)) fail_msg("not even the true case passes: %.300s", one);
        try_case(c, MUTANTS, path, &r, &tally);
        free(one);
    }
    text_free(&text);
    scratch_remove(folder);
    free(c);
    print_message("%s\n", strrchr(file, '/') + 1);
    int alive = 0;
    for (int f = 0; f < FAULTS; f++) {
        print_message("  %-12s %4d of %4d killed (%3.0f %%); beyond ten tolerances %4d of %4d\n",
                      fault_names[f], tally.killed[f], tally.made[f],
                      tally.made[f] ? 100.0 * tally.killed[f] / tally.made[f] : 100.0,
                      tally.must_killed[f], tally.must[f]);
        alive += tally.must[f] - tally.must_killed[f];
    }
    assert_int_equal(alive, 0);
}

static void makespans(void **state)
{
    (void)state;
    mutants_die(DATA "makespan.json", 60);
}

static void bands(void **state)
{
    (void)state;
    mutants_die(DATA "makespan_sensitivity.json", 20);
}

static void collectives(void **state)
{
    (void)state;
    mutants_die(DATA "collectives.json", 16);
}

static void cases_by_hand(void **state)
{
    (void)state;
    mutants_die(DATA "hand_cases.json", 30);
}

static void latencies(void **state)
{
    (void)state;
    mutants_die(DATA "latency_load.json", 3);
}

static void saturations(void **state)
{
    (void)state;
    mutants_die(DATA "saturation.json", 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(makespans),     cmocka_unit_test(bands),     cmocka_unit_test(collectives),
        cmocka_unit_test(cases_by_hand), cmocka_unit_test(latencies), cmocka_unit_test(saturations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_verify_mutants.c - the checker checked: changed answers are found, and how many of them is
 * printed. */
#include "config.h"

#include <glob.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/random.h"
#include "base/text.h"
#include "dynamics/system.h"
#include "model/vector_model.h"
#include "study/verify.h"
#include "study/verify_answers.h"
#include "vector_mutant.h"

#define DATA(file) MIMDSIM_SRCDIR "/tests/data/vectors/" file

#ifdef SANITIZERS /* slow, and files of one kind are read alike */
enum { EACH = 3, STEP = 4 };
#else
enum { EACH = 12, STEP = 1 };
#endif
enum { MOST_NUMBERS = 20000 };

/* The keys of answers, as the file has them, and where their numbers stand in struct
 * verify_answers. */
static const struct answer_key {
    const char *key, *inside;
    enum verify_quantity quantity;
} answer_key[] = {
    {"tau_id", NULL, VERIFY_TAU_ID},         {"qdd_fd", NULL, VERIFY_QDD_FD},
    {"bias", NULL, VERIFY_BIAS},             {"gravity_torque", NULL, VERIFY_GRAVITY_TORQUE},
    {"lambda", NULL, VERIFY_LAMBDA},         {"M", NULL, VERIFY_MASS_MATRIX},
    {"joint_wrench_id", NULL, VERIFY_WRENCH}, {"kinetic", "energy", VERIFY_KINETIC},
    {"potential", "energy", VERIFY_POTENTIAL}, {"linear", "momentum", VERIFY_LINEAR},
    {"angular_about_world_origin", "momentum", VERIFY_ANGULAR}, {"com_world", NULL, VERIFY_COM},
    {"total_mass", NULL, VERIFY_TOTAL_MASS},
};
enum { KEYS = sizeof answer_key / sizeof *answer_key };

/* Numbers of an answer: "tau_id" stands in the list of floors too, which the files have behind the
 * answers. */
static int numbers_of(const char *text, const struct answer_key *k, const char **number)
{
    const char *from = k->inside ? vector_text_key(text, k->inside) : NULL;
    if (k->inside && !from) return 0;
    return vector_text_numbers(text, k->key, from, number, MOST_NUMBERS);
}

static char *text_of(const char *path)
{
    struct text t = {0};
    struct err e;
    err_clear(&e);
    assert_true(text_read_file(&t, path, &e));
    return t.s;
}

static void write_text(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs(text, out);
    fclose(out);
}

static bool verify_text(const char *text, bool parallel, struct arena *a, struct verify_report *r,
                        struct err *e)
{
    char path[] = P_tmpdir "/mimdsim-mutant-XXXXXX";
    const struct verify_options o = {.parallel = parallel};
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    close(fd);
    write_text(path, text);
    err_clear(e);
    bool good = verify_file(path, &o, a, r, e);
    unlink(path);
    return good;
}

/* --- all answers at once ---------------------------------------------------------------------- */

enum change { DOUBLED, NEGATED, TURNED, CHANGES };
static const char *const change_name[CHANGES] = {"doubled", "negated", "permuted"};

/* All numbers of a key changed; permuted: each takes the place of the one before it, the last one's
 * of the first. */
static char *text_changed(char *text, const struct answer_key *k, enum change change)
{
    static const char *number[MOST_NUMBERS];
    static double x[MOST_NUMBERS];
    static size_t at[MOST_NUMBERS], length[MOST_NUMBERS];
    int n = numbers_of(text, k, number);
    for (int i = 0; i < n; i++) {
        x[i] = strtod(number[i], NULL);
        at[i] = (size_t)(number[i] - text);
        length[i] = (size_t)(vector_text_end(number[i]) - number[i]);
    }
    for (int i = n - 1; i >= 0; i--) { /* from the end, so that the places before stay true */
        char with[32];
        double y = change == DOUBLED ? 2 * x[i] : change == NEGATED ? -x[i] : x[(i + 1) % n];
        text_real(with, y);
        char *next = vector_text_put(text, text + at[i], length[i], with);
        free(text);
        text = next;
    }
    return text;
}

/* Do all numbers of the answer stay what they are? */
static bool same_answer(const char *text, const char *changed, const struct answer_key *k)
{
    static const char *x[MOST_NUMBERS], *y[MOST_NUMBERS];
    int n = numbers_of(text, k, x);
    if (numbers_of(changed, k, y) != n) return false;
    for (int i = 0; i < n; i++)
        if (strtod(x[i], NULL) != strtod(y[i], NULL)) return false;
    return true;
}

/* Rows of the quantity that still say that the changed answer is right. */
static int accepted(const struct verify_report *r, enum verify_quantity k, const char *what)
{
    int n = 0;
    for (int i = 0; i < r->nrow; i++) {
        const struct verify_row *row = &r->row[i];
        if (strcmp(row->quantity, verify_quantity_name(k)) != 0) continue;
        if (row->verdict == VERIFY_FAIL || row->verdict == VERIFY_NOT_APPLICABLE) continue;
        fprintf(stderr, "%s %s: %s says %s (error %.1e)\n", r->name, what, row->algorithm,
                verify_verdict_word(row->verdict), row->error);
        n++;
    }
    return n;
}

static int file_accepts(const char *path, bool parallel)
{
    int wrong = 0;
    char *text = text_of(path);
    for (int change = 0; change < CHANGES; change++) {
        struct arena *a = arena_create();
        struct verify_report r;
        struct err e;
        char *changed = strdup(text);
        for (int k = 0; k < KEYS; k++)
            changed = text_changed(changed, &answer_key[k], (enum change)change);
        if (!verify_text(changed, parallel, a, &r, &e)) fail_msg("%s: %s", path, e.text);
        for (int k = 0; k < KEYS; k++)
            if (!same_answer(text, changed, &answer_key[k]))
                wrong += accepted(&r, answer_key[k].quantity, change_name[change]);
        free(changed);
        arena_destroy(a);
    }
    free(text);
    return wrong;
}

static void no_row_accepts_changed_answers(void **state)
{
    (void)state;
    glob_t files;
    int wrong = 0;
    assert_int_equal(glob(DATA("*.json"), 0, NULL, &files), 0);
    for (size_t i = 0; i < files.gl_pathc; i += STEP) {
        const char *path = files.gl_pathv[i];
        bool small = strstr(path, "n000") || strstr(path, "closed_f") || strstr(path, "x_m") ||
                     strstr(path, "tiny");
        wrong += file_accepts(path, small);
    }
    globfree(&files);
    assert_int_equal(wrong, 0);
}

/* Poses have maps of their own: each vector of each is changed in turn. */
static void no_row_accepts_changed_poses(void **state)
{
    (void)state;
    static const char *const key[] = {"R", "p", "v", "w", "a", "alpha"};
    char *text = text_of(DATA("float_rev_n0008.json"));
    const char *fk = vector_text_key(text, "fk");
    for (int k = 0; k < 6; k++)
        for (int change = 0; change < CHANGES; change++) {
            const char *number[9];
            struct arena *a = arena_create();
            struct verify_report r;
            struct err e;
            char with[32], *changed = strdup(text);
            int n = vector_text_numbers(changed, key[k], changed + (fk - text), number, 9);
            double x = strtod(number[0], NULL), y = strtod(number[n - 1], NULL);
            text_real(with, change == DOUBLED ? 2 * x : change == NEGATED ? -x : y);
            char *next = vector_text_put(changed, number[0],
                                         (size_t)(vector_text_end(number[0]) - number[0]), with);
            assert_true(verify_text(next, false, a, &r, &e));
            assert_int_equal(accepted(&r, VERIFY_FK, change_name[change]), 0);
            free(changed);
            free(next);
            arena_destroy(a);
        }
    free(text);
}

/* Forces of 1e-8 N at the base, torques of 1e-18 N m in the joints: each joint's torque alone, off
 * by a millionth. */
static void small_torques_are_checked_beside_large_forces(void **state)
{
    (void)state;
    char *text = text_of(DATA("x_molecular_float_n0032.json"));
    const char *number[64];
    int n = vector_text_numbers(text, "tau_id", NULL, number, 64), checked = 0;
    for (int i = 6; i < n; i += 5) {
        struct arena *a = arena_create();
        struct verify_report r;
        struct err e;
        char with[32];
        text_real(with, strtod(number[i], NULL) * 1.000001);
        char *changed = vector_text_put(text, number[i],
                                        (size_t)(vector_text_end(number[i]) - number[i]), with);
        assert_true(verify_text(changed, false, a, &r, &e));
        assert_int_equal(accepted(&r, VERIFY_TAU_ID, "off by a millionth"), 0);
        checked++;
        free(changed);
        arena_destroy(a);
    }
    assert_true(checked > 5);
    free(text);
}

/* A motion: every kind of number of its last state but one, and the same state in 45 digits. */
static void no_changed_motion_passes(void **state)
{
    (void)state;
    static const struct { const char *key, *quantity; } part[] = {
        {"kinetic", "energy.kinetic"}, {"potential", "energy.potential"}, {"total", "energy.total"},
        {"linear", "momentum.linear"}, {"angular_about_world_origin", "momentum.angular"}, {"q",
         "states"},
        {"qd", "states"}};
    char *text = text_of(DATA("trajectories/traj_double_pendulum_point.json"));
    const char *states = vector_text_key(text, "states"), *middle = states + (strlen(states) / 4);
    for (size_t k = 0; k < sizeof part / sizeof *part; k++)
        for (int change = 0; change < 2; change++) {
            const char *number[8];
            struct arena *a = arena_create();
            struct verify_report r;
            struct err e;
            char with[32];
            int n = vector_text_numbers(text, part[k].key, middle, number, 8), i = n - 1;
            while (i > 0 && strtod(number[i], NULL) == 0) i--; /* a planar motion has zeros */
            text_real(with, strtod(number[i], NULL) * (change == DOUBLED ? 2 : -1));
            char *changed = vector_text_put(text, number[i],
                                            (size_t)(vector_text_end(number[i]) - number[i]), with);
            assert_true(verify_text(changed, false, a, &r, &e));
            bool found = false;
            for (int row = 0; row < r.nrow; row++)
                found = found || (strcmp(r.row[row].quantity, part[k].quantity) == 0 &&
                                  r.row[row].verdict == VERIFY_FAIL);
            if (r.passed || !found)
                fail_msg("%s %s is not found", part[k].key, change_name[change]);
            free(changed);
            arena_destroy(a);
        }
    free(text);
}

/* --- one small change at a time --------------------------------------------------------------- */

enum mutation { DIGIT, SIGN, EXCHANGE, DROPPED, MISSPELT, MUTATIONS };
static const char *const mutation_name[MUTATIONS] = {"digit", "sign", "exchange", "dropped key",
                                                     "misspelt key"};

struct mutant {
    char *text;    /* NULL: this mutation changes nothing here */
    bool matters;  /* an answer changes by more than ten times its tolerance, or a key is gone */
};

/* Is number i of the answer further from y than ten tolerances? */
static bool matters(const struct verify_answers *x, enum verify_quantity k, int i, double y)
{
    double tolerance = k == VERIFY_QDD_FD || k == VERIFY_LAMBDA ? 1e-10 : 1e-12;
    return fabs(y - x->reference[x->at[k] + i]) > 10 * tolerance * x->scale[x->at[k] + i];
}

/* A number with one of its digits changed, or its sign, as a text. */
static void number_changed(char with[40], const char *at, enum mutation mutation, struct random *r)
{
    size_t length = (size_t)(vector_text_end(at) - at);
    snprintf(with, 40, "%.*s", (int)length, at);
    if (mutation == SIGN) {
        snprintf(with, 40, "%s%.*s", *at == '-' ? "" : "-", (int)length - (*at == '-'),
                 at + (*at == '-'));
        return;
    }
    size_t digits = strcspn(with, "eE"), place;
    do place = (size_t)random_below(r, digits);
    while (with[place] < '0' || with[place] > '9');
    with[place] = (char)('0' + (with[place] - '0' + 1 + (int)random_below(r, 9)) % 10);
}

static struct mutant number_mutant(const char *text, const struct verify_answers *x,
                                   const struct answer_key *k, enum mutation mutation,
                                   struct random *r)
{
    static const char *number[MOST_NUMBERS];
    int n = numbers_of(text, k, number), i = n > 0 ? (int)random_below(r, (uint64_t)n) : 0;
    char with[40];
    if (n == 0) return (struct mutant){NULL, false};
    number_changed(with, number[i], mutation, r);
    return (struct mutant){
        vector_text_put(text, number[i], (size_t)(vector_text_end(number[i]) - number[i]), with),
        matters(x, k->quantity, i, strtod(with, NULL))};
}

static struct mutant exchange_mutant(const char *text, const struct verify_answers *x,
                                     const struct answer_key *k, struct random *r)
{
    static const char *number[MOST_NUMBERS];
    int n = numbers_of(text, k, number);
    if (n < 2) return (struct mutant){NULL, false};
    int i = (int)random_below(r, (uint64_t)n - 1),
        j = i + 1 + (int)random_below(r, (uint64_t)(n - i - 1));
    char a[40], b[40];
    snprintf(a, sizeof a, "%.*s", (int)(vector_text_end(number[i]) - number[i]), number[i]);
    snprintf(b, sizeof b, "%.*s", (int)(vector_text_end(number[j]) - number[j]), number[j]);
    char *once = vector_text_put(text, number[j], strlen(b), a);
    struct mutant m = {vector_text_put(once, once + (number[i] - text), strlen(a), b),
                       matters(x, k->quantity, i, strtod(b, NULL)) ||
                           matters(x, k->quantity, j, strtod(a, NULL))};
    free(once);
    return m;
}

/* A key that no reader knows: two neighbouring letters exchanged, or for "dropped" the answer's key
 * is renamed to a remark's and the remark's to nothing, which is what a file without the answer
 * looks like to the reader. */
static struct mutant key_mutant(const char *text, const struct answer_key *k,
                                enum mutation mutation)
{
    const char *at = vector_text_key(k->inside ? vector_text_key(text, k->inside) : text, k->key);
    if (!at) return (struct mutant){NULL, false};
    size_t length = strlen(k->key) + 2;
    if (mutation == DROPPED) {
        const char *note = vector_text_key(text, "note");
        char *without = note ? vector_text_put(text, note, 6, "\"source\"") : strdup(text);
        at = vector_text_key(k->inside ? vector_text_key(without, k->inside) : without, k->key);
        char *dropped =
            vector_text_put(without, at, length, k->inside ? "\"nothing\"" : "\"note\"");
        free(without);
        return (struct mutant){dropped, true};
    }
    char with[80];
    snprintf(with, sizeof with, "\"%s\"", k->key);
    if (length > 3) {
        char c = with[1];
        with[1] = with[2];
        with[2] = c == with[1] ? 'x' : c;
    } else {
        with[1] = 'm';
    }
    return (struct mutant){vector_text_put(text, at, length, with), true};
}

static bool is_killed(const char *text)
{
    struct arena *a = arena_create();
    struct verify_report r;
    struct err e;
    bool killed = !verify_text(text, false, a, &r, &e);
    if (killed && e.kind != ERR_DATA) fail_msg("not the file's fault: %s", e.text);
    killed = killed || !r.passed;
    arena_destroy(a);
    return killed;
}

struct tally {
    int made[MUTATIONS], killed[MUTATIONS], mattered, mattered_killed;
};

/* The answers of a file with their scales. */
static struct verify_answers answers_of(const char *path, struct arena *a)
{
    static struct vector_case c;
    struct verify_answers x;
    struct err e;
    err_clear(&e);
    assert_true(vector_read(path, &c, a, &e));
    struct model *m = vector_model(&c, a, &e);
    assert_non_null(m);
    system_prepare(m);
    assert_true(verify_answers_make(&x, &c, m, vector_state(&c, m, a), a, &e));
    return x;
}

static void mutate_file(const char *path, int each, struct random *r, struct tally *t)
{
    struct arena *a = arena_create();
    struct verify_answers x = answers_of(path, a);
    char *text = text_of(path);
    for (int i = 0; i < each * MUTATIONS; i++) {
        enum mutation mutation = (enum mutation)(i % MUTATIONS);
        const struct answer_key *k = &answer_key[random_below(r, KEYS)];
        struct mutant m = mutation == EXCHANGE ? exchange_mutant(text, &x, k, r)
                          : mutation < EXCHANGE ? number_mutant(text, &x, k, mutation, r)
                                                : key_mutant(text, k, mutation);
        if (!m.text) continue;
        bool killed = is_killed(m.text);
        t->made[mutation]++;
        t->killed[mutation] += killed;
        t->mattered += m.matters;
        t->mattered_killed += m.matters && killed;
        if (m.matters && !killed)
            fprintf(stderr, "%s: %s of %s survives\n", path, mutation_name[mutation], k->key);
        free(m.text);
    }
    free(text);
    arena_destroy(a);
}

static void mutants_are_killed(void **state)
{
    (void)state;
    static const char *const file[] = {
        "closed_fourbar", "closed_two_4R_point3", "fext_serial_n0007", "float_rev_n0008",
        "serial_mixed_n0007",
        "serial_rev_n0003", "serial_sph_n0012", "tree_random_n0015", "x_massless_n0014",
        "x_massratio_up_n0013",
        "x_tinylinks_n0012", "x_fourbar_changepoint"};
    struct random r = random_make(2026, 11, 22);
    struct tally t = {0};
    for (size_t i = 0; i < sizeof file / sizeof *file; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s%s.json", DATA(""), file[i]);
        mutate_file(path, EACH, &r, &t);
    }
    for (int k = 0; k < MUTATIONS; k++)
        printf("  %-12s %3d of %3d mutants killed\n", mutation_name[k], t.killed[k], t.made[k]);
    printf("  of %d that change an answer by more than ten tolerances, or a key, %d: %.1f %%\n",
           t.mattered, t.mattered_killed, 100.0 * t.mattered_killed / t.mattered);
    assert_true(t.mattered > 25 * EACH);
    assert_int_equal(t.mattered_killed, t.mattered);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_row_accepts_changed_answers),
        cmocka_unit_test(no_row_accepts_changed_poses),
        cmocka_unit_test(small_torques_are_checked_beside_large_forces),
        cmocka_unit_test(no_changed_motion_passes),
        cmocka_unit_test(mutants_are_killed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

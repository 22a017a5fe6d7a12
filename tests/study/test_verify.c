/* test_verify.c - verify: the reference vectors pass, wrong answers do not, and every verdict says
 * why. */
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

#include "base/text.h"
#include "io/document.h"
#include "study/verify.h"

#define DATA(file) MIMDSIM_SRCDIR "/tests/data/vectors/" file

/* Verify `path`; fails the test when the file cannot be used. */
static struct verify_report report_of(const char *path, const struct verify_options *o,
                                      struct arena *a)
{
    struct verify_report r;
    struct err e;
    err_clear(&e);
    if (!verify_file(path, o, a, &r, &e)) fail_msg("%s: %s", path, e.text);
    return r;
}

static const struct verify_row *row_of(const struct verify_report *r, const char *algorithm,
                                       const char *quantity)
{
    for (int i = 0; i < r->nrow; i++)
        if (strcmp(r->row[i].algorithm, algorithm) == 0 &&
            strcmp(r->row[i].quantity, quantity) == 0)
            return &r->row[i];
    fail_msg("%s: no row %s %s", r->name, algorithm, quantity);
    return NULL;
}

static void all_vectors_pass(const char *pattern, const struct verify_options *o)
{
    glob_t files;
    int failed = 0;
    assert_int_equal(glob(pattern, 0, NULL, &files), 0);
    for (size_t i = 0; i < files.gl_pathc; i++) {
        struct arena *a = arena_create();
        struct verify_report r = report_of(files.gl_pathv[i], o, a);
        if (!r.passed) {
            failed++;
            verify_print(stderr, &r, true);
        }
        arena_destroy(a);
    }
    globfree(&files);
    assert_int_equal(failed, 0);
}

static void serial_algorithms_agree_with_the_vectors(void **state)
{
    (void)state;
    const struct verify_options o = {.parallel = false};
    all_vectors_pass(DATA("*.json"), &o);
}

static void parallel_kernels_agree_with_small_vectors(void **state)
{
    (void)state;
    const struct verify_options o = {.parallel = true};
    all_vectors_pass(DATA("serial_*n000*.json"), &o);
    all_vectors_pass(DATA("float_*n000*.json"), &o);
    all_vectors_pass(DATA("tree_*n0015.json"), &o);
    all_vectors_pass(DATA("closed_f*.json"), &o);
    all_vectors_pass(DATA("fext_serial*.json"), &o);
}

/* Three components, where they describe the case: by joints or by rows, at a change point, too. */
static void planar_kernels_agree_with_planar_vectors(void **state)
{
    (void)state;
    static const char *const name[] = {DATA("x_straight_n0016.json"), DATA("closed_fourbar.json"),
                                       DATA("closed_slidercrank.json"),
                                       DATA("x_fourbar_changepoint.json")};
    const struct verify_options o = {.parallel = true};
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        struct arena *a = arena_create();
        struct verify_report r = report_of(name[i], &o, a);
        assert_true(r.passed);
        assert_int_equal(row_of(&r, "parallel inverse planar", "tau_id")->verdict, VERIFY_PASS);
        assert_int_equal(row_of(&r, "parallel forward paper planar", "qdd_fd")->verdict,
                         VERIFY_PASS);
        assert_int_equal(row_of(&r, "parallel forward direct planar", "qdd_fd")->verdict,
                         VERIFY_PASS);
        if (i > 0)
            assert_int_equal(row_of(&r, "parallel forward direct planar", "lambda")->verdict,
                             VERIFY_PASS);
        arena_destroy(a);
    }
}

static void trajectories_are_followed(void **state)
{
    (void)state;
    const struct verify_options o = {.parallel = false};
    all_vectors_pass(DATA("trajectories/traj_double*.json"), &o);
    all_vectors_pass(DATA("trajectories/traj_spherical*.json"), &o);
    all_vectors_pass(DATA("trajectories/traj_stiff_n*.json"), &o);
}

/* A copy of a vector in which the text `old` once became `new`. */
static void copy_changed(const char *from, const char *old, const char *new, char *path)
{
    struct text t = {0};
    struct err e;
    err_clear(&e);
    assert_true(text_read_file(&t, from, &e));
    char *at = strstr(t.s, old);
    assert_non_null(at);
    int fd = mkstemp(path);
    FILE *out = fdopen(fd, "w");
    assert_non_null(out);
    fprintf(out, "%.*s%s%s", (int)(at - t.s), t.s, new, at + strlen(old));
    fclose(out);
    text_free(&t);
}

static void a_wrong_answer_fails(void **state)
{
    (void)state;
    static const struct { const char *old, *new, *algorithm, *quantity; } lie[] = {
        {"\"tau_id\": [", "\"tau_id\": [1", "rnea", "tau_id"},
        {"\"qdd_fd\": [-45.57", "\"qdd_fd\": [-45.58", "aba", "qdd_fd"},
        {"\"qdd_fd\": [-45.57", "\"qdd_fd\": [-45.58", "cfa-direct", "qdd_fd"},
        {"\"lambda\": [-0.73", "\"lambda\": [-0.74", "cfa-robust", "lambda"},
        {"\"M\": [\n  [", "\"M\": [\n  [1", "crba", "M"},
        {"\"kinetic\": ", "\"kinetic\": 1", "totals", "energy.kinetic"},
        {"\"linear\": [", "\"linear\": [1", "totals", "momentum.linear"},
        {"\"bias\": [", "\"bias\": [1", "rnea", "bias"},
    };
    for (size_t i = 0; i < sizeof lie / sizeof *lie; i++) {
        char path[] = P_tmpdir "/mimdsim-verify-XXXXXX";
        struct arena *a = arena_create();
        const struct verify_options o = {.parallel = false};
        copy_changed(DATA("closed_fourbar.json"), lie[i].old, lie[i].new, path);
        struct verify_report r = report_of(path, &o, a);
        assert_false(r.passed);
        assert_non_null(strstr(r.text, lie[i].quantity));
        assert_int_equal(row_of(&r, lie[i].algorithm, lie[i].quantity)->verdict, VERIFY_FAIL);
        unlink(path);
        arena_destroy(a);
    }
}

static void what_no_double_attains_fails_without_being_wrong(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    const struct verify_options strict = {.tolerance_forward = 1e-18}, usual = {.parallel = false};
    struct verify_report r = report_of(DATA("serial_rev_n0016.json"), &strict, a);
    assert_false(r.passed);
    const struct verify_row *row = row_of(&r, "aba", "qdd_fd");
    assert_true(row->verdict == VERIFY_ROUNDING && row->tolerance == 1e-18);
    assert_string_equal(r.text, "no algorithm gives qdd_fd within the tolerance");
    /* What the file says of roundings and of other programs does not change what is asked for. */
    r = report_of(DATA("x_massratio_up_n0013.json"), &usual, a);
    assert_true(row_of(&r, "aba", "qdd_fd")->tolerance == 1e-10 && r.peer_fd > 1e-10);
    arena_destroy(a);
}

static void massless_bodies_rule_out_constraint_forces(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    const struct verify_options o = {.parallel = true};
    struct verify_report r = report_of(DATA("x_massless_n0014.json"), &o, a);
    assert_true(r.passed);
    assert_int_equal(row_of(&r, "aba", "qdd_fd")->verdict, VERIFY_PASS);
    const struct verify_row *row = row_of(&r, "cfa-direct", "qdd_fd");
    assert_int_equal(row->verdict, VERIFY_NOT_APPLICABLE);
    assert_non_null(strstr(row->note, "massless body"));
    row = row_of(&r, "parallel forward direct cr", "qdd_fd");
    assert_int_equal(row->verdict, VERIFY_NOT_APPLICABLE);
    assert_int_equal(row_of(&r, "parallel inverse incoming", "tau_id")->verdict, VERIFY_PASS);
    arena_destroy(a);
}

static void heavy_tips_are_beyond_the_mass_matrix_by_rounding(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    const struct verify_options o = {.parallel = false};
    struct verify_report r = report_of(DATA("x_massratio_up_n0013.json"), &o, a);
    assert_true(r.passed);
    const struct verify_row *row = row_of(&r, "crba", "qdd_fd");
    assert_int_equal(row->verdict, VERIFY_ROUNDING);
    assert_non_null(strstr(row->note, "quad"));
    assert_true(row_of(&r, "cfa-robust", "qdd_fd")->plain <= r.peer_fd);
    arena_destroy(a);
}

static void keys_are_sorted(const struct node *node)
{
    const struct node *before = NULL;
    for (const struct node *c = node->child; c; before = c, c = c->next) {
        if (node->kind == NODE_MAP && before) assert_true(strcmp(before->key, c->key) < 0);
        keys_are_sorted(c);
    }
}

static void json_has_every_row_and_sorted_keys(void **state)
{
    (void)state;
    char path[] = P_tmpdir "/mimdsim-verify-XXXXXX";
    struct arena *a = arena_create();
    struct err e;
    const struct verify_options o = {.parallel = false};
    struct verify_report r[2] = {report_of(DATA("closed_fourbar.json"), &o, a),
                                 report_of(DATA("x_massless_n0014.json"), &o, a)};
    FILE *out = fdopen(mkstemp(path), "w");
    assert_non_null(out);
    verify_print_json(out, r, 2);
    fclose(out);
    err_clear(&e);
    const struct node *root = document_read(path, a, &e);
    assert_non_null(root);
    keys_are_sorted(root);
    assert_true(document_find(root, "total")->number == 2 &&
                document_find(root, "failed")->number == 0);
    const struct node *first = document_find(root, "cases")->child;
    assert_string_equal(document_text(first, "name"), "closed_fourbar");
    assert_int_equal(document_find(first, "rows")->count, r[0].nrow);
    const struct node *row = document_find(first, "rows")->child;
    assert_true(document_find(row, "error")->number == r[0].row[0].error);
    unlink(path);
    arena_destroy(a);
}

static void a_missing_file_is_the_users_mistake(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct verify_report r;
    struct err e;
    const struct verify_options o = {.parallel = false};
    err_clear(&e);
    assert_false(verify_file("/nowhere/case.json", &o, a, &r, &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(serial_algorithms_agree_with_the_vectors),
        cmocka_unit_test(parallel_kernels_agree_with_small_vectors),
        cmocka_unit_test(planar_kernels_agree_with_planar_vectors),
        cmocka_unit_test(trajectories_are_followed),
        cmocka_unit_test(a_wrong_answer_fails),
        cmocka_unit_test(what_no_double_attains_fails_without_being_wrong),
        cmocka_unit_test(massless_bodies_rule_out_constraint_forces),
        cmocka_unit_test(heavy_tips_are_beyond_the_mass_matrix_by_rounding),
        cmocka_unit_test(json_has_every_row_and_sorted_keys),
        cmocka_unit_test(a_missing_file_is_the_users_mistake),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_vector.c - reference vectors: read bit by bit, refused where they are wrong, made into
 * models and states. */
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

#include "base/arena.h"
#include "io/document.h"
#include "model/lump.h"
#include "model/vector.h"
#include "model/vector_model.h"

#define assert_near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))
#define DATA(file) MIMDSIM_SRCDIR "/tests/data/vectors/" file

struct fixture {
    struct arena *a;
    struct err e;
    char path[64];
};

static struct fixture fixture_make(const char *content)
{
    struct fixture f = {.a = arena_create(), .path = P_tmpdir "/mimdsim-vector-XXXXXX"};
    err_clear(&f.e);
    int fd = mkstemp(f.path);
    assert_true(fd >= 0);
    if (write(fd, content, strlen(content)) != (ssize_t)strlen(content)) fail();
    close(fd);
    return f;
}

static void fixture_end(struct fixture *f)
{
    unlink(f->path);
    arena_destroy(f->a);
}

static void numbers_come_back_bit_by_bit(void **state)
{
    (void)state;
    struct fixture f =
        fixture_make("{\"x\": [0.1, -1.7976931348623157e+308, 5e-324, 0.30000000000000004,\t1],\n"
                     "\t\"s\": \"a \\\"b\\\"\", \"none\": null}\n");
    const struct node *root = document_read(f.path, f.a, &f.e);
    assert_non_null(root);
    double x[5];
    assert_true(document_numbers(root, "x", f.path, x, 5, &f.e));
    assert_true(x[0] == 0.1 && x[1] == -1.7976931348623157e+308 && x[2] == 5e-324 &&
                x[3] == 0.1 + 0.2 && x[4] == 1);
    assert_string_equal(document_text(root, "s"), "a \"b\"");
    assert_int_equal(document_find(root, "none")->kind, NODE_NULL);
    assert_int_equal(document_find(root, "s")->line, 2);
    fixture_end(&f);
}

static void bad_documents_are_refused_at_their_line(void **state)
{
    (void)state;
    static const struct { const char *text; int line; const char *why; } bad[] = {
        {"", 1, "empty"},
        {"{\"a\": 1,\n\"a\": 2}", 2, "duplicate key 'a'; first given in line 1"},
        {"{\"a\": [1, 2\n", 2, ""},
        {"{\"a\": &x 1}", 1, "anchors"},
        {"{\"a\": 1,\n \"b\": *x}", 2, "aliases"},
        {"{\"a\": 1,\n \"b\": !!float 2}", 2, "tags"},
        {"{\"a\": 1}\n---\n{\"b\": 2}\n", 2, "a second document"},
        {"{[1]: 2}", 1, "a key has to be a name"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct fixture f = fixture_make(bad[i].text);
        assert_null(document_read(f.path, f.a, &f.e));
        assert_int_equal(f.e.kind, ERR_DATA);
        if (!strstr(f.e.text, bad[i].why)) fail_msg("document %zu: %s", i, f.e.text);
        assert_true(f.e.line >= bad[i].line - (bad[i].why[0] == 0));
        fixture_end(&f);
    }
    char deep[400] = "";
    for (int i = 0; i < 100; i++) strcat(deep, "[");
    struct fixture f = fixture_make(deep);
    assert_null(document_read(f.path, f.a, &f.e));
    assert_non_null(strstr(f.e.text, "nested deeper"));
    fixture_end(&f);
}

/* A pendulum; %s replaces parts of it. */
#define HEAD "{\"format\": \"dynref-1\", \"name\": \"p\", \"gravity\": [0, 0, -9.81],\n"
#define COUNTS "\"nq\": 1, \"nv\": 1,\n"
#define FRAME "{\"p\": [0, 0, 0], \"quat\": [0, 0, 0, 1], \"R\": [1, 0, 0, 0, 1, 0, 0, 0, 1]}"
#define BODY(parent, joint)                                                                        \
    "\"bodies\": [\n{\"parent\": " parent ", \"joint\": " joint ", \"placement\": " FRAME          \
    ", \"mass\": 1, \"com\": [0, 0, -1], \"inertia_com\": [1, 0, 0, 1, 0, 1]}],\n"
#define HINGE "{\"type\": \"revolute\", \"axis\": [0, 1, 0]}"
#define STATE "\"q\": [0.5], \"qd\": [1], \"qdd\": [2],\n"
#define ANSWER "\"tau_id\": [3]}\n"

static void bad_vectors_are_refused_at_their_line(void **state)
{
    (void)state;
    static const struct { const char *text; int line; const char *why; } bad[] = {
        {"{\"format\": \"other\"}", 1, "dynref-1"},
        {HEAD COUNTS BODY("0", HINGE) STATE ANSWER, 4, "'parent' must be an integer from -1 to -1"},
        {HEAD COUNTS BODY("-1", "{\"type\": \"hinge\"}") STATE ANSWER, 4,
         "unknown joint type 'hinge'"},
        {HEAD COUNTS BODY("-1", "{\"type\": \"revolute\"}") STATE ANSWER, 4, "'axis' is missing"},
        {HEAD COUNTS BODY("-1", "{\"type\": \"revolute\", \"axis\": [0, 2, 0]}") STATE ANSWER, 4,
         "no unit vector"},
        {HEAD COUNTS BODY("-1", "{\"type\": \"fixed\"}") STATE ANSWER, 1, "do not fit the joints"},
        {HEAD COUNTS BODY("-1", HINGE) "\"q\": [0.5, 1], \"qd\": [1]}", 5,
         "'q' has more than the 1 numbers"},
        {HEAD COUNTS BODY("-1", HINGE) "\"q\": [0.5], \"qd\": [.inf]}", 5, "finite"},
        {HEAD COUNTS BODY("-1", HINGE) "\"q\": [0.5], \"qd\": [1],\n\"tau_id\": [3]}", 1,
         "without 'qdd'"},
        {HEAD COUNTS BODY("-1", HINGE) "\"q\": [0.5], \"qd\": [1]}", 1, "nothing to compare"},
        {HEAD COUNTS BODY("-1", HINGE) STATE "\"joint_spring\": [1],\n" ANSWER, 1, "springs need"},
        {HEAD COUNTS BODY("-1", HINGE) STATE "\"loops\": [{\"rows\": []}],\n" ANSWER, 6,
         "1 to 6 rows"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct fixture f = fixture_make(bad[i].text);
        struct vector_case c;
        assert_false(vector_read(f.path, &c, f.a, &f.e));
        assert_int_equal(f.e.kind, ERR_DATA);
        if (!strstr(f.e.text, bad[i].why)) fail_msg("vector %zu: %s", i, f.e.text);
        if (f.e.line != bad[i].line)
            fail_msg("vector %zu: line %d, not %d: %s", i, f.e.line, bad[i].line, f.e.text);
        fixture_end(&f);
    }
    struct fixture f = fixture_make(HEAD COUNTS BODY("-1", HINGE) STATE ANSWER);
    struct vector_case c;
    assert_true(vector_read(f.path, &c, f.a, &f.e));
    assert_true(c.nbody == 1 && c.q[0] == 0.5 && c.tau_id[0] == 3 && isnan(c.peer_fd.error));
    fixture_end(&f);
}

static void a_case_is_read_with_its_answers_and_peers(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    struct vector_case c;
    err_clear(&e);
    assert_true(vector_read(DATA("closed_fourbar.json"), &c, a, &e));
    assert_string_equal(c.name, "closed_fourbar");
    assert_true(c.nbody == 3 && c.nq == 3 && c.nv == 3 && c.nloop == 1 && c.nrow == 2);
    assert_true(c.qdd_fd[1] == 60.823122796510845 && c.lambda[0] == -0.7350294203770859);
    assert_true(c.mass_matrix[1] == 0.39874504026046464 && c.mass_matrix[8] == 0.10856249999999998);
    assert_true(c.loop[0].body_a == 1 && c.loop[0].body_b == 2 && c.loop[0].row[1][1] == 1 &&
                c.loop[0].frame_a.p[0] == 0.8);
    assert_true(c.has_energy && c.potential == 7.7415029855993405);
    /* Simbody's 1.2e-16 is the best in double precision; the 113-bit entry is left out. */
    assert_true(c.peer_fd.error == 1.2e-16);
    assert_string_equal(c.peer_fd.name, "Simbody");
    struct model *m = vector_model(&c, a, &e);
    assert_non_null(m);
    assert_true(m->nu == 3 && m->nloop == 1 && m->nrow == 2 && m->has_phi);
    struct state *s = vector_state(&c, m, a);
    assert_memory_equal(s->tau, c.tau, 3 * sizeof *s->tau);
    assert_null(s->fext);
    arena_destroy(a);
}

static void trajectories_are_read_with_their_springs(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    struct vector_case c;
    err_clear(&e);
    assert_true(vector_read(DATA("trajectories/traj_stiff_n06.json"), &c, a, &e));
    assert_int_equal(c.ninstant, 11);
    assert_true(c.instant[0].time == 0 && c.instant[10].time == 1);
    assert_memory_equal(c.instant[0].q, c.q, 6 * sizeof *c.q);
    struct model *m = vector_model(&c, a, &e);
    assert_non_null(m);
    assert_true(m->body[2].stiffness == c.spring[2] && m->body[2].damping == c.damping[2] &&
                c.spring[2] > 0);
    arena_destroy(a);
}

static void massless_bodies_are_kept_and_known(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    struct vector_case c;
    err_clear(&e);
    assert_true(vector_read(DATA("x_massless_n0014.json"), &c, a, &e));
    struct model *m = vector_model(&c, a, &e);
    assert_non_null(m);
    assert_true(m->nbody == 14 && !m->has_phi);
    arena_destroy(a);
}

/* Lumping: external wrenches and loops follow the body that they act on. */
static void wrenches_and_loops_follow_a_lumped_body(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    struct lumped lumped;
    err_clear(&e);
    struct model *m = model_begin(a, NULL);
    struct body_def carrier = {.name = "carrier",
                               .parent = -1,
                               .joint = JOINT_REVOLUTE,
                               .axis = {0, 0, 1},
                               .mass = 1,
                               .inertia = {1, 0, 0, 1, 0, 1}};
    /* turned by 90 degrees about z, 2 m along x */
    struct body_def part = {.name = "part",
                            .parent = 0,
                            .joint = JOINT_FIXED,
                            .mass = 1,
                            .inertia = {1, 0, 0, 1, 0, 1},
                            .placement = {{0, 0, sqrt(0.5), sqrt(0.5)}, {2, 0, 0}}};
    struct body_def ground = part;
    ground.parent = -1;
    struct loop_def loop = {
        .body_a = 1, .body_b = -1, .frame_a = {{0, 0, 0, 1}, {1, 0, 0}}, .nrow = 1, .row = {{1}}};
    assert_int_equal(model_add_body(m, &carrier, &e), 0);
    assert_int_equal(model_add_body(m, &part, &e), 1);
    assert_int_equal(model_add_body(m, &ground, &e), 2);
    assert_int_equal(model_add_loop(m, &loop, &e), 0);
    assert_true(model_finish(m, false, &e));
    struct state *s = state_take(m, a);
    double *fext = state_fext_need(s, m, a);
    fext[6] = 3;                       /* 3 N along the part's x, which is the carrier's y */
    fext[11] = 5;                      /* 5 N m about z */
    fext[0] = 7;
    assert_true(lump_fixed(m, false, a, &lumped, &e));
    assert_int_equal(lumped.model->nbody, 1);
    assert_true(lumped.body[0] == 0 && lumped.body[1] == 0 && lumped.body[2] == -1);
    struct state *t = lump_state(&lumped, m, s, a);
    const double expected[6] = {7, 3, 0, 0, 0, 5 + 2 * 3};
    for (int i = 0; i < 6; i++) assert_near(t->fext[i], expected[i], 1e-14);
    assert_ptr_equal(t->q, s->q);
    const struct loop_def *moved = &lumped.model->loop[0];
    assert_true(moved->body_a == 0 && moved->body_b == -1);
    assert_near(moved->frame_a.p[0], 2, 1e-14);
    assert_near(moved->frame_a.p[1], 1, 1e-14);
    assert_near(moved->frame_a.quat[2], sqrt(0.5), 1e-15);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_come_back_bit_by_bit),
        cmocka_unit_test(bad_documents_are_refused_at_their_line),
        cmocka_unit_test(bad_vectors_are_refused_at_their_line),
        cmocka_unit_test(a_case_is_read_with_its_answers_and_peers),
        cmocka_unit_test(trajectories_are_read_with_their_springs),
        cmocka_unit_test(massless_bodies_are_kept_and_known),
        cmocka_unit_test(wrenches_and_loops_follow_a_lumped_body),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

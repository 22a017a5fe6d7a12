/* test_urdf.c - robots from URDF: what is read, what is refused and where, and the models made of
 * it. */
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
#include "model/urdf_model.h"
#include "model/vector.h"

#define assert_near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

/* Write `xml` to a file of its own and read it. */
static bool read_xml(const char *xml, struct urdf_robot *robot, struct arena *a, struct err *e)
{
    char path[] = P_tmpdir "/mimdsim-urdf-XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, xml, strlen(xml)), strlen(xml));
    close(fd);
    err_clear(e);
    bool good = urdf_read(path, robot, a, e);
    unlink(path);
    return good;
}

#define INERTIAL                                                                                   \
    "<inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "                 \
    "izz='1'/></inertial>"
#define LINK(name) "<link name='" name "'>" INERTIAL "</link>\n"
#define JOINT(name, type, parent, child)                                                           \
    "<joint name='" name "' type='" type "'><parent link='" parent "'/><child link='" child        \
    "'/></joint>\n"

static void links_are_ordered_depth_first_in_the_order_of_joints(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct urdf_robot robot;
    struct err e;
    assert_true(read_xml("<robot name='tree'>\n" LINK("leaf2") LINK("leaf1") LINK("arm")
                             LINK("root") LINK("leg") JOINT("j1", "revolute", "root", "leg")
                                 JOINT("j2", "revolute", "root", "arm")
                                     JOINT("j3", "fixed", "leg", "leaf1")
                                         JOINT("j4", "continuous", "leg", "leaf2") "</robot>",
                         &robot, a, &e));
    static const char *const expected[] = {"root", "leg", "leaf1", "leaf2", "arm"};
    assert_string_equal(robot.name, "tree");
    assert_int_equal(robot.nlink, 5);
    for (int i = 0; i < 5; i++) assert_string_equal(robot.link[robot.order[i]].name, expected[i]);
    arena_destroy(a);
}

static void every_number_of_a_joint_is_read(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct urdf_robot robot;
    struct err e;
    assert_true(read_xml("<robot name='r'>" LINK("a") LINK("b") "<joint name='j' type='prismatic'>"
                         "<origin xyz='1 -2 3e-1' rpy='0.1 0.2 0.3'/><parent link='a'/><child "
                         "link='b'/><axis xyz='0 3 4'/><limit lower='-1' upper='2' effort='5' "
                         "velocity='6'/>"
                         "<dynamics damping='0.5'/></joint></robot>", &robot, a, &e));
    const struct urdf_joint *j = &robot.joint[0];
    assert_int_equal(j->kind, URDF_PRISMATIC);
    assert_true(j->p[0] == 1 && j->p[1] == -2 && j->p[2] == 0.3);
    assert_near(j->axis[1], 0.6, 1e-16);
    assert_near(j->axis[2], 0.8, 1e-16);
    assert_true(j->has_limit && j->lower == -1 && j->upper == 2 && j->effort == 5 &&
                j->velocity == 6 && j->damping == 0.5);
    /* Rz(0.3) Ry(0.2) Rx(0.1) applied to e_x is (cy cp, sy cp, -sp). */
    double x = j->quat[0], y = j->quat[1], z = j->quat[2], w = j->quat[3];
    assert_near(1 - 2 * (y * y + z * z), cos(0.3) * cos(0.2), 1e-15);
    assert_near(2 * (x * y + z * w), sin(0.3) * cos(0.2), 1e-15);
    assert_near(2 * (x * z - y * w), -sin(0.2), 1e-15);
    /* The last row's second entry is cp sr. */
    assert_near(2 * (y * z + x * w), cos(0.2) * sin(0.1), 1e-15);
    arena_destroy(a);
}

static void inertias_are_turned_into_link_axes(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct urdf_robot robot;
    struct err e;
    assert_true(
        read_xml("<robot name='r'><link name='base'/><link name='b'><inertial><origin xyz='1 2 3' "
                 "rpy='0 0 0.5'/><mass value='4'/><inertia ixx='2' ixy='0' ixz='0' iyy='3' iyz='0' "
                 "izz='4'/></inertial></link>" JOINT("j", "continuous", "base", "b") "</robot>",
                 &robot, a, &e));
    struct urdf_options o = {.keep_fixed = true};
    struct model *m = urdf_model(&robot, &o, a, &e);
    assert_non_null(m);
    assert_int_equal(m->nbody, 1);
    double c = cos(0.5), s = sin(0.5);
    const double expected[6] = {
        2 * c * c + 3 * s * s, (2 - 3) * s * c, 0, 2 * s * s + 3 * c * c, 0, 4};
    for (int i = 0; i < 6; i++) assert_near(m->body[0].inertia[i], expected[i], 1e-15);
    assert_true(m->body[0].com[0] == 1 && m->body[0].com[1] == 2 && m->body[0].com[2] == 3 &&
                m->body[0].mass == 4);
    arena_destroy(a);
}

static void fixed_links_become_part_of_their_parents(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct urdf_robot robot;
    struct err e;
    assert_true(read_xml(
        "<robot name='r'>\n" LINK("base") LINK("left") LINK("right") "<link name='camera'/>" LINK(
            "tip") "<joint name='hinge' type='revolute'><parent link='base'/><child "
                   "link='left'/></joint><joint name='weld' type='fixed'><origin xyz='2 0 0' "
                   "rpy='0 0 1.5707963267948966'/>"
                   "<parent link='left'/><child link='right'/></joint>" JOINT(
                       "mount", "fixed", "right",
                       "camera") "<joint name='far' type='prismatic'><origin xyz='1 0 "
                                                            "0'/><parent link='right'/><child "
                                                            "link='tip'/></joint></robot>",
        &robot, a, &e));
    struct urdf_options o = {.floating = false};
    struct model *m = urdf_model(&robot, &o, a, &e);
    assert_non_null(m);
    assert_int_equal(m->nbody, 2);
    /* two equal bodies 2 m apart: mass 4, centre half-way, 2 m 1^2 added about y and z */
    const double expected[6] = {2, 0, 0, 6, 0, 6};
    assert_near(m->body[0].mass, 4, 1e-15);
    assert_near(m->body[0].com[0], 1, 1e-15);
    for (int i = 0; i < 6; i++) assert_near(m->body[0].inertia[i], expected[i], 1e-14);
    /* 1 m along x of the welded part, which points along y */
    assert_int_equal(m->body[1].parent, 0);
    assert_near(m->body[1].placement.p[0], 2, 1e-15);
    assert_near(m->body[1].placement.p[1], 1, 1e-15);
    arena_destroy(a);
}

static void what_is_not_supported_is_listed_with_its_line(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct urdf_robot robot;
    struct err e;
    assert_true(read_xml("<robot name='r'>\n" LINK("a") LINK("b")
                         "<joint name='j' type='revolute'><parent link='a'/><child link='b'/>\n"
                         "<mimic joint='other' multiplier='2'/>\n"
                         "<dynamics damping='0' friction='1'/></joint>\n"
                         "<transmission name='t'><joint name='j'/></transmission>\n"
                         "<fancy_extension/></robot>", &robot, a, &e));
    static const struct { int line; const char *text; } expected[] = {
        {5, "mimic"}, {6, "friction"}, {7, "<transmission>"}, {8, "<fancy_extension>"}};
    assert_int_equal(robot.nwarning, 4);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(robot.warning[i].line, expected[i].line);
        assert_non_null(strstr(robot.warning[i].text, expected[i].text));
    }
    arena_destroy(a);
}

/* A robot with one mistake, the line that must be told, and a part of the message. */
static const struct { const char *xml; int line; const char *text;
} malformed[] = {
    {"<robot name='r'>\n<link name='a'>\n</robot>", 3, "XML"},
    {"<sdf/>", 1, "not <robot>"},
    {"<robot name='r'/>", 0, "no links"},
    {"<robot name='r'>\n<link/></robot>", 2, "without a name"},
    {"<robot name='r'>\n" LINK("a") LINK("a") "</robot>", 3,
     "second link 'a'; the first is on line 2"},
    {"<robot name='r'>\n" LINK("a") LINK("b") JOINT("j", "hinge", "a", "b") "</robot>", 4,
     "unknown type 'hinge'"},
    {"<robot name='r'>\n" LINK("a") LINK("b") JOINT("j", "revolut", "a", "b") "</robot>", 4,
     "did you mean 'revolute'"},
    {"<robot name='r'>\n" LINK("forearm") LINK("b") JOINT("j", "revolute", "fourarm",
     "b") "</robot>", 4,
     "no link 'fourarm'; did you mean 'forearm'"},
    {"<robot name='r'>\n" LINK("a") LINK("b") "<joint name='j' type='fixed'><parent "
                                              "link='a'/></joint></robot>", 4,
     "no <child>"},
    {"<robot name='r'>\n" LINK("a") LINK("b") "</robot>", 3, "two roots"},
    {"<robot name='r'>\n" LINK("a") LINK("b") JOINT("j", "revolute", "a", "b")
         JOINT("k", "revolute", "b", "a") "</robot>",
     2, "cycle"},
    {"<robot name='r'>\n" LINK("r") LINK("a") LINK("b") JOINT("j", "fixed", "a", "b")
         JOINT("k", "fixed", "b", "a") "</robot>",
     3, "cycle"},
    {"<robot name='r'>\n" LINK("a") LINK("b") LINK("c") JOINT("j", "fixed", "a", "c")
         JOINT("k", "fixed", "b", "c") "</robot>",
     6, "two parents"},
    {"<robot name='r'>\n" LINK("a") LINK("b") JOINT("j", "fixed", "a", "b")
         JOINT("j", "fixed", "a", "b") "</robot>",
     5, "second joint 'j'; the first is on line 4"},
    {"<robot name='r'>\n<link name='a'><inertial><mass value='heavy'/>", 2,
     "finite number expected"},
    {"<robot name='r'>\n<link name='a'><inertial><mass value='${m}'/>", 2,
     "expand xacro first"},
    {"<robot name='r'>\n<link name='a'><inertial><mass value='inf'/>", 2,
     "finite number expected"},
    {"<robot name='r'>\n<link name='a'><inertial><origin xyz='1 2'/>", 2,
     "3 finite numbers expected"},
    {"<robot name='r'>\n<link name='a'><inertial><origin xyz='1 2 3 4'/>", 2,
     "after the last number"},
    {"<robot name='r'>\n<link name='a'><inertial><origin xzy='1 2 3'/>", 2,
     "did you mean 'xyz'"},
    {"<robot name='r'>\n<link name='a'><intertial/>", 2, "did you mean <inertial>"},
    {"<robot name='r'>\n<link name='a'><inertial>\n</inertial></link></robot>", 3,
     "without <mass>"},
    {"<robot name='r'>\n<link name='a'><inertial><mass value='1'/>\n</inertial></link></robot>",
     3,
     "without <inertia>"},
    {"<robot name='r'>\n<link name='a'><inertial><inertia ixx='1'/>", 2, "without ixy="},
    {"<robot name='r'>\n" LINK("a") "<link name='b'/><joint name='j' type='revolute'>\n<axis "
                                    "xyz='0 0 0'/>", 4,
     "axis of joint 'j' has length zero"},
    {"<robot name='r'>\n<joint name='j' type='revolute'>\n<limit lower='2' upper='1'/>", 3,
     "above upper limit"},
};

static void malformed_robots_are_refused_at_their_line(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof malformed / sizeof *malformed; i++) {
        struct arena *a = arena_create();
        struct urdf_robot robot;
        struct err e;
        assert_false(read_xml(malformed[i].xml, &robot, a, &e));
        assert_int_equal(e.kind, ERR_DATA);
        if (!strstr(e.text, malformed[i].text))
            fail_msg("robot %zu: '%s' instead of '%s'", i, e.text, malformed[i].text);
        if (e.line != malformed[i].line)
            fail_msg("robot %zu: line %d instead of %d (%s)", i, e.line, malformed[i].line, e.text);
        arena_destroy(a);
    }
}

static void impossible_bodies_are_refused_by_name_and_line(void **state)
{
    (void)state;
    static const struct { const char *mass, *inertia, *text; } bad[] = {
        {"-1", "ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'", "negative mass"},
        {"0", "ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'", "must be positive"},
        {"1", "ixx='1' iyy='-1' izz='1' ixy='0' ixz='0' iyz='0'", "not positive definite"},
        {"1", "ixx='1' iyy='1' izz='1' ixy='2' ixz='0' iyz='0'", "not positive definite"},
        {"1", "ixx='1' iyy='1' izz='3' ixy='0' ixz='0' iyz='0'", "triangle inequality"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        for (int fixed = 0; fixed < 2; fixed++) {
            struct arena *a = arena_create();
            struct urdf_robot robot;
            struct err e;
            char xml[1500];
            snprintf(
                xml, sizeof xml,
                "<robot name='r'>\n%s<link name='odd'>\n<inertial><mass value='%s'/><inertia "
                "%s/></inertial></link>%s<joint name='k' type='%s'><parent link='b'/><child "
                "link='odd'/></joint></robot>",
                LINK("a") LINK("b"), bad[i].mass, bad[i].inertia, JOINT("j", "revolute", "a", "b"),
                fixed ? "fixed" : "planar");
            assert_true(read_xml(xml, &robot, a, &e));
            struct urdf_options o = {.floating = true};
            assert_null(urdf_model(&robot, &o, a, &e));
            assert_non_null(strstr(e.text, "'odd'"));
            if (!strstr(e.text, bad[i].text))
                fail_msg("body %zu: '%s' instead of '%s'", i, e.text, bad[i].text);
            assert_int_equal(e.line, 5);
            err_clear(&e);
            o.allow_nonphysical = true;
            assert_true((urdf_model(&robot, &o, a, &e) != NULL) == (bad[i].mass[0] != '-'));
            arena_destroy(a);
        }
}

static void a_moving_link_needs_mass(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct urdf_robot robot;
    struct err e;
    assert_true(read_xml("<robot name='r'>\n" LINK("a") "<link name='frame'/>" JOINT(
                             "j", "revolute", "a", "frame") "</robot>",
                         &robot, a, &e));
    struct urdf_options o = {.floating = false};
    assert_null(urdf_model(&robot, &o, a, &e));
    assert_non_null(strstr(e.text, "'frame'"));
    assert_int_equal(e.line, 3);
    arena_destroy(a);
}

static void our_own_robots_are_possible(void **state)
{
    (void)state;
    static const struct { const char *file; bool floating; int nbody, nu; double mass; } own[] = {
        {"humanoid.urdf", true, 29, 34, 72.1}, {"arm.urdf", false, 8, 8, 28.9}};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        struct arena *a = arena_create();
        struct urdf_robot robot;
        struct err e;
        char path[512];
        err_clear(&e);
        snprintf(path, sizeof path, "%s/models/%s", MIMDSIM_SRCDIR, own[i].file);
        assert_true(urdf_read(path, &robot, a, &e));
        assert_int_equal(robot.nwarning, 0);
        struct urdf_options o = {.floating = own[i].floating};
        struct model *m = urdf_model(&robot, &o, a, &e);
        assert_non_null(m);
        assert_int_equal(m->nbody, own[i].nbody);
        assert_int_equal(m->nu, own[i].nu);
        assert_true(m->has_phi);
        double mass = 0;
        for (int k = 0; k < m->nbody; k++) mass += m->body[k].mass;
        assert_near(mass, own[i].mass, 1e-9);
        arena_destroy(a);
    }
}

/* The folder of other people's robots, which are not part of this tree. */
static bool robot_path(char *path, int size, const char *file)
{
    const char *shared = getenv("MIMDSIM_SHARED");
    if (shared)
        snprintf(path, (size_t)size, "%s/vectors/urdf/%s", shared, file);
    else
        snprintf(path, (size_t)size, "%s/../shared/vectors/urdf/%s", MIMDSIM_SRCDIR, file);
    return access(path, R_OK) == 0;
}

static void real_robots_have_the_bodies_that_others_read(void **state)
{
    (void)state;
    static const struct { const char *name; bool floating; } real[] = {
        {"ur5", false}, {"kinova_j2s6", false}, {"anymal_c", true}, {"simple_humanoid", true}};
    for (size_t i = 0; i < sizeof real / sizeof *real; i++) {
        char file[64], path[512];
        snprintf(file, sizeof file, "%s.urdf", real[i].name);
        if (!robot_path(path, sizeof path, file)) skip();
        struct arena *a = arena_create();
        struct urdf_robot robot;
        struct vector_case c;
        struct err e;
        err_clear(&e);
        assert_true(urdf_read(path, &robot, a, &e));
        struct urdf_options o = {real[i].floating, true, true, {0, 0, -9.81}};
        struct model *m = urdf_model(&robot, &o, a, &e);
        assert_non_null(m);
        snprintf(file, sizeof file, "%s_s0.json", real[i].name);
        assert_true(robot_path(path, sizeof path, file));
        assert_true(vector_read(path, &c, a, &e));
        assert_int_equal(m->nbody, c.nbody);
        assert_int_equal(m->nu, c.nv);
        for (int k = 0; k < c.nbody; k++) {
            assert_string_equal(m->body[k].name, c.body[k].name);
            assert_int_equal(m->body[k].parent, c.body[k].parent);
            assert_true(m->body[k].mass == c.body[k].mass);
            for (int j = 0; j < 3; j++) {
                assert_near(m->body[k].com[j], c.body[k].com[j], 1e-15);
                assert_near(m->body[k].placement.p[j], c.body[k].placement.p[j], 1e-15);
            }
            for (int j = 0; j < 6; j++)
                assert_near(m->body[k].inertia[j], c.body[k].inertia[j], 1e-15);
        }
        arena_destroy(a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(links_are_ordered_depth_first_in_the_order_of_joints),
        cmocka_unit_test(every_number_of_a_joint_is_read),
        cmocka_unit_test(inertias_are_turned_into_link_axes),
        cmocka_unit_test(fixed_links_become_part_of_their_parents),
        cmocka_unit_test(what_is_not_supported_is_listed_with_its_line),
        cmocka_unit_test(malformed_robots_are_refused_at_their_line),
        cmocka_unit_test(impossible_bodies_are_refused_by_name_and_line),
        cmocka_unit_test(a_moving_link_needs_mass),
        cmocka_unit_test(our_own_robots_are_possible),
        cmocka_unit_test(real_robots_have_the_bodies_that_others_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_spatial.c - structured transforms and inertias against dense 6x6 matrices. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "linalg/inertia.h"
#include "linalg/spatial.h"

#define assert_near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

static void fill(struct random *r, double *x, int n)
{
    for (int i = 0; i < n; i++) x[i] = random_uniform(r, -1, 1);
}

static struct xform random_xform(struct random *r)
{
    struct xform x;
    double a[3], b[3];
    fill(r, a, 3), fill(r, b, 3), fill(r, x.p, 3);
    vec3_scale(a, 1 / vec3_norm(a), a);
    double dot = vec3_dot(a, b);
    for (int i = 0; i < 3; i++) b[i] -= dot * a[i];
    vec3_scale(b, 1 / vec3_norm(b), b);
    vec3_copy(x.r, a), vec3_copy(x.r + 3, b), vec3_cross(x.r + 6, a, b);
    return x;
}

/* [r, p~ r; 0, r]. */
static void dense_of(const struct xform *x, double *m)
{
    double skew[9], pr[9];
    mat3_skew(skew, x->p);
    mat3_mul(pr, skew, x->r);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            m[6 * i + j] = m[6 * (3 + i) + 3 + j] = x->r[3 * i + j];
            m[6 * i + 3 + j] = pr[3 * i + j];
            m[6 * (3 + i) + j] = 0;
        }
}

static void dense_mul(const double *a, const double *b, bool transposed, double *c)
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            c[6 * i + j] = 0;
            for (int k = 0; k < 6; k++)
                c[6 * i + j] += a[6 * i + k] * (transposed ? b[6 * j + k] : b[6 * k + j]);
        }
}

static void transforms_equal_their_matrices(void **state)
{
    (void)state;
    struct random r = random_make(1, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        struct xform x = random_xform(&r), y = random_xform(&r), xy, back;
        double m[36], n[36], product[36], composed[36], f[6], got[6];
        dense_of(&x, m), dense_of(&y, n);
        fill(&r, f, 6);
        xform_force(got, &x, f);
        for (int i = 0; i < 6; i++) assert_near(got[i], screw_dot(m + 6 * i, f), 1e-14);
        xform_motion(got, &x, f);
        for (int i = 0; i < 6; i++) {
            double sum = 0;
            for (int k = 0; k < 6; k++) sum += m[6 * k + i] * f[k];
            assert_near(got[i], sum, 1e-14);
        }
        xform_compose(&xy, &x, &y);
        dense_mul(m, n, false, product), dense_of(&xy, composed);
        for (int i = 0; i < 36; i++) assert_near(product[i], composed[i], 1e-14);
        xform_inverse(&back, &x);
        xform_compose(&xy, &x, &back);
        dense_of(&xy, composed);
        for (int i = 0; i < 36; i++) assert_near(composed[i], i % 7 == 0, 1e-14);
        screw_copy(got, f);
        xform_force(got, &x, got), xform_force(f, &x, f);
        for (int i = 0; i < 6; i++) assert_true(got[i] == f[i]); /* in place is the same */
    }
}

static void symmetric_matrices_move_as_their_matrices(void **state)
{
    (void)state;
    struct random r = random_make(2, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        struct xform x = random_xform(&r);
        struct sym6 s, moved;
        double m[36], full[36], t[36], want[36], got[36], v[6], y[6];
        fill(&r, s.a, 6), fill(&r, s.b, 9), fill(&r, s.c, 6), fill(&r, v, 6);
        dense_of(&x, m), sym6_expand(full, &s);
        sym6_mul(y, &s, v);
        for (int i = 0; i < 6; i++) assert_near(y[i], screw_dot(full + 6 * i, v), 1e-14);
        dense_mul(m, full, false, t), dense_mul(t, m, true, want);
        sym6_move(&moved, &x, &s);
        sym6_expand(got, &moved);
        for (int i = 0; i < 36; i++) assert_near(got[i], want[i], 1e-13);
    }
}

static void rigid_inertias_are_symmetric_matrices(void **state)
{
    (void)state;
    struct random r = random_make(3, 0, 0);
    for (int trial = 0; trial < 50; trial++) {
        struct xform x = random_xform(&r);
        struct inertia in, moved, sum;
        struct sym6 s, t, u;
        double v[6], f[6], g[6];
        in.m = random_uniform(&r, 0.5, 2);
        fill(&r, in.ms, 3), fill(&r, in.j, 6), fill(&r, v, 6);
        sym6_from_inertia(&s, &in);
        inertia_mul(f, &in, v), sym6_mul(g, &s, v);
        for (int i = 0; i < 6; i++) assert_near(f[i], g[i], 1e-14);
        inertia_move(&moved, &x, &in), sym6_move(&t, &x, &s), sym6_from_inertia(&u, &moved);
        for (int i = 0; i < 6; i++) assert_near(t.a[i], u.a[i], 1e-13);
        for (int i = 0; i < 9; i++) assert_near(t.b[i], u.b[i], 1e-13);
        for (int i = 0; i < 6; i++) assert_near(t.c[i], u.c[i], 1e-13);
        sum = in, inertia_add(&sum, &moved), sym6_add(&s, &t), inertia_mul(f, &sum, v),
        sym6_mul(g, &s, v);
        for (int i = 0; i < 6; i++) assert_near(f[i], g[i], 1e-13);
        /* I V' + P of a steadily turning body: P = [w x J w; w x (w x ms)] */
        double c[3];
        inertia_gyro(f, &in, v);
        sym3_mul_vec(c, in.j, v), vec3_cross(c, v, c);
        for (int i = 0; i < 3; i++) assert_near(f[i], c[i], 1e-14);
        vec3_cross(c, v, in.ms), vec3_cross(c, v, c);
        for (int i = 0; i < 3; i++) assert_near(f[3 + i], c[i], 1e-14);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_equal_their_matrices),
        cmocka_unit_test(symmetric_matrices_move_as_their_matrices),
        cmocka_unit_test(rigid_inertias_are_symmetric_matrices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

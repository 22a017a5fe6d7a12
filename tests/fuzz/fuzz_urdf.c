/* fuzz_urdf.c - robots of strangers: refused with a reason, or a model whose parents come before
 * their children. */
#include "fuzz.h"

#include "model/urdf_model.h"

static void build(const struct urdf_robot *robot, const struct urdf_options *o, struct arena *a)
{
    struct err e;
    err_clear(&e);
    const struct model *m = urdf_model(robot, o, a, &e);
    if (m == NULL) fuzz_refused(&e);
    for (int i = 0; m != NULL && i < m->nbody; i++)
        CHECK(m->body[i].parent >= -1 && m->body[i].parent < i);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct err e;
    struct urdf_robot robot;
    struct arena *a = arena_create();
    err_clear(&e);
    if (urdf_read(fuzz_file("input.urdf", data, size), &robot, a, &e)) {
        CHECK(robot.nlink >= 1 && robot.njoint == robot.nlink - 1);
        build(&robot, &(struct urdf_options){.gravity = {0, 0, -9.81}}, a);
        build(
            &robot,
            &(struct urdf_options){.floating = true, .keep_fixed = true, .allow_nonphysical = true},
            a);
    } else fuzz_refused(&e);
    arena_destroy(a);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return text_mutate(data, size, most, seed);
}

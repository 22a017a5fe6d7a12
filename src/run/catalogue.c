/* catalogue.c - names and titles of the kernels. */
#include "run/catalogue.h"

#include <string.h>

#include "base/check.h"
#include "guest/guest_program.h"
#include "kernel/programs.h"
#include "schedule/schedule_program.h"
#include "sim/fiber.h"

/* Names by way of this room, since app does not see kernels. */
struct catalogue catalogue_of_kernels(void)
{
    struct catalogue c = {0};
    const struct program_type *const *k = program_list(&c.n);
    CHECK(c.n <= CATALOGUE_MOST);
    for (int i = 0; i < c.n; i++) {
        c.name[i] = k[i]->name;
        c.title[i] = k[i]->title;
    }
    return c;
}

const struct program_sheet *run_sheet(const char *image, const char *path, const char *hash,
                                      struct arena *a, struct err *e)
{
    /* A schedule is known by its ending; everything else is an image, whose sheet it brings
     * itself. */
    const char *dot = strrchr(path, '.');
    if (dot != NULL && strcmp(dot, ".goal") == 0) return schedule_sheet(image, a, e);
    return guest_sheet(image, path, hash, a, e);
}

const char *run_fibers(void) { return fiber_backend(); }

/* test_privacy.c - what a program of any language keeps between calls is private to a rank: every
 * way that is known to be shared by copies that dlopen makes. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/guests.h"
#include "support/scratch.h"

static char folder[256];

static int make(void **state)
{
    (void)state;
    scratch_make(folder, sizeof folder);
    return 0;
}

static int remove_it(void **state)
{
    (void)state;
    scratch_remove(folder);
    return 0;
}

/* Sleeping lets the other rank go on: what it writes must not show here. */
static void globals_of_c(void **state)
{
    (void)state;
    guests_expect(folder, "globals.c", "",
                  "0: 3 10 0 5 3 4 a 1 guest\n1: 6 13 30 8 6 4 b 1 guest\n");
}

/* Relative relocations as bits, where the linker has them; vector mathematics of the host; a
 * library of C++ per rank. */
static void other_ways_of_linking(void **state)
{
    (void)state;
    const char *output = "0: 3 10 0 5 3 4 a 1 guest\n1: 6 13 30 8 6 4 b 1 guest\n";
    guests_expect(folder, "globals.c", "-Wl,-z,pack-relative-relocs", output);
    guests_expect(folder, "globals.c", "-Wl,--hash-style=sysv -Wl,-z,now", output);
    guests_expect(folder, "vectors.c", "-O3 -ffast-math", "0: 4.620256785\n1: 4.620256785\n");
    guests_expect(folder, "statics.cc",
                  "-shared-libgcc -Wl,--no-as-needed -Wl,-Bdynamic -l:libstdc++.so.6",
                  "0: 1 2 3 4\n1: 3 4 5 6\n");
}

static void inline_and_template_statics_of_cpp(void **state)
{
    (void)state;
    guests_expect(folder, "statics.cc", "-O1", "0: 1 2 3 4\n1: 3 4 5 6\n");
}

static void constructors_and_destructors_of_cpp(void **state)
{
    (void)state;
    guests_expect(folder, "constructors.cc", "-O2",
                  "0: +global\n0: +local\n1: +global\n1: +local\n"
                  "0: +function\n0: 3 a longer word than fits inside 1.5\n0: -used\n0: "
                  "-function\n0: -global\n"
                  "1: +function\n1: 3 a longer word than fits inside 1.5\n1: -used\n1: "
                  "-function\n1: -global\n");
}

static void exceptions_of_cpp(void **state)
{
    (void)state;
    guests_expect(
        folder, "exceptions.cc", "-O2",
        "0: unwound\n0: unwound\n0: deep 0\n0: 42\n1: unwound\n1: unwound\n1: deep 0\n1: 42\n"
        "0: again 1\n1: again 1\n");
}

static void fortran_common_saved_and_print(void **state)
{
    (void)state;
    guests_expect(folder, "kept.f90", "-O1",
                  "0:            3           0           5\n0: pi 3.142\n0:    17\n"
                  "1:            3           3           8\n1: pi 3.142\n1:    17\n");
}

static void hidden_state_of_the_c_library(void **state)
{
    (void)state;
    guests_expect(folder, "hidden.c", "",
                  "0: 383 170 b 1 n3 v -1 4 word c\n1: 290 41 b 2 n3 v -1 4 word c\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(globals_of_c, make, remove_it),
        cmocka_unit_test_setup_teardown(other_ways_of_linking, make, remove_it),
        cmocka_unit_test_setup_teardown(inline_and_template_statics_of_cpp, make, remove_it),
        cmocka_unit_test_setup_teardown(constructors_and_destructors_of_cpp, make, remove_it),
        cmocka_unit_test_setup_teardown(exceptions_of_cpp, make, remove_it),
        cmocka_unit_test_setup_teardown(fortran_common_saved_and_print, make, remove_it),
        cmocka_unit_test_setup_teardown(hidden_state_of_the_c_library, make, remove_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

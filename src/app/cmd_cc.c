/* cmd_cc.c - mimdsim cc, c++, f90: compile and link programs of users, as gcc would be asked to. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/verb.h"
#include "base/text.h"
#include "compile/driver.h"

enum { PATH_SIZE = 4096 };

/* A path that is too long is a file that is not there. */
static bool is_there(const char *folder, const char *name)
{
    char path[3 * PATH_SIZE];
    return snprintf(path, sizeof path, "%s/%s", folder, name) < (int)sizeof path &&
           access(path, R_OK) == 0;
}

/* The folder of this program, and the program itself. */
static bool find_self(char self[PATH_SIZE], char folder[PATH_SIZE])
{
    /* Linux tells the true path, whatever argv[0] says and PATH holds. */
    const ssize_t n = readlink("/proc/self/exe", self, PATH_SIZE - 1);
    if (n <= 0) return false;
    self[n] = '\0';
    text_copy(folder, PATH_SIZE, self);
    char *slash = strrchr(folder, '/');
    if (slash != NULL) *slash = '\0';
    return slash != NULL;
}

/* For a reader who has no manual at hand; gcc's own --help lists gcc's options. */
static int print_help(const char *verb, const char *compiler)
{
    printf(
        "Usage: %s GCC'S-OPTIONS... FILE...\n"
        "Compile and link programs for virtual processors, as %s would be asked to.\n\n"
        "Example: %s -O2 -o heat heat.c -lm      an image; `mimdsim mpirun -n 64 ./heat` runs it\n"
        "         ./configure CC=\"mimdsim cc\"          in a project that has a configure "
        "script\n\n"
        "All options of %s pass through. Every basic block of the code counts what it computes, "
        "and a run takes\n"
        "that time on its machine. The compiler is gcc, g++ or gfortran, or what MIMDSIM_CC, "
        "MIMDSIM_CXX and\n"
        "MIMDSIM_FC name. For CMake: share/mimdsim/mimdsim.cmake is a toolchain file. Refused: "
        "-march=native,\n"
        "-fopenmp, -fsanitize=..., -pg, and objects of other compilers.\n",
        verb, compiler, verb, compiler);
    return 0;
}

/* In the folder where it was built the archive lies beside the program and the headers in the
 * source tree. Installed, both are found from the program on, so that the tree may move; else where
 * they were installed first. */
static int compile_as(enum driver_language language, int argc, char **argv)
{
    char self[PATH_SIZE], folder[PATH_SIZE], library[2 * PATH_SIZE], include[2 * PATH_SIZE];
    struct driver_places places = {self, MIMDSIM_INCLUDEDIR, NULL, MIMDSIM_PKGLIBDIR};
    struct err e;
    err_clear(&e);
    /* The built tree is tried first: who develops wants the headers that were just edited. */
    if (find_self(self, folder)) {
        snprintf(library, sizeof library, "%s/../lib/mimdsim", folder);
        snprintf(include, sizeof include, "%s/../include", folder);
        if (is_there(folder, "libmimdsim-guest.a")) {
            snprintf(include, sizeof include, "%s/include", folder);
            places = (struct driver_places){self, MIMDSIM_SRCDIR "/include", include, folder};
        } else if (is_there(library, "libmimdsim-guest.a") && is_there(include, "mimdsim/host.h"))
            places = (struct driver_places){self, include, NULL, library};
    }
    static const char *const compiler[] = {"gcc", "g++", "gfortran"};
    /* Only a lone --help is ours; beside other options it is meant for the compiler. */
    if (argc == 2 && strcmp(argv[1], "--help") == 0) return print_help(argv[0], compiler[language]);
    const int status = driver_run(language, argc - 1, (const char *const *)argv + 1, &places, &e);
    if (status >= 0) return status;
    err_print(&e);
    return err_exit_status(e.kind);
}

/* One compiler driver, three languages. */
int cmd_cc(int argc, char **argv) { return compile_as(DRIVER_C, argc, argv); }
int cmd_cxx(int argc, char **argv) { return compile_as(DRIVER_CXX, argc, argv); }
int cmd_f90(int argc, char **argv) { return compile_as(DRIVER_FORTRAN, argc, argv); }

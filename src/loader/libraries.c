/* libraries.c - the files of a program: the program itself and every library that it needs, but the
 * host's own.
 *
 * libc, libm and their like belong to the process: there is one heap, one set of descriptors.
 * Everything else, the compilers' run-time libraries too, is copied for each rank, since its
 * variables belong to the program. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "loader/template.h"

/* Libraries of the process. All of glibc's that hold no state of the program, and the loader of the
 * system. */
static const char *const of_the_host[] = {"libc.so.6",   "libm.so.6",  "ld-linux-x86-64.so.2",
                                          "libdl.so.2",  "librt.so.1", "libpthread.so.0",
                                          "libmvec.so.1"};

/* Where the system keeps libraries, besides what the file and LD_LIBRARY_PATH name; Debian's and
 * Fedora's folders. */
static const char system_folders[] =
    "/lib/x86_64-linux-gnu:/usr/lib/x86_64-linux-gnu:/lib64:/usr/lib64:"
    "/usr/local/lib:/lib:/usr/lib";

/* Compared whole, with the number of the interface: another libc.so would be another library. */
bool library_of_host(const char *name)
{
    for (size_t i = 0; i < sizeof of_the_host / sizeof *of_the_host; i++)
        if (strcmp(name, of_the_host[i]) == 0) return true;
    return false;
}

/* Look for `name` in a list of folders with colons; "$ORIGIN" in it is the folder of the file that
 * needs it. */
static bool in_folders(const char *folders, const char *origin, const char *name, char *out,
                       size_t size)
{
    while (folders && *folders) {
        size_t n = strcspn(folders, ":");
        const char *slash = strrchr(origin, '/');
        int norigin = slash ? (int)(slash - origin) : 1;
        const char *text = slash ? origin : ".";
        if (n >= 7 && strncmp(folders, "$ORIGIN", 7) == 0)
            snprintf(out, size, "%.*s%.*s/%s", norigin, text, (int)(n - 7), folders + 7, name);
        else snprintf(out, size, "%.*s/%s", (int)n, folders, name);
        if (n && access(out, R_OK) == 0) return true;
        folders += n + (folders[n] == ':');
    }
    return false;
}

/* The order of the system's loader: run path, LD_LIBRARY_PATH, the system's folders (ld.so(8)).
 * A name with a slash is a path. */
static bool find_library(const struct elf_file *by, const char *name, char *out, size_t size)
{
    if (strchr(name, '/')) {
        text_copy(out, (int)size, name);
        return access(out, R_OK) == 0;
    }
    return in_folders(by->runpath, by->path, name, out, size) ||
           in_folders(getenv("LD_LIBRARY_PATH"), by->path, name, out, size) ||
           in_folders(system_folders, by->path, name, out, size);
}

/* The number of the file already read under that name, -1: none. */
static int file_named(const struct loader_template *t, const char *name)
{
    for (int i = 1; i < t->nfile; i++) {
        const struct elf_file *f = &t->file[i].elf;
        const char *slash = strrchr(f->path, '/');
        if ((f->soname && strcmp(f->soname, name) == 0) ||
            strcmp(slash ? slash + 1 : f->path, name) == 0)
            return i;
    }
    return -1;
}

/* A library that is missing is told with all the places that were looked at. */
static bool read_library(struct loader_template *t, const struct elf_file *by, const char *name,
                         struct err *e)
{
    char path[4096];
    if (t->nfile == LOADER_FILES)
        return err_set_at(e, ERR_DATA, by->path, 0, "needs more than %d libraries",
                          LOADER_FILES - 1);
    if (!find_library(by, name, path, sizeof path))
        return err_set_at(
            e, ERR_DATA, by->path, 0,
            "needs the library %s, which is in no folder of its run path, LD_LIBRARY_PATH, or %s",
            name, system_folders);
    if (!elf_file_read(&t->file[t->nfile].elf, path, e)) return err_in(e, by->path);
    t->nfile++;
    return true;
}

/* A file after all that it needs: the order of constructors. Circles end where they are met. */
static void put_in_order(struct loader_template *t, int i, bool *seen, int *n)
{
    if (seen[i]) return;
    seen[i] = true;
    for (int k = 0; k < t->file[i].elf.nneeded; k++) {
        int needed = file_named(t, t->file[i].elf.needed[k]);
        if (needed >= 0) put_in_order(t, needed, seen, n);
    }
    t->order[(*n)++] = i;
}

/* The program and all that it needs, each file once. */
bool files_read(struct loader_template *t, const char *path, struct err *e)
{
    if (!elf_file_read(&t->file[0].elf, path, e)) return false;
    t->nfile = 1;
    /* Breadth first, as symbols are looked up. The list grows while it is walked. */
    for (int i = 0; i < t->nfile; i++) {
        const struct elf_file *f = &t->file[i].elf;
        for (int k = 0; k < f->nneeded; k++) {
            if (library_of_host(f->needed[k]) || file_named(t, f->needed[k]) >= 0) continue;
            if (!read_library(t, f, f->needed[k], e)) return false;
        }
    }
    /* The program itself comes last. */
    bool seen[LOADER_FILES] = {false};
    int n = 0;
    put_in_order(t, 0, seen, &n);
    return true;
}

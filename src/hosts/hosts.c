/* hosts.c - which MPI started this process, and its module.
 *
 * Launchers leave their marks in the environment. Without any mark the process is a job of one,
 * for which any MPI will do. */
#include "hosts/hosts.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The kinds of MPI: two that are not binary compatible. Others (Intel, MVAPICH, Cray) keep to the
 * interface of MPICH. */
struct kind {
    const char *name, *module;
    const char *mark[3]; /* variables that its launcher sets */
};

static const struct kind kinds[] = {
    {"Open MPI", "mimdsim-hosts-openmpi.so", {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", NULL}},
    {"MPICH", "mimdsim-hosts-mpich.so", {"PMI_RANK", "PMI_SIZE", NULL}},
};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

/* The kind whose launcher started this process, NULL: none did. */
static const struct kind *started_by(void)
{
    for (int i = 0; i < KINDS; i++)
        for (int k = 0; kinds[i].mark[k] != NULL; k++)
            if (getenv(kinds[i].mark[k]) != NULL) return &kinds[i];
    return NULL;
}

bool hosts_started(void) { return started_by() != NULL; }

/* The folder of this program, where a build tree has the modules; "" when it cannot be found. */
static void folder_of_program(char out[PATH_MAX])
{
    const ssize_t n = readlink("/proc/self/exe", out, PATH_MAX - 1);
    out[n > 0 ? n : 0] = '\0';
    char *slash = strrchr(out, '/');
    if (slash != NULL) *slash = '\0';
    else out[0] = '\0';
}

/* The module's table, NULL with the loader's reason in `why`. Its symbols are made visible to all,
 * as MPI's own plug-ins look for them there. */
static const struct hosts_calls *load(const char *folder, const char *module, char *why,
                                      size_t size)
{
    char path[PATH_MAX + 64];
    snprintf(path, sizeof path, "%s/%s", folder, module);
    if (access(path, R_OK) != 0) return NULL;
    void *handle = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    const struct hosts_calls *calls = handle != NULL ? dlsym(handle, "mimdsim_hosts") : NULL;
    if (calls == NULL) snprintf(why, size, "%s", dlerror());
    else if (calls->table != HOSTS_TABLE)
        snprintf(why, size, "%.300s belongs to another version of mimdsim", path);
    return calls != NULL && calls->table == HOSTS_TABLE ? calls : NULL;
}

/* From the build tree, or from where it is installed. */
static const struct hosts_calls *find(const struct kind *kind, char *why, size_t size)
{
    char folder[PATH_MAX];
    folder_of_program(folder);
    const struct hosts_calls *calls = load(folder, kind->module, why, size);
    return calls != NULL ? calls : load(MIMDSIM_PKGLIBDIR, kind->module, why, size);
}

bool hosts_open(struct hosts *h, struct err *e)
{
    char why[512] = "";
    const struct kind *kind = started_by();
    *h = (struct hosts){.size = 1};
    /* A job of one process takes the first MPI that is there. */
    if (kind != NULL) h->call = find(kind, why, sizeof why);
    for (int i = 0; kind == NULL && h->call == NULL && i < KINDS; i++)
        h->call = find(&kinds[i], why, sizeof why);
    if (h->call == NULL)
        return err_set(e, ERR_UNAVAILABLE,
                       "this mimdsim was built without %s%s%s; install its compiler (mpicc) and "
                       "build again: configure --with-mpi",
                       kind != NULL ? kind->name : "MPI", why[0] != '\0' ? ": " : "", why);
    if (!h->call->begin(&h->rank, &h->size))
        return err_set(e, ERR_INTERNAL, "%s does not start", h->call->library);
    return true;
}

/* host.h - what a loaded program finds of the simulator: one versioned struct with tables of
 * functions.
 *
 * Every rank of a program ("guest") is a copy of its image with data of its own. The loader stores
 * a pointer to the rank's struct mimdsim_host in the image's variable `mimdsim_host` before any
 * code of the image runs. The archive that `mimdsim cc` links into each image (guest/) is written
 * against this header; so are the MPI stubs and the calls of a kernel in one file. Programs of
 * users need none of it.
 *
 * Rules of growth: members are only appended, `size` and `version` grow with them, `magic` changes
 * when that is not possible. A guest reads a member only where `size` covers it; the loader refuses
 * an image that wants more.
 *
 * Undefined symbols named `mimdsim_libc_NAME` mean the function NAME of the host's C library,
 * whatever else the image defines under that name: so the archive's own `open` calls the real one.
 * Declare them weak. */
#ifndef MIMDSIM_HOST_H
#define MIMDSIM_HOST_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MIMDSIM_HOST_MAGIC UINT64_C(0x74736f686d696d31)
enum { MIMDSIM_HOST_VERSION = 1 };

struct mimdsim_host;
struct mpi_functions;  /* include/mimdsim/mpi.h's table; defined by room mpi */
struct mpi_rank;       /* what the MPI functions know of this rank */
struct comm_functions; /* include/mimdsim/program.h's table: messages and work for a kernel in one
                          file */
struct comm;           /* src/comm/comm.h: this rank's face of the machine */

/* What every program may call, whatever else it is. All on the rank's own fiber. */
struct mimdsim_runtime {
    uint32_t size; /* of this struct [B] */

    /* The rank's clock [ps]. */
    int64_t (*now_ps)(struct mimdsim_host *host);

    /* elapse_ps: computing time of counted blocks since the last call. sleep_ps: time that passes
     * idly. [ps], >= 0 */
    void (*elapse_ps)(struct mimdsim_host *host, int64_t ps);
    void (*sleep_ps)(struct mimdsim_host *host, int64_t ps);

    /* n bytes of what the rank writes to its standard output (stream 1) or standard error (2). */
    void (*output)(struct mimdsim_host *host, int stream, const char *data, size_t n);

    /* finish: run the termination functions (DT_FINI_ARRAY, DT_FINI) of all files of the rank.
     * leave: the rank is done, with this exit status. fail: the program has failed, the run ends
     * with rank and text; `place` is the address in the program that is to blame, NULL: none. The
     * last two do not return. */
    void (*finish)(struct mimdsim_host *host);
    void (*leave)(struct mimdsim_host *host, int status);
    void (*fail)(struct mimdsim_host *host, const void *place, const char *text);

    /* The loaded files of this rank, for the unwinder: file number i's base address and (count)
     * program headers; 0 when there are no more. */
    int (*module)(struct mimdsim_host *host, int i, uintptr_t *base, const void **headers,
                  int *count);

    /* Computing that the program states: `flops` operations and `bytes` copied bytes. */
    void (*compute)(struct mimdsim_host *host, double flops, double bytes);
};

struct mimdsim_host {
    uint64_t magic;   /* MIMDSIM_HOST_MAGIC */
    uint32_t version; /* MIMDSIM_HOST_VERSION */
    uint32_t size;    /* of this struct [B] */
    int32_t rank, nrank;
    const struct mimdsim_runtime *runtime;
    void *instance;                    /* the loader's */
    void *context;                     /* of whoever started the rank */
    const struct mpi_functions *mpi;   /* NULL: the program was not started as an MPI program */
    struct mpi_rank *mpi_rank;         /* first argument of every function of `mpi` */
    const struct comm_functions *comm; /* NULL: not started as a kernel in one file */
    struct comm *comm_rank;            /* first argument of every function of `comm` */
    const char *directory; /* the working directory; the only place where files may be written */
};

/* The image's variable; defined by the archive of guest/, set by the loader. */
extern struct mimdsim_host *mimdsim_host;

#ifdef __cplusplus
}
#endif

#endif

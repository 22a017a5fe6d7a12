/* record_mpi.c - what mimdsim record loads before an MPI program: its time from the end of MPI_Init
 * to the beginning of MPI_Finalize, by MPI's profiling interface. Compiled once for each MPI.
 *
 * Every rank adds a line to the file that MIMDSIM_RECORD names: rank, size, nanoseconds,
 * involuntary switches, nanoseconds of processor time, processor. All ranks leave a barrier first
 * and enter one last, so that the longest line is the run's time. A program is not changed for it,
 * and need not be built anew. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <mpi.h>
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

/* At the beginning; of this process. */
static struct {
    int64_t wall_ns, processor_ns, switches;
} begun;

/* Any clock of the system in nanoseconds. */
static int64_t clock_of(clockid_t which)
{
    struct timespec t;
    clock_gettime(which, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

/* Of the thread that called MPI_Init, which is the program's own. */
static int64_t switches(void)
{
    struct rusage u;
    return getrusage(RUSAGE_THREAD, &u) == 0 ? u.ru_nivcsw : 0;
}

/* Nobody begins before all have started: starting takes mpirun a while. */
static void begin(void)
{
    PMPI_Barrier(MPI_COMM_WORLD);
    begun.switches = switches();
    begun.processor_ns = clock_of(CLOCK_PROCESS_CPUTIME_ID);
    begun.wall_ns = clock_of(CLOCK_MONOTONIC);
}

/* One write for a line: lines of several ranks do not mix (O_APPEND). */
static void end(void)
{
    char line[160];
    int rank, size;
    PMPI_Barrier(MPI_COMM_WORLD);
    const int64_t wall = clock_of(CLOCK_MONOTONIC) - begun.wall_ns;
    const int64_t used = clock_of(CLOCK_PROCESS_CPUTIME_ID) - begun.processor_ns;
    const int64_t taken = switches() - begun.switches;
    const char *path = getenv("MIMDSIM_RECORD");
    PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
    PMPI_Comm_size(MPI_COMM_WORLD, &size);
    const int n = snprintf(line, sizeof line, "%d %d %lld %lld %lld %d\n", rank, size,
                           (long long)wall, (long long)taken, (long long)used, sched_getcpu());
    const int file = path != NULL ? open(path, O_WRONLY | O_APPEND | O_CLOEXEC) : -1;
    if (file < 0) return;
    if (write(file, line, (size_t)n) != n) perror("mimdsim record");
    close(file);
}

/* In place of MPI's own, which are called by their other names. */
int MPI_Init(int *argc, char ***argv)
{
    const int code = PMPI_Init(argc, argv);
    if (code == MPI_SUCCESS) begin();
    return code;
}

int MPI_Init_thread(int *argc, char ***argv, int required, int *provided)
{
    const int code = PMPI_Init_thread(argc, argv, required, provided);
    if (code == MPI_SUCCESS) begin();
    return code;
}

int MPI_Finalize(void)
{
    end();
    return PMPI_Finalize();
}

/* Fortran's names, which MPI's libraries do not take through the C ones. */
void mpi_init_(int *error);
void mpi_init_(int *error) { *error = MPI_Init(NULL, NULL); }
void mpi_finalize_(int *error);
void mpi_finalize_(int *error) { *error = MPI_Finalize(); }

/* Module mpi_f08 has functions of its own, which also prepare its constants and reach MPI without
 * the C names: they are called, and the time is taken around them. `error` may be NULL. */
static int f08(const char *name)
{
    int code = MPI_ERR_OTHER;
    void (*call)(int *) = (void (*)(int *))dlsym(RTLD_NEXT, name);
    if (call != NULL) call(&code);
    return code;
}

void mpi_init_f08_(int *error);
void mpi_init_f08_(int *error)
{
    const int code = f08("mpi_init_f08_");
    if (code == MPI_SUCCESS) begin();
    if (error != NULL) *error = code;
}

void mpi_finalize_f08_(int *error);
void mpi_finalize_f08_(int *error)
{
    end();
    const int code = f08("mpi_finalize_f08_");
    if (error != NULL) *error = code;
}

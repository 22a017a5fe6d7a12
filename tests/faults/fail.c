/* fail.c - a library to be loaded before a program (LD_PRELOAD) that lets one call of a kind fail.
 *
 *     FAULT=malloc FAULT_AT=17            the 17th allocation is refused
 *     FAULT=write FAULT_AT=3 FAULT_AS=ENOSPC    the 3rd write fails; SHORT: it takes half
 *     FAULT_ON=1                          all later ones, too
 *     FAULT_COUNT=FILE                    how many there were, at the end of a process that ends by
 * itself
 *     FAULT_SOCKET=5 ...                  each in a process of its own, forked there (branch.h)
 *
 * Only in processes called $FAULT_PROGRAM: what these start in turn goes on as usual, but for
 * reads, which a program makes before it has loaded this library. Allocations, opening, names,
 * processes, pipes and mappings are caught by their functions; writes and reads, which stdio makes
 * without any function that could be replaced, by the system itself: a seccomp filter turns them
 * into SIGSYS, whose handler makes the call, or does not. */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <ucontext.h>
#include <unistd.h>

#include "branch.h"

enum kind { NOTHING, MALLOC, WRITE, READ, SYNC, NAME, OPEN, PROCESS, PIPE, MAP, LOCK };
static const char *const words[] = {"",     "malloc",  "write", "read", "sync", "name",
                                    "open", "process", "pipe",  "map",  "lock"};
enum { SHORT = -1 }; /* as an errno: half of it is done */

static struct {
    enum kind kind;
    long at;
    int error;
    int on;
    atomic_long count;
    const char *report;
} fault;

/* Whether this call of `kind`, made by `caller`, is to fail; errno is set. */
static int fails_for(enum kind kind, const void *caller)
{
    if (kind != fault.kind) return 0;
    long now = atomic_fetch_add(&fault.count, 1) + 1;
    if (branch_is_on() ? !branch_fails(now, fault.at, caller)
                       : now != fault.at && !(fault.on && fault.at > 0 && now > fault.at))
        return 0;
    errno = fault.error;
    return 1;
}

#define fails(kind) fails_for(kind, __builtin_return_address(0))

/* --- functions -------------------------------------------------------------------------------- */

/* The C library's own, which are there before this library can look for anything. */
extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t),
    *__libc_memalign(size_t, size_t);

void *malloc(size_t n) { return fails(MALLOC) ? NULL : __libc_malloc(n); }
void *calloc(size_t n, size_t each) { return fails(MALLOC) ? NULL : __libc_calloc(n, each); }
void *realloc(void *p, size_t n) { return fails(MALLOC) ? NULL : __libc_realloc(p, n); }
void *aligned_alloc(size_t a, size_t n) { return fails(MALLOC) ? NULL : __libc_memalign(a, n); }
void *memalign(size_t a, size_t n) { return fails(MALLOC) ? NULL : __libc_memalign(a, n); }
int posix_memalign(void **p, size_t a, size_t n)
{
    if (fails(MALLOC)) return ENOMEM;
    *p = __libc_memalign(a, n);
    return *p ? 0 : ENOMEM;
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define REPLACE(kind, result, failed, name, parameters, arguments)                                 \
    result name parameters { return fails(kind) ? (failed) : NEXT(name) arguments; }

REPLACE(SYNC, int, -1, fsync, (int fd), (fd))
REPLACE(SYNC, int, -1, fdatasync, (int fd), (fd))
REPLACE(NAME, int, -1, rename, (const char *a, const char *b), (a, b))
REPLACE(NAME, int, -1, link, (const char *a, const char *b), (a, b))
REPLACE(NAME, int, -1, mkdir, (const char *a, mode_t m), (a, m))
REPLACE(NAME, int, -1, ftruncate, (int fd, off_t n), (fd, n))
REPLACE(NAME, int, -1, ftruncate64, (int fd, off64_t n), (fd, n))
REPLACE(NAME, int, -1, chmod, (const char *a, mode_t m), (a, m))
REPLACE(PROCESS, pid_t, -1, fork, (void), ())
REPLACE(PIPE, int, -1, pipe, (int p[2]), (p))
REPLACE(PIPE, int, -1, pipe2, (int p[2], int flags), (p, flags))
REPLACE(OPEN, FILE *, NULL, fopen, (const char *a, const char *b), (a, b))
REPLACE(OPEN, FILE *, NULL, fopen64, (const char *a, const char *b), (a, b))
REPLACE(OPEN, FILE *, NULL, fdopen, (int fd, const char *b), (fd, b))
REPLACE(OPEN, int, -1, mkostemps, (char *t, int n, int flags), (t, n, flags))
REPLACE(OPEN, int, -1, mkostemps64, (char *t, int n, int flags), (t, n, flags))
REPLACE(OPEN, int, -1, mkstemp, (char *t), (t))
REPLACE(OPEN, int, -1, mkstemp64, (char *t), (t))
REPLACE(MAP, void *, MAP_FAILED, mmap, (void *p, size_t n, int a, int b, int fd, off_t o),
        (p, n, a, b, fd, o))
REPLACE(MAP, void *, MAP_FAILED, mmap64, (void *p, size_t n, int a, int b, int fd, off64_t o),
        (p, n, a, b, fd, o))

int posix_spawnp(pid_t *pid, const char *file, const posix_spawn_file_actions_t *a,
                 const posix_spawnattr_t *b, char *const argv[], char *const envp[])
{
    return fails(PROCESS) ? errno : NEXT(posix_spawnp)(pid, file, a, b, argv, envp);
}

#define REPLACE_OPEN(name)                                                                         \
    int name(const char *path, int flags, ...)                                                     \
    {                                                                                              \
        va_list more;                                                                              \
        va_start(more, flags);                                                                     \
        const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;              \
        va_end(more);                                                                              \
        return fails(OPEN) ? -1 : NEXT(name)(path, flags, mode);                                   \
    }
REPLACE_OPEN(open)
REPLACE_OPEN(open64)

/* Locks of files: taken by somebody else. */
#define REPLACE_FCNTL(name)                                                                        \
    int name(int fd, int what, ...)                                                                \
    {                                                                                              \
        va_list more;                                                                              \
        va_start(more, what);                                                                      \
        void *argument = va_arg(more, void *);                                                     \
        va_end(more);                                                                              \
        return what == F_SETLK && fails(LOCK) ? -1 : NEXT(name)(fd, what, argument);               \
    }
REPLACE_FCNTL(fcntl)
REPLACE_FCNTL(fcntl64)

/* --- system calls ----------------------------------------------------------------------------- */

#ifdef __x86_64__
/* The filter lets calls pass that have this in their sixth argument, which none of these calls
 * has. */
enum { MARK = 0x6d696d64 };
static long make_call(long number, long a, long b, long c, long d)
{
    long result;
    register long r10 __asm__("r10") = d;
    register long r9 __asm__("r9") = MARK;
    __asm__ volatile("syscall"
                     : "=a"(result)
                     : "a"(number), "D"(a), "S"(b), "d"(c), "r"(r10), "r"(r9)
                     : "rcx", "r11", "memory");
    return result;
}

/* Half of what a call would take or give. */
static long half(long number, const greg_t *r)
{
    struct iovec part;
    const struct iovec *v = (const struct iovec *)r[REG_RSI];
    switch (number) {
    case SYS_writev:
    case SYS_readv:
        part = v[0];
        part.iov_len = part.iov_len > 1 ? part.iov_len / 2 : part.iov_len;
        return make_call(number, r[REG_RDI], (long)&part, 1, 0);
    default:
        return make_call(number, r[REG_RDI], r[REG_RSI],
                         r[REG_RDX] > 1 ? r[REG_RDX] / 2 : r[REG_RDX], r[REG_R10]);
    }
}

static void on_call(int signal_number, siginfo_t *info, void *context)
{
    greg_t *r = ((ucontext_t *)context)->uc_mcontext.gregs;
    const long number = info->si_syscall;
    const int saved = errno;
    (void)signal_number;
    if (!fails(fault.kind))
        r[REG_RAX] =
            make_call(number, r[REG_RDI], r[REG_RSI], r[REG_RDX], r[REG_R10]);
    else r[REG_RAX] = fault.error == SHORT ? half(number, r) : -fault.error;
    errno = saved;
}

static void hear_calls(void)
{
    struct sigaction act = {.sa_sigaction = on_call, .sa_flags = SA_SIGINFO | SA_NODEFER};
    sigaction(SIGSYS, &act, NULL);
}

/* Calls of `numbers` without the mark become signals, here and in what this process starts. A
 * handler is entered by a signal that is not blocked: where the C library blocks all of them it
 * makes none of these calls. */
static void catch_calls(const int *numbers, int n)
{
    struct sock_filter program[16];
    int k = 0;
    program[k++] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS,
                                                offsetof(struct seccomp_data, args[5]));
    program[k++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, MARK, 0, 1);
    program[k++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    program[k++] =
        (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
    for (int i = 0; i < n; i++) {
        program[k++] =
            (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)numbers[i], 0, 1);
        program[k++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
    }
    program[k++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    struct sock_fprog filter = {(unsigned short)k, program};
    hear_calls();
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
        prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0)
        _exit(99); /* the runner tells that this system has no filters */
}
#else
static void hear_calls(void) {}
static void catch_calls(const int *numbers, int n) { (void)numbers, (void)n, _exit(99); }
#endif

/* --- beginning and end ------------------------------------------------------------------------ */

static const struct {
    const char *name;
    int error;
} errors[] = {{"ENOMEM", ENOMEM}, {"ENOSPC", ENOSPC}, {"EIO", EIO},       {"EINTR", EINTR},
              {"EACCES", EACCES}, {"EMFILE", EMFILE}, {"EAGAIN", EAGAIN}, {"EROFS", EROFS},
              {"EDQUOT", EDQUOT}, {"SHORT", SHORT}};

__attribute__((constructor)) static void begin(void)
{
    static const int writes[] = {SYS_write, SYS_pwrite64, SYS_writev},
                     reads[] = {SYS_read, SYS_pread64, SYS_readv};
    const char *kind = getenv("FAULT"), *program = getenv("FAULT_PROGRAM"),
               *as = getenv("FAULT_AS"), *at = getenv("FAULT_AT");
    if (!kind || !program) return;
    if (strcmp(program, program_invocation_short_name) != 0) {
        hear_calls(); /* it has the filter of the program that started it */
        return;
    }
    fault.at = at ? atol(at) : 0;
    fault.on = getenv("FAULT_ON") != NULL;
    fault.report = getenv("FAULT_COUNT");
    fault.error = ENOMEM;
    for (size_t i = 0; as && i < sizeof errors / sizeof *errors; i++)
        if (strcmp(as, errors[i].name) == 0) fault.error = errors[i].error;
    for (int i = 1; i < (int)(sizeof words / sizeof *words); i++)
        if (strcmp(kind, words[i]) == 0) fault.kind = (enum kind)i;
    branch_begin();
    if (fault.kind == WRITE) catch_calls(writes, 3);
    if (fault.kind == READ) catch_calls(reads, 3);
}

__attribute__((destructor)) static void end(void)
{
    if (!fault.report || branch_is_on()) return;
    fault.at = fault.on = 0;
    const long count = fault.count;
    FILE *out = fopen(fault.report, "w");
    if (!out) return;
    fprintf(out, "%ld\n", count);
    fclose(out);
}

/* crash.c - catching crashes of loaded programs: what the signal handler writes down before the
 * worker ends.
 *
 * The handler needs to find its data without a global variable: they stand at the bottom of its own
 * stack, and the system tells where that is (sigaltstack). It calls nothing but what POSIX allows
 * in handlers, and reads the program's memory only where it is known to be mapped. */
#include "loader/crash.h"

#include <errno.h>
#include <execinfo.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <ucontext.h>
#include <unistd.h>

#include "loader/template.h"

enum { GUARD_BYTES = 64 * 1024, SCAN_WORDS = 4096 };
static const uint64_t GUARD_MAGIC = UINT64_C(0x6372617368677264);

/* Stacks of ranks are smaller than this; beyond it, an address has nothing to do with the stack. */
static const uint64_t MOST_STACK = UINT64_C(1) << 30;

static const int signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF};
enum { NSIGNAL = sizeof signals / sizeof *signals };

/* The data at the bottom of the handler's stack. */
struct guard {
    uint64_t magic;
    struct crash_record *record;
    const struct loader_template *watched;
    int64_t stack_bytes; /* of its ranks */
    double seconds;
    struct sigaction before[NSIGNAL];
    stack_t stack_before;
};

/* The handler's data, by where the system keeps its stack; NULL where no guard has been set up,
 * or somebody else has put another stack there. */
static struct guard *guard_of_process(void)
{
    stack_t s;
    if (sigaltstack(NULL, &s) != 0 || (s.ss_flags & SS_DISABLE) || s.ss_size < sizeof(struct guard))
        return NULL;
    struct guard *g = s.ss_sp;
    return s.ss_size == GUARD_BYTES && g->magic == GUARD_MAGIC ? g : NULL;
}

/* The rank that ran: whose program text `pc` is, or, in the C library or the simulator, on whose
 * stack `sp` is: of the stacks that begin above it the nearest. */
static const struct loader_instance *running_instance(const struct loader_template *t, uint64_t pc,
                                                      uintptr_t sp)
{
    const struct loader_instance *best = NULL;
    const char *file;
    uint64_t at;
    int rank;
    if (loader_find_address(t, (void *)(uintptr_t)pc, &rank, &file, &at)) return &t->instance[rank];
    for (int k = 0; k < t->nrank; k++) {
        const struct loader_instance *i = &t->instance[k];
        if (!i->base || !i->outermost || i->stack < sp || i->stack - sp > MOST_STACK) continue;
        if (!best || i->stack < best->stack) best = i;
    }
    return best;
}

/* One more place of the program, as a file and an address in it. The path is copied, as the
 * parent reads the record when this process's memory has gone. */
static bool add_frame(struct crash_record *r, const struct loader_template *t, uint64_t pc)
{
    const char *file;
    uint64_t at;
    if (r->nframe == CRASH_FRAMES ||
        !loader_find_address(t, (void *)(uintptr_t)pc, NULL, &file, &at))
        return false;
    size_t n = strlen(file);
    if (n >= CRASH_PATH) return false;
    memcpy(r->frame[r->nframe].file, file, n + 1);
    r->frame[r->nframe++].address = at;
    return true;
}

/* Places in the program, innermost first: where it is itself, or where it called the C library or
 * the simulator from. Their frames are known to the unwinder, which stops at the first one of the
 * program. Behind it come words of the stack that look like return addresses: they count only where
 * the first place has no line, as in a library. */
__attribute__((no_sanitize("address"))) static void
note_frames(struct crash_record *r, const struct loader_instance *i, uint64_t pc, uintptr_t sp)
{
    void *frame[64];
    if (!add_frame(r, i->t, pc)) {
        const int n = backtrace(frame, 64);
        for (int k = 0; k < n && r->nframe == 0; k++)
            if (loader_is_return(i, frame[k]))
                add_frame(r, i->t, (uint64_t)(uintptr_t)frame[k] - 1);
    }
    void *const *word = (void *const *)((sp + 7) / 8 * 8);
    for (int k = 0; k < SCAN_WORDS && (uintptr_t)&word[k] < i->stack; k++)
        if (loader_is_return(i, word[k])) add_frame(r, i->t, (uint64_t)(uintptr_t)word[k] - 1);
}

/* An access near the stack pointer, far below the stack's beginning, to what is protected or not
 * there: its end. Where frames of many pages step over the guard page, the stack pointer is far
 * off, too. */
static bool is_stack_overflow(const siginfo_t *info, const struct loader_instance *i, uintptr_t sp,
                              int64_t stack_bytes)
{
    enum { NEAR = 1 << 20, MOST_DEPTH = 16 * 1024 };
    /* Of small stacks the lower quarter is deep. */
    const uintptr_t small = (uintptr_t)stack_bytes / 4 * 3,
                    depth = small < MOST_DEPTH ? small : MOST_DEPTH;
    const uintptr_t at = (uintptr_t)info->si_addr;
    const char *file;
    uint64_t in_file;
    if (info->si_signo != SIGSEGV || (info->si_code != SEGV_ACCERR && info->si_code != SEGV_MAPERR))
        return false;
    if (at > i->stack - depth || i->stack - at > MOST_STACK) return false;
    if ((at > sp ? at - sp : sp - at) > NEAR) return false;
    return !loader_find_address(i->t, info->si_addr, NULL, &file, &in_file);
}

/* Which rank ran, where in its program, and at which simulated time. */
static void note_rank(struct crash_record *r, const struct loader_template *t,
                      const siginfo_t *info, const ucontext_t *u, int *kind)
{
#ifdef __x86_64__
    const uintptr_t sp = (uintptr_t)u->uc_mcontext.gregs[REG_RSP];
    const uint64_t pc = (uint64_t)u->uc_mcontext.gregs[REG_RIP];
    const struct loader_instance *i = running_instance(t, pc, sp);
    if (!i) return;
    r->rank = i->host.rank;
    const bool overflow = *kind == CRASH_SIGNAL && is_stack_overflow(info, i, sp, r->stack_bytes);
    if (overflow) *kind = CRASH_STACK;
    /* At an overflow the words at the stack pointer are not there to be read. */
    if (overflow) add_frame(r, t, pc);
    else note_frames(r, i, pc, sp);
    if (t->hooks->now_ps) r->now_ps = t->hooks->now_ps(i->context);
#else
    (void)r, (void)t, (void)info, (void)u, (void)kind;
#endif
}

/* First the plain facts, then what needs memory of the program to be read: if that faults, the
 * facts are kept. */
static void handle(int number, siginfo_t *info, void *context)
{
    struct guard *g = guard_of_process();
    if (!g || number == 0) _exit(CRASH_STATUS);
    struct crash_record *r = g->record;
    int kind = number == SIGPROF ? CRASH_HOST_TIME : CRASH_SIGNAL;
    /* A second fault in here must not lose what is known. */
    if (atomic_load(&r->kind) != CRASH_NONE) _exit(CRASH_STATUS);
    r->signal = number;
    r->code = info->si_code;
    r->rank = -1;
    r->address = (uint64_t)(uintptr_t)info->si_addr;
    r->now_ps = -1;
    r->seconds = g->seconds;
    r->stack_bytes = g->stack_bytes;
    r->nframe = 0;
    atomic_store(&r->kind, kind);
    if (g->watched) note_rank(r, g->watched, info, context, &kind);
    atomic_store(&r->kind, kind);
    _exit(CRASH_STATUS);
}

/* Everything that the handler will need is made here, where memory may be asked for. */
bool crash_guard_begin(struct crash_record *record, struct err *e)
{
    struct guard *g =
        mmap(NULL, GUARD_BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (g == MAP_FAILED)
        return err_set(e, ERR_INTERNAL, "no memory for a signal stack: %s", strerror(errno));
    *g = (struct guard){.magic = GUARD_MAGIC, .record = record};
    const stack_t s = {.ss_sp = g, .ss_size = GUARD_BYTES};
    /* The C library loads its unwinder at the first use, which is nothing for a handler. */
    void *here[1];
    (void)backtrace(here, 1);
    if (sigaltstack(&s, &g->stack_before) != 0) {
        munmap(g, GUARD_BYTES);
        return err_set(e, ERR_INTERNAL, "no signal stack: %s", strerror(errno));
    }
    /* A fault inside the handler comes back to it (SA_NODEFER), sees the record begun, and ends the
     * process. */
    struct sigaction a = {.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER};
    a.sa_sigaction = handle;
    sigemptyset(&a.sa_mask);
    for (int i = 0; i < NSIGNAL; i++) sigaction(signals[i], &a, &g->before[i]);
    return true;
}

/* The process's own handlers and signal stack come back. */
void crash_guard_end(void)
{
    struct guard *g = guard_of_process();
    if (!g) return;
    crash_limit(0);
    for (int i = 0; i < NSIGNAL; i++) sigaction(signals[i], &g->before[i], NULL);
    stack_t before = g->stack_before;
    if (!before.ss_sp) before.ss_flags = SS_DISABLE;
    sigaltstack(&before, NULL);
    munmap(g, GUARD_BYTES);
}

/* Found as the handler finds it: there is no global variable. */
struct crash_record *crash_record_of_process(void)
{
    const struct guard *g = guard_of_process();
    return g ? g->record : NULL;
}

/* What a handler of somebody else has found out, who knows more than this one could. The kind is
 * stored last: the parent reads what is there by then. */
void crash_told(struct crash_record *record, const char *text)
{
    size_t n = strlen(text);
    if (n >= sizeof record->told) n = sizeof record->told - 1;
    memcpy(record->told, text, n);
    record->told[n] = '\0';
    atomic_store(&record->kind, CRASH_TOLD);
    _exit(CRASH_STATUS);
}

/* Between runs nobody is watched: a fault is the simulator's own then. */
void crash_watch(const struct loader_template *t, int64_t stack_bytes)
{
    struct guard *g = guard_of_process();
    if (!g) return;
    g->watched = t;
    g->stack_bytes = stack_bytes;
}

void crash_limit(double seconds)
{
    struct guard *g = guard_of_process();
    if (!g) return;
    g->seconds = seconds;
    /* Processor time, so that a busy host does not make a program too slow. */
    struct itimerval v = {{0, 0},
                          {(time_t)seconds, (suseconds_t)(1e6 * (seconds - floor(seconds)))}};
    setitimer(ITIMER_PROF, &v, NULL);
}

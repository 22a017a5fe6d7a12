/* crash.c - catching crashes of loaded programs: what the signal handler writes down before the
 * worker ends.
 *
 * The handler finds its data at the bottom of its own stack (base/signal_stack.h). It calls nothing
 * but what POSIX allows in handlers, and reads the program's memory only where it is known to be
 * mapped.
 *
 * Several programs may run at once, each as a job of its own: whose ranks an address belongs to is
 * looked for in all of them. */
#include "loader/crash.h"

#include <errno.h>
#include <execinfo.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <ucontext.h>
#include <unistd.h>

#include "base/signal_stack.h"
#include "loader/template.h"

enum { SCAN_WORDS = 4096 };

/* Stacks of ranks are smaller than this; beyond it, an address has nothing to do with the stack. */
static const uint64_t MOST_STACK = UINT64_C(1) << 30;

static const int signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF};
enum { NSIGNAL = sizeof signals / sizeof *signals };

/* A program whose ranks run. */
struct watched {
    const struct loader_template *t;
    int64_t stack_bytes; /* of its ranks */
    const char *job;     /* NULL: it has its machine alone */
};

/* The data at the bottom of the handler's stack. */
struct guard {
    struct signal_stack stack; /* first */
    struct crash_record *record;
    double seconds;
    struct sigaction before[NSIGNAL];
    int nwatched;
    struct watched watched[CRASH_PROGRAMS];
};

/* NULL where no guard has been set up, or somebody else has put another stack there. */
static struct guard *guard_of_process(void) { return signal_stack_find(SIGNAL_STACK_CRASH); }

/* The rank that ran: whose program text `pc` is, or, in the C library or the simulator, on whose
 * stack `sp` is: of the stacks that begin above it the nearest. *whose: its program. */
static const struct loader_instance *running_instance(const struct guard *g, uint64_t pc,
                                                      uintptr_t sp, const struct watched **whose)
{
    const struct loader_instance *best = NULL;
    const char *file;
    uint64_t at;
    int rank;
    for (*whose = g->watched; *whose < g->watched + g->nwatched; (*whose)++)
        if (loader_find_address((*whose)->t, (void *)(uintptr_t)pc, &rank, &file, &at))
            return &(*whose)->t->instance[rank];
    for (const struct watched *w = g->watched; w < g->watched + g->nwatched; w++)
        for (int k = 0; k < w->t->nrank; k++) {
            const struct loader_instance *i = &w->t->instance[k];
            if (!i->base || !i->outermost || i->stack < sp || i->stack - sp > MOST_STACK) continue;
            if (best && i->stack >= best->stack) continue;
            best = i;
            *whose = w;
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
static void note_rank(struct crash_record *r, const struct guard *g, const siginfo_t *info,
                      const ucontext_t *u, int *kind)
{
#ifdef __x86_64__
    const uintptr_t sp = (uintptr_t)u->uc_mcontext.gregs[REG_RSP];
    const uint64_t pc = (uint64_t)u->uc_mcontext.gregs[REG_RIP];
    const struct watched *w;
    const struct loader_instance *i = running_instance(g, pc, sp, &w);
    if (!i) return;
    r->rank = i->host.rank;
    r->stack_bytes = w->stack_bytes;
    /* Its name is memory of this process, of which the parent has a copy from before at most. */
    for (size_t n = 0; w->job && w->job[n] != '\0' && n + 1 < sizeof r->job; n++)
        r->job[n] = w->job[n];
    const bool overflow = *kind == CRASH_SIGNAL && is_stack_overflow(info, i, sp, r->stack_bytes);
    if (overflow) *kind = CRASH_STACK;
    /* At an overflow the words at the stack pointer are not there to be read. */
    if (overflow) add_frame(r, w->t, pc);
    else note_frames(r, i, pc, sp);
    if (w->t->hooks->now_ps) r->now_ps = w->t->hooks->now_ps(i->context);
#else
    (void)r, (void)g, (void)info, (void)u, (void)kind;
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
    r->stack_bytes = 0;
    memset(r->job, 0, sizeof r->job);
    r->nframe = 0;
    atomic_store(&r->kind, kind);
    note_rank(r, g, info, context, &kind);
    atomic_store(&r->kind, kind);
    _exit(CRASH_STATUS);
}

/* Everything that the handler will need is made here, where memory may be asked for. */
bool crash_guard_begin(struct crash_record *record, struct err *e)
{
    /* The C library loads its unwinder at the first use, which is nothing for a handler. */
    void *here[1];
    (void)backtrace(here, 1);
    struct guard *g = signal_stack_make(SIGNAL_STACK_CRASH);
    if (g == NULL) return err_set(e, ERR_INTERNAL, "no signal stack: %s", strerror(errno));
    g->record = record;
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
    signal_stack_end(&g->stack);
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

void crash_watch(const struct loader_template *t, int64_t stack_bytes, const char *job)
{
    struct guard *g = guard_of_process();
    if (!g || g->nwatched == CRASH_PROGRAMS) return;
    g->watched[g->nwatched++] = (struct watched){t, stack_bytes, job};
}

/* Between runs nobody is watched: a fault is the simulator's own then, and takes as long as it
 * likes. */
void crash_forget(const struct loader_template *t)
{
    struct guard *g = guard_of_process();
    if (!g) return;
    int kept = 0;
    for (int i = 0; i < g->nwatched; i++)
        if (g->watched[i].t != t) g->watched[kept++] = g->watched[i];
    g->nwatched = kept;
    if (kept == 0) crash_limit(0);
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

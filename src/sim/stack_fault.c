/* stack_fault.c - see stack_fault.h.
 *
 * A stack that is used up leaves no room for the handler, so that one has a stack of its own
 * (sigaltstack), which each thread must ask for itself. The handler finds its data without a
 * global variable: they stand at the bottom of that stack, and the system tells where it is. */
#include "sim/stack_fault.h"

#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/mman.h>

#include "sim/fiber.h"

/* The registers of the widest processors take 11 KiB of it, a sentence less than 4. */
enum { HANDLER_BYTES = 64 * 1024 };
static const uint64_t MAGIC = UINT64_C(0x737461636b66696c);

/* A guard page is protected memory (SIGSEGV) on Linux; a file that is mapped may give SIGBUS. */
static const int signals[] = {SIGSEGV, SIGBUS};
enum { NSIGNAL = sizeof signals / sizeof *signals };

struct stack_fault {
    uint64_t magic;
    const struct fiber_pool *pool;
    stack_fault_fn *tell;
    void *context;
    const struct stack_fault *first;  /* whose `before` it is; itself: the first */
    struct sigaction before[NSIGNAL]; /* of the process */
    stack_t stack_before;             /* of the thread */
};

/* The data of this thread; NULL: it has none, or somebody else has put another stack there. */
static const struct stack_fault *of_thread(void)
{
    stack_t s;
    if (sigaltstack(NULL, &s) != 0 || (s.ss_flags & SS_DISABLE) || s.ss_size != HANDLER_BYTES)
        return NULL;
    const struct stack_fault *f = s.ss_sp;
    return f->magic == MAGIC ? f : NULL;
}

/* Not ours: the one before gets it. An access happens again as soon as this returns; what somebody
 * has sent is sent again. */
static void pass_on(int number, const siginfo_t *info, const struct stack_fault *f)
{
    const struct sigaction usual = {.sa_handler = SIG_DFL};
    const struct sigaction *before = &usual;
    for (int i = 0; f != NULL && i < NSIGNAL; i++)
        if (signals[i] == number) before = &f->first->before[i];
    sigaction(number, before, NULL);
    if (info->si_code <= 0) raise(number);
}

static void handle(int number, siginfo_t *info, void *registers)
{
    const struct stack_fault *f = of_thread();
    /* Sent signals have no address. */
    const int i = f != NULL && info->si_code > 0 ? fiber_below(f->pool, info->si_addr) : -1;
    (void)registers;
    if (i >= 0) f->tell(f->context, i);
    pass_on(number, info, f);
}

/* The handler's stack for this thread, with its data. */
static struct stack_fault *make(const struct stack_fault *like)
{
    struct stack_fault *f =
        mmap(NULL, HANDLER_BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (f == MAP_FAILED) return NULL;
    *f = *like;
    f->magic = MAGIC;
    const stack_t s = {.ss_sp = f, .ss_size = HANDLER_BYTES};
    if (sigaltstack(&s, &f->stack_before) == 0) return f;
    munmap(f, HANDLER_BYTES);
    return NULL;
}

struct stack_fault *stack_fault_begin(const struct fiber_pool *p, stack_fault_fn *tell,
                                      void *context)
{
    const struct stack_fault like = {.pool = p, .tell = tell, .context = context};
    struct stack_fault *f = make(&like);
    if (f == NULL) return NULL;
    f->first = f;
    struct sigaction a = {.sa_flags = SA_SIGINFO | SA_ONSTACK};
    a.sa_sigaction = handle;
    sigemptyset(&a.sa_mask);
    for (int i = 0; i < NSIGNAL; i++) sigaction(signals[i], &a, &f->before[i]);
    return f;
}

struct stack_fault *stack_fault_join(const struct stack_fault *first)
{
    return first != NULL ? make(first) : NULL;
}

void stack_fault_end(struct stack_fault *f)
{
    if (f == NULL) return;
    for (int i = 0; f->first == f && i < NSIGNAL; i++) sigaction(signals[i], &f->before[i], NULL);
    stack_t before = f->stack_before;
    if (before.ss_sp == NULL) before.ss_flags = SS_DISABLE;
    sigaltstack(&before, NULL);
    munmap(f, HANDLER_BYTES);
}

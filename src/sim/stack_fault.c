/* stack_fault.c - see stack_fault.h.
 *
 * A stack that is used up leaves no room for the handler, so that one has a stack of its own
 * (base/signal_stack.h), which each thread must ask for itself. The handler finds its data at the
 * bottom of that stack. */
#include "sim/stack_fault.h"

#include <signal.h>
#include <stddef.h>

#include "base/signal_stack.h"
#include "sim/fiber.h"

/* A guard page is protected memory (SIGSEGV) on Linux; a file that is mapped may give SIGBUS. */
static const int signals[] = {SIGSEGV, SIGBUS};
enum { NSIGNAL = sizeof signals / sizeof *signals };

struct stack_fault {
    struct signal_stack stack; /* of the thread; first: the data lie at its bottom */
    const struct fiber_pool *pool;
    stack_fault_fn *tell;
    void *context;
    const struct stack_fault *first;  /* whose `before` it is; itself: the first */
    struct sigaction before[NSIGNAL]; /* of the process */
};

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
    /* NULL: this thread has none, or somebody else has put another stack there. */
    const struct stack_fault *f = signal_stack_find(SIGNAL_STACK_FAULT);
    /* Sent signals have no address. */
    const int i = f != NULL && info->si_code > 0 ? fiber_below(f->pool, info->si_addr) : -1;
    (void)registers;
    if (i >= 0) f->tell(f->context, i);
    pass_on(number, info, f);
}

/* The handler's stack for this thread, with its data. */
static struct stack_fault *make(const struct stack_fault *like)
{
    struct stack_fault *f = signal_stack_make(SIGNAL_STACK_FAULT);
    if (f == NULL) return NULL;
    const struct signal_stack own = f->stack;
    *f = *like;
    f->stack = own;
    return f;
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
    signal_stack_end(&f->stack);
}

/* exit.c - ends of a rank: exit and its kin end the rank, never the process; abort and assert end
 * the run. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "guest.h"

/* A function to be called at exit, in one of the forms that the C library and the C++ ABI have. */
struct handler {
    void (*plain)(void);
    void (*with_argument)(void *);
    void (*with_status)(int, void *);
    void *argument;
};

struct handlers {
    struct handler *handler;
    size_t n, capacity;
};

static struct handlers at_exit, at_thread_exit, at_quick;

static int add(struct handlers *h, struct handler one)
{
    if (h->n == h->capacity) {
        size_t capacity = h->capacity ? 2 * h->capacity : 32;
        struct handler *more = realloc(h->handler, capacity * sizeof *more);
        if (!more) return -1;
        h->handler = more;
        h->capacity = capacity;
    }
    h->handler[h->n++] = one;
    return 0;
}

/* Last in, first out. A handler may add more, and may call exit itself: each is taken off before it
 * is called. */
static void run(struct handlers *h, int status)
{
    while (h->n) {
        struct handler one = h->handler[--h->n];
        if (one.plain) one.plain();
        else if (one.with_status) one.with_status(status, one.argument);
        else one.with_argument(one.argument);
    }
}

int __cxa_atexit(void (*f)(void *), void *argument, void *file);
WEAK int __cxa_atexit(void (*f)(void *), void *argument, void *file)
{
    (void)file;
    return add(&at_exit, (struct handler){.with_argument = f, .argument = argument});
}

/* Destructors of C++ thread-locals run before those of objects with static storage
 * ([basic.start.term]). */
int __cxa_thread_atexit_impl(void (*f)(void *), void *argument, void *file);
WEAK int __cxa_thread_atexit_impl(void (*f)(void *), void *argument, void *file)
{
    (void)file;
    return add(&at_thread_exit, (struct handler){.with_argument = f, .argument = argument});
}

/* Called when a file is unloaded; here its handlers have run by then. */
void __cxa_finalize(void *file);
WEAK void __cxa_finalize(void *file) { (void)file; }

WEAK int atexit(void (*f)(void)) { return add(&at_exit, (struct handler){.plain = f}); }
WEAK int at_quick_exit(void (*f)(void)) { return add(&at_quick, (struct handler){.plain = f}); }
WEAK int on_exit(void (*f)(int, void *), void *argument)
{
    return add(&at_exit, (struct handler){.with_status = f, .argument = argument});
}

/* leave_at_once: without any handler. */
static _Noreturn void leave_at_once(int status)
{
    mimdsim_host->runtime->leave(mimdsim_host, status & 0xff);
    __builtin_unreachable();
}

_Noreturn void mimdsim_exit(int status);
_Noreturn void mimdsim_exit(int status)
{
    run(&at_thread_exit, status);
    run(&at_exit, status);
    mimdsim_account();
    mimdsim_host->runtime->finish(mimdsim_host);
    guest_flush();
    leave_at_once(status);
}

WEAK _Noreturn void exit(int status)
{
    guest_account(HERE);
    mimdsim_count_anew();
    mimdsim_exit(status);
}
WEAK _Noreturn void _exit(int status)
{
    guest_account(HERE);
    leave_at_once(status);
}
WEAK _Noreturn void _Exit(int status)
{
    guest_account(HERE);
    leave_at_once(status);
}

WEAK _Noreturn void quick_exit(int status)
{
    run(&at_quick, status);
    leave_at_once(status);
}

WEAK _Noreturn void abort(void) { guest_fail(HERE, "calls abort()"); }

_Noreturn void __assert_fail(const char *condition, const char *file, unsigned line,
                             const char *function);
WEAK _Noreturn void __assert_fail(const char *condition, const char *file, unsigned line,
                                  const char *function)
{
    const char *slash = strrchr(file, '/');
    guest_fail(HERE, "the assertion \"%s\" of %s (%s:%u) does not hold", condition, function,
               slash ? slash + 1 : file, line);
}

/* fiber.c - stacks from one reserved mapping; switching by Boost.Context's assembly or by
 * ucontext. */
#include "config.h"

#include "sim/fiber.h"

#include <errno.h>
#include <link.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/arena.h"
#include "base/check.h"
#include "base/large_pages.h"
#include "base/memory.h"
#include "base/size.h"
#include "sim/guard.h"

#ifdef SANITIZERS
#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#endif

#ifdef THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

#ifdef HAVE_FCONTEXT
/* The C interface of Boost.Context's assembly, which its own headers declare for C++ only. */
struct transfer {
    void *context;
    void *data;
};
struct transfer jump_fcontext(void *to, void *data);
void *make_fcontext(void *stack_top, size_t size, void (*entry)(struct transfer));
#else
#include <ucontext.h>
#endif

/* Start addresses of neighbouring stacks are shifted by one of COLOURS multiples of
 * COLOUR_BYTES. */
enum { COLOURS = 8, COLOUR_BYTES = 128 };

struct fiber {
    struct fiber_pool *pool;
    fiber_fn *fn;
    void *argument;
    char *stack; /* lowest byte; the guard or spare page lies below */
    int64_t switches; /* by whichever thread: each fiber counts its own */
    bool finished;
#ifdef HAVE_FCONTEXT
    void *context; /* of the fiber while it is left */
    void *outside; /* of the host while the fiber runs */
#else
    ucontext_t context, outside;
#endif
#ifdef SANITIZERS
    void *fake_fiber, *fake_outside;
    const void *outside_stack;
    size_t outside_size;
#endif
#ifdef THREAD_SANITIZER
    void *tsan_fiber, *tsan_outside;
#endif
};

struct fiber_pool {
    struct arena *arena; /* of `fiber`, owned */
    struct fiber *fiber; /* (n) */
    char *base;          /* of the lowest stack, or what is below it */
    char *mapping, *heap; /* where they are, the other NULL */
    size_t mapped;       /* its bytes */
    size_t stride;       /* stack and what is below it */
    size_t below;        /* the guard page; 0: packed, none */
    size_t stack_bytes, page;
    int n, nguard;
    int room; /* stacks that are mapped, n of them in use */
    int colours; /* of tops: COLOURS, or 1 */
};

/* The address sanitizer keeps a shadow of the current stack. Each switch is announced before, with
 * the bounds of the stack to come, and confirmed after it, on the new stack. NULL instead of the
 * place to save says that the stack being left is finished. */
#ifdef SANITIZERS
static void sanitizer_enter(struct fiber *f)
{
    __sanitizer_start_switch_fiber(&f->fake_outside, f->stack, f->pool->stack_bytes);
}
static void sanitizer_entered(struct fiber *f)
{
    __sanitizer_finish_switch_fiber(f->fake_fiber, &f->outside_stack, &f->outside_size);
}
static void sanitizer_leave(struct fiber *f)
{
    __sanitizer_start_switch_fiber(f->finished ? NULL : &f->fake_fiber, f->outside_stack,
                                   f->outside_size);
}
static void sanitizer_left(struct fiber *f)
{
    __sanitizer_finish_switch_fiber(f->fake_outside, NULL, NULL);
}

/* A mapping at the address of an earlier pool must not inherit what was poisoned there. */
static void sanitizer_fresh(void *memory, size_t bytes)
{
    __asan_unpoison_memory_region(memory, bytes);
}
#elif defined THREAD_SANITIZER
/* The thread sanitizer keeps the calls of each fiber apart, and must hear of each switch before
 * it. */
static void sanitizer_enter(struct fiber *f)
{
    if (!f->tsan_fiber) f->tsan_fiber = __tsan_create_fiber(0);
    f->tsan_outside = __tsan_get_current_fiber();
    __tsan_switch_to_fiber(f->tsan_fiber, 0);
}
static void sanitizer_entered(struct fiber *f) { (void)f; }
static void sanitizer_leave(struct fiber *f) { __tsan_switch_to_fiber(f->tsan_outside, 0); }
static void sanitizer_left(struct fiber *f)
{
    if (f->finished) __tsan_destroy_fiber(f->tsan_fiber);
}
static void sanitizer_fresh(void *memory, size_t bytes) { (void)memory, (void)bytes; }
#else
static inline void sanitizer_enter(struct fiber *f) { (void)f; }
static inline void sanitizer_entered(struct fiber *f) { (void)f; }
static inline void sanitizer_leave(struct fiber *f) { (void)f; }
static inline void sanitizer_left(struct fiber *f) { (void)f; }
static inline void sanitizer_fresh(void *memory, size_t bytes) { (void)memory, (void)bytes; }
#endif

/* Stacks are rounded up to pages: guards are made and stack use is measured in pages. */
static size_t whole_pages(int64_t stack_bytes, size_t page)
{
    return ((size_t)stack_bytes + page - 1) / page * page;
}

/* A mapping of `bytes` that is reserved and not committed. MAP_NORESERVE: ten thousands of stacks
 * may be reserved on a machine that has memory for the touched pages only. */
static char *reserve(size_t bytes, int n, struct err *e)
{
    char *base = mmap(NULL, bytes, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_STACK, -1, 0);
    if (base != MAP_FAILED) {
        sanitizer_fresh(base, bytes);
        return base;
    }
    err_set(e, ERR_INTERNAL,
            "cannot reserve %zu bytes of address space for the stacks of %d virtual processors: %s",
            bytes, n, strerror(errno));
    return NULL;
}

static struct fiber_pool *pool_make(const struct fiber_pool *like)
{
    struct fiber_pool *p = memory_take(1, sizeof *p);
    *p = *like;
    p->arena = arena_create();
    /* Of processes that share a run each starts some of them, but all of packed ones. */
    p->fiber = TAKE_FULL(p->arena, p->n, struct fiber, p->below == 0);
    p->room = p->n;
    return p;
}

struct fiber_pool *fiber_pool_create(int n, int64_t stack_bytes, struct err *e)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), stack = whole_pages(stack_bytes, page);
    struct fiber_pool p = {.n = n, .page = page, .stack_bytes = stack, .below = page};
    p.stride = stack + page;
    p.mapped = p.stride * (size_t)n;
    p.colours = COLOURS;
    p.base = p.mapping = reserve(p.mapped, n, e);
    if (!p.base) return NULL;
    madvise(p.base, p.mapped, MADV_NOHUGEPAGE); /* else one touched page would commit 2 MiB */
    /* Where not all can be had, fiber_pool_stack_peak looks at the spare pages instead. */
    p.nguard = guard_pages(p.base, p.stride, page, n);
    return pool_make(&p);
}

#ifdef KNOWN_DEPTH
/* Whether the dynamic linker has found every function of the program before main: its own section
 * says so. */
static bool bound_at_start(void)
{
    for (const ElfW(Dyn) *d = _DYNAMIC; d->d_tag != DT_NULL; d++)
        if (d->d_tag == DT_BIND_NOW ||
            (d->d_tag == DT_FLAGS && (d->d_un.d_val & DF_BIND_NOW) != 0) ||
            (d->d_tag == DT_FLAGS_1 && (d->d_un.d_val & DF_1_NOW) != 0))
            return true;
    return false;
}

/* Of signals that come at any time: the faults of a program end it. */
static bool handler_on_own_stack(int number)
{
    static const int fault[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP};
    struct sigaction now;
    for (size_t i = 0; i < sizeof fault / sizeof *fault; i++)
        if (number == fault[i]) return false;
    if (sigaction(number, NULL, &now) != 0 || (now.sa_flags & SA_ONSTACK) != 0) return false;
    return (now.sa_flags & SA_SIGINFO) != 0 ||
           (now.sa_handler != SIG_DFL && now.sa_handler != SIG_IGN);
}

bool fiber_packs(void)
{
    const char *preloaded = getenv("LD_PRELOAD"); /* another malloc */
    bool packs = bound_at_start() && (preloaded == NULL || *preloaded == '\0');
    for (int number = 1; number < NSIG && packs; number++) packs = !handler_on_own_stack(number);
    return packs;
}
#else
bool fiber_packs(void) { return false; }
#endif

struct fiber_pool *fiber_pool_create_packed(int n, struct err *e)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), bytes = page * (size_t)n;
    struct fiber_pool p = {.n = n, .page = page, .stack_bytes = page, .stride = page};
    p.colours = 1;
    /* A few of them lie in the large pages of the heap, which are there already. What goes beyond
     * the lowest stack meets two pages that are nobody's. */
    if (bytes < LARGE_PAGE) {
        p.heap = memory_aligned(page, (size_t)n + 2, page);
        p.base = p.heap + 2 * page;
        memset(p.base, 0, bytes);
        return pool_make(&p);
    }
    /* From a border of large pages on, which all systems but new ones leave to chance. */
    p.mapped = bytes + LARGE_PAGE;
    p.mapping = reserve(p.mapped, n, e);
    if (!p.mapping) return NULL;
    p.base = p.mapping + (0 - (uintptr_t)p.mapping) % LARGE_PAGE;
    madvise(p.base, bytes, MADV_HUGEPAGE);
    return pool_make(&p);
}

bool fiber_pool_again(struct fiber_pool *p, int n, int64_t stack_bytes)
{
    if (n > p->room || p->below == 0 || whole_pages(stack_bytes, p->page) != p->stack_bytes)
        return false;
    for (int i = 0; i < p->n; i++) CHECK(p->fiber[i].pool == NULL || p->fiber[i].finished);
    sanitizer_fresh(p->base, p->stride * (size_t)p->n);
    memset(p->fiber, 0, (size_t)p->n * sizeof *p->fiber);
    p->n = n;
    p->colours = COLOURS;
    return true;
}

void fiber_pool_fill(struct fiber_pool *p) { p->colours = 1; }

void fiber_pool_destroy(struct fiber_pool *p)
{
    if (!p) return;
    sanitizer_fresh(p->base, p->stride * (size_t)p->room); /* the next one here inherits nothing */
    if (p->mapping) munmap(p->mapping, p->mapped);
    free(p->heap);
    arena_destroy(p->arena);
    free(p);
}

#ifdef HAVE_FCONTEXT
/* The first switch into a fiber arrives here, every later one behind the jump that left it. This
 * function must not return: there is no caller on this stack. */
static void entry(struct transfer t)
{
    struct fiber *f = t.data;
    f->outside = t.context;
    sanitizer_entered(f);
    f->fn(f->argument);
    f->finished = true;
    sanitizer_leave(f);
    jump_fcontext(f->outside, f);
    CHECK(f->pool == NULL); /* a finished fiber was entered */
}

static void prepare(struct fiber *f, char *top)
{
    f->context = make_fcontext(top, (size_t)(top - f->stack), entry);
}

/* A jump returns when somebody jumps back, and hands over where that one continues. */
static inline void switch_in(struct fiber *f) { f->context = jump_fcontext(f->context, f).context; }

static inline void switch_out(struct fiber *f)
{
    f->outside = jump_fcontext(f->outside, f).context;
}

/* The first lines of a fiber are those that jump_fcontext saved on top of its stack. */
void fiber_prefetch_stack(const struct fiber *f)
{
    const char *top = f->context;
    for (int line = 0; line < 6; line++) __builtin_prefetch(top + 64 * line);
}

const char *fiber_backend(void) { return "fcontext"; }
#else
/* makecontext passes int arguments only, so that the pointer comes in two halves. */
static void entry(unsigned high, unsigned low)
{
    struct fiber *f = (struct fiber *)((uintptr_t)high << 32 | low);
    sanitizer_entered(f);
    f->fn(f->argument);
    f->finished = true;
    sanitizer_leave(f);
    setcontext(&f->outside);
}

static void prepare(struct fiber *f, char *top)
{
    getcontext(&f->context);
    f->context.uc_stack.ss_sp = f->stack;
    f->context.uc_stack.ss_size = (size_t)(top - f->stack);
    f->context.uc_link = NULL;
    uintptr_t address = (uintptr_t)f;
    makecontext(&f->context, (void (*)(void))entry, 2, (unsigned)(address >> 32),
                (unsigned)address);
}

static inline void switch_in(struct fiber *f) { swapcontext(&f->outside, &f->context); }

static inline void switch_out(struct fiber *f) { swapcontext(&f->context, &f->outside); }

void fiber_prefetch_stack(const struct fiber *f) { (void)f; }

const char *fiber_backend(void) { return "ucontext"; }
#endif

struct fiber *fiber_start(struct fiber_pool *p, int i, fiber_fn *fn, void *argument)
{
    CHECK(i >= 0 && i < p->n);
    struct fiber *f = &p->fiber[i];
    /* What ran in this place before has been counted, and stays so. */
    *f = (struct fiber){.pool = p, .fn = fn, .argument = argument, .switches = f->switches};
    f->stack = p->base + p->stride * (size_t)i + p->below;
    /* Stacks lie a whole number of pages apart, so that their tops would compete for the same sets
     * of the first-level cache. Shifted tops keep the hot lines of different fibers apart. */
    char *top = f->stack + p->stack_bytes - (size_t)(i % p->colours) * COLOUR_BYTES;
    prepare(f, top);
    return f;
}

bool fiber_enter(struct fiber *f)
{
    CHECK(!f->finished);
    f->switches++;
    sanitizer_enter(f);
    switch_in(f);
    sanitizer_left(f);
    return !f->finished;
}

void fiber_leave(struct fiber *f)
{
    sanitizer_leave(f);
    switch_out(f);
    sanitizer_entered(f);
}

/* Pages down to the lowest resident one. Stacks grow downwards, so this is the depth ever reached;
 * a page that was skipped (a large array never written) counts too. */
static size_t resident_depth(const unsigned char *resident, size_t npage)
{
    size_t lowest = 0;
    while (lowest < npage && !(resident[lowest] & 1)) lowest++;
    return npage - lowest;
}

/* Memory of the system is zero where nothing was written. Of neighbours that follow each other the
 * uppermost has gone too far. */
static int64_t packed_peak(const struct fiber_pool *p, int *overflowed)
{
    size_t deepest = 0;
    *overflowed = -1;
    for (int i = 0; i < p->n; i++) {
        const uint64_t *word = (const uint64_t *)(const void *)(p->base + p->stride * (size_t)i);
        const size_t words = p->stride / sizeof *word;
        size_t zero = 0;
        while (zero < words && word[zero] == 0) zero++;
        if (zero * sizeof *word < FIBER_PACKED_SPARE && (*overflowed < 0 || *overflowed == i - 1))
            *overflowed = i;
        const size_t depth = p->stride - zero * sizeof *word;
        if (depth > deepest) deepest = depth;
    }
    return (int64_t)deepest;
}

int64_t fiber_pool_stack_peak(const struct fiber_pool *p, int *overflowed)
{
    if (p->below == 0) return packed_peak(p, overflowed);
    enum { BATCH = 1024 };
    size_t npage = p->stride / p->page, deepest = 0;
    /* mincore answers for a range of pages at once. In batches, the answer stays small whatever the
     * number of fibers. */
    unsigned char *resident = memory_take(size_product(npage, BATCH), 1);
    *overflowed = -1;
    for (int first = 0; first < p->n; first += BATCH) {
        size_t n = (size_t)(p->n - first < BATCH ? p->n - first : BATCH);
        /* A kernel without mincore: report what was found so far, since this is a statistic
         * only. */
        if (mincore(p->base + p->stride * (size_t)first, p->stride * n, resident) != 0) break;
        for (size_t k = 0; k < n; k++) {
            const unsigned char *r = resident + k * npage;
            /* The spare page was touched: without a guard nothing stopped it. Stacks grow down, so
             * of neighbours that follow each other it was the uppermost. */
            const int i = first + (int)k;
            if (i >= p->nguard && (r[0] & 1) && (*overflowed < 0 || *overflowed == i - 1))
                *overflowed = i;
            size_t depth = resident_depth(r + 1, npage - 1);
            if (depth > deepest) deepest = depth;
        }
    }
    free(resident);
    return (int64_t)(deepest * p->page);
}

/* Stacks with their pages lie side by side, so a division finds the one. */
int fiber_below(const struct fiber_pool *p, const void *address)
{
    const uintptr_t from = (uintptr_t)p->base, at = (uintptr_t)address;
    if (at < from || at - from >= p->stride * (size_t)p->n) return -1;
    return (at - from) % p->stride < p->below ? (int)((at - from) / p->stride) : -1;
}

int64_t fiber_pool_switches(const struct fiber_pool *p)
{
    int64_t n = 0;
    for (int i = 0; i < p->n; i++) n += p->fiber[i].switches;
    return n;
}

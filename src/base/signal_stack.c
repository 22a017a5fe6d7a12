/* signal_stack.c - see signal_stack.h.
 *
 * The system knows one such stack for each thread, and gives it back when another one takes its
 * place: so they form a chain, whose links are in the stacks themselves. */
#include "base/signal_stack.h"

#include <stddef.h>
#include <sys/mman.h>

static const uint64_t MAGIC = UINT64_C(0x7369676e616c7374);

void *signal_stack_make(enum signal_stack_kind kind)
{
    struct signal_stack *s =
        mmap(NULL, SIGNAL_STACK_BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (s == MAP_FAILED) return NULL;
    /* Data before the stack: a handler may come as soon as the system knows it. */
    s->magic = MAGIC;
    s->kind = kind;
    const stack_t own = {.ss_sp = s, .ss_size = SIGNAL_STACK_BYTES};
    if (sigaltstack(&own, &s->before) == 0) return s;
    munmap(s, SIGNAL_STACK_BYTES);
    return NULL;
}

/* Ours, or NULL. Whose size is another one is not even looked at. */
static struct signal_stack *ours(const stack_t *s)
{
    if ((s->ss_flags & SS_DISABLE) || s->ss_sp == NULL || s->ss_size != SIGNAL_STACK_BYTES)
        return NULL;
    struct signal_stack *own = s->ss_sp;
    return own->magic == MAGIC ? own : NULL;
}

/* From the latest back. */
void *signal_stack_find(enum signal_stack_kind kind)
{
    stack_t now;
    if (sigaltstack(NULL, &now) != 0) return NULL;
    struct signal_stack *s = ours(&now);
    while (s != NULL && s->kind != kind) s = ours(&s->before);
    return s;
}

void signal_stack_end(struct signal_stack *s)
{
    stack_t before = s->before;
    /* A thread that had none gets none: the system gave no place for it. */
    if (before.ss_sp == NULL) before.ss_flags = SS_DISABLE;
    sigaltstack(&before, NULL);
    munmap(s, SIGNAL_STACK_BYTES);
}

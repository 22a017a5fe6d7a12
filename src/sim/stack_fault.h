/* stack_fault.h - who has gone beyond its stack: told by the number of its fiber, before the
 * process ends. */
#ifndef SIM_STACK_FAULT_H
#define SIM_STACK_FAULT_H

struct fiber_pool;

/* One thread's part of it: a stack for the signal's handler, with what that has to know. */
struct stack_fault;

/* Called in a signal handler, on a stack of its own: what POSIX allows there, and sentences with
 * snprintf, which asks for no memory for words and whole numbers. Ends the process, or returns:
 * then whoever handled faults before gets this one. */
typedef void stack_fault_fn(void *context, int fiber);

/* stack_fault_begin: from now on, when this thread touches the guard page below the stack of fiber
 * i of `p` (fiber.h), `tell(context, i)` is called. What else faults ends as without it. NULL: the
 * system has no memory for the handler's stack, and all faults end as without it. */
struct stack_fault *stack_fault_begin(const struct fiber_pool *p, stack_fault_fn *tell,
                                      void *context);

/* stack_fault_join: the same for the calling thread, which is another one, and runs fibers of the
 * same pool. NULL as above, or where `first` is NULL. */
struct stack_fault *stack_fault_join(const struct stack_fault *first);

/* stack_fault_end: by the thread that made it, in which faults then act as before; the first one
 * last. NULL: nothing. */
void stack_fault_end(struct stack_fault *f);

#endif

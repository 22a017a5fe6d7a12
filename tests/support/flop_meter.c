/* flop_meter.c - the calls of the compiler's library that quad arithmetic makes (flop_meter.h). */
#include "flop_meter.h"

#include <stdbool.h>

typedef __float128 quad;

static struct work executed;
static int running; /* 0: stopped; otherwise 1, less than that while constants are made */

void flop_meter_start(void)
{
    executed = (struct work){0};
    running = 1;
}

void flop_meter_pause(void) { running--; }
void flop_meter_resume(void) { running++; }

struct work flop_meter_stop(void)
{
    running = 0;
    return executed;
}

/* The operation of two operands called `name` in the library, counted in `field`. */
#define BINARY(name, field)                                                                        \
    quad __real_##name(quad x, quad y);                                                            \
    quad __wrap_##name(quad x, quad y);                                                            \
    quad __wrap_##name(quad x, quad y)                                                             \
    {                                                                                              \
        executed.field += running == 1;                                                            \
        return __real_##name(x, y);                                                                \
    }
#define UNARY(name, field)                                                                         \
    quad __real_##name(quad x);                                                                    \
    quad __wrap_##name(quad x);                                                                    \
    quad __wrap_##name(quad x)                                                                     \
    {                                                                                              \
        executed.field += running == 1;                                                            \
        running--; /* what it does inside is its own business */                                   \
        const quad y = __real_##name(x);                                                           \
        running++;                                                                                 \
        return y;                                                                                  \
    }

BINARY(__addtf3, flop)
BINARY(__subtf3, flop)
BINARY(__multf3, flop)
BINARY(__divtf3, div)
UNARY(sqrtq, sqrt)
UNARY(sinq, trig)
UNARY(cosq, trig)

/* What prepares a model: not counted. */
#define PREPARATION(type, name, parameters, arguments)                                             \
    type __real_##name parameters;                                                                 \
    type __wrap_##name parameters;                                                                 \
    type __wrap_##name parameters                                                                  \
    {                                                                                              \
        running--;                                                                                 \
        type result = __real_##name arguments;                                                     \
        running++;                                                                                 \
        return result;                                                                             \
    }
#define PREPARATION_VOID(name, parameters, arguments)                                              \
    void __real_##name parameters;                                                                 \
    void __wrap_##name parameters;                                                                 \
    void __wrap_##name parameters                                                                  \
    {                                                                                              \
        running--;                                                                                 \
        __real_##name arguments;                                                                   \
        running++;                                                                                 \
    }

PREPARATION(const void *, bodies_make_f128, (const void *m, void *a), (m, a))
PREPARATION(const void *, bodies_make_planar_f128, (const void *m, void *a), (m, a))
PREPARATION(void *, revolutes_take_f128, (const void *m, const void *b, void *a), (m, b, a))
PREPARATION(int, loop_rows_planar_f128, (const void *m), (m))
PREPARATION_VOID(base_motion_f128, (const void *m, const void *s, quad *a), (m, s, a))
PREPARATION_VOID(base_motion_planar_f128, (const void *m, const void *s, quad *a), (m, s, a))
PREPARATION_VOID(loop_make_f128, (const void *m, int i, void *l), (m, i, l))
PREPARATION_VOID(loops_make_planar_f128, (const void *m, void *l, int *place), (m, l, place))

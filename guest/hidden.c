/* hidden.c - functions of the C library that keep something between calls: here each rank has its
 * own.
 *
 * The random numbers are the C library's own, from its functions that take their state as an
 * argument. */
#include <locale.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <threads.h>

#include "guest.h"

/* --- rand, random --- */

static struct random_data random_data;
static char random_state[128]; /* the C library's default: degree 31 */

static void random_begin(void)
{
    if (!random_data.state) initstate_r(1, random_state, sizeof random_state, &random_data);
}

WEAK long random(void)
{
    int32_t x;
    random_begin();
    random_r(&random_data, &x);
    return x;
}
WEAK int rand(void) { return (int)random(); }

WEAK void srandom(unsigned seed)
{
    random_begin();
    srandom_r(seed, &random_data);
}
WEAK void srand(unsigned seed) { srandom(seed); }

WEAK char *initstate(unsigned seed, char *state, size_t n)
{
    random_begin();
    char *before = (char *)random_data.state;
    return initstate_r(seed, state, n, &random_data) ? NULL : before;
}

WEAK char *setstate(char *state)
{
    random_begin();
    char *before = (char *)random_data.state;
    return setstate_r(state, &random_data) ? NULL : before;
}

/* --- drand48 --- */

static struct drand48_data drand;
static unsigned short drand_before[3];

WEAK double drand48(void)
{
    double x;
    drand48_r(&drand, &x);
    return x;
}
WEAK double erand48(unsigned short state[3])
{
    double x;
    erand48_r(state, &drand, &x);
    return x;
}
WEAK long lrand48(void)
{
    long x;
    lrand48_r(&drand, &x);
    return x;
}
WEAK long nrand48(unsigned short state[3])
{
    long x;
    nrand48_r(state, &drand, &x);
    return x;
}
WEAK long mrand48(void)
{
    long x;
    mrand48_r(&drand, &x);
    return x;
}
WEAK long jrand48(unsigned short state[3])
{
    long x;
    jrand48_r(state, &drand, &x);
    return x;
}
WEAK void srand48(long seed) { srand48_r(seed, &drand); }
WEAK void lcong48(unsigned short p[7]) { lcong48_r(p, &drand); }
WEAK unsigned short *seed48(unsigned short state[3])
{
    memcpy(drand_before, drand.__x, sizeof drand_before);
    seed48_r(state, &drand);
    return drand_before;
}

/* --- strings --- */

static char *token;

WEAK char *strtok(char *restrict text, const char *restrict separators)
{
    return strtok_r(text, separators, &token);
}

/* The locale belongs to the process; programs get the "C" locale, which is the one they start with.
 */
WEAK char *setlocale(int category, const char *name)
{
    static char c[] = "C";
    (void)category;
    return !name || !*name || strcmp(name, "C") == 0 || strcmp(name, "POSIX") == 0 ? c : NULL;
}

/* --- things done once, things kept per thread: a rank is one thread --- */

WEAK int pthread_once(pthread_once_t *once, void (*f)(void))
{
    if (*once) return 0;
    *once = 2;
    f();
    return 0;
}

WEAK void call_once(once_flag *once, void (*f)(void)) { pthread_once((pthread_once_t *)once, f); }

enum { KEYS = 128 };
static struct {
    const void *value;
    int used;
} key[KEYS];

WEAK int pthread_key_create(pthread_key_t *k, void (*destructor)(void *))
{
    (void)destructor; /* runs when a thread ends before its process; a rank never does */
    for (unsigned i = 0; i < KEYS; i++) {
        if (key[i].used) continue;
        key[i].used = 1;
        key[i].value = NULL;
        *k = i;
        return 0;
    }
    return 11; /* EAGAIN */
}

WEAK int pthread_key_delete(pthread_key_t k)
{
    if (k >= KEYS) return 22; /* EINVAL */
    key[k].used = 0;
    return 0;
}

WEAK void *pthread_getspecific(pthread_key_t k)
{
    return k < KEYS ? (void *)(uintptr_t)key[k].value : NULL;
}

WEAK int pthread_setspecific(pthread_key_t k, const void *value)
{
    if (k >= KEYS) return 22; /* EINVAL */
    key[k].value = value;
    return 0;
}

/* sort.c - sorting and searching with the program's own comparisons.
 *
 * The C library's functions keep values in r15 while they call a comparison, which counts its
 * blocks there: so these are our own, compiled like the program. Merging from the bottom up:
 * stable, as the C library's is where memory suffices, n log n comparisons at worst. */
#include <search.h>
#include <stdlib.h>
#include <string.h>

#include "guest.h"

/* A comparison with or without a third argument. */
struct order {
    int (*plain)(const void *, const void *);
    int (*with_argument)(const void *, const void *, void *);
    void *argument;
};

static int compare(const struct order *o, const void *a, const void *b)
{
    return o->plain ? o->plain(a, b) : o->with_argument(a, b, o->argument);
}

/* Short pieces by insertion: fewer moves than merging. */
static void insert_sort(char *x, size_t n, size_t size, char *one, const struct order *o)
{
    for (size_t i = 1; i < n; i++) {
        size_t k = i;
        while (k > 0 && compare(o, x + (k - 1) * size, x + i * size) > 0) k--;
        if (k == i) continue;
        memcpy(one, x + i * size, size);
        memmove(x + (k + 1) * size, x + k * size, (i - k) * size);
        memcpy(x + k * size, one, size);
    }
}

/* Two sorted neighbours, a before b, to one. */
static void merge(const char *a, size_t na, const char *b, size_t nb, char *to, size_t size,
                  const struct order *o)
{
    while (na && nb) {
        if (compare(o, b, a) < 0) {
            memcpy(to, b, size);
            b += size, nb--;
        } else {
            memcpy(to, a, size);
            a += size, na--;
        }
        to += size;
    }
    memcpy(to, a, na * size);
    memcpy(to + na * size, b, nb * size);
}

static void sort(void *base, size_t n, size_t size, const struct order *o)
{
    enum { RUN = 8 };
    if (n < 2 || size == 0) return;
    char *x = base, *other = malloc(n * size);
    if (!other)
        guest_fail(HERE, "sorts %zu elements of %zu bytes: no memory for a copy of them", n, size);
    for (size_t i = 0; i < n; i += RUN)
        insert_sort(x + i * size, n - i < RUN ? n - i : RUN, size, other, o);

    /* Runs of `width` lie in `from`; pairs of them go to `to`, and the two change places. */
    char *from = x, *to = other;
    for (size_t width = RUN; width < n; width *= 2) {
        for (size_t i = 0; i < n; i += 2 * width) {
            size_t na = n - i < width ? n - i : width, nb = n - i - na < width ? n - i - na : width;
            merge(from + i * size, na, from + (i + na) * size, nb, to + i * size, size, o);
        }
        char *swap = from;
        from = to;
        to = swap;
    }
    if (from != x) memcpy(x, from, n * size);
    free(other);
}

WEAK void qsort(void *base, size_t n, size_t size, int (*f)(const void *, const void *))
{
    sort(base, n, size, &(struct order){.plain = f});
}

WEAK void qsort_r(void *base, size_t n, size_t size, int (*f)(const void *, const void *, void *),
                  void *argument)
{
    sort(base, n, size, &(struct order){.with_argument = f, .argument = argument});
}

WEAK void *bsearch(const void *wanted, const void *base, size_t n, size_t size,
                   int (*f)(const void *, const void *))
{
    const char *x = base;
    while (n) {
        const char *middle = x + n / 2 * size;
        int order = f(wanted, middle);
        if (order == 0) return (void *)middle;
        if (order > 0) x = middle + size, n -= n / 2 + 1;
        else n /= 2;
    }
    return NULL;
}

WEAK void *lfind(const void *wanted, const void *base, size_t *n, size_t size,
                 int (*f)(const void *, const void *))
{
    const char *x = base;
    for (size_t i = 0; i < *n; i++)
        if (f(wanted, x + i * size) == 0) return (void *)(x + i * size);
    return NULL;
}

WEAK void *lsearch(const void *wanted, void *base, size_t *n, size_t size,
                   int (*f)(const void *, const void *))
{
    void *found = lfind(wanted, base, n, size, f);
    if (found) return found;
    return memcpy((char *)base + size * (*n)++, wanted, size);
}

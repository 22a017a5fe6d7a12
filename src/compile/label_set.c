/* label_set.c - an open hash table of names that doubles when it is half full. */
#include "compile/label_set.h"

#include <ctype.h>
#include <stdint.h>
#include <string.h>

struct label_set {
    struct arena *arena;
    struct span *slot; /* (size), size a power of two; n = 0: free */
    size_t size, used;
};

enum { FIRST_SIZE = 1024 };

/* Slots of length 0 are free: TAKE gives zeros. */
struct label_set *label_set_make(struct arena *a)
{
    struct label_set *set = TAKE(a, 1, struct label_set);
    *set = (struct label_set){a, TAKE(a, FIRST_SIZE, struct span), FIRST_SIZE, 0};
    return set;
}

/* FNV-1a. */
static uint64_t hash(struct span name)
{
    uint64_t h = UINT64_C(0xcbf29ce484222325);
    for (int i = 0; i < name.n; i++) h = (h ^ (unsigned char)name.s[i]) * UINT64_C(0x100000001b3);
    return h;
}

/* Where the name is, or the free slot where it belongs. */
static struct span *find(const struct label_set *set, struct span name)
{
    size_t i = hash(name) & (set->size - 1);
    while (set->slot[i].n > 0) {
        const struct span *there = &set->slot[i];
        if (there->n == name.n && memcmp(there->s, name.s, (size_t)name.n) == 0) break;
        i = (i + 1) & (set->size - 1);
    }
    return &set->slot[i];
}

void label_set_put(struct label_set *set, struct span name)
{
    struct span *slot = find(set, name);
    if (name.n == 0 || slot->n > 0) return;
    *slot = name;
    if (2 * ++set->used < set->size) return;
    /* Half full: all into a table of twice the size; the arena takes the old one with it at the
     * end. */
    const struct label_set old = *set;
    set->size *= 2;
    set->slot = TAKE(set->arena, set->size, struct span);
    for (size_t i = 0; i < old.size; i++)
        if (old.slot[i].n > 0) *find(set, old.slot[i]) = old.slot[i];
}

bool label_set_has(const struct label_set *set, struct span name)
{
    return name.n > 0 && find(set, name)->n > 0;
}

/* Every name that begins with .L, wherever it stands in the operands: differences such as
 * .L4-.L2 in tables of jumps name two. */
void label_set_put_local(struct label_set *set, struct span operands)
{
    const char *s = operands.s, *end = s + operands.n;
    while (s < end) {
        const char *begin = s;
        while (s < end && (isalnum((unsigned char)*s) || *s == '_' || *s == '.' || *s == '$')) s++;
        const struct span name = {begin, (int)(s - begin)};
        if (span_starts(name, ".L")) label_set_put(set, name);
        if (s == begin) s++;
    }
}

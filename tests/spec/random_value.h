/* random_value.h - a text that a field takes, drawn at random: for tests that go through all
 * fields. */
#ifndef TESTS_RANDOM_VALUE_H
#define TESTS_RANDOM_VALUE_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/random.h"
#include "spec/field.h"

/* Some text in the range of f. */
static void random_value(const struct field *f, struct random *r, char *text, size_t size)
{
    double top = f->max < 1e6 ? f->max : 1e6, low = f->min > -1e6 ? f->min : -1e6;
    char unit[64];
    switch (f->kind) {
    case FIELD_REAL:
        units_print(random_uniform(r, low, top), f->unit, text, (int)size);
        break;
    case FIELD_INT:
        snprintf(text, size, "%.0f", floor(random_uniform(r, low, top)));
        break;
    case FIELD_INT64:
        snprintf(text, size, "%.0f B", floor(random_uniform(r, low < 0 ? 0 : low, top)));
        break;
    case FIELD_SEED:
        snprintf(text, size, "%llu", (unsigned long long)random_u64(r));
        break;
    case FIELD_BOOL:
        snprintf(text, size, "%s", random_below(r, 2) ? "true" : "false");
        break;
    case FIELD_CHOICE: {
        int n = 0;
        while (f->choice[n] != NULL) n++;
        snprintf(text, size, "%s", f->choice[random_below(r, (uint64_t)n)]);
        break;
    }
    case FIELD_TEXT:
        if (strcmp(f->key, "software.collectives") == 0)
            snprintf(text, size, "reduce chain; scan linear from %llu B",
                     (unsigned long long)random_below(r, 100000));
        else if (strcmp(f->key, "network.collective.kinds") == 0) snprintf(text, size, "reduce");
        else if (f->valid) snprintf(text, size, "ring");
        else snprintf(text, size, "name-%llu", (unsigned long long)random_below(r, 100000));
        break;
    case FIELD_INTS:
        snprintf(text, size, "[%llu, 3]", (unsigned long long)random_below(r, 50) + 1);
        break;
    case FIELD_INT_LIST:
        snprintf(text, size, "[5, %llu, 1]", (unsigned long long)random_below(r, 50) + 1);
        break;
    case FIELD_PAIR_LIST:
        snprintf(text, size, "[[0, %llu], [2, 1]]", (unsigned long long)random_below(r, 50));
        break;
    case FIELD_SEGMENTS:
        snprintf(text, size,
                 "[{from: 0 B, send.copy: %.17g s/B}, {from: %llu B, gap: 1 us, protocol: "
                 "synchronous}]",
                 random_uniform(r, 0, 1), (unsigned long long)random_below(r, 1 << 20) + 1);
        break;
    case FIELD_REALS: {
        size_t n = (size_t)snprintf(text, size, "[");
        for (int i = 0; i < f->capacity; i++) {
            units_print(random_uniform(r, low, top), f->unit, unit, (int)sizeof unit);
            n += (size_t)snprintf(text + n, size - n, "%s%s", i ? ", " : "", unit);
        }
        snprintf(text + n, size - n, "]");
        break;
    }
    }
}

#endif

/* contention.c - one pattern of messages at every level of the network (contention.h).
 *
 * The levels agree on an empty network. What they make of an exchange among all, and between two
 * halves, shows what a cheaper level would hide. */
#include "app/contention.h"

#include <math.h>

/* The quantity at each level; NAN where a level refuses it (a machine without buffers at flit). */
static bool measure(const struct machine_spec *m, struct contention *row)
{
    bool any = false; /* whether some level can run the pattern */
    for (int i = 0; i < LEVELS; i++) {
        struct machine_spec at = *m;
        struct err why;
        err_clear(&why);
        at.network.level = (enum network_level)i;
        if (!probe_measure(&at, row->quantity, row->ranks, 0, &row->level[i], &why))
            row->level[i] = NAN;
        any = any || isfinite(row->level[i]);
    }
    return any;
}

/* An even number of ranks: halves exchange. A machine of fewer than four has no contention to
 * show. */
int contention_measure(const char *machine, struct contention row[CONTENTION_ROWS], struct arena *a,
                       struct err *e)
{
    static const enum probe_quantity pattern[CONTENTION_ROWS] = {PROBE_EXCHANGE, PROBE_HALVES};
    struct machine_spec m;
    struct plan_options none = {0};
    /* As shipped: --set does not reach here. */
    if (!plan_machine(&m, machine, &none, a, NULL, NULL, e)) return -1;
    int64_t processors = machine_spec_processors(&m);
    int ranks = processors < CONTENTION_RANKS ? (int)processors / 2 * 2 : CONTENTION_RANKS, n = 0;
    for (int i = 0; i < CONTENTION_ROWS && ranks >= 4; i++) {
        row[n] = (struct contention){.quantity = pattern[i], .ranks = ranks};
        /* A pattern that no level can run is left out. */
        n += measure(&m, &row[n]);
    }
    return n;
}

/* Levels side by side, in the order of their cost. */
void contention_print(const struct contention *row, int n)
{
    /* nothing to compare: too few ranks */
    if (n == 0) return;
    printf("\nMB/s that each of %d ranks sends, by level of the network\n%-10s", row[0].ranks, "");
    for (int i = 0; i < LEVELS; i++) printf(" %10s", validation_level_name(i));
    putchar('\n');
    for (int k = 0; k < n; k++) {
        printf("%-10s", probe_name(row[k].quantity));
        for (int i = 0; i < LEVELS; i++) {
            if (isfinite(row[k].level[i])) printf(" %10.5g", row[k].level[i] / 1e6);
            else printf(" %10s", "-");
        }
        putchar('\n');
    }
}

/* The same as a list under the key `contention`. */
void contention_json(const struct contention *row, int n, struct json *j)
{
    json_key(j, "contention");
    json_array(j);
    for (int k = 0; k < n; k++) {
        json_object(j);
        json_key(j, "levels");
        validation_levels_json(row[k].level, 1, j);
        json_key_text(j, "quantity", probe_name(row[k].quantity));
        json_key_int(j, "ranks", row[k].ranks);
        json_key_text(j, "unit", "B/s");
        json_end(j);
    }
    json_end(j);
}

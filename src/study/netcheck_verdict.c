/* netcheck_verdict.c - answers compared with the stated accuracy, case by case and group by
 * group. */
#include "study/netcheck_verdict.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A thousandth of a cycle, as a fraction of the reference, counts as equality. */
static double rounding(const struct netcheck_row *row) { return 1e-3 / fmax(row->high, 1); }

/* Only what has an answer and something to compare it with. */
static bool judged(const struct netcheck_row *row, enum network_level level)
{
    return row->counted && !row->played && row->answer[level].ran;
}

/* The reason of a failure in one form; `why` NULL: nobody asked. Always returns true. */
static bool say(char why[160], const struct netcheck_row *row, const char *what, double found,
                double low, double high)
{
    if (why)
        snprintf(why, 160, "%.80s: %s %+.4g %%, stated are %+.4g to %+.4g %%", row->name, what,
                 100 * found, 100 * low, 100 * high);
    return true;
}

/* The stated accuracy of the row's class has limits for the whole and for the worst message. */
static bool breaks_stated(const struct netcheck_row *row, enum network_level level, char why[160])
{
    const struct netcheck_answer *x = &row->answer[level];
    const struct netcheck_accuracy *s = netcheck_accuracy_of(row, level);
    double slack = rounding(row);
    /* What is no number is within no limits. */
    if (!(x->error >= s->low - slack && x->error <= s->high + slack))
        return say(why, row, "error", x->error, s->low, s->high);
    if (!row->compared) return false;
    /* Where every arrival is stated to be exact, one that differs is enough: no rounding is
     * permitted. */
    if (s->message == 0 && x->differing > 0)
        return say(why, row, "a message's error", x->message_worst, 0, 0);
    return x->message_worst > s->message + slack &&
           say(why, row, "a message's error", x->message_worst, 0, s->message);
}

/* In order of gravity: the reference contradicts itself, a deadlock too many or too few, the
 * error. within < 0: the stated accuracy counts; else this one number does. */
bool netcheck_row_fails(const struct netcheck_row *row, enum network_level level, double within,
                        char why[160])
{
    if (!judged(row, level)) return false;
    if (row->flaw[0]) {
        if (why) snprintf(why, 160, "%.60s: %.90s", row->name, row->flaw);
        return true;
    }
    const struct netcheck_answer *x = &row->answer[level];
    if (x->deadlock != row->expect_deadlock) {
        if (why)
            snprintf(why, 160, "%.80s: %s", row->name, x->deadlock ? "a deadlock" : "no deadlock");
        return true;
    }
    if (row->expect_deadlock) return false;
    if (within < 0) return breaks_stated(row, level, why);
    return !(fabs(x->error) <= within + rounding(row)) &&
           say(why, row, "error", x->error, -within, within);
}

/* The limit of a mean of n cases lies between that of one case and that of many:
 *     limit = m + (w - m) / sqrt(n)
 * with m the mean of the stated means and w that of the stated worst cases: chance averages out
 * as 1 / sqrt(n). */
static void judge_mean(struct netcheck_verdict *v, double mean_limit, double worst, double within)
{
    if (v->cases == 0) return;
    v->mean /= v->cases;
    mean_limit /= v->cases;
    v->mean_limit =
        within >= 0 ? within : mean_limit + (worst / v->cases - mean_limit) / sqrt(v->cases);
    /* The reason of a case that failed is more precise than that of the mean, and stays. */
    if (v->mean <= v->mean_limit + 1e-9 || !v->pass) return;
    v->pass = false;
    snprintf(v->why, sizeof v->why, "mean |error| of %d cases %.4g %%, stated is %.4g %%", v->cases,
             100 * v->mean, 100 * v->mean_limit);
}

struct netcheck_verdict netcheck_verdict(const struct netcheck *n, const char *group,
                                         enum network_level level, double within)
{
    struct netcheck_verdict v = {.pass = true};
    double mean_limit = 0, worst = 0;
    for (int i = 0; i < n->nrow; i++) {
        const struct netcheck_row *row = &n->row[i];
        /* Rows of one group may belong to several classes: the limits are the widest of them. */
        const struct netcheck_accuracy *s = netcheck_accuracy_of(row, level);
        if (!netcheck_in_group(row, group) || !judged(row, level)) continue;
        v.cases++;
        v.low = fmin(v.low, within >= 0 ? -within : s->low);
        v.high = fmax(v.high, within >= 0 ? within : s->high);
        /* sums over the cases; judge_mean divides */
        mean_limit += s->mean;
        worst += fmax(-s->low, s->high);
        v.mean += row->expect_deadlock ? 0 : fabs(row->answer[level].error);
        bool fails = netcheck_row_fails(row, level, within, v.failed ? NULL : v.why);
        v.failed += fails;
        v.pass = v.pass && !fails;
    }
    judge_mean(&v, mean_limit, worst, within);
    return v;
}

/* Whether row i is the first of its group: groups are in the order of the file. */
bool netcheck_opens_group(const struct netcheck *n, int i)
{
    if (!netcheck_in_group(&n->row[i], NULL)) return false;
    for (int j = 0; j < i; j++)
        if (netcheck_in_group(&n->row[j], n->row[i].group)) return false;
    return true;
}

/* A flaw of the file fails it, whatever the levels say. */
bool netcheck_pass(const struct netcheck *n, double within)
{
    for (int i = 0; i < n->nrow; i++) {
        if (n->row[i].flaw[0]) return false;
        for (int l = 0; netcheck_opens_group(n, i) && l < LEVELS; l++)
            if (!netcheck_verdict(n, n->row[i].group, (enum network_level)l, within).pass)
                return false;
    }
    return true;
}

bool netcheck_in_group(const struct netcheck_row *row, const char *group)
{
    return row->counted && (!group || strcmp(row->group, group) == 0);
}

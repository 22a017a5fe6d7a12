/* validation.c - published figures judged (validation.h).
 *
 * What was used in calibration must come out within 5 to 20 %, what was not within 30 %: the
 * first is a test of the program, the second one of the model. */
#include "app/validation.h"

#include <math.h>
#include <string.h>

#include "base/sorted.h"
#include "base/text.h"

/* Cuts and wires follow from the topology by arithmetic: there is little to be wrong. */
static bool is_cut(const struct published *p)
{
    return p->quantity == PROBE_BISECTION || p->quantity == PROBE_GLOBAL ||
           p->quantity == PROBE_WIRE;
}

/* The limit of the error, as the verb's help states it; wider where the source is quoted from
 * memory. */
static double tolerance_of(const struct published *p)
{
    bool recalled = strcmp(p->evidence, "PR") == 0 || strcmp(p->evidence, "E") == 0;
    if (is_cut(p) || (p->quantity == PROBE_READ && !recalled)) return recalled ? 0.2 : 0.05;
    if (p->use == USE_HELD) return VALIDATION_UNEXPLAINED;
    return recalled ? 0.2 : 0.1;
}

/* Whether the error is the one that the row's cause explains: a cause names the error that it
 * stands for, and any other error is a new one. A cause without a number explains nothing that
 * was measured. */
static bool cause_fits(const struct published *p, struct validated *o)
{
    char error[32];
    if (isfinite(p->missed) && fabs((1 + o->error) / (1 + p->missed) - 1) <= o->tolerance)
        return true;
    snprintf(error, sizeof error, "%+.3g %%", 100 * p->missed);
    snprintf(o->why, sizeof o->why, "the cause explains %s, not %+.3g %%",
             isfinite(p->missed) ? error : "no error", 100 * o->error);
    return false;
}

/* The order counts: what was not measured, a cause that does not fit, rows that cannot be
 * tested, then the limit or the published range. */
void validation_judge(const struct published *p, struct validated *o)
{
    o->tolerance = tolerance_of(p);
    o->error = (o->value - p->value) / p->value;
    bool inside = p->low < p->high && o->value >= p->low && o->value <= p->high;
    if (!o->measured) o->verdict = "not-testable"; /* the machine lacks it */
    else if (*p->cause && !cause_fits(p, o)) o->verdict = "fail"; /* not the known error */
    else if (p->use == USE_OTHER) o->verdict = "not-testable"; /* not what is simulated */
    else if (inside || fabs(o->error) <= o->tolerance) o->verdict = "pass";
    else o->verdict = *p->cause ? "explained" : "fail";
}

const char *validation_level_name(int level)
{
    return network_level_name((enum network_level)level);
}

/* Keys in the order of the alphabet; NAN becomes null. */
void validation_levels_json(const double level[LEVELS], double scale, struct json *j)
{
    enum network_level sorted[LEVELS];
    network_levels_by_name(sorted);
    json_object(j);
    for (int i = 0; i < LEVELS; i++) {
        json_key_real(j, network_level_name(sorted[i]), level[sorted[i]] / scale);
    }
    json_end(j);
}

/* Every level, for quantities in which ranks share links. */
static void measure_levels(const struct published *p, const struct machine_spec *m,
                           struct validated *o)
{
    o->contended = true;
    for (int i = 0; i < LEVELS; i++) {
        struct machine_spec at = *m;
        struct err why;
        err_clear(&why);
        at.network.level = (enum network_level)i;
        if (probe_measure(&at, p->quantity, p->at, p->ranks, &o->level[i], &why))
            o->level[i] += p->add;
        else o->level[i] = NAN;
    }
}

/* By rates and by roofline: a machine whose file states no memory has one answer. */
static void measure_models(const struct published *p, const struct machine_spec *m,
                           struct validated *o)
{
    if (!(m->node.level[NODE_MEMORY].bandwidth > 0)) return;
    o->computed = true;
    for (int i = 0; i < NODE_MODELS; i++) {
        struct machine_spec by = *m;
        struct err why;
        err_clear(&why);
        by.node.model = (enum node_model)i;
        if (!probe_measure(&by, p->quantity, p->at, p->ranks, &o->model[i], &why))
            o->model[i] = NAN;
    }
}

/* Measure and judge one row. A machine that lacks the quantity is an outcome; a machine that
 * cannot be read is an error. */
bool validation_measure(const struct published *p, struct validated *o, struct arena *a,
                        struct err *e)
{
    struct machine_spec m;
    /* Rows may change the machine: another library, another number of nodes. */
    struct plan_options options = {.nset = p->nset, .set = p->set};
    *o = (struct validated){.value = NAN};
    if (!plan_machine(&m, p->machine, &options, a, NULL, NULL, e)) return false;
    struct err why;
    err_clear(&why);
    o->measured = probe_measure(&m, p->quantity, p->at, p->ranks, &o->value, &why);
    /* `add`: what the benchmark measures beside the network, such as memories. */
    o->value = o->measured ? o->value + p->add : NAN;
    text_copy(o->why, sizeof o->why, why.text);
    validation_judge(p, o);
    /* Exchanges copy: where that takes the memory's time, they are bound by it, too. */
    const bool copies = m.software.copy_traffic > 0 && p->quantity == PROBE_EXCHANGE;
    if (o->measured && (copies || probe_computes(p->quantity))) measure_models(p, &m, o);
    if (o->measured && probe_contends(p->quantity, p->at, p->ranks)) measure_levels(p, &m, o);
    return true;
}

/* The points of one use; `size` is scratch of n. Estimates (class E) are in no group: they would
 * judge themselves. */
static struct validation_group group(const struct published *const *p, const struct validated *o,
                                     int n, enum published_use use, double *size)
{
    struct validation_group g = {.worst_id = ""};
    for (int i = 0; i < n; i++) {
        double error = fabs(o[i].error);
        if (!o[i].measured || p[i]->use != use || p[i]->evidence[0] == 'E') continue;
        size[g.n++] = error;
        g.mean += error;
        g.above += error > VALIDATION_UNEXPLAINED;
        g.unnamed += error > VALIDATION_UNEXPLAINED && !*p[i]->cause;
        if (*g.worst_id && error <= fabs(g.worst)) continue;
        g.worst = o[i].error;
        g.worst_id = p[i]->id;
    }
    if (g.n == 0) return g;
    g.mean /= g.n;
    sort_numbers(size, (size_t)g.n);
    /* The mean of the two middle ones where their number is even. */
    g.median = (size[(g.n - 1) / 2] + size[g.n / 2]) / 2;
    return g;
}

/* Counts over all rows, then the groups. */
struct validation_summary validation_summarize(const struct published *const *p,
                                               const struct validated *o, int n)
{
    struct validation_summary s = {.shown = n};
    struct arena *a = arena_create();
    double *size = TAKE(a, n + 1, double);
    for (int i = 0; i < n; i++) {
        s.failed += strcmp(o[i].verdict, "fail") == 0;
        s.explained += strcmp(o[i].verdict, "explained") == 0;
        bool untested = strcmp(o[i].verdict, "not-testable") == 0;
        s.untested += untested;
        s.estimated += !untested && p[i]->evidence[0] == 'E';
    }
    s.calibrated = group(p, o, n, USE_CALIBRATED, size);
    s.held = group(p, o, n, USE_HELD, size);
    arena_destroy(a);
    return s;
}

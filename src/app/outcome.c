/* outcome.c - see outcome.h. */
#include "app/outcome.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "plan/condition.h"

/* What is not known compares with nothing, so that a search for the best passes it over. */
const struct outcome outcome_unknown = {
    .makespan_s = NAN, .speedup = NAN, .efficiency = NAN, .messages = NAN, .sent_bytes = NAN};

/* id, makespan, speedup, efficiency, messages, bytes, status */
static bool take_outcome(void *context, int ncolumn, const char *const *name,
                         const char *const *value)
{
    struct outcome *o = context;
    /* numbers first, in the order of the struct */
    double number[6];
    (void)ncolumn, (void)name;
    for (int i = 0; i < 6; i++) number[i] = value[i] != NULL ? strtod(value[i], NULL) : NAN;
    *o = (struct outcome){.ok = strcmp(value[6], "ok") == 0,
                          .makespan_s = number[1] * 1e-12,
                          .speedup = number[2],
                          .efficiency = number[3],
                          .messages = number[4],
                          .sent_bytes = number[5],
                          .id = (int64_t)number[0]};
    return false;
}

bool outcome_read(struct store *s, const struct run_spec *run, struct outcome *o, struct err *e)
{
    /* By its identity: a run that is stored under another name is found as well. */
    char id[24];
    snprintf(id, sizeof id, "%lld", (long long)store_run_id(s, run));
    const char *const bound[] = {id};
    *o = outcome_unknown;
    return store_select(
        s,
        "SELECT r.id, r.makespan_ps, v.speedup, v.efficiency, r.messages, r.sent_bytes, r.status"
        " FROM run r LEFT JOIN v_speedup v ON v.run_id = r.id AND v.baseline = 'fastest serial'"
        " WHERE r.id = ?1",
        1, bound, take_outcome, o, e);
}

/* What a formula may look at: a run and what it came to. */
struct scope {
    struct condition_scope settings;
    const struct outcome *outcome;
};

/* Results first, then settings: no setting has such a name. */
static bool look_up(void *context, const char *name, struct expression_value *v, char *why,
                    int size)
{
    struct scope *s = context;
    const struct outcome *o = s->outcome;
    /* With their units, so that a time is compared with a time. */
    const struct {
        const char *name;
        double value;
        enum unit unit;
    } result[] = {{"makespan", o->makespan_s, UNIT_TIME},
                  {"speedup", o->speedup, UNIT_NONE},
                  {"efficiency", o->efficiency, UNIT_NONE},
                  {"messages", o->messages, UNIT_NONE},
                  {"sent_bytes", o->sent_bytes, UNIT_BYTES}};
    enum { RESULTS = sizeof result / sizeof *result };
    const char *names[RESULTS];
    for (int i = 0; i < RESULTS; i++) {
        names[i] = result[i].name;
        if (strcmp(result[i].name, name) != 0) continue;
        *v = (struct expression_value){.number = result[i].value, .unit = result[i].unit};
        return true;
    }
    if (condition_lookup(&s->settings, name, v, why, size)) return true;
    /* a misspelt result is more likely than a setting that is spelt alike */
    const char *near = text_nearest(name, names, RESULTS);
    if (near != NULL)
        snprintf(why, (size_t)size, "unknown name '%.60s'; did you mean '%s'?", name, near);
    return false;
}

bool outcome_value(const struct expression *x, const struct run_spec *run, const struct outcome *o,
                   const char *asked, const char *file, int line, struct expression_value *v,
                   struct err *e)
{
    char why[256];
    /* Texts of settings are printed for the comparison and thrown away. */
    struct scope s = {{run, arena_create()}, o};
    bool fine = expression_value(x, look_up, &s, v, why, (int)sizeof why);
    arena_destroy(s.settings.arena);
    /* texts were the arena's: a goal and a limit are none */
    if (fine && v->text != NULL) {
        fine = false;
        snprintf(why, sizeof why, "a text, not a number");
    }
    return fine ||
           err_set_at(e, ERR_DATA, file, line, "%s: '%.120s': %s", asked, expression_text(x), why);
}

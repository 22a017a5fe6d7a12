/* measured_run.c - see measured_run.h.
 *
 * Only what a comparison needs is read. How fast the computer was stands in column text as JSON
 * (real_bursts_text); of rows that have something else there nothing is known. */
#include "app/measured_run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"

/* A number as the database gives it: a whole one where it has no fraction, nothing where it was not
 * known when the row was stored. */
static double real_of(const struct store_value *v)
{
    return v->kind == STORE_REAL ? v->real : v->kind == STORE_INT ? (double)v->integer : NAN;
}

/* The columns of the query below, in its order. */
static bool take_run(void *context, int n, const char *const *name, const struct store_value *v)
{
    struct measured_run *m = context;
    (void)n, (void)name;
    m->found = true;
    text_copy(m->id, sizeof m->id, v[0].text);
    text_copy(m->host, sizeof m->host, v[1].text);
    text_copy(m->utc, sizeof m->utc, v[2].text);
    m->real.time.min = real_of(&v[3]);
    m->real.time.median = real_of(&v[4]);
    m->real.nsample = (int)v[5].integer;
    m->real.disturbed = (int)v[6].integer;
    m->real.load.others = real_of(&v[7]);
    m->real.load.before = real_of(&v[8]);
    m->real.oversubscribed = v[9].integer != 0;
    return false; /* the latest alone */
}

/* Stages in the order of the program; more than there can be are of another version and are left
 * out. */
static bool take_stage(void *context, int n, const char *const *name, const struct store_value *v)
{
    struct measured_run *m = context;
    (void)n, (void)name;
    if (m->real.nstage > RUN_MAX_STAGES) return false;
    struct real_stage *s = &m->real.stage[m->real.nstage++];
    text_copy(s->name, sizeof s->name, v[0].text);
    s->median_s = real_of(&v[1]);
    return true;
}

/* --- the condition ---------------------------------------------------------------------------- */

/* One number of one list of the JSON: its name, its place, itself. What is no list of this version
 * is left out. */
static bool take_look(void *context, int n, const char *const *name, const struct store_value *v)
{
    struct real_result *r = context;
    (void)n, (void)name;
    const char *list = v[0].kind == STORE_TEXT ? v[0].text : "";
    const int64_t at = v[1].integer;
    const double x = real_of(&v[2]);
    if (strcmp(list, "bursts") == 0 && at < REAL_BURSTS) {
        r->burst[at].n = x >= 0 && x < 1e6 ? (int)x : 0;
        if (at >= r->nburst) r->nburst = (int)at + 1;
    }
    if (at >= 2 * REAL_BURSTS) return true;
    struct real_burst *b = &r->burst[at / 2];
    for (int o = 0; o < HOST_OPERATIONS; o++)
        if (strcmp(list, host_operation_name((enum host_operation)o)) == 0)
            (at % 2 == 0 ? &b->before : &b->after)->time[o] = isfinite(x) ? x * 1e-9 : 0;
    return true;
}

/* A sample behind those that are there; room grows by doubling. */
static bool take_sample(void *context, int n, const char *const *name, const struct store_value *v)
{
    struct real_result *r = context;
    (void)n, (void)name;
    const int i = r->nsample++;
    if ((i & (i + 1)) == 0)
        r->sample = memory_resize(r->sample, ((size_t)i + 1) * 2, sizeof *r->sample);
    r->sample[i] = (struct real_sample){real_of(&v[0]), v[1].integer != 0};
    return true;
}

/* A row of another version, or one that somebody has changed, has no JSON, or other JSON. */
static bool find_condition(struct store *s, struct measured_run *out, struct err *e)
{
    const char *const by_id[] = {out->id};
    struct real_result *r = memory_zeroed(1, sizeof *r);
    const bool ok =
        store_query(s,
                    "SELECT j.key, l.key, l.value FROM real_run AS r, json_each(CASE WHEN "
                    "json_valid(r.text) THEN r.text ELSE '{}' END) AS j, json_each(CASE j.type "
                    "WHEN 'array' THEN j.value ELSE '[]' END) AS l WHERE r.real_id = ?1",
                    1, by_id, NULL, take_look, r, e) &&
        store_query(s,
                    "SELECT seconds, disturbed FROM real_sample WHERE real_id = ?1 ORDER BY sample",
                    1, by_id, NULL, take_sample, r, e);
    if (ok) out->condition = condition_of(r);
    free(r->sample);
    free(r);
    return ok;
}

/* --- the run ---------------------------------------------------------------------------------- */

/* The table does not mix several computers, and older rows stay where they are for other questions.
 */
bool measured_run_find(struct store *s, const char *task, struct measured_run *out, struct err *e)
{
    const char *const by_task[] = {task};
    memset(out, 0, sizeof *out);
    if (!store_query(
            s,
            "SELECT real_id, host, created_utc, min_s, median_s, samples, disturbed, "
            "load_others, load_before, oversubscribed FROM real_run WHERE task_hash = ?1 "
            "AND status = 'ok' AND median_s > 0 ORDER BY created_utc DESC, real_id LIMIT 1",
            1, by_task, NULL, take_run, out, e))
        return false;
    if (!out->found) return true;
    const char *const by_id[] = {out->id};
    return store_query(s, "SELECT name, median_s FROM real_stage WHERE real_id = ?1 ORDER BY stage",
                       1, by_id, NULL, take_stage, out, e) &&
           find_condition(s, out, e);
}

/* More ranks than processors take turns, which no machine model here describes; too few undisturbed
 * repetitions are no measurement; and a computer that is another one after each burst is no one
 * machine. */
const char *measured_run_left_out(const struct measured_run *m)
{
    if (m->real.oversubscribed) return "more ranks than processors";
    if (m->real.nsample - m->real.disturbed < REAL_LEAST_SAMPLES) return "disturbed";
    if (condition_changed(&m->condition)) return "the computer's speed changed";
    return "";
}

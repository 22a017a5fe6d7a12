/* store_put.c - one finished run becomes rows: run, settings, stages, ranks, baselines, checks, omissions, links,
 * spans.
 *
 * All of them in one transaction. Sums over ranks are made here, so that a run of a million ranks stores as many rows
 * as one of two. */
#include "store/store.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"
#include "spec/field.h"
#include "store/binding.h"
#include "store/build.h"

/* Run a statement that finds one row id; 0 when there is none. */
static bool find_id(struct store *s, struct binding *b, int64_t *id, struct err *e)
{
    int code = sqlite3_step(b->statement);
    bool ok = code == SQLITE_ROW || code == SQLITE_DONE || store_failed(s, e);
    *id = code == SQLITE_ROW ? sqlite3_column_int64(b->statement, 0) : 0;
    sqlite3_reset(b->statement);
    return ok;
}

static bool bind_identity(struct store *s, const struct run_spec *spec, struct binding *b, struct err *e)
{
    if (!bind_start(s, STATEMENT_RUN_FIND, b, e)) return false;
    bind_text(b, spec->config_hash);
    bind_int(b, (int64_t)spec->seed);
    bind_int(b, spec->rep);
    return true;
}

bool store_has(struct store *s, const struct run_spec *spec)
{
    struct err ignored = {0};
    struct binding b;
    if (!bind_identity(s, spec, &b, &ignored)) return false;
    bool has = sqlite3_step(b.statement) == SQLITE_ROW &&
               strcmp((const char *)sqlite3_column_text(b.statement, 1), "ok") == 0;
    sqlite3_reset(b.statement);
    return has;
}

int64_t store_run_id(struct store *s, const struct run_spec *spec)
{
    struct err ignored = {0};
    struct binding b;
    int64_t id = 0;
    if (bind_identity(s, spec, &b, &ignored)) find_id(s, &b, &id, &ignored);
    return id;
}

/* The word of the choice field that lies `offset` bytes into the struct of table `prefix`. */
static const char *choice_word(const char *prefix, size_t offset, unsigned value)
{
    int ntable;
    const struct field_table *const *table = field_tables(&ntable);
    for (int t = 0; t < ntable; t++) {
        if (strcmp(table[t]->prefix, prefix) != 0) continue;
        for (int i = 0; i < table[t]->nfield; i++)
            if (table[t]->field[i].offset == offset && table[t]->field[i].kind == FIELD_CHOICE)
                return table[t]->field[i].choice[value];
    }
    return "";
}

#define MACHINE_WORD(spec, member)                                                                                     \
    choice_word("machine", offsetof(struct machine_spec, member), (unsigned)(spec)->machine.member)
#define MODEL_WORD(spec, member)                                                                                       \
    choice_word("model", offsetof(struct model_spec, member), (unsigned)(spec)->model.member)
#define KERNEL_WORD(spec, member)                                                                                      \
    choice_word("kernel", offsetof(struct kernel_spec, member), (unsigned)(spec)->kernel.member)

/* The row of this program in table build. */
static bool find_build(struct store *s, struct err *e)
{
    if (s->build_id != 0) return true;
    struct build build = store_build();
    for (int add = 1; add >= 0; add--) {
        struct binding b;
        if (!bind_start(s, add ? STATEMENT_BUILD_ADD : STATEMENT_BUILD_FIND, &b, e)) return false;
        bind_text(&b, build.version);
        bind_text(&b, build.git);
        bind_text(&b, build.compiler);
        bind_text(&b, build.flags);
        if (add ? !store_step(s, b.statement, e) : !find_id(s, &b, &s->build_id, e)) return false;
    }
    return true;
}

static int64_t stage_total(const struct stage_time *t)
{
    return t->compute_ps + t->send_ps + t->recv_ps + t->wait_ps + t->contention_ps;
}

/* What is known of all ranks together. */
struct rank_summary {
    int64_t accounting_error;
    int64_t compute_min, compute_max;
    int64_t finish_min, finish_max;
};

static struct rank_summary summarise_ranks(const struct run_result *r)
{
    struct rank_summary u = {.compute_min = INT64_MAX, .finish_min = INT64_MAX};
    for (int k = 0; k < r->nrank && r->stage != NULL; k++) {
        int64_t sum = 0, compute = 0;
        for (int i = 0; i < r->nstage; i++) {
            const struct stage_time *t = &r->stage[(int64_t)k * r->nstage + i];
            sum += stage_total(t);
            compute += t->compute_ps;
        }
        int64_t error = llabs(sum - r->makespan_ps);
        if (error > u.accounting_error) u.accounting_error = error;
        if (compute < u.compute_min) u.compute_min = compute;
        if (compute > u.compute_max) u.compute_max = compute;
    }
    for (int k = 0; k < r->nrank && r->finish_ps != NULL; k++) {
        if (r->finish_ps[k] < u.finish_min) u.finish_min = r->finish_ps[k];
        if (r->finish_ps[k] > u.finish_max) u.finish_max = r->finish_ps[k];
    }
    return u;
}

static void bind_spec(struct binding *b, const struct run_spec *spec, const struct run_result *r)
{
    bind_text(b, spec->config_hash);
    bind_int(b, (int64_t)spec->seed);
    bind_int(b, spec->rep);
    bind_text(b, spec->scenario);
    bind_text(b, spec->machine.name);
    bind_text(b, MACHINE_WORD(spec, topology.family));
    bind_text(b, MACHINE_WORD(spec, network.level));
    bind_text(b, MACHINE_WORD(spec, placement.kind));
    bind_text(b, spec->kernel.name);
    bind_text(b, KERNEL_WORD(spec, formulation));
    bind_text(b, KERNEL_WORD(spec, solver));
    bind_text(b, KERNEL_WORD(spec, part_solver));
    bind_text(b, KERNEL_WORD(spec, operators));
    bind_text(b, KERNEL_WORD(spec, precision));
    bind_text(b, MODEL_WORD(spec, generator));
    bind_text(b, MODEL_WORD(spec, base));
    bind_text(b, MODEL_WORD(spec, joint));
    bind_int(b, r->nbody > 0 ? r->nbody : spec->model.nbody);
    bind_int(b, r->nu);
    bind_int(b, spec->nrank);
    bind_real(b, spec->machine.noise.compute_cv);
    bind_real(b, spec->machine.noise.background_load);
}

static void bind_result(struct binding *b, const struct run_result *r, char digest[17])
{
    static const char *const status[] = {"ok", "invalid", "deadlock", "failed"};
    struct rank_summary u = summarise_ranks(r);
    bool has_stages = r->stage != NULL && r->nrank > 0, has_finish = r->finish_ps != NULL && r->nrank > 0;
    snprintf(digest, 17, "%016llx", (unsigned long long)r->digest);
    bind_text(b, status[r->status]);
    bind_text(b, r->text);
    bind_int(b, r->makespan_ps);
    bind_real(b, r->measured_s);
    bind_int_if(b, r->loop_rows > 0, r->loop_rows);
    bind_int_if(b, r->loop_rows > 0 && r->loop_rank >= 0, r->loop_rank);
    bind_real(b, r->loop_rows > 0 ? r->drift_position : NAN);
    bind_real(b, r->loop_rows > 0 ? r->drift_velocity : NAN);
    bind_real(b, r->residual);
    bind_real(b, r->condition > 0 ? r->condition : NAN);
    bind_int(b, r->messages);
    bind_int(b, r->bytes);
    bind_int(b, r->events);
    bind_int(b, r->ties);
    bind_int(b, r->switches);
    bind_text(b, digest);
    bind_int(b, u.accounting_error);
    bind_int_if(b, has_finish, u.finish_min);
    bind_int_if(b, has_finish, u.finish_max);
    bind_int_if(b, has_stages, u.compute_min);
    bind_int_if(b, has_stages, u.compute_max);
    bind_int(b, r->nlink);
    bind_real(b, r->host_s);
    bind_real(b, r->host_total_s);
    bind_int(b, r->host_peak_bytes);
    bind_int(b, r->stack_peak_bytes);
}

static void bind_level_choice(struct binding *b, const struct run_spec *spec, char asked[64])
{
    const struct level_choice *c = &spec->level_choice;
    snprintf(asked, 64, "auto-tolerance %.9g %%", 100 * spec->machine.network.tolerance);
    bind_text(b, c->made ? asked : NULL);
    bind_real(b, c->made ? c->error : NAN);
    bind_text(b, c->made ? c->at : NULL);
}

/* The omissions as one text. */
static void join_omissions(const struct run_result *r, struct text *out)
{
    text_add(out, "%s", "");
    for (int i = 0; i < r->nomission; i++)
        text_add(out, "%s%s: %s", i > 0 ? "; " : "", r->omission[i].what, r->omission[i].why);
}

static bool put_run(struct store *s, const struct run_spec *spec, const struct run_result *r, int64_t *id,
                    struct err *e)
{
    struct binding b;
    char digest[17], asked[64];
    struct text left_out = {0};
    if (!bind_start(s, STATEMENT_RUN_INSERT, &b, e)) return false;
    join_omissions(r, &left_out);
    bind_spec(&b, spec, r);
    bind_result(&b, r, digest);
    bind_level_choice(&b, spec, asked);
    bind_int(&b, r->inner_added);
    bind_int(&b, r->outer_added);
    bind_int(&b, r->twice_added);
    bind_real(&b, run_result_refined(r) ? r->residual_before : NAN);
    bind_text(&b, left_out.s);
    bind_text(&b, spec->config_text ? spec->config_text : "");
    bind_text(&b, spec->machine_changes);
    bind_text(&b, spec->machine_changes ? spec->machine_hash : NULL);
    bind_int(&b, s->build_id);
    const bool ok = store_step(s, b.statement, e);
    text_free(&left_out);
    if (ok) *id = sqlite3_last_insert_rowid(s->db);
    return ok;
}

/* The row of a setting, made when it is new. */
static bool setting_id(struct store *s, const char *key, int nkey, const char *value, int nvalue, int64_t *id,
                       struct err *e)
{
    for (int add = 0; add < 2; add++) {
        struct binding b;
        if (!bind_start(s, add ? STATEMENT_SETTING_ADD : STATEMENT_SETTING_FIND, &b, e)) return false;
        sqlite3_bind_text(b.statement, 1, key, nkey, SQLITE_STATIC);
        sqlite3_bind_text(b.statement, 2, value, nvalue, SQLITE_STATIC);
        if (!add && !find_id(s, &b, id, e)) return false;
        if (!add && *id != 0) return true;
        if (add && !store_step(s, b.statement, e)) return false;
    }
    *id = sqlite3_last_insert_rowid(s->db);
    return true;
}

/* The "key = value" lines of the canonical configuration. */
static bool put_settings(struct store *s, int64_t run, const char *config, struct err *e)
{
    if (s->passing) return true;
    for (const char *line = config; line != NULL && *line;) {
        const char *end = strchrnul(line, '\n'), *equals = memmem(line, (size_t)(end - line), " = ", 3);
        if (equals != NULL) {
            int64_t setting;
            struct binding b;
            if (!setting_id(s, line, (int)(equals - line), equals + 3, (int)(end - equals - 3), &setting, e) ||
                !bind_start(s, STATEMENT_RUN_SETTING, &b, e))
                return false;
            bind_int(&b, run);
            bind_int(&b, setting);
            if (!store_step(s, b.statement, e)) return false;
        }
        line = *end ? end + 1 : end;
    }
    return true;
}

/* Sum, least and most of one quantity over the ranks. */
struct spread {
    int64_t sum, min, max;
    bool fits;              /* the sum fits into 64 bits */
};

static void spread_add(struct spread *p, int64_t v)
{
    if (__builtin_add_overflow(p->sum, v, &p->sum)) p->fits = false;
    if (v < p->min) p->min = v;
    if (v > p->max) p->max = v;
}

static bool put_stage(struct store *s, int64_t run, const struct run_result *r, int stage, struct err *e)
{
    enum { COMPUTE, SEND, RECV, WAIT, CONTENTION, TOTAL, PARTS };
    struct spread part[PARTS];
    struct stage_time all = {0};
    for (int i = 0; i < PARTS; i++) part[i] = (struct spread){0, INT64_MAX, INT64_MIN, true};
    for (int k = 0; k < r->nrank; k++) {
        const struct stage_time *t = &r->stage[(int64_t)k * r->nstage + stage];
        const int64_t value[PARTS] = {t->compute_ps, t->send_ps,       t->recv_ps,
                                      t->wait_ps,    t->contention_ps, stage_total(t)};
        for (int i = 0; i < PARTS; i++) spread_add(&part[i], value[i]);
        all.messages += t->messages;
        all.bytes += t->bytes;
        work_add(&all.work, &t->work);
    }
    struct binding b;
    if (!bind_start(s, STATEMENT_STAGE, &b, e)) return false;
    bind_int(&b, run);
    bind_int(&b, stage);
    bind_text(&b, r->stage_name[stage]);
    for (int i = 0; i < PARTS; i++) {
        bind_int_if(&b, part[i].fits, part[i].sum);
        bind_int(&b, part[i].min);
        bind_int(&b, part[i].max);
    }
    bind_int(&b, all.messages);
    bind_int(&b, all.bytes);
    bind_count(&b, all.work.flop);
    bind_count(&b, all.work.div);
    bind_count(&b, all.work.sqrt);
    bind_count(&b, all.work.trig);
    bind_count(&b, all.work.bytes);
    bind_count(&b, all.work.call);
    return store_step(s, b.statement, e);
}

static bool put_rank_stage(struct store *s, int64_t run, int rank, int stage, const struct stage_time *t, struct err *e)
{
    struct binding b;
    if (stage_total(t) == 0 && t->messages == 0 && t->work.flop == 0) return true;
    if (!bind_start(s, STATEMENT_RANK_STAGE, &b, e)) return false;
    bind_int(&b, run);
    bind_int(&b, rank);
    bind_int(&b, stage);
    bind_int(&b, t->compute_ps);
    bind_int(&b, t->send_ps);
    bind_int(&b, t->recv_ps);
    bind_int(&b, t->wait_ps);
    bind_int(&b, t->contention_ps);
    bind_int(&b, t->messages);
    bind_int(&b, t->bytes);
    bind_count(&b, t->work.flop);
    return store_step(s, b.statement, e);
}

static bool put_stages(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    if (r->stage == NULL || r->nrank == 0) return true;
    for (int i = 0; i < r->nstage; i++)
        if (!put_stage(s, run, r, i, e)) return false;
    if (s->passing || r->nrank > STORE_RANK_ROWS) return true;
    for (int k = 0; k < r->nrank; k++)
        for (int i = 0; i < r->nstage; i++)
            if (!put_rank_stage(s, run, k, i, &r->stage[(int64_t)k * r->nstage + i], e)) return false;
    return true;
}

static bool put_baselines(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    for (int i = 0; i < r->nbaseline; i++) {
        const struct baseline *line = &r->baseline[i];
        struct binding b;
        if (!bind_start(s, STATEMENT_BASELINE, &b, e)) return false;
        bind_int(&b, run);
        bind_int(&b, i);
        bind_text(&b, line->name);
        bind_int(&b, line->time_ps);
        bind_count(&b, line->work.flop);
        bind_count(&b, line->work.div);
        bind_count(&b, line->work.sqrt);
        bind_count(&b, line->work.trig);
        bind_count(&b, line->work.bytes);
        bind_count(&b, line->work.call);
        if (!store_step(s, b.statement, e)) return false;
    }
    return true;
}

static bool put_errors(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    for (int i = 0; i < r->nerror; i++) {
        const struct error_check *check = &r->error[i];
        struct binding b;
        if (!bind_start(s, STATEMENT_ERROR_CHECK, &b, e)) return false;
        bind_int(&b, run);
        bind_int(&b, i);
        bind_text(&b, check->quantity);
        bind_text(&b, check->reference);
        bind_real(&b, check->relative);
        bind_real(&b, check->tolerance);
        bind_int(&b, check->relative <= check->tolerance); /* a NaN has not passed */
        if (!store_step(s, b.statement, e)) return false;
    }
    return true;
}

static bool put_omissions(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    for (int i = 0; i < r->nomission; i++) {
        const struct omission *o = &r->omission[i];
        struct binding b;
        if (!bind_start(s, STATEMENT_OMISSION, &b, e)) return false;
        bind_int(&b, run);
        bind_text(&b, o->what);
        bind_text(&b, o->why);
        bind_text(&b, o->bound > 0 ? "bounded" : "exact");
        bind_real(&b, o->bound > 0 ? o->bound : NAN);
        if (!store_step(s, b.statement, e)) return false;
    }
    return true;
}

/* Busiest first: longest queues, then longest use, then place. */
static int compare_load(const void *a, const void *b)
{
    const struct link_load *x = *(const struct link_load *const *)a, *y = *(const struct link_load *const *)b;
    if (x->queue_ps != y->queue_ps) return x->queue_ps > y->queue_ps ? -1 : 1;
    if (x->busy_ps != y->busy_ps) return x->busy_ps > y->busy_ps ? -1 : 1;
    return x < y ? -1 : x > y;
}

static bool put_link(struct store *s, int64_t run, const struct run_result *r, const struct link_load *l, struct err *e)
{
    struct binding b;
    if (!bind_start(s, STATEMENT_LINK_LOAD, &b, e)) return false;
    bind_int(&b, run);
    bind_int(&b, l - r->link);
    bind_int_if(&b, l->from >= 0, l->from);
    bind_int_if(&b, l->to >= 0, l->to);
    bind_int_if(&b, l->node >= 0, l->node);
    bind_int(&b, l->messages);
    bind_int(&b, l->bytes);
    bind_int(&b, l->busy_ps);
    bind_int(&b, l->queue_ps);
    return store_step(s, b.statement, e);
}

static bool put_links(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    if (r->nlink == 0 || r->link == NULL) return true;
    const struct link_load **order = malloc((size_t)r->nlink * sizeof *order);
    CHECK(order != NULL);
    for (int i = 0; i < r->nlink; i++) order[i] = &r->link[i];
    if (r->nlink > STORE_LINK_ROWS) qsort(order, (size_t)r->nlink, sizeof *order, compare_load);
    bool ok = true;
    for (int i = 0; i < r->nlink && i < STORE_LINK_ROWS && ok; i++) ok = put_link(s, run, r, order[i], e);
    free(order);
    return ok;
}

static bool put_spans(struct store *s, int64_t run, const struct run_result *r, struct err *e)
{
    static const char *const kind[] = {"compute", "send", "recv", "wait", "barrier"};
    if (r->span == NULL || r->nspan > STORE_SPAN_ROWS) return true;
    for (int64_t i = 0; i < r->nspan; i++) {
        const struct span *p = &r->span[i];
        struct binding b;
        if (!bind_start(s, STATEMENT_SPAN, &b, e)) return false;
        bind_int(&b, run);
        bind_int(&b, i);
        bind_int(&b, p->rank);
        bind_int(&b, p->stage);
        bind_text(&b, kind[p->kind]);
        bind_int(&b, p->begin_ps);
        bind_int(&b, p->end_ps);
        bind_int_if(&b, p->peer >= 0, p->peer);
        bind_int(&b, p->bytes);
        bind_int_if(&b, p->message >= 0, p->message);
        if (!store_step(s, b.statement, e)) return false;
    }
    return true;
}

/* An older row of the same identity goes, with everything that belongs to it. */
static bool remove_old(struct store *s, const struct run_spec *spec, struct err *e)
{
    struct binding b;
    int64_t old;
    if (!bind_identity(s, spec, &b, e) || !find_id(s, &b, &old, e)) return false;
    if (old == 0) return true;
    if (!bind_start(s, STATEMENT_RUN_DELETE, &b, e)) return false;
    bind_int(&b, old);
    return store_step(s, b.statement, e);
}

bool store_note_build(struct store *s, struct err *e) { return find_build(s, e); }

bool store_put(struct store *s, const struct run_spec *spec, const struct run_result *r, struct err *e)
{
    bool alone = !s->in_transaction;
    int64_t run = 0;
    CHECK(s->writable);
    if (alone && !store_begin(s, e)) return false;
    bool ok = find_build(s, e) && remove_old(s, spec, e) && put_run(s, spec, r, &run, e) &&
              put_settings(s, run, spec->config_text, e) && put_stages(s, run, r, e) && put_baselines(s, run, r, e) &&
              put_errors(s, run, r, e) && put_omissions(s, run, r, e) && put_links(s, run, r, e) &&
              put_spans(s, run, r, e);
    if (!alone) return ok;
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}

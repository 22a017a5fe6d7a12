/* test_schedule_random.c - schedules drawn at random: written as text in many ways and in binary
 * form, both read back to what was drawn; circles found as by trying; times of computations as by
 * the longest path. */
#include "../vp/timed_world.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "base/text.h"
#include "schedule/schedule_run.h"

enum { RANKS = 5, OPS = 12, EDGES = 3 * OPS };

struct drawn {
    int nrank, nop[RANKS], nedge[RANKS];
    struct schedule_op op[RANKS][OPS];
    struct {
        int op, on;
        bool start;
    } edge[RANKS][EDGES];
};

/* Below `most`, its ends more often than others. */
static int64_t number(struct random *r, uint64_t most)
{
    const uint64_t way = random_below(r, 8);
    return (int64_t)(way == 0 ? 0 : way == 1 ? most - 1 : random_below(r, most));
}

static void draw(struct drawn *d, struct random *r, bool circles)
{
    *d = (struct drawn){.nrank = 1 + (int)random_below(r, RANKS)};
    for (int i = 0; i < d->nrank; i++) {
        d->nop[i] = (int)random_below(r, OPS + 1);
        for (int k = 0; k < d->nop[i]; k++) {
            struct schedule_op *o = &d->op[i][k];
            o->kind = (uint8_t)(SCHEDULE_SEND + (int)random_below(r, 3));
            o->cpu = (uint8_t)number(r, 256);
            o->size = number(r, o->kind == SCHEDULE_COMPUTE ? (uint64_t)1 << 40
                                                            : ((uint64_t)1 << 50) + 1);
            if (o->kind == SCHEDULE_COMPUTE) continue;
            o->peer = (int32_t)random_below(r, (uint64_t)d->nrank);
            o->tag = number(r, UINT32_MAX);
            if (o->kind == SCHEDULE_RECEIVE && random_below(r, 4) == 0) o->peer = SCHEDULE_ANY;
            if (o->kind == SCHEDULE_RECEIVE && random_below(r, 4) == 0) o->tag = SCHEDULE_ANY;
        }
        for (int k = 0; k < EDGES && d->nop[i] > 1; k++) {
            int op = (int)random_below(r, (uint64_t)d->nop[i]),
                on = (int)random_below(r, (uint64_t)d->nop[i]);
            if (!circles && op == on) continue;
            if (!circles && op < on) {
                const int kept = op;
                op = on, on = kept;
            }
            if (random_below(r, 3) && !circles) continue;
            if (circles && k > 4) break;
            d->edge[i][d->nedge[i]].op = op;
            d->edge[i][d->nedge[i]].on = on;
            d->edge[i][d->nedge[i]++].start = random_below(r, 2);
            d->op[i][op].needs++;
        }
    }
}

/* --- as text --- */

/* Something that means nothing: blanks, remarks; line ends where `lines`. */
static void noise(struct text *t, struct random *r, bool lines)
{
    static const char *const some[] = {" ",    "\t",     " /* a\n remark */ ", "  ", "\n",
                                       "\r\n", " // {\n"};
    text_add(t, "%s", some[random_below(r, lines ? 7 : 4)]);
}

static void write_op(struct text *t, struct random *r, const struct schedule_op *o)
{
    if (o->kind == SCHEDULE_COMPUTE) {
        text_add(t, "calc %lld", (long long)o->size);
    } else {
        const bool send = o->kind == SCHEDULE_SEND;
        text_add(t, "%s %lld", send ? "send" : "recv", (long long)o->size);
        if (random_below(r, 2)) noise(t, r, false);
        text_add(t, "b %s %d", send ? "to" : "from", (int)o->peer);
        if (o->tag || random_below(r, 2)) text_add(t, " tag %lld", (long long)o->tag);
    }
    if (o->cpu || random_below(r, 2)) noise(t, r, false), text_add(t, "cpu %d", o->cpu);
    if (o->kind != SCHEDULE_COMPUTE && random_below(r, 2))
        text_add(t, " nic %d", (int)random_below(r, 256));
}

static char *as_text(const struct drawn *d, struct random *r, struct arena *a)
{
    struct text t = {0};
    int order[RANKS];
    for (int i = 0; i < d->nrank; i++) order[i] = i;
    for (int i = d->nrank - 1; i > 0; i--) {
        const int k = (int)random_below(r, (uint64_t)i + 1), kept = order[i];
        order[i] = order[k], order[k] = kept;
    }
    noise(&t, r, true);
    text_add(&t, "num_ranks %d\n", d->nrank);
    for (int x = 0; x < d->nrank; x++) {
        const int i = order[x];
        noise(&t, r, true);
        text_add(&t, "rank %d {\n", i);
        for (int k = 0; k < d->nop[i]; k++) {
            text_add(&t, "op_%d:", k);
            noise(&t, r, false);
            write_op(&t, r, &d->op[i][k]);
            text_add(&t, "\n");
            if (random_below(r, 3) == 0) noise(&t, r, true);
        }
        for (int k = 0; k < d->nedge[i]; k++)
            text_add(&t, "op_%d %s op_%d\n", d->edge[i][k].op,
                     d->edge[i][k].start ? "irequires" : "requires", d->edge[i][k].on);
        text_add(&t, "}\n");
    }
    char *s = arena_text(a, t.s);
    text_free(&t);
    return s;
}

/* --- in binary form, by its description in goal_binary.c and LogGOPSim --- */

static void put(struct text *t, uint64_t x, int bytes)
{
    for (int i = 0; i < bytes; i++) text_add_bytes(t, &(char){(char)(x >> 8 * i)}, 1);
}

/* One rank's part: those without requirements, the operations, and the list of who waits. */
static void write_part(struct text *t, const struct drawn *d, int i)
{
    struct text list = {0};
    int roots = 0;
    for (int k = 0; k < d->nop[i]; k++) roots += d->op[i][k].needs == 0;
    put(t, (uint64_t)d->nop[i], 4), put(t, (uint64_t)roots, 4);
    for (int k = 0; k < d->nop[i]; k++)
        if (d->op[i][k].needs == 0) put(t, (uint64_t)k, 4);
    for (int k = 0; k < d->nop[i]; k++) {
        const struct schedule_op *o = &d->op[i][k];
        put(t, (uint64_t)o->needs, 4);
        put(t, o->kind == SCHEDULE_SEND ? 1 : o->kind == SCHEDULE_RECEIVE ? 2 : 3, 1);
        put(t, (uint32_t)o->peer, 4), put(t, (uint64_t)o->size, 8), put(t, (uint32_t)o->tag, 4);
        put(t, o->cpu, 1), put(t, 9, 1);
        for (int start = 0; start < 2; start++) {
            const size_t from = list.length / 4;
            for (int e = 0; e < d->nedge[i]; e++)
                if (d->edge[i][e].on == k && d->edge[i][e].start == start)
                    put(&list, (uint64_t)d->edge[i][e].op, 4);
            put(t, list.length / 4 - from, 4), put(t, from, 4);
        }
    }
    if (list.length) text_add_bytes(t, list.s, list.length);
    text_free(&list);
}

static void as_binary(const struct drawn *d, struct text *t)
{
    struct text parts = {0};
    put(t, 4223, 8), put(t, (uint64_t)d->nrank, 4), put(t, 255, 1), put(t, 255, 1);
    for (int i = 0; i < d->nrank; i++) {
        const uint64_t head = 6 + 16 * (uint64_t)d->nrank;
        put(t, head + parts.length, 8);
        write_part(&parts, d, i);
        put(t, head + parts.length, 8);
    }
    text_add_bytes(t, parts.s, parts.length);
    text_free(&parts);
}

/* --- both against what was drawn --- */

static void expect_drawn(const struct schedule *s, const struct drawn *d)
{
    int64_t n = 0, edges = 0;
    int most = 0;
    assert_int_equal(s->nrank, d->nrank);
    for (int i = 0; i < d->nrank; i++) {
        assert_int_equal(s->first[i], n);
        for (int k = 0; k < d->nop[i]; k++, n++) {
            const struct schedule_op *o = &d->op[i][k], *x = &s->op[n];
            assert_true(x->kind == o->kind && x->size == o->size && x->cpu == o->cpu);
            assert_int_equal(x->needs, o->needs);
            if (o->kind != SCHEDULE_COMPUTE) assert_true(x->peer == o->peer && x->tag == o->tag);
            if (o->cpu > most) most = o->cpu;
            /* who waits for it, as often as it was said */
            for (int op = 0; op < d->nop[i]; op++)
                for (int start = 0; start < 2; start++) {
                    int said = 0, found = 0;
                    for (int e = 0; e < d->nedge[i]; e++)
                        said += d->edge[i][e].on == k && d->edge[i][e].op == op &&
                                d->edge[i][e].start == start;
                    for (int64_t e = s->edge_first[n]; e < s->edge_first[n + 1]; e++)
                        found += s->edge[e] == (uint32_t)(2 * op + start);
                    assert_int_equal(found, said);
                }
        }
        edges += d->nedge[i];
    }
    assert_int_equal(s->first[d->nrank], n);
    assert_true(s->nop == n && s->nedge == edges && s->ncpu == most + 1);
}

static void what_is_written_is_read(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 400; seed++) {
        struct random r = random_make(seed, 121, 0);
        struct arena *a = arena_create();
        struct text bytes = {0};
        struct drawn d;
        struct err e;
        draw(&d, &r, false);
        const char *text = as_text(&d, &r, a);
        err_clear(&e);
        const struct schedule *s = goal_read_text(text, strlen(text), "x.goal", a, &e);
        if (!s) fail_msg("%s\n%d: %s", text, e.line, e.text);
        assert_false(goal_is_binary(text, strlen(text)));
        expect_drawn(s, &d);
        as_binary(&d, &bytes);
        assert_true(goal_is_binary(bytes.s, bytes.length));
        s = goal_read_binary(bytes.s, bytes.length, "x.goal", a, &e);
        if (!s) fail_msg("%s", e.text);
        expect_drawn(s, &d);
        text_free(&bytes);
        arena_destroy(a);
    }
}

/* Operations are taken away while one is left that waits for none of the rest. */
static int left_over(const struct drawn *d, int *rank, int *first)
{
    int left = 0;
    *rank = -1;
    for (int i = 0; i < d->nrank; i++) {
        bool done[OPS] = {false}, more = true;
        while (more) {
            more = false;
            for (int k = 0; k < d->nop[i]; k++) {
                bool waits = done[k];
                for (int e = 0; e < d->nedge[i]; e++)
                    waits |= d->edge[i][e].op == k && !done[d->edge[i][e].on];
                if (!waits) done[k] = more = true;
            }
        }
        for (int k = 0; k < d->nop[i]; k++) {
            left += !done[k];
            if (!done[k] && *rank < 0) *rank = i, *first = k;
        }
    }
    return left;
}

static void circles_are_found(void **state)
{
    int with = 0;
    (void)state;
    for (uint64_t seed = 0; seed < 300; seed++) {
        struct random r = random_make(seed, 122, 0);
        struct arena *a = arena_create();
        struct drawn d;
        struct err e;
        int rank, first = 0;
        char said[200];
        draw(&d, &r, true);
        const char *text = as_text(&d, &r, a);
        err_clear(&e);
        const struct schedule *s = goal_read_text(text, strlen(text), "x.goal", a, &e);
        const int left = left_over(&d, &rank, &first);
        assert_true((s == NULL) == (left > 0));
        snprintf(said, sizeof said,
                 "%d operations of the schedule wait for each other in circles; the first of them "
                 "is number %d of rank %d",
                 left, first, rank);
        if (left > 0) assert_string_equal(e.text, said), with++;
        else expect_drawn(s, &d);
        arena_destroy(a);
    }
    assert_true(with > 50 && with < 290);
}

/* --- times --- */

static void rank_main(struct comm *c, void *context)
{
    struct schedule_job *job = context;
    schedule_rank(c, job, arena_take(job->arena, schedule_workspace(job, comm_rank(c))));
}

/* Every computation has a processor of its own: it starts when what it requires has ended, or
 * started. */
static void computations_end_by_the_longest_path(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 60; seed++) {
        struct random r = random_make(seed, 123, 0);
        struct arena *a = arena_create();
        struct drawn d;
        struct err e;
        int64_t finish[RANKS] = {0};
        draw(&d, &r, false);
        for (int i = 0; i < d.nrank; i++) {
            int64_t begin[OPS] = {0};
            for (int k = 0; k < d.nop[i]; k++) {
                d.op[i][k] = (struct schedule_op){.kind = SCHEDULE_COMPUTE,
                                                  .cpu = (uint8_t)k,
                                                  .size = 1 + (int64_t)random_below(&r, 1000)};
                for (int x = 0; x < d.nedge[i]; x++) {
                    const int on = d.edge[i][x].on;
                    const int64_t at = begin[on] + (d.edge[i][x].start ? 0 : d.op[i][on].size);
                    if (d.edge[i][x].op == k && at > begin[k]) begin[k] = at;
                }
                if (begin[k] + d.op[i][k].size > finish[i]) finish[i] = begin[k] + d.op[i][k].size;
            }
        }
        const char *text = as_text(&d, &r, a);
        err_clear(&e);
        struct schedule_job job = {.schedule = goal_read_text(text, strlen(text), "x", a, &e),
                                   .path = "x",
                                   .unit_ps = 1000,
                                   .arena = a};
        assert_non_null(job.schedule);
        struct machine_spec m = crossbar(d.nrank);
        struct outcome o = go(&m, d.nrank, rank_main, &job);
        expect_ok(&o);
        for (int i = 0; i < d.nrank; i++) assert_int_equal(o.r.finish_ps[i], 1000 * finish[i]);
        arena_destroy(o.arena);
        arena_destroy(a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read),
        cmocka_unit_test(circles_are_found),
        cmocka_unit_test(computations_end_by_the_longest_path),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

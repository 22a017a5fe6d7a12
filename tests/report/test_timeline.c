/* test_timeline.c - spans drawn at random against models of what each format promises: which are
 * picked, which are the two ends of a message, which letter stands in a bar. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/random.h"
#include "report/timeline.h"
#include "report/trace.h"

enum { MOST = 400, STAGES = 3 };

/* A run of random spans, which follow each other on each rank with gaps here and there. */
struct drawn {
    struct run_result r;
    struct span span[MOST];
    struct err e;
};

static void draw(struct drawn *d, struct random *x, int nrank, int each)
{
    *d = (struct drawn){.r = {.nrank = nrank, .nstage = STAGES, .span = d->span}};
    for (int i = 0; i < STAGES; i++) snprintf(d->r.stage_name[i], 24, "stage %d", i);
    for (int k = 0; k < nrank; k++) {
        int64_t now = (int64_t)random_below(x, 50);
        for (int i = 0; i < each; i++) {
            struct span *p = &d->span[d->r.nspan++];
            /* some of no length */
            const int64_t length = (int64_t)random_below(x, 4) * (int64_t)random_below(x, 300);
            *p = (struct span){.rank = k,
                               .stage = (int)random_below(x, STAGES + 1) - 1,
                               .kind = (enum span_kind)random_below(x, 5),
                               .begin_ps = now,
                               .end_ps = now + length,
                               .peer = -1,
                               .message = -1};
            now += length + (random_below(x, 3) == 0 ? (int64_t)random_below(x, 90) : 0);
        }
        if (now > d->r.makespan_ps) d->r.makespan_ps = now;
    }
    /* in any order, as the simulator records them */
    for (int64_t i = d->r.nspan - 1; i > 0; i--) {
        const int64_t k = (int64_t)random_below(x, (uint64_t)(i + 1));
        const struct span s = d->span[i];
        d->span[i] = d->span[k];
        d->span[k] = s;
    }
}

/* Messages between spans of kinds send and receive; some have one end alone. */
static void pair_up(struct drawn *d, struct random *x)
{
    int64_t number = 0, send = -1;
    for (int64_t i = 0; i < d->r.nspan; i++) {
        struct span *p = &d->span[i];
        if (p->kind == SPAN_SEND) {
            p->message = number++;
            send = i;
        }
        if (p->kind != SPAN_RECV) continue;
        if (send >= 0 && random_below(x, 4) > 0) p->message = d->span[send].message;
        else p->message = random_below(x, 2) ? number++ : -1;
        send = -1;
    }
}

static char *written(struct drawn *d, enum trace_format format, const struct trace_options *o,
                     int64_t *left_out)
{
    char *s = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&s, &size);
    const bool ok = trace_write(&d->r, format, o, out, left_out, &d->e);
    fclose(out);
    if (ok) return s;
    free(s);
    return NULL;
}

/* ---- what is picked ---- */

static bool reaches(const struct span *p, int first, int last, int64_t begin, int64_t end)
{
    return p->rank >= first && p->rank <= last && p->begin_ps < end && p->end_ps > begin;
}

/* Rows of the CSV, and the latest begin and the number of spans that were written. */
static int64_t rows_of(const char *csv)
{
    int64_t n = -1; /* the header */
    for (; *csv; csv++) n += *csv == '\n';
    return n;
}

static void windows_and_limits_leave_the_rest(void **state)
{
    (void)state;
    struct random x = random_make(5, 0, 0);
    struct drawn *d = malloc(sizeof *d);
    for (int round = 0; round < 300; round++) {
        draw(d, &x, 1 + (int)random_below(&x, 6), 1 + (int)random_below(&x, 20));
        struct trace_options o = {.max_spans = (int64_t)random_below(&x, 30)};
        o.some_ranks = random_below(&x, 2);
        o.first_rank = (int)random_below(&x, (uint64_t)d->r.nrank);
        o.last_rank = o.first_rank + (int)random_below(&x, 3);
        if (random_below(&x, 2)) o.begin_ps = (int64_t)random_below(&x, 800);
        if (random_below(&x, 2)) o.end_ps = o.begin_ps + 1 + (int64_t)random_below(&x, 800);
        const bool all = !o.some_ranks && o.first_rank == 0 && o.last_rank == 0;
        const int last = all ? d->r.nrank - 1 : o.last_rank;
        const int64_t end = o.end_ps > 0 ? o.end_ps : d->r.makespan_ps + 1,
                      most = o.max_spans > 0 ? o.max_spans : TRACE_MAX_SPANS;
        int64_t inside = 0, left_out = -1;
        for (int64_t i = 0; i < d->r.nspan; i++)
            inside += reaches(&d->span[i], o.first_rank, last, o.begin_ps, end);
        char *csv = written(d, TRACE_CSV, &o, &left_out);
        if (inside == 0) {
            assert_null(csv);
            assert_int_equal(d->e.kind, ERR_CONFIG);
            continue;
        }
        assert_int_equal(left_out, inside > most ? inside - most : 0);
        assert_int_equal(rows_of(csv), inside - left_out);
        /* by rank, then time; and whatever is shown began no later than what is not */
        int rank = -1, before_rank = -1;
        long long begin, before = -1, latest = -1;
        int64_t earlier = 0;
        for (char *line = strchr(csv, '\n') + 1; *line; line = strchr(line, '\n') + 1) {
            const char *comma = line;
            rank = (int)strtol(line, NULL, 10);
            for (int k = 0; k < 3; k++) comma = strchr(comma, ',') + 1;
            begin = strtoll(comma, NULL, 10);
            assert_true(rank > before_rank || (rank == before_rank && begin >= before));
            before_rank = rank;
            before = begin;
            if (begin > latest) latest = begin;
        }
        for (int64_t i = 0; i < d->r.nspan; i++)
            earlier += reaches(&d->span[i], o.first_rank, last, o.begin_ps, end) &&
                       d->span[i].begin_ps < latest;
        assert_true(earlier <= inside - left_out);
        free(csv);
    }
    free(d);
}

static void a_schedule_takes_all_whatever_is_asked_for(void **state)
{
    (void)state;
    struct random x = random_make(6, 0, 0);
    struct drawn *d = malloc(sizeof *d);
    int64_t barriers;
    draw(d, &x, 3, 12);
    const struct trace_options all = {0}, few = {.max_spans = 1,
                                                 .some_ranks = true,
                                                 .first_rank = 1,
                                                 .last_rank = 1,
                                                 .begin_ps = 40,
                                                 .end_ps = 41};
    char *a = written(d, TRACE_GOAL, &all, &barriers), *b = written(d, TRACE_GOAL, &few, &barriers);
    assert_non_null(a);
    assert_non_null(b);
    assert_string_equal(a, b);
    free(a);
    free(b);
    free(d);
}

/* ---- groups and partners ---- */

/* The picked spans of all ranks, in order. */
static int by_rank(const void *a, const void *b)
{
    const struct span *x = *(const struct span *const *)a, *y = *(const struct span *const *)b;
    if (x->rank != y->rank) return x->rank < y->rank ? -1 : 1;
    if (x->begin_ps != y->begin_ps) return x->begin_ps < y->begin_ps ? -1 : 1;
    return x < y ? -1 : x > y;
}

static void partners_are_the_two_ends_of_a_message(void **state)
{
    (void)state;
    struct random x = random_make(7, 0, 0);
    struct drawn *d = malloc(sizeof *d);
    const struct span *list[MOST];
    int pairs = 0, alone = 0;
    for (int round = 0; round < 200; round++) {
        draw(d, &x, 1 + (int)random_below(&x, 4), 1 + (int)random_below(&x, 40));
        pair_up(d, &x);
        struct timeline t = {.run = &d->r, .title = "", .span = list};
        /* a part of them, as a window leaves */
        for (int64_t i = 0; i < d->r.nspan; i++)
            if (random_below(&x, 5) > 0) list[t.nspan++] = &d->span[i];
        qsort(list, (size_t)t.nspan, sizeof *list, by_rank);
        int64_t *partner = timeline_partners(&t);
        for (int64_t i = 0; i < t.nspan; i++) {
            int64_t wanted = -1;
            const bool end = list[i]->kind == SPAN_SEND || list[i]->kind == SPAN_RECV;
            for (int64_t k = 0; k < t.nspan && end && list[i]->message >= 0; k++)
                if (k != i && list[k]->message == list[i]->message &&
                    list[k]->kind + list[i]->kind == SPAN_SEND + SPAN_RECV &&
                    list[k]->kind != list[i]->kind)
                    wanted = k;
            assert_int_equal(partner[i], wanted);
            pairs += wanted >= 0;
            alone += end && wanted < 0;
        }
        free(partner);
        /* groups: maximal, of one rank and stage, and every span is in one */
        for (int64_t first = 0, next; first < t.nspan; first = next) {
            next = timeline_group(&t, first);
            assert_true(next > first && next <= t.nspan);
            for (int64_t i = first; i < next; i++)
                assert_true(list[i]->rank == list[first]->rank &&
                            list[i]->stage == list[first]->stage);
            if (next < t.nspan)
                assert_true(list[next]->rank != list[first]->rank ||
                            list[next]->stage != list[first]->stage);
        }
    }
    assert_true(pairs > 100 && alone > 100);
    /* two sends of one number are no pair */
    struct span twice[2] = {{.kind = SPAN_SEND, .message = 4}, {.kind = SPAN_SEND, .message = 4}};
    const struct span *both[2] = {&twice[0], &twice[1]};
    int64_t *none = timeline_partners(&(struct timeline){.nspan = 2, .span = both});
    assert_true(none[0] == -1 && none[1] == -1);
    free(none);
    free(d);
}

static void kinds_and_stages_have_words(void **state)
{
    (void)state;
    struct run_result r = {.nstage = 2, .stage_name = {"first", "second", "beyond"}};
    const struct timeline t = {.run = &r};
    assert_string_equal(timeline_kind(SPAN_COMPUTE), "compute");
    assert_string_equal(timeline_kind(SPAN_BARRIER), "barrier");
    assert_string_equal(timeline_stage(&t, 0), "first");
    assert_string_equal(timeline_stage(&t, 1), "second");
    /* before the first stage, and beyond the last */
    assert_string_equal(timeline_stage(&t, -1), "");
    assert_string_equal(timeline_stage(&t, 2), "");
}

/* ---- bars of letters ---- */

/* The letter of a slot of time: what fills most of it, the first of equals, a blank for nothing. */
static char most_of(const struct drawn *d, int rank, int64_t from, int64_t to, bool stage)
{
    static const char sign[] = "#><.|";
    int64_t share[8] = {0};
    for (int64_t i = 0; i < d->r.nspan; i++) {
        const struct span *p = &d->span[i];
        const int64_t begin = p->begin_ps > from ? p->begin_ps : from,
                      end = p->end_ps < to ? p->end_ps : to;
        const int which = stage ? p->stage : (int)p->kind;
        if (p->rank == rank && end > begin && which >= 0) share[which] += end - begin;
    }
    int best = 0;
    for (int k = 1; k < 8; k++)
        if (share[k] > share[best]) best = k;
    return share[best] == 0 ? ' ' : stage ? (char)('A' + best) : sign[best];
}

/* All of a text, line by line: two for each rank below the head. */
static void bars_are(const struct drawn *d, const char *text, int columns)
{
    int64_t begin = INT64_MAX, end = 0;
    for (int64_t i = 0; i < d->r.nspan; i++) {
        if (d->span[i].begin_ps < begin) begin = d->span[i].begin_ps;
        if (d->span[i].end_ps > end) end = d->span[i].end_ps;
    }
    const char *line = strstr(text, "    rank\n");
    assert_non_null(line);
    line = strchr(line, '\n') + 1;
    for (int k = 0; k < d->r.nrank; k++)
        for (int half = 0; half < 2; half++, line = strchr(line, '\n') + 1) {
            assert_int_equal(strcspn(line, "\n"), 10 + columns);
            for (int c = 0; c < columns; c++) {
                const int64_t from = begin + (end - begin) * c / columns,
                              to = begin + (end - begin) * (c + 1) / columns;
                const char wanted = most_of(d, k, from, to, half == 0);
                if (line[10 + c] != wanted)
                    fail_msg("rank %d column %d: '%c', wanted '%c'", k, c, line[10 + c], wanted);
            }
        }
    assert_string_equal(line, "");
}

static void letters_are_what_fills_most_of_their_time(void **state)
{
    (void)state;
    struct random x = random_make(8, 0, 0);
    struct drawn *d = malloc(sizeof *d);
    int64_t left_out;
    for (int round = 0; round < 60; round++) {
        draw(d, &x, 1 + (int)random_below(&x, 5), 2 + (int)random_below(&x, 20));
        int64_t inside = 0;
        for (int64_t i = 0; i < d->r.nspan; i++) inside += d->span[i].end_ps > 0;
        /* a span of no length at 0 reaches into no window: the model above has none of these */
        if (inside < d->r.nspan) continue;
        const struct trace_options o = {.columns = 1 + (int)random_below(&x, 120)};
        char *text = written(d, TRACE_TEXT, &o, &left_out);
        assert_non_null(text);
        bars_are(d, text, o.columns);
        free(text);
    }
    free(d);
}

/* More columns than a line holds: the time of a letter is still that of the bar that is there. */
static void the_time_of_a_letter_is_that_of_the_bar(void **state)
{
    (void)state;
    static const int columns[] = {1, 100, 499, 500, 501, 700, 100000};
    struct drawn *d = calloc(1, sizeof *d);
    int64_t left_out;
    d->span[0] = (struct span){.kind = SPAN_COMPUTE, .end_ps = 5000000, .peer = -1, .message = -1};
    d->r = (struct run_result){.nrank = 1, .nspan = 1, .makespan_ps = 5000000, .span = d->span};
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) {
        const struct trace_options o = {.columns = columns[i]};
        char *text = written(d, TRACE_TEXT, &o, &left_out);
        char wanted[80];
        const int shown = (int)strspn(strchr(text, '#') + 1, "#");
        const char *bar = strstr(text, "       0  #");
        assert_non_null(bar);
        assert_int_equal(shown, 0); /* the head has one sign alone */
        const double length = (double)strspn(bar + 10, "#");
        snprintf(wanted, sizeof wanted, "0.000 to 5.000 us, one column is %.3f us", 5 / length);
        if (strstr(text, wanted) == NULL) fail_msg("no '%s' in %.80s", wanted, text);
        free(text);
    }
    free(d);
}

static void more_ranks_than_a_terminal_has_are_counted(void **state)
{
    (void)state;
    struct random x = random_make(9, 0, 0);
    struct drawn *d = malloc(sizeof *d);
    const struct trace_options o = {0};
    int64_t left_out;
    for (int more = 0; more < 3; more++) {
        char wanted[40];
        draw(d, &x, TRACE_TEXT_RANKS + more, 2);
        for (int64_t i = 0; i < d->r.nspan; i++) d->span[i].end_ps++; /* none is empty */
        char *text = written(d, TRACE_TEXT, &o, &left_out);
        snprintf(wanted, sizeof wanted, "and %d more ranks", more);
        assert_true((strstr(text, wanted) != NULL) == (more > 0));
        snprintf(wanted, sizeof wanted, "\n%8d  ", TRACE_TEXT_RANKS - 1);
        assert_non_null(strstr(text, wanted));
        snprintf(wanted, sizeof wanted, "\n%8d  ", TRACE_TEXT_RANKS);
        assert_null(strstr(text, wanted));
        free(text);
    }
    free(d);
}

/* ---- a schedule by hand ---- */

static const struct span by_hand[] = {
    {.rank = 0, .kind = SPAN_COMPUTE, .begin_ps = 0, .end_ps = 100, .peer = -1, .message = -1},
    {.rank = 0,
     .kind = SPAN_SEND,
     .begin_ps = 100,
     .end_ps = 150,
     .peer = 1,
     .bytes = 8,
     .message = ((int64_t)3 << 32) + 5},
    {.rank = 0, .kind = SPAN_WAIT, .begin_ps = 150, .end_ps = 170, .peer = 1, .message = -1},
    {.rank = 0, .kind = SPAN_COMPUTE, .begin_ps = 170, .end_ps = 175, .peer = -1, .message = -1},
    {.rank = 0, .kind = SPAN_BARRIER, .begin_ps = 175, .end_ps = 400, .peer = -1, .message = -1},
    {.rank = 1,
     .kind = SPAN_RECV,
     .begin_ps = 0,
     .end_ps = 200,
     .peer = 0,
     .bytes = 8,
     .message = ((int64_t)3 << 32) + 5},
    /* made of messages: it has one within */
    {.rank = 1, .kind = SPAN_BARRIER, .begin_ps = 200, .end_ps = 400, .peer = -1, .message = -1},
    {.rank = 1,
     .kind = SPAN_SEND,
     .begin_ps = 210,
     .end_ps = 220,
     .peer = 0,
     .bytes = 0,
     .message = 6},
};

static void a_schedule_repeats_what_each_rank_did(void **state)
{
    (void)state;
    struct drawn *d = calloc(1, sizeof *d);
    int64_t barriers = -1;
    memcpy(d->span, by_hand, sizeof by_hand);
    d->r = (struct run_result){
        .nrank = 3, .nspan = sizeof by_hand / sizeof *by_hand, .makespan_ps = 400, .span = d->span};
    const struct trace_options o = {.title = "by hand"};
    char *text = written(d, TRACE_GOAL, &o, &barriers);
    assert_string_equal(text, "// by hand\n// mimdsim time unit: 1 ps\nnum_ranks 3\n"
                              "\nrank 0 {\nl1: calc 100\nl2: send 8b to 1 tag 5\nl2 requires l1\n"
                              "l3: calc 5\nl3 irequires l2\n// a barrier of the machine\n"
                              "l4: calc 225\nl4 requires l3\n}\n"
                              "\nrank 1 {\nl1: recv 8b from 0 tag 5\n"
                              "l2: send 0b to 0 tag 6\nl2 requires l1\n}\n"
                              "\nrank 2 {\n}\n");
    assert_int_equal(barriers, 1);
    free(text);
    free(d);
}

/* What there is nothing of is refused, and nothing is written. */
static void nothing_is_refused(void **state)
{
    (void)state;
    static const char *const name[] = {"chrome", "paje", "csv", "text", "goal"};
    struct drawn *d = calloc(1, sizeof *d);
    const struct trace_options o = {.begin_ps = 1000, .end_ps = 2000};
    int64_t left_out;
    d->r = (struct run_result){.nrank = 1, .makespan_ps = 500, .span = d->span};
    for (int i = 0; i < 5; i++) {
        enum trace_format format;
        assert_true(trace_format_find(name[i], &format));
        assert_int_equal(format, i);
        d->r.nspan = 0;
        assert_null(written(d, format, &o, &left_out));
        assert_int_equal(d->e.kind, ERR_NO_INPUT);
        err_clear(&d->e);
        d->r.nspan = 1;
        d->span[0] = (struct span){.end_ps = 500, .peer = -1, .message = -1};
        char *text = written(d, format, &o, &left_out);
        /* a schedule is whole, whatever the window */
        assert_true((text != NULL) == (format == TRACE_GOAL));
        if (text == NULL) assert_int_equal(d->e.kind, ERR_CONFIG);
        err_clear(&d->e);
        free(text);
    }
    enum trace_format format = TRACE_CSV;
    assert_false(trace_format_find("", &format));
    assert_false(trace_format_find("CSV", &format));
    assert_int_equal(format, TRACE_CSV);
    free(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(windows_and_limits_leave_the_rest),
        cmocka_unit_test(a_schedule_takes_all_whatever_is_asked_for),
        cmocka_unit_test(partners_are_the_two_ends_of_a_message),
        cmocka_unit_test(kinds_and_stages_have_words),
        cmocka_unit_test(letters_are_what_fills_most_of_their_time),
        cmocka_unit_test(the_time_of_a_letter_is_that_of_the_bar),
        cmocka_unit_test(more_ranks_than_a_terminal_has_are_counted),
        cmocka_unit_test(a_schedule_repeats_what_each_rank_did),
        cmocka_unit_test(nothing_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

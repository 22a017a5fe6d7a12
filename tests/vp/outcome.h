/* outcome.h - results of runs that must not differ, with the memory that they lie in. */
#ifndef TESTS_VP_OUTCOME_H
#define TESTS_VP_OUTCOME_H

#include "base/arena.h"
#include "measure/run_result.h"

struct outcome {
    struct arena *arena;
    struct run_result r;
};

/* Every number and every word. */
static inline void same(const struct run_result *a, const struct run_result *b)
{
    assert_int_equal(a->status, b->status);
    assert_string_equal(a->text, b->text);
    assert_int_equal(a->digest, b->digest);
    assert_int_equal(a->events, b->events);
    assert_int_equal(a->ties, b->ties);
    assert_int_equal(a->makespan_ps, b->makespan_ps);
    assert_int_equal(a->messages, b->messages);
    assert_int_equal(a->bytes, b->bytes);
    assert_int_equal(a->nlink, b->nlink);
    assert_memory_equal(a->stage, b->stage,
                        (size_t)a->nrank * (size_t)a->nstage * sizeof *a->stage);
    assert_memory_equal(a->finish_ps, b->finish_ps, (size_t)a->nrank * sizeof *a->finish_ps);
    if (a->nlink) assert_memory_equal(a->link, b->link, (size_t)a->nlink * sizeof *a->link);
}

#endif

/* serial_answers.h - serial codes that have run on one processor, kept for the runs that follow:
 * their answer is the same for any number of ranks. */
#ifndef GUEST_SERIAL_ANSWERS_H
#define GUEST_SERIAL_ANSWERS_H

#include "guest/guest_world.h"
#include "program/program.h"

/* One that ended. */
struct serial_answer {
    char key[65]; /* of program, parameters, node and part */
    int nrank;    /* of the run, where the code asked for it; 0: it did not */
    int64_t time_ps;
    struct work work;
    struct guest_results results; /* what it published, owned */
};

/* serial_answers_create, _destroy: program_type.cache_create and cache_destroy. */
struct program_cache *serial_answers_create(void);
void serial_answers_destroy(struct program_cache *cache);

/* serial_answer: part `part` of the program of `r` on one processor: from its cache, or run now.
 *
 *   why  out  on failure, in `size` bytes: what became of it
 *
 *   Returns NULL when it did not end; else the answer, which lasts while the run does. */
const struct serial_answer *serial_answer(const struct program_run *r, int part,
                                          enum program_cost cost, int64_t stack_bytes, char *why,
                                          int size);

#endif

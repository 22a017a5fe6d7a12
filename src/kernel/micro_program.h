/* micro_program.h - the micro-benchmarks of micro.h as room program wants them. They publish one
 * number. */
#ifndef KERNEL_MICRO_PROGRAM_H
#define KERNEL_MICRO_PROGRAM_H

#include "program/program.h"

enum micro_output { OUTPUT_SECONDS /* (nrank) what each rank measured, simulated [s] */ };

/* micro_open, micro_prepare, micro_check, micro_estimate: of every micro-benchmark, see
 * program_type; context is its kernel_type, the text of its ranks. */
bool micro_open(struct program_run *r, struct err *e);
bool micro_prepare(struct program_run *r, struct arena *a, struct err *e);
void micro_check(struct program_run *r, struct arena *scratch, struct run_result *out);
void micro_estimate(const struct program_run *r, struct program_estimate *out);

/* MICRO_PROGRAM: the program_type of stem_kernel. */
#define MICRO_PROGRAM(stem, word, text)                                                            \
    {                                                                                              \
        .name = word, .title = text, .context = &stem##_kernel, .open = micro_open,                \
        .prepare = micro_prepare, .check = micro_check, .estimate = micro_estimate,                \
    }

#endif

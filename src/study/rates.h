/* rates.h - small serial benchmark codes, executed with every operation counted, as rates of a
 * node.
 *
 * What was published of computing is a rate: conventional operations, or bytes, over measured time.
 * The same code is executed here, its operations are counted in the classes of base/work.h, and the
 * costs of the node (machine/node_cost.h) turn them into simulated time. */
#ifndef STUDY_RATES_H
#define STUDY_RATES_H

#include "base/work.h"
#include "machine/node_cost.h"
#include "spec/machine_spec.h"

/* What one execution of a code did. */
struct rate_count {
    struct work work;
    double nominal; /* operations or bytes that the benchmark's own rule divides by the time */
};

enum rate_stream { RATE_COPY, RATE_SCALE, RATE_ADD, RATE_TRIAD };

/* rate_linpack: the LINPACK benchmark of order n: factors (dgefa) and solves (dgesl) with partial
 * pivoting and daxpy, column by column, on the benchmark's own matrix. Up to RATE_EXECUTED it is
 * executed, and the solution checked; beyond, its operations are summed. nominal: 2 n^3 / 3 + 2 n^2
 * (Dongarra, CS-89-85). */
enum { RATE_EXECUTED = 200 };
struct rate_count rate_linpack(int n);

/* rate_linpack_summed: the operations of rate_linpack for any n >= 1, none executed. daxpy leaves
 * out multipliers that are zero, of which the matrix has few: an executed count is up to 0.1 %
 * less. */
struct rate_count rate_linpack_summed(int n);

/* rate_stream: one pass of a kernel of STREAM over vectors of n doubles. nominal: 16 or 24 bytes an
 * element (McCalpin). A byte read and a byte written are one byte copied; a byte read alone is half
 * a byte copied. */
struct rate_count rate_stream(enum rate_stream kind, int n);

/* rate_inner_product: of two vectors of n doubles; nominal: 2 n. */
struct rate_count rate_inner_product(int n);

/* rate_of: nominal operations or bytes a second on a processor of `node`, whose first cache holds
 * the data. rate_at: at these costs. */
double rate_of(const struct node_spec *node, const struct rate_count *count);
double rate_at(const struct node_cost *cost, const struct rate_count *count);

#endif

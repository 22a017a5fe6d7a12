/* roofline.h - computing against communication: how many operations a processor does for each byte
 * that it sends, how fast it is, and which part of the machine would stop it from being faster.
 *
 * Source: S. Williams, A. Waterman, D. Patterson, "Roofline: an insightful visual performance model
 * for multicore architectures", Communications of the ACM 52 (2009) 65-76. There bytes are those of
 * memory; here they are those of messages, and message software is a roof of its own. */
#ifndef STUDY_ROOFLINE_H
#define STUDY_ROOFLINE_H

#include "base/arena.h"
#include "measure/run_result.h"
#include "spec/machine_spec.h"

/* What the lowest roof is made of. */
enum roof { ROOF_COMPUTING, ROOF_BANDWIDTH, ROOF_SOFTWARE };

/* One stage, or all of the run. Rates are of one processor, in the mean over all of them. */
struct roofline_row {
    int stage;                /* -1: the whole run */
    double flops;             /* additions, subtractions and multiplications, all ranks */
    double sent_bytes, messages;
    double intensity;         /* flops for each byte sent; INFINITY: nothing is sent */
    double attained;          /* [flop/s], waiting included */
    double computing;         /* [flop/s] while it computes: with its divisions, copies and calls */
    double bandwidth;         /* [flop/s] if it did nothing but send, at the rate of its port;
                                 INFINITY: unlimited */
    double software;          /* [flop/s] if it did nothing but handle messages: o_s, o_r, copies;
                                 INFINITY: that takes no time */
    enum roof lowest;         /* of these three */
};

/* roofline_word: "computing", "bandwidth", "message software". */
const char *roofline_word(enum roof roof);

/* roofline_rows: of a run `r` on machine `m`, in `a`: the whole run, then the stages that compute
 * in their order; *n rows, none when nothing was counted. */
struct roofline_row *roofline_rows(const struct machine_spec *m, const struct run_result *r, int *n,
                                   struct arena *a);

/* roofline_bandwidth: what a processor's port can send [B/s]: the injection port's rate, the
 * link's, or 1/G, whichever is least; INFINITY: unlimited. */
double roofline_bandwidth(const struct machine_spec *m, int64_t bytes);

#endif

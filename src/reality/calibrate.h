/* calibrate.h - a machine file of this computer, out of measured rates and messages. */
#ifndef REALITY_CALIBRATE_H
#define REALITY_CALIBRATE_H

#include "base/text.h"
#include "measure/real_row.h"
#include "reality/code_rates.h"
#include "reality/collective_times.h"
#include "reality/condition.h"
#include "reality/messages.h"
#include "reality/rates.h"

/* Everything that was measured. */
struct calibration {
    struct rates rates;
    bool has_code; /* there was a compiler for programs in one file */
    struct code_rates code;
    bool has_messages; /* there were two processes */
    struct messages messages;
    bool has_collectives; /* and no more of them than processors */
    struct collective_times collectives;
    struct condition_reference condition; /* how fast the computer was meanwhile */
    int points;          /* kernels and loops */
    int changed;         /* of them: passes_changed, by this part */
    double changed_by;
    int slow;            /* of them: slowed down whenever they were measured */
    struct host_load load;
    char host[64], processor[64], library[24], date[16];
    int processors; /* of this computer that the job may use */
    double clock;   /* [Hz]: for cycle counts, as the system states it; 1e9 where it does not */
};

/* calibration_remark: what was measured under another condition than the rest, as sentences
 * without a last full stop; "" where a tenth of the points at most took 10 % longer in one pass. */
void calibration_remark(const struct calibration *c, char *text, size_t size);

/* calibration_text: the machine file, every number with its residual, class "measured", date and
 * host; appended. */
void calibration_text(const struct calibration *c, struct text *out);

/* calibration_machine: what is known so far as a machine that predicts: `base` (a crossbar whose
 * network takes no time) with this node and this message software. */
struct machine_spec calibration_machine(const struct calibration *c,
                                        const struct machine_spec *base);

/* calibration_clock: the clock of the first processor as the system states it [Hz], 1e9 where it
 * does not. Only the unit of cycle counts: their times are measured. */
double calibration_clock(void);

#endif

/* interrupt.h - what a campaign says when somebody ends it by Ctrl-C or SIGTERM. */
#ifndef RUN_INTERRUPT_H
#define RUN_INTERRUPT_H

#include <signal.h>

/* What interrupts_begin has replaced. */
struct interrupts {
    struct sigaction interrupt, terminate;
};

/* interrupts_begin: from now on SIGINT and SIGTERM end the process as ever, but with a sentence on
 * stderr: what is stored stays. Signals that are ignored, as under nohup, stay so. interrupts_end:
 * as it was before. */
void interrupts_begin(struct interrupts *before);
void interrupts_end(const struct interrupts *before);

/* interrupts_silent: in a worker, whose parent says it. */
void interrupts_silent(void);

#endif

/* comm_serial.h - comm.h on one rank without any simulator: the bare kernel, its work counted by
 * stage. */
#ifndef COMM_COMM_SERIAL_H
#define COMM_COMM_SERIAL_H

#include "comm/comm.h"

enum { COMM_SERIAL_STAGES = 16 };

struct comm_serial {
    struct comm comm; /* first: pass &s.comm to a kernel */
    int stage;
    struct work work[COMM_SERIAL_STAGES]; /* counted so far, by stage */
};

/* comm_serial_make: a communicator of one rank. There is nobody to talk to: sending or receiving is
 * a CHECK. */
struct comm_serial comm_serial_make(void);

#endif

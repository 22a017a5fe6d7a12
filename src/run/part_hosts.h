/* part_hosts.h - the processes of a job as a program sees them (program/run_part.h). */
#ifndef RUN_PART_HOSTS_H
#define RUN_PART_HOSTS_H

#include "hosts/hosts.h"
#include "program/run_part.h"

/* part_hosts: this process's part of a run of nrank ranks that the processes of `h` share; h is
 * borrowed. */
struct run_part part_hosts(const struct hosts *h, int nrank);

#endif

/* host_load.h - what else this computer does while something is measured on it. */
#ifndef HOST_HOST_LOAD_H
#define HOST_HOST_LOAD_H

#include "measure/real_row.h"

/* Readings of the system's counters, at the beginning. */
struct host_load_begin {
    double busy_s, wall_s; /* processor time of all that runs; the clock */
    double average;        /* load average over 1 minute */
};

/* host_load_start: from now on. host_load_read: until now, in which the job itself used `own_s` of
 * processor time on this host. Numbers that the system does not tell are NaN. */
struct host_load_begin host_load_start(void);
struct host_load host_load_read(const struct host_load_begin *begin, double own_s);

/* host_processor_set: the processors that this process may use, a bit each. host_processors: how
 * many a union of such sets has; launchers that bind ranks give each process another one.
 * host_processor_name: what the first
 * one is called, "" when the system does not say. host_name: this computer's. */
uint64_t host_processor_set(void);
int host_processors(uint64_t set);
void host_processor_name(char *buffer, int size);
void host_name(char *buffer, int size);

/* host_date: today in UTC, "2026-11-22". */
void host_date(char buffer[16]);

#endif

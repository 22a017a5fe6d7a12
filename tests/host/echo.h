/* echo.h - an MPI of one process for tests: what is sent to the only rank comes back to it, in the
 * order sent. */
#ifndef TESTS_HOST_ECHO_H
#define TESTS_HOST_ECHO_H

#include "hosts/hosts.h"

/* echo_hosts: a job of one process whose messages go through memory. `largest_tag` is what it tells
 * of its tags. One job at a time. */
struct hosts echo_hosts(int largest_tag);

/* echo_under_way: messages that nobody has received. echo_slow: sends are not done before they have
 * been tested this often. */
int echo_under_way(void);
void echo_slow(int tests);

#endif

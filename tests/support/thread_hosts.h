/* thread_hosts.h - a job of processes that are threads of a test, with queues for messages. */
#ifndef TESTS_THREAD_HOSTS_H
#define TESTS_THREAD_HOSTS_H

#include "hosts/hosts.h"

enum { THREAD_HOSTS = 8 };

/* thread_hosts: the calls of such a job, for struct hosts. */
extern const struct hosts_calls thread_hosts;

/* thread_hosts_begin: before its threads start; thread_hosts_join: this thread is process `rank`;
 * thread_hosts_end: when they have ended. Returns how many messages nobody has received. */
void thread_hosts_begin(void);
void thread_hosts_join(int rank);
int thread_hosts_end(void);

#endif

/* fresh_messages.c - how many page faults the first messages of a job meet. reality.bats runs it as
 * two processes of an MPI; the first prints the count. */
#include <stdio.h>
#include <string.h>

#include "host/host_comm.h"

enum { ROUND_TRIPS = 20, TAG = 1, MOST = 4000 };

static char out[MOST], in[MOST];

/* To and fro. */
static void exchange(struct comm *c, int bytes)
{
    const int other = 1 - c->rank;
    if (c->rank == 0) comm_send(c, other, TAG, out, bytes);
    comm_recv(c, other, TAG, in, bytes);
    if (c->rank == 1) comm_send(c, other, TAG, out, bytes);
}

int main(void)
{
    struct hosts job;
    struct err e;
    err_clear(&e);
    struct host_comm *h = hosts_open(&job, &e) ? host_comm_create(&job, &e) : NULL;
    if (h == NULL || job.size != 2) {
        fprintf(stderr, "expected two processes: %s\n", e.text);
        return 1;
    }
    struct comm *c = host_comm_run_begin(h, false, 1, NULL, 0);
    /* The code and the buffers have their pages. */
    memset(out, 1, sizeof out);
    memset(in, 1, sizeof in);
    exchange(c, 8);
    exchange(c, MOST);
    int64_t faults = host_faults();
    for (int i = 0; i < ROUND_TRIPS; i++) {
        exchange(c, 8);
        exchange(c, MOST / 4);
        exchange(c, MOST);
    }
    faults = host_faults() - faults;
    if (job.call->reduce(HOSTS_SUM, &faults, 1) && job.rank == 0)
        printf("%lld\n", (long long)faults);
    host_comm_destroy(h);
    job.call->end();
    return 0;
}

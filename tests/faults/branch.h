/* branch.h - one process that tries all its failures: at each the library of fail.c forks, the
 * child's call fails and the child runs to its end, while the parent waits and then goes on as if
 * nothing had been. A failure costs what comes after it, not the whole command. every.c follows.
 *
 * Parent and child share what a process has outside its memory, so the child takes a copy of it: a
 * mount namespace of its own, in which the folder is covered by an overlay, and in it its open
 * files and shared mappings. Locks of files are not inherited; nobody holds the copies. Where
 * another thread or an unfinished child process is there, no such copy can be made: that failure is
 * passed, and left to a process of its own. */
#ifndef TESTS_FAULTS_BRANCH_H
#define TESTS_FAULTS_BRANCH_H

/* What the processes tell the one that follows them, by datagrams over the socket FAULT_SOCKET.
 * After all but BRANCH_PASSED they wait for one byte. */
struct branch_word {
    enum { BRANCH_PASSED, BRANCH_BORN, BRANCH_ENDED } what;
    long at;    /* the call */
    int child;  /* BORN: its process, which has the copy now */
    int status; /* ENDED: as of waitpid; the namespace lives while somebody holds it */
};

/* branch_begin: from the environment: FAULT_SOCKET a descriptor, FAULT_FOLDER what is to be copied,
 * FAULT_STEP one call of how many, FAULT_THIN fewer (branch_fails); without the first the library
 * fails one call as ever. */
void branch_begin(void);

/* branch_fails: whether call `now` is to fail, which `caller` has made; true in the child alone.
 * `first`: the first that is. With FAULT_THIN, of calls one after the other from the same place the
 * 1st, 2nd, 4th, 8th, ... and every 64th: SQLite, whose allocations all come from one place, makes
 * thousands for a statement, and tells this program the same whichever of them fails. */
int branch_fails(long now, long first, const void *caller);

/* branch_is_on: whether calls fail in branches. */
int branch_is_on(void);

#endif

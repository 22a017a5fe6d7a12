/* crash.h - crashes and endless loops of loaded programs: caught in the worker process, told by its
 * parent.
 *
 * The handler runs on a stack of its own and writes raw facts (signal, addresses, rank) into a
 * record in memory that worker and parent share; then the worker ends. The parent, which has all
 * its wits, makes the sentence out of it: "rank 3 in compute (my.c:17): segmentation fault at
 * address 0x0". */
#ifndef LOADER_CRASH_H
#define LOADER_CRASH_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/err.h"
#include "loader/loader.h"

enum { CRASH_FRAMES = 8, CRASH_PATH = 512, CRASH_TOLD_BYTES = 480, CRASH_STATUS = 72 };
enum { CRASH_PROGRAMS = 65, CRASH_JOB = 32 }; /* watched at a time: jobs and a serial code */

enum crash_kind { CRASH_NONE, CRASH_SIGNAL, CRASH_STACK, CRASH_HOST_TIME, CRASH_TOLD };

/* What the handler leaves; plain data in shared memory. */
struct crash_record {
    _Atomic int kind; /* enum crash_kind, stored last */
    int signal, code; /* of the signal, as in siginfo_t */
    int rank;         /* -1: not in a rank */
    char job[CRASH_JOB]; /* of several on one machine; "": it has that alone */
    uint64_t address; /* the memory accessed, for SIGSEGV and SIGBUS */
    int64_t now_ps;   /* the rank's clock, -1: not known */
    int64_t stack_bytes; /* that each rank has */
    char told[CRASH_TOLD_BYTES]; /* CRASH_TOLD: the whole sentence */
    double seconds;   /* the limit of host time that was passed [s] */
    int nframe;       /* places, innermost first: those within the program's files */
    struct {
        char file[CRASH_PATH]; /* the image or library */
        uint64_t address;      /* in that file */
    } frame[CRASH_FRAMES];
};

/* crash_record_create: a record in memory that processes forked from now on share, NULL: no memory.
 * crash_record_clear makes it empty for the next run. */
struct crash_record *crash_record_create(void);
void crash_record_clear(struct crash_record *r);
void crash_record_destroy(struct crash_record *r);

/* crash_guard_begin: from now on crashes of this process (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT)
 * are written to `record` and end it with status CRASH_STATUS. False with ERR_INTERNAL.
 * crash_guard_end: as it was before. */
bool crash_guard_begin(struct crash_record *record, struct err *e);
void crash_guard_end(void);

/* crash_record_of_process: the record of crash_guard_begin, NULL: this process has none.
 * crash_told: `text` is what is to be said of the end of this process, which is now; may be called
 * in a signal handler. */
struct crash_record *crash_record_of_process(void);
_Noreturn void crash_told(struct crash_record *record, const char *text);

/* crash_watch: ranks of `t` run from now on; they are found by their stacks of `stack_bytes` each.
 * `job`: its name, borrowed, where several programs share a machine, else NULL. crash_forget: they
 * do not any more; behind the last there is no limit of time either. Without a guard: no effect. */
void crash_watch(const struct loader_template *t, int64_t stack_bytes, const char *job);
void crash_forget(const struct loader_template *t);

/* crash_limit: end the process when it takes `seconds` of processor time from now on; 0: no limit.
 * Without a guard: no effect. */
void crash_limit(double seconds);

/* crash_text: the sentence for a record; false when nothing was recorded. Starts addr2line. */
bool crash_text(const struct crash_record *r, char *buffer, int size);

/* place_text: "function (file.c:12)" for `address` of the ELF file `file` by addr2line, true;
 * "file+0x1c" or what else it knows, false. */
bool place_text(const char *file, uint64_t address, char *buffer, int size);

#endif

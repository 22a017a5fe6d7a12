/* loader.h - programs of users as images with private data per rank: an ELF loader of our own.
 *
 * All ranks of a run are fibers of one process. dlopen gives each file one copy of its globals;
 * this loader gives every rank its own: writable data, thread-locals, C++ inline statics and the
 * data of the libraries the program needs (libgfortran, libstdc++) are private, program text is
 * shared. The host's libc, libm and ld.so alone are the process's own. A program is the user's own
 * code and runs with the user's rights.
 *
 * Order of use: loader_open, (patch the text), loader_reserve, then per rank loader_instantiate
 * and, on the rank's fiber, loader_start and loader_call or loader_main; loader_close at the end.
 * Every value read from the file is checked; a damaged file is ERR_DATA with what is wrong.
 *
 * Source of formats and rules: System V ABI (gABI chapters 4 and 5), AMD64 psABI 1.0, Drepper "ELF
 * Handling For Thread-Local Storage". */
#ifndef LOADER_LOADER_H
#define LOADER_LOADER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <mimdsim/host.h>

#include "base/err.h"

struct loader_template; /* one program with the libraries it needs, ready to be copied */
struct loader_instance; /* one rank's copy */

/* What the simulator does for the ranks. Functions get the `context` of loader_instantiate and run
 * on the rank's fiber. Members that are NULL: time stands still; output goes to the process's
 * streams; fail ends the rank. */
struct loader_hooks {
    int64_t (*now_ps)(void *context);
    void (*elapse_ps)(void *context, int64_t ps); /* computing */
    void (*sleep_ps)(void *context, int64_t ps);  /* idle */
    void (*output)(void *context, int stream, const char *data, size_t n);
    void (*fail)(void *context, const char *text); /* must not return */
    void (*compute)(void *context, double flops, double bytes); /* stated by the program */
};

/* How a call into a program ended. */
struct loader_outcome {
    bool exited; /* by exit or the like, with `status`; else it returned `value` */
    int status;
    int64_t value;
};

/* loader_open: read the program `path` (an ELF shared object made by `mimdsim cc`) and the
 * libraries it needs. Returns NULL with ERR_NO_INPUT (not there), ERR_DATA (damaged, wrong
 * architecture, not made by `mimdsim cc`, a library or symbol is missing) or ERR_INTERNAL. The
 * caller owns the template and ends it with loader_close. */
struct loader_template *loader_open(const char *path, struct err *e);

/* loader_close: give back the template and all its instances; accepts NULL. */
void loader_close(struct loader_template *t);

/* loader_template_symbol: address, in the template, of a symbol that the program defines, NULL:
 * none. *size (may be NULL) becomes the symbol's. Not where ranks find it: for reading constants
 * and patching text. */
void *loader_template_symbol(const struct loader_template *t, const char *name, size_t *size);

/* loader_template_section: the bytes of section `name` of the program in the template, NULL: there
 * is none, or it is not loaded; *size becomes its length [B]. Text and read-only data are writable
 * here until loader_reserve and are what every rank gets. */
void *loader_template_section(const struct loader_template *t, const char *name, size_t *size);

/* loader_template_at: `size` bytes of the program from address `address` of its file on (as in its
 * symbol table), in the template; NULL when they are not all within one loaded segment. */
void *loader_template_at(const struct loader_template *t, uint64_t address, size_t size);

/* loader_template_address: the other way, from a pointer into the template to the file's address.
 */
uint64_t loader_template_address(const struct loader_template *t, const void *at);

/* loader_reserve: fix the text and reserve addresses for `nrank` ranks; `hooks` are borrowed until
 * loader_close. Returns false with ERR_INTERNAL. */
bool loader_reserve(struct loader_template *t, int nrank, const struct loader_hooks *hooks,
                    struct err *e);

/* loader_instantiate: rank `rank`'s copy, relocated; no code of it has run. `context` is handed to
 * the hooks. NULL with ERR_INTERNAL (no memory). Lives until loader_close. */
struct loader_instance *loader_instantiate(struct loader_template *t, int rank, void *context,
                                           struct err *e);

/* loader_host: what the rank's program sees of the simulator; the caller fills mpi, comm,
 * directory. */
struct mimdsim_host *loader_host(struct loader_instance *i);

/* loader_symbol: address of a function or variable of the rank's program, NULL: none. */
void *loader_symbol(const struct loader_instance *i, const char *name);

/* loader_debug_stop: does nothing; loader_start calls it before any code of a rank runs, so that a
 * debugger can stop there and load the symbols of `file` at `base`. */
void loader_debug_stop(int rank, const char *file, uint64_t base);

/* loader_start: run the constructors, on the rank's fiber, as `argv` (argc entries and NULL) and
 * the process's environment. An exit inside shows in the outcome. */
struct loader_outcome loader_start(struct loader_instance *i, int argc, char **argv);

/* loader_call: call `function` of the program with up to four whole-number or pointer arguments.
 * Computing time that the program counted in register r15 goes to elapse_ps; the host's own r15 is
 * kept. Nests. */
struct loader_outcome loader_call(struct loader_instance *i, void *function,
                                  const int64_t argument[4]);

/* loader_call_six: loader_call with six arguments. */
struct loader_outcome loader_call_six(struct loader_instance *i, void *function,
                                      const int64_t argument[6]);

/* loader_exit: the rank ends with `status` as by exit: exit functions, destructors, streams. */
struct loader_outcome loader_exit(struct loader_instance *i, int status);

/* loader_main: constructors, main(argc, argv) or mimdsim_main, exit functions and destructors;
 * returns the exit status. */
int loader_main(struct loader_instance *i, int argc, char **argv);

/* loader_address_text: "function (file.c:12)" for an address in an instance, as far as the file
 * tells; without debug information "function+0x1c". False when the address belongs to no instance.
 * Starts addr2line: not for signal handlers (crash.h). */
bool loader_address_text(const struct loader_template *t, const void *address, char *buffer,
                         int size);

/* loader_prefetch: ask for the memory that the rank will touch first when it goes on; no effect but
 * on speed. */
void loader_prefetch(const struct loader_instance *i);

/* loader_bytes: memory that the copies take besides what they share, per rank as reserved [B]. */
int64_t loader_bytes(const struct loader_template *t);

#endif

/* template.h - the insides of room loader: a program and its libraries as the bytes that every rank
 * starts with.
 *
 * All files of a program lie one behind the other in one piece of memory, the same for every rank:
 * offsets in this piece ("places") are the currency of this room. The template holds the bytes of
 * all files with every relocation done as if the piece began at address 0; a copy at address B only
 * adds B at the listed places. */
#ifndef LOADER_TEMPLATE_H
#define LOADER_TEMPLATE_H

#include <stdatomic.h>

#include "loader/elf_file.h"
#include "loader/loader.h"

enum { LOADER_FILES = 32, LOADER_HOST_LIBRARIES = 16, LOADER_PAGE = 4096 };

/* One file of the program: the image itself, or a library that ranks have their own copy of. */
struct loader_file {
    struct elf_file elf;
    uint64_t place; /* of its address 0; may lie before the piece's start modulo 2^64, never in use
                       then */
    uint64_t begin; /* place of its first page */
    uint64_t data, end;  /* places: first writable page; end of the pages that the file fills */
    uint64_t memory_end; /* with zeroed memory */
    uint64_t tls;        /* place of its thread-locals */
};

/* A place that becomes known only by running code of the rank: result of the function at
 * `resolver`. */
struct indirect {
    uint64_t place, resolver;
};

struct symbol_slot; /* symbols.c */

struct loader_template {
    struct loader_file file[LOADER_FILES]; /* [0]: the program */
    int nfile;
    int order[LOADER_FILES]; /* constructors: libraries before those that need them */
    char *bytes;             /* (size) the template: shared mapping of `memory` */
    int memory;              /* descriptor of the bytes */
    uint64_t size;           /* pages that files fill, with the gaps between them [B] */
    uint64_t stride;         /* one rank: `size`, zeroed memory, thread-locals, whole pages [B] */
    uint64_t *relative;      /* (nrelative) places to which a copy's address is added, rising */
    size_t nrelative, relative_capacity;
    struct indirect *indirect; /* (nindirect) */
    size_t nindirect, indirect_capacity;
    struct symbol_slot *symbol; /* (nslot) of all files, by hash */
    size_t nslot;
    void *host[LOADER_HOST_LIBRARIES]; /* (nhost) handles of dlopen: libc, libm, ... */
    int nhost;
    int group;             /* ranks with one mapping together; 0: text mapped for each */
    bool relro;            /* constants are write-protected after relocation */
    char *memory_of_ranks; /* (nrank * stride) reserved; NULL before loader_reserve */
    int nrank;
    struct loader_instance *instance; /* (nrank) */
    const struct loader_hooks *hooks;
    struct mimdsim_runtime runtime; /* what hosts point to */
    char directory[1024];           /* the working directory */
};

/* One rank. Cache lines of its own; the first is all that most calls touch. */
struct loader_instance {
    _Alignas(64) struct mimdsim_host host;
    int64_t *pending; /* the image's mimdsim_pending, NULL: it has none */
    struct loader_template *t;
    char *base; /* its piece of memory, NULL: not instantiated */
    void *context;
    struct loader_frame *frame, *outermost;
    uintptr_t stack; /* where the stack of its fiber was at the outermost call */
    bool exited;
    int status;
    const char *text, *data; /* program text and data that were used last; for prefetching */
};

/* What loader_enter keeps: the host's stack pointer while the program runs, and the program's count
 * at its return. */
struct loader_frame {
    void *stack;
    int64_t count;
    struct loader_frame *outer;
};

/* loader_enter: call function(argument[0..5]) with r15 = 0, as loader_call says (enter.c).
 * loader_leave: make that call return `value` now; the stack between is forgotten. */
int64_t loader_enter(void *function, const int64_t argument[6], struct loader_frame *frame);
_Noreturn void loader_leave(struct loader_frame *frame, int64_t value);

/* library_of_host: whether a library is the process's own, not a rank's. */
bool library_of_host(const char *name);

/* --- libraries.c: files_read: the program and what it needs, in t->file and t->order. */
bool files_read(struct loader_template *t, const char *path, struct err *e);

/* --- image.c: image_make: places, memory, bytes of all files. image_give_back: the memory. */
bool image_make(struct loader_template *t, struct err *e);
void image_give_back(struct loader_template *t);

/* image_writable: whether `size` bytes at `place` lie in pages of the file that are writable and
 * not zeroed memory. */
bool image_writable(const struct loader_file *f, uint64_t place, uint64_t size);

/* image_code: whether the file's `address` lies in program text. */
bool image_code(const struct elf_file *f, uint64_t address);

/* A symbol that was found: in a file of the program (symbol), or in the host (address); neither: a
 * weak one, 0. */
struct found {
    const struct loader_file *file;
    const Elf64_Sym *symbol;
    void *address;
};

/* --- symbols.c: symbols_make: the table of what the files define. symbols_give_back: its memory.
 */
bool symbols_make(struct loader_template *t, struct err *e);
void symbols_give_back(struct loader_template *t);
/* symbols_defined: the first file that defines `name`; file NULL: none. */
struct found symbols_defined(const struct loader_template *t, const char *name);

/* symbols_find: what symbol number i of file f means; false: nobody defines it. */
bool symbols_find(const struct loader_template *t, const struct loader_file *f, size_t i,
                  struct found *out);

/* --- relocate.c: relocate_all: do all relocations in the template, fill relative and indirect. */
bool relocate_all(struct loader_template *t, struct err *e);

/* loader_find_address: rank (may be NULL), file and address in that file of an address in some
 * rank's copy; false: none. Fit for signal handlers (loader.c). */
bool loader_find_address(const struct loader_template *t, const void *address, int *rank,
                         const char **file, uint64_t *at);

/* loader_is_return: whether `address` is where a call of the rank's program returns to: it is
 * program text, and a call stands before it. Fit for signal handlers (address.c). */
bool loader_is_return(const struct loader_instance *i, const void *address);

/* loader_place_text: function and line of the call that returns to `place`; where that has no line,
 * of the nearest caller on the stack from `stack` on that has one. False: no place of the program.
 */
bool loader_place_text(const struct loader_instance *i, const void *place, const void *stack,
                       char *buffer, int size);

/* loader_finish: run the termination functions of all files of a rank (enter.c). */
void loader_finish(struct loader_instance *i);

/* --- runtime.c: runtime_fill: the functions that programs call. */
void runtime_fill(struct mimdsim_runtime *r);

#endif

/* driver.c - gcc to assembly, the filter, gcc to an object; and the link of an image. */
#include "compile/driver.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/process.h"
#include "compile/block_filter.h"
#include "compile/command.h"
#include "compile/object_check.h"
#include "compile/start_text.h"

enum { FAILED = -1 }; /* *e tells */

struct driver {
    enum driver_language language;
    const struct driver_places *places;
    struct arena *arena;
    struct words compiler; /* its own words: gcc, or ccache gcc */
    struct command command;
    char folder[4096]; /* of objects that are linked at once, "": none yet */
    struct err *e;
};

/* Behind the user's options, so that they win. Register 15 counts; what follows it keeps code in
 * assembly of one syntax, as position-independent as a shared image needs, without the interposing
 * of functions that nobody asked for. String instructions that repeat would hide how much they
 * move, so that these are calls. A caller must not know which
 * registers a function leaves alone, as its entry (entries.h) takes one more. Unwind tables tell
 * where arguments are. Frames larger than a page touch each page, so that they meet the guard page
 * of their stack. */
static const char *const forced[] = {"-ffixed-r15",
                                     "-fPIC",
                                     "-fno-semantic-interposition",
                                     "-fno-lto",
                                     "-fno-ipa-ra",
                                     "-masm=att",
                                     "-mstringop-strategy=libcall",
                                     "-fstack-clash-protection",
                                     "-fasynchronous-unwind-tables"};
enum { FORCED = sizeof forced / sizeof forced[0] };

/* A command line that begins with the compiler's own words. */
static struct words new_words(struct driver *d)
{
    struct words w = {.arena = d->arena};
    words_add_all(&w, d->compiler.n, d->compiler.word);
    return w;
}

/* Three texts as one, in the driver's arena. */
static const char *joined(struct driver *d, const char *a, const char *b, const char *c)
{
    const size_t n = strlen(a) + strlen(b) + strlen(c) + 1;
    char *text = arena_take(d->arena, n);
    snprintf(text, n, "%s%s%s", a, b, c);
    return text;
}

/* Our headers, behind the user's folders (Fortran knows -I only), and the macro that tells sources
 * where they are. */
static void add_includes(struct driver *d, struct words *w)
{
    words_add(w, "-D__MIMDSIM__=1");
    const char *const from[] = {d->places->include, d->places->include_built};
    for (int i = 0; i < 2; i++) {
        if (from[i] == NULL || access(from[i], X_OK) != 0) continue; /* gfortran warns */
        const char *option = d->language == DRIVER_FORTRAN ? "-I" : "-isystem";
        words_add(w, option);
        words_add(w, from[i]);
        words_add(w, option);
        words_add(w, joined(d, from[i], "/mimdsim", ""));
    }
}

/* A compiler that is not there: which one it may be. */
static void name_compilers(struct err *e)
{
    char what[sizeof e->text];
    if (e->kind != ERR_UNAVAILABLE) return;
    text_copy(what, sizeof what, e->text);
    err_clear(e);
    err_set(e, ERR_UNAVAILABLE,
            "%.300s; `mimdsim cc`, `c++` and `f90` work through gcc, g++ and gfortran, or what "
            "MIMDSIM_CC, MIMDSIM_CXX and MIMDSIM_FC name",
            what);
}

/* Run a program that writes its own messages; its status, or FAILED. */
static int run(struct driver *d, const struct words *w, const struct text *in, struct text *out)
{
    int status;
    if (process_run(w->word, in, out, &status, d->e)) return status;
    name_compilers(d->e);
    return FAILED;
}

/* --- compiling --- */

/* The source as assembly, unfiltered. */
static int read_assembly(struct driver *d, const struct command_source *s, int i,
                         const char *object, struct text *assembly)
{
    /* .s needs no preprocessor, which gcc would not start for it. */
    const char *dot = strrchr(s->path, '.');
    const bool plain = s->language != NULL ? strcmp(s->language, "assembler") == 0
                                           : dot != NULL && strcmp(dot, ".s") == 0;
    if (s->assembly && plain)
        return (strcmp(s->path, "-") == 0
                    ? text_read_stream(assembly, stdin, "standard input", d->e)
                    : text_read_file(assembly, s->path, d->e))
                   ? 0
                   : FAILED;
    struct words w = new_words(d);
    words_add_all(&w, d->command.compile.n, d->command.compile.word);
    add_includes(d, &w);
    command_dependency_words(&d->command, i, object, &w);
    if (!s->assembly) words_add_all(&w, FORCED, forced);
    /* One program sends whole numbers and reals by the same mpi_send, which Fortran's rules
     * forbid. */
    if (!s->assembly && d->language == DRIVER_FORTRAN) {
        words_add(&w, "-fallow-argument-mismatch");
        words_add(&w,
                  "-fallow-invalid-boz"); /* hexadecimal constants as older compilers took them */
    }
    words_add(&w, s->assembly ? "-E" : "-S");
    words_add(&w, "-o");
    words_add(&w, "-");
    if (s->language != NULL) {
        words_add(&w, "-x");
        words_add(&w, s->language);
    }
    words_add(&w, s->path);
    return run(d, &w, NULL, assembly);
}

/* Assembly with the counters of its blocks. */
static int filter(struct driver *d, const struct command_source *s, const struct text *in,
                  struct text *out)
{
    /* libgfortran calls no procedure of the program, and many of these have arguments on the
     * stack. */
    const bool guarded = !s->assembly && d->language != DRIVER_FORTRAN;
    const struct block_source source = {s->path, d->command.flags, s->assembly, guarded};
    if (block_filter(in, &source, out, d->e)) return 0;
    /* clang would not come so far, as it has no -ffixed-r15; other compilers may. */
    return FAILED;
}

/* For -S: to the file, or to standard output for "-". */
static int write_text(struct driver *d, const char *path, const struct text *t)
{
    const bool standard = strcmp(path, "-") == 0;
    FILE *f = standard ? stdout : fopen(path, "w");
    bool fine = f != NULL && fwrite(t->s, 1, t->length, f) == t->length;
    if (f != NULL && (standard ? fflush(f) : fclose(f)) != 0) fine = false;
    if (!fine) err_set(d->e, ERR_CREATE, "%s cannot be written: %s", path, strerror(errno));
    return fine ? 0 : FAILED;
}

/* The counted assembly becomes an object without touching the disk in between. */
static int assemble(struct driver *d, const struct text *assembly, const char *object)
{
    struct words w = new_words(d);
    words_add_all(&w, d->command.assemble.n, d->command.assemble.word);
    words_add(&w, "-c");
    words_add(&w, "-x");
    words_add(&w, "assembler");
    words_add(&w, "-o");
    words_add(&w, object);
    words_add(&w, "-");
    return run(d, &w, assembly, NULL);
}

/* Source i to `output`: an object, or with -S assembly. */
static int compile(struct driver *d, int i, const char *output)
{
    const struct command_source *s = &d->command.source[i];
    struct text assembly = {0}, counted = {0};
    int status = read_assembly(d, s, i, output, &assembly);
    if (status == 0) status = filter(d, s, &assembly, &counted);
    if (status == 0)
        status = d->command.stage == COMMAND_ASSEMBLY ? write_text(d, output, &counted)
                                                      : assemble(d, &counted, output);
    text_free(&assembly);
    text_free(&counted);
    return status;
}

/* With -c or -S: each source has an output of its own. */
static int compile_all(struct driver *d)
{
    const struct command *c = &d->command;
    for (int i = 0; i < c->nsource; i++) {
        const char *ending = c->stage == COMMAND_ASSEMBLY ? "s" : "o";
        const char *output = c->output != NULL
                                 ? c->output
                                 : command_default_output(c->source[i].path, ending, d->arena);
        const int status = compile(d, i, output);
        if (status != 0) return status;
    }
    return 0;
}

/* --- linking --- */

/* A folder of our own for objects that are in the way only. */
static int open_folder(struct driver *d)
{
    const char *temporary = getenv("TMPDIR");
    snprintf(d->folder, sizeof d->folder, "%s/mimdsim-cc-XXXXXX",
             temporary != NULL && temporary[0] == '/' ? temporary : P_tmpdir);
    if (mkdtemp(d->folder) != NULL) return 0;
    err_set(d->e, ERR_CREATE, "no folder for objects: %s: %s", d->folder, strerror(errno));
    d->folder[0] = '\0';
    return FAILED;
}

/* Objects are numbered; the one behind the last source is the start code. */
static void close_folder(struct driver *d, int objects)
{
    char path[sizeof d->folder + 64];
    for (int i = 0; d->folder[0] != '\0' && i <= objects; i++) {
        snprintf(path, sizeof path, "%s/%d.o", d->folder, i);
        unlink(path);
    }
    if (d->folder[0] != '\0') rmdir(d->folder);
}

/* Sources become objects, and their words in the link line the objects' paths. */
static int compile_for_link(struct driver *d)
{
    for (int i = 0; i < d->command.nsource; i++) {
        char number[32];
        snprintf(number, sizeof number, "/%d.o", i);
        const char *object = joined(d, d->folder, number, "");
        const int status = compile(d, i, object);
        if (status != 0) return status;
        d->command.link.word[d->command.source[i].place] = object;
    }
    return 0;
}

/* Whether one of the objects declares a kernel: it has no main, and is loaded by `mimdsim run`. */
static bool is_kernel(const struct driver *d)
{
    for (int i = 0; i < d->command.link.n; i++) {
        const char *word = d->command.link.word[i];
        if (word[0] != '-' && object_facts_of_file(word).kernel) return true;
    }
    return false;
}

/* What makes an image of objects: our archives, the code that starts it, and no symbol left
 * undefined, as in a program. The archive of guest/ is linked whole, so that its functions come
 * before the C library's. */
static int add_image_words(struct driver *d, bool kernel, struct words *w)
{
    char number[32];
    snprintf(number, sizeof number, "/%d.o", d->command.nsource);
    const char *start = joined(d, d->folder, number, ""), *library = d->places->library;
    struct text text = {0};
    start_text(&text, d->places->program, kernel);
    const int status = assemble(d, &text, start);
    text_free(&text);
    if (status != 0) return status;
    const char *const image[] = {"-Wl,-Bsymbolic", "-Wl,-z,defs", "-Wl,-e,mimdsim_start", start};
    words_add_all(w, 4, image);
    const char *mpi = joined(d, library, "/libmimdsim-mpi.a", "");
    if (access(mpi, R_OK) == 0) words_add(w, mpi);
    words_add(w, "-Wl,--whole-archive");
    words_add(w, joined(d, library, "/libmimdsim-guest.a", ""));
    words_add(w, "-Wl,--no-whole-archive");
    return 0;
}

/* The linker's lines of files go to the check; what else it prints is for the user. */
static int check_trace(struct driver *d, const struct text *trace, const char *output)
{
    if (object_check_trace(trace, d->e)) return 0;
    unlink(output);
    return FAILED;
}

/* A program becomes a shared image that the simulator loads once for each rank. The linker's
 * trace, asked for twice so that it names members of archives, tells which objects it took. */
static int link_image(struct driver *d)
{
    const struct command *c = &d->command;
    const char *output = c->output != NULL ? c->output : "a.out";
    const bool kernel = !c->relocatable && is_kernel(d),
               image = !c->relocatable && (kernel || !c->shared);
    struct words w = new_words(d);
    words_add_all(&w, c->link.n, c->link.word);
    if (!c->shared && !c->relocatable) words_add(&w, "-shared");
    if (d->language == DRIVER_CXX) {
        words_add(&w, "-static-libstdc++");
        words_add(&w, "-static-libgcc");
    }
    const int status = image ? add_image_words(d, kernel, &w) : 0;
    if (status != 0) return status;
    const char *const last[] = {"-fPIC",       "-fno-lto", "-lm", "-Wl,--trace",
                                "-Wl,--trace", "-o",       output};
    words_add_all(&w, 7, last);
    struct text trace = {0};
    int linked = run(d, &w, NULL, &trace);
    if (linked == 0) linked = check_trace(d, &trace, output);
    text_free(&trace);
    return linked;
}

/* The folder goes whatever happens; the user's objects stay where they are. */
static int compile_and_link(struct driver *d)
{
    int status = open_folder(d);
    if (status == 0) status = compile_for_link(d);
    if (status == 0) status = link_image(d);
    close_folder(d, d->command.nsource);
    return status;
}

/* --- all of it --- */

/* The compiler's words, and a look whether it is gcc where the user has named it. */
static int find_compiler(struct driver *d)
{
    static const char *const variable[] = {"MIMDSIM_CC", "MIMDSIM_CXX", "MIMDSIM_FC"};
    static const char *const usual[] = {"gcc", "g++", "gfortran"};
    const char *named = getenv(variable[d->language]);
    d->compiler.arena = d->arena;
    words_add_parts(&d->compiler, named != NULL && named[0] != '\0' ? named : usual[d->language]);
    if (named == NULL || named[0] == '\0') return 0;
    struct words w = new_words(d);
    struct text version = {0};
    words_add(&w, "--version");
    int status = run(d, &w, NULL, &version);
    if (status == 0 && version.s != NULL && strstr(version.s, "clang") != NULL) {
        err_set(d->e, ERR_UNAVAILABLE,
                "%s is '%s', a clang, which cannot keep a register free; `mimdsim cc` works "
                "through gcc",
                variable[d->language], named);
        status = FAILED;
    }
    text_free(&version);
    return status;
}

/* Questions and preprocessing: gcc itself, which then knows our headers. */
static int pass_on(struct driver *d, int n, const char *const *word)
{
    struct words w = new_words(d);
    words_add_all(&w, n, word);
    if (d->command.nsource > 0) add_includes(d, &w);
    process_replace(w.word, d->e);
    name_compilers(d->e);
    return FAILED;
}

/* What the line asks for, by its stage; gcc's own status comes back where gcc failed. */
int driver_run(enum driver_language language, int n, const char *const *word,
               const struct driver_places *places, struct err *e)
{
    struct driver d = {.language = language, .places = places, .arena = arena_create(), .e = e};
    int status = find_compiler(&d);
    if (status == 0 && !command_read(&d.command, n, word, d.arena, e)) status = FAILED;
    if (status == 0) {
        const enum command_stage stage = d.command.stage;
        status = stage == COMMAND_PASS   ? pass_on(&d, n, word)
                 : stage == COMMAND_LINK ? compile_and_link(&d)
                                         : compile_all(&d);
    }
    arena_destroy(d.arena);
    return status;
}

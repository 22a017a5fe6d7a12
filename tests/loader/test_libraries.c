/* test_libraries.c - which libraries a program takes with it, where they are looked for, and in
 * which order they begin; and the records that crashes leave. */
#include <elf.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/random.h"
#include "loader/crash.h"
#include "loader/template.h"
#include "support/scratch.h"

enum { MOST_NEEDED = 40 };

/* The smallest shared object that is one: names of what it needs, and an empty table of symbols.
 * Addresses are offsets. */
struct small {
    Elf64_Ehdr h;
    Elf64_Phdr p[5];
    Elf64_Dyn dynamic[MOST_NEEDED + 8];
    Elf64_Sym symbol[1];
    uint32_t hash[4];
    char strings[1200];
};

#define OFFSET(member) offsetof(struct small, member)

static char folder[200];
static struct loader_template *t;

static int begin(void **state)
{
    (void)state;
    scratch_make(folder, sizeof folder);
    t = calloc(1, sizeof *t);
    unsetenv("LD_LIBRARY_PATH");
    return 0;
}

static void forget(void)
{
    for (int i = 0; i < t->nfile; i++) elf_file_free(&t->file[i].elf);
    memset(t, 0, sizeof *t);
}

static int end(void **state)
{
    (void)state;
    forget();
    free(t);
    unsetenv("LD_LIBRARY_PATH");
    scratch_remove(folder);
    return 0;
}

/* An object in memory; `needed`: names with blanks between them. */
static struct small small_of(const char *needed, const char *soname, const char *runpath)
{
    struct small s;
    memset(&s, 0, sizeof s);
    memcpy(s.h.e_ident, ELFMAG, SELFMAG);
    s.h.e_ident[EI_CLASS] = ELFCLASS64;
    s.h.e_ident[EI_DATA] = ELFDATA2LSB;
    s.h.e_type = ET_DYN;
    s.h.e_machine = EM_X86_64;
    s.h.e_phoff = OFFSET(p);
    s.h.e_phentsize = sizeof(Elf64_Phdr);
    s.h.e_phnum = 2;
    s.p[0] = (Elf64_Phdr){.p_type = PT_LOAD,
                          .p_flags = PF_R | PF_X,
                          .p_filesz = sizeof s,
                          .p_memsz = sizeof s,
                          .p_align = 4096};
    s.p[1] = (Elf64_Phdr){
        .p_type = PT_DYNAMIC, .p_vaddr = OFFSET(dynamic), .p_filesz = sizeof s.dynamic};
    size_t used = 1;
    int n = 0;
    s.dynamic[n++] = (Elf64_Dyn){DT_STRTAB, {OFFSET(strings)}};
    s.dynamic[n++] = (Elf64_Dyn){DT_STRSZ, {sizeof s.strings}};
    s.dynamic[n++] = (Elf64_Dyn){DT_SYMTAB, {OFFSET(symbol)}};
    s.dynamic[n++] = (Elf64_Dyn){DT_SYMENT, {sizeof(Elf64_Sym)}};
    s.dynamic[n++] = (Elf64_Dyn){DT_HASH, {OFFSET(hash)}};
    s.hash[0] = s.hash[1] = 1;
    const char *const one[2] = {soname, runpath};
    static const Elf64_Sxword tag[2] = {DT_SONAME, DT_RUNPATH};
    for (int k = 0; k < 2; k++) {
        if (one[k] == NULL) continue;
        strcpy(s.strings + used, one[k]);
        s.dynamic[n++] = (Elf64_Dyn){tag[k], {used}};
        used += strlen(one[k]) + 1;
    }
    for (size_t length; *(needed += strspn(needed, " ")) != '\0'; needed += length) {
        length = strcspn(needed, " ");
        assert_true(used + length + 1 < sizeof s.strings);
        memcpy(s.strings + used, needed, length);
        s.dynamic[n++] = (Elf64_Dyn){DT_NEEDED, {used}};
        used += length + 1;
    }
    return s;
}

/* "folder/name", in one of four buffers. */
static const char *path_of(const char *name)
{
    static char path[4][512];
    static int next;
    return scratch_path(path[next++ % 4], sizeof path[0], folder, name);
}

static void write_small(const char *name, const struct small *s)
{
    FILE *out = fopen(path_of(name), "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(s, sizeof *s, 1, out), 1);
    assert_int_equal(fclose(out), 0);
}

static void library(const char *name, const char *needed)
{
    const struct small s = small_of(needed, NULL, "$ORIGIN");
    write_small(name, &s);
}

static void read_all(const char *program)
{
    struct err e;
    err_clear(&e);
    forget();
    if (!files_read(t, path_of(program), &e)) fail_msg("%s", e.text);
}

static const char *name_of(int file) { return strrchr(t->file[file].elf.path, '/') + 1; }

/* The files in the order in which names are searched, and in which they begin. */
static void assert_files(const char *search, const char *order)
{
    char is[2][400] = {"", ""};
    for (int i = 0; i < t->nfile; i++) {
        snprintf(is[0] + strlen(is[0]), sizeof is[0] - strlen(is[0]), " %s", name_of(i));
        snprintf(is[1] + strlen(is[1]), sizeof is[1] - strlen(is[1]), " %s", name_of(t->order[i]));
    }
    assert_string_equal(is[0] + 1, search);
    assert_string_equal(is[1] + 1, order);
}

static void libraries_are_searched_breadth_first_and_begin_before_their_users(void **state)
{
    (void)state;
    library("d", "");
    library("c", "d");
    library("b", "d libc.so.6");
    library("a", "libm.so.6 b c");
    read_all("a");
    assert_files("a b c d", "d b c a");
    /* a circle ends where it is met; the program still comes last */
    library("d", "b");
    read_all("a");
    assert_int_equal(t->nfile, 4);
    assert_string_equal(name_of(t->order[3]), "a");
}

/* Any graph without circles: each file that can be reached once, and what is needed begins first.
 */
static void any_graph_is_put_in_order(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 25; seed++) {
        enum { N = 8 };
        bool edge[N][N] = {{false}}, reached[N] = {true};
        struct random r = random_make(seed, 0, 0);
        for (int i = 0; i < N; i++) {
            char needed[100] = "", name[8];
            for (int k = N - 1; k > i; k--) {
                if (!(edge[i][k] = random_below(&r, 3) == 0)) continue;
                snprintf(needed + strlen(needed), sizeof needed - strlen(needed), " f%d", k);
            }
            snprintf(name, sizeof name, "f%d", i);
            library(name, needed);
        }
        int n = 0;
        for (int i = 0; i < N; i++)
            for (int k = 0; reached[i] && k < N; k++) reached[k] |= edge[i][k];
        for (int i = 0; i < N; i++) n += reached[i];
        read_all("f0");
        assert_int_equal(t->nfile, n);
        int place[N], depth[N] = {0};
        for (int i = 0; i < N; i++) place[i] = -1;
        for (int i = 0; i < n; i++) {
            const int file = name_of(t->order[i])[1] - '0';
            assert_true(reached[file] && place[file] < 0);
            place[file] = i;
        }
        /* the shortest way from the program, by relaxing until nothing changes */
        for (int i = 1; i < N; i++) depth[i] = N;
        for (int round = 0; round < N; round++)
            for (int i = 0; i < N; i++)
                for (int k = 0; k < N; k++)
                    if (edge[i][k] && depth[i] + 1 < depth[k]) depth[k] = depth[i] + 1;
        for (int i = 0; i < N; i++)
            for (int k = 0; k < N; k++)
                if (edge[i][k] && reached[i]) assert_true(place[k] < place[i]);
        for (int i = 1; i < n; i++)
            assert_true(depth[name_of(i)[1] - '0'] >= depth[name_of(i - 1)[1] - '0']);
    }
}

static void a_library_is_looked_for_where_it_is_said_to_be(void **state)
{
    (void)state;
    static const char *const where[] = {"run", "env", "first"};
    char text[900];
    for (int i = 0; i < 3; i++) {
        assert_int_equal(mkdir(path_of(where[i]), 0755), 0);
        snprintf(text, sizeof text, "%s/lib.so", where[i]);
        library(text, "");
    }
    const struct {
        const char *runpath, *environment, *needed, *found;
    } row[] = {
        {"$ORIGIN/run", NULL, "lib.so", "run"},
        {"$ORIGIN/none:$ORIGIN/run", "%s/env", "lib.so", "run"}, /* goes before the environment */
        {"::%s/run", "%s/env", "lib.so", "run"},                 /* nothing names no folder */
        {NULL, "%s/env", "lib.so", "env"},
        {"%s/none", "%s/none:%s/first:%s/env", "lib.so", "first"},
        {"$ORIGIN/env", "%s/env", "%s/first/lib.so", "first"}, /* a path is a path */
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        char runpath[700], environment[900], needed[400], wanted[300];
        snprintf(runpath, sizeof runpath, row[k].runpath ? row[k].runpath : "", folder, folder);
        snprintf(environment, sizeof environment, row[k].environment ? row[k].environment : "",
                 folder, folder, folder);
        snprintf(needed, sizeof needed, row[k].needed, folder);
        const struct small s = small_of(needed, NULL, row[k].runpath ? runpath : NULL);
        write_small("program", &s);
        if (row[k].environment) setenv("LD_LIBRARY_PATH", environment, 1);
        else unsetenv("LD_LIBRARY_PATH");
        read_all("program");
        assert_int_equal(t->nfile, 2);
        snprintf(wanted, sizeof wanted, "/%s/lib.so", row[k].found);
        if (strstr(t->file[1].elf.path, wanted) == NULL)
            fail_msg("row %d: %s", (int)k, t->file[1].elf.path);
    }
}

/* One file under two names is one library: its constructors run once. */
static void a_library_with_two_names_is_read_once(void **state)
{
    (void)state;
    const struct small s = small_of("", "libx.so.1", NULL);
    write_small("libx.so", &s);
    library("user", "libx.so.1");
    library("program", "libx.so user");
    read_all("program");
    assert_files("program libx.so user", "libx.so user program");
}

static void a_library_that_is_missing_is_told_with_who_needs_it(void **state)
{
    (void)state;
    struct err e;
    err_clear(&e);
    library("user", "libnone.so.3");
    library("program", "user");
    assert_false(files_read(t, path_of("program"), &e));
    assert_int_equal(e.kind, ERR_DATA);
    assert_non_null(strstr(e.text, "libnone.so.3"));
    assert_string_equal(strrchr(e.file, '/'), "/user");
    /* and one that is there, but damaged */
    FILE *out = fopen(path_of("libnone.so.3"), "wb");
    fputs("no object at all, whatever its name says, though long enough for a header of one", out);
    fclose(out);
    forget();
    err_clear(&e);
    assert_false(files_read(t, path_of("program"), &e));
    assert_int_equal(e.kind, ERR_DATA);
    assert_non_null(strstr(e.text, "no ELF file"));
}

static void as_many_libraries_as_there_is_room_for(void **state)
{
    (void)state;
    char needed[400] = "", name[16];
    for (int i = 1; i < LOADER_FILES; i++) {
        snprintf(name, sizeof name, "l%d", i);
        library(name, "");
        snprintf(needed + strlen(needed), sizeof needed - strlen(needed), " %s", name);
    }
    library("program", needed);
    read_all("program");
    assert_int_equal(t->nfile, LOADER_FILES);
    struct err e;
    err_clear(&e);
    library("one-more", "");
    library("l31", "one-more");
    forget();
    assert_false(files_read(t, path_of("program"), &e));
    assert_int_equal(e.kind, ERR_DATA);
    assert_non_null(strstr(e.text, "more than 31 libraries"));
}

static void what_is_the_hosts_is_no_library_of_ranks(void **state)
{
    (void)state;
    static const char *const host[] = {"libc.so.6",   "libm.so.6",  "ld-linux-x86-64.so.2",
                                       "libdl.so.2",  "librt.so.1", "libpthread.so.0",
                                       "libmvec.so.1"},
                             *const rank[] = {"libstdc++.so.6", "libgfortran.so.5", "libgcc_s.so.1",
                                              "libc.so",        "libc.so.60",       "",
                                              "/lib/libc.so.6"};
    for (int i = 0; i < 7; i++) {
        assert_true(library_of_host(host[i]));
        assert_false(library_of_host(rank[i]));
    }
}

/* Text that lies behind data, with or without constants between them, would be private to each rank
 * and not executed: it is refused. */
static void text_behind_data_is_refused(void **state)
{
    (void)state;
    const unsigned r = PF_R, w = PF_R | PF_W, x = PF_R | PF_X;
    const struct {
        unsigned flags[3];
        bool good;
    } row[] = {{{r, w, w}, true},  {{x, r, w}, true},  {{r, x, w}, true},
               {{w, x, r}, false}, {{w, r, x}, false}, {{r, w, x}, false}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct small s = small_of("", NULL, NULL);
        struct err e;
        err_clear(&e);
        forget();
        /* behind the first one, a page for each; bytes that the file has anyway */
        for (int i = 0; i < 3; i++)
            s.p[2 + i] = (Elf64_Phdr){.p_type = PT_LOAD,
                                      .p_flags = row[k].flags[i],
                                      .p_vaddr = 0x10000 * (uint64_t)(i + 1),
                                      .p_filesz = 64,
                                      .p_memsz = 64,
                                      .p_align = 4096};
        s.h.e_phnum = 5;
        write_small("program", &s);
        if (files_read(t, path_of("program"), &e) != row[k].good)
            fail_msg("row %d: %s", (int)k, e.text);
        if (!row[k].good) assert_non_null(strstr(e.text, "text behind data"));
    }
}

/* ---- crashes ---- */

static void each_crash_has_its_sentence(void **state)
{
    (void)state;
    static const struct {
        int kind, signal, code, rank;
        uint64_t address;
        int64_t now_ps, stack_bytes;
        double seconds;
        const char *text;
    } row[] = {
        {CRASH_SIGNAL, SIGSEGV, SEGV_MAPERR, 3, 0x10, -1, 0, 0,
         "rank 3: segmentation fault at address 0x10"},
        {CRASH_SIGNAL, SIGSEGV, SI_KERNEL, 0, 0, 0, 0, 0,
         "rank 0: segmentation fault at an address that is no address after 0 s of simulated time"},
        {CRASH_SIGNAL, SIGBUS, 0, 12, 0xffffffffffffffff, 1500000000000, 0, 0,
         "rank 12: bus error at address 0xffffffffffffffff after 1.5 s of simulated time"},
        {CRASH_SIGNAL, SIGFPE, FPE_INTDIV, 1, 0, 1, 0, 0,
         "rank 1: whole-number division by zero after 1e-12 s of simulated time"},
        {CRASH_SIGNAL, SIGFPE, FPE_FLTINV, 1, 0, -1, 0, 0, "rank 1: arithmetic error (SIGFPE)"},
        {CRASH_SIGNAL, SIGILL, 0, 1, 0, -1, 0, 0, "rank 1: illegal instruction"},
        {CRASH_SIGNAL, SIGABRT, 0, -1, 0, -1, 0, 0,
         "outside of the ranks' programs: abort, by the C library or by the simulator itself"},
        {CRASH_STACK, SIGSEGV, 0, 7, 0x1000, -1, 65536, 0,
         "rank 7: stack overflow (address 0x1000) of a stack of 64 KiB, which .stack_bytes of a "
         "kernel makes larger,"},
        {CRASH_HOST_TIME, 0, 0, 2, 0, -1, 0, 0.25,
         "rank 2: still busy after 0.25 s of processor time of the host, which is the limit"},
    };
    struct crash_record *r = crash_record_create();
    char text[600];
    assert_non_null(r);
    assert_false(crash_text(r, text, sizeof text));
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        r->signal = row[k].signal, r->code = row[k].code, r->rank = row[k].rank;
        r->address = row[k].address, r->now_ps = row[k].now_ps;
        r->stack_bytes = row[k].stack_bytes, r->seconds = row[k].seconds;
        atomic_store(&r->kind, row[k].kind);
        assert_true(crash_text(r, text, sizeof text));
        assert_string_equal(text, row[k].text);
        /* what there is no room for is left out, and nothing is written behind it */
        char small[20];
        memset(small, 'x', sizeof small);
        assert_true(crash_text(r, small, 12));
        assert_int_equal(strlen(small), 11);
        assert_memory_equal(small, row[k].text, 11);
        assert_int_equal(small[12], 'x');
    }
    crash_record_clear(r);
    assert_false(crash_text(r, text, sizeof text));
    crash_record_destroy(r);
    crash_record_destroy(NULL);
}

/* Of places that nobody knows a line of the innermost one is told. */
static void a_crash_is_where_its_innermost_place_is(void **state)
{
    (void)state;
    struct crash_record *r = crash_record_create();
    char text[600];
    assert_non_null(r);
    r->signal = SIGILL, r->rank = 3, r->now_ps = -1;
    for (int k = 0; k < CRASH_FRAMES; k++) {
        snprintf(r->frame[k].file, sizeof r->frame[k].file, "/no/such/lib%d.so", k);
        r->frame[k].address = 0x20 + (uint64_t)k;
    }
    static const char *const wanted[] = {"rank 3: illegal instruction",
                                         "rank 3 in lib0.so+0x20: illegal instruction",
                                         "rank 3 in lib0.so+0x20: illegal instruction"};
    for (int n = 0; n < 3; n++) {
        r->nframe = n;
        atomic_store(&r->kind, CRASH_SIGNAL);
        assert_true(crash_text(r, text, sizeof text));
        assert_string_equal(text, wanted[n]);
    }
    crash_record_destroy(r);
}

static void a_place_without_a_file_is_a_number_in_it(void **state)
{
    (void)state;
    char text[100];
    assert_false(place_text("/no/such/libx.so", 0x1c, text, sizeof text));
    assert_string_equal(text, "libx.so+0x1c");
    assert_false(place_text("libx.so", UINT64_MAX, text, 8));
    assert_string_equal(text, "libx.so");
}

/* What a child leaves in the record as it ends, and with which status. */
enum ending { TELLS, TELLS_LONG, RAISES, BUSY, GUARDED_NO_MORE, ENDINGS };

static _Noreturn void child(enum ending how, struct crash_record *r)
{
    struct err e;
    char text[2 * CRASH_TOLD_BYTES];
    memset(text, 'y', sizeof text);
    text[sizeof text - 1] = '\0';
    /* the system's own report of an abort, and no core file */
    if (freopen("/dev/null", "w", stderr) == NULL) _exit(1);
    err_clear(&e);
    if (!crash_guard_begin(r, &e) || crash_record_of_process() != r) _exit(2);
    switch (how) {
    case TELLS:
        crash_told(r, "all is lost");
    case TELLS_LONG:
        crash_told(r, text);
    case RAISES:
        raise(SIGFPE);
        break;
    case BUSY:
        crash_limit(0.02);
        for (volatile unsigned long i = 0;; i++) continue;
    default:
        crash_guard_end();
        if (crash_record_of_process() != NULL) _exit(3);
    }
    _exit(0);
}

static void a_child_leaves_what_its_parent_tells(void **state)
{
    (void)state;
    struct crash_record *r = crash_record_create();
    for (int how = 0; how < ENDINGS; how++) {
        char text[600];
        int status;
        crash_record_clear(r);
        const pid_t pid = fork();
        if (pid == 0) child((enum ending)how, r);
        assert_int_equal(waitpid(pid, &status, 0), pid);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), how == GUARDED_NO_MORE ? 0 : CRASH_STATUS);
        assert_int_equal(crash_text(r, text, sizeof text), how != GUARDED_NO_MORE);
        if (how == TELLS) assert_string_equal(text, "all is lost");
        if (how == TELLS_LONG) assert_int_equal(strspn(text, "y"), CRASH_TOLD_BYTES - 1);
        if (how == RAISES)
            assert_string_equal(text, "outside of the ranks' programs: arithmetic error (SIGFPE)");
        if (how == BUSY) assert_non_null(strstr(text, "still busy after 0.02 s of processor time"));
    }
    crash_record_destroy(r);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(libraries_are_searched_breadth_first_and_begin_before_their_users),
        TEST(any_graph_is_put_in_order),
        TEST(a_library_is_looked_for_where_it_is_said_to_be),
        TEST(a_library_with_two_names_is_read_once),
        TEST(a_library_that_is_missing_is_told_with_who_needs_it),
        TEST(as_many_libraries_as_there_is_room_for),
        TEST(what_is_the_hosts_is_no_library_of_ranks),
        TEST(text_behind_data_is_refused),
        cmocka_unit_test(each_crash_has_its_sentence),
        cmocka_unit_test(a_crash_is_where_its_innermost_place_is),
        cmocka_unit_test(a_place_without_a_file_is_a_number_in_it),
        cmocka_unit_test(a_child_leaves_what_its_parent_tells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

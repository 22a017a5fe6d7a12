/* test_image.c - where the bytes of a program and its library lie, which addresses are whose, and
 * what names mean. */
#include <dlfcn.h>
#include <elf.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "made_program.h"

enum { TLS_BYTES = 40 };

/* ---- where things lie ---- */

static void files_lie_one_behind_the_other(void **state)
{
    (void)state;
    program->file[0].elf.tls = (Elf64_Phdr){.p_memsz = 24, .p_align = 8};
    program->file[1].elf.tls = (Elf64_Phdr){.p_memsz = TLS_BYTES, .p_align = 64};
    /* the library begins at its second page */
    for (int i = 0; i < 2; i++) program->file[1].elf.segment[i].p_vaddr += 0x1000;
    made_image();
    const struct loader_file *a = &program->file[0], *b = &program->file[1];
    assert_int_equal(a->begin, 0);
    assert_int_equal(a->place, 0);
    assert_int_equal(a->data, DATA);
    assert_int_equal(a->end, DATA + 0x2000); /* pages that the file fills */
    assert_int_equal(a->memory_end, DATA + 0x4000);
    assert_int_equal(b->begin, a->memory_end);
    assert_int_equal(b->place + 0x1000, b->begin);
    assert_int_equal(b->data, b->begin + DATA);
    assert_int_equal(program->size, b->end);
    /* thread-locals behind all files, each with its alignment, 16 at least; whole pages in all */
    assert_int_equal(a->tls % 16, 0);
    assert_int_equal(b->tls % 64, 0);
    assert_true(a->tls >= b->memory_end && b->tls >= a->tls + 24);
    assert_int_equal(program->stride % LOADER_PAGE, 0);
    assert_true(program->stride >= b->tls + TLS_BYTES &&
                program->stride < b->tls + TLS_BYTES + LOADER_PAGE);
    for (int i = 0; i < 2; i++) {
        const uint64_t shift = i == 0 ? 0 : 0x1000;
        assert_memory_equal(program->bytes + program->file[i].place + shift, made[i].bytes,
                            TEXT_BYTES);
        assert_memory_equal(program->bytes + program->file[i].place + shift + DATA,
                            made[i].bytes + DATA, DATA_BYTES);
    }
}

/* Data in two segments, as linkers make it for constants that are write-protected later: all is
 * data from the first one on. */
static void data_begins_with_its_first_segment(void **state)
{
    (void)state;
    struct elf_file *f = &program->file[1].elf;
    f->segment[2] = f->segment[1];
    f->segment[1].p_filesz = f->segment[1].p_memsz = 0x800;
    f->segment[2].p_vaddr += 0x2000, f->segment[2].p_offset += 0x1000;
    f->segment[2].p_filesz = 0x100;
    f->nsegment = 3;
    made_image();
    const struct loader_file *b = &program->file[1];
    assert_int_equal(b->data, b->begin + DATA);
    assert_int_equal(b->end, b->begin + DATA + 0x3000);
    assert_int_equal(b->memory_end, b->begin + DATA + 0x2000 + DATA_MEMORY);
    assert_memory_equal(program->bytes + b->place + DATA + 0x2000, made[1].bytes + DATA + 0x1000,
                        0x100);
}

static void data_is_what_may_be_written(void **state)
{
    (void)state;
    made_image();
    const struct {
        uint64_t address, size;
        bool writable;
    } row[] = {
        {DATA, 8, true},
        {DATA - 1, 8, false},
        {DATA - 8, 8, false},
        {0, 8, false},
        {TEXT_BYTES - 8, 8, false},
        {DATA + DATA_BYTES - 8, 8, true},
        {DATA, 0x2000, true},
        {DATA, 0x2001, false},
        {DATA + 0x2000 - 8, 8, true},
        {DATA + 0x2000 - 7, 8, false}, /* runs into zeroed memory */
        {DATA + 0x2000, 8, false},
        {DATA + 8, UINT64_MAX - 4, false},
        {UINT64_MAX - 3, 8, false},
    };
    for (int i = 0; i < 2; i++)
        for (size_t k = 0; k < sizeof row / sizeof *row; k++)
            if (image_writable(&program->file[i], program->file[i].place + row[k].address,
                               row[k].size) != row[k].writable)
                fail_msg("file %d, row %d", i, (int)k);
    static const struct {
        uint64_t address;
        bool code;
    } code[] = {{0, true},     {TEXT_BYTES - 1, true}, {TEXT_BYTES, false},
                {DATA, false}, {DATA - 1, false},      {UINT64_MAX, false}};
    for (size_t k = 0; k < sizeof code / sizeof *code; k++)
        assert_int_equal(image_code(&program->file[1].elf, code[k].address), code[k].code);
}

/* Any address is that of the rank and file whose pages it is in. */
static void addresses_tell_rank_and_file(void **state)
{
    (void)state;
    struct random r = random_make(2, 0, 0);
    made_image();
    char *memory = (char *)(uintptr_t)0x7000000000;
    const char *file;
    uint64_t at;
    int rank;
    assert_false(loader_find_address(program, memory, &rank, &file, &at)); /* nothing is reserved */
    program->nrank = 5;
    program->memory_of_ranks = memory;
    for (int k = 0; k < 2000; k++) {
        const int64_t offset =
            (int64_t)random_below(&r, 7 * program->stride) - (int64_t)program->stride;
        int wanted_rank = -1, wanted_file = -1;
        for (int p = 0; p < 5; p++)
            for (int i = 0; i < 2; i++) {
                const int64_t first =
                    (int64_t)(program->stride * (uint64_t)p + program->file[i].begin);
                if (offset >= first && offset < first + (int64_t)(program->file[i].memory_end -
                                                                  program->file[i].begin))
                    wanted_rank = p, wanted_file = i;
            }
        const bool found = loader_find_address(program, memory + offset, &rank, &file, &at);
        assert_int_equal(found, wanted_rank >= 0);
        if (!found) continue;
        assert_int_equal(rank, wanted_rank);
        assert_string_equal(file, program->file[wanted_file].elf.path);
        assert_int_equal(at, (uint64_t)offset - program->stride * (uint64_t)rank -
                                 program->file[wanted_file].place);
    }
    /* the ends, to the byte */
    assert_true(loader_find_address(program, memory, NULL, &file, &at));
    assert_false(loader_find_address(program, memory - 1, NULL, &file, &at));
    assert_false(loader_find_address(program, memory + 5 * program->stride, NULL, &file, &at));
    program->memory_of_ranks = NULL;
}

/* ---- what names mean ---- */

static void names_are_searched_in_order(void **state)
{
    (void)state;
    struct found s;
    const size_t both = made_variable(0, "both", DATA), theirs = made_variable(1, "both", DATA + 8),
                 needs = made_unknown(0, "there", STB_GLOBAL),
                 there = made_variable(1, "there", DATA + 16),
                 local = made_symbol(1, "both", STB_LOCAL, STT_OBJECT, 1, DATA + 24),
                 shown = made_variable(1, "shown", DATA + 32),
                 old = made_variable(1, "old", DATA + 40),
                 hidden = made_variable(1, "hidden", DATA + 48),
                 weak = made_symbol(1, "weak", STB_WEAK, STT_FUNC, 1, 0x20),
                 unique = made_symbol(1, "unique", STB_GNU_UNIQUE, STT_OBJECT, 1, DATA + 56);
    const size_t ask_old = made_unknown(0, "old", STB_WEAK),
                 ask_hidden = made_unknown(0, "hidden", STB_WEAK),
                 ask_weak = made_unknown(0, "weak", STB_GLOBAL),
                 ask_unique = made_unknown(0, "unique", STB_GLOBAL),
                 nobody = made_unknown(0, "nobody_at_all", STB_GLOBAL),
                 nobody_weak = made_unknown(0, "nobody_at_all", STB_WEAK);
    made[1].symbol[shown].st_other = STV_PROTECTED;
    made[1].symbol[hidden].st_other = STV_HIDDEN;
    made[1].version[old] |= 0x8000;
    made_variable(0, "shown", DATA + 64);
    made_image();
    const struct {
        int file;
        size_t number;
        int in; /* file that defines it */
        uint64_t value;
    } row[] = {
        {0, both, 0, DATA},        {1, theirs, 0, DATA}, /* the program's goes before */
        {0, needs, 1, DATA + 16},  {1, there, 1, DATA + 16},  {1, local, 1, DATA + 24},
        {1, shown, 1, DATA + 32}, /* its own, whoever else has it */
        {1, hidden, 1, DATA + 48}, {0, ask_weak, 1, 0x20},    {0, ask_unique, 1, DATA + 56},
        {1, weak, 1, 0x20},        {1, unique, 1, DATA + 56}, {1, old, 1, DATA + 40},
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        assert_true(symbols_find(program, &program->file[row[k].file], row[k].number, &s));
        if (s.file != &program->file[row[k].in] || s.symbol->st_value != row[k].value)
            fail_msg("row %d", (int)k);
    }
    /* what is not offered to others: weak asks get 0, other asks nothing */
    assert_true(symbols_find(program, &program->file[0], ask_old, &s) && !s.file && !s.address);
    assert_true(symbols_find(program, &program->file[0], ask_hidden, &s) && !s.file && !s.address);
    assert_true(symbols_find(program, &program->file[0], nobody_weak, &s) && !s.file && !s.address);
    assert_false(symbols_find(program, &program->file[0], nobody, &s));
    assert_true(symbols_find(program, &program->file[0], 0, &s) && !s.file && !s.address);
    /* a file that asks for its own symbols first gets them */
    program->file[1].elf.symbolic = true;
    assert_true(symbols_find(program, &program->file[1], theirs, &s) &&
                s.file == &program->file[1]);
    assert_null(symbols_defined(program, "nobody_at_all").file);
    assert_ptr_equal(symbols_defined(program, "both").file, &program->file[0]);
    assert_null(symbols_defined(program, "").file);
}

/* A name that no file defines is the host's; one with the host's prefix always. */
static void the_hosts_names_come_last(void **state)
{
    (void)state;
    struct found s;
    made_variable(1, "memcpy", DATA);
    const size_t length = made_unknown(0, "strlen", STB_GLOBAL),
                 copy = made_unknown(0, "memcpy", STB_GLOBAL),
                 of_host = made_unknown(0, "mimdsim_libc_memcpy", STB_GLOBAL),
                 sine = made_unknown(0, "sin", STB_WEAK),
                 memory = made_unknown(0, "malloc", STB_GLOBAL);
    made_image();
    assert_true(symbols_find(program, &program->file[0], length, &s) && !s.file);
    assert_ptr_equal(s.address, dlsym(program->host[0], "strlen"));
    assert_true(symbols_find(program, &program->file[0], copy, &s) && s.file == &program->file[1]);
    assert_true(symbols_find(program, &program->file[0], of_host, &s) && !s.file);
    assert_ptr_equal(s.address, dlsym(program->host[0], "memcpy"));
    /* of the library of mathematics; and weak or not, it is found */
    assert_true(symbols_find(program, &program->file[0], sine, &s));
    assert_ptr_equal(s.address, dlsym(program->host[1], "sin"));
    /* memory is the process's, whoever provides it */
    assert_true(symbols_find(program, &program->file[0], memory, &s));
    assert_ptr_equal(s.address, dlsym(RTLD_DEFAULT, "malloc"));
}

/* Functions that choose a function are names like others; sections, files and types that nobody
 * knows are not. */
static void only_what_can_be_used_is_offered(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int type;
        bool offered;
    } row[] = {{"object", STT_OBJECT, true},     {"function", STT_FUNC, true},
               {"chooser", STT_GNU_IFUNC, true}, {"local_of_thread", STT_TLS, true},
               {"untyped", STT_NOTYPE, true},    {"strange", 8, false},
               {"stranger", STT_HIPROC, false}};
    const size_t n = sizeof row / sizeof *row;
    for (size_t i = 0; i < n; i++) made_symbol(1, row[i].name, STB_GLOBAL, row[i].type, 1, 16);
    made_symbol(1, "missing_chooser", STB_GLOBAL, STT_GNU_IFUNC, SHN_UNDEF, 0);
    made_symbol(1, "far", STB_GLOBAL, STT_OBJECT, 1, UINT64_C(1) << 46);
    made_image();
    for (size_t i = 0; i < n; i++)
        assert_int_equal(symbols_defined(program, row[i].name).file != NULL, row[i].offered);
    assert_null(symbols_defined(program, "missing_chooser").file);
    assert_null(symbols_defined(program, "far").file);
}

/* Of a name with several versions the host gives the one that is asked for. */
static void the_version_that_was_linked_is_the_one(void **state)
{
    (void)state;
    struct found s;
    struct {
        Elf64_Verneed need;
        Elf64_Vernaux aux;
    } table = {{1, 1, 0, sizeof table.need, 0}, {0, 0, 2, 0, 0}};
    const size_t old = made_unknown(0, "memcpy", STB_GLOBAL),
                 any = made_unknown(0, "memcpy", STB_GLOBAL);
    /* the version's name stands in the table of names */
    made_unknown(0, "GLIBC_2.2.5", STB_WEAK);
    table.aux.vna_name = made[0].symbol[3].st_name;
    struct elf_file *f = &program->file[0].elf;
    /* in the text, whose addresses are offsets, where a word may begin */
    f->verneed = 64 - (uintptr_t)made[0].bytes % 4;
    f->nverneed = 1;
    memcpy(made[0].bytes + f->verneed, &table, sizeof table);
    made[0].version[old] = 2;
    made_image();
    assert_true(symbols_find(program, &program->file[0], old, &s));
    assert_ptr_equal(s.address, dlvsym(program->host[0], "memcpy", "GLIBC_2.2.5"));
    assert_true(symbols_find(program, &program->file[0], any, &s));
    assert_ptr_equal(s.address, dlsym(program->host[0], "memcpy"));
    assert_ptr_not_equal(s.address, dlvsym(program->host[0], "memcpy", "GLIBC_2.2.5"));
}

/* The host's further libraries are opened as they are needed, as many as there is room for; and
 * thread-locals are found by the block that stands for their module. */
static void the_hosts_libraries_are_opened_as_needed(void **state)
{
    struct found s;
    struct err e;
    const size_t sines = made_unknown(0, "_ZGVbN2v_sin", STB_GLOBAL),
                 local = made_unknown(0, "__tls_get_addr", STB_GLOBAL);
    program->file[1].elf.needed[0] = "libother.so";
    program->file[1].elf.needed[1] = "libmvec.so.1";
    program->file[1].elf.nneeded = 2;
    made_image();
    assert_int_equal(program->nhost, 3);
    assert_true(symbols_find(program, &program->file[0], sines, &s));
    assert_ptr_equal(s.address, dlsym(program->host[2], "_ZGVbN2v_sin"));
    assert_true(symbols_find(program, &program->file[0], local, &s));
    void *(*get)(const uint64_t *) = (void *(*)(const uint64_t *))s.address;
    assert_ptr_equal(get((const uint64_t[]){0x1000, 0x18}), (void *)0x1018);
    made_end(state);
    made_begin(state);
    for (int k = 0; k < LOADER_HOST_LIBRARIES - 2; k++)
        program->file[0].elf.needed[k] = "libmvec.so.1";
    program->file[0].elf.nneeded = LOADER_HOST_LIBRARIES - 2;
    err_clear(&e);
    assert_true(symbols_make(program, &e));
    assert_int_equal(program->nhost, LOADER_HOST_LIBRARIES);
    symbols_give_back(program);
    program->file[0].elf.needed[LOADER_HOST_LIBRARIES - 2] = "libmvec.so.1";
    program->file[0].elf.nneeded++;
    assert_false(symbols_make(program, &e));
    assert_int_equal(e.kind, ERR_INTERNAL);
    assert_non_null(strstr(e.text, "too many"));
}

/* More names than one table has room for at first, many of them alike. */
static void thousands_of_names_are_found(void **state)
{
    enum { MANY = 3000 };
    (void)state;
    Elf64_Sym *symbols = calloc(MANY + 1, sizeof *symbols);
    char *strings = calloc(MANY + 1, 16);
    for (int i = 1; i <= MANY; i++) {
        snprintf(strings + 16 * i, 16, "v%d", i * 16 % 2999);
        symbols[i] = (Elf64_Sym){.st_name = (Elf64_Word)(16 * i),
                                 .st_info = ELF64_ST_INFO(STB_GLOBAL, STT_OBJECT),
                                 .st_shndx = 1,
                                 .st_value = (uint64_t)i};
    }
    struct elf_file *f = &program->file[1].elf;
    f->symbol = symbols, f->strings = strings, f->nsymbol = MANY + 1, f->version = NULL;
    made_image();
    for (int i = 1; i <= MANY; i++) {
        char name[16];
        snprintf(name, sizeof name, "v%d", i * 16 % 2999);
        const struct found s = symbols_defined(program, name);
        /* the last one has the name of the first */
        assert_ptr_equal(s.symbol, &symbols[i == MANY ? 1 : i]);
    }
    assert_null(symbols_defined(program, "v2999").file);
    free(symbols);
    free(strings);
}

/* ---- calls ---- */

/* In front of a return address stands a call: by a distance, or through a register or memory (Intel
 * SDM 2, CALL: E8, FF /2 with each form of its operand). */
static void a_return_address_has_a_call_before_it(void **state)
{
    (void)state;
    static const struct {
        int n;
        unsigned char code[8];
        bool call;
    } row[] = {
        {5, {0xe8, 1, 2, 3, 4}, true},                /* call rel32 */
        {2, {0xff, 0xd0}, true},                      /* call *%rax */
        {2, {0xff, 0x13}, true},                      /* call *(%rbx) */
        {3, {0x41, 0xff, 0xd3}, true},                /* call *%r11 */
        {3, {0xff, 0x50, 0x18}, true},                /* call *24(%rax) */
        {4, {0x41, 0xff, 0x57, 0x10}, true},          /* call *16(%r15) */
        {6, {0xff, 0x15, 9, 9, 0, 0}, true},          /* call *x(%rip) */
        {6, {0xff, 0x90, 0x80, 1, 0, 0}, true},       /* call *384(%rax) */
        {3, {0xff, 0x14, 0x24}, true},                /* call *(%rsp) */
        {4, {0xff, 0x54, 0x24, 8}, true},             /* call *8(%rsp) */
        {7, {0xff, 0x14, 0xc5, 0, 0x10, 0, 0}, true}, /* call *table(,%rax,8) */
        {7, {0xff, 0x94, 0x24, 0x90, 0, 0, 0}, true}, /* call *144(%rsp) */
        {5, {0xe9, 1, 2, 3, 4}, false},               /* jmp */
        {2, {0xff, 0xe0}, false},                     /* jmp *%rax */
        {3, {0x41, 0xff, 0xe3}, false},               /* jmp *%r11 */
        {3, {0x41, 0xff, 0xc3}, false},               /* inc %r11d */
        {3, {0x48, 0x89, 0xc8}, false},               /* mov */
        {1, {0xc3}, false},                           /* ret */
    };
    struct loader_instance *i = aligned_alloc(64, sizeof *i);
    made_image();
    memset(i, 0, sizeof *i);
    i->t = program;
    i->base = program->bytes;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        unsigned char *at = (unsigned char *)program->bytes + program->file[1].begin + 0x100;
        memset(at - 16, 0x90, 16);
        memcpy(at - row[k].n, row[k].code, (size_t)row[k].n);
        if (loader_is_return(i, at) != row[k].call) fail_msg("row %d", (int)k);
    }
    /* the same bytes are no code in data, before the text, and outside of the files */
    unsigned char *data = (unsigned char *)program->bytes + program->file[1].begin + DATA + 0x100;
    data[-5] = 0xe8;
    assert_false(loader_is_return(i, data));
    assert_false(loader_is_return(i, program->bytes));
    assert_false(loader_is_return(i, program->bytes - 1));
    assert_false(loader_is_return(i, NULL));
    free(i);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, made_begin, made_end)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(data_begins_with_its_first_segment),
        TEST(only_what_can_be_used_is_offered),
        TEST(the_version_that_was_linked_is_the_one),
        TEST(the_hosts_libraries_are_opened_as_needed),
        TEST(files_lie_one_behind_the_other),
        TEST(data_is_what_may_be_written),
        TEST(addresses_tell_rank_and_file),
        TEST(names_are_searched_in_order),
        TEST(the_hosts_names_come_last),
        TEST(thousands_of_names_are_found),
        TEST(a_return_address_has_a_call_before_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

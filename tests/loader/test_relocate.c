/* test_relocate.c - what every kind of relocation writes (psABI 4.4, table 4.9) into a program made
 * here, and which are refused. */
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

static void relocate(void)
{
    struct err e;
    err_clear(&e);
    made_image();
    if (!relocate_all(program, &e)) fail_msg("%s", e.text);
}

static uint64_t word_at(int file, uint64_t address)
{
    uint64_t word;
    memcpy(&word, program->bytes + program->file[file].place + address, sizeof word);
    return word;
}

static bool is_relative(int file, uint64_t address)
{
    for (size_t i = 0; i < program->nrelative; i++)
        if (program->relative[i] == program->file[file].place + address) return true;
    return false;
}

/* ---- what relocations write ---- */

/* What a written word is counted from. */
enum from { NOTHING, PROGRAM, LIBRARY, THREAD_LOCALS, STRLEN };

/* A relocation, and the word that it leaves. */
struct row {
    int file;
    unsigned type;
    uint64_t at;
    size_t symbol;
    int64_t addend;
    enum from from;
    int64_t value;
    bool relative;
};

static uint64_t value_of(const struct row *r)
{
    const uint64_t from[] = {[PROGRAM] = program->file[0].place,
                             [LIBRARY] = program->file[1].place,
                             [THREAD_LOCALS] = program->file[1].tls,
                             [STRLEN] = (uint64_t)(uintptr_t)dlsym(program->host[0], "strlen")};
    return from[r->from] + (uint64_t)r->value;
}

static void every_relocation_writes_its_formula(void **state)
{
    (void)state;
    program->file[1].elf.tls = (Elf64_Phdr){.p_memsz = 40, .p_align = 8};
    const size_t x = made_variable(0, "x", DATA + 0x20), other = made_unknown(1, "x", STB_GLOBAL),
                 fixed = made_symbol(0, "fixed", STB_GLOBAL, STT_OBJECT, SHN_ABS, 0x1234),
                 weak = made_unknown(0, "nobody_at_all", STB_WEAK),
                 host = made_unknown(0, "strlen", STB_GLOBAL),
                 chosen = made_symbol(0, "chosen", STB_GLOBAL, STT_GNU_IFUNC, 1, 0x40),
                 local = made_symbol(1, "own", STB_GLOBAL, STT_TLS, 1, 12),
                 of_library = made_unknown(0, "own", STB_GLOBAL);
    const struct row row[] = {
        {0, R_X86_64_RELATIVE, DATA, 0, 0x777, PROGRAM, 0x777, true},
        {0, R_X86_64_64, DATA + 8, x, -4, PROGRAM, DATA + 0x1c, true},
        {0, R_X86_64_GLOB_DAT, DATA + 16, x, 99, PROGRAM, DATA + 0x20, true}, /* no addend */
        {0, R_X86_64_JUMP_SLOT, DATA + 24, x, 99, PROGRAM, DATA + 0x20, true},
        {0, R_X86_64_64, DATA + 32, fixed, 6, NOTHING, 0x123a, false},
        {0, R_X86_64_64, DATA + 40, weak, 5, NOTHING, 5, false},
        {0, R_X86_64_64, DATA + 48, host, 2, STRLEN, 2, false},
        {0, R_X86_64_GLOB_DAT, DATA + 56, chosen, 0, NOTHING, 0, false},
        {0, R_X86_64_IRELATIVE, DATA + 64, 0, 0x50, NOTHING, 0, false},
        /* not even a look at its place: what stands there stays */
        {0, R_X86_64_NONE, DATA + 88, 999, 1, NOTHING, 0, false},
        {0, R_X86_64_DTPMOD64, DATA + 72, of_library, 0, THREAD_LOCALS, 0, true},
        {0, R_X86_64_DTPOFF64, DATA + 80, of_library, 3, NOTHING, 15, false},
        {1, R_X86_64_64, DATA, other, 1, PROGRAM, DATA + 0x21, true},
        /* local dynamic: this file's own block; places need no alignment */
        {1, R_X86_64_DTPMOD64, DATA + 8, 0, 0, THREAD_LOCALS, 0, true},
        {1, R_X86_64_DTPOFF64, DATA + 16, local, 0, NOTHING, 12, false},
        {1, R_X86_64_RELATIVE, DATA + 0x1003, 0, 0x10, LIBRARY, 0x10, true}};
    const size_t n = sizeof row / sizeof *row;
    for (size_t k = 0; k < n; k++)
        made_relocation(row[k].file, row[k].type, row[k].at, row[k].symbol, row[k].addend);
    relocate();
    size_t nrelative = 0;
    for (size_t k = 0; k < n; k++) {
        nrelative += row[k].relative;
        if (word_at(row[k].file, row[k].at) != value_of(&row[k]) ||
            is_relative(row[k].file, row[k].at) != row[k].relative)
            fail_msg("row %d: %#llx", (int)k, (unsigned long long)word_at(row[k].file, row[k].at));
    }
    assert_int_equal(program->nrelative, nrelative);
    for (size_t i = 1; i < program->nrelative; i++)
        assert_true(program->relative[i] > program->relative[i - 1]);
    /* what code of the rank is asked for */
    assert_int_equal(program->nindirect, 2);
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(program->indirect[i].place, program->file[0].place + DATA + 56 + 8 * i);
        assert_int_equal(program->indirect[i].resolver, program->file[0].place + 0x40 + 0x10 * i);
    }
}

/* Packed ones: written here by the rule of the format, from a set of addresses. */
static void packed_relocations_are_unpacked(void **state)
{
    for (uint64_t seed = 1; seed <= 20; seed++) {
        bool in[DATA_BYTES / 8] = {false};
        struct random r = random_make(seed, 0, 0);
        if (seed > 1) {
            made_end(state);
            made_begin(state);
        }
        for (int k = 0; k < DATA_BYTES / 8; k++) {
            const uint64_t value = random_below(&r, 1 << 20);
            in[k] = random_below(&r, 16) < 1 + seed % 16 && (k < 100 || k > 300);
            memcpy(made[1].bytes + DATA + 8 * k, &value, sizeof value);
        }
        /* an address, then bitmaps of 63 words each while there are some; then anew */
        size_t n = 0;
        for (int k = 0; k < DATA_BYTES / 8 && n < 16;) {
            if (!in[k]) {
                k++;
                continue;
            }
            made[1].relr[n++] = DATA + 8 * (uint64_t)k++;
            for (bool some = true; some && n < 16;) {
                uint64_t bits = 0;
                for (int i = 0; i < 63 && k + i < DATA_BYTES / 8; i++)
                    bits |= (uint64_t)in[k + i] << (i + 1);
                if ((some = bits != 0)) made[1].relr[n++] = bits | 1, k += 63;
            }
            /* those that found no room are none */
            if (n == 16)
                for (; k < DATA_BYTES / 8; k++) in[k] = false;
        }
        program->file[1].elf.relr = (struct elf_table){made[1].relr, n};
        relocate();
        size_t listed = 0;
        for (int k = 0; k < DATA_BYTES / 8; k++) {
            uint64_t before;
            memcpy(&before, made[1].bytes + DATA + 8 * k, sizeof before);
            listed += in[k];
            assert_int_equal(word_at(1, DATA + 8 * (uint64_t)k),
                             before + (in[k] ? program->file[1].place : 0));
            assert_int_equal(is_relative(1, DATA + 8 * (uint64_t)k), in[k]);
        }
        assert_int_equal(program->nrelative, listed);
    }
}

/* ---- what is refused ---- */

static void wrong_relocations_are_refused_by_name(void **state)
{
    static const struct {
        unsigned type;
        uint64_t at;
        size_t symbol;
        int64_t addend;
        const char *says;
    } row[] = {
        {R_X86_64_RELATIVE, DATA - 8, 0, 0, "outside the data"},
        {R_X86_64_RELATIVE, DATA + 0x2000 - 7, 0, 0, "outside the data"},
        {R_X86_64_RELATIVE, 0, 0, 0, "outside the data"},
        {R_X86_64_RELATIVE, UINT64_MAX - 3, 0, 0, "outside the data"},
        {R_X86_64_64, DATA, 1, 0, "symbol that is not there"},
        {R_X86_64_IRELATIVE, DATA, 0, DATA, "resolver lies outside"},
        {R_X86_64_IRELATIVE, DATA, 0, -1, "resolver lies outside"},
        {R_X86_64_DTPMOD64, DATA, 0, 0, "thread-local of a file that has none"},
        {R_X86_64_TPOFF64, DATA, 0, 0, "initial-exec"},
        {R_X86_64_TLSDESC, DATA, 0, 0, "-mtls-dialect=gnu2"},
        {R_X86_64_COPY, DATA, 0, 0, "copy relocation"},
        {99, DATA, 0, 0, "type 99"},
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct err e;
        err_clear(&e);
        if (k > 0) {
            made_end(state);
            made_begin(state);
        }
        made_relocation(1, row[k].type, row[k].at, row[k].symbol, row[k].addend);
        made_image();
        assert_false(relocate_all(program, &e));
        assert_int_equal(e.kind, ERR_DATA);
        assert_string_equal(e.file, "library.so");
        if (strstr(e.text, row[k].says) == NULL) fail_msg("%d: %s", (int)k, e.text);
    }
    /* packed ones, too: the 63 words behind the last of the data */
    made_end(state);
    made_begin(state);
    made[0].relr[0] = DATA + 0x2000 - 8;
    made[0].relr[1] = 3;
    for (size_t n = 1; n <= 2; n++) {
        struct err e;
        err_clear(&e);
        program->file[0].elf.relr = (struct elf_table){made[0].relr, n};
        if (n == 1) made_image();
        assert_int_equal(relocate_all(program, &e), n == 1);
        if (n == 2) assert_non_null(strstr(e.text, "outside the data"));
    }
}

/* One message names all that is missing, each once, also where one name is a part of another. */
static void all_that_is_missing_is_told(void **state)
{
    (void)state;
    static const char *const name[] = {"longer_name", "name", "longer", "name"};
    struct err e;
    err_clear(&e);
    for (int k = 0; k < 4; k++)
        made_relocation(0, R_X86_64_GLOB_DAT, DATA + 8 * (uint64_t)k,
                        made_unknown(0, name[k], STB_GLOBAL), 0);
    made_image();
    assert_false(relocate_all(program, &e));
    assert_int_equal(e.kind, ERR_DATA);
    const char *list = strstr(e.text, ": ");
    assert_non_null(list);
    assert_string_equal(list + 2, "longer_name, name, longer");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, made_begin, made_end)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(every_relocation_writes_its_formula),
        TEST(packed_relocations_are_unpacked),
        TEST(wrong_relocations_are_refused_by_name),
        TEST(all_that_is_missing_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

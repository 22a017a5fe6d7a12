/* test_damage.c - programs with seeded damage: bytes changed, cut short. Each is loaded or refused
 * with what is wrong, and never crashes the loader. LOADER_DAMAGE in the environment is how many,
 * besides the usual. */
#include <elf.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "loader/loader.h"
#include "support/guests.h"
#include "support/scratch.h"

enum { USUAL = 3000 };

static char folder[256], path[512];
static char *bytes;
static size_t size;

static int make(void **state)
{
    (void)state;
    scratch_make(folder, sizeof folder);
    guests_build(folder, "globals.c", "", path);
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    fseek(in, 0, SEEK_END);
    size = (size_t)ftell(in);
    rewind(in);
    bytes = malloc(size);
    assert_int_equal(fread(bytes, 1, size, in), size);
    fclose(in);
    return 0;
}

static int remove_it(void **state)
{
    (void)state;
    free(bytes);
    scratch_remove(folder);
    return 0;
}

/* Where damage matters: the headers, the dynamic section, the tables that it names, and now and
 * then anywhere. */
static size_t a_place(struct random *r)
{
    const Elf64_Ehdr *h = (const Elf64_Ehdr *)bytes;
    const Elf64_Phdr *p = (const Elf64_Phdr *)(bytes + h->e_phoff);
    size_t begin = 0, n = size;
    switch (random_below(r, 6)) {
    case 0:
        n = sizeof *h;
        break;
    case 1:
        begin = h->e_phoff, n = h->e_phnum * sizeof *p;
        break;
    case 2:
    case 3:
        for (int i = 0; i < h->e_phnum; i++)
            if (p[i].p_type == PT_DYNAMIC) begin = p[i].p_offset, n = p[i].p_filesz;
        break;
    case 4:
        begin = p[0].p_offset, n = p[0].p_filesz;
        break; /* tables of symbols and relocations */
    default:
        break;
    }
    return begin + (size_t)random_below(r, n);
}

static void damage(char *copy, struct random *r)
{
    const int changes = 1 + (int)random_below(r, 4);
    for (int i = 0; i < changes; i++) {
        const size_t at = a_place(r);
        switch (random_below(r, 3)) {
        case 0:
            copy[at] ^= (char)(1 << random_below(r, 8));
            break;
        case 1:
            copy[at] = (char)random_below(r, 256);
            break;
        default:
            /* A whole word at once: zero, all ones, or a large number. */
            if (at / 8 * 8 + 8 > size) break;
            memset(copy + at / 8 * 8, random_below(r, 2) ? 0xff : 0, 8);
            if (random_below(r, 2))
                copy[at / 8 * 8 + random_below(r, 8)] = (char)random_below(r, 256);
        }
    }
}

/* Open, reserve, instantiate; 1 when it is refused. Anything else than a refusal that says why is a
 * failure. */
static int try_it(const char *copy, size_t n, const char *what, long number)
{
    static const struct loader_hooks hooks;
    char file[600];
    struct err e;
    err_clear(&e);
    scratch_path(file, sizeof file, folder, "damaged");
    FILE *out = fopen(file, "wb");
    assert_non_null(out);
    fwrite(copy, 1, n, out);
    fclose(out);
    struct loader_template *t = loader_open(file, &e);
    if (t && loader_reserve(t, 2, &hooks, &e)) loader_instantiate(t, 1, NULL, &e);
    loader_close(t);
    if (e.kind != ERR_NONE && e.kind != ERR_DATA && e.kind != ERR_INTERNAL)
        fail_msg("%s %ld: %s", what, number, e.text);
    if (e.kind != ERR_NONE && !e.text[0]) fail_msg("%s %ld: no text", what, number);
    return e.kind != ERR_NONE;
}

static void damaged_programs_are_refused_or_loaded(void **state)
{
    (void)state;
    const char *more = getenv("LOADER_DAMAGE");
    char *copy = malloc(size);
    int refused = 0, n = more ? atoi(more) : USUAL;
    for (int i = 0; i < n; i++) {
        struct random r = random_make(1, (uint64_t)i, 0);
        memcpy(copy, bytes, size);
        damage(copy, &r);
        refused +=
            try_it(copy, random_below(&r, 20) ? size : (size_t)random_below(&r, size), "seed", i);
    }
    /* Damage to text and constants is the program's own affair; that to tables must be seen. */
    assert_true(refused > n / 3 && refused < n);
    free(copy);
}

/* Each word in turn of the part [begin, begin + n) becomes each of a few numbers that hurt; with
 * `pair`, the next word becomes the same one, as sizes in the file and in memory do. */
static int every_word(char *copy, size_t begin, size_t n, int pair, const char *what)
{
    const uint64_t hurt[] = {0,
                             1,
                             7,
                             8,
                             4096,
                             size - 8,
                             size,
                             size + 8,
                             1u << 31,
                             UINT64_C(1) << 40,
                             UINT64_C(1) << 47,
                             UINT64_MAX - 4095,
                             UINT64_MAX - 7,
                             UINT64_MAX};
    int refused = 0;
    for (size_t at = begin; at + 8 * (size_t)(1 + pair) <= begin + n; at += 8)
        for (size_t k = 0; k < sizeof hurt / sizeof *hurt; k++) {
            memcpy(copy, bytes, size);
            memcpy(copy + at, &hurt[k], 8);
            if (pair) memcpy(copy + at + 8, &hurt[k], 8);
            refused += try_it(copy, size, what, (long)at);
        }
    return refused;
}

static void every_word_of_the_headers_is_checked(void **state)
{
    (void)state;
    const Elf64_Ehdr *h = (const Elf64_Ehdr *)bytes;
    const Elf64_Phdr *p = (const Elf64_Phdr *)(bytes + h->e_phoff);
    char *copy = malloc(size);
    assert_true(every_word(copy, 0, sizeof *h, 0, "header") > 0);
    for (int pair = 0; pair < 2; pair++)
        assert_true(every_word(copy, h->e_phoff, h->e_phnum * sizeof *p, pair, "program header") >
                    0);
    for (int i = 0; i < h->e_phnum; i++)
        if (p[i].p_type == PT_DYNAMIC)
            assert_true(every_word(copy, p[i].p_offset, p[i].p_filesz, 0, "dynamic") > 0);
    free(copy);
}

/* The variable that the loader itself writes, wherever a damaged table says that it is. */
static void the_pointer_to_the_simulator_lies_in_the_data(void **state)
{
    (void)state;
    const Elf64_Ehdr *h = (const Elf64_Ehdr *)bytes;
    const Elf64_Shdr *s = (const Elf64_Shdr *)(bytes + h->e_shoff);
    char *copy = malloc(size);
    int seen = 0;
    for (int i = 0; i < h->e_shnum; i++) {
        if (s[i].sh_type != SHT_DYNSYM) continue;
        const char *names = bytes + s[s[i].sh_link].sh_offset;
        for (size_t at = s[i].sh_offset; at < s[i].sh_offset + s[i].sh_size;
             at += sizeof(Elf64_Sym)) {
            const Elf64_Sym *symbol = (const Elf64_Sym *)(bytes + at);
            if (strcmp(names + symbol->st_name, "mimdsim_host") != 0) continue;
            seen += every_word(copy, at + offsetof(Elf64_Sym, st_value), 8, 0, "symbol");
        }
    }
    /* All of these values but perhaps one are outside of the data. */
    assert_true(seen >= 13);
    free(copy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(damaged_programs_are_refused_or_loaded, make, remove_it),
        cmocka_unit_test_setup_teardown(every_word_of_the_headers_is_checked, make, remove_it),
        cmocka_unit_test_setup_teardown(the_pointer_to_the_simulator_lies_in_the_data, make,
                                        remove_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

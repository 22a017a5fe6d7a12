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

static void damaged_programs_are_refused_or_loaded(void **state)
{
    (void)state;
    static const struct loader_hooks hooks;
    const char *more = getenv("LOADER_DAMAGE");
    char file[600];
    char *copy = malloc(size);
    int refused = 0, n = more ? atoi(more) : USUAL;
    scratch_path(file, sizeof file, folder, "damaged");
    for (int i = 0; i < n; i++) {
        struct random r = random_make(1, (uint64_t)i, 0);
        struct err e;
        err_clear(&e);
        memcpy(copy, bytes, size);
        damage(copy, &r);
        FILE *out = fopen(file, "wb");
        assert_non_null(out);
        fwrite(copy, 1, random_below(&r, 20) ? size : (size_t)random_below(&r, size), out);
        fclose(out);
        struct loader_template *t = loader_open(file, &e);
        if (t && loader_reserve(t, 2, &hooks, &e)) loader_instantiate(t, 1, NULL, &e);
        loader_close(t);
        refused += e.kind != ERR_NONE;
        if (e.kind != ERR_NONE && e.kind != ERR_DATA && e.kind != ERR_INTERNAL)
            fail_msg("seed %d: %s", i, e.text);
        if (e.kind != ERR_NONE && !e.text[0]) fail_msg("seed %d: no text", i);
    }
    /* Damage to text and constants is the program's own affair; that to tables must be seen. */
    assert_true(refused > n / 3 && refused < n);
    free(copy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(damaged_programs_are_refused_or_loaded, make, remove_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* fuzz_elf.c - programs of users as ELF images: refused with a reason, or priced and copied for two
 * ranks. No code of them runs.
 *
 * Changes go where the loader looks: headers, dynamic section, tables. */
#include "fuzz.h"

#include <elf.h>

#include "base/random.h"
#include "loader/loader.h"
#include "loader/price.h"

/* A machine with every price that blocks can have, and one with a price of an instruction. */
static const struct node_cost fine = {.flop = 1000,
                                      .div = 9000,
                                      .sqrt = 9000,
                                      .trig = 40000,
                                      .byte = 60,
                                      .call = 2000,
                                      .instruction = 300,
                                      .issue = 150,
                                      .code_div = 4000,
                                      .code_root = 5000,
                                      .chain = 1300,
                                      .step = 330,
                                      .load = 160,
                                      .whole = 90,
                                      .add = 170,
                                      .multiply = 170,
                                      .fetch = 330,
                                      .window = 200,
                                      .late = 300,
                                      .product = 30},
                              coarse = {.flop = 20000, .div = 200000, .instruction = 6000};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const struct loader_hooks hooks;
    struct err e;
    err_clear(&e);
    struct loader_template *t = loader_open(fuzz_file("image", data, size), &e);
    bool taken = t != NULL && loader_price_blocks(t, &coarse, 1.5, &e) &&
                 loader_price_blocks(t, &fine, 1, &e) && loader_reserve(t, 2, &hooks, &e);
    if (taken) taken = loader_instantiate(t, 1, NULL, &e) != NULL;
    /* a mapping that the system refuses is ERR_INTERNAL */
    if (!taken && e.kind != ERR_INTERNAL) fuzz_refused(&e);
    loader_close(t);
    return 0;
}

/* Where the loader looks, by chance; anywhere in a file that has no headers. */
static size_t a_place(const uint8_t *data, size_t size, struct random *r)
{
    Elf64_Ehdr h;
    Elf64_Phdr p;
    Elf64_Shdr s;
    size_t begin = 0, n = size;
    if (size < sizeof h) return random_below(r, size);
    memcpy(&h, data, sizeof h);
    uint64_t how = random_below(r, 10);
    /* a section's header, or what is in it */
    const uint64_t section = h.e_shoff + random_below(r, h.e_shnum + 1u) * sizeof s;
    if (how >= 8 && h.e_shoff < size && h.e_shnum < 64 && section + sizeof s <= size) {
        memcpy(&s, data + section, sizeof s);
        begin = how == 8 ? section : s.sh_offset;
        n = how == 8 ? sizeof s : s.sh_size;
    }
    if (how == 0) n = sizeof h;
    if (how >= 1 && how <= 4 && h.e_phoff < size && h.e_phnum < 64) {
        uint64_t at = h.e_phoff + random_below(r, h.e_phnum + 1u) * sizeof p;
        if (how == 1) begin = h.e_phoff, n = h.e_phnum * sizeof p;
        if (how > 1 && at + sizeof p <= size) {
            memcpy(&p, data + at, sizeof p);
            if (p.p_type == PT_DYNAMIC || how == 4) begin = p.p_offset, n = p.p_filesz;
        }
    }
    if (begin >= size) begin = 0;
    if (n == 0 || n > size - begin) n = size - begin;
    return begin + random_below(r, n);
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    struct random r = random_make(seed, 0, 0);
    if (size < 8 || random_below(&r, 4) == 0) return LLVMFuzzerMutate(data, size, most);
    const uint64_t hurt[] = {0,
                             1,
                             7,
                             8,
                             24,
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
    const size_t at = a_place(data, size, &r), width = (size_t)1 << random_below(&r, 4);
    uint64_t word = 0;
    if (at + width > size) return size;
    memcpy(&word, data + at / width * width, width);
    switch (random_below(&r, 3)) {
    case 0:
        word = hurt[random_below(&r, sizeof hurt / sizeof *hurt)];
        break;
    case 1:
        word += random_below(&r, 33) - 16;
        break;
    default:
        word ^= UINT64_C(1) << random_below(&r, 8 * width);
    }
    memcpy(data + at / width * width, &word, width);
    return size;
}

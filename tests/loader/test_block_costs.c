/* test_block_costs.c - costs of blocks in a made-up image: values, rounding, and what does not fit.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/progress.h"
#include "base/random.h"
#include "loader/block_costs.h"

/* An image of 256 bytes that begins at address 0x1000: two blocks and a rate, and their table
 * behind them. */
enum { IMAGE_ADDRESS = 0x1000, TABLE_AT = 64, BLOCKS = 3 };

struct image {
    _Alignas(4) unsigned char byte[256];
};

static const int code_at[BLOCKS] = {0, 10, 32}; /* of the instructions, and of the rate's word */

static void *image_at(const void *image, uint64_t address, size_t size)
{
    struct image *i = (struct image *)(uintptr_t)image;
    if (address < IMAGE_ADDRESS || address - IMAGE_ADDRESS + size > sizeof i->byte) return NULL;
    return &i->byte[address - IMAGE_ADDRESS];
}

static struct block_table image_make(struct image *i, const struct block_counts counts[BLOCKS])
{
    memset(i->byte, 0x90, sizeof i->byte);
    struct block_entry *entry = (struct block_entry *)(void *)&i->byte[TABLE_AT];
    for (int k = 0; k < BLOCKS; k++) {
        const enum block_kind kind = k == 2 ? BLOCK_RATE : BLOCK_ADD;
        const int word = code_at[k] + (kind == BLOCK_ADD ? BLOCK_ADD_OPCODE_BYTES : 0);
        if (kind == BLOCK_ADD)
            memcpy(&i->byte[code_at[k]], BLOCK_ADD_OPCODE, BLOCK_ADD_OPCODE_BYTES);
        entry[k] = (struct block_entry){.immediate = word - TABLE_AT - k * (int)sizeof *entry,
                                        .counts = counts[k],
                                        .kind = (uint16_t)kind};
    }
    return (struct block_table){entry, BLOCKS, IMAGE_ADDRESS + TABLE_AT};
}

static const struct block_counts usual[BLOCKS] = {
    {.instruction = 5, .flop = 2, .bytes = 16}, {.instruction = 7}, {.bytes = 2048}};

/* 10 ns a flop, 1 ns an instruction, 2 ns a byte. */
static const struct node_cost node = {.flop = 10000, .instruction = 1000, .byte = 2000};

static int32_t word_at(const struct image *i, int at)
{
    int32_t word;
    memcpy(&word, &i->byte[at], sizeof word);
    return word;
}

static void each_block_gets_its_cost(void **state)
{
    (void)state;
    struct image i;
    struct err e;
    err_clear(&e);
    const struct block_table t = image_make(&i, usual);
    assert_true(block_costs_patch(&t, image_at, &i, &node, 1, &e));
    assert_int_equal(word_at(&i, 3), 20000);
    assert_int_equal(word_at(&i, 13), 7000);
    assert_int_equal(word_at(&i, 32), 2048000);
    assert_int_equal(i.byte[7], 0x90);
    assert_int_equal(i.byte[17], 0x90);
    /* Again for another machine, 0.3333 times as long: every cost rounded for itself. */
    assert_true(block_costs_patch(&t, image_at, &i, &node, 0.33333, &e));
    assert_int_equal(word_at(&i, 3), 6667);
    assert_int_equal(word_at(&i, 13), 2333);
}

/* With the finer prices: the longest of what is issued, the chain, and the bytes. */
static void the_finer_prices_hold_where_there_are_some(void **state)
{
    (void)state;
    static const struct node_cost fine = {.flop = 10000,
                                          .instruction = 1000,
                                          .div = 90000,
                                          .sqrt = 90000,
                                          .trig = 5000,
                                          .byte = 2000,
                                          .issue = 100,
                                          .code_div = 7000,
                                          .code_root = 8000,
                                          .chain = 900,
                                          .step = 300};
    const struct {
        struct block_counts c;
        int64_t ps;
    } cases[] = {
        {{.instruction = 8, .flop = 4, .issue = 5, .load = 9, .whole = 90}, 500},
        {{.issue = 5, .trig = 1}, 5500},
        {{.issue = 5, .div = 1}, 7000},
        {{.issue = 5, .div = 1, .sqrt = 2}, 23000},
        {{.issue = 5, .chain_flop = 2}, 1800},
        {{.issue = 5, .chain_flop = 1, .chain_cycle = 4}, 2100},
        {{.issue = 40, .chain_flop = 1, .chain_cycle = 4}, 4000},
        {{.issue = 5, .bytes = 16}, 16000},
        {{.issue = 2, .blocks = 1}, 300}, /* the counter's own step */
        {{.bytes = 0}, 0},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_int_equal(block_cost_ps(&fine, &cases[i].c, 0, 1), cases[i].ps);
    assert_int_equal(block_cost_ps(&fine, &cases[1].c, 0, 2), 11000);
    /* With a price of loads the counter is an instruction. */
    struct node_cost finer = fine;
    finer.load = 70;
    finer.whole = 50;
    static const struct block_counts loads = {.issue = 5, .load = 9, .blocks = 1},
                                     whole = {.issue = 5, .whole = 15, .blocks = 1},
                                     counter = {.issue = 5, .blocks = 1};
    assert_int_equal(block_cost_ps(&finer, &loads, 0, 1), 630);
    assert_int_equal(block_cost_ps(&finer, &whole, 0, 1), 800);
    assert_int_equal(block_cost_ps(&finer, &counter, 0, 1), 600);
    /* Without a price of what is issued the others are not looked at. */
    struct node_cost coarse = fine;
    coarse.issue = 0;
    assert_int_equal(block_cost_ps(&coarse, &cases[0].c, 0, 1), 40000);
}

/* Floating-point units, pieces of code, and chains whose additions and products differ. */
static void units_chains_and_code_have_prices(void **state)
{
    (void)state;
    static const struct node_cost c = {.issue = 100,
                                       .chain = 900,
                                       .step = 300,
                                       .add = 400,
                                       .multiply = 500,
                                       .fetch = 2000,
                                       .late = 350,
                                       .product = -100};
    static const struct block_counts sums = {.issue = 5, .add = 3, .multiply = 2},
                                     products = {.issue = 5, .add = 3, .multiply = 3},
                                     chain = {.chain_flop = 3,
                                              .chain_cycle = 9,
                                              .chain_late = 2,
                                              .chain_product = 2};
    assert_int_equal(block_cost_ps(&c, &sums, 0, 1), 1200);
    assert_int_equal(block_cost_ps(&c, &products, 0, 1), 1500);
    assert_int_equal(block_cost_ps(&c, &products, 1, 1), 2000);
    assert_int_equal(block_cost_ps(&c, &chain, 0, 1), 5900);
}

/* 3 additions, 2 of them late, and 9 cycles with 2 products are 5,900 ps from the beginning of a
 * round to its end; of its 6 floating-point instructions only 24 are on their way at a time. */
static void rounds_wait_for_places_of_those_before(void **state)
{
    (void)state;
    struct node_cost c = {
        .issue = 100, .chain = 900, .step = 300, .late = 350, .product = -100, .window = 24};
    const struct block_counts round = {.issue = 11,
                                       .add = 3,
                                       .multiply = 2,
                                       .sqrt = 1,
                                       .once_flop = 3,
                                       .once_cycle = 9,
                                       .once_late = 2,
                                       .once_product = 2};
    assert_int_equal(block_cost_ps(&c, &round, 0, 1), 1180); /* 5,900 x 6 / (6 + 24) */
    c.window = 6;
    assert_int_equal(block_cost_ps(&c, &round, 0, 1), 2950);
    /* Not known, and so large that what is issued takes longer. */
    c.window = 0;
    assert_int_equal(block_cost_ps(&c, &round, 0, 1), 1100);
    c.window = 1e9;
    assert_int_equal(block_cost_ps(&c, &round, 0, 1), 1100);
}

/* The rule in block_costs.c line by line: entries of 6 instructions, lines of 64 bytes. */
static unsigned fetches_by_line(uint64_t address, uint32_t length, unsigned instructions)
{
    unsigned halves = 0;
    for (uint64_t at = address, next; at < address + length; at = next) {
        next = (at / 64 + 1) * 64 < address + length ? (at / 64 + 1) * 64 : address + length;
        const uint64_t here = (2 * instructions * (next - at) + length) / (2 * (uint64_t)length);
        const unsigned entries = (unsigned)((here + 5) / 6);
        halves += entries <= 2 ? entries : at == address ? 2 * entries : entries + entries % 2;
    }
    return (halves + 1) / 2;
}

static void a_long_loop_takes_the_pieces_of_its_lines(void **state)
{
    (void)state;
    struct random r = random_make(17, 0, 0);
    for (int i = 0; i < 20000; i++) {
        const uint64_t address = 4096 + random_below(&r, 256);
        const uint32_t length = (uint32_t)random_below(&r, i % 2 ? 200 : 5000);
        const unsigned instructions = (unsigned)random_below(&r, 1500);
        assert_int_equal(block_fetches(address, length, instructions),
                         fetches_by_line(address, length, instructions));
    }
    /* As long as a table can say: at once. */
    const double begin = host_seconds();
    for (int i = 0; i < 1000; i++)
        assert_int_equal(block_fetches(4096, UINT32_MAX, 64), 0);
    assert_true(host_seconds() - begin < 1);
}

/* By hand, from the rule in block_costs.c. */
static void loops_are_fetched_in_pieces(void **state)
{
    (void)state;
    static const struct {
        uint64_t address;
        uint32_t length;
        unsigned instructions, pieces;
    } cases[] = {
        {0, 20, 6, 1},   {0, 40, 12, 1},         {0, 52, 13, 3},  {0, 60, 20, 4},
        {32, 64, 12, 1}, {32, 64, 24, 2},        {48, 64, 16, 2}, {0, 75, 15, 4},
        {0, 128, 26, 5}, {1 << 20, 320, 70, 11}, {63, 1, 1, 1},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const unsigned n = block_fetches(cases[i].address, cases[i].length, cases[i].instructions);
        if (n != cases[i].pieces) fail_msg("case %u: %u pieces", i, n);
    }
    /* A block's length decides, not its loop's; blocks without one are not fetched. */
    struct image i;
    struct err e;
    err_clear(&e);
    static const struct block_counts counts[BLOCKS] = {{.issue = 13}, {.issue = 13}, {.issue = 13}};
    static const struct node_cost c = {.issue = 10, .fetch = 1000};
    const struct block_table t = image_make(&i, counts);
    struct block_entry *entry = (struct block_entry *)(void *)&i.byte[TABLE_AT];
    entry[0].length = 52;
    assert_true(block_costs_patch(&t, image_at, &i, &c, 1, &e));
    assert_int_equal(word_at(&i, 3), 3000);
    assert_int_equal(word_at(&i, 13), 130);
    /* No instruction is so long. */
    entry[0].length = 15 * 15 + 1;
    assert_false(block_costs_patch(&t, image_at, &i, &c, 1, &e));
    assert_int_equal(e.kind, ERR_DATA);
}

/* A loop of two blocks and what its entry says of a round of it. */
static void loop_costs(const struct block_counts *round, const struct node_cost *c, int64_t first,
                       int64_t last)
{
    struct image i;
    struct err e;
    err_clear(&e);
    const struct block_counts counts[BLOCKS] = {
        *round,
        {.instruction = 6, .issue = 6, .div = 1, .load = 2, .whole = 3, .blocks = 1},
        {.instruction = 4, .issue = 4, .load = 7, .whole = 1, .blocks = 1}};
    struct block_table t = image_make(&i, counts);
    struct block_entry *entry = (struct block_entry *)(void *)&i.byte[TABLE_AT];
    /* The last place, of a rate otherwise, becomes that of code. */
    memcpy(&i.byte[code_at[2] - BLOCK_ADD_OPCODE_BYTES], BLOCK_ADD_OPCODE, BLOCK_ADD_OPCODE_BYTES);
    entry[0].kind = BLOCK_LOOP;
    entry[0].immediate = 2;
    entry[2].kind = BLOCK_ADD;
    if (!block_costs_patch(&t, image_at, &i, c, 1, &e)) fail_msg("%s", e.text);
    assert_int_equal(word_at(&i, 13), first);
    assert_int_equal(word_at(&i, code_at[2]), last);
}

static void blocks_of_a_loop_take_the_same_bound(void **state)
{
    (void)state;
    struct node_cost c = {
        .issue = 100, .code_div = 500, .chain = 900, .step = 10, .load = 30, .whole = 20};
    /* a round of the first block twice and the last once: what all of it takes longest */
    const struct block_counts round = {.issue = 16, .div = 2, .load = 11, .whole = 7, .blocks = 3};
    loop_costs(&round, &c, 700, 500);
    c.code_div = 1000;
    loop_costs(&round, &c, 1000, 0);
    c.load = 500;
    loop_costs(&round, &c, 1000, 3500);
    c.whole = 1000;
    loop_costs(&round, &c, 4000, 2000);
    c.step = 9000;
    loop_costs(&round, &c, 9000, 9000);
    /* a chain is the round's, at its end */
    c.step = 10;
    struct block_counts chained = round;
    chained.chain_flop = 20, chained.chain_cycle = 5;
    loop_costs(&chained, &c, 0, 18050);
    chained.chain_late = 3, chained.chain_product = 1;
    c.late = 100, c.product = -40;
    loop_costs(&chained, &c, 0, 18310);
    /* and so is what it waits for within itself: 90 additions of 900 ps, 58 others beside 2
     * divisions, 20 on their way */
    chained.once_flop = 90, chained.add = 58;
    c.window = 20;
    loop_costs(&chained, &c, 0, 60750); /* 81,000 x 60 / 80 */
    c.window = 0;
    /* without a price of loads each block stands alone */
    c.load = c.whole = 0;
    loop_costs(&chained, &c, 1000, 400);
}

/* Loops that are empty, longer than the table, in another one, or of other things than blocks. */
static void a_loop_that_does_not_fit_is_refused(void **state)
{
    (void)state;
    static const struct node_cost c = {.issue = 100, .load = 30};
    for (int fault = 0; fault < 5; fault++) {
        struct image i;
        struct err e;
        err_clear(&e);
        struct block_table t = image_make(&i, usual);
        struct block_entry *entry = (struct block_entry *)(void *)&i.byte[TABLE_AT];
        entry[0].kind = BLOCK_LOOP;
        entry[0].immediate = fault == 0 ? 0 : fault == 1 ? 3 : fault == 2 ? -1 : 2;
        if (fault == 3) entry[1].kind = BLOCK_LOOP, entry[1].immediate = 1;
        assert_false(block_costs_patch(&t, image_at, &i, &c, 1, &e));
        assert_int_equal(e.kind, ERR_DATA);
        assert_non_null(strstr(e.text, "entry 0 of 3"));
    }
}

static void a_table_that_does_not_fit_is_refused(void **state)
{
    (void)state;
    struct image i;
    for (int fault = 0; fault < 4; fault++) {
        const struct block_table t = image_make(&i, usual);
        struct block_entry *entry = (struct block_entry *)(void *)&i.byte[TABLE_AT];
        if (fault == 0) i.byte[11] = 0x8b;         /* another instruction */
        if (fault == 1) entry[1].immediate++;      /* beside it */
        if (fault == 2) entry[2].immediate = 4096; /* outside */
        if (fault == 3) entry[0].kind = 7;
        struct err e;
        err_clear(&e);
        assert_false(block_costs_patch(&t, image_at, &i, &node, 1, &e));
        assert_int_equal(e.kind, ERR_DATA);
    }
}

static void a_block_that_takes_too_long_is_refused(void **state)
{
    (void)state;
    struct image i;
    struct err e;
    err_clear(&e);
    const struct block_table t = image_make(&i, usual);
    const struct node_cost slow = {.instruction = (double)INT32_MAX / 7};
    assert_true(block_costs_patch(&t, image_at, &i, &slow, 1, &e));
    assert_int_equal(word_at(&i, 13), INT32_MAX);
    assert_false(block_costs_patch(&t, image_at, &i, &slow, 1.0000001, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    assert_non_null(strstr(e.text, "7 instructions would take 2.147 ms"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_block_gets_its_cost),
        cmocka_unit_test(the_finer_prices_hold_where_there_are_some),
        cmocka_unit_test(units_chains_and_code_have_prices),
        cmocka_unit_test(rounds_wait_for_places_of_those_before),
        cmocka_unit_test(loops_are_fetched_in_pieces),
        cmocka_unit_test(a_long_loop_takes_the_pieces_of_its_lines),
        cmocka_unit_test(blocks_of_a_loop_take_the_same_bound),
        cmocka_unit_test(a_loop_that_does_not_fit_is_refused),
        cmocka_unit_test(a_table_that_does_not_fit_is_refused),
        cmocka_unit_test(a_block_that_takes_too_long_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

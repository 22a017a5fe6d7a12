/* test_block_costs.c - costs of blocks in a made-up image: values, rounding, and what does not fit.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

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
        entry[k] = (struct block_entry){word - TABLE_AT - k * (int)sizeof *entry, counts[k],
                                         (uint16_t)kind};
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
        {{.instruction = 8, .flop = 4, .issue = 5}, 500},
        {{.issue = 5, .trig = 1}, 5500},
        {{.issue = 5, .div = 1}, 7000},
        {{.issue = 5, .div = 1, .sqrt = 2}, 23000},
        {{.issue = 5, .chain_flop = 2}, 1800},
        {{.issue = 5, .chain_flop = 1, .chain_cycle = 4}, 2100},
        {{.issue = 40, .chain_flop = 1, .chain_cycle = 4}, 4000},
        {{.issue = 5, .bytes = 16}, 16000},
        {{.issue = 2}, 300}, /* the counter's own step */
        {{.bytes = 0}, 0},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_int_equal(block_cost_ps(&fine, &cases[i].c, 1), cases[i].ps);
    assert_int_equal(block_cost_ps(&fine, &cases[1].c, 2), 11000);
    /* Without a price of what is issued the others are not looked at. */
    struct node_cost coarse = fine;
    coarse.issue = 0;
    assert_int_equal(block_cost_ps(&coarse, &cases[0].c, 1), 40000);
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
        cmocka_unit_test(a_table_that_does_not_fit_is_refused),
        cmocka_unit_test(a_block_that_takes_too_long_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

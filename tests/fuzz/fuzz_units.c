/* fuzz_units.c - quantities with units: the first byte says of which kind, the rest is the text.
 * What is read is finite and comes back from its printed form to the same bits. */
#include "fuzz.h"

#include <math.h>
#include <stdio.h>

#include "base/units.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0) return -1;
    enum unit unit = (enum unit)(data[0] % UNIT_KINDS);
    char *text = fuzz_text(data + 1, size - 1), why[256] = "", printed[128];
    double value = NAN, again = NAN;
    if (units_parse(text, unit, &value, why, (int)sizeof why)) {
        CHECK(isfinite(value));
        units_print(value, unit, printed, (int)sizeof printed);
        CHECK(units_parse(printed, unit, &again, why, (int)sizeof why));
        CHECK(again == value && signbit(again) == signbit(value));
    } else {
        CHECK(why[0] != '\0');
        /* a clause that fits whatever room there is */
        char little[8];
        CHECK(!units_parse(text, unit, &value, little, (int)sizeof little));
        CHECK(memchr(little, '\0', sizeof little) != NULL);
    }
    free(text);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return text_mutate(data, size, most, seed);
}

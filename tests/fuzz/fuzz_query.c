/* fuzz_query.c - SQL of `query`: refused with a reason, or rows; the database stays as it was, byte
 * by byte. */
#include "fuzz_database.h"

#include <stdio.h>

#include "base/text.h"
#include "report/report.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char *path;
    struct err e;
    size_t n;
    const uint8_t *image = database_image(&n);
    if (path == NULL) path = strdup(fuzz_file("queried.db", image, n));
    char *sql = fuzz_text(data, size);
    err_clear(&e);
    struct store *s = store_open(path, STORE_READ, &e);
    CHECK(s != NULL);
    if (!report_query(s, sql, 0, NULL, size % 2 == 0, fuzz_sink(), &e))
        CHECK(e.kind != ERR_NONE && e.text[0] != '\0');
    store_close(s);
    struct text now = {0};
    err_clear(&e);
    CHECK(text_read_file(&now, path, &e));
    CHECK(now.length == n && memcmp(now.s, image, n) == 0);
    text_free(&now);
    free(sql);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return text_mutate(data, size, most, seed);
}

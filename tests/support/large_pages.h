/* large_pages.h - whether this computer has large pages for tests that count page faults. */
#ifndef TESTS_SUPPORT_LARGE_PAGES_H
#define TESTS_SUPPORT_LARGE_PAGES_H

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Whether the system gives large pages to who asks. */
static inline bool large_pages_given(void)
{
    char said[64] = "";
    FILE *f = fopen("/sys/kernel/mm/transparent_hugepage/enabled", "r");
    if (f == NULL) return false;
    const bool read = fgets(said, sizeof said, f) != NULL;
    fclose(f);
    return read && strstr(said, "[never]") == NULL;
}

#endif

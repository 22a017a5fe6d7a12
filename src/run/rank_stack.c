/* rank_stack.c - see rank_stack.h.
 *
 * How deep the calls of a built-in program go depends on the scene, and a stack costs memory for
 * every one of a million ranks: so the usual size is small, and can be changed from outside,
 * without becoming a part of what a run is. */
#include "run/rank_stack.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/units.h"
#include "loader/crash.h"

static const double LEAST = 4096, MOST = 1 << 30;

/* In a signal handler: no stdio. */
static void told(void *record, const char *text)
{
    static const char before[] = "mimdsim: ", after[] = "; what is stored stays\n";
    if (record != NULL) crash_told(record, text);
    (void)!write(STDERR_FILENO, before, sizeof before - 1);
    (void)!write(STDERR_FILENO, text, strlen(text));
    (void)!write(STDERR_FILENO, after, sizeof after - 1);
    _exit(ERR_DEADLOCK_STATUS);
}

bool rank_stack_set(struct world_load *load, struct err *e)
{
    const char *named = getenv(RANK_STACK_VARIABLE);
    double bytes;
    char why[160];
    load->overflowed = told;
    /* Asked for now, as the handler would look at a signal stack that is its own. */
    load->overflow_context = crash_record_of_process();
    if (named == NULL || *named == '\0') return true;
    if (!units_parse(named, UNIT_BYTES, &bytes, why, (int)sizeof why))
        return err_set(e, ERR_USAGE, RANK_STACK_VARIABLE " is '%.40s': %s", named, why);
    if (bytes < LEAST || bytes > MOST)
        return err_set(e, ERR_USAGE,
                       RANK_STACK_VARIABLE " is '%.40s'; expected 4 KiB to 1 GiB for each rank",
                       named);
    load->stack_bytes = (int64_t)bytes;
    return true;
}

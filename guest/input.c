/* input.c - functions that read standard input without naming it: there is none.
 *
 * No headers: they give some of these names to others. */
#include <stddef.h>

#include "guest.h"

const char guest_no_input[] =
    "reads standard input, which a program on the simulator does not have; give it a file or "
    "arguments";

#define NO_INPUT(name)                                                                             \
    WEAK int name(void);                                                                           \
    int name(void) { guest_fail(HERE, "%s", guest_no_input); }

NO_INPUT(scanf)
NO_INPUT(vscanf)
NO_INPUT(__isoc99_scanf)
NO_INPUT(__isoc99_vscanf)
NO_INPUT(__isoc23_scanf)
NO_INPUT(__isoc23_vscanf)
NO_INPUT(wscanf)
NO_INPUT(__isoc99_wscanf)
NO_INPUT(getchar)
NO_INPUT(getchar_unlocked)
NO_INPUT(getwchar)
NO_INPUT(gets)

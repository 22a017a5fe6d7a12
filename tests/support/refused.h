/* refused.h - what a call that was refused has said.
 *
 * To be included behind cmocka.h. */
#ifndef SUPPORT_REFUSED_H
#define SUPPORT_REFUSED_H

#include <string.h>

#include "base/err.h"

/* is_refused: the error is of that kind, with `part` in its text, and then forgotten. */
static inline void is_refused(struct err *e, enum err_kind kind, const char *part)
{
    assert_int_equal(e->kind, kind);
    if (strstr(e->text, part) == NULL) fail_msg("'%s' is not in '%s'", part, e->text);
    err_clear(e);
}

/* is_refused_at: the same of that line of its file; 0: of none. */
static inline void is_refused_at(struct err *e, enum err_kind kind, int line, const char *part)
{
    assert_int_equal(e->line, line);
    is_refused(e, kind, part);
}

#endif

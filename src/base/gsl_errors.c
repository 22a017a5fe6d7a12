/* gsl_errors.c - see gsl_errors.h. */
#include "base/gsl_errors.h"

#include <gsl/gsl_errno.h>

#include "base/check.h"

void gsl_errors_returned(const char *reason, const char *file, int line, int status)
{
    (void)reason, (void)file, (void)line;
    if (status == GSL_ENOMEM) check_memory(0);
}

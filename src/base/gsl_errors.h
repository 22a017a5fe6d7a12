/* gsl_errors.h - what GSL does where it meets an error: by itself it would abort the process. */
#ifndef BASE_GSL_ERRORS_H
#define BASE_GSL_ERRORS_H

/* gsl_errors_returned: a handler for gsl_set_error_handler. The function of GSL returns its status,
 * as with gsl_set_error_handler_off; but where it got no memory the process ends (check_memory),
 * since some of GSL's functions go on with the null pointer. */
void gsl_errors_returned(const char *reason, const char *file, int line, int status);

#endif

/* parameters.h - the numbers of the machines that plans use, as text for a report. */
#ifndef APP_PARAMETERS_H
#define APP_PARAMETERS_H

#include "base/arena.h"
#include "plan/plan.h"
#include "report/report_document.h"

/* parameters_gather: every value with a source of every machine in the plans, in memory of `a`; *n
 * of them. */
bool parameters_gather(const struct plan *plan, int nplan, struct arena *a,
                       const struct document_parameter **out, int *n, struct err *e);

/* parameters_range: "12 us to 20 us" in the unit of the value's field, in memory of `a`; "" without
 * a range. */
const char *parameters_range(const struct origin *o, struct arena *a);

#endif

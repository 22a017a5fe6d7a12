/* why_range.h - how far a parameter may move until another path takes over. */
#ifndef STUDY_WHY_RANGE_H
#define STUDY_WHY_RANGE_H

#include "study/why.h"

/* why_ranges: fill the range of those parameters of w that have a tolerance behind another path.
 * Workers, quiet, a as for why_study. Returns false as run_campaign. */
bool why_ranges(const struct run_spec *spec, int workers, bool quiet, struct arena *a,
                struct why *w, struct err *e);

/* why_crossing: where two straight lines cross: y through (1, y) with slope `own`, and through
 * (x1, y1) with slope `other`; NAN: they are parallel. */
double why_crossing(double y, double own, double x1, double y1, double other);

#endif

/* tolerance.c - how far a correct parallel answer may be from the serial one (references.h). */
#include <math.h>

#include "kernel/references.h"

static double precision_scale(enum precision p)
{
    return p == PRECISION_FLOAT ? 0x1p-24 / 0x1p-53 : 1;
}

/* Errors of the accelerations grow like n^2 in chains of a stretched shape (physics 8.2); up to 100
 * bodies one tolerance is enough. 1e-2 is the end of any trust. */
double references_tolerance(const struct kernel_spec *k, int n)
{
    double size = fmax(1, n / 100.0), base = k->formulation == FORMULATION_PAPER ? 1e-8 : 1e-10;
    return fmin(base * size * size * precision_scale(k->precision), 1e-2);
}

/* Inverse dynamics sums forces without solving anything: its error grows like n. */
double references_tolerance_inverse(const struct kernel_spec *k, int n)
{
    return fmin(1e-11 * fmax(1, n / 100.0) * precision_scale(k->precision), 1e-2);
}

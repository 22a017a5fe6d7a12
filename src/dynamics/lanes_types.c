/* lanes_types.c - which widths of lanes this host has. */
#include <stddef.h>

#include "base/processor.h"
#include "dynamics/lanes_type.h"

/* Each width's files are compiled apart, for the registers that it needs (local.am). */
extern const struct lanes_type lanes_type_f64x4, lanes_type_f64x8;

const struct lanes_type *lanes_type_of(int width)
{
#ifdef __x86_64__
    if (width == 4 && processor_has_avx2()) return &lanes_type_f64x4;
    if (width == 8 && processor_has_avx512f()) return &lanes_type_f64x8;
#else
    (void)width;
#endif
    return NULL;
}

const struct lanes_type *lanes_type_widest(void)
{
    const struct lanes_type *eight = lanes_type_of(8);
    return eight ? eight : lanes_type_of(4);
}

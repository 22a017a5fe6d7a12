/* dynamics_types.c - which table for which precision; names of methods. */
#include "dynamics/dynamics_table.h"

/* Each precision's archive defines its own (dynamics_type.c). */
extern const struct dynamics_type dynamics_type_f32, dynamics_type_f64, dynamics_type_f128;

/* The tables of the three builds of dynamics_type.c. */
const struct dynamics_type *dynamics_type_of(enum precision precision)
{
    switch (precision) {
    case PRECISION_FLOAT: return &dynamics_type_f32;
    case PRECISION_QUAD: return &dynamics_type_f128;
    case PRECISION_DOUBLE: break;
    }
    return &dynamics_type_f64;
}

/* As in reports and on the command line. */
const char *forward_method_name(enum forward_method method)
{
    static const char *const name[FORWARD_METHODS] = {"aba",       "crba",       "crba-sparse",
                                                      "cfa-paper", "cfa-direct", "cfa-robust"};
    return name[method];
}

/* units.h - quantities with units as written in files and on the command line.
 *
 * Every dimensioned number carries its unit; bits and bytes differ by 8 (Gb/s, GB/s); prefixes are
 * SI (k M G T, m u n p) and binary (Ki Mi Gi) for bytes. Values are held in SI base units: s, B,
 * B/s, Hz, flop/s, m, kg, N, rad. */
#ifndef BASE_UNITS_H
#define BASE_UNITS_H

#include <stdbool.h>

enum unit {
    UNIT_NONE,          /* a bare number */
    UNIT_TIME,          /* s, ms, us, ns, ps */
    UNIT_BYTES,         /* B, kB, KiB, MB, ..., bit */
    UNIT_BANDWIDTH,     /* B/s, kB/s, MB/s, GB/s, Mb/s, Gb/s, ... */
    UNIT_TIME_PER_BYTE, /* s/B, us/B, ns/B, ps/B */
    UNIT_FREQUENCY,     /* Hz, kHz, MHz, GHz */
    UNIT_FLOP_RATE,     /* flop/s, Mflop/s, Gflop/s, Tflop/s */
    UNIT_CYCLES,        /* cycles */
    UNIT_LENGTH,        /* m, mm, um, nm, angstrom */
    UNIT_MASS,          /* kg, g, amu */
    UNIT_ANGLE,         /* rad, deg */
    UNIT_ANGULAR_RATE,  /* rad/s, deg/s */
    UNIT_ACCELERATION,  /* m/s^2 */
    UNIT_PERCENT,       /* % (held as a fraction) */
    UNIT_STIFFNESS,     /* N m/rad */
    UNIT_DAMPING,       /* N m s/rad */
    UNIT_TORQUE,        /* N m */
    UNIT_FORCE,         /* N */
    UNIT_ANGULAR_ACCELERATION, /* rad/s^2 */
    UNIT_KINDS
};

/* units_parse: read "480 MB/s" as a quantity of kind `unit` into *value (SI).
 *
 *   why   buffer of `size` bytes that receives, on failure, what is wrong and what was expected, as
 * a clause
 *         ("no unit; expected a bandwidth such as '480 MB/s'")
 *
 *   Returns false on a missing or wrong unit, trailing text, or a number that is not finite. */
bool units_parse(const char *text, enum unit unit, double *value, char *why, int size);

/* units_print: `value` (SI) with a readable prefix into buffer; reads back to the same double with
 * units_parse. */
void units_print(double value, enum unit unit, char *buffer, int size);

/* units_name: what the kind is called in messages ("a bandwidth"); units_example: one example ("480
 * MB/s"); units_si: the SI symbol used in SQL column names and tables ("B_per_s", "s", "" for
 * UNIT_NONE). */
const char *units_name(enum unit unit);
const char *units_example(enum unit unit);
const char *units_si(enum unit unit);

#endif

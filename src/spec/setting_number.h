/* setting_number.h - the value of a setting as a number in base units, so that it can be sorted,
 * drawn and fitted. */
#ifndef SPEC_SETTING_NUMBER_H
#define SPEC_SETTING_NUMBER_H

#include <stdbool.h>

#include "base/units.h"

/* setting_number: the number that the text `value` of the setting `key` (in full) is.
 *
 *   number  out  in SI base units: "60 us" is 6e-5
 *   unit    out  what kind of quantity it is; also of settings whose value is no number
 *
 *   Returns false for words, lists, "unlimited", and texts that are no number. What a person's own
 * program declares (program.NAME) has no unit of its own: a plain number is one, and so is a number
 * with a unit that only one kind of quantity has. */
bool setting_number(const char *key, const char *value, double *number, enum unit *unit);

#endif

/* field_segments.h - the segments of message software as text: "[{from: 0 B, gap: 1 us}, {from: 8
 * KiB, ...}]". */
#ifndef SPEC_FIELD_SEGMENTS_H
#define SPEC_FIELD_SEGMENTS_H

#include "spec/field.h"

/* field_set and field_print, handed in: the numbers of a segment are fields themselves. */
typedef bool field_reader(const struct field *f, void *base, const char *text, struct arena *a,
                          char *why, int size);
typedef void field_printer(const struct field *f, const void *base, struct text *out);

/* field_segments_set: as field_set; "[]" is no segment. Refused with the segment's number: no
 * 'from', a first one that does not begin at 0 B, two from the same size, sizes that do not rise,
 * an unknown or repeated key, a wrong value. */
bool field_segments_set(const struct field *f, void *base, const char *text, field_reader *read,
                        struct arena *a, char *why, int size);

/* field_segments_print: as field_print; what a segment does not give is left out. */
void field_segments_print(const struct field *f, const void *base, field_printer *print,
                          struct text *out);

#endif

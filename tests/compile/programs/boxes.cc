/* boxes.cc - the second file of throwing.cc. */
#include "boxes.h"

long other_boxes(long n) { return boxed(n) + box<short>(4).squared() + box<long>::made; }

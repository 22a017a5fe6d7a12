/* images.h - the pictures that gnuplot has made of a figure: whole, or not there. */
#ifndef REPORT_IMAGES_H
#define REPORT_IMAGES_H

#include <stdbool.h>

#include "base/err.h"

/* images_remove: remove DIR/NAME.png and DIR/NAME.svg. */
void images_remove(const char *dir, const char *name);

/* images_check: of DIR/NAME.png and DIR/NAME.svg at least one is there, and what is there has its
 * end: gnuplot tells nobody of a full disk. Returns false with ERR_IO. */
bool images_check(const char *dir, const char *name, struct err *e);

#endif

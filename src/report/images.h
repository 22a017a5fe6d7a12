/* images.h - the pictures that gnuplot has made of a figure: whole, or not there. */
#ifndef REPORT_IMAGES_H
#define REPORT_IMAGES_H

#include <stdbool.h>

#include "base/err.h"

/* images_remove: remove DIR/NAME.png and DIR/NAME.svg. */
void images_remove(const char *dir, const char *name);

/* images_check: of WORK/NAME.png and WORK/NAME.svg at least one is there, and what is there has its
 * end: gnuplot tells nobody of a full disk. Returns false with ERR_IO, ERR_UNAVAILABLE where there
 * is none; messages tell `dir`, where they are to be. */
bool images_check(const char *work, const char *dir, const char *name, struct err *e);

#endif

/* vector_check.h - what a reference vector must and must not hold, so that nothing in it is passed
 * over in silence. */
#ifndef MODEL_VECTOR_CHECK_H
#define MODEL_VECTOR_CHECK_H

#include <stdbool.h>

#include "base/err.h"
#include "io/document.h"
#include "model/vector.h"

/* vector_check_keys: is every key of the file `root`, at every level, one of the format's? False
 * with ERR_DATA: file and line of the first that is not, and the nearest known one. What other
 * libraries reached ('peers') is free text. */
bool vector_check_keys(const struct node *root, const char *path, struct err *e);

/* vector_check_frame: do the rotation R and the quaternion of a frame agree, to four roundings?
 * False with ERR_DATA. */
bool vector_check_frame(const struct vector_frame *f, const struct node *at, const char *path,
                        struct err *e);

/* vector_complete: does c hold every answer that the format promises for a system of its size? A
 * file that holds fewer says so by the list 'answers' of the keys that it has. False with ERR_DATA
 * and the missing key. */
bool vector_complete(const struct vector_case *c, struct err *e);

#endif

/* json.h - a streaming JSON writer: nesting and commas handled, non-finite numbers written as
 * null. */
#ifndef BASE_JSON_H
#define BASE_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct json {
    FILE *out;      /* borrowed */
    int depth;
    unsigned char first[64]; /* per depth: nothing written yet */
    char closer[64];         /* per depth: the bracket that ends it */
    bool key_open;  /* a key was written, its value is next */
};

/* json_make: a writer onto `out` (borrowed; not closed). */
struct json json_make(FILE *out);

/* json_object / json_array open, json_end closes the innermost; json_key names the next value. */
void json_object(struct json *j);
void json_array(struct json *j);
void json_end(struct json *j);
void json_key(struct json *j, const char *key);

/* values: text (escaped), integer, real (as few digits as read back to the same double,
 * null when not finite), truth, null. */
void json_text(struct json *j, const char *s);
void json_int(struct json *j, int64_t v);
void json_real(struct json *j, double v);
void json_bool(struct json *j, bool v);
void json_null(struct json *j);

/* json_key_text, json_key_int, json_key_real, json_key_bool: a key and its value. */
void json_key_text(struct json *j, const char *key, const char *s);
void json_key_int(struct json *j, const char *key, int64_t v);
void json_key_real(struct json *j, const char *key, double v);
void json_key_bool(struct json *j, const char *key, bool v);

/* json_finish: end the document with a newline and flush; CHECKs that everything was closed. */
void json_finish(struct json *j);

#endif

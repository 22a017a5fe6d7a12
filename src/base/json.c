/* json.c - a streaming JSON writer.
 *
 * Nothing is held back: a document of any length needs the same memory. Commas, quotes and brackets
 * follow from a stack of what is open; a call that does not fit there is a mistake of the program
 * (CHECK). */
#include "base/json.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

enum { DEPTHS = sizeof ((struct json *)0)->first };

/* Depth 0 is the document: it may hold one value. */
struct json json_make(FILE *out)
{
    struct json j = {.out = out};
    j.first[0] = 1;
    return j;
}

/* json_begin_value: the comma before a value, unless it follows its key; a value in an object needs
 * a key. */
static void json_begin_value(struct json *j)
{
    if (!j->key_open) {
        /* Without a key a value may stand alone or in a list. */
        CHECK(j->depth == 0 ? j->first[0] : j->closer[j->depth] == ']');
        if (!j->first[j->depth]) fputs(", ", j->out);
        j->first[j->depth] = 0;
    }
    j->key_open = false;
}

/* What closes a level is remembered with it. */
static void json_open(struct json *j, char opener, char closer)
{
    json_begin_value(j);
    CHECK(j->depth + 1 < DEPTHS);
    fputc(opener, j->out);
    j->depth++;
    j->first[j->depth] = 1;
    j->closer[j->depth] = closer;
}

void json_object(struct json *j)
{
    json_open(j, '{', '}');
}

void json_array(struct json *j)
{
    json_open(j, '[', ']');
}

void json_end(struct json *j)
{
    CHECK(j->depth > 0 && !j->key_open);
    fputc(j->closer[j->depth--], j->out);
}

/* utf8_length: bytes of the well-formed character at s, 0 when it is none (Unicode 15, table 3-7).
 */
static int utf8_length(const unsigned char *s)
{
    if (s[0] < 0x80) return 1;
    /* Length by the first byte; 0xc0 and 0xc1 could only begin overlong forms. */
    int n = s[0] >= 0xc2 && s[0] <= 0xdf   ? 2
            : (s[0] & 0xf0) == 0xe0        ? 3
            : s[0] >= 0xf0 && s[0] <= 0xf4 ? 4
                                           : 0;
    for (int i = 1; i < n; i++)
        if ((s[i] & 0xc0) != 0x80) return 0;
    bool overlong = (s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xf0 && s[1] < 0x90);
    /* surrogates, > U+10FFFF */
    bool outside = (s[0] == 0xed && s[1] > 0x9f) || (s[0] == 0xf4 && s[1] > 0x8f);
    return overlong || outside ? 0 : n;
}

/* json_escaped: s in quotes; bytes that are not UTF-8 become U+FFFD, so that the document is valid
 * whatever a file name or a model's text holds. */
static void json_escaped(struct json *j, const char *s)
{
    fputc('"', j->out);
    for (const unsigned char *p = (const unsigned char *)s; *p;) {
        int n = utf8_length(p);
        if (n == 0) fputs("\\ufffd", j->out);
        else if (*p == '"' || *p == '\\') fprintf(j->out, "\\%c", *p);
        else if (*p == '\n') fputs("\\n", j->out);
        else if (*p == '\t') fputs("\\t", j->out);
        /* Control characters have no other form in JSON. */
        else if (*p < 0x20 || *p == 0x7f) fprintf(j->out, "\\u%04x", *p);
        else fwrite(p, 1, (size_t)n, j->out);
        p += n > 0 ? n : 1;
    }
    fputc('"', j->out);
}

/* A key needs an object that waits for one; its value must follow. */
void json_key(struct json *j, const char *key)
{
    CHECK(j->depth > 0 && j->closer[j->depth] == '}' && !j->key_open);
    if (!j->first[j->depth]) fputs(", ", j->out);
    j->first[j->depth] = 0;
    json_escaped(j, key);
    fputs(": ", j->out);
    j->key_open = true;
}

void json_text(struct json *j, const char *s)
{
    json_begin_value(j);
    json_escaped(j, s);
}

void json_int(struct json *j, int64_t v)
{
    json_begin_value(j);
    fprintf(j->out, "%" PRId64, v);
}

/* JSON has no infinity and no "not a number": null. */
void json_real(struct json *j, double v)
{
    char digits[32] = "null";
    json_begin_value(j);
    if (isfinite(v)) text_real(digits, v);
    fputs(digits, j->out);
}

void json_bool(struct json *j, bool v)
{
    json_begin_value(j);
    fputs(v ? "true" : "false", j->out);
}

void json_null(struct json *j)
{
    json_begin_value(j);
    fputs("null", j->out);
}

/* Key and value in one call, the common case. */
void json_key_text(struct json *j, const char *key, const char *s)
{
    json_key(j, key);
    json_text(j, s);
}

void json_key_int(struct json *j, const char *key, int64_t v)
{
    json_key(j, key);
    json_int(j, v);
}

void json_key_real(struct json *j, const char *key, double v)
{
    json_key(j, key);
    json_real(j, v);
}

void json_key_bool(struct json *j, const char *key, bool v)
{
    json_key(j, key);
    json_bool(j, v);
}

/* Everything must be closed; the reader sees the whole document at once. */
void json_finish(struct json *j)
{
    CHECK(j->depth == 0 && !j->key_open);
    fputc('\n', j->out);
    fflush(j->out);
}

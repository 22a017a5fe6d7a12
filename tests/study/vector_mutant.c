/* vector_mutant.c - finding and replacing numbers in the text of a reference vector. */
#include "vector_mutant.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *vector_text_key(const char *text, const char *key)
{
    char quoted[80];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    return strstr(text, quoted);
}

const char *vector_text_end(const char *at)
{
    return at + strspn(at, "+-0123456789.eE");
}

int vector_text_numbers(const char *text, const char *key, const char *from, const char **number,
                        int room)
{
    const char *s = vector_text_key(from ? from : text, key);
    int depth = 0, n = 0;
    if (!s) return 0;
    s += strlen(key) + 3;
    do {
        s += strspn(s, " \t\r\n,:");
        if (*s == '[' || *s == '{') depth++, s++;
        else if (*s == ']' || *s == '}') depth--, s++;
        else if (*s == '"') s = strchr(s + 1, '"') + 1;
        else if (strchr("+-0123456789", *s)) {
            if (n < room) number[n++] = s;
            s = vector_text_end(s);
        } else s += strcspn(s, ",]}");
    } while (depth > 0 && *s);
    return n;
}

char *vector_text_put(const char *text, const char *at, size_t length, const char *with)
{
    size_t before = (size_t)(at - text), size = strlen(text) - length + strlen(with) + 1;
    char *out = malloc(size);
    if (!out) abort();
    memcpy(out, text, before);
    strcpy(out + before, with);
    strcat(out + before, at + length);
    return out;
}

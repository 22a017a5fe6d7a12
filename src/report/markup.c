/* markup.c - see markup.h. Texts of a database may be a stranger's: all of them pass here. */
#include "report/markup.h"

#include <string.h>

void markup_escape_bytes(FILE *out, const char *s, size_t n)
{
    for (size_t i = 0; i < n; i++) switch (s[i]) {
        case '<': fputs("&lt;", out); break;
        case '>': fputs("&gt;", out); break;
        case '&': fputs("&amp;", out); break;
        case '"': fputs("&quot;", out); break;
        case '\'': fputs("&#39;", out); break;
        /* line breaks stay: the writer of a paragraph may want them */
        default: putc((unsigned char)s[i] < ' ' && s[i] != '\n' ? ' ' : s[i], out);
        }
}

void markup_escape(FILE *out, const char *s)
{
    markup_escape_bytes(out, s, strlen(s));
}

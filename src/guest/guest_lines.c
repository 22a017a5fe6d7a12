/* guest_lines.c - see guest_lines.h. */
#include "guest/guest_lines.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/escape.h"
#include "base/memory.h"

/* One whole line goes to the result, up to a limit, and to people. Ranks share the host's
 * output, so lines are whole or not there: those of ranks that write at the same
 * simulated time do not mix. */
static void emit(const struct guest_line *line, int rank, int stream, enum program_output output,
                 struct text *said)
{
    if (said != NULL && said->length < GUEST_SAID_MOST)
        text_add(said, "%d %d %.*s\n", rank, stream, line->n, line->text);
    if (output == PROGRAM_OUTPUT_KEEP) return;
    struct text whole = {0};
    if (output == PROGRAM_OUTPUT_LABEL) text_add(&whole, "[%d] ", rank);
    text_add_bytes(&whole, line->text, (size_t)line->n);
    text_add(&whole, "\n");
    /* As it is, colours and all: the program is the user's. At once, as the rank may crash in its
     * next step. */
    escape_raw(stream == 2 ? 2 : 1, whole.s, whole.length);
    text_free(&whole);
}

void guest_line_add(struct guest_line *line, int rank, int stream, const char *data, size_t n,
                    enum program_output output, struct text *said)
{
    if (line->text == NULL) line->text = memory_take(GUEST_LINE, 1);
    for (size_t i = 0; i < n; i++) {
        /* Lines that are too long are cut into several; an empty line is a line. */
        const bool end = data[i] == '\n';
        if (!end) line->text[line->n++] = data[i] != '\0' ? data[i] : '?'; /* texts end at a NUL */
        if (!end && line->n < GUEST_LINE) continue;
        emit(line, rank, stream, output, said);
        line->n = 0;
    }
}

void guest_line_end(struct guest_line *line, int rank, int stream, enum program_output output,
                    struct text *said)
{
    if (line->n > 0) emit(line, rank, stream, output, said);
    free(line->text);
    *line = (struct guest_line){0};
}

/* guest_lines.h - what ranks write to their standard output and error, line by line. */
#ifndef GUEST_GUEST_LINES_H
#define GUEST_GUEST_LINES_H

#include <stddef.h>

#include "base/text.h"
#include "spec/program_spec.h"

enum {
    GUEST_LINE = 4096,        /* a longer line is cut into several [B] */
    GUEST_SAID_MOST = 1 << 20 /* kept of one run [B]; shown is all of it */
};

/* What one rank has begun to write to a stream, and not ended. */
struct guest_line {
    char *text; /* GUEST_LINE bytes, owned; NULL: it has written nothing yet */
    int n;
};

/* guest_line_add: n bytes that `rank` writes to `stream` (1 or 2): whole lines are appended to
 * *said as "RANK STREAM TEXT" and shown as `output` says; the rest waits in *line. */
void guest_line_add(struct guest_line *line, int rank, int stream, const char *data, size_t n,
                    enum program_output output, struct text *said);

/* guest_line_end: a line that has begun, though it has no end. Gives the memory back. */
void guest_line_end(struct guest_line *line, int rank, int stream, enum program_output output,
                    struct text *said);

#endif

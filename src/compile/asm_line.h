/* asm_line.h - a line of AT&T assembly in its statements: labels, directives, instructions.
 *
 * The syntax is that of the GNU assembler for x86-64 (its manual, chapters 3 and 9.16): statements
 * end with the line or with ';', comments begin with '#' or stand in slashes and stars. */
#ifndef COMPILE_ASM_LINE_H
#define COMPILE_ASM_LINE_H

#include <stdbool.h>

/* A piece of a text that somebody else owns. */
struct span {
    const char *s;
    int n;
};

enum asm_kind {
    ASM_NOTHING,     /* the line has no more statements */
    ASM_LABEL,       /* word: its name */
    ASM_DIRECTIVE,   /* word: with its dot; operands: the rest */
    ASM_INSTRUCTION, /* word: the mnemonic; operands: the rest */
    ASM_PREFIX       /* word: lock, rep, ... alone: it belongs to the next instruction */
};

struct asm_statement {
    enum asm_kind kind;
    const char *begin;          /* where it begins, with its prefixes */
    struct span word, operands; /* without spaces at their ends, without comments */
};

/* asm_next: the statement at *at of a line that ends at `end`; *at becomes where the next begins.
 * An instruction comes without its prefixes (rep movsb is movsb). Kind ASM_NOTHING at the end. */
struct asm_statement asm_next(const char **at, const char *end);

/* asm_operand: operand number `i` (from 0) of an instruction, empty (n = 0) when there is none.
 * Commas in parentheses do not separate. */
struct span asm_operand(struct span operands, int i);

/* span_is, span_starts: whether a span is, or begins with, the string `s`. */
bool span_is(struct span a, const char *s);
bool span_starts(struct span a, const char *s);

/* span_find: where string `s` stands in a span, -1: nowhere. */
int span_find(struct span a, const char *s);

#endif

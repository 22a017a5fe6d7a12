/* block_filter.c - one pass for the labels that are referred to, one that writes the text with
 * counters. */
#include "compile/block_filter.h"

#include <stdio.h>
#include <string.h>

#include "base/arena.h"
#include "compile/entries.h"
#include "compile/instruction.h"
#include "compile/label_set.h"
#include "compile/loops.h"

enum { MOST_NESTED = 64 };

/* A section as the text names it. */
struct section {
    struct span key; /* the directive's operands, or .text and the like */
    bool code, debug;
    int first; /* number of its first block, 0: none yet */
    struct section *next;
};

struct block {
    struct code_block code; /* number 0: none is open */
    struct section *section;
};

struct filter {
    const struct block_source *source;
    struct arena *arena;
    struct label_set *referred;
    struct entries *entries; /* NULL: functions are left as they are */
    struct text *out;
    struct text table; /* entries of blocks of the present section that are not yet written */
    struct err *e;
    struct section *sections, *now, *before, *stack[MOST_NESTED], *before_stack[MOST_NESTED];
    int depth;
    struct block block;
    struct code code; /* blocks of this function that are not yet in `table` */
    int blocks;
    int repeated;  /* block that leads back to itself and ends on this line, 0: none */
    bool begins;   /* the next instruction begins a block */
    bool reached;  /* control can come there from above */
    bool in_asm;   /* between #APP and #NO_APP */
    bool branched; /* the asm statement has labels or branches */
    bool holds; /* nothing may be inserted here: inside a sequence of bytes that the linker knows */
    bool frame; /* %rbp is the frame pointer of this function */
    struct span function, compiler; /* the last label that is not local; .ident */
    struct span file;               /* place in the source, as far as line markers tell */
    int line;
};

/* --- sections --- */

/* Quoted or not, so within the first two characters. */
static bool is_debug_section(struct span key)
{
    return span_find(key, ".debug_") >= 0 && span_find(key, ".debug_") < 2;
}

/* Whether a section holds code: flag x, or without flags its name. */
static bool is_code_section(struct span key)
{
    const struct span name = asm_operand(key, 0), flags = asm_operand(key, 1);
    if (flags.n > 0) return span_find(flags, "x") >= 0;
    return span_starts(name, ".text") || span_starts(name, "\".text") || span_is(name, ".init") ||
           span_is(name, ".fini");
}

/* A file has few sections, so a list will do. */
static struct section *section_named(struct filter *f, struct span key)
{
    for (struct section *s = f->sections; s != NULL; s = s->next)
        if (s->key.n == key.n && memcmp(s->key.s, key.s, (size_t)key.n) == 0) return s;
    struct section *s = TAKE(f->arena, 1, struct section);
    *s = (struct section){key, is_code_section(key), is_debug_section(key), 0, f->sections};
    f->sections = s;
    return s;
}

/* The entries of the section's blocks go to a piece of the table that is linked to the section
 * (flag o, by the label of its first block) and lies in its group, if it has one (flag ?). One
 * label for each section, so that there is one piece for each. */
static void write_entries(struct filter *f)
{
    loops_write(&f->code, &f->table);
    if (f->table.length == 0) return;
    text_add(f->out,
             "\t.pushsection " BLOCK_TABLE_SECTION ",\"ao?\",@progbits,.Lmimdsim%d\n\t.balign 4\n",
             f->now->first);
    text_add_bytes(f->out, f->table.s, f->table.length);
    text_add(f->out, "\t.popsection\n");
    f->table.length = 0;
}

/* The block goes to the code of its function. */
static void close_block(struct filter *f)
{
    struct code_block *b = &f->block.code;
    /* Labels that follow each other begin one block. */
    if (b->number == 0) return;
    b->counts.blocks = b->counts.issue > 0;
    code_add_block(&f->code, *b);
    *b = (struct code_block){0};
}

/* The next instruction begins another block; reached tells whether control may come there from
 * above. */
static void leave_block(struct filter *f, bool reached)
{
    close_block(f);
    f->begins = true;
    f->reached = reached;
}

/* Follow a directive that changes the section; false when it is none. */
static bool change_section(struct filter *f, const struct asm_statement *s)
{
    struct section *next = NULL, *before = f->now;
    if (span_is(s->word, ".section")) next = section_named(f, s->operands);
    else if (span_is(s->word, ".text") || span_is(s->word, ".data") || span_is(s->word, ".bss"))
        next = section_named(f, s->word);
    else if (span_is(s->word, ".previous")) next = f->before;
    else if (span_is(s->word, ".pushsection") && f->depth < MOST_NESTED) {
        f->before_stack[f->depth] = f->before;
        f->stack[f->depth++] = f->now;
        next = section_named(f, s->operands);
    } else if (span_is(s->word, ".popsection") && f->depth > 0) {
        next = f->stack[--f->depth];
        before = f->before_stack[f->depth];
    }
    if (next == NULL) return false;
    /* Compilers leave a function's section between functions only, or between its hot and its cold
     * part, and enter both at labels. An asm statement comes back to where it was, and its block
     * goes on. The entries are written while the section is still the one whose group they belong
     * to. */
    if (!f->in_asm) leave_block(f, false);
    if (f->now->code) write_entries(f);
    f->before = before;
    f->now = next;
    return true;
}

/* --- the second pass --- */

/* leaq keeps the flags, which the code around may still need; its 32-bit operand, 0 here, is
 * written when the image is loaded and the machine is known. */
static void begin_block(struct filter *f)
{
    f->block.code.number = ++f->blocks;
    f->block.section = f->now;
    if (f->now->first == 0) f->now->first = f->block.code.number;
    f->begins = false;
    f->reached = true;
    text_add(f->out, "{disp32} leaq 0(%%r15), %%r15\n.Lmimdsim%d:\n", f->block.code.number);
}

/* Thread-local addresses are computed by sequences of fixed bytes that the linker replaces. */
static bool is_in_sequence(const struct asm_statement *s)
{
    return span_find(s->operands, "@tlsgd") >= 0 || span_find(s->operands, "@tlsld") >= 0 ||
           span_find(s->operands, "@TLSDESC") >= 0 || span_find(s->operands, "@TLSCALL") >= 0 ||
           span_find(s->operands, "@tlsdesc") >= 0 || span_find(s->operands, "@tlscall") >= 0;
}

/* Code that nobody wrote in assembly has no line of its own; then the function must do. */
static bool refuse_r15(struct filter *f)
{
    static const char why[] =
        "register r15 is used here; `mimdsim cc` keeps the count of computing time in it, so "
        "that programs cannot have it";
    char file[sizeof f->e->file];
    if (!f->in_asm && !f->source->written)
        return err_set_at(f->e, ERR_DATA, f->source->name, 0, "in %.*s: %s", f->function.n,
                          f->function.s, why);
    snprintf(file, sizeof file, "%.*s", f->file.n, f->file.s);
    return err_set_at(f->e, ERR_DATA, file, f->line, "%s", why);
}

/* An instruction, or a prefix alone on its line, in code. */
static bool take_instruction(struct filter *f, const struct asm_statement *s)
{
    struct block_counts counts = {0};
    if (instruction_uses_r15(s->operands)) return refuse_r15(f);
    if (s->kind == ASM_PREFIX) {
        f->holds = true;
        return true;
    }
    const enum flow flow = instruction_read(s->word, s->operands, f->frame, &counts);
    if (instruction_is_frame_set(s->word, s->operands)) f->frame = true;
    f->holds = is_in_sequence(s);
    if (f->in_asm) {
        f->branched = f->branched || flow != FLOW_ON;
        if (f->now == f->block.section) code_add_counts(&f->block.code.counts, &counts);
        return true;
    }
    code_add_counts(&f->block.code.counts, &counts);
    code_add_line(&f->code, s->word, s->operands);
    /* How long a loop of one block is tells a label behind it. */
    if (flow == FLOW_BRANCH && block_has_label(&f->block.code, s->operands)) {
        f->block.code.repeats = true;
        f->repeated = f->block.code.number;
    }
    if (flow != FLOW_ON) leave_block(f, flow != FLOW_AWAY);
    return true;
}

/* A label that something refers to may be jumped to: a block begins there. Others are ignored,
 * so that the debugging information changes no count. */
static void take_label(struct filter *f, struct span name)
{
    const bool local = span_starts(name, ".L");
    if (f->in_asm) {
        f->branched = true;
        return;
    }
    if (!f->now->code || (local && !label_set_has(f->referred, name))) return;
    leave_block(f, true);
    if (f->block.code.nlabel < MOST_LABELS) f->block.code.label[f->block.code.nlabel++] = name;
    if (local) return;
    loops_write(&f->code, &f->table);
    /* foo.cold is the part of foo that is seldom executed, and has its frame. */
    if (span_find(name, ".cold") < 0) f->frame = false;
    f->function = name;
}

/* Whether a statement is one that code executes: what must come behind the counter. .byte 0x66
 * begins a sequence for thread-local addresses; other data in code may be a table, which nothing
 * may be put into. */
static bool is_executed(const struct asm_statement *s)
{
    if (s->kind == ASM_DIRECTIVE) return span_is(s->word, ".byte") && span_is(s->operands, "0x66");
    return s->kind == ASM_PREFIX ||
           (s->kind == ASM_INSTRUCTION &&
            !span_starts(s->word, "endbr")); /* must stay first: it is what is jumped to */
}

/* Whether a counter comes in front of a statement. */
static bool begins_block(struct filter *f, const struct asm_statement *s)
{
    if (f->in_asm || !f->now->code || !is_executed(s) || f->holds) return false;
    /* Eight is what one instruction counts at most. */
    if (f->block.code.number != 0 && f->block.code.counts.instruction > BLOCK_MOST_INSTRUCTIONS - 8)
        leave_block(f, true);
    return f->begins || f->block.code.number == 0;
}

/* Where the name of a called function begins that moves as many bytes as its caller says; NULL:
 * another statement. Calls of these become calls of mimdsim_NAME (guest/memory.S), which counts the
 * bytes and goes on to NAME. In the library itself they must not be replaced: it may keep something
 * in register 15. */
static const char *moved_name(const struct filter *f, const struct asm_statement *s)
{
    static const char *const moves[] = {"memcpy", "memmove", "memset", NULL};
    if (s->kind != ASM_INSTRUCTION || f->in_asm || !f->now->code) return NULL;
    if (!span_starts(s->word, "call") && !span_starts(s->word, "jmp")) return NULL;
    const char *name = s->operands.s + (s->operands.n > 0 && s->operands.s[0] == '*');
    const struct span rest = {name, (int)(s->operands.s + s->operands.n - name)};
    for (int i = 0; moves[i] != NULL; i++) {
        const int n = (int)strlen(moves[i]);
        if (span_starts(rest, moves[i]) && (rest.n == n || name[n] == '@')) return name;
    }
    return NULL;
}

/* Where a name begins that becomes mimdsim_body.NAME: the label of a function that has an entry, or
 * a call of it that need not go through that; NULL: nothing of this kind. */
static const char *body_name(const struct filter *f, const struct asm_statement *s)
{
    if (f->entries == NULL || f->in_asm) return NULL;
    if (s->kind == ASM_LABEL) return entries_guarded(f->entries, s->word) ? s->word.s : NULL;
    if (s->kind != ASM_INSTRUCTION ||
        !(span_starts(s->word, "call") || span_starts(s->word, "jmp")))
        return NULL;
    int n = 0;
    while (n < s->operands.n && s->operands.s[n] != '@') n++;
    return entries_direct(f->entries, (struct span){s->operands.s, n}) ? s->operands.s : NULL;
}

/* At its end, .size f, .-f, a function gets its entry. */
static bool ends_body(struct filter *f, const struct asm_statement *s)
{
    const struct span name = asm_operand(s->operands, 0);
    if (f->entries == NULL || f->in_asm || s->kind != ASM_DIRECTIVE || !span_is(s->word, ".size"))
        return false;
    if (!f->now->code || !entries_guarded(f->entries, name)) return false;
    entries_write(f->entries, name, f->out);
    return true;
}

/* The statements of one line. It is copied in pieces, as a counter may come between a label and
 * what follows it. */
static bool take_line(struct filter *f, const char *line, const char *end)
{
    const char *at = line, *copied = line;
    for (struct asm_statement s; (s = asm_next(&at, end)).kind != ASM_NOTHING;) {
        if (s.kind == ASM_LABEL) take_label(f, s.word);
        else if (s.kind == ASM_DIRECTIVE && change_section(f, &s)) continue;
        else if (s.kind == ASM_DIRECTIVE && span_is(s.word, ".ident")) f->compiler = s.operands;
        if (s.kind != ASM_LABEL && begins_block(f, &s)) {
            text_add_bytes(f->out, copied, (size_t)(s.begin - copied));
            if (memchr(copied, ':', (size_t)(s.begin - copied)) != NULL) text_add(f->out, "\n\t");
            copied = s.begin;
            begin_block(f);
            text_add(f->out, "\t");
        }
        const char *moved = moved_name(f, &s), *named = moved != NULL ? moved : body_name(f, &s);
        if (named != NULL) {
            text_add_bytes(f->out, copied, (size_t)(named - copied));
            text_add(f->out, moved != NULL ? "mimdsim_" : "mimdsim_body.");
            copied = named;
        }
        if (ends_body(f, &s)) return true;
        if ((s.kind == ASM_INSTRUCTION || s.kind == ASM_PREFIX) && f->now->code &&
            !take_instruction(f, &s))
            return false;
    }
    text_add_bytes(f->out, copied, (size_t)(end - copied));
    text_add(f->out, "\n");
    if (f->repeated != 0) text_add(f->out, ".Lmimdsim_t%d:\n", f->repeated);
    f->repeated = 0;
    return true;
}

/* gcc writes asm statements between these lines. What control may leave or enter in the middle ends
 * its block. */
static void take_asm_mark(struct filter *f, bool opens)
{
    const bool between = f->begins || f->block.code.number == 0;
    if (opens && f->now->code && f->reached && between && !f->holds) {
        text_add(f->out, "\t");
        begin_block(f);
    }
    if (!opens && f->branched && f->block.code.number != 0) leave_block(f, true);
    f->in_asm = opens;
    f->branched = false;
}

/* A line marker of the preprocessor, # 12 "sum.c" 1: the place of the line behind it. */
static void take_line_marker(struct filter *f, struct span line)
{
    int number = 0, i = 2;
    while (i < line.n && line.s[i] >= '0' && line.s[i] <= '9' && number < 100000000)
        number = 10 * number + (line.s[i++] - '0');
    const char *open = memchr(line.s, '"', (size_t)line.n);
    const char *close =
        open != NULL ? memchr(open + 1, '"', (size_t)(line.s + line.n - open - 1)) : NULL;
    if (i == 2 || close == NULL) return;
    f->line = number - 1; /* of this line, so that the next is `number` */
    f->file = (struct span){open + 1, (int)(close - open - 1)};
}

/* The second pass: every line is copied, with counters where blocks begin. */
static bool write_text(struct filter *f, const struct text *in)
{
    const char *stop = in->s + in->length;
    for (const char *line = in->s, *end; line < stop; line = end + 1) {
        end = memchr(line, '\n', (size_t)(stop - line));
        if (end == NULL) end = stop;
        const struct span whole = {line, (int)(end - line)};
        f->line++;
        if (span_is(whole, "#APP")) take_asm_mark(f, true);
        if (span_is(whole, "#NO_APP")) take_asm_mark(f, false);
        if (span_starts(whole, "# ")) take_line_marker(f, whole);
        if (!take_line(f, line, end)) return false;
    }
    leave_block(f, false);
    write_entries(f);
    return true;
}

/* The first pass: labels that code, tables of jumps or tables of landing pads refer to. Of what
 * debugging tells nobody jumps anywhere. */
static void find_referred(struct label_set *set, const struct text *in)
{
    const char *stop = in->s + in->length;
    bool debug = false;
    for (const char *at = in->s, *end; at < stop; at = end + 1) {
        end = memchr(at, '\n', (size_t)(stop - at));
        if (end == NULL) end = stop;
        for (struct asm_statement s; (s = asm_next(&at, end)).kind != ASM_NOTHING;) {
            if (span_is(s.word, ".section") || span_is(s.word, ".pushsection"))
                debug = is_debug_section(s.operands);
            else if (span_is(s.word, ".text") || span_is(s.word, ".popsection") ||
                     span_is(s.word, ".previous"))
                debug = false;
            if (debug || s.kind == ASM_LABEL || span_starts(s.word, ".cfi_") ||
                span_is(s.word, ".loc"))
                continue;
            label_set_put_local(set, s.operands);
        }
    }
}

/* Text between quotes of the assembler. */
static void add_quoted(struct text *out, struct span s)
{
    for (int i = 0; i < s.n; i++) {
        if (s.s[i] == '"' || s.s[i] == '\\') text_add(out, "\\");
        text_add(out, "%c", s.s[i]);
    }
}

/* The note tells the loader's and the linker's checks that the object is counted, by which rules
 * (BLOCK_TABLE_ABI), and from what it was made. Format: gABI, "Note Section". */
void block_note(const struct block_source *source, const char *compiler, int n, struct text *out)
{
    text_add(out, "\t.section " BLOCK_NOTE_SECTION ",\"a\",@note\n\t.balign 4\n");
    text_add(out, "\t.long %zu, .Lmimdsim_n1-.Lmimdsim_n0, %d\n\t.asciz \"" BLOCK_NOTE_NAME "\"\n",
             sizeof BLOCK_NOTE_NAME, BLOCK_NOTE_OBJECT);
    text_add(out, ".Lmimdsim_n0:\n\t.long %d\n\t.asciz \"", BLOCK_TABLE_ABI);
    add_quoted(out, (struct span){source->name, (int)strlen(source->name)});
    text_add(out, "; %.*s; ", n, compiler);
    add_quoted(out, (struct span){source->flags, (int)strlen(source->flags)});
    text_add(out, "\"\n.Lmimdsim_n1:\n\t.balign 4\n");
}

/* Text that has the note was filtered before, as when a make rule assembles what -S wrote. */
bool block_filter(const struct text *in, const struct block_source *source, struct text *out,
                  struct err *e)
{
    if (in->length == 0) return true;
    if (memmem(in->s, in->length, BLOCK_NOTE_SECTION, strlen(BLOCK_NOTE_SECTION)) != NULL) {
        text_add_bytes(out, in->s, in->length);
        return true;
    }
    struct arena *arena = arena_create();
    struct filter f = {
        .source = source, .arena = arena, .referred = label_set_make(arena), .out = out, .e = e};
    f.code.arena = arena;
    f.now = f.before = section_named(&f, (struct span){".text", 5});
    f.file = (struct span){source->name, (int)strlen(source->name)};
    find_referred(f.referred, in);
    if (source->guarded) f.entries = entries_find(in, arena);
    bool fine = write_text(&f, in);
    if (fine && span_find(f.compiler, "clang") >= 0)
        fine = err_set_at(e, ERR_DATA, source->name, 0,
                          "compiled by clang, which cannot keep a register free; "
                          "`mimdsim cc` works with gcc");
    /* .ident has quotes. */
    if (fine && f.entries != NULL) entries_end(f.entries, out);
    if (fine && f.compiler.n > 2) block_note(source, f.compiler.s + 1, f.compiler.n - 2, out);
    else if (fine) block_note(source, "assembly", 8, out);
    text_free(&f.table);
    arena_destroy(arena);
    return fine;
}

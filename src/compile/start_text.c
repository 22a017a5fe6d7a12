/* start_text.c - PT_INTERP and an entry for shared objects. */
#include "compile/start_text.h"

#include <string.h>

#include "compile/block_filter.h"

/* The kernel starts a shared object as a program when it has an entry and names a dynamic linker
 * (psABI 5.2.1). The linker of the system then relocates it and runs no constructor of it, as it
 * leaves these to a program's own start code. main may be hidden by -fvisibility=hidden;
 * mimdsim_main is what the loader finds. */
void start_text(struct text *out, const char *program, bool kernel)
{
    text_add(out, "\t.section .interp,\"a\",@progbits\n"
                  "\t.asciz \"/lib64/ld-linux-x86-64.so.2\"\n"
                  "\t.section .rodata\n"
                  "mimdsim_program_path:\n\t.asciz \"");
    for (const char *s = program; *s != '\0'; s++)
        text_add(out, strchr("\"\\", *s) ? "\\%c" : "%c", *s);
    text_add(out, "\"\n"
                  "\t.text\n"
                  "\t.globl mimdsim_start\n"
                  "\t.type mimdsim_start, @function\n"
                  "mimdsim_start:\n"
                  "\txorl %%ebp, %%ebp\n"
                  "\tmovq %%rsp, %%rdi\n" /* argc, argv, NULL, environment */
                  "\tleaq mimdsim_program_path(%%rip), %%rsi\n"
                  "\tandq $-16, %%rsp\n"
                  "\tcall mimdsim_execute\n"
                  "\tud2\n"
                  "\t.size mimdsim_start, .-mimdsim_start\n");
    if (!kernel)
        text_add(out, "\t.globl mimdsim_main\n"
                      "\t.type mimdsim_main, @function\n"
                      "mimdsim_main:\n"
                      "\tjmp main\n"
                      "\t.size mimdsim_main, .-mimdsim_main\n");
    static const char by[] = "mimdsim";
    block_note(&(struct block_source){"start", "", true, false}, by, sizeof by - 1, out);
    text_add(out, "\t.section .note.GNU-stack,\"\",@progbits\n");
}

/* enter.c - calls from the simulator into a program, and out of it by exit.
 *
 * Programs count computing time in register r15, which nobody saves there (compiled with
 * -ffixed-r15), while the host expects it back as it was. So every call goes through loader_enter,
 * which keeps the host's registers. */
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/check.h"
#include "loader/template.h"

#ifdef __x86_64__
/* psABI 3.2.1: rbx, rbp, r12 to r15, the control words of x87 and SSE belong to the caller. No
 * unwind information on purpose: an exception that nobody catches ends here, and the C++ library
 * then calls terminate. */
__asm__(
    ".text\n"
    ".globl loader_enter\n"
    ".hidden loader_enter\n"
    ".type loader_enter, @function\n"
    "loader_enter:\n"
    "    push %rbp\n    push %rbx\n    push %r12\n    push %r13\n    push %r14\n    push %r15\n"
    "    sub $24, %rsp\n"    /* the stack is aligned to 16 at the call below */
    "    mov %rdx, (%rsp)\n" /* frame */
    "    stmxcsr 8(%rsp)\n"
    "    fnstcw 12(%rsp)\n"
    "    mov %rsp, (%rdx)\n" /* frame->stack, for loader_leave */
    "    mov %rdi, %rax\n"
    "    mov %rsi, %r11\n"
    "    mov (%r11), %rdi\n    mov 8(%r11), %rsi\n    mov 16(%r11), %rdx\n    mov 24(%r11), %rcx\n"
    "    mov 32(%r11), %r8\n    mov 40(%r11), %r9\n"
    "    xor %r15d, %r15d\n"
    "    call *%rax\n"
    "    mov (%rsp), %rdx\n"
    "    mov %r15, 8(%rdx)\n" /* frame->count */
    "loader_return:\n"
    "    ldmxcsr 8(%rsp)\n"
    "    fldcw 12(%rsp)\n"
    "    add $24, %rsp\n"
    "    pop %r15\n    pop %r14\n    pop %r13\n    pop %r12\n    pop %rbx\n    pop %rbp\n"
    "    ret\n"
    ".size loader_enter, . - loader_enter\n"
    ".globl loader_leave\n"
    ".hidden loader_leave\n"
    ".type loader_leave, @function\n"
    "loader_leave:\n"
    "    mov (%rdi), %rsp\n"
    "    movq $0, 8(%rdi)\n" /* what was counted has been handed over before */
    "    mov %rsi, %rax\n"
    "    jmp loader_return\n"
    ".size loader_leave, . - loader_leave\n");
#else
int64_t loader_enter(void *function, const int64_t argument[6], struct loader_frame *frame)
{
    (void)function, (void)argument, (void)frame;
    CHECK(!"loader_open refuses programs on this host");
    return 0;
}
_Noreturn void loader_leave(struct loader_frame *frame, int64_t value)
{
    (void)frame, (void)value;
    check_failed(__FILE__, __LINE__, "loader_open refuses programs on this host");
}
#endif

/* A call into the program. Calls nest when the program calls the simulator and that calls back;
 * the outermost one is where exit() leads to. */
struct loader_outcome loader_call_six(struct loader_instance *i, void *function,
                                      const int64_t argument[6])
{
    struct loader_frame frame = {.outer = i->frame};
    const bool outermost = i->outermost == NULL;
    if (outermost) {
        i->text = function;
        i->outermost = &frame;
        i->stack = (uintptr_t)__builtin_frame_address(0);
    }
    i->exited = false;
    i->frame = &frame;
    const int64_t value = loader_enter(function, argument, &frame);
    i->frame = frame.outer;
    if (outermost) i->outermost = NULL;
    /* Functions that are called through their entries (`mimdsim cc`) leave their count in memory.
     */
    if (i->pending) {
        frame.count += *i->pending;
        *i->pending = 0;
    }
    if (frame.count && i->t->hooks->elapse_ps) i->t->hooks->elapse_ps(i->context, frame.count);
    return (struct loader_outcome){
        .exited = i->exited, .status = i->exited ? i->status : 0, .value = value};
}

/* Four arguments are enough for all but MPI's attribute functions. */
struct loader_outcome loader_call(struct loader_instance *i, void *function,
                                  const int64_t argument[4])
{
    const int64_t six[6] = {argument[0], argument[1], argument[2], argument[3]};
    return loader_call_six(i, function, six);
}

/* Places whose values only the program's own code knows: functions chosen by the processor's
 * abilities. Afterwards the constants of all files are closed against writing, where mappings are
 * left for it. */
static bool finish_relocation(struct loader_instance *i, struct loader_outcome *o)
{
    const struct loader_template *t = i->t;
    const int64_t none[4] = {0};
    for (size_t n = 0; n < t->nindirect; n++) {
        *o = loader_call(i, i->base + t->indirect[n].resolver, none);
        if (o->exited) return false;
        memcpy(i->base + t->indirect[n].place, &o->value, sizeof o->value);
    }
    for (int n = 0; n < t->nfile && t->relro; n++) {
        const struct loader_file *f = &t->file[n];
        uint64_t begin = f->place + f->elf.relro.p_vaddr, end = begin + f->elf.relro.p_memsz;
        begin = begin / LOADER_PAGE * LOADER_PAGE;
        end = end / LOADER_PAGE * LOADER_PAGE;
        if (f->elf.relro.p_memsz && begin >= f->data && end <= f->end && begin < end)
            mprotect(i->base + begin, end - begin, PROT_READ);
    }
    return true;
}

/* Call the function at place `at` unless it stands for none. */
static bool call_at(struct loader_instance *i, uint64_t function, const int64_t argument[4],
                    struct loader_outcome *o)
{
    if (function == 0 || function == UINT64_MAX) return true;
    *o = loader_call(i, (void *)(uintptr_t)function, argument);
    return !o->exited;
}

/* Entries of the arrays of constructors and destructors were relocated: they are addresses. */
static uint64_t array_entry(const struct loader_instance *i, const struct loader_file *f,
                            uint64_t array, size_t k)
{
    uint64_t function;
    memcpy(&function, i->base + f->place + array + 8 * k, sizeof function);
    return function;
}

/* Kept as a call of its own, with these arguments, for a debugger. */
#ifndef __clang__
__attribute__((noclone)) /* which clang does not know, and does not do */
#endif
__attribute__((noinline)) void
loader_debug_stop(int rank, const char *file, uint64_t base)
{
    __asm__ volatile("" : : "r"(rank), "r"(file), "r"(base) : "memory");
}

/* What the system's loader does before main: relocations that need code, then constructors,
 * those of libraries first (gABI 5, "Initialization and Termination Functions"). */
struct loader_outcome loader_start(struct loader_instance *i, int argc, char **argv)
{
    const int64_t argument[4] = {argc, (int64_t)(intptr_t)argv, (int64_t)(intptr_t)environ, 0};
    const struct loader_template *t = i->t;
    struct loader_outcome o = {0};
    loader_debug_stop(i->host.rank, t->file[0].elf.path,
                      (uint64_t)(uintptr_t)i->base + t->file[0].place);
    if (!finish_relocation(i, &o)) return o;
    /* The archive's own beginning (guest/streams.c) comes before the constructors of libraries,
     * which may print. */
    if (!call_at(i, (uint64_t)(uintptr_t)loader_symbol(i, "mimdsim_begin"), argument, &o)) return o;
    for (int n = 0; n < t->nfile; n++) {
        const struct loader_file *f = &t->file[t->order[n]];
        const uint64_t base = (uint64_t)(uintptr_t)i->base + f->place;
        if (f->elf.init && !call_at(i, base + f->elf.init, argument, &o)) return o;
        for (size_t k = 0; k < f->elf.ninit; k++)
            if (!call_at(i, array_entry(i, f, f->elf.init_array, k), argument, &o)) return o;
    }
    return o;
}

/* What happens after main or exit; an exit in a destructor ends it. */
void loader_finish(struct loader_instance *i)
{
    const int64_t none[4] = {0};
    const struct loader_template *t = i->t;
    struct loader_outcome o;
    /* The reverse of the constructors' order, within the files, too (gABI 5, "Termination
     * Functions"). */
    for (int n = t->nfile; n-- > 0;) {
        const struct loader_file *f = &t->file[t->order[n]];
        for (size_t k = f->elf.nfini; k-- > 0;)
            if (!call_at(i, array_entry(i, f, f->elf.fini_array, k), none, &o)) return;
        if (f->elf.fini &&
            !call_at(i, (uint64_t)(uintptr_t)i->base + f->place + f->elf.fini, none, &o))
            return;
    }
}

/* As return from main: the program's own exit runs what atexit was given. */
struct loader_outcome loader_exit(struct loader_instance *i, int status)
{
    void *leave = loader_symbol(i, "mimdsim_exit");
    if (!leave) return (struct loader_outcome){.exited = true, .status = status};
    return loader_call(i, leave, (const int64_t[4]){status});
}

/* Constructors, main, destructors; the status is the one a shell would see. */
int loader_main(struct loader_instance *i, int argc, char **argv)
{
    struct loader_outcome o = loader_start(i, argc, argv);
    if (o.exited) return o.status;
    /* `mimdsim cc` names it, too, as main itself may be hidden. */
    void *main_function = loader_symbol(i, "mimdsim_main");
    if (main_function == NULL) main_function = loader_symbol(i, "main");
    CHECK(main_function); /* the caller has looked */
    o = loader_call(i, main_function,
                    (const int64_t[4]){argc, (int64_t)(intptr_t)argv, (int64_t)(intptr_t)environ});
    if (!o.exited) o = loader_exit(i, (int)o.value);
    return o.status;
}

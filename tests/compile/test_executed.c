/* test_executed.c - every block that is executed is counted once each time, seen by executing
 * programs step by step.
 *
 * Programs of tests/compile/programs are compiled twice: as they are, and through the filter. The
 * counted one runs with the processor's trap flag on, so that a signal comes after each
 * instruction; a tally is kept of each address. All instructions from one counter to the next must
 * have been executed as often as the counter, the sum in r15 must be that of the tally, and the
 * answer must be that of the program as it is. */
#include <dlfcn.h>
#include <link.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <ucontext.h>
#include <unistd.h>

#include <cmocka.h>

#include "compile/block_filter.h"
#include "loader/block_costs.h"

#ifdef __x86_64__

/* long step_through(long (*guest)(void), long *counted): calls guest with r15 = 0 and the trap flag
 * set; *counted becomes r15. */
long step_through(long (*guest)(void), long *counted);
__asm__(".text\n.globl step_through\nstep_through:\n"
        "\tpush %r15\n\tpush %rbx\n\tpush %rbp\n\tmov %rsi, %rbx\n\txor %r15d, %r15d\n"
        "\tpushf\n\torl $0x100, (%rsp)\n\tpopf\n"
        "\tcall *%rdi\n"
        "\tpushf\n\tandl $~0x100, (%rsp)\n\tpopf\n"
        "\tmov %r15, (%rbx)\n\tpop %rbp\n\tpop %rbx\n\tpop %r15\n\tret\n");

/* Where functions with entries leave what they counted; in an image it is in guest/host.c. */
extern long mimdsim_pending;
long mimdsim_pending;

/* What counted code calls in place of these functions; in an image they come from guest/memory.S.
 */
void *mimdsim_memcpy(void *to, const void *from, size_t n);
void *mimdsim_memcpy(void *to, const void *from, size_t n) { return memcpy(to, from, n); }
void *mimdsim_memset(void *to, int byte, size_t n);
void *mimdsim_memset(void *to, int byte, size_t n) { return memset(to, byte, n); }

/* The image that is stepped through: its code, and how often each address of it was executed. */
struct image {
    unsigned char *code, *end;
    uint32_t *tally;
    struct block_table table;
    const unsigned char *base;
};
static struct image *stepped;

static void on_step(int signal, siginfo_t *info, void *context)
{
    (void)signal, (void)info;
    const ucontext_t *u = context;
    const unsigned char *at = (const unsigned char *)(uintptr_t)u->uc_mcontext.gregs[REG_RIP];
    if (at >= stepped->code && at < stepped->end) stepped->tally[at - stepped->code]++;
}

static void *image_at(const void *image, uint64_t address, size_t size)
{
    const struct image *i = image;
    unsigned char *at = (unsigned char *)(uintptr_t)i->base + address;
    return at >= i->code && at + size <= i->end ? at : NULL;
}

static int find_code(struct dl_phdr_info *info, size_t size, void *image)
{
    (void)size;
    struct image *i = image;
    if ((const unsigned char *)info->dlpi_addr != i->base) return 0;
    for (int k = 0; k < info->dlpi_phnum; k++)
        if (info->dlpi_phdr[k].p_type == PT_LOAD && (info->dlpi_phdr[k].p_flags & PF_X)) {
            i->code = (unsigned char *)info->dlpi_addr + info->dlpi_phdr[k].p_vaddr;
            i->end = i->code + info->dlpi_phdr[k].p_memsz;
        }
    return 1;
}

/* --- building --- */

static void shell(const char *format, ...) __attribute__((format(printf, 1, 2)));
static void shell(const char *format, ...)
{
    char command[2048];
    va_list a;
    va_start(a, format);
    vsnprintf(command, sizeof command, format, a);
    va_end(a);
    if (system(command) != 0) fail_msg("%s", command);
}

static const char *compiler_of(const char *file)
{
    const char *dot = strrchr(file, '.');
    return strcmp(dot, ".c") == 0 ? "gcc" : strcmp(dot, ".cc") == 0 ? "g++" : "gfortran";
}

/* file.s -> file.o through the filter, or as it is. */
static void assemble(const char *dir, int k, bool counted, bool guarded)
{
    char path[256];
    struct text in = {0}, out = {0};
    struct err e;
    err_clear(&e);
    snprintf(path, sizeof path, "%s/%d.s", dir, k);
    if (!text_read_file(&in, path, &e)) fail_msg("%s", e.text);
    const struct block_source source = {path, "", false, guarded};
    if (counted && !block_filter(&in, &source, &out, &e)) fail_msg("%s", e.text);
    snprintf(path, sizeof path, "%s/%d-%d.s", dir, k, counted);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fwrite(counted ? out.s : in.s, 1, counted ? out.length : in.length, f);
    fclose(f);
    shell("gcc -c %s -o %s/%d-%d.o", path, dir, k, counted);
    text_free(&in);
    text_free(&out);
}

/* The functions that tell of the table; not counted themselves. */
static const char probe[] =
    "extern char b[] __asm__(\"__start_mimdsim_blocks\") __attribute__((weak, "
    "visibility(\"hidden\")));extern char e[] __asm__(\"__stop_mimdsim_blocks\") "
    "__attribute__((weak, visibility(\"hidden\")));char *table_begin(void) { return b; } char "
    "*table_end(void) { return e; }";

struct program {
    const char *file[2];
    const char *flags, *link;
};

static void build(const struct program *p, const char *dir, bool counted)
{
    const char *root = getenv("MIMDSIM_SRCDIR") ? getenv("MIMDSIM_SRCDIR") : ".";
    char objects[512] = "";
    for (int k = 0; k < 2 && p->file[k] != NULL; k++) {
        shell("%s -S -fPIC -ffixed-r15 -mstringop-strategy=libcall -fno-ipa-ra %s -o %s/%d.s "
              "%s/tests/compile/programs/%s",
              compiler_of(p->file[k]), p->flags, dir, k, root, p->file[k]);
        assemble(dir, k, counted, strcmp(compiler_of(p->file[k]), "gfortran") != 0);
        snprintf(objects + strlen(objects), sizeof objects - strlen(objects), " %s/%d-%d.o", dir, k,
                 counted);
    }
    shell("echo '%s' | gcc -O1 -fPIC -x c -c -o %s/p.o -", probe, dir);
    shell("%s -shared -Wl,-z,now %s -o %s/%d.so %s %s/p.o -lm", compiler_of(p->file[0]), p->link,
          dir, counted, objects, dir);
}

/* --- what must hold, in the child --- */

static void wrong(const char *format, ...) __attribute__((format(printf, 1, 2), noreturn));
static void wrong(const char *format, ...)
{
    va_list a;
    va_start(a, format);
    vfprintf(stderr, format, a);
    va_end(a);
    fputc('\n', stderr);
    _exit(1);
}

static int by_address(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* Padding, and the mark of places that may be jumped to, which comes before the counter. */
static bool is_filler(const unsigned char *at)
{
    return *at == 0x90 || (at[0] == 0x66 && at[1] == 0x90) || (at[0] == 0x0f && at[1] == 0x1f) ||
           (at[0] == 0x66 && (at[1] == 0x0f || at[1] == 0x66 || at[1] == 0x2e)) ||
           memcmp(at, "\xf3\x0f\x1e\xfa", 4) == 0;
}

/* Addresses of the *n counters, each with the number of its entry; the code's end behind them.
 * Entries of loops have none. */
static uint64_t *counters(const struct image *i, size_t *n)
{
    *n = 0;
    uint64_t *place = calloc(i->table.n + 1, 2 * sizeof *place);
    if (place == NULL) wrong("no memory");
    for (size_t k = 0; k < i->table.n; k++) {
        if (i->table.entry[k].kind != BLOCK_ADD) continue;
        const unsigned char *imm =
            (const unsigned char *)&i->table.entry[k] + i->table.entry[k].immediate;
        place[2 * *n] = (uint64_t)(imm - BLOCK_ADD_OPCODE_BYTES - i->code);
        place[2 * (*n)++ + 1] = k;
    }
    qsort(place, *n, 2 * sizeof *place, by_address);
    place[2 * *n] = (uint64_t)(i->end - i->code);
    return place;
}

/* An entry (compile/entries.h), which is not counted: push %r15; xor %r15d, %r15d; call. */
static const char entry_begins[] = "\x41\x57\x45\x31\xff\xe8";
static const char pad_begins[] = "\x4d\x01\x3b\x48\x89\xc7"; /* add %r15, (%r11); mov %rax, %rdi */
enum { ENTRY_BYTES = 23, PAD_BYTES = 18, PAD_BEGINS = 7 };

/* Returns the sum that r15 must be. */
static long judge(const struct image *i, const char *name)
{
    size_t n;
    uint64_t *place = counters(i, &n);
    long sum = 0, executed = 0;
    for (size_t k = 0; k < n; k++) {
        const struct block_counts *c = &i->table.entry[place[2 * k + 1]].counts;
        const uint32_t times = i->tally[place[2 * k]];
        int instructions = 0;
        for (uint64_t x = place[2 * k] + 1; x < place[2 * k + 2]; x++) {
            if (memcmp(i->code + x, entry_begins, sizeof entry_begins - 1) == 0) {
                const unsigned char *pad = i->code + x + ENTRY_BYTES + PAD_BEGINS;
                x += ENTRY_BYTES - 1;
                if (memcmp(pad, pad_begins, sizeof pad_begins - 1) == 0) x += PAD_BYTES;
                continue;
            }
            if (i->tally[x] == 0 || is_filler(i->code + x)) continue;
            instructions++;
            if (i->tally[x] != times)
                wrong("%s: code at %#lx was executed %u times, its counter at %#lx %u times", name,
                      (unsigned long)x, i->tally[x], (unsigned long)place[2 * k], times);
        }
        if (times > 0 && instructions > c->instruction)
            wrong("%s: %d instructions behind %#lx, counted %u", name, instructions,
                  (unsigned long)place[2 * k], c->instruction);
        sum += (long)times * c->instruction;
        executed += (long)times * instructions;
    }
    free(place);
    if (executed < 500) wrong("%s: nothing was executed", name);
    return sum;
}

static long run_plain(const char *dir)
{
    char path[256];
    snprintf(path, sizeof path, "%s/0.so", dir);
    void *so = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (so == NULL) wrong("%s", dlerror());
    long (*guest)(void) = (long (*)(void))dlsym(so, "guest");
    const long value = guest();
    return value;
}

/* The table of the loaded file; its code becomes writable. */
static void open_image(struct image *i, void *so)
{
    struct link_map *map;
    if (dlinfo(so, RTLD_DI_LINKMAP, &map) != 0) wrong("%s", dlerror());
    i->base = (const unsigned char *)map->l_addr;
    dl_iterate_phdr(find_code, i);
    const unsigned char *begin = ((unsigned char *(*)(void))dlsym(so, "table_begin"))();
    const unsigned char *end = ((unsigned char *(*)(void))dlsym(so, "table_end"))();
    i->table = (struct block_table){(const struct block_entry *)(const void *)begin,
                                    (size_t)(end - begin) / sizeof(struct block_entry),
                                    (uint64_t)(begin - i->base)};
    if (i->table.n == 0) wrong("no table");
    i->tally = calloc((size_t)(i->end - i->code), sizeof *i->tally);
    if (i->tally == NULL) wrong("no memory");
    const uintptr_t page = (uintptr_t)i->code & ~(uintptr_t)4095;
    assert_int_equal(
        mprotect((void *)page, (uintptr_t)i->end - page, PROT_READ | PROT_WRITE | PROT_EXEC), 0);
}

static void run_counted(const char *dir, const char *name, long value)
{
    char path[256];
    struct image i = {0};
    struct err e;
    err_clear(&e);
    snprintf(path, sizeof path, "%s/1.so", dir);
    void *so = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (so == NULL) wrong("%s", dlerror());
    open_image(&i, so);
    const struct node_cost one = {.instruction = 1};
    if (!block_costs_patch(&i.table, image_at, &i, &one, 1, &e)) wrong("%s", e.text);
    long counted[3];
    for (int k = 0; k < 3; k++) {
        stepped = &i;
        mimdsim_pending = 0;
        memset(i.tally, 0, (size_t)(i.end - i.code) * sizeof *i.tally);
        if (step_through((long (*)(void))dlsym(so, "guest"), &counted[k]) != value)
            wrong("%s: another answer with counters", name);
        const long expected = judge(&i, name);
        counted[k] += mimdsim_pending;
        if (counted[k] != expected)
            wrong("%s: r15 is %ld, the tally %ld", name, counted[k], expected);
    }
    if (counted[1] != counted[2])
        wrong("%s: other counts when repeated",
              name); /* the first also initialises static variables */
    free(i.tally);
}

/* In a process of its own that ends without destructors: these are counted code, which only the
 * loader may call. */
static void run_child(const char *dir, const char *name)
{
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        run_counted(dir, name, run_plain(dir));
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    if (status != 0) fail_msg("%s: status %#x", name, (unsigned)status);
}

static const struct program programs[] = {
    {{"control.c"}, "-O0", ""},
    {{"control.c"}, "-O1 -g", ""},
    {{"control.c"}, "-O2 -g3 -fcf-protection=full", ""},
    {{"control.c"}, "-O3 -ffast-math -ffunction-sections", "-Wl,--gc-sections"},
    {{"control.c"}, "-Os -fno-plt -mavx2 -mfma", ""},
    {{"control.c"}, "-O3 -funroll-loops -fno-omit-frame-pointer", ""},
    {{"throwing.cc", "boxes.cc"}, "-O0 -g", ""},
    {{"throwing.cc", "boxes.cc"}, "-O2 -std=c++17", ""},
    {{"throwing.cc", "boxes.cc"}, "-O3 -g -ffunction-sections", "-Wl,--gc-sections"},
    {{"sums.f90"}, "-O0", ""},
    {{"sums.f90"}, "-O2 -g", ""},
    {{"sums.f90"}, "-O3 -ffast-math", ""},
};

/* The address sanitizer takes __cxa_throw for itself, and finds no C++ library behind it in a test
 * that is written in C. */
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define EXCEPTIONS_ARE_TAKEN true
#endif
#endif
#ifndef EXCEPTIONS_ARE_TAKEN
#define EXCEPTIONS_ARE_TAKEN false
#endif

static void what_is_executed_is_counted_once(void **state)
{
    (void)state;
    char dir[] = "executed-XXXXXX";
    assert_non_null(mkdtemp(dir));
    char *full = realpath(dir, NULL);
    for (unsigned k = 0; k < sizeof programs / sizeof programs[0]; k++) {
        const struct program *p = &programs[k];
        char name[128], probe_command[128];
        snprintf(name, sizeof name, "%s %s", p->file[0], p->flags);
        snprintf(probe_command, sizeof probe_command, "%s --version >/dev/null 2>&1",
                 compiler_of(p->file[0]));
        if (system(probe_command) != 0) continue;
        if (EXCEPTIONS_ARE_TAKEN && strcmp(p->file[0], "throwing.cc") == 0) continue;
        if (strstr(p->flags, "avx2") &&
            !(__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")))
            continue;
        build(p, full, false);
        build(p, full, true);
        run_child(full, name);
    }
    shell("rm -rf '%s'", full);
    free(full);
}

int main(void)
{
    if (system("gcc --version >/dev/null 2>&1") != 0) return 77;
    static unsigned char stack[65536];
    sigaltstack(&(stack_t){.ss_sp = stack, .ss_size = sizeof stack}, NULL);
    struct sigaction action = {.sa_sigaction = on_step, .sa_flags = SA_SIGINFO | SA_ONSTACK};
    sigaction(SIGTRAP, &action, NULL);
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_executed_is_counted_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else
int main(void) { return 77; }
#endif

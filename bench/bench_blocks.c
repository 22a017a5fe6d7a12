/* bench_blocks.c - what counting blocks costs, and how near the counted time is to this host's.
 *
 * blocks_kernels.c is compiled by gcc, and by `mimdsim cc`; each kernel runs as both in turn, in
 * the same process, and the shortest times are compared. The counted time is that of a node of the
 * machine smp-node (2.4 Gflop/s, 3 GHz). Usage: bench_blocks [-O1|-O2|-O3] in the build folder. */
#include <dlfcn.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/progress.h"
#include "loader/block_costs.h"

#ifdef __x86_64__

/* call_counted: calls f with r15 = 0 and returns what it counted. */
int64_t call_counted(void (*f)(void));
__asm__(".text\n.globl call_counted\ncall_counted:\n"
        "\tpush %r15\n\txor %r15d, %r15d\n\tcall *%rdi\n\tmov %r15, %rax\n\tpop %r15\n\tret\n");

static const char *const kernels[] = {
    "triad_memory", "triad_cache", "dot",       "matrix_product", "stencil",   "sparse_product",
    "pull_bodies",  "sines",       "quicksort", "chase",          "fibonacci", "histogram"};
enum { KERNELS = sizeof kernels / sizeof kernels[0], ROUNDS = 15 };

static const struct node_spec node = {.flop_rate = 2.4e9,
                                      .clock = 3e9,
                                      .div_cycles = 14,
                                      .sqrt_cycles = 18,
                                      .trig_cycles = 50,
                                      .copy_bandwidth = 12e9};

static void shell(const char *format, const char *a, const char *b, const char *c)
{
    char command[4096];
    snprintf(command, sizeof command, format, a, b, c);
    if (system(command) != 0) {
        fprintf(stderr, "%s\n", command);
        exit(1);
    }
}

static void *opened(const char *path)
{
    void *so = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (so != NULL) return so;
    fprintf(stderr, "%s\n", dlerror());
    exit(1);
}

static void *image_at(const void *image, uint64_t address, size_t size)
{
    (void)size;
    return (char *)(uintptr_t)image + address;
}

/* The loaded library's blocks get the node's costs; its text is made writable for that. The table
 * is found by the symbols that the linker makes of the section's name. */
static void patch(void *so)
{
    struct link_map *map;
    struct err e;
    err_clear(&e);
    dlinfo(so, RTLD_DI_LINKMAP, &map);
    const char *base = (const char *)map->l_addr;
    const char *(*begin)(void) = (const char *(*)(void))dlsym(so, "table_begin");
    const char *(*end)(void) = (const char *(*)(void))dlsym(so, "table_end");
    const struct block_table t = {(const struct block_entry *)(const void *)begin(),
                                  (size_t)(end() - begin()) / sizeof(struct block_entry),
                                  (uint64_t)(begin() - base)};
    const struct node_cost cost = node_cost_make(&node);
    const size_t text = 1 << 20;
    mprotect((void *)(uintptr_t)base, text, PROT_READ | PROT_WRITE | PROT_EXEC);
    if (!block_costs_patch(&t, image_at, base, &cost, 1, &e)) err_print(&e), exit(1);
}

static void measure(void *plain, void *counted, const char *name, int64_t *pending, double *sum,
                    double *sum_ratio)
{
    double shortest[2] = {1e30, 1e30};
    int64_t ps = 0;
    void (*f[2])(void) = {(void (*)(void))dlsym(plain, name), (void (*)(void))dlsym(counted, name)};
    for (int r = 0; r < 2 * ROUNDS; r++) {
        const double begin = host_processor_seconds();
        *pending = 0; /* where the kernel's entry leaves what it counted */
        if (r % 2) ps = call_counted(f[1]) + *pending;
        else f[0]();
        const double took = host_processor_seconds() - begin;
        if (took < shortest[r % 2]) shortest[r % 2] = took;
    }
    printf("%-16s %10.3f %10.3f %8.3f %12.3f %10.2f\n", name, shortest[0] * 1e3, shortest[1] * 1e3,
           shortest[1] / shortest[0], (double)ps * 1e-9, (double)ps * 1e-12 / shortest[0]);
    *sum += 1;
    *sum_ratio += shortest[1] / shortest[0];
}

int main(int argc, char **argv)
{
    static const char probe[] =
        "extern char b[] __asm__(\"__start_mimdsim_blocks\"), e[] "
        "__asm__(\"__stop_mimdsim_blocks\");"
        "long mimdsim_pending;"
        "void *memset(void *, int, unsigned long);"
        "void *mimdsim_memset(void *a, int x, unsigned long n) { return memset(a, x, n); }"
        "char *table_begin(void) { return b; } char *table_end(void) { return e; }";
    const char *level = argc > 1 ? argv[1] : "-O2",
               *source = MIMDSIM_SRCDIR "/bench/blocks_kernels.c";
    char dir[] = "blocks-XXXXXX", path[64];
    if (mkdtemp(dir) == NULL) return 1;
    shell("gcc %s -fPIC -shared -o %s/plain.so %s -lm", level, dir, source);
    shell("printf '%%s' '%s' >%s/probe.c", probe, dir, "");
    shell("./mimdsim-cc %s -c -o %s/kernels.o %s", level, dir, source);
    shell("gcc -O1 -fPIC -c -o %s/probe.o %s/probe.c%s", dir, dir, "");
    shell("gcc -shared -Wl,-z,separate-code -o %s/counted.so %s/kernels.o %s/probe.o -lm", dir, dir,
          dir);
    snprintf(path, sizeof path, "%s/plain.so", dir);
    void *plain = opened(path);
    snprintf(path, sizeof path, "%s/counted.so", dir);
    void *counted = opened(path);
    patch(counted);
    call_counted((void (*)(void))dlsym(plain, "fill"));
    call_counted((void (*)(void))dlsym(counted, "fill"));
    double n = 0, sum = 0;
    int64_t *pending = dlsym(counted, "mimdsim_pending");
    printf("%s: shortest of %d, processor time\n%-16s %10s %10s %8s %12s %10s\n", level, ROUNDS,
           "kernel", "plain/ms", "counted/ms", "ratio", "predicted/ms", "pred/plain");
    for (int k = 0; k < KERNELS; k++) measure(plain, counted, kernels[k], pending, &n, &sum);
    printf("mean ratio %.3f\n", sum / n);
    shell("rm -r %s%s%s", dir, "", "");
    return 0;
}

#else
int main(void) { return 77; }
#endif

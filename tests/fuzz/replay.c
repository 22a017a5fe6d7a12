/* replay.c - a harness without libFuzzer: runs every file of a folder, each within the stated time
 * and memory.
 *
 *     fuzz_units [-n COUNT] [-s SEED] [FILE|FOLDER...]      by default the corpus of the harness in
 * the source tree
 *
 * -n: that many changed inputs, too, each a file of the corpus with some of the harness's own
 * changes. Nothing guides them, which makes them many times as fast as libFuzzer's. An input that
 * breaks the program ends the process; the name of its file is told then, and it is kept as
 * broken-NAME in the working directory. */
#include "fuzz.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "base/random.h"
#include "config.h"

/* Sanitizers make programs several times slower; the limit of memory is theirs to break. */
#ifdef SANITIZERS
enum { SLOWER = 10 };
#else
enum { SLOWER = 1 };
#endif

enum { MOST_FILES = 4096, MOST_BYTES = 8192 };

static const char *program_name = "fuzz";
static char running[1024], kept[256];
static const uint8_t *running_data;
static size_t running_size;
static long count, failed;
static double slowest;
static struct random chance;

/* Files of the corpus that are small enough to be changed. */
static struct {
    char *name;
    uint8_t *data;
    size_t size;
} file[MOST_FILES];
static size_t nfile;

/* A few bytes changed, removed, repeated: what libFuzzer does without looking. */
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most)
{
    static const uint8_t hurt[] = {0, 1, 0x7f, 0x80, 0xff, '0', '-', '\n', ' ', '"'};
    size_t at = size ? random_below(&chance, size) : 0, n = 1 + random_below(&chance, 8);
    if (n > size - at) n = size - at;
    switch (random_below(&chance, 5)) {
    case 0:
        if (size > 0) data[at] ^= (uint8_t)(1 << random_below(&chance, 8));
        return size;
    case 1:
        if (size > 0) data[at] = hurt[random_below(&chance, sizeof hurt)];
        return size;
    case 2:
        memmove(data + at, data + at + n, size - at - n);
        return size - n;
    case 3:
        if (size + n > most) return size;
        memmove(data + at + n, data + at, size - at);
        return size + n;
    default:
        if (size + 1 > most) return size;
        memmove(data + at + 1, data + at, size - at);
        data[at] = (uint8_t)random_below(&chance, 256);
        return size + 1;
    }
}

/* Calls that signal handlers may make. */
static void keep_input(void)
{
    int fd = open(kept, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ssize_t ignored = write(2, "\nbroken by ", 11);
    ignored += write(2, running, strlen(running));
    ignored += write(2, "; kept as ", 10) + write(2, kept, strlen(kept)) + write(2, "\n", 1);
    if (fd >= 0) ignored += write(fd, running_data, running_size);
    (void)ignored;
}

static void tell_file(int number)
{
    keep_input();
    signal(number, SIG_DFL);
    raise(number);
}

/* Memory that the system refuses ends the process without a signal. */
static void tell_exit(void)
{
    if (running_data != NULL) keep_input();
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void run_input(const uint8_t *data, size_t size)
{
    /* a copy of its own on the heap, so that reading behind its end is seen */
    uint8_t *copy = malloc(size ? size : 1);
    CHECK(copy != NULL);
    if (size > 0) memcpy(copy, data, size);
    running_data = copy;
    running_size = size;
    fuzz_allow(FUZZ_SECONDS);
    double begin = now();
    LLVMFuzzerTestOneInput(copy, size);
    double took = now() - begin;
    if (took > fuzz_allowed() * SLOWER) {
        fprintf(stderr, "%s: %.1f s, more than %.1f s\n", running, took, fuzz_allowed() * SLOWER);
        keep_input();
        failed++;
    }
    running_data = NULL;
    if (took > slowest) slowest = took;
    count++;
    free(copy);
}

static void run_file(const char *path)
{
    FILE *in = fopen(path, "rb");
    if (in == NULL) {
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        failed++;
        return;
    }
    snprintf(running, sizeof running, "%s", path);
    fseek(in, 0, SEEK_END);
    size_t size = (size_t)ftell(in);
    rewind(in);
    uint8_t *data = malloc(size + 1);
    CHECK(data != NULL && fread(data, 1, size, in) == size);
    fclose(in);
    fuzz_whole(true);
    run_input(data, size);
    fuzz_whole(false);
    if (nfile == MOST_FILES || size > MOST_BYTES) {
        free(data);
        return;
    }
    file[nfile].name = strdup(path);
    file[nfile].data = data;
    file[nfile++].size = size;
}

/* One to four changes of a file of the corpus. */
static void run_changed(long n)
{
    static uint8_t data[MOST_BYTES];
    for (long i = 0; i < n && nfile > 0; i++) {
        size_t which = random_below(&chance, nfile), size = file[which].size;
        snprintf(running, sizeof running, "a change of %s", file[which].name);
        memcpy(data, file[which].data, size);
        for (uint64_t k = 1 + random_below(&chance, 4); k > 0; k--)
            size = LLVMFuzzerCustomMutator(data, size, MOST_BYTES,
                                           (unsigned)random_below(&chance, 1u << 31));
        run_input(data, size);
    }
}

/* In the order of their names, so that every run is the same one. */
static void run_all(const char *path)
{
    struct dirent **entry;
    int n = scandir(path, &entry, NULL, alphasort);
    if (n < 0) {
        run_file(path);
        return;
    }
    for (int i = 0; i < n; i++) {
        char name[1024];
        snprintf(name, sizeof name, "%s/%s", path, entry[i]->d_name);
        if (entry[i]->d_name[0] != '.') run_file(name);
        free(entry[i]);
    }
    free(entry);
}

/* tests/fuzz/fuzz_units: "units". */
static const char *harness_of(const char *program)
{
    const char *name = strstr(program, "fuzz_");
    for (const char *next = name; next != NULL; next = strstr(next + 1, "fuzz_")) name = next;
    return name ? name + 5 : program;
}

static void limit_memory(void)
{
#ifndef SANITIZERS
    const struct rlimit limit = {(rlim_t)FUZZ_MEGABYTES << 20, (rlim_t)FUZZ_MEGABYTES << 20};
    setrlimit(RLIMIT_AS, &limit);
#endif
}

int main(int argc, char **argv)
{
    static const int deadly[] = {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTERM};
    long changed = 0;
    uint64_t seed = 1;
    for (int c; (c = getopt(argc, argv, "n:s:")) != -1;) {
        if (c == '?') return 64;
        *(c == 'n' ? &changed : (long *)&seed) = strtol(optarg, NULL, 10);
    }
    program_name = harness_of(argv[0]);
    snprintf(kept, sizeof kept, "broken-%s-%d", program_name, (int)getpid());
    for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++) signal(deadly[i], tell_file);
    atexit(tell_exit);
    limit_memory();
    chance = random_make(seed, 0, 0);
    char corpus[1024];
    snprintf(corpus, sizeof corpus, "%s/tests/fuzz/corpus/%s", MIMDSIM_SRCDIR, program_name);
    if (optind == argc) run_all(corpus);
    for (int i = optind; i < argc; i++) run_all(argv[i]);
    run_changed(changed);
    for (size_t i = 0; i < nfile; i++) free(file[i].name), free(file[i].data);
    printf("%s: %ld inputs, the slowest took %.3f s\n", program_name, count, slowest);
    if (failed == 0 && count > 0) printf("[  PASSED  ] %ld test(s).\n", count);
    return failed > 0 || count == 0;
}

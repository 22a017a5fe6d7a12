/* fuzz.c - files, numbers and refusals of the harnesses (fuzz.h). */
#include "fuzz.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[128];
static FILE *sink;
static double allowed = FUZZ_SECONDS;
static bool whole;

static int remove_entry(const char *path, const struct stat *s, int kind, struct FTW *w)
{
    (void)s, (void)kind, (void)w;
    return remove(path), 0;
}

static void remove_folder(void) { nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS); }

void fuzz_allow(double seconds) { allowed = seconds; }

double fuzz_allowed(void) { return allowed; }

void fuzz_whole(bool all) { whole = all; }

bool fuzz_is_whole(void) { return whole; }

/* FNV-1a, its high half: the low bits alone depend on the low bits of the bytes alone. */
size_t fuzz_choice(const uint8_t *data, size_t size)
{
    uint64_t h = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < size; i++) h = (h ^ data[i]) * UINT64_C(1099511628211);
    return (size_t)(h >> 32);
}

/* A file system in memory: millions of inputs are written. */
const char *fuzz_folder(void)
{
    if (folder[0] != '\0') return folder;
    const char *base = getenv("TMPDIR");
    if (base == NULL || strlen(base) > 80)
        base = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : P_tmpdir;
    snprintf(folder, sizeof folder, "%s/fuzz-XXXXXX", base);
    CHECK(mkdtemp(folder) != NULL);
    atexit(remove_folder);
    return folder;
}

const char *fuzz_file(const char *name, const void *data, size_t size)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", fuzz_folder(), name);
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    CHECK(fd >= 0);
    CHECK(write(fd, data, size) == (ssize_t)size);
    close(fd);
    return path;
}

void fuzz_data(void) { setenv("MIMDSIM_DATA", MIMDSIM_SRCDIR, 0); }

/* Memory that the system refuses ends the process (check_memory), so ERR_INTERNAL is no refusal of
 * an input. */
void fuzz_refused(const struct err *e)
{
    CHECK(e->kind == ERR_DATA || e->kind == ERR_NO_INPUT || e->kind == ERR_CONFIG ||
          e->kind == ERR_USAGE || e->kind == ERR_UNAVAILABLE);
    CHECK(e->text[0] != '\0');
}

char *fuzz_text(const uint8_t *data, size_t size)
{
    char *s = malloc(size + 1);
    CHECK(s != NULL);
    if (size > 0) memcpy(s, data, size);
    s[size] = '\0';
    return s;
}

void *fuzz_sink(void)
{
    if (sink == NULL) sink = fopen("/dev/null", "w");
    CHECK(sink != NULL);
    return sink;
}

uint64_t fuzz_take(struct fuzz_bytes *b, int n)
{
    uint64_t x = 0;
    for (int i = 0; i < n; i++) x = x << 8 | (b->at < b->end ? *b->at++ : 0);
    return x;
}

unsigned fuzz_below(struct fuzz_bytes *b, unsigned n)
{
    return n <= 1 ? 0 : (unsigned)(fuzz_take(b, n > 256 ? 2 : 1) % n);
}

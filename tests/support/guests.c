/* guests.c - programs for the tests of room loader: compiled, loaded, run on fibers. */
#include "config.h"

#include "support/guests.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "loader/crash.h"
#include "sim/fiber.h"
#include "support/scratch.h"

#ifdef SANITIZERS
/* Programs leave memory behind, which goes with the worker process; here there is none. */
const char *__asan_default_options(void);
const char *__asan_default_options(void) { return "detect_leaks=0"; }
#endif

struct rank {
    struct guests *g;
    struct loader_instance *instance;
    struct fiber *fiber;
    int number, n, column;
    char **argument;
    bool over;
};

/* The compiler of a source file: $CC for C, else GNU's. Flags are those that `mimdsim cc` needs. */
static const char *compiler(const char *source, const char **flags)
{
    const char *end = strrchr(source, '.'), *cc = getenv("CC");
    *flags = strcmp(end, ".cc") == 0 ? "-static-libstdc++ -static-libgcc" : "";
    if (strcmp(end, ".cc") == 0) return "g++";
    if (strcmp(end, ".f90") == 0) return "gfortran";
    return cc && *cc ? cc : "cc";
}

void guests_build(const char *folder, const char *source, const char *options, char path[512])
{
    char command[4096];
    const char *build = getenv("MIMDSIM_BUILDDIR"), *top = getenv("MIMDSIM_SRCDIR"), *flags;
    const char *cc = compiler(source, &flags), *last = strrchr(cc, ' ');
    /* $CC may have two words ("ccache gcc"); the last one is what must be there. */
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", last ? last + 1 : cc);
    if (!build || !top || system(command) != 0) {
        printf("skipped: no compiler %s for %s, or not started by `make check`\n", cc, source);
        skip();
    }
    scratch_path(path, 512, folder, "guest");
    snprintf(
        command, sizeof command,
        "%s -g -shared -fPIC -Wl,-Bsymbolic %s %s -I%s/include -o %s %s/tests/loader/programs/%s "
        "-Wl,--whole-archive %s/libmimdsim-guest.a -Wl,--no-whole-archive -lm >%s.log 2>&1 || "
        "{ cat %s.log; false; }",
        cc, flags, options, top, path, top, source, build, path, path);
    assert_int_equal(system(command), 0);
}

static void take_output(void *context, int stream, const char *data, size_t n)
{
    struct rank *r = context;
    struct guests *g = r->g;
    (void)stream;
    for (size_t i = 0; i < n && g->used < GUEST_OUTPUT - 16; i++) {
        if (r->column++ == 0) g->used += sprintf(g->output + g->used, "%d: ", r->number);
        g->output[g->used++] = data[i];
        if (data[i] == '\n') r->column = 0;
    }
    g->output[g->used] = '\0';
}

static int64_t now_ps(void *context)
{
    const struct rank *r = context;
    return r->g->clock_ps[r->number];
}

static void elapse_ps(void *context, int64_t ps)
{
    const struct rank *r = context;
    r->g->clock_ps[r->number] += ps;
}

static void sleep_ps(void *context, int64_t ps)
{
    struct rank *r = context;
    r->g->clock_ps[r->number] += ps;
    fiber_leave(r->fiber);
}

static void fail_run(void *context, const char *text)
{
    struct rank *r = context;
    if (r->g->failed_rank < 0) {
        r->g->failed_rank = r->number;
        snprintf(r->g->failure, sizeof r->g->failure, "%s", text);
    }
    r->over = true;
    for (;;) fiber_leave(r->fiber);
}

static void rank_main(void *argument)
{
    struct rank *r = argument;
    r->g->status[r->number] = loader_main(r->instance, r->n, r->argument);
    r->over = true;
}

bool guests_run(const char *path, int nrank, int n, char **argument, struct guests *g)
{
    static const struct loader_hooks hooks = {now_ps,      elapse_ps, sleep_ps,
                                              take_output, fail_run,  NULL};
    *g = (struct guests){.failed_rank = -1};
    assert_true(nrank <= GUEST_RANKS);
    struct loader_template *t = loader_open(path, &g->error);
    if (!t || !loader_reserve(t, nrank, &hooks, &g->error)) {
        loader_close(t);
        return false;
    }
    struct fiber_pool *p = fiber_pool_create(nrank, 8 << 20, &g->error);
    assert_non_null(p);
    crash_watch(t, 1 << 20, NULL);
    struct rank rank[GUEST_RANKS];
    for (int i = 0; i < nrank; i++) {
        rank[i] = (struct rank){.g = g, .number = i, .n = n, .argument = argument};
        rank[i].instance = loader_instantiate(t, i, &rank[i], &g->error);
        assert_non_null(rank[i].instance);
        rank[i].fiber = fiber_start(p, i, rank_main, &rank[i]);
    }
    for (int left = nrank; left;) {
        left = 0;
        for (int i = 0; i < nrank; i++)
            if (!rank[i].over && fiber_enter(rank[i].fiber) && !rank[i].over) left++;
    }
    crash_forget(t);
    fiber_pool_destroy(p);
    loader_close(t);
    return true;
}

void guests_expect(const char *folder, const char *source, const char *options, const char *output)
{
    static struct guests g;
    char path[512], *argument[] = {"guest", NULL};
    guests_build(folder, source, options, path);
    if (!guests_run(path, 2, 1, argument, &g)) fail_msg("%s", g.error.text);
    if (g.failed_rank >= 0) fail_msg("rank %d: %s\n%s", g.failed_rank, g.failure, g.output);
    assert_string_equal(g.output, output);
}

/* runtime.c - what programs ask of the simulator whatever they are: time, output, ends
 * (mimdsim/host.h). */
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "config.h"

#include "base/check.h"
#include "base/escape.h"
#include "loader/template.h"

#ifdef SANITIZERS
#include <sanitizer/asan_interface.h>
#endif

static struct loader_instance *instance_of(struct mimdsim_host *host) { return host->instance; }

/* The hooks without a look at the instance: a rank that is switched in finds its host cold in
 * memory, and one line of it is enough. The runtime's functions stand in the template. */
static const struct loader_hooks *hooks_of(const struct mimdsim_host *host)
{
    const size_t before = offsetof(struct loader_template, runtime);
    return ((const struct loader_template *)(const void *)((const char *)host->runtime - before))
        ->hooks;
}

/* Simulated time; a test without hooks stands still at 0. */
static int64_t now_ps(struct mimdsim_host *host)
{
    const struct loader_hooks *h = hooks_of(host);
    return h->now_ps ? h->now_ps(host->context) : 0;
}

/* Computing time that the program's counter has added up. */
static void elapse_ps(struct mimdsim_host *host, int64_t ps)
{
    const struct loader_hooks *h = hooks_of(host);
    if (h->elapse_ps) h->elapse_ps(host->context, ps);
}

/* Time that passes without computing, as in nanosleep. */
static void sleep_ps(struct mimdsim_host *host, int64_t ps)
{
    const struct loader_hooks *h = hooks_of(host);
    if (h->sleep_ps) h->sleep_ps(host->context, ps);
}

/* Without a hook a rank writes to the process's own streams; what cannot be written is lost as it
 * is to a closed pipe. */
static void output(struct mimdsim_host *host, int stream, const char *data, size_t n)
{
    struct loader_instance *i = instance_of(host);
    if (i->t->hooks->output) i->t->hooks->output(i->context, stream, data, n);
    else escape_raw(stream == 2 ? 2 : 1, data, n);
}

/* Destructors, and what atexit was given, from within the program. */
static void finish(struct mimdsim_host *host) { loader_finish(instance_of(host)); }

/* The frames between are dropped, also those of the simulator when it has called back into the
 * program. */
static void leave(struct mimdsim_host *host, int status)
{
    struct loader_instance *i = instance_of(host);
    CHECK(i->outermost);
    i->exited = true;
    i->status = status;
#ifdef SANITIZERS
    __asan_handle_no_return();
#endif
    loader_leave(i->outermost, status);
}

/* "compute (my.c:17): calls fork()": the place before the text, where the files tell it. */
static void fail(struct mimdsim_host *host, const void *place, const char *text)
{
    struct loader_instance *i = instance_of(host);
    char where[512], whole[1024];
    if (loader_place_text(i, place, __builtin_frame_address(0), where, (int)sizeof where))
        snprintf(whole, sizeof whole, "%s: %s", where, text);
    else snprintf(whole, sizeof whole, "%s", text);
    if (i->t->hooks->fail) i->t->hooks->fail(i->context, whole);
    fprintf(stderr, "mimdsim: rank %d: %s\n", host->rank, whole);
    leave(host, 1);
}

/* Program headers of file n in this rank's copy: C++ finds its unwind tables by them. */
static int module(struct mimdsim_host *host, int n, uintptr_t *base, const void **headers,
                  int *count)
{
    const struct loader_instance *i = instance_of(host);
    if (n < 0 || n >= i->t->nfile) return 0;
    const struct loader_file *f = &i->t->file[n];
    *base = (uintptr_t)i->base + (uintptr_t)f->place;
    *headers = f->elf.header;
    *count = f->elf.nheader;
    return 1;
}

/* Work that the author states himself (mimdsim_compute). */
static void compute(struct mimdsim_host *host, double flops, double bytes)
{
    const struct loader_hooks *h = hooks_of(host);
    if (h->compute) h->compute(host->context, flops, bytes);
}

/* The functions' table is one for all ranks; the host struct of each rank points to it. */
void runtime_fill(struct mimdsim_runtime *r)
{
    *r = (struct mimdsim_runtime){.size = sizeof *r,
                                  .now_ps = now_ps,
                                  .elapse_ps = elapse_ps,
                                  .sleep_ps = sleep_ps,
                                  .output = output,
                                  .finish = finish,
                                  .leave = leave,
                                  .fail = fail,
                                  .module = module,
                                  .compute = compute};
}

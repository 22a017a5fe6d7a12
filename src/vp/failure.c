/* failure.c - a program has done wrong: the run ends, and says who, when, where and what. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/check.h"
#include "vp/explain.h"
#include "vp/vp.h"

/* Programs are compiled anywhere: folders are of no use in a report, and would differ
 * between computers. */
const char *vp_base_name(const char *path)
{
    const char *slash = path ? strrchr(path, '/') : NULL;
    return slash ? slash + 1 : path ? path : "?";
}

void vp_record_failure(struct vp *v, const char *file, int line, const char *text)
{
    struct world *w = v->world;
    struct run_result *r = w->result;
    /* One failure is told; those that follow are often its consequences. */
    if (w->whole->stopped) return;
    w->whole->stopped = true;
    w->whole->failed = w->failed = true;
    /* What is not a call of comm.h has a text that says where it is. */
    char place[128] = "";
    if (file) snprintf(place, sizeof place, " (%s:%d)", vp_base_name(file), line);
    snprintf(r->text, sizeof r->text, "rank %d in %s at %.9g s%s: %s", v->comm.rank,
             r->stage_name[v->stage], (double)(v->clock - w->start) / SIM_PS_PER_S, place, text);
}

/* The loop in world.c sees `stopped` and enters no fiber again; a rank that blocks here
 * costs nothing. */
_Noreturn static void stop(struct vp *v)
{
    for (;;) vp_block(v, WAITING_NOTHING, NULL);
}

void vp_fail(struct comm *c, const char *text)
{
    struct vp *v = (struct vp *)c;
    vp_record_failure(v, c->file, c->line, text);
    stop(v);
}

/* A kernel of this project that errs has a bug, and the process ends where it is;
 * somebody else's program ends its run, and others go on. */
void vp_misuse(struct vp *v, const char *format, ...)
{
    char text[512];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (!v->world->load->foreign)
        check_failed(v->comm.file ? v->comm.file : "?", v->comm.line, text);
    vp_fail(&v->comm, text);
}

/* Found by whoever delivers the message, so that the rank that receives may be at rest. */
void size_mismatch(struct vp *v, const struct comm_request *r, const struct message *m)
{
    char text[512];
    /* The rank of the receive is told, not that of the send: its call has the size that
     * did not fit. */
    snprintf(
        text, sizeof text,
        "a receive of exactly %lld bytes from rank %d, tag %lld, meets a message of %lld bytes",
        (long long)r->bytes, m->from->comm.rank, (long long)m->tag, (long long)m->bytes);
    if (!v->world->load->foreign) check_failed(r->file ? r->file : "?", r->line, text);
    vp_record_failure(v, r->file, r->line, text);
}

/* Times of a run that failed would look like results in tables: only the text stays. */
void forget_parts(struct world *w)
{
    struct run_result *r = w->result;
    r->stage = NULL;
    r->finish_ps = NULL;
    r->nspan = 0;
}

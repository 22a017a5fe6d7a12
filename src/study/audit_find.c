/* audit_find.c - the list of the contradictions that the parts of the audit find
 * (audit_rules.h). */
#include <stdarg.h>
#include <stdio.h>

#include "study/audit_rules.h"

void audit_find(struct audit_report *r, int64_t run, const char *rule, const char *format, ...)
{
    char text[512];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    /* Count all, keep the first: a broken database may contradict itself a million times. */
    if (r->nfinding++ >= AUDIT_KEPT) return;
    r->finding[r->nfinding - 1] = (struct audit_finding){
        .run = run, .rule = arena_text(r->arena, rule), .text = arena_text(r->arena, text)};
}

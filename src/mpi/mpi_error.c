/* mpi_error.c - what a program does wrong: classes, texts, handlers.
 *
 * Under MPI_ERRORS_RETURN a call returns its class; a handler of the program is called first. Else
 * the run ends as failed (comm_fail) with the call, the place in the program and what is wrong. */
#include <stdarg.h>
#include <stdio.h>

#include "mpi/mpi_internal.h"

/* Classes and codes that the program added: codes LASTCODE + 1 + i. Section 9.5: a
 * program may add classes and codes of its own, at any time and differently on each rank.
 * The table has an end, behind which
 * a call fails. */
enum { MOST_ADDED = 256, FIRST_ADDED = MPI_ERR_LASTCODE + 1 };
struct mpi_errors {
    int n;
    struct {
        int class; /* its class; a class is its own */
        char *text;
        bool there;
    } of[MOST_ADDED];
};

/* In the order of the standard's numbers (ABI chapter): class is index. */
static const char *const class_text[] = {"no error",
                                         "invalid buffer",
                                         "invalid count",
                                         "invalid datatype",
                                         "invalid tag",
                                         "invalid communicator",
                                         "invalid rank",
                                         "invalid request",
                                         "invalid root",
                                         "invalid group",
                                         "invalid operation",
                                         "invalid topology",
                                         "invalid dimension",
                                         "invalid argument",
                                         "unknown error",
                                         "message truncated",
                                         "other error",
                                         "internal error",
                                         "pending request",
                                         "error in a status",
                                         "permission denied",
                                         "invalid access mode",
                                         "invalid assertion",
                                         "invalid file name",
                                         "invalid base",
                                         "conversion failed",
                                         "invalid displacement",
                                         "data representation exists",
                                         "file exists",
                                         "file in use",
                                         "invalid file",
                                         "key too long",
                                         "no such key",
                                         "value too long",
                                         "invalid info",
                                         "input or output failed",
                                         "invalid keyval",
                                         "invalid lock type",
                                         "no such name",
                                         "no memory",
                                         "arguments differ between ranks",
                                         "no space",
                                         "no such file",
                                         "invalid port",
                                         "quota exceeded",
                                         "read only",
                                         "memory cannot be attached",
                                         "conflicting accesses",
                                         "outside of the window",
                                         "memory cannot be shared",
                                         "wrong synchronization",
                                         "no such service",
                                         "invalid size",
                                         "processes cannot be started",
                                         "data representation not supported",
                                         "operation not supported",
                                         "invalid window",
                                         "wrong kind of window",
                                         "process aborted",
                                         "value too large",
                                         "invalid session",
                                         "invalid error handler",
                                         "invalid binary interface"};
enum { NCLASS = sizeof class_text / sizeof class_text[0] };

/* mpi_call_program: a function of the program, on its own terms. The host may have to
 * account for computing and switch what belongs to the program (setup->call); tests call
 * plainly. Six words are the most that any callback has; one with fewer ignores the rest,
 * which the calling convention allows. */
intptr_t mpi_call_program(struct mpi_rank *r, void *function, const intptr_t argument[6])
{
    const struct mpi_setup *s = r->world->setup;
    typedef intptr_t six(intptr_t, intptr_t, intptr_t, intptr_t, intptr_t, intptr_t);
    if (s->call) return s->call(r->host, (void (*)(void))(intptr_t)function, argument);
    six *f = (six *)(intptr_t)function;
    return f(argument[0], argument[1], argument[2], argument[3], argument[4], argument[5]);
}

/* The place in the program comes from the return address of the call, if anybody can look
 * it up. */
_Noreturn void mpi_fail(struct mpi_rank *r, const char *text)
{
    char place[256] = "", all[1280];
    const struct mpi_setup *s = r->world->setup;
    if (s->place && r->address) s->place(r->host, r->address, place, sizeof place);
    snprintf(all, sizeof all, "%s%s%s: %s", r->call, place[0] ? " in " : "", place, text);
    comm_fail(r->comm, all);
}

/* The handler that counts: the communicator's, else the world's. Handles' errors have no
 * communicator. Before MPI_Init there is no world either: then errors are fatal. */
static struct mpi_errhandler *handler_of(struct mpi_rank *r, struct mpi_comm *c)
{
    if (!c || !c->handler) c = r->world_comm;
    return c ? c->handler : NULL;
}

int mpi_error(struct mpi_rank *r, struct mpi_comm *c, int code, const char *format, ...)
{
    struct mpi_errhandler *h = handler_of(r, c);
    char text[768];
    va_list list;
    if (h && !h->function && h->code == (int)(intptr_t)MPI_ERRORS_RETURN) return code;
    if (h && h->function) return mpi_error_handled(r, c ? c : r->world_comm, h, code);
    /* A text is made only where somebody reads it: MPI_ERRORS_RETURN may be part of a
     * program's loop. */
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    mpi_fail(r, text);
}

/* The function gets pointers to the handle and to the code (section 9.3), and may return:
 * the call then returns the code. A window's own handler comes here with the window. */
int mpi_error_handled(struct mpi_rank *r, void *object, struct mpi_errhandler *h, int code)
{
    struct mpi_comm *c = object;
    void *handle = c == r->world_comm  ? (void *)MPI_COMM_WORLD
                   : c == r->self_comm ? (void *)MPI_COMM_SELF
                                       : mpi_handle(object);
    int seen = code;
    const char *call = r->call;
    mpi_call_program(r, (void *)(intptr_t)h->function,
                     (intptr_t[6]){(intptr_t)&handle, (intptr_t)&seen});
    /* The handler may have called MPI itself, which changed the name of the call in
     * progress. */
    r->call = call;
    return code;
}

/* --- the program's own classes and codes --- */

/* Few programs add codes, so the table is made by the first. */
static struct mpi_errors *errors_of(struct mpi_rank *r)
{
    if (!r->errors) r->errors = mpi_take_zero(r->world, sizeof *r->errors);
    return r->errors;
}

/* Removed codes keep their numbers: none is given twice. */
static int added(struct mpi_rank *r, int code)
{
    int i = code - FIRST_ADDED;
    return r->errors && i >= 0 && i < r->errors->n && r->errors->of[i].there ? i : -1;
}

/* A class is a code of its own class, which the number 0 asks for here. */
static int add(struct mpi_rank *r, int class, int *out)
{
    struct mpi_errors *e = errors_of(r);
    if (e->n == MOST_ADDED)
        return mpi_error(r, NULL, MPI_ERR_OTHER, "more than %d codes were added", MOST_ADDED);
    e->of[e->n].there = true;
    e->of[e->n].text = NULL;
    *out = FIRST_ADDED + e->n;
    e->of[e->n++].class = class ? class : *out;
    return MPI_SUCCESS;
}

/* The value of MPI_LASTUSEDCODE: it grows with each addition and never shrinks. */
int mpi_last_code(struct mpi_rank *r) { return FIRST_ADDED - 1 + (r->errors ? r->errors->n : 0); }

int mpi_add_error_class(struct mpi_rank *self, int *errorclass) { return add(self, 0, errorclass); }

int mpi_add_error_code(struct mpi_rank *self, int errorclass, int *errorcode)
{
    return add(self, errorclass, errorcode);
}

/* Texts of the standard's codes cannot be changed (section 9.5). */
int mpi_add_error_string(struct mpi_rank *self, int errorcode, const char *string)
{
    int i = added(self, errorcode);
    if (i < 0)
        return mpi_error(self, NULL, MPI_ERR_ARG, "%d is no code that the program added",
                         errorcode);
    mpi_give(self->world, self->errors->of[i].text);
    self->errors->of[i].text = mpi_take_text(self->world, string);
    return MPI_SUCCESS;
}

/* MPI 4.1 added removal; the number stays used. */
static int remove_code(struct mpi_rank *r, int code)
{
    int i = added(r, code);
    if (i < 0) return mpi_error(r, NULL, MPI_ERR_ARG, "%d is no code that the program added", code);
    mpi_give(r->world, r->errors->of[i].text);
    r->errors->of[i].text = NULL;
    r->errors->of[i].there = false;
    return MPI_SUCCESS;
}

int mpi_remove_error_class(struct mpi_rank *self, int errorclass)
{
    return remove_code(self, errorclass);
}
int mpi_remove_error_code(struct mpi_rank *self, int errorcode)
{
    return remove_code(self, errorcode);
}

int mpi_remove_error_string(struct mpi_rank *self, int errorcode)
{
    int i = added(self, errorcode);
    if (i < 0)
        return mpi_error(self, NULL, MPI_ERR_ARG, "%d is no code that the program added",
                         errorcode);
    mpi_give(self->world, self->errors->of[i].text);
    self->errors->of[i].text = NULL;
    return MPI_SUCCESS;
}

/* A code of the standard is its own class. */
int mpi_error_class(struct mpi_rank *self, int errorcode, int *errorclass)
{
    int i = added(self, errorcode);
    *errorclass = i >= 0                                 ? self->errors->of[i].class
                  : errorcode >= 0 && errorcode < NCLASS ? errorcode
                                                         : MPI_ERR_UNKNOWN;
    return MPI_SUCCESS;
}

/* To the program: of a text that is too long the length is that of what is there. */
int mpi_text_out(char *to, int capacity, const char *text, int *length)
{
    snprintf(to, (size_t)capacity, "%s", text);
    *length = (int)strlen(to);
    return MPI_SUCCESS;
}

int mpi_error_string(struct mpi_rank *self, int errorcode, char *string, int *resultlen)
{
    int i = added(self, errorcode);
    const char *text = "unknown error";
    if (i >= 0) text = self->errors->of[i].text ? self->errors->of[i].text : "";
    else if (errorcode >= 0 && errorcode < NCLASS) text = class_text[errorcode];
    return mpi_text_out(string, MPI_MAX_ERROR_STRING, text, resultlen);
}

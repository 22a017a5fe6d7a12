/* mpi_attribute.c - values that the program attaches to communicators, types and windows, and names
 * of types. */
#include <stdio.h>

#include "mpi/mpi_internal.h"

/* Keyvals of the program stand above those of the standard. MPI 5.0, section 7.7
 * (Caching), has the rules; one table serves all three kinds of object. */
enum { KEYVAL_FIRST = 0x1000 };

/* One list for each rank, the newest first: few programs attach more than a handful. */
struct mpi_attribute {
    struct mpi_attribute *next;
    enum mpi_kind kind;
    const void *object;
    struct mpi_keyval *keyval; /* NULL: a name, `value` its text */
    void *value;
};

/* Returns the link that leads to the entry, so that a caller may take it out; the end of
 * the list when there is none. */
static struct mpi_attribute **find(struct mpi_rank *r, enum mpi_kind kind, const void *object,
                                   const struct mpi_keyval *keyval)
{
    struct mpi_attribute **at = &r->attributes;
    while (*at && ((*at)->kind != kind || (*at)->object != object || (*at)->keyval != keyval))
        at = &(*at)->next;
    return at;
}

/* handle_of: what a function of the program gets for an object. */
static void *handle_of(struct mpi_rank *r, enum mpi_kind kind, const void *object)
{
    if (kind == KIND_COMM) return mpi_comm_handle(r, object);
    return kind == KIND_TYPE ? (void *)mpi_type_handle(object) : mpi_handle(object);
}

/* The program's function may refuse: then the value stays and its code is the call's
 * result (section 7.7.2). It may also attach, delete or free other things, so nothing
 * found before the call is trusted after it. */
static int delete_one(struct mpi_rank *r, struct mpi_attribute **at)
{
    struct mpi_attribute *a = *at;
    struct mpi_keyval *k = a->keyval;
    if (k && k->remove) {
        const intptr_t argument[6] = {(intptr_t)handle_of(r, a->kind, a->object),
                                      KEYVAL_FIRST + k->o.number, (intptr_t)a->value,
                                      (intptr_t)k->extra};
        int code = (int)mpi_call_program(r, k->remove, argument);
        if (code != MPI_SUCCESS) return code;
        at = find(r, a->kind, a->object, k); /* the function may have changed the list */
        if (*at != a) return MPI_SUCCESS;
    }
    /* An entry without a keyval is a name, whose text belongs to this list. A keyval that
     * the program has freed ends with its last value. */
    *at = a->next;
    if (!k) mpi_give(r->world, a->value);
    else if (--k->o.uses == 0) mpi_handle_end(r, k);
    mpi_give(r->world, a);
    return MPI_SUCCESS;
}

/* The newest first, as the standard asks of the end of MPI_COMM_SELF. One deletion may
 * change the list anywhere, so the search begins again after each. The first refusal
 * stops it: the caller keeps the object. */
int mpi_attributes_end(struct mpi_rank *r, enum mpi_kind kind, const void *object)
{
    for (struct mpi_attribute **at = &r->attributes; *at;) {
        if ((*at)->kind != kind || (*at)->object != object) {
            at = &(*at)->next;
            continue;
        }
        int code = delete_one(r, at);
        if (code != MPI_SUCCESS) return code;
        at = &r->attributes;
    }
    return MPI_SUCCESS;
}

/* The list holds one use of the keyval for each value. */
static void attach(struct mpi_rank *r, enum mpi_kind kind, const void *object, struct mpi_keyval *k,
                   void *value)
{
    struct mpi_attribute *a = mpi_take(r->world, sizeof *a);
    *a = (struct mpi_attribute){r->attributes, kind, object, k, value};
    r->attributes = a;
    if (k) k->o.uses++;
}

/* copied: whether the value goes over to the copy, by the keyval's function. Without a
 * function nothing is copied (MPI_COMM_NULL_COPY_FN is 0 in the ABI); 1 stands for the
 * function that always copies, for which no call into the program is needed. */
static int copied(struct mpi_rank *r, const struct mpi_attribute *a, void **value, int *flag)
{
    struct mpi_keyval *k = a->keyval;
    *flag = 0;
    if (!k->copy) return MPI_SUCCESS;
    *flag = 1;
    *value = a->value;
    if (k->copy == (void *)1) return MPI_SUCCESS; /* MPI_COMM_DUP_FN and its like */
    const intptr_t argument[6] = {(intptr_t)handle_of(r, a->kind, a->object),
                                  KEYVAL_FIRST + k->o.number,
                                  (intptr_t)k->extra,
                                  (intptr_t)a->value,
                                  (intptr_t)value,
                                  (intptr_t)flag};
    *flag = 0;
    return (int)mpi_call_program(r, k->copy, argument);
}

/* A keyval ends with its last use. */
static void keyval_drop(struct mpi_rank *r, struct mpi_keyval *k)
{
    if (--k->o.uses == 0) mpi_handle_end(r, k);
}

/* The keyvals under which an object has values, oldest first, each with one use more; NULL: none.
 * Names are no attributes. */
static struct mpi_keyval **keyvals_of(struct mpi_rank *r, enum mpi_kind kind, const void *object,
                                      int *n)
{
    const struct mpi_attribute *a;
    *n = 0;
    for (a = r->attributes; a; a = a->next)
        *n += a->kind == kind && a->object == object && a->keyval;
    if (*n == 0) return NULL;
    struct mpi_keyval **k = mpi_take(r->world, *n * (int64_t)sizeof *k);
    int at = *n;
    for (a = r->attributes; a; a = a->next)
        if (a->kind == kind && a->object == object && a->keyval) {
            k[--at] = a->keyval;
            a->keyval->o.uses++;
        }
    return k;
}

/* Oldest first, so that the copy's list has the same order. The program's functions may change the
 * list, so each value is looked for when its turn comes. */
int mpi_attributes_copy(struct mpi_rank *r, enum mpi_kind kind, const void *from, const void *to)
{
    int n, code = MPI_SUCCESS;
    struct mpi_keyval **k = keyvals_of(r, kind, from, &n);
    for (int i = 0; i < n && code == MPI_SUCCESS; i++) {
        const struct mpi_attribute *a = *find(r, kind, from, k[i]);
        void *value = NULL;
        int flag = 0;
        if (!a) continue;
        code = copied(r, a, &value, &flag);
        if (code == MPI_SUCCESS && flag) attach(r, kind, to, k[i], value);
    }
    for (int i = 0; i < n; i++) keyval_drop(r, k[i]);
    mpi_give(r->world, k);
    return code;
}

/* --- keyvals --- */

/* A keyval is an integer and no handle, so its kind is checked at the object. Odd table
 * entries are free slots (mpi_handle.c). */
static struct mpi_keyval *keyval_of(struct mpi_rank *r, int keyval)
{
    int i = keyval - KEYVAL_FIRST;
    struct mpi_object *o =
        i >= 0 && i < r->room && !((intptr_t)r->object[i] & 1) ? r->object[i] : NULL;
    if (o && o->kind == KIND_KEYVAL) return (struct mpi_keyval *)o;
    r->code = mpi_error(r, NULL, MPI_ERR_KEYVAL, "%d is not a keyval of the program", keyval);
    return NULL;
}

/* The functions may be those for communicators, types or windows: all have the same
 * shape, and the object's handle fits one word. */
int mpi_keyval_make(struct mpi_rank *r, void *copy, void *remove, int *keyval, void *extra)
{
    struct mpi_keyval *k = mpi_take_zero(r->world, sizeof *k);
    mpi_handle_make(r, k, KIND_KEYVAL);
    k->copy = copy;
    k->remove = remove;
    k->extra = extra;
    *keyval = KEYVAL_FIRST + k->o.number;
    return MPI_SUCCESS;
}

/* Values that were attached keep the keyval. The program's own use ends once, however
 * often it frees: `freed` says so. */
int mpi_keyval_end(struct mpi_rank *r, int *keyval)
{
    struct mpi_keyval *k = keyval_of(r, *keyval);
    if (!k) return r->code;
    if (!k->freed && --k->o.uses == 0) mpi_handle_end(r, k);
    k->freed = true;
    *keyval = MPI_KEYVAL_INVALID;
    return MPI_SUCCESS;
}

/* A value that is replaced is deleted first, by the program's function, as section 7.7.2
 * asks; if that refuses, the old value stays. */
int mpi_attribute_set(struct mpi_rank *r, enum mpi_kind kind, const void *object, int keyval,
                      void *value)
{
    struct mpi_keyval *k = object ? keyval_of(r, keyval) : NULL;
    if (!k) return r->code;
    struct mpi_attribute **at = find(r, kind, object, k);
    if (*at) {
        int code = delete_one(r, at);
        if (code != MPI_SUCCESS) return code;
    }
    attach(r, kind, object, k, value);
    return MPI_SUCCESS;
}

/* `value` is where the program wants a void *: the standard types it as void * itself. */
int mpi_attribute_get(struct mpi_rank *r, enum mpi_kind kind, const void *object, int keyval,
                      void *value, int *flag)
{
    struct mpi_keyval *k = object ? keyval_of(r, keyval) : NULL;
    if (!k) return r->code;
    struct mpi_attribute *a = *find(r, kind, object, k);
    *flag = a != NULL;
    if (a) *(void **)value = a->value;
    return MPI_SUCCESS;
}

int mpi_attribute_delete(struct mpi_rank *r, enum mpi_kind kind, const void *object, int keyval)
{
    struct mpi_keyval *k = object ? keyval_of(r, keyval) : NULL;
    if (!k) return r->code;
    struct mpi_attribute **at = find(r, kind, object, k);
    if (!*at)
        return mpi_error(r, NULL, MPI_ERR_KEYVAL, "nothing is attached under keyval %d", keyval);
    return delete_one(r, at);
}

/* --- names of types and windows --- */

/* A name is an entry without a keyval: few objects have one, so none of them pays for the
 * room. */
const char *mpi_name_given(struct mpi_rank *r, enum mpi_kind kind, const void *object,
                           const char *else_)
{
    struct mpi_attribute *a = *find(r, kind, object, NULL);
    return a ? a->value : else_;
}

void mpi_name_give(struct mpi_rank *r, enum mpi_kind kind, const void *object, const char *name)
{
    struct mpi_attribute **at = find(r, kind, object, NULL);
    if (*at) delete_one(r, at);
    attach(r, kind, object, NULL, mpi_take_text(r->world, name));
}

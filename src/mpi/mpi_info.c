/* mpi_info.c - MPI_Info: keys with values, in the order in which they were set.
 *
 * Chapter 10 of MPI 5.0. Nothing acts on hints: they are kept so that programs that set
 * and ask for them work. Lists are short, so a key is searched for from the start. */
#include <ctype.h>
#include <stdio.h>

#include "mpi/mpi_internal.h"

/* MPI_INFO_NULL is no info here: calls that accept it do not look at it. */
static struct mpi_info *info_of(struct mpi_rank *r, MPI_Info handle)
{
    struct mpi_info *i = mpi_object(r, handle, KIND_INFO);
    return i ? i : mpi_bad_handle(r, handle, KIND_INFO);
}

static struct mpi_entry *entry_of(const struct mpi_info *i, const char *key)
{
    for (int k = 0; k < i->n; k++)
        if (strcmp(i->entry[k].key, key) == 0) return &i->entry[k];
    return NULL;
}

/* trimmed: without blanks at either end, as the standard asks; false: empty or longer
 * than `most`. `most` counts the byte at the end, as MPI_MAX_INFO_KEY does in C. */
static bool trimmed(char *out, const char *in, size_t most)
{
    while (isspace((unsigned char)*in)) in++;
    size_t n = strlen(in);
    while (n && isspace((unsigned char)in[n - 1])) n--;
    if (n >= most) return false;
    memcpy(out, in, n);
    out[n] = '\0';
    return true;
}

/* asked: the entry of a key as the program writes it, blanks and all. */
static struct mpi_entry *asked(struct mpi_info *i, const char *key)
{
    char k[MPI_MAX_INFO_KEY];
    return trimmed(k, key, sizeof k) ? entry_of(i, k) : NULL;
}

/* Key and value are copies of the info's own. A key that is there keeps its place in the
 * order. */
static void put(struct mpi_rank *r, struct mpi_info *i, const char *key, const char *value)
{
    struct mpi_entry *e = entry_of(i, key);
    if (e) {
        mpi_give(r->world, e->value);
        e->value = mpi_take_text(r->world, value);
        return;
    }
    /* Doubling, so that n keys cost O(n) copies in all. */
    if (i->n == i->room) {
        int room = i->room ? 2 * i->room : 4;
        struct mpi_entry *grown = mpi_take(r->world, room * (int64_t)sizeof *grown);
        if (i->n) memcpy(grown, i->entry, (size_t)i->n * sizeof *grown);
        mpi_give(r->world, i->entry);
        i->entry = grown;
        i->room = room;
    }
    i->entry[i->n++] =
        (struct mpi_entry){mpi_take_text(r->world, key), mpi_take_text(r->world, value)};
}

/* Room comes with the first key. */
int mpi_info_create(struct mpi_rank *self, MPI_Info *info)
{
    struct mpi_info *i = mpi_take_zero(self->world, sizeof *i);
    *info = mpi_handle_make(self, i, KIND_INFO);
    return MPI_SUCCESS;
}

/* Blanks at the ends go, so that Fortran's padded strings name the same keys as C's. */
int mpi_info_set(struct mpi_rank *self, MPI_Info info, const char *key, const char *value)
{
    struct mpi_info *i = info_of(self, info);
    char k[MPI_MAX_INFO_KEY], v[MPI_MAX_INFO_VAL];
    if (!i) return self->code;
    if (!trimmed(k, key, sizeof k) || !k[0])
        return mpi_error(self, NULL, MPI_ERR_INFO_KEY, "the key is empty or longer than %d",
                         MPI_MAX_INFO_KEY - 1);
    if (!trimmed(v, value, sizeof v) || !v[0])
        return mpi_error(self, NULL, MPI_ERR_INFO_VALUE, "the value is empty or longer than %d",
                         MPI_MAX_INFO_VAL - 1);
    put(self, i, k, v);
    return MPI_SUCCESS;
}

/* Keys behind it move up: their numbers follow the order in which they were set. */
int mpi_info_delete(struct mpi_rank *self, MPI_Info info, const char *key)
{
    struct mpi_info *i = info_of(self, info);
    struct mpi_entry *e = i ? asked(i, key) : NULL;
    if (!i) return self->code;
    if (!e) return mpi_error(self, NULL, MPI_ERR_INFO_NOKEY, "there is no key '%s'", key);
    /* A key that is not there is an error in this call alone; the others say so by a
     * flag. */
    mpi_give(self->world, e->key);
    mpi_give(self->world, e->value);
    memmove(e, e + 1, (size_t)(i->entry + i->n - e - 1) * sizeof *e);
    i->n--;
    return MPI_SUCCESS;
}

/* Deprecated: `valuelen` does not count the byte at the end, which is why one is added. */
int mpi_info_get(struct mpi_rank *self, MPI_Info info, const char *key, int valuelen, char *value,
                 int *flag)
{
    struct mpi_info *i = info_of(self, info);
    if (!i) return self->code;
    const struct mpi_entry *e = asked(i, key);
    *flag = e != NULL;
    if (e) snprintf(value, (size_t)valuelen + 1, "%s", e->value);
    return MPI_SUCCESS;
}

/* Its replacement counts the byte at the end, in both directions; a length of 0 asks for
 * the size alone. */
int mpi_info_get_string(struct mpi_rank *self, MPI_Info info, const char *key, int *buflen,
                        char *value, int *flag)
{
    struct mpi_info *i = info_of(self, info);
    if (!i) return self->code;
    const struct mpi_entry *e = asked(i, key);
    *flag = e != NULL;
    if (!e) return MPI_SUCCESS;
    if (*buflen > 0) snprintf(value, (size_t)*buflen, "%s", e->value);
    *buflen = (int)strlen(e->value) + 1;
    return MPI_SUCCESS;
}

/* Without the byte at the end, as in MPI_Info_get; also deprecated. */
int mpi_info_get_valuelen(struct mpi_rank *self, MPI_Info info, const char *key, int *valuelen,
                          int *flag)
{
    struct mpi_info *i = info_of(self, info);
    if (!i) return self->code;
    const struct mpi_entry *e = asked(i, key);
    *flag = e != NULL;
    if (e) *valuelen = (int)strlen(e->value);
    return MPI_SUCCESS;
}

int mpi_info_get_nkeys(struct mpi_rank *self, MPI_Info info, int *nkeys)
{
    struct mpi_info *i = info_of(self, info);
    if (!i) return self->code;
    *nkeys = i->n;
    return MPI_SUCCESS;
}

/* Numbers begin at 0 and change when a key is deleted. */
int mpi_info_get_nthkey(struct mpi_rank *self, MPI_Info info, int n, char *key)
{
    struct mpi_info *i = info_of(self, info);
    if (!i) return self->code;
    if (n < 0 || n >= i->n) return mpi_error(self, NULL, MPI_ERR_ARG, "key %d of %d", n, i->n);
    snprintf(key, MPI_MAX_INFO_KEY, "%s", i->entry[n].key);
    return MPI_SUCCESS;
}

/* Entries are put in the order of the original, so that numbers of keys are the same. */
int mpi_info_dup(struct mpi_rank *self, MPI_Info info, MPI_Info *newinfo)
{
    struct mpi_info *i = info_of(self, info);
    if (!i) return self->code;
    mpi_info_create(self, newinfo);
    for (int k = 0; k < i->n; k++)
        put(self, info_of(self, *newinfo), i->entry[k].key, i->entry[k].value);
    return MPI_SUCCESS;
}

/* Nothing else holds on to an info: it ends at once. */
int mpi_info_free(struct mpi_rank *self, MPI_Info *info)
{
    struct mpi_info *i = info_of(self, *info);
    if (!i) return self->code;
    for (int k = 0; k < i->n; k++) {
        mpi_give(self->world, i->entry[k].key);
        mpi_give(self->world, i->entry[k].value);
    }
    mpi_give(self->world, i->entry);
    mpi_handle_end(self, i);
    mpi_give(self->world, i);
    *info = MPI_INFO_NULL;
    return MPI_SUCCESS;
}

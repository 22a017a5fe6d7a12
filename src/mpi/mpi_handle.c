/* mpi_handle.c - handles: numbers for objects, checked when they come back.
 *
 * A program's object of C or Fortran is this number and nothing else: no pointer leaves
 * the simulator, so that a wrong handle is found here and crashes nothing. Every rank has
 * a table of its own. */
#include <stdio.h>

#include "mpi/mpi_internal.h"

enum { FIRST_HANDLE = 0x400 };

/* Objects lie at even addresses, so an odd word is a free slot; the rest of it is the
 * number of the next one. */
static void *free_slot(int next) { return (void *)((intptr_t)next * 2 + 1); }

/* more_room: double the table; free slots are chained by numbers, -1 ends the chain. */
static void more_room(struct mpi_rank *r)
{
    int room = r->room ? 2 * r->room : 16;
    void **object = mpi_take(r->world, room * (int64_t)sizeof *object);
    if (r->room) memcpy(object, r->object, (size_t)r->room * sizeof *object);
    for (int i = r->room; i < room; i++) object[i] = free_slot(i + 1 < room ? i + 1 : -1);
    mpi_give(r->world, r->object);
    r->free_object = r->room;
    r->object = object;
    r->room = room;
}

/* The last number freed is the first to be given again: tables stay short in programs
 * that make and free requests all the time. So a stale handle may come to stand for a
 * newer object of the same kind. */
void *mpi_handle_make(struct mpi_rank *r, void *object, enum mpi_kind kind)
{
    struct mpi_object *o = object;
    if (r->free_object < 0) more_room(r);
    int number = r->free_object;
    r->free_object = (int)((intptr_t)r->object[number] >> 1);
    r->object[number] = object;
    *o = (struct mpi_object){.kind = kind, .number = number, .uses = 1};
    r->nobject++;
    return mpi_handle(object);
}

/* The lower four bits are the kind. The standard's own handles are below 0x400 (ABI
 * chapter), so the two do not meet. */
void *mpi_handle(const void *object)
{
    const struct mpi_object *o = object;
    return (void *)(intptr_t)(FIRST_HANDLE + 16 * o->number + (int)o->kind);
}

/* The object itself is its owner's to free; it may live on without a handle. */
void mpi_handle_end(struct mpi_rank *r, void *object)
{
    struct mpi_object *o = object;
    if (o->number < 0) return;
    r->object[o->number] = free_slot(r->free_object);
    r->free_object = o->number;
    r->nobject--;
    o->number = -1;
}

/* No error here: callers decide whether a handle of another kind is one. */
void *mpi_object(struct mpi_rank *r, const void *handle, enum mpi_kind kind)
{
    intptr_t value = (intptr_t)handle - FIRST_HANDLE;
    if (value < 0 || (value & 15) != (intptr_t)kind || value >> 4 >= r->room) return NULL;
    void *object = r->object[value >> 4];
    return (intptr_t)object & 1 ? NULL : object;
}

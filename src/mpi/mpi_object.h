/* mpi_object.h - the objects that handles stand for: communicators, groups, types, requests and the
 * rest.
 *
 * A handle that the standard does not fix is 0x400 + 16 * number + kind: it fits an INTEGER of
 * Fortran, and one of the wrong kind or of an object that was freed is noticed. */
#ifndef MPI_MPI_OBJECT_H
#define MPI_MPI_OBJECT_H

#include <stdbool.h>

#include "comm/comm.h"
#include <mimdsim/mpi_table.h>

enum mpi_kind {
    KIND_COMM = 1,
    KIND_GROUP,
    KIND_TYPE,
    KIND_OP,
    KIND_REQUEST,
    KIND_INFO,
    KIND_ERRHANDLER,
    KIND_WIN,
    KIND_MESSAGE,
    KIND_KEYVAL
};

/* Every object begins with this. */
struct mpi_object {
    enum mpi_kind kind;
    int number; /* of the handle, -1: has none */
    int uses;   /* of the handle and by other objects */
};

/* Ranks of the world: listed, or first, first + step, ... */
struct mpi_group {
    struct mpi_object o;
    int size, rank; /* rank: the own, MPI_UNDEFINED */
    int first, step;
    int *list;  /* (size), NULL: first and step say it */
    int *order; /* (size) positions sorted by rank of the world, made when first needed */
};

/* Pieces of memory: count times, each `stride` bytes further, blocks of `length` elements of `of`.
 */
struct mpi_piece {
    int64_t at, count, stride, length;
    struct mpi_type *of;
};

/* What a reduction sees in a basic type. */
enum mpi_class {
    CLASS_NONE, /* not a basic type, or one that no operation is defined on */
    CLASS_INT8,
    CLASS_INT16,
    CLASS_INT32,
    CLASS_INT64,
    CLASS_UINT8,
    CLASS_UINT16,
    CLASS_UINT32,
    CLASS_UINT64,
    CLASS_FLOAT,
    CLASS_DOUBLE,
    CLASS_LONG_DOUBLE,
    CLASS_QUAD,
    CLASS_COMPLEX_FLOAT,
    CLASS_COMPLEX_DOUBLE,
    CLASS_COMPLEX_LONG_DOUBLE,
    CLASS_BOOL,
    CLASS_LOGICAL8,
    CLASS_LOGICAL16,
    CLASS_LOGICAL32,
    CLASS_LOGICAL64,
    CLASS_BYTE,
    CLASS_FLOAT_INT,
    CLASS_DOUBLE_INT,
    CLASS_LONG_INT,
    CLASS_INT_INT,
    CLASS_SHORT_INT,
    CLASS_LONG_DOUBLE_INT,
    CLASS_FLOAT_FLOAT,
    CLASS_DOUBLE_DOUBLE,
    CLASSES
};

struct mpi_type {
    struct mpi_object o;
    int combiner;
    enum mpi_class class;
    bool dense; /* size bytes one behind the other from lb = 0, and the next element right behind */
    bool committed;
    bool marked; /* the program set the bounds, of it or of a part: other parts do not count then */
    int64_t size, lb, extent, true_lb, true_extent; /* [B] */
    int64_t basics, align;                          /* basic elements; of a struct's end [B] */
    int npiece;
    struct mpi_piece *piece; /* (npiece); NULL: basic */
    /* What it was made of, for MPI_Type_get_contents. */
    int ninteger, naddress, ntype;
    MPI_Count *integer;
    MPI_Aint *address;
    struct mpi_type **type;
    const char *name; /* NULL: none */
    char *given_name;
};

typedef void mpi_combine(void *into, const void *with, bool before, int64_t n, void *context,
                         struct work *w);

struct mpi_op {
    struct mpi_object o;
    bool commutative, idempotent, large;
    MPI_User_function *function; /* of the program; NULL: built in */
    const char *name;
};

struct mpi_errhandler {
    struct mpi_object o;
    MPI_Handler_function *function; /* NULL: `code` says which of the standard's */
    int code;
};

/* A keyval of any of the three kinds of object; functions as of communicators, whose types fit all.
 */
struct mpi_keyval {
    struct mpi_object o;
    void *copy, *remove, *extra;
    bool freed; /* by the program: it lives on while values are attached */
};

struct mpi_entry {
    char *key, *value;
};

struct mpi_info {
    struct mpi_object o;
    int n, room;
    struct mpi_entry *entry; /* (n) in the order set */
};

#endif

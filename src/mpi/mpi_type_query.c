/* mpi_type_query.c - what datatypes are: sizes, bounds, names, what they were made of, which fits.
 *
 * Sections 5.1.5 to 5.1.8 and 5.1.13 of MPI 5.0 for what types are, 19.1.9 for those by
 * precision. */
#include <stdio.h>

#include "mpi/mpi_internal.h"

/* Bytes of data, without gaps. */
int mpi_type_size(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *size)
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    if (!t) return self->code;
    *size = t->size;
    return MPI_SUCCESS;
}

/* The forms with _x are of MPI 3.0; counts are 64 bits wide in all of ours. */
int mpi_type_size_x(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *size)
{
    return mpi_type_size(self, datatype, size);
}

/* From here to the next element of the type. */
int mpi_type_get_extent(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *lb,
                        MPI_Count *extent)
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    if (!t) return self->code;
    *lb = t->lb;
    *extent = t->extent;
    return MPI_SUCCESS;
}

int mpi_type_get_extent_x(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *lb,
                          MPI_Count *extent)
{
    return mpi_type_get_extent(self, datatype, lb, extent);
}

/* From the first byte of data to the last, whatever bounds were set: what memory an
 * element needs. */
int mpi_type_get_true_extent(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *true_lb,
                             MPI_Count *true_extent)
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    if (!t) return self->code;
    *true_lb = t->true_lb;
    *true_extent = t->true_extent;
    return MPI_SUCCESS;
}

int mpi_type_get_true_extent_x(struct mpi_rank *self, MPI_Datatype datatype, MPI_Count *true_lb,
                               MPI_Count *true_extent)
{
    return mpi_type_get_true_extent(self, datatype, true_lb, true_extent);
}

/* Removed from the standard in MPI 3.0, as are the next two; old programs have them. */
int mpi_type_extent(struct mpi_rank *self, MPI_Datatype datatype, MPI_Aint *extent)
{
    MPI_Count lb;
    return mpi_type_get_extent(self, datatype, &lb, extent);
}

int mpi_type_lb(struct mpi_rank *self, MPI_Datatype datatype, MPI_Aint *displacement)
{
    MPI_Count extent;
    return mpi_type_get_extent(self, datatype, displacement, &extent);
}

/* The upper bound is one behind the last byte of the extent. */
int mpi_type_ub(struct mpi_rank *self, MPI_Datatype datatype, MPI_Aint *displacement)
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    if (!t) return self->code;
    *displacement = t->lb + t->extent;
    return MPI_SUCCESS;
}

/* Only the first type of arrays is the program's; the second is how they are built. */
static int told_types(const struct mpi_type *t)
{
    bool array = t->combiner == MPI_COMBINER_SUBARRAY || t->combiner == MPI_COMBINER_DARRAY;
    return array ? 1 : t->ntype;
}

/* Sizes of the arrays that MPI_Type_get_contents fills. */
int mpi_type_get_envelope(struct mpi_rank *self, MPI_Datatype datatype, int *num_integers,
                          int *num_addresses, int *num_datatypes, int *combiner)
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    if (!t) return self->code;
    *num_integers = t->ninteger;
    *num_addresses = t->naddress;
    *num_datatypes = told_types(t);
    *combiner = t->combiner;
    return MPI_SUCCESS;
}

/* A type whose handle was freed gets a new one when the program asks for it. */
static MPI_Datatype handed_out(struct mpi_rank *r, struct mpi_type *t)
{
    if (mpi_type_is_basic(t)) return mpi_type_handle(t);
    int uses = t->o.uses;
    if (t->o.number < 0) mpi_handle_make(r, t, KIND_TYPE);
    t->o.uses = uses + 1;
    return mpi_handle(t);
}

/* Arrays must have the room that the envelope tells; types that are handed out are the
 * program's to free, basic ones aside. */
int mpi_type_get_contents(struct mpi_rank *self, MPI_Datatype datatype, int max_integers,
                          int max_addresses, int max_datatypes, int array_of_integers[],
                          MPI_Aint array_of_addresses[], MPI_Datatype array_of_datatypes[])
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    if (!t) return self->code;
    if (mpi_type_is_basic(t))
        /* Section 5.1.13 forbids the call for named types. */
        return mpi_error(self, NULL, MPI_ERR_TYPE, "%s is not made of others", t->name);
    if (max_integers < t->ninteger || max_addresses < t->naddress || max_datatypes < told_types(t))
        return mpi_error(self, NULL, MPI_ERR_ARG,
                         "the arrays are too short: %d integers, %d addresses, %d types",
                         t->ninteger, t->naddress, told_types(t));
    for (int i = 0; i < t->ninteger; i++) array_of_integers[i] = (int)t->integer[i];
    for (int i = 0; i < t->naddress; i++) array_of_addresses[i] = t->address[i];
    for (int i = 0; i < told_types(t); i++) array_of_datatypes[i] = handed_out(self, t->type[i]);
    return MPI_SUCCESS;
}

/* Names given by the program go before the standard's (section 7.8). */
int mpi_type_get_name(struct mpi_rank *self, MPI_Datatype datatype, char *type_name, int *resultlen)
{
    struct mpi_type *t = datatype == MPI_DATATYPE_NULL ? NULL : mpi_type_of(self, datatype);
    const char *name = "MPI_DATATYPE_NULL";
    if (!t && datatype != MPI_DATATYPE_NULL) return self->code;
    if (t) name = mpi_name_given(self, KIND_TYPE, t, t->name ? t->name : "");
    return mpi_text_out(type_name, MPI_MAX_OBJECT_NAME, name, resultlen);
}

/* Also of basic types, whose names this changes for the rank alone. */
int mpi_type_set_name(struct mpi_rank *self, MPI_Datatype datatype, const char *type_name)
{
    struct mpi_type *t = mpi_type_of(self, datatype);
    if (!t) return self->code;
    mpi_name_give(self, KIND_TYPE, t, type_name);
    return MPI_SUCCESS;
}

/* --- which type fits --- */

int mpi_type_match_size(struct mpi_rank *self, int typeclass, int size, MPI_Datatype *datatype)
{
    /* The types with sizes in their names are what Fortran programs mean by these. */
    static const struct {
        int class, size;
        MPI_Datatype type;
    } fits[] = {{MPI_TYPECLASS_INTEGER, 1, MPI_INTEGER1},  {MPI_TYPECLASS_INTEGER, 2, MPI_INTEGER2},
                {MPI_TYPECLASS_INTEGER, 4, MPI_INTEGER4},  {MPI_TYPECLASS_INTEGER, 8, MPI_INTEGER8},
                {MPI_TYPECLASS_REAL, 4, MPI_REAL4},        {MPI_TYPECLASS_REAL, 8, MPI_REAL8},
                {MPI_TYPECLASS_REAL, 16, MPI_REAL16},      {MPI_TYPECLASS_COMPLEX, 8, MPI_COMPLEX8},
                {MPI_TYPECLASS_COMPLEX, 16, MPI_COMPLEX16}};
    for (size_t i = 0; i < sizeof fits / sizeof fits[0]; i++)
        if (fits[i].class == typeclass && fits[i].size == size) {
            *datatype = fits[i].type;
            return MPI_SUCCESS;
        }
    return mpi_error(self, NULL, MPI_ERR_ARG, "no type of class %d has %d bytes", typeclass, size);
}

/* Types by decimal digits p and exponent range r: IEEE 754 single, double, quadruple.
 * Digits and range as Fortran's selected_real_kind counts them: 6 and 37, 15 and 307, 33
 * and 4931. What is undefined asks for nothing. */
int mpi_type_create_f90_real(struct mpi_rank *self, int p, int r, MPI_Datatype *newtype)
{
    if (p == MPI_UNDEFINED) p = 0;
    if (r == MPI_UNDEFINED) r = 0;
    if (p > 33 || r > 4931)
        return mpi_error(self, NULL, MPI_ERR_ARG, "no real has %d digits and range %d", p, r);
    *newtype = p <= 6 && r <= 37 ? MPI_REAL4 : p <= 15 && r <= 307 ? MPI_REAL8 : MPI_REAL16;
    return MPI_SUCCESS;
}

/* As for reals, two of which make a complex number. */
int mpi_type_create_f90_complex(struct mpi_rank *self, int p, int r, MPI_Datatype *newtype)
{
    if (p == MPI_UNDEFINED) p = 0;
    if (r == MPI_UNDEFINED) r = 0;
    if (p > 33 || r > 4931)
        return mpi_error(self, NULL, MPI_ERR_ARG, "no complex has %d digits and range %d", p, r);
    *newtype = p <= 6 && r <= 37     ? MPI_COMPLEX8
               : p <= 15 && r <= 307 ? MPI_COMPLEX16
                                     : MPI_COMPLEX32;
    return MPI_SUCCESS;
}

/* The range is in decimal digits: 127 has two whole ones, 32767 four, and so on. */
int mpi_type_create_f90_integer(struct mpi_rank *self, int r, MPI_Datatype *newtype)
{
    if (r > 18) return mpi_error(self, NULL, MPI_ERR_ARG, "no integer has range %d", r);
    *newtype = r <= 2 ? MPI_INTEGER1 : r <= 4 ? MPI_INTEGER2 : r <= 9 ? MPI_INTEGER4 : MPI_INTEGER8;
    return MPI_SUCCESS;
}

/* Only the standard's pairs: others would need operations that nobody has defined. */
int mpi_type_get_value_index(struct mpi_rank *self, MPI_Datatype value_type,
                             MPI_Datatype index_type, MPI_Datatype *pair_type)
{
    static const struct {
        MPI_Datatype value, pair;
    } pairs[] = {{MPI_FLOAT, MPI_FLOAT_INT}, {MPI_DOUBLE, MPI_DOUBLE_INT},
                 {MPI_LONG, MPI_LONG_INT},   {MPI_INT, MPI_2INT},
                 {MPI_SHORT, MPI_SHORT_INT}, {MPI_LONG_DOUBLE, MPI_LONG_DOUBLE_INT}};
    *pair_type = MPI_DATATYPE_NULL;
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++)
        if (pairs[i].value == value_type && index_type == MPI_INT) *pair_type = pairs[i].pair;
    return mpi_type_of(self, value_type) && mpi_type_of(self, index_type) ? MPI_SUCCESS
                                                                          : self->code;
}

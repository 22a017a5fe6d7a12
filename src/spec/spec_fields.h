/* spec_fields.h - the tables of the single structs, joined in field_tables.c. */
#ifndef SPEC_SPEC_FIELDS_H
#define SPEC_SPEC_FIELDS_H

#include "spec/field.h"

extern const struct field_table machine_table;
extern const struct field_table model_table;
extern const struct field_table job_table;
extern const struct field_table kernel_table;
extern const struct field_table program_table;
extern const struct field_table run_table;

#endif

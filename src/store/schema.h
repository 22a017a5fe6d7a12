/* schema.h - schema.sql as a text of this program. */
#ifndef STORE_SCHEMA_H
#define STORE_SCHEMA_H

/* store_schema: all statements of schema.sql, in order. */
const char *store_schema(void);

#endif

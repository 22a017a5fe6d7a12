/* schema.h - schema.sql as a text of this program. */
#ifndef STORE_SCHEMA_H
#define STORE_SCHEMA_H

/* schema_text: schema.sql, with "@table@" where rows.h puts columns. */
const char *schema_text(void);

#endif

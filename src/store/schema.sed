# schema.sql as the body of a C function: every line becomes a string literal.
1i\
/* Made from schema.sql by schema.sed. */\
#include "store/schema.h"\
\
const char *schema_text(void)\
{\
    return ""
s/\\/\\\\/g
s/"/\\"/g
s/^.*$/        "&\\n"/
$a\
        ;\
}

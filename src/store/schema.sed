# schema.sql as the body of a C function: comments and blank lines go, the rest becomes string literals.
1i\
/* Made from schema.sql by schema.sed. */\
#include "store/schema.h"\
\
const char *store_schema(void)\
{\
    return ""
s/ *--.*$//
/^ *$/{
$!d
s/.*//
}
s/\\/\\\\/g
s/"/\\"/g
s/^.*$/        "&\\n"/
$a\
        ;\
}

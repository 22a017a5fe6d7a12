# audit.sql as the body of a C function: blank lines go, and comments but for the names of rules.
1i\
/* Made from audit.sql by audit_sql.sed. */\
#include "study/audit_rules.h"\
\
const char *audit_sql(void)\
{\
    return ""
/^-- rule: /!s/^--.*$//
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

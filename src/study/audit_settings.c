/* audit_settings.c - the numbers of settings: figures are drawn from them, and each is its text
 * read again. */
#include <string.h>

#include "spec/setting_number.h"
#include "study/audit_rules.h"

/* One row of table setting: key, value, number, unit. */
static bool take_setting(void *context, int ncolumn, const char *const *name,
                         const struct store_value *value)
{
    (void)ncolumn, (void)name;
    struct audit_report *r = context;
    const char *key = value[0].text, *text = value[1].text, *stored = value[3].text;
    double number;
    enum unit unit;
    const bool is_number = setting_number(key, text, &number, &unit);
    const bool same = is_number ? value[2].kind == STORE_REAL && value[2].real == number
                                : value[2].kind == STORE_NULL;
    if (!same) audit_find(r, 0, "setting-number", "%s: the number is not that of '%s'", key, text);
    if (strcmp(stored, units_si(unit)) != 0)
        audit_find(r, 0, "setting-number", "%s: the unit is '%s', not '%s'", key, stored,
                   units_si(unit));
    return true;
}

bool audit_settings(struct store *s, struct audit_report *r, struct err *e)
{
    r->nrule++;
    return store_query(s, "SELECT key, value, number, unit FROM setting ORDER BY id", 0, NULL, NULL,
                       take_setting, r, e);
}

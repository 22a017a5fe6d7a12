/* stored.c - notes in table meta: digests of what stored answers depend on (stored.h). */
#include "app/stored.h"

#include <string.h>

#include "base/digest.h"

/* One line a run: any setting that differs from its default changes the identity. */
void stored_add_runs(struct text *all, const struct run_spec *spec, int n)
{
    for (int i = 0; i < n; i++) text_add(all, "%s\n", spec[i].config_hash);
}

/* The query is part of it: a claim that is judged differently has other answers. */
void stored_add_claim(struct text *all, const struct claim_rule *rule)
{
    text_add(all, "%s\n%s\n", rule->id, rule->sql);
}

/* The texts are of no use afterwards. */
void stored_digest(struct text *all, char hex[65])
{
    digest_sha256_hex(all->s, all->length, hex);
    text_free(all);
}

/* The first row is the only one: the key is unique. */
static bool take_text(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn, (void)name;
    text_copy(context, 65, value[0] ? value[0] : "");
    return false;
}

/* Empty where there is no such note. */
bool stored_note(struct store *s, const char *key, char value[65], struct err *e)
{
    const char *const bound[] = {key};
    value[0] = '\0';
    return store_select(s, "SELECT value FROM meta WHERE key = ?1", 1, bound, take_text, value, e);
}

bool stored_is(struct store *s, const char *key, const char *hex)
{
    /* whatever is wrong with the database, whoever writes into it next says so */
    char value[65];
    struct err ignored;
    err_clear(&ignored);
    return stored_note(s, key, value, &ignored) && strcmp(value, hex) == 0;
}

/* The note replaces the one of that key. */
bool stored_keep(struct store *s, const char *key, const char *text, struct err *e)
{
    /* Table meta has a text for each key. */
    static const char *const name[] = {"key", "value"};
    const struct store_value value[] = {store_text(key), store_text(text)};
    return store_insert(s, "meta", 2, name, value, e);
}

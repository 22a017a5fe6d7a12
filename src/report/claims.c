/* claims.c - reading the claims' files, judging them, keeping the verdicts; see claims.h. */
#include "report/claims.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

/* --- the files -----------------------------------------------------------------------------------------------------
 */

static bool is_claim_file(const char *name)
{
    size_t n = strlen(name);
    return n > 4 && strcmp(name + n - 4, ".sql") == 0;
}

/* C2 before C10, indicators last. */
static int compare_rules(const void *a, const void *b)
{
    const char *x = ((const struct claim_rule *)a)->id, *y = ((const struct claim_rule *)b)->id;
    bool cx = x[0] == 'C', cy = y[0] == 'C';
    if (cx != cy) return cx ? -1 : 1;
    size_t nx = strlen(x), ny = strlen(y);
    if (cx && nx != ny) return nx < ny ? -1 : 1;
    return strcmp(x, y);
}

/* The rest of the line that begins with "-- word: ". */
static const char *header_line(struct arena *a, const char *sql, const char *word)
{
    struct text mark = {0};
    text_add(&mark, "-- %s: ", word);
    const char *at = strstr(sql, mark.s), *found = NULL;
    if (at && (at == sql || at[-1] == '\n')) {
        at += mark.length;
        char *line = arena_text(a, at);
        line[strcspn(line, "\n")] = '\0';
        found = line;
    }
    text_free(&mark);
    return found;
}

static bool read_rule(struct claim_rule *r, struct arena *a, const char *folder, const char *file, struct err *e)
{
    struct text path = {0}, sql = {0};
    text_add(&path, "%s/%s", folder, file);
    bool ok = text_read_file(&sql, path.s, e);
    if (ok) {
        char *id = arena_text(a, file);
        id[strlen(id) - 4] = '\0';
        *r = (struct claim_rule){.id = id, .sql = arena_text(a, sql.s)};
        r->statement = header_line(a, r->sql, "statement");
        r->test = header_line(a, r->sql, "test");
        r->unit = header_line(a, r->sql, "unit");
        r->designated = header_line(a, r->sql, "designated");
        if (!r->statement || !r->test || !r->unit || !r->designated)
            ok = err_set_at(e, ERR_DATA, path.s, 1,
                            "a claim begins with -- statement:, test:, unit: and designated: lines");
    }
    text_free(&path);
    text_free(&sql);
    return ok;
}

bool claims_read(struct claim_rules *c, const char *data_dir, struct err *e)
{
    struct text folder = {0};
    text_add(&folder, "%s/plots/claims", data_dir);
    struct dirent **entry = NULL;
    int n = scandir(folder.s, &entry, NULL, alphasort);
    *c = (struct claim_rules){.arena = arena_create()};
    c->rule = TAKE(c->arena, n > 0 ? n : 1, struct claim_rule);
    bool ok = true;
    for (int i = 0; i < n; i++) {
        if (ok && is_claim_file(entry[i]->d_name))
            ok = read_rule(&c->rule[c->n++], c->arena, folder.s, entry[i]->d_name, e);
        free(entry[i]);
    }
    free(entry);
    if (ok && c->n == 0) ok = err_set(e, ERR_NO_INPUT, "there are no claims in %s", folder.s);
    if (ok) qsort(c->rule, (size_t)c->n, sizeof *c->rule, compare_rules);
    else claims_free(c);
    text_free(&folder);
    return ok;
}

void claims_free(struct claim_rules *c)
{
    arena_destroy(c->arena);
    *c = (struct claim_rules){0};
}

/* --- judging --------------------------------------------------------------------------------------------------------
 */

/* One row of a claim's query. */
struct judgement {
    const char *variant, *note;
    struct store_value value, threshold;
    struct store_value holds; /* 0, 1 or NULL */
};

typedef bool judgement_fn(void *context, const struct claim_rule *rule, const struct judgement *j);

struct judging {
    const struct claim_rule *rule;
    judgement_fn *tell;
    void *context;
    struct err *e;
};

static struct store_value as_real(struct store_value v)
{
    return v.kind == STORE_INT ? store_real((double)v.integer) : v.kind == STORE_REAL ? v : store_null();
}

static bool judge_row(void *context, int ncolumn, const char *const *name, const struct store_value *value)
{
    struct judging *g = context;
    (void)name;
    if (ncolumn != 5 || value[0].kind != STORE_TEXT)
        return err_set(g->e, ERR_DATA, "claim %s: a row is (variant, value, threshold, holds, note)", g->rule->id);
    struct judgement j = {.variant = value[0].text,
                          .value = as_real(value[1]),
                          .threshold = as_real(value[2]),
                          .holds = value[3].kind == STORE_INT ? store_int(value[3].integer != 0) : store_null(),
                          .note = value[4].kind == STORE_TEXT ? value[4].text : ""};
    return g->tell(g->context, g->rule, &j);
}

static bool judge(const struct claim_rule *rule, struct store *s, judgement_fn *tell, void *context, struct err *e)
{
    struct judging g = {rule, tell, context, e};
    if (!store_query(s, rule->sql, 0, NULL, NULL, judge_row, &g, e)) return err_in(e, rule->id);
    return e->kind == ERR_NONE;
}

/* --- samples --------------------------------------------------------------------------------------------------------
 */

struct sampling {
    struct store *into;
    int sample;
    struct err *e;
};

static bool keep_sample(void *context, const struct claim_rule *rule, const struct judgement *j)
{
    struct sampling *p = context;
    static const char *const name[] = {"id", "variant", "sample", "value", "holds"};
    const struct store_value value[] = {store_text(rule->id), store_text(j->variant), store_int(p->sample), j->value,
                                        j->holds};
    return store_insert(p->into, "claim_sample", 5, name, value, p->e);
}

bool claims_sample(const struct claim_rules *c, struct store *from, struct store *into, int sample, struct err *e)
{
    struct sampling p = {into, sample, e};
    if (!store_begin(into, e)) return false;
    for (int i = 0; i < c->n; i++)
        if (!judge(&c->rule[i], from, keep_sample, &p, e)) {
            store_rollback(into);
            return false;
        }
    return store_commit(into, e);
}

/* --- verdicts -------------------------------------------------------------------------------------------------------
 */

/* One claim in the making: its designated row, and where else it holds. */
struct deciding {
    struct store *s;
    struct err *e;
    bool found;
    struct judgement own; /* texts below */
    struct text own_note, holding, failing;
};

/* Range and share over the samples: (samples, share, low, high). */
struct spread {
    struct store_value count, share, low, high;
};

static bool take_spread(void *context, int ncolumn, const char *const *name, const struct store_value *value)
{
    struct spread *p = context;
    (void)ncolumn;
    (void)name;
    *p = (struct spread){value[0], value[1], as_real(value[2]), as_real(value[3])};
    return false;
}

static const char *verdict_of(struct store_value holds)
{
    return holds.kind == STORE_NULL ? "not-testable" : holds.integer ? "pass" : "fail";
}

static bool put_claim(struct deciding *d, const struct claim_rule *rule, const char *variant, const struct judgement *j,
                      const char *note)
{
    static const char *const name[] = {"id",        "variant",    "statement", "test",  "unit",    "value", "threshold",
                                       "value_low", "value_high", "samples",   "share", "verdict", "note"};
    const char *const key[] = {rule->id, *variant ? variant : rule->designated};
    struct spread p = {store_int(0), store_null(), store_null(), store_null()};
    if (!store_query(d->s,
                     "SELECT count(*), avg(holds), min(value), max(value) FROM claim_sample WHERE id = ?1 "
                     "AND variant = ?2",
                     2, key, NULL, take_spread, &p, d->e))
        return false;
    const struct store_value value[] = {store_text(rule->id),
                                        store_text(variant),
                                        store_text(rule->statement),
                                        store_text(rule->test),
                                        store_text(rule->unit),
                                        j->value,
                                        j->threshold,
                                        p.low,
                                        p.high,
                                        p.count,
                                        p.share,
                                        store_text(verdict_of(j->holds)),
                                        store_text(note)};
    return store_insert(d->s, "claim", 13, name, value, d->e);
}

static bool decide_row(void *context, const struct claim_rule *rule, const struct judgement *j)
{
    struct deciding *d = context;
    if (strcmp(j->variant, rule->designated) == 0) {
        d->found = true;
        d->own = *j;
        text_add(&d->own_note, "%s", j->note);
    } else if (j->holds.kind == STORE_INT) {
        struct text *list = j->holds.integer ? &d->holding : &d->failing;
        text_add(list, "%s%s", list->length ? "; " : "", j->variant);
    }
    return put_claim(d, rule, j->variant, j, j->note);
}

/* What a reader wants to know next: where the verdict would be the other one. */
static void add_elsewhere(struct deciding *d, const struct claim_rule *rule, struct text *note)
{
    if (d->found) text_add(note, "judged for %s: ", rule->designated);
    text_add(note, "%s", d->own_note.s ? d->own_note.s : "");
    if (!d->found || d->own.holds.kind != STORE_INT) return;
    bool holds = d->own.holds.integer != 0;
    const struct text *other = holds ? &d->failing : &d->holding;
    const char *lead = holds ? "fails for" : "holds for";
    if (other->length) text_add(note, "; %s: %s", lead, other->s);
    else text_add(note, "; %s no variant", lead);
}

static bool decide(const struct claim_rule *rule, struct store *s, struct err *e)
{
    struct deciding d = {
        .s = s, .e = e, .own = {.value = store_null(), .threshold = store_null(), .holds = store_null()}};
    bool ok = judge(rule, s, decide_row, &d, e);
    struct text note = {0};
    if (!d.found) text_add(&d.own_note, "no run is stored that could tell; `mimdsim paper` makes them");
    add_elsewhere(&d, rule, &note);
    ok = ok && put_claim(&d, rule, "", &d.own, note.s);
    text_free(&note);
    text_free(&d.own_note);
    text_free(&d.holding);
    text_free(&d.failing);
    return ok;
}

bool claims_decide(const struct claim_rules *c, struct store *s, struct err *e)
{
    if (!store_begin(s, e)) return false;
    bool ok = true;
    for (int i = 0; ok && i < c->n; i++)
        ok = store_delete(s, "claim", "id", store_text(c->rule[i].id), e) && decide(&c->rule[i], s, e);
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}

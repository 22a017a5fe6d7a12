/* claims.c - reading the claims' files, judging them, keeping the verdicts; see claims.h.
 *
 * The rules stand in the files, before any number is known; this file only asks them and writes
 * down the answers. A claim has many variants (serial baselines, operators, machines): one of
 * them is designated to give the verdict, the others show how much depends on that choice. */
#include "report/claims.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

/* --- the files -------------------------------------------------------------------------------- */

static bool is_claim_file(const char *name)
{
    size_t n = strlen(name);
    return n > 4 && strcmp(name + n - 4, ".sql") == 0;
}

/* For qsort: C2 before C10, indicators last, by their names. */
static int compare_rules(const void *a, const void *b)
{
    const char *x = ((const struct claim_rule *)a)->id, *y = ((const struct claim_rule *)b)->id;
    bool cx = x[0] == 'C', cy = y[0] == 'C';
    if (cx != cy) return cx ? -1 : 1;
    size_t nx = strlen(x), ny = strlen(y);
    if (cx && nx != ny) return nx < ny ? -1 : 1;
    return strcmp(x, y);
}

/* The rest of the line that begins with "-- word: ", with the lines "--   ..." that continue it. */
static const char *header_line(struct arena *a, const char *sql, const char *word)
{
    /* The first occurrence must begin its line: a mark in the middle of a line would hide the
     * header below it. */
    struct text mark = {0}, all = {0};
    text_add(&mark, "-- %s: ", word);
    const char *line = strstr(sql, mark.s), *found = NULL;
    if (line && (line == sql || line[-1] == '\n')) {
        line += mark.length;
        for (;;) {
            size_t n = strcspn(line, "\n");
            text_add_bytes(&all, line, n);
            /* A continuation begins with three blanks; any other line ends the text. */
            if (strncmp(line + n, "\n--   ", 6) != 0) break;
            text_add(&all, " ");
            line += n + 6;
        }
        found = arena_text(a, all.s ? all.s : "");
    }
    text_free(&mark);
    text_free(&all);
    return found;
}

/* All headers of a file; false when one is missing. */
static bool read_headers(struct claim_rule *r, struct arena *a)
{
    struct {
        const char *word, **place;
    /* The order is that of the messages: all are needed, `never` and `explore` are not. */
    } const header[] = {{"statement", &r->statement}, {"test", &r->test},     {"unit", &r->unit},
                        {"designated", &r->designated}, {"judged", &r->judged},
                         {"points", &r->points},
                        {"needs", &r->needs}};
    for (size_t i = 0; i < sizeof header / sizeof *header; i++)
        if (!(*header[i].place = header_line(a, r->sql, header[i].word))) return false;
    return true;
}

/* Every "-- explore:" line; several scenarios may be needed for one claim. */
static bool explore_lines(struct claim_rule *r, struct arena *a, const char *path, struct err *e)
{
    for (const char *at = r->sql, *line; (line = header_line(a, at, "explore")) != NULL;) {
        if (r->nexplore == CLAIM_MOST_EXPLORED)
            return err_set_at(e, ERR_DATA, path, 1,
                              "more than %d lines -- explore:", CLAIM_MOST_EXPLORED);
        r->explore[r->nexplore++] = line;
        /* Go on behind this line's mark: header_line finds the first one from there. */
        at = strstr(at, "-- explore: ") + 1;
    }
    return true;
}

/* One file as a rule. Its name without .sql is the claim's id. */
static bool read_rule(struct claim_rule *r, struct arena *a, const char *folder, const char *file,
                      struct err *e)
{
    struct text path = {0}, sql = {0};
    text_add(&path, "%s/%s", folder, file);
    bool ok = text_read_file(&sql, path.s, e);
    if (ok) {
        char *id = arena_text(a, file);
        id[strlen(id) - 4] = '\0';
        *r = (struct claim_rule){.id = id, .sql = arena_text(a, sql.s)};
        /* The message names all lines: a missing one is easier to see in the list than to guess. */
        if (!read_headers(r, a))
            ok = err_set_at(e, ERR_DATA, path.s, 1, "a claim begins with -- statement:, test:, "
                                                    "unit:, designated:, judged:, points: and "
                                                    "needs: lines");
        /* NULL where nobody knows a reason */
        r->never = header_line(a, r->sql, "never");
        ok = ok && explore_lines(r, a, path.s, e);
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
    /* The kernel's order of files differs between file systems: sort by name, then by number. */
    int n = scandir(folder.s, &entry, NULL, alphasort);
    *c = (struct claim_rules){.arena = arena_create()};
    c->rule = TAKE(c->arena, n > 0 ? n : 1, struct claim_rule);
    bool ok = true;
    /* After a failure only what scandir allocated is freed. */
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

/* --- judging ---------------------------------------------------------------------------------- */

/* What a row of a claim's query needs. */
struct judging {
    const struct claim_rule *rule;
    judgement_fn *tell;
    void *context;
    struct err *e;
};

/* SQL has integers where a share happens to be 0 or 1. */
static struct store_value as_real(struct store_value v)
{
    return v.kind == STORE_INT    ? store_real((double)v.integer)
           : v.kind == STORE_REAL ? v
                                  : store_null();
}

/* One variant. A row that lacks runs has no value, whatever the query computed from the others. */
static bool judge_row(void *context, int ncolumn, const char *const *name,
                      const struct store_value *value)
{
    struct judging *g = context;
    (void)name;
    if (ncolumn < 6 || ncolumn > 7 || value[0].kind != STORE_TEXT)
        return err_set(g->e, ERR_DATA, "claim %s: a row is (variant, value, threshold, holds, "
                                       "missing, note, margin)",
                       g->rule->id);
    /* `missing` is NULL for a whole variant. */
    bool whole = value[4].kind != STORE_TEXT;
    struct store_value margin = whole && ncolumn == 7 ? as_real(value[6]) : store_null();
    struct judgement j = {.variant = value[0].text,
                          .value = whole ? as_real(value[1]) : store_null(),
                          .threshold = as_real(value[2]),
                          .missing = whole ? NULL : value[4].text,
                          .holds = store_null(),
                          .note = value[5].kind == STORE_TEXT ? value[5].text : "",
                          .margin = margin.kind == STORE_REAL ? margin.real : NAN};
    if (whole && value[3].kind == STORE_INT) j.holds = store_int(value[3].integer != 0);
    return g->tell(g->context, g->rule, &j);
}

bool claims_judge(const struct claim_rule *rule, struct store *s, const char *admitted,
                  judgement_fn *tell, void *context, struct err *e)
{
    struct judging g = {rule, tell, context, e};
    /* A query that does not ask for ?1 cannot be bound to it. */
    bool asks = strstr(rule->sql, "?1") != NULL;
    if (!store_query(s, rule->sql, asks ? 1 : 0, &admitted, NULL, judge_row, &g, e))
        /* What the query refuses is told with the claim's id; what `tell` refused is in *e
         * already. */
        return err_in(e, rule->id);
    return e->kind == ERR_NONE;
}

/* --- samples ---------------------------------------------------------------------------------- */

struct sampling {
    struct store *into;
    int sample;
    struct err *e;
};

/* Samples keep values and verdicts only: texts are the same for all. */
static bool keep_sample(void *context, const struct claim_rule *rule, const struct judgement *j)
{
    struct sampling *p = context;
    static const char *const name[] = {"id", "variant", "sample", "value", "holds"};
    const struct store_value value[] = {store_text(rule->id), store_text(j->variant),
                                        store_int(p->sample), j->value, j->holds};
    return store_insert(p->into, "claim_sample", 5, name, value, p->e);
}

bool claims_sample(const struct claim_rules *c, struct store *from, struct store *into, int sample,
                   struct err *e)
{
    struct sampling p = {into, sample, e};
    /* One transaction per sample: a commit for each claim takes longer than judging it. */
    if (!store_begin(into, e)) return false;
    for (int i = 0; i < c->n; i++)
        if (!claims_judge(&c->rule[i], from, "what-if", keep_sample, &p, e)) {
            store_rollback(into);
            return false;
        }
    return store_commit(into, e);
}

/* --- verdicts --------------------------------------------------------------------------------- */

/* Machines that are not as shipped: their runs count only when asked for. */
struct changes {
    int machines;
    int64_t runs;
    struct text names;
};

/* One claim in the making: its designated row, and where else it holds. */
struct deciding {
    struct store *s;
    struct err *e;
    bool what_if;
    const char *names; /* of the changed machines; NULL: there are none */
    int64_t changed; /* runs on machines that are not as shipped */
    bool found, whole;
    struct judgement own; /* texts below */
    struct text own_note, holding, failing;
    int nholding, nfailing; /* variants, the designated one among them */
};

/* Range and share over the samples: (samples, share, low, high). */
struct spread {
    struct store_value count, share, low, high;
};

/* One row is expected, so reading stops after it. */
static bool take_spread(void *context, int ncolumn, const char *const *name,
                        const struct store_value *value)
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

/* A row of table claim: the claim itself (variant ''), or one of its variants. What all variants
 * share is stored with each, so that a row can be read alone. */
static bool put_claim(struct deciding *d, const struct claim_rule *rule, const char *variant,
                      const struct judgement *j, const char *note)
{
    static const char *const name[] = {"id",         "variant",  "statement", "test",
                                       "unit",       "value",    "threshold", "value_low",
                                       "value_high", "samples",  "share",     "verdict",
                                       "judged",     "testable", "holding",   "note"};
    bool claim = *variant == '\0';
    /* The claim's range and share are those of its designated variant. */
    const char *const key[] = {rule->id, *variant ? variant : rule->designated};
    struct spread p = {store_int(0), store_null(), store_null(), store_null()};
    if (!store_query(d->s,
                     "SELECT count(*), avg(holds), min(value), max(value) FROM claim_sample WHERE "
                     "id = ?1 AND variant = ?2",
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
                                        store_text(claim ? rule->judged : ""),
                                        claim ? store_int(d->nholding + d->nfailing) : store_null(),
                                        claim ? store_int(d->nholding) : store_null(),
                                        store_text(note)};
    return store_insert(d->s, "claim", 16, name, value, d->e);
}

/* Why a variant cannot be told: which runs are missing, the command that makes them, and how
 * many runs there are that do not count. */
static void add_missing(const struct deciding *d, const struct claim_rule *rule,
                        const char *missing, struct text *note)
{
    text_add(note, "not testable, runs are missing: %s; `%s -o %s` makes them", missing,
             rule->needs, store_path(d->s));
    if (d->changed > 0 && !d->what_if)
        text_add(note, "; %lld runs on changed machines do not count (--what-if counts them)",
                 (long long)d->changed);
}

/* One variant: into the table, and into the lists of those that hold or fail. */
static bool decide_row(void *context, const struct claim_rule *rule, const struct judgement *j)
{
    struct deciding *d = context;
    bool own = strcmp(j->variant, rule->designated) == 0;
    struct text note = {0};
    if (j->missing) add_missing(d, rule, j->missing, &note);
    else text_add(&note, "%s", j->note);
    /* Texts of a row are borrowed until the next one: the designated row's note is copied. */
    if (own) {
        d->found = true;
        d->whole = !j->missing;
        d->own = *j;
        text_add(&d->own_note, "%s", note.s);
    }
    if (j->holds.kind == STORE_INT) {
        struct text *list = j->holds.integer ? &d->holding : &d->failing;
        if (!own) text_add(list, "%s%s", list->length ? "; " : "", j->variant);
        d->nholding += j->holds.integer != 0;
        d->nfailing += j->holds.integer == 0;
    }
    bool ok = put_claim(d, rule, j->variant, j, note.s);
    text_free(&note);
    return ok;
}

/* The note of the claim: its own verdict, then where the verdict would be the other one. */
static void add_elsewhere(struct deciding *d, const struct claim_rule *rule, struct text *note)
{
    if (d->what_if && d->changed > 0)
        text_add(note, "what-if, runs on changed machines count (%s); ", d->names);
    /* Without all its runs the variant was not judged, whatever the rule. */
    if (d->whole) text_add(note, "judged for %s: ", rule->designated);
    text_add(note, "%s", d->own_note.s ? d->own_note.s : "");
    if (d->own.holds.kind != STORE_INT) return;
    text_add(note, "; holds in %d of %d variants", d->nholding, d->nholding + d->nfailing);
    bool holds = d->own.holds.integer != 0;
    const struct text *other = holds ? &d->failing : &d->holding;
    if (other->length) text_add(note, "; %s: %s", holds ? "fails for" : "holds for", other->s);
}

/* One claim. Its variants' rows come first; the claim's own row needs their counts. */
static bool decide(const struct claim_rule *rule, struct store *s, bool what_if,
                   const struct changes *changes, struct err *e)
{
    struct deciding d = {
        .s = s, .e = e, .what_if = what_if, .changed = changes->runs, .names = changes->names.s,
        .own = {.value = store_null(), .threshold = store_null(), .holds = store_null()}};
    bool ok = claims_judge(rule, s, what_if ? "what-if" : "as shipped", decide_row, &d, e);
    struct text note = {0};
    /* The query gave no row for the designated variant: no run of it is stored at all. */
    if (!d.found) add_missing(&d, rule, rule->points, &d.own_note);
    add_elsewhere(&d, rule, &note);
    ok = ok && put_claim(&d, rule, "", &d.own, note.s);
    text_free(&note);
    text_free(&d.own_note);
    text_free(&d.holding);
    text_free(&d.failing);
    return ok;
}

/* A machine that was changed: what it is called, and its runs. Of many names the first three. */
static bool take_changed(void *context, int ncolumn, const char *const *name,
                         const struct store_value *value)
{
    struct changes *c = context;
    (void)ncolumn;
    (void)name;
    if (c->machines < 3)
        text_add(&c->names, "%s%s", c->machines > 0 ? "; " : "", value[0].text);
    if (c->machines == 3) text_add(&c->names, "; and others");
    c->machines++;
    c->runs += value[1].integer;
    return true;
}

bool claims_decide(const struct claim_rules *c, struct store *s, struct err *e)
{
    struct changes changes = {0};
    bool ok = true;
    /* Only machines that the claims are about, and not the runs that the study itself makes with
     * changes. */
    if (!store_query(s,
                     "SELECT l.name, count(*) FROM v_machine_state m JOIN v_label l ON l.run_id = "
                     "m.run_id WHERE m.state <> 'as shipped' AND m.machine IN ('t3e-300', "
                     "'paragon') AND m.run_id NOT IN (SELECT id FROM run WHERE scenario LIKE "
                     "'paper-%') GROUP BY l.name ORDER BY min(m.run_id)",
                     0, NULL, NULL, take_changed, &changes, e) ||
        !store_begin(s, e)) {
        text_free(&changes.names);
        return false;
    }
    /* All claims or none: a table with old and new verdicts would be read as one study. */
    for (int i = 0; ok && i < c->n; i++)
        ok = store_delete(s, "claim", "id", store_text(c->rule[i].id), e) &&
             decide(&c->rule[i], s, c->what_if, &changes, e);
    text_free(&changes.names);
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}

/* audit_config.c - what the configuration of a stored run says of its row: identity, machine,
 * prices of serial codes (audit.h). */
#include <stdio.h>
#include <string.h>

#include "base/digest.h"
#include "base/text.h"
#include "machine/node_cost.h"
#include "plan/machine_changes.h"
#include "spec/identity.h"
#include "store/build.h"
#include "study/audit_rules.h"

bool audit_spec(struct run_spec *spec, const char *config_text, struct arena *a, char *why,
                int size)
{
    if (!run_from_text(spec, config_text, a, why, size)) return false;
    run_identify(spec, a);
    return true;
}

/* The first line of `text` that `all` lacks; NULL: it has all. Settings that are newer than the
 * row are in `all` only, and so pass. */
static const char *line_without(const char *text, const char *all, struct arena *a)
{
    const char *padded = all;
    for (const char *line = text, *end; *line; line = *end ? end + 1 : end) {
        end = strchrnul(line, '\n');
        const size_t n = (size_t)(end - line);
        char *own = arena_take(a, n + 2);
        memcpy(own, line, n);
        own[n] = '\n';
        /* A whole line, not the end of a longer one: it begins the text or follows a line break. */
        const char *found = strstr(padded, own);
        while (found && found != all && found[-1] != '\n') found = strstr(found + 1, own);
        own[n] = '\0';
        if (!found) return own;
    }
    return NULL;
}

/* SHA-256 of the machine that a text describes, as plan/machine_changes.c takes it of a shipped
 * one: the lines of the machine without the two settings that say how accurately it is
 * simulated, not what it is. */
static void machine_hash(const char *config_text, char hex[65])
{
    static const char *const question[] = {"machine.network.level = ",
                                           "machine.network.tolerance = "};
    struct text machine = {0};
    for (const char *line = config_text, *end; *line; line = *end ? end + 1 : end) {
        end = strchrnul(line, '\n');
        bool ours = strncmp(line, "machine.", 8) == 0;
        for (int i = 0; i < 2; i++)
            ours = ours && strncmp(line, question[i], strlen(question[i])) != 0;
        if (!ours) continue;
        text_add_bytes(&machine, line, (size_t)(end - line));
        text_add_bytes(&machine, "\n", 1);
    }
    digest_sha256_hex(machine.s ? machine.s : "", machine.length, hex);
    text_free(&machine);
}

/* The columns of a row that its configuration repeats. */
struct row {
    int64_t id;
    const char *hash, *text, *changes, *machine_hash;
    bool ours; /* made by this very program */
};

/* Two statements of a row are checked: that the machine is the shipped one (no changes), and
 * which changes it has. */
static void check_machine(const struct row *row, struct run_spec *spec,
                          struct machine_changes *known, struct audit_report *r)
{
    char hex[65];
    if (!row->changes || !row->machine_hash) return;
    machine_hash(row->text, hex);
    if (strcmp(row->changes, "{}") == 0 && strcmp(hex, row->machine_hash) != 0)
        audit_find(r, row->id, "machine",
                   "the machine is noted as the shipped one, but the configuration has another");
    machine_changes_note(known, spec);
    /* Of a machine file that is another one by now, nobody can tell what was changed. */
    if (!spec->machine_changes) return;
    /* The shipped machine itself is another one by now. That is an error only if this very
     * program made the row; an older one read an older file. */
    if (strcmp(spec->machine_hash, row->machine_hash) != 0) {
        if (row->ours && strcmp(row->changes, "{}") != 0)
            audit_find(r, row->id, "machine",
                       "machine_hash is %.12s..., that of the shipped machine %.12s...",
                       row->machine_hash, spec->machine_hash);
        return;
    }
    if (strcmp(spec->machine_changes, row->changes) != 0)
        audit_find(r, row->id, "machine", "machine_changes is %.200s; the configuration has %.200s",
                   row->changes, spec->machine_changes);
}

/* The serial codes of one run, priced on its node. */
struct pricing {
    struct audit_report *report;
    int64_t run;
    struct node_cost cost;
};

static bool price_row(void *context, int ncolumn, const char *const *name,
                      const struct store_value *v)
{
    (void)ncolumn, (void)name;
    const struct pricing *p = context;
    /* The columns of the query in check_prices, in its order. */
    const struct work w = {.flop = (uint64_t)v[2].integer,
                           .div = (uint64_t)v[3].integer,
                           .sqrt = (uint64_t)v[4].integer,
                           .trig = (uint64_t)v[5].integer,
                           .bytes = (uint64_t)v[6].integer,
                           .call = (uint64_t)v[7].integer};
    const int64_t ps = node_cost_ps(&p->cost, &w);
    if (ps != v[1].integer)
        audit_find(p->report, p->run, "prices",
                   "'%s' takes %lld ps; its operations take %lld on this node", v[0].text,
                   (long long)v[1].integer, (long long)ps);
    return true;
}

/* The time of a serial code is what its counted operations cost on the node, to the picosecond. */
static bool check_prices(struct store *s, int64_t run, const struct run_spec *spec,
                         struct audit_report *r, struct err *e)
{
    const struct node_spec node = node_spec_serial(&spec->machine.node);
    char id[24];
    const char *const param[] = {id};
    /* its time is that of blocks of code, which are not stored */
    if (spec->kernel.own) return true;
    /* and here it depends on the ranks' working sets, which are not stored either */
    if (node.model == NODE_ROOFLINE) return true;
    struct pricing p = {r, run, node_cost_make(&node)};
    snprintf(id, sizeof id, "%lld", (long long)run);
    return store_query(s,
                       "SELECT name, time_ps, flops, divisions, square_roots, sines, copied_bytes, "
                       "calls FROM baseline WHERE run_id = CAST(?1 AS INTEGER)",
                       1, param, NULL, price_row, &p, e);
}

/* The walk over all runs. `known` remembers the shipped machine that was looked up last. */
struct audit_walk {
    struct store *store;
    struct audit_report *report;
    struct arena *arena; /* of one row */
    struct machine_changes known;
    struct err *err;
};

static bool take_row(void *context, int ncolumn, const char *const *name,
                     const struct store_value *v)
{
    (void)ncolumn, (void)name;
    struct audit_walk *w = context;
    /* The order of the columns is that of the query in audit_configurations. */
    const struct build build = store_build();
    const struct row row = {
        v[0].integer, v[1].text,
        v[2].text,    v[3].text,
        v[4].text,    strcmp(v[5].text, build.git) == 0 && strcmp(v[6].text, build.version) == 0};
    const struct arena_mark mark = arena_mark(w->arena);
    struct run_spec spec;
    char why[256];
    bool ok = true;
    if (audit_spec(&spec, row.text, w->arena, why, sizeof why)) {
        const char *line = line_without(row.text, spec.config_text, w->arena);
        /* The hash is of the whole text: it finds any change of a setting, but not which one. */
        if (strcmp(spec.config_hash, row.hash) != 0)
            audit_find(w->report, row.id, "identity",
                       "config_hash is %.12s..., that of the configuration %.12s...", row.hash,
                       spec.config_hash);
        /* A text whose settings are the same may still be written otherwise: then some line is
         * not there. */
        if (line)
            audit_find(w->report, row.id, "identity", "'%s' is not how the setting is written",
                       line);
        check_machine(&row, &spec, &w->known, w->report);
        ok = check_prices(w->store, row.id, &spec, w->report, w->err);
    } else {
        audit_find(w->report, row.id, "identity", "the configuration cannot be read: %s", why);
    }
    /* What is remembered of the machine may lie in memory that is given back. */
    w->known.any = false;
    arena_release(w->arena, mark);
    return ok;
}

/* Runs in the order of their ids: the findings come in the same order every time. Two arenas:
 * the machine's description outlives the memory of one row. */
bool audit_configurations(struct store *s, struct audit_report *r, struct err *e)
{
    struct audit_walk w = {
        .store = s, .report = r, .arena = arena_create(), .known.arena = arena_create(), .err = e};
    r->nrule += 3;
    bool ok = store_query(s,
                          "SELECT r.id, config_hash, config_text, machine_changes, machine_hash, "
                          "git, version FROM run r JOIN build b ON b.id = r.build_id ORDER BY r.id",
                          0, NULL, NULL, take_row, &w, e);
    arena_destroy(w.known.arena);
    arena_destroy(w.arena);
    return ok && e->kind == ERR_NONE;
}

/* stamp.c - see stamp.h.
 *
 * A figure travels without its database, so what a reader needs to judge it stands in it. */
#include "report/stamp.h"

#include <stdlib.h>
#include <string.h>

#include "base/digest.h"
#include "report/figure_rows.h"
#include "report/how_sure.h"
#include "store/build.h"

/* "version (commit)" of each program that made a run, joined by commas. */
static bool add_source(void *context, int ncolumn, const char *const *name,
                       const char *const *value)
{
    (void)ncolumn, (void)name;
    text_add(context, "%s%s", ((struct text *)context)->length ? ", " : "",
             value[0] ? value[0] : "");
    return true;
}

/* 64 digits each: their number is the length divided by 64. */
static bool add_hash(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn, (void)name;
    text_add(context, "%s", value[0] ? value[0] : "");
    return true;
}

/* What a database cannot be asked is not said: a figure is drawn all the same. Lack of memory is no
 * answer of a database. */
static bool known_errors(struct store *s, const char *run_ids, struct text *out, struct err *e)
{
    struct err why;
    struct how_sure h;
    err_clear(&why);
    if (how_sure_read(s, run_ids, &h, &why)) how_sure_short(&h, out);
    if (out->length > 0) text_add(out, "; ");
    if (why.kind == ERR_INTERNAL) *e = why;
    return why.kind != ERR_INTERNAL;
}

/* The commit that draws, unless its name is there already. */
static void add_drawer(struct text *out)
{
    const struct build b = store_build();
    if (out->length > 0 && strstr(out->s, b.git) == NULL) text_add(out, "; drawn by %s", b.git);
}

/* Of rows that belong to no run: "mimdsim 0.1.0 (commit)", the programs that wrote in this
 * database. */
static bool writers(struct store *s, struct text *out, struct err *e)
{
    struct text sources = {0};
    bool ok =
        store_select(s, "SELECT DISTINCT version || ' (' || git || ')' FROM build ORDER BY 1", 0,
                     NULL, add_source, &sources, e);
    if (sources.length > 0) text_add(out, "mimdsim %s", sources.s);
    text_free(&sources);
    add_drawer(out);
    return ok;
}

bool stamp_make(struct store *s, const char *run_ids, struct text *out, struct err *e)
{
    if (run_ids == NULL) return writers(s, out, e);
    struct text sources = {0}, hashes = {0};
    char hash[65];
    const char *const ids[] = {run_ids};
    bool ok = store_select(s,
                           "SELECT DISTINCT version || ' (' || git || ')' FROM v_provenance "
                           "WHERE run_id IN (SELECT value FROM json_each(?1)) ORDER BY 1",
                           1, ids, add_source, &sources, e) &&
              store_select(s,
                           "SELECT config_hash FROM run WHERE id IN (SELECT value FROM "
                           "json_each(?1)) ORDER BY config_hash, seed, rep",
                           1, ids, add_hash, &hashes, e);
    ok = ok && known_errors(s, run_ids, out, e);
    /* One run is named by its own hash, several by a hash of all their hashes. */
    const size_t nrun = hashes.length / 64;
    if (ok && nrun == 1 && sources.s)
        text_add(out, "mimdsim %s, configuration %.12s", sources.s, hashes.s);
    else if (ok && nrun > 1 && sources.s) {
        digest_sha256_hex(hashes.s, hashes.length, hash);
        text_add(out, "mimdsim %s, %zu runs, configurations %.12s", sources.s, nrun, hash);
    }
    /* No figure chooses among machines in silence. */
    struct text machines = {0};
    ok = ok && figure_rows(s, run_ids, &machines, e);
    if (machines.length > 0) text_add(out, "; %s", machines.s);
    text_free(&machines);
    add_drawer(out);
    text_free(&sources);
    text_free(&hashes);
    return ok;
}

/* timeline_picture.c - see timeline_picture.h.
 *
 * A picture has a thousand pixels and a run may have millions of spans, so they are counted into
 * cells: a row of ranks by a column of time, and in each cell how long its ranks do what. What is
 * drawn is the kind with the largest share; neighbouring cells of one kind become one bar. Few
 * ranks with few spans are drawn span by span. The tables are temporary ones of the database, from
 * which plots/_timeline draws. */
#include "report/timeline_picture.h"

#include <stdlib.h>

#include "base/memory.h"
#include "report/report.h"
#include "report/timeline.h"
#include "store/temporary.h"

enum {
    NKIND = SPAN_BARRIER + 1,
    SINGLE_RANKS = 48,   /* rows that are tall enough for bars with edges */
    SINGLE_SPANS = 6000, /* more make an SVG that no browser likes */
    ROWS = 120,
    COLUMNS = 400,
    MESSAGES = 500 /* more arrows hide what they connect */
};

/* The cells, and how ranks and times become rows and columns. */
struct grid {
    const struct timeline_view *v;
    int nrow, ncolumn;
    bool single; /* a row is a rank, drawn span by span */
    int64_t *kind;  /* (nrow x ncolumn x NKIND) time [ps] */
    int64_t *stage; /* (ncolumn x (RUN_MAX_STAGES + 1)) time of all ranks [ps]; the last: none */
};

/* Spans of the window and the ranks. */
static bool shown(const struct timeline_view *v, const struct span *p)
{
    return p->rank >= v->first_rank && p->rank <= v->last_rank && p->begin_ps < v->end_ps &&
           p->end_ps > v->begin_ps;
}

static int row_of(const struct grid *g, int rank)
{
    const int64_t n = g->v->last_rank - g->v->first_rank + 1;
    return (int)((int64_t)(rank - g->v->first_rank) * g->nrow / n);
}

/* Where column c begins. In wide arithmetic: a length times columns may exceed 64 bits. */
static int64_t column_begin(const struct grid *g, int c)
{
    const __int128 length = g->v->end_ps - g->v->begin_ps;
    return g->v->begin_ps + (int64_t)(length * c / g->ncolumn);
}

static int column_of(const struct grid *g, int64_t ps)
{
    /* Times outside the window belong to its first and last column. */
    const __int128 length = g->v->end_ps - g->v->begin_ps;
    int64_t c = (int64_t)((__int128)(ps - g->v->begin_ps) * g->ncolumn / length);
    if (c < 0) c = 0;
    return c >= g->ncolumn ? g->ncolumn - 1 : (int)c;
}

/* Each span into the cells that it covers. */
static void count_span(struct grid *g, const struct span *p)
{
    const int stage = p->stage >= 0 && p->stage < RUN_MAX_STAGES ? p->stage : RUN_MAX_STAGES;
    /* From the column of its begin on: a span may last over many. */
    const int row = row_of(g, p->rank);
    for (int c = column_of(g, p->begin_ps); c < g->ncolumn; c++) {
        const int64_t left = column_begin(g, c), right = column_begin(g, c + 1);
        if (left >= p->end_ps) return;
        const int64_t from = p->begin_ps > left ? p->begin_ps : left;
        const int64_t to = p->end_ps < right ? p->end_ps : right;
        if (to <= from) continue;
        g->kind[((int64_t)row * g->ncolumn + c) * NKIND + p->kind] += to - from;
        g->stage[c * (RUN_MAX_STAGES + 1) + stage] += to - from;
    }
}

/* The largest of n shares, -1 when all are 0; of equal ones the first. */
static int largest(const int64_t *share, int n)
{
    int best = -1;
    for (int i = 0; i < n; i++)
        if (share[i] > (best < 0 ? 0 : share[best])) best = i;
    return best;
}

static struct store_value in_us(int64_t ps)
{
    return store_real((double)ps * 1e-6);
}

/* ---- tables ---- */

/* One bar; y counts rows from 0, kind and stage by number. */
static bool put_bar(struct store *s, const struct grid *g, int row, int64_t from, int64_t to,
                    int kind, struct err *e)
{
    /* The first rank of the row, for people who read the table. */
    const int n = g->v->last_rank - g->v->first_rank + 1;
    const int first = g->v->first_rank + (int)(((int64_t)row * n + g->nrow - 1) / g->nrow);
    const struct store_value v[] = {store_int(row),  store_int(first), in_us(from),
                                    in_us(to),       store_int(kind),
                                    store_int(g->v->run_id)};
    return store_temporary_row(s, "timeline_bar", 6, v, e);
}

/* Cells of one kind beside each other are one bar. */
static bool put_rows(struct store *s, const struct grid *g, struct err *e)
{
    bool ok = true;
    for (int r = 0; r < g->nrow; r++) {
        const int64_t *cell = g->kind + (int64_t)r * g->ncolumn * NKIND;
        for (int c = 0, from = 0; ok && c < g->ncolumn; c++) {
            const int kind = largest(cell + (int64_t)c * NKIND, NKIND);
            /* A bar ends where the kind changes; a time of which nothing is known is no bar. */
            const bool last =
                c + 1 == g->ncolumn || largest(cell + (int64_t)(c + 1) * NKIND, NKIND) != kind;
            if (!last) continue;
            if (kind >= 0)
                ok = put_bar(s, g, r, column_begin(g, from), column_begin(g, c + 1), kind, e);
            from = c + 1;
        }
    }
    return ok;
}

/* Few spans: each is a bar, cut at the window's edges. */
static bool put_spans(struct store *s, const struct grid *g, struct err *e)
{
    const struct timeline_view *v = g->v;
    bool ok = true;
    for (int64_t i = 0; ok && i < v->run->nspan; i++) {
        const struct span *p = &v->run->span[i];
        if (!shown(v, p)) continue;
        ok =
            put_bar(s, g, row_of(g, p->rank), p->begin_ps > v->begin_ps ? p->begin_ps : v->begin_ps,
                    p->end_ps < v->end_ps ? p->end_ps : v->end_ps, p->kind, e);
    }
    return ok;
}

/* Per column the mean number of ranks of each kind, and the stage that most time is spent in. */
static bool put_shares(struct store *s, const struct grid *g, struct err *e)
{
    bool ok = true;
    for (int c = 0; ok && c < g->ncolumn; c++) {
        const int64_t from = column_begin(g, c), to = column_begin(g, c + 1);
        const int stage = largest(g->stage + (int64_t)c * (RUN_MAX_STAGES + 1), RUN_MAX_STAGES);
        struct store_value v[3 + NKIND] = {in_us(from), in_us(to), store_int(stage)};
        /* Time of all ranks over the width of the column is a number of ranks. */
        for (int k = 0; k < NKIND; k++) {
            int64_t sum = 0;
            for (int r = 0; r < g->nrow; r++)
                sum += g->kind[((int64_t)r * g->ncolumn + c) * NKIND + k];
            v[3 + k] = store_real(to > from ? (double)sum / (double)(to - from) : 0);
        }
        ok = store_temporary_row(s, "timeline_share", 3 + NKIND, v, e);
    }
    return ok;
}

/* One piece of the critical path, from (us, row) to (us, row). */
static bool put_piece(struct store *s, int64_t from, int from_row, int64_t to, int to_row,
                      struct err *e)
{
    const struct store_value v[] = {in_us(from), store_int(from_row), in_us(to), store_int(to_row)};
    return store_temporary_row(s, "timeline_path", 4, v, e);
}

/* The critical path in pieces: along a rank, and from one rank to the next. A step that is not
 * shown leaves a gap. */
static bool put_path(struct store *s, const struct grid *g, struct err *e)
{
    const struct timeline_view *v = g->v;
    bool ok = true;
    int before = -1; /* row of the step before, -1: it is not shown */
    for (int64_t i = 0; ok && i < v->run->npath; i++) {
        const struct path_step *p = &v->run->path[i];
        if (p->rank < v->first_rank || p->rank > v->last_rank || p->end_ps < v->begin_ps ||
            p->begin_ps > v->end_ps) {
            before = -1;
            continue;
        }
        const int64_t from = p->begin_ps > v->begin_ps ? p->begin_ps : v->begin_ps;
        const int64_t to = p->end_ps < v->end_ps ? p->end_ps : v->end_ps;
        const int row = row_of(g, p->rank);
        if (before >= 0 && before != row) ok = put_piece(s, from, before, from, row, e);
        if (ok && to > from) ok = put_piece(s, from, row, to, row, e);
        before = row;
    }
    return ok;
}

/* Messages between shown ranks, as arrows; none when they are too many. */
static bool put_messages(struct store *s, const struct grid *g, struct err *e)
{
    struct timeline t = {.run = g->v->run};
    t.span = memory_take((size_t)t.run->nspan + 1, sizeof *t.span);
    for (int64_t i = 0; i < t.run->nspan; i++)
        if (shown(g->v, &t.run->span[i])) t.span[t.nspan++] = &t.run->span[i];
    /* Both ends must be shown, or there is no arrow. */
    int64_t *partner = timeline_partners(&t), n = 0;
    bool ok = true;
    for (int64_t i = 0; i < t.nspan; i++) n += t.span[i]->kind == SPAN_SEND && partner[i] >= 0;
    for (int64_t i = 0; ok && n <= MESSAGES && i < t.nspan; i++) {
        if (t.span[i]->kind != SPAN_SEND || partner[i] < 0) continue;
        const struct span *to = t.span[partner[i]];
        const struct store_value v[] = {in_us(t.span[i]->end_ps),
                                        store_int(row_of(g, t.span[i]->rank)), in_us(to->begin_ps),
                                        store_int(row_of(g, to->rank))};
        ok = store_temporary_row(s, "timeline_message", 4, v, e);
    }
    free(partner);
    free(t.span);
    return ok;
}

/* What the script has to know, and the names of the stages. */
static bool put_about(struct store *s, const struct grid *g, struct err *e)
{
    const struct timeline_view *v = g->v;
    const struct store_value about[] = {store_text(v->title),      store_int(g->nrow),
                                        store_int(v->first_rank),  store_int(v->last_rank),
                                        in_us(v->begin_ps),        in_us(v->end_ps),
                                        in_us(v->run->makespan_ps), store_int(g->single),
                                        store_int(v->run->npath > 0)};
    bool ok = store_temporary_row(s, "timeline_about", 9, about, e);
    for (int i = 0; ok && i < v->run->nstage; i++) {
        const struct store_value stage[] = {store_int(i), store_text(v->run->stage_name[i])};
        ok = store_temporary_row(s, "timeline_stage", 2, stage, e);
    }
    return ok;
}

static bool make_tables(struct store *s, struct err *e)
{
    return store_temporary(s, "timeline_bar",
                           "y INTEGER, rank INTEGER, begin_us REAL, end_us REAL, kind INTEGER, "
                           "run_id INTEGER",
                           e) &&
           store_temporary(s, "timeline_share",
                           "begin_us REAL, end_us REAL, stage INTEGER, compute REAL, send REAL, "
                           "recv REAL, wait REAL, barrier REAL",
                           e) &&
           store_temporary(s, "timeline_path",
                           "from_us REAL, from_y INTEGER, to_us REAL, to_y INTEGER", e) &&
           store_temporary(s, "timeline_message",
                           "sent_us REAL, from_y INTEGER, received_us REAL, to_y INTEGER", e) &&
           store_temporary(s, "timeline_stage", "stage INTEGER, name TEXT", e) &&
           store_temporary(s, "timeline_about",
                           "title TEXT, rows INTEGER, first_rank INTEGER, last_rank INTEGER, "
                           "begin_us REAL, end_us REAL, makespan_us REAL, single INTEGER, path "
                           "INTEGER",
                           e);
}

bool timeline_picture(struct store *s, const char *data_dir, const struct timeline_view *v,
                      const char *as, const char *dir, struct err *e)
{
    const int nrank = v->last_rank - v->first_rank + 1;
    struct grid g = {.v = v, .ncolumn = COLUMNS};
    /* How much there is decides how it is drawn. */
    int64_t spans = 0;
    for (int64_t i = 0; i < v->run->nspan; i++) spans += shown(v, &v->run->span[i]);
    g.single = nrank <= SINGLE_RANKS && spans <= SINGLE_SPANS;
    g.nrow = g.single || nrank < ROWS ? nrank : ROWS;
    g.kind = memory_zeroed((size_t)g.nrow * COLUMNS * NKIND, sizeof *g.kind);
    g.stage = memory_zeroed((size_t)COLUMNS * (RUN_MAX_STAGES + 1), sizeof *g.stage);
    for (int64_t i = 0; i < v->run->nspan; i++)
        if (shown(v, &v->run->span[i])) count_span(&g, &v->run->span[i]);
    /* Bars by span or by cell; everything else is the same. */
    bool ok = make_tables(s, e) && (g.single ? put_spans(s, &g, e) : put_rows(s, &g, e)) &&
              put_shares(s, &g, e) && put_path(s, &g, e) &&
              (!g.single || put_messages(s, &g, e)) && put_about(s, &g, e) &&
              report_figure_run(s, data_dir, "_timeline", v->run_id, as, dir, e);
    free(g.kind);
    free(g.stage);
    return ok;
}

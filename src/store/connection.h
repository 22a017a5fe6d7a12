/* connection.h - what the files of this room share: the open database and its prepared statements.
 *
 * Statements are prepared when first used and kept: preparing costs more than stepping. */
#ifndef STORE_CONNECTION_H
#define STORE_CONNECTION_H

#include <sqlite3.h>
#include <stdbool.h>

#include "base/err.h"

/* X(name, sql): the statements that store_put and store_has use again and again. */
#define STORE_STATEMENTS(X)                                                                                            \
    X(RUN_FIND, "SELECT id, status FROM run WHERE config_hash = ?1 AND seed = ?2 AND rep = ?3")                        \
    X(RUN_DELETE, "DELETE FROM run WHERE id = ?1")                                                                     \
    X(RUN_INSERT,                                                                                                      \
      "INSERT INTO run (config_hash, seed, rep, scenario, machine, topology, level, placement, kernel, formulation,"   \
      " solver, part_solver, operators, precision, model, base, joint, n, nu, P, compute_noise_cv, background_load,"   \
      " status, text, makespan_ps, measured_s, loop_rows, loop_rank, drift_position, drift_velocity,"                  \
      " residual, condition,"                                                                                          \
      " messages, sent_bytes, events, ties, switches, digest,"                                                         \
      " accounting_error_ps,"                                                                                          \
      " finish_min_ps, finish_max_ps, rank_compute_min_ps, rank_compute_max_ps, links, host_s, host_total_s,"          \
      " host_peak_bytes, stack_peak_bytes, level_asked, level_error, level_error_at, inner_added, outer_added,"        \
      " twice_added, residual_before, left_out, config_text, machine_changes, machine_hash, build_id, created_utc)"    \
      " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?,"    \
      " ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?,"                              \
      " strftime('%Y-%m-%dT%H:%M:%SZ', 'now'))")                                                                       \
    X(BUILD_ADD, "INSERT OR IGNORE INTO build (version, git, compiler, flags) VALUES (?1, ?2, ?3, ?4)")                \
    X(BUILD_FIND, "SELECT id FROM build WHERE version = ?1 AND git = ?2 AND compiler = ?3 AND flags = ?4")             \
    X(SETTING_ADD, "INSERT INTO setting (key, value) VALUES (?1, ?2)")                                                 \
    X(SETTING_FIND, "SELECT id FROM setting WHERE key = ?1 AND value = ?2")                                            \
    X(RUN_SETTING, "INSERT INTO run_setting VALUES (?1, ?2)")                                                          \
    X(STAGE,                                                                                                           \
      "INSERT INTO stage VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?,"  \
      " ?)")                                                                                                           \
    X(RANK_STAGE, "INSERT INTO rank_stage VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")                                   \
    X(BASELINE, "INSERT INTO baseline VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")                                          \
    X(ERROR_CHECK, "INSERT INTO error_check VALUES (?, ?, ?, ?, ?, ?, ?)")                                             \
    X(OMISSION, "INSERT INTO run_omission VALUES (?, ?, ?, ?, ?)")                                                     \
    X(LINK_LOAD, "INSERT INTO link_load VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)")                                           \
    X(SPAN, "INSERT INTO span VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")                                                  \
    X(BEGIN, "BEGIN IMMEDIATE")                                                                                        \
    X(COMMIT, "COMMIT")

enum statement {
#define X(name, sql) STATEMENT_##name,
    STORE_STATEMENTS(X)
#undef X
        STATEMENT_COUNT
};

enum {
    STORE_APPLICATION = 0x6d696d64, /* "mimd" */
    STORE_VERSION = 5,              /* of schema.sql, in user_version */
    STORE_BUSY_MS = 2000,           /* how long another program's lock is waited for */
    STORE_RANK_ROWS = 256,          /* more ranks: table rank_stage stays empty */
    STORE_LINK_ROWS = 16384,        /* link loads kept of one run */
    STORE_SPAN_ROWS = 20000         /* a longer timeline is a file */
};

struct store {
    sqlite3 *db; /* owned */
    char *path;  /* owned */
    bool writable;
    bool passing;                             /* STORE_MEMORY: what only people read is not kept */
    bool in_transaction;                      /* store_begin's */
    int64_t build_id;                         /* row of this program in table build, 0: not looked up yet */
    sqlite3_stmt *statement[STATEMENT_COUNT]; /* owned, NULL until used */
};

/* store_statement: the prepared statement, reset and without bindings; NULL with the error set. */
sqlite3_stmt *store_statement(struct store *s, enum statement which, struct err *e);

/* store_step: run a statement that returns no row, and reset it. */
bool store_step(struct store *s, sqlite3_stmt *statement, struct err *e);

/* store_failed: set *e from the database's last error: what went wrong, in which file. Returns false. */
bool store_failed(struct store *s, struct err *e);

/* store_exec: run SQL text that returns nothing of interest. */
bool store_exec(struct store *s, const char *sql, struct err *e);

#endif

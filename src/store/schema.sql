-- The database of mimdsim. Simulated times are integer picoseconds, sizes bytes; every column name ends in its unit.
-- Tables are for programs, views (v_...) for people and figures. Non-finite numbers are NULL.

CREATE TABLE meta (
    key   TEXT PRIMARY KEY,
    value TEXT
) STRICT, WITHOUT ROWID;

-- The programs that wrote rows here.
CREATE TABLE build (
    id       INTEGER PRIMARY KEY,
    version  TEXT NOT NULL,
    git      TEXT NOT NULL,
    compiler TEXT NOT NULL,
    flags    TEXT NOT NULL,
    UNIQUE (version, git, compiler, flags)
) STRICT;

-- One row per run. Its identity, by which a campaign resumes, is (config_hash, seed, rep).
CREATE TABLE run (
    id               INTEGER PRIMARY KEY,
@run@
    build_id         INTEGER NOT NULL REFERENCES build (id),
    created_utc      TEXT NOT NULL,
    UNIQUE (config_hash, seed, rep)
) STRICT;
CREATE INDEX run_by_point ON run (machine, kernel, n, P);

-- Runs from a database of an older version that this program cannot describe any more: they keep their config_hash of
-- then, so no run of today is taken for one of them.
CREATE TABLE run_older (
    run_id  INTEGER PRIMARY KEY REFERENCES run (id) ON DELETE CASCADE,
    version INTEGER NOT NULL,          -- of the database that it came from
    reason  TEXT NOT NULL
) STRICT;

-- Every setting of every run; values are shared, so a sweep over anything can be pivoted.
CREATE TABLE setting (
    id    INTEGER PRIMARY KEY,
    key   TEXT NOT NULL,
    value TEXT NOT NULL,
    UNIQUE (key, value)
) STRICT;
CREATE TABLE run_setting (
    run_id     INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    setting_id INTEGER NOT NULL REFERENCES setting (id),
    PRIMARY KEY (run_id, setting_id)
) STRICT, WITHOUT ROWID;

-- Where the time of each stage went, over all ranks of the run. total = compute + send + recv + wait + contention.
CREATE TABLE stage (
    run_id            INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    stage             INTEGER NOT NULL,
@stage@
    PRIMARY KEY (run_id, stage)
) STRICT, WITHOUT ROWID;

-- The same per rank, for runs of at most meta.rank_rows_limit ranks. A rank that did nothing in a stage has no row.
CREATE TABLE rank_stage (
    run_id        INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    rank          INTEGER NOT NULL,
    stage         INTEGER NOT NULL,
@rank_stage@
    PRIMARY KEY (run_id, rank, stage)
) STRICT, WITHOUT ROWID;

-- Serial codes that the speedup is measured against: predicted time on one processor of the same machine.
CREATE TABLE baseline (
    run_id       INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    ordinal      INTEGER NOT NULL,
@baseline@
    PRIMARY KEY (run_id, ordinal)
) STRICT, WITHOUT ROWID;

-- Numbers of a run checked against independent references.
CREATE TABLE error_check (
    run_id         INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    ordinal        INTEGER NOT NULL,
@error_check@
    CHECK (passed IN (0, 1)),
    PRIMARY KEY (run_id, ordinal)
) STRICT, WITHOUT ROWID;

-- Recorded loads of links; of very many only the meta.link_rows_limit busiest.
CREATE TABLE link_load (
    run_id      INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    link        INTEGER NOT NULL,
@link_load@
    PRIMARY KEY (run_id, link)
) STRICT, WITHOUT ROWID;

-- The timeline of a small run, whole or not at all (meta.span_rows_limit); longer ones are files, in table trace.
CREATE TABLE span (
    run_id   INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    span     INTEGER NOT NULL,
@span@
    PRIMARY KEY (run_id, span)
) STRICT, WITHOUT ROWID;

CREATE TABLE trace (
    run_id         INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
    path           TEXT NOT NULL,
    format         TEXT NOT NULL,
    sha256         TEXT NOT NULL,
    size_bytes     INTEGER NOT NULL,
    spans          INTEGER NOT NULL,
    spans_left_out INTEGER NOT NULL,
    PRIMARY KEY (run_id, path)
) STRICT, WITHOUT ROWID;

-- Comparison of a result with a value known from elsewhere: closed forms, stored cases, published figures.
CREATE TABLE check_point (
    id             INTEGER PRIMARY KEY,
    suite          TEXT NOT NULL,
    subject        TEXT NOT NULL,
    quantity       TEXT NOT NULL,
    at             TEXT NOT NULL,      -- where: "P=128", "4096 B"
    unit           TEXT NOT NULL,
    reference      REAL,
    value          REAL,
    relative_error REAL,
    tolerance      REAL,
    class          TEXT NOT NULL,      -- evidence: exact, P, PR, D, E, blind
    verdict        TEXT NOT NULL CHECK (verdict IN ('pass', 'fail', 'explained', 'not-testable')),
    source         TEXT NOT NULL,
    cause          TEXT NOT NULL DEFAULT '', -- of an error that is explained, of a point that cannot be tested
    UNIQUE (suite, subject, quantity, at)
) STRICT;

-- The claims of the paper. One row per claim and variant (serial baseline, operators, machine); variant '' is the
-- claim's own verdict. `share` is the fraction of samples of the uncertain parameters in which it holds.
CREATE TABLE claim (
    id         TEXT NOT NULL,
    variant    TEXT NOT NULL,
    statement  TEXT NOT NULL,
    test       TEXT NOT NULL,          -- formula over this database
    unit       TEXT NOT NULL,
    value      REAL,
    threshold  REAL,
    value_low  REAL,                   -- range over the samples
    value_high REAL,
    samples    INTEGER NOT NULL DEFAULT 0,
    share      REAL,
    verdict    TEXT NOT NULL CHECK (verdict IN ('pass', 'fail', 'not-testable')),
    judged     TEXT NOT NULL DEFAULT '', -- of variant '': which row is judged, with which tolerance, and why
    testable   INTEGER,                -- of variant '': how many variants can be judged, and in how many it holds
    holding    INTEGER,
    note       TEXT NOT NULL DEFAULT '',
    PRIMARY KEY (id, variant)
) STRICT, WITHOUT ROWID;
CREATE TABLE claim_sample (
    id      TEXT NOT NULL,
    variant TEXT NOT NULL,
    sample  INTEGER NOT NULL,
    value   REAL,
    holds   INTEGER CHECK (holds IN (0, 1)),
    PRIMARY KEY (id, variant, sample)
) STRICT, WITHOUT ROWID;
-- The machine parameters that were drawn for a sample, in SI units.
CREATE TABLE sample_setting (
    sample INTEGER NOT NULL,
    key    TEXT NOT NULL,
    value  REAL,
    PRIMARY KEY (sample, key)
) STRICT, WITHOUT ROWID;

-- Error against run time: one row per rung of a ladder (network, arithmetic, integration), failed ones too.
CREATE TABLE ladder (
    scenario       TEXT NOT NULL,
    ladder         TEXT NOT NULL,
    at             TEXT NOT NULL,      -- point of the scenario: "n=P=128"
    family         TEXT NOT NULL,      -- SHA-256 of the settings without sizes, level and seeds: what it holds for
    method         TEXT NOT NULL,      -- a curve
    rung           TEXT NOT NULL,      -- a point on it: level, step size, tolerance
    ordinal        INTEGER NOT NULL,
    quantity       TEXT NOT NULL,
    reference      TEXT NOT NULL,
    relative_error REAL,               -- NULL: failed, or not finite
    host_s         REAL,
    machine_ps     INTEGER,            -- predicted time on the machine
    status         TEXT NOT NULL CHECK (status IN ('ok', 'degraded', 'failed')),
    text           TEXT NOT NULL DEFAULT '',
    PRIMARY KEY (scenario, ladder, family, at, method, rung, quantity)
) STRICT, WITHOUT ROWID;
CREATE TABLE ladder_choice (
    scenario       TEXT NOT NULL,
    ladder         TEXT NOT NULL,
    at             TEXT NOT NULL,
    quantity       TEXT NOT NULL,
    tolerance      REAL NOT NULL,
    method         TEXT,               -- NULL: no rung is within the tolerance
    rung           TEXT,
    relative_error REAL,
    cost_ratio     REAL,               -- of the finest rung's cost to this one's
    PRIMARY KEY (scenario, ladder, at, quantity, tolerance)
) STRICT, WITHOUT ROWID;

-- Stiff and extreme cases against algorithms.
CREATE TABLE stability (
    suite          TEXT NOT NULL,
    subject        TEXT NOT NULL,      -- the case
    algorithm      TEXT NOT NULL,
    precision      TEXT NOT NULL,
    ordinal        INTEGER NOT NULL,
    status         TEXT NOT NULL CHECK (status IN ('ok', 'degraded', 'failed')),
    relative_error REAL,
    residual       REAL,
    condition      REAL,
    growth         REAL,
    refinements    INTEGER,
    energy_drift   REAL,
    step_s         REAL,               -- largest stable step, of integrators
    reason         TEXT NOT NULL,
    PRIMARY KEY (suite, subject, algorithm, precision)
) STRICT, WITHOUT ROWID;

-- What was not computed because the scene of the run does not need it.
CREATE TABLE run_omission (
    run_id INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,
@run_omission@
    PRIMARY KEY (run_id, what)
) STRICT, WITHOUT ROWID;

-- The omissions of a scenario, and what they save.
CREATE TABLE omission (
    scenario         TEXT NOT NULL,
    what             TEXT NOT NULL,
    ordinal          INTEGER NOT NULL,
    why              TEXT NOT NULL,
    class            TEXT NOT NULL CHECK (class IN ('exact', 'bounded')),
    bound            REAL,             -- relative, of bounded ones
    at               TEXT NOT NULL,    -- point of the scenario that was measured: "n=P=128"
    host_s           REAL,             -- of the run without it; NULL here and below: nothing brings it back
    host_saved_s     REAL,
    host_noise_s     REAL,             -- savings below it cannot be told from nothing
    machine_ps       INTEGER,
    machine_saved_ps INTEGER,
    PRIMARY KEY (scenario, what)
) STRICT, WITHOUT ROWID;

-- Speedup against each serial baseline; degree of parallelism f by Amdahl, 1/S = (1 - f) + f/P.
CREATE VIEW v_speedup AS
SELECT r.id AS run_id, r.scenario, r.machine, r.topology, r.level, r.kernel, r.formulation, r.solver, r.part_solver,
       r.operators, r.precision, r.base, r.n, r.P, r.compute_noise_cv, r.background_load, r.seed, r.rep,
       b.ordinal AS baseline_ordinal, b.name AS baseline, b.time_ps AS baseline_ps, r.makespan_ps,
       CAST(b.time_ps AS REAL) / nullif(r.makespan_ps, 0) AS speedup,
       CAST(b.time_ps AS REAL) / nullif(r.makespan_ps, 0) / r.P AS efficiency,
       CASE WHEN r.P > 1 AND b.time_ps > 0
            THEN (1.0 - CAST(r.makespan_ps AS REAL) / b.time_ps) / (1.0 - 1.0 / r.P) END AS parallel_fraction
FROM run r JOIN baseline b ON b.run_id = r.id
WHERE r.status = 'ok';

-- Time per stage: largest over the ranks, and the means, which add up to the makespan over all stages.
CREATE VIEW v_stage AS
SELECT r.id AS run_id, r.scenario, r.machine, r.level, r.kernel, r.formulation, r.solver, r.operators, r.n, r.P,
       s.stage, s.name, s.total_max_ps,
       s.total_sum_ps      / (1.0 * r.P) AS total_mean_ps,
       s.compute_sum_ps    / (1.0 * r.P) AS compute_mean_ps,    s.compute_max_ps,
       s.send_sum_ps       / (1.0 * r.P) AS send_mean_ps,       s.send_max_ps,
       s.recv_sum_ps       / (1.0 * r.P) AS recv_mean_ps,       s.recv_max_ps,
       s.wait_sum_ps       / (1.0 * r.P) AS wait_mean_ps,       s.wait_max_ps,
       s.contention_sum_ps / (1.0 * r.P) AS contention_mean_ps, s.contention_max_ps,
       s.messages, s.sent_bytes, s.flops
FROM run r JOIN stage s ON s.run_id = r.id
WHERE r.status = 'ok';

-- The ten links of each run that were busy longest; a port of a node has no router at one end.
CREATE VIEW v_link_top AS
SELECT run_id, scenario, machine, topology, level, kernel, n, P, place, link, from_router, to_router, node, messages,
       sent_bytes, busy_ps, busy_share, queue_ps
FROM (SELECT r.id AS run_id, r.scenario, r.machine, r.topology, r.level, r.kernel, r.n, r.P, l.link, l.from_router,
             l.to_router, l.node, l.messages, l.sent_bytes, l.busy_ps,
             1.0 * l.busy_ps / nullif(r.makespan_ps, 0) AS busy_share, l.queue_ps,
             row_number() OVER (PARTITION BY r.id ORDER BY l.busy_ps DESC, l.queue_ps DESC, l.link) AS place
      FROM link_load l JOIN run r ON r.id = l.run_id)
WHERE place <= 10;

-- Proof that nothing is lost: over all ranks and stages the parts add up to P times the makespan, to the picosecond.
CREATE VIEW v_accounting AS
SELECT r.id AS run_id, r.scenario, r.n, r.P, r.makespan_ps, r.P * r.makespan_ps AS expected_ps,
       sum(s.compute_sum_ps + s.send_sum_ps + s.recv_sum_ps + s.wait_sum_ps + s.contention_sum_ps) AS found_ps,
       sum(s.compute_sum_ps + s.send_sum_ps + s.recv_sum_ps + s.wait_sum_ps + s.contention_sum_ps)
           - r.P * r.makespan_ps AS difference_ps,
       r.accounting_error_ps
FROM run r JOIN stage s ON s.run_id = r.id
WHERE r.status IN ('ok', 'invalid')
GROUP BY r.id;

CREATE VIEW v_errors AS
SELECT r.id AS run_id, r.scenario, r.machine, r.kernel, r.formulation, r.solver, r.precision, r.n, r.P, r.status,
       e.quantity, e.reference, e.relative_error, e.tolerance, e.passed
FROM run r JOIN error_check e ON e.run_id = r.id;

-- The paper's indicators: run time over communication and synchronisation (R/C), and spread of the load.
CREATE VIEW v_indicator AS
SELECT r.id AS run_id, r.scenario, r.machine, r.level, r.kernel, r.formulation, r.operators, r.n, r.P, r.makespan_ps,
       1.0 * r.P * r.makespan_ps
           / nullif(sum(s.send_sum_ps + s.recv_sum_ps + s.wait_sum_ps + s.contention_sum_ps), 0) AS rc_ratio,
       1.0 * sum(s.compute_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS compute_share,
       1.0 * sum(s.send_sum_ps + s.recv_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS overhead_share,
       1.0 * sum(s.wait_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS wait_share,
       1.0 * sum(s.contention_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS contention_share,
       1.0 * (r.rank_compute_max_ps - r.rank_compute_min_ps) * r.P / nullif(sum(s.compute_sum_ps), 0) AS load_spread
FROM run r JOIN stage s ON s.run_id = r.id
WHERE r.status = 'ok'
GROUP BY r.id;

-- Repetitions of one configuration (noise, background traffic): mean, spread, and the half-width of the 95 % confidence
-- interval of the mean by Student's t.
CREATE VIEW v_repetition AS
WITH spread AS (
    SELECT min(id) AS run_id, config_hash, scenario, machine, level, kernel, formulation, n, P, count(*) AS repetitions,
           avg(makespan_ps) AS mean_ps, min(makespan_ps) AS min_ps, max(makespan_ps) AS max_ps,
           CASE WHEN count(*) > 1
                THEN sqrt(max(0.0, avg(1.0 * makespan_ps * makespan_ps) - avg(makespan_ps) * avg(makespan_ps))
                          * count(*) / (count(*) - 1.0)) END AS deviation_ps
    FROM run WHERE status = 'ok' GROUP BY config_hash)
SELECT *, deviation_ps / sqrt(repetitions)
           * CASE repetitions WHEN 2 THEN 12.706 WHEN 3 THEN 4.303 WHEN 4 THEN 3.182 WHEN 5 THEN 2.776 WHEN 6 THEN 2.571
                              WHEN 7 THEN 2.447 WHEN 8 THEN 2.365 WHEN 9 THEN 2.306 WHEN 10 THEN 2.262
                              ELSE 1.96 + 2.5 / (repetitions - 1) END AS confidence95_ps
FROM spread;

-- Whose machine a run was made on: 'as shipped'; 'changed', by --set, by its scenario or by a file of one's own with the
-- same name; 'own', no machine of that name is shipped; 'older', the shipped file was another one when the database's
-- latest run on that machine was made. Only runs on machines as shipped enter a claim, unless its file names a change.
CREATE VIEW v_machine_state AS
WITH newest AS (
    SELECT machine, machine_hash FROM run WHERE id IN (SELECT max(id) FROM run WHERE machine_changes IS NOT NULL GROUP BY machine))
SELECT r.id AS run_id, r.machine, r.machine_changes,
       CASE WHEN r.machine_changes IS NULL AND r.machine_hash IS NULL THEN 'own' WHEN r.machine_changes IS NULL
            OR r.machine_hash <> w.machine_hash THEN 'older'
            WHEN r.machine_changes = '{}' THEN 'as shipped' ELSE 'changed' END AS state
FROM run r LEFT JOIN newest w ON w.machine = r.machine;

-- The runs that figures show: those on a machine as shipped; where a machine and kernel has none of these, all it has.
CREATE VIEW v_shown AS
WITH state AS (
    SELECT s.run_id, r.machine, r.kernel, s.state = 'as shipped' AS shipped
    FROM v_machine_state s JOIN run r ON r.id = s.run_id WHERE r.status = 'ok'),
most AS (SELECT machine, kernel, max(shipped) AS shipped FROM state GROUP BY machine, kernel)
SELECT a.run_id FROM state a JOIN most b ON b.machine = a.machine AND b.kernel = a.kernel AND b.shipped = a.shipped;

CREATE VIEW v_setting AS
SELECT rs.run_id, s.key, s.value FROM run_setting rs JOIN setting s ON s.id = rs.setting_id;

-- The settings that differ between the runs of a scenario: what it sweeps.
CREATE VIEW v_itervar AS
WITH varied AS (
    SELECT r.scenario, s.key
    FROM run_setting rs JOIN run r ON r.id = rs.run_id JOIN setting s ON s.id = rs.setting_id
    GROUP BY r.scenario, s.key HAVING count(DISTINCT s.id) > 1)
SELECT rs.run_id, r.scenario, s.key, s.value
FROM run_setting rs JOIN run r ON r.id = rs.run_id JOIN setting s ON s.id = rs.setting_id
     JOIN varied v ON v.scenario = r.scenario AND v.key = s.key;

CREATE VIEW v_claims AS
SELECT id, variant, statement, verdict, value, unit, threshold, value_low, value_high, share, samples, testable, holding,
       judged, note
FROM claim;

-- Who made a row, with what.
CREATE VIEW v_provenance AS
SELECT r.id AS run_id, r.scenario, r.config_hash, r.seed, r.rep, r.digest, r.status, r.created_utc, b.version, b.git,
       b.compiler, b.flags, r.host_s, r.host_total_s, r.host_peak_bytes, r.left_out
FROM run r JOIN build b ON b.id = r.build_id;

-- What would make claims hold (claims --explain). Tables from here on may be missing in databases of this version that
-- were made by earlier programs; whoever opens one for writing adds them.
-- One row a point of the space of unstated parameters.
CREATE TABLE IF NOT EXISTS explain_point (
    id        INTEGER PRIMARY KEY,
    subject   TEXT NOT NULL,           -- claim, or 'together'
    key       TEXT NOT NULL,           -- fingerprint of operators and settings
    operators TEXT NOT NULL,
    settings  TEXT NOT NULL,           -- what differs from the machine's file, as for --set; '' is the file itself
    distance  REAL NOT NULL,           -- sum of |ln(value / nominal)|
    published INTEGER NOT NULL,        -- 1: every change is within a published range
    runs      TEXT NOT NULL,           -- first 12 digits of the config_hash of each run
    UNIQUE (subject, key)
) STRICT;
-- Every variant of the claim at that point, by the claim's own query.
CREATE TABLE IF NOT EXISTS explain_judged (
    point_id INTEGER NOT NULL REFERENCES explain_point (id) ON DELETE CASCADE,
    claim    TEXT NOT NULL,
    variant  TEXT NOT NULL,
    value    REAL,
    margin   REAL,                     -- from holding (< 0) or from failing (> 0)
    holds    INTEGER CHECK (holds IN (0, 1)),
    PRIMARY KEY (point_id, claim, variant)
) STRICT, WITHOUT ROWID;
-- The plane of the two parameters that matter most to a claim, the others as in its answer.
CREATE TABLE IF NOT EXISTS explain_map (
    subject  TEXT NOT NULL,
    i        INTEGER NOT NULL,
    j        INTEGER NOT NULL,
    x_key    TEXT NOT NULL,
    y_key    TEXT NOT NULL,
    x_label  TEXT NOT NULL,
    y_label  TEXT NOT NULL,
    x        REAL NOT NULL,            -- value over nominal; of shares the share; so are all that follow
    y        REAL NOT NULL,
    x_low    REAL, x_high REAL,        -- published range, NULL: none
    y_low    REAL, y_high REAL,
    x_nominal REAL NOT NULL, y_nominal REAL NOT NULL,
    x_answer REAL NOT NULL, y_answer REAL NOT NULL,
    variant  TEXT NOT NULL,
    point_id INTEGER NOT NULL REFERENCES explain_point (id) ON DELETE CASCADE,
    PRIMARY KEY (subject, i, j)
) STRICT, WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS explain_answer (
    subject   TEXT NOT NULL,
    goal      TEXT NOT NULL,           -- 'own': the claim's own variant; 'any': any operators and serial baseline
    verdict   TEXT NOT NULL CHECK (verdict IN ('holds', 'not found', 'never')),
    variant   TEXT NOT NULL,
    operators TEXT NOT NULL,
    settings  TEXT NOT NULL,           -- of the smallest change that was found, or of the point nearest to holding
    distance  REAL,                    -- each other choice counted as a factor of 2
    value     REAL,
    margin    REAL,
    points    INTEGER NOT NULL,        -- that were tried for the subject
    confirmed INTEGER,                 -- 1: the study's own runs at that point say so, too; NULL: nothing to confirm
    study     INTEGER,                 -- how many they are
    sentence  TEXT NOT NULL,
    PRIMARY KEY (subject, goal)
) STRICT, WITHOUT ROWID;

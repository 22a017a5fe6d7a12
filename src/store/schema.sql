-- The database of mimdsim. Simulated times are integer picoseconds, sizes bytes; every column name ends in its unit.
-- Tables are for programs, views (v_...) for people and figures. Non-finite numbers are NULL.
-- Tables, views and indices of your own may stand beside these: they stay, and only queries that name them use them.
-- What has a name of these must be as here, and triggers are refused.

-- Limits, and what studies note of themselves.
CREATE TABLE meta (
    key   TEXT PRIMARY KEY,            -- rank_rows_limit, link_rows_limit, span_rows_limit, notes of studies
    value TEXT                         -- as text
) STRICT, WITHOUT ROWID;

-- The programs that wrote rows here.
CREATE TABLE build (
    id       INTEGER PRIMARY KEY,      -- number of the row
    version  TEXT NOT NULL,            -- of mimdsim
    git      TEXT NOT NULL,            -- commit of its sources, or a hash of them
    compiler TEXT NOT NULL,            -- with its version
    flags    TEXT NOT NULL,            -- of the compiler
    UNIQUE (version, git, compiler, flags)
) STRICT;

-- One row per run. Its identity, by which a campaign resumes, is (config_hash, seed, rep).
CREATE TABLE run (
    id               INTEGER PRIMARY KEY,  -- number of the row
@run@
    build_id         INTEGER NOT NULL REFERENCES build (id),  -- the program that made it
    created_utc      TEXT NOT NULL,    -- when, UTC
    UNIQUE (config_hash, seed, rep)
) STRICT;
CREATE INDEX run_by_point ON run (machine, kernel, n, P);

-- Runs from a database of an older version that this program cannot describe any more: they keep their config_hash of
-- then, so no run of today is taken for one of them.
CREATE TABLE run_older (
    run_id  INTEGER PRIMARY KEY REFERENCES run (id) ON DELETE CASCADE, -- the run
    version INTEGER NOT NULL,          -- of the database that it came from
    reason  TEXT NOT NULL              -- what of it is not known any more
) STRICT;

-- Every setting of every run; values are shared, so a sweep over anything can be pivoted.
CREATE TABLE setting (
    id    INTEGER PRIMARY KEY,         -- number of the row
    key   TEXT NOT NULL,               -- full name of the setting
    value TEXT NOT NULL,               -- as text, with its unit
    number REAL,                       -- the same in SI base units; NULL: a word or a list
    unit  TEXT NOT NULL DEFAULT '',    -- of number: s, B, B_per_s, ...
    UNIQUE (key, value)
) STRICT;
-- Which run has which settings.
CREATE TABLE run_setting (
    run_id     INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    setting_id INTEGER NOT NULL REFERENCES setting (id),  -- one of its settings
    PRIMARY KEY (run_id, setting_id)
) STRICT, WITHOUT ROWID;

-- Where the time of each stage went, over all ranks of the run. total = compute + send + recv + wait + contention.
CREATE TABLE stage (
    run_id            INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    stage             INTEGER NOT NULL,  -- number of the stage, from 0
@stage@
    PRIMARY KEY (run_id, stage)
) STRICT, WITHOUT ROWID;

-- The same per rank, for runs of at most meta.rank_rows_limit ranks: all of a run in one text, which view rank_stage
-- shows as rows. A row for each rank and stage took longer to store than a small run to simulate.
CREATE TABLE rank_times (
    run_id  INTEGER PRIMARY KEY REFERENCES run (id) ON DELETE CASCADE,  -- the run
    entries TEXT NOT NULL              -- JSON: [[rank, stage, ...], ...], in the order of the columns of view rank_stage
) STRICT;

-- Serial codes that the speedup is measured against: predicted time on one processor of the same machine.
CREATE TABLE baseline (
    run_id       INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    ordinal      INTEGER NOT NULL,     -- order of the serial codes
@baseline@
    PRIMARY KEY (run_id, ordinal)
) STRICT, WITHOUT ROWID;

-- Numbers of a run checked against independent references.
CREATE TABLE error_check (
    run_id         INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    ordinal        INTEGER NOT NULL,   -- order of the checks
@error_check@
    CHECK (passed IN (0, 1)),
    PRIMARY KEY (run_id, ordinal)
) STRICT, WITHOUT ROWID;

-- Recorded loads of links, of very many only the meta.link_rows_limit busiest: all of a run in one text, which view
-- link_load shows as rows.
CREATE TABLE link_loads (
    run_id  INTEGER PRIMARY KEY REFERENCES run (id) ON DELETE CASCADE,  -- the run
    entries TEXT NOT NULL              -- JSON: [[link, ...], ...], in the order of the columns of view link_load
) STRICT;

-- The timeline of a small run, whole or not at all (meta.span_rows_limit); longer ones are files, in table trace.
CREATE TABLE span (
    run_id   INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    span     INTEGER NOT NULL,         -- order of the spans
@span@
    PRIMARY KEY (run_id, span)
) STRICT, WITHOUT ROWID;

-- Timelines that were written as files.
CREATE TABLE trace (
    run_id         INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    path           TEXT NOT NULL,      -- of the file
    format         TEXT NOT NULL,      -- text, chrome, paje or csv
    sha256         TEXT NOT NULL,      -- of the file
    size_bytes     INTEGER NOT NULL,   -- of the file
    spans          INTEGER NOT NULL,   -- in the file
    spans_left_out INTEGER NOT NULL,   -- that would have made it too large
    PRIMARY KEY (run_id, path)
) STRICT, WITHOUT ROWID;

-- Comparison of a result with a value known from elsewhere: closed forms, stored cases, published figures.
CREATE TABLE check_point (
    id             INTEGER PRIMARY KEY,  -- number of the row
    suite          TEXT NOT NULL,      -- machines, or what else was compared
    subject        TEXT NOT NULL,      -- a machine, or what else was asked
    quantity       TEXT NOT NULL,      -- what was compared
    at             TEXT NOT NULL,      -- where: "P=128", "4096 B"
    unit           TEXT NOT NULL,      -- of reference and value
    reference      REAL,               -- what is known
    value          REAL,               -- what the simulator finds; NULL: not measured
    relative_error REAL,               -- of the value
    tolerance      REAL,               -- largest error that passes
    class          TEXT NOT NULL,      -- evidence: exact, P, PR, D, E, blind
    verdict        TEXT NOT NULL CHECK (verdict IN ('pass', 'fail', 'explained', 'not-testable')),  -- of the comparison
    source         TEXT NOT NULL,      -- where the reference comes from
    cause          TEXT NOT NULL DEFAULT '', -- of an error that is explained, of a point that cannot be tested
    UNIQUE (suite, subject, quantity, at)
) STRICT;

-- The claims of the paper. One row per claim and variant (serial baseline, operators, machine); variant '' is the
-- claim's own verdict. `share` is the fraction of samples of the uncertain parameters in which it holds.
CREATE TABLE claim (
    id         TEXT NOT NULL,          -- of the claim
    variant    TEXT NOT NULL,          -- serial baseline, operators and machine; '': the claim's own verdict
    statement  TEXT NOT NULL,          -- what the paper says
    test       TEXT NOT NULL,          -- formula over this database
    unit       TEXT NOT NULL,          -- of value and threshold
    value      REAL,                   -- that the test finds
    threshold  REAL,                   -- from which the claim holds
    value_low  REAL,                   -- range over the samples
    value_high REAL,                   -- range over the samples
    samples    INTEGER NOT NULL DEFAULT 0,  -- that were drawn of the uncertain parameters
    share      REAL,                   -- of the samples in which it holds
    verdict    TEXT NOT NULL CHECK (verdict IN ('pass', 'fail', 'not-testable')),  -- of the test
    judged     TEXT NOT NULL DEFAULT '', -- of variant '': which row is judged, with which tolerance, and why
    testable   INTEGER,                -- of variant '': how many variants can be judged, and in how many it holds
    holding    INTEGER,                -- in how many of these variants it holds
    note       TEXT NOT NULL DEFAULT '',  -- what was found, in words
    PRIMARY KEY (id, variant)
) STRICT, WITHOUT ROWID;
-- What a claim says of each sample.
CREATE TABLE claim_sample (
    id      TEXT NOT NULL,             -- of the claim
    variant TEXT NOT NULL,             -- as in table claim
    sample  INTEGER NOT NULL,          -- number of the sample
    value   REAL,                      -- that the test finds
    holds   INTEGER CHECK (holds IN (0, 1)),  -- 1: the claim holds
    PRIMARY KEY (id, variant, sample)
) STRICT, WITHOUT ROWID;
-- The machine parameters that were drawn for a sample, in SI units.
CREATE TABLE sample_setting (
    sample INTEGER NOT NULL,           -- number of the sample
    key    TEXT NOT NULL,              -- full name of the parameter
    value  REAL,                       -- that was drawn
    PRIMARY KEY (sample, key)
) STRICT, WITHOUT ROWID;

-- Error against run time: one row per rung of a ladder (network, arithmetic, integration), failed ones too.
CREATE TABLE ladder (
    scenario       TEXT NOT NULL,      -- that was climbed
    ordinal        INTEGER NOT NULL,   -- order of the rungs
@ladder@
    PRIMARY KEY (scenario, ladder, family, at, method, rung, quantity)
) STRICT, WITHOUT ROWID;
-- The cheapest rung of each ladder within a tolerance.
CREATE TABLE ladder_choice (
    scenario       TEXT NOT NULL,      -- that was climbed
@ladder_choice@
    PRIMARY KEY (scenario, ladder, at, quantity, tolerance)
) STRICT, WITHOUT ROWID;

-- Stiff and extreme cases against algorithms.
CREATE TABLE stability (
    suite          TEXT NOT NULL,      -- 'suite', or the scenario
    ordinal        INTEGER NOT NULL,   -- order of the rows
@stability@
    PRIMARY KEY (suite, subject, algorithm, precision)
) STRICT, WITHOUT ROWID;

-- What was not computed because the scene of the run does not need it.
CREATE TABLE run_omission (
    run_id INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
@run_omission@
    PRIMARY KEY (run_id, what)
) STRICT, WITHOUT ROWID;

-- The omissions of a scenario, and what they save.
CREATE TABLE omission (
    scenario         TEXT NOT NULL,    -- that was measured
    ordinal          INTEGER NOT NULL,  -- order of the omissions
@omission@
    PRIMARY KEY (scenario, what)
) STRICT, WITHOUT ROWID;

-- Runs of programs on real computers, not simulated. Each measurement is a row of its own.
CREATE TABLE real_run (
    real_id     TEXT PRIMARY KEY,      -- of the row: made of what was run, where and when
    task_hash   TEXT NOT NULL,         -- SHA-256 of all settings but those of the machine
    scenario    TEXT NOT NULL,         -- stem of the scenario file, or the command that was recorded
    program     TEXT NOT NULL,         -- what ran
    n           INTEGER NOT NULL,      -- bodies; 0: it has no scene
    settings    TEXT NOT NULL,         -- all settings of the task, or the arguments of the command
@real_run@
    build_id    INTEGER NOT NULL REFERENCES build (id),  -- the program that made it
    created_utc TEXT NOT NULL          -- when, UTC
) STRICT, WITHOUT ROWID;

-- Where the time of a real run went, by stage of the program; the last one is waiting for the last rank.
CREATE TABLE real_stage (
    real_id     TEXT NOT NULL REFERENCES real_run (real_id) ON DELETE CASCADE,  -- the real run
    stage       INTEGER NOT NULL,      -- number of the stage, from 0
@real_stage@
    PRIMARY KEY (real_id, stage)
) STRICT, WITHOUT ROWID;

-- Every repetition of a real run, in the order made.
CREATE TABLE real_sample (
    real_id     TEXT NOT NULL REFERENCES real_run (real_id) ON DELETE CASCADE,  -- the real run
    sample      INTEGER NOT NULL,      -- number of the repetition, from 0
@real_sample@
    PRIMARY KEY (real_id, sample)
) STRICT, WITHOUT ROWID;

-- Where the time of each rank went, stage by stage (table rank_times). A rank that did nothing in a stage has no row.
--   run_id: the run
--   rank: number of the rank, from 0
--   stage: number of the stage, from 0
@rank_stage.words@
CREATE VIEW rank_stage AS
SELECT t.run_id, json_extract(e.value, '$[0]') AS rank, json_extract(e.value, '$[1]') AS stage
@rank_stage.fields@
FROM rank_times t JOIN json_each(t.entries) e;

-- Recorded loads of links (table link_loads).
--   run_id: the run
--   link: number of the link
@link_load.words@
CREATE VIEW link_load AS
SELECT t.run_id, json_extract(e.value, '$[0]') AS link
@link_load.fields@
FROM link_loads t JOIN json_each(t.entries) e;

-- Speedup against each serial baseline; degree of parallelism f by Amdahl, 1/S = (1 - f) + f/P.
--   run_id: the run
--   baseline_ordinal: order of the serial codes
--   baseline: the serial code
--   baseline_ps: its predicted time on one processor
--   speedup: time of the serial code over that of the run
--   efficiency: speedup over P
--   parallel_fraction: f by Amdahl, NULL on one processor
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
--   run_id: the run
--   total_mean_ps: all parts, mean over the ranks
--   compute_mean_ps: computing, mean over the ranks
--   send_mean_ps: send overhead, mean over the ranks
--   recv_mean_ps: receive overhead, mean over the ranks
--   wait_mean_ps: waiting, mean over the ranks
--   contention_mean_ps: further waiting for links, ports and servers, mean over the ranks
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
--   run_id: the run
--   place: 1 is the link that was busy longest
--   busy_share: time in use over the makespan
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
--   run_id: the run
--   expected_ps: P times the makespan
--   found_ps: sum of all parts over ranks and stages
--   difference_ps: found less expected; 0 is exact
CREATE VIEW v_accounting AS
SELECT r.id AS run_id, r.scenario, r.n, r.P, r.makespan_ps, r.P * r.makespan_ps AS expected_ps,
       s.us * 1000000 + s.ps AS found_ps,
       (s.us - r.P * (r.makespan_ps / 1000000)) * 1000000 + (s.ps - r.P * (r.makespan_ps % 1000000)) AS difference_ps,
       r.accounting_error_ps
-- us, ps: whole microseconds and the rest apart, whose sums stay within 64 bits, NULL where a stage's own sum does not
FROM run r JOIN (SELECT run_id,
                        iif(count(total_sum_ps) = count(*),
                            sum(compute_sum_ps / 1000000 + send_sum_ps / 1000000 + recv_sum_ps / 1000000
                                + wait_sum_ps / 1000000 + contention_sum_ps / 1000000), NULL) AS us,
                        sum(compute_sum_ps % 1000000 + send_sum_ps % 1000000 + recv_sum_ps % 1000000
                            + wait_sum_ps % 1000000 + contention_sum_ps % 1000000) AS ps
                 FROM stage GROUP BY run_id) s ON s.run_id = r.id
WHERE r.status IN ('ok', 'invalid');

-- Checks of all runs, with what was run.
--   run_id: the run
CREATE VIEW v_errors AS
SELECT r.id AS run_id, r.scenario, r.machine, r.kernel, r.formulation, r.solver, r.precision, r.n, r.P, r.status,
       e.quantity, e.reference, e.relative_error, e.tolerance, e.passed
FROM run r JOIN error_check e ON e.run_id = r.id;

-- The paper's indicators: run time over communication and synchronisation (R/C), and spread of the load.
--   run_id: the run
--   rc_ratio: time of all ranks over their communication and waiting
--   compute_share: of the time of all ranks
--   overhead_share: sending and receiving, of the time of all ranks
--   wait_share: of the time of all ranks
--   contention_share: of the time of all ranks
--   load_spread: computing of the most less that of the least loaded rank, over the mean
CREATE VIEW v_indicator AS
SELECT r.id AS run_id, r.scenario, r.machine, r.level, r.kernel, r.formulation, r.operators, r.n, r.P, r.makespan_ps,
       1.0 * r.P * r.makespan_ps
           / nullif(total(s.send_sum_ps + s.recv_sum_ps + s.wait_sum_ps + s.contention_sum_ps), 0) AS rc_ratio,
       total(s.compute_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS compute_share,
       total(s.send_sum_ps + s.recv_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS overhead_share,
       total(s.wait_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS wait_share,
       total(s.contention_sum_ps) / nullif(r.P * r.makespan_ps, 0) AS contention_share,
       1.0 * (r.rank_compute_max_ps - r.rank_compute_min_ps) * r.P / nullif(total(s.compute_sum_ps), 0) AS load_spread
FROM run r JOIN stage s ON s.run_id = r.id
WHERE r.status = 'ok'
GROUP BY r.id;

-- Repetitions of one configuration (noise, background traffic): mean, spread, and the half-width of the 95 % confidence
-- interval of the mean by Student's t.
--   run_id: the first of the runs
--   repetitions: how many
--   mean_ps: of their makespans
--   min_ps: least makespan
--   max_ps: largest makespan
--   deviation_ps: standard deviation of the makespan
--   confidence95_ps: half the width of the confidence interval of the mean
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
--   run_id: the run
--   state: 'as shipped', 'changed', 'own' or 'older'
CREATE VIEW v_machine_state AS
WITH newest AS (
    SELECT machine, machine_hash FROM run WHERE id IN (SELECT max(id) FROM run WHERE machine_changes IS NOT NULL GROUP BY machine))
SELECT r.id AS run_id, r.machine, r.machine_changes,
       CASE WHEN r.machine_changes IS NULL AND r.machine_hash IS NULL THEN 'own' WHEN r.machine_changes IS NULL
            OR r.machine_hash <> w.machine_hash THEN 'older'
            WHEN r.machine_changes = '{}' THEN 'as shipped' ELSE 'changed' END AS state
FROM run r LEFT JOIN newest w ON w.machine = r.machine;

-- The runs that figures show: those on a machine as shipped; where a machine and kernel has none of these, those on the one
-- changed machine that has most of them, the latest of equals. So no curve mixes two machines of one name.
--   run_id: a run that figures show
CREATE VIEW v_shown AS
WITH state AS (
    SELECT s.run_id, r.machine, r.kernel, r.machine_key, s.state = 'as shipped' AS shipped
    FROM v_machine_state s JOIN run r ON r.id = s.run_id WHERE r.status = 'ok'),
most AS (SELECT machine, kernel, max(shipped) AS shipped FROM state GROUP BY machine, kernel),
one AS (
    SELECT machine, kernel, machine_key,
           row_number() OVER (PARTITION BY machine, kernel ORDER BY count(*) DESC, max(run_id) DESC) AS choice
    FROM state WHERE NOT shipped GROUP BY machine, kernel, machine_key)
SELECT a.run_id FROM state a JOIN most b ON b.machine = a.machine AND b.kernel = a.kernel AND b.shipped = a.shipped
     LEFT JOIN one c ON c.machine = a.machine AND c.kernel = a.kernel AND c.machine_key = a.machine_key AND NOT a.shipped
WHERE a.shipped OR c.choice = 1;

-- What each run is called in legends and tables. Where one name was given to several machines, a part of the machine's
-- fingerprint tells them apart: no two machines share a name here.
--   run_id: the run
--   name: its label, with "[machine_key]" where other machines have that label, too
CREATE VIEW v_label AS
WITH shared AS (SELECT label FROM run GROUP BY label HAVING count(DISTINCT machine_key) > 1)
SELECT id AS run_id, machine, label, machine_key,
       CASE WHEN label IN (SELECT label FROM shared) THEN label || ' [' || substr(machine_key, 1, 4) || ']' ELSE label END AS name
FROM run;

-- Every run that ended well with its chief results: what `mimdsim plot --x --y` and `mimdsim compare` draw from.
--   run_id: the run
--   name: what it is called (v_label)
--   makespan_s: its time
--   speedup: over the fastest serial code
--   efficiency: that over P
--   parallel_fraction: f by Amdahl of that
--   speedup_self: over the same code on one processor
--   compute_share: of the time of all ranks
--   overhead_share: sending and receiving, of the time of all ranks
--   wait_share: of the time of all ranks
--   contention_share: of the time of all ranks
--   rc_ratio: time of all ranks over their communication and waiting
--   load_spread: computing of the most less that of the least loaded rank, over the mean
--   relative_error: largest of its checks
CREATE VIEW v_run AS
SELECT r.id AS run_id, l.name, r.scenario, r.machine, r.topology, r.level, r.placement, r.kernel, r.formulation, r.solver,
       r.part_solver, r.operators, r.precision, r.model, r.base, r.joint, r.n, r.nu, r.P, r.compute_noise_cv,
       r.background_load, r.seed, r.rep, r.config_hash, r.machine_key, r.makespan_ps * 1e-12 AS makespan_s,
       f.speedup, f.efficiency, f.parallel_fraction, o.speedup AS speedup_self, i.compute_share, i.overhead_share,
       i.wait_share, i.contention_share, i.rc_ratio, i.load_spread, r.measured_s, r.messages, r.sent_bytes, r.host_s,
       (SELECT max(e.relative_error) FROM error_check e WHERE e.run_id = r.id) AS relative_error
FROM run r JOIN v_label l ON l.run_id = r.id
     LEFT JOIN v_speedup f ON f.run_id = r.id AND f.baseline = 'fastest serial'
     LEFT JOIN v_speedup o ON o.run_id = r.id AND o.baseline = 'parallel code on one processor'
     LEFT JOIN v_indicator i ON i.run_id = r.id
WHERE r.status = 'ok';

-- Settings whose 0 means that there is no limit.
--   key: full name of the setting
CREATE VIEW v_unlimited AS
@unlimited@

-- The settings of every run. What has no limit has the value 'unlimited', and no number.
--   run_id: the run
--   value: as text, with its unit
--   number: the same in SI base units; NULL: a word, a list, or no limit
CREATE VIEW v_setting AS
SELECT rs.run_id, s.key, iif(s.number = 0 AND s.key IN (SELECT key FROM v_unlimited), 'unlimited', s.value) AS value,
       iif(s.number = 0 AND s.key IN (SELECT key FROM v_unlimited), NULL, s.number) AS number, s.unit
FROM run_setting rs JOIN setting s ON s.id = rs.setting_id;

-- The settings that differ between the runs of a scenario: what it sweeps.
--   run_id: the run
CREATE VIEW v_itervar AS
WITH varied AS (
    SELECT r.scenario, s.key
    FROM run_setting rs JOIN run r ON r.id = rs.run_id JOIN setting s ON s.id = rs.setting_id
    GROUP BY r.scenario, s.key HAVING count(DISTINCT s.id) > 1)
SELECT rs.run_id, r.scenario, s.key, iif(s.number = 0 AND s.key IN (SELECT key FROM v_unlimited), 'unlimited', s.value) AS value,
       iif(s.number = 0 AND s.key IN (SELECT key FROM v_unlimited), NULL, s.number) AS number, s.unit
FROM run_setting rs JOIN run r ON r.id = rs.run_id JOIN setting s ON s.id = rs.setting_id
     JOIN varied v ON v.scenario = r.scenario AND v.key = s.key;

-- The claims and their variants, as people read them.
CREATE VIEW v_claims AS
SELECT id, variant, statement, verdict, value, unit, threshold, value_low, value_high, share, samples, testable, holding,
       judged, note
FROM claim;

-- Who made a row, with what.
--   run_id: the run
CREATE VIEW v_provenance AS
SELECT r.id AS run_id, r.scenario, r.config_hash, r.seed, r.rep, r.digest, r.status, r.created_utc, b.version, b.git,
       b.compiler, b.flags, r.host_s, r.host_total_s, r.host_peak_bytes, r.left_out
FROM run r JOIN build b ON b.id = r.build_id;

-- What would make claims hold (claims --explain). Tables from here on may be missing in databases of this version that
-- were made by earlier programs; whoever opens one for writing adds them.
-- One row a point of the space of unstated parameters.
CREATE TABLE IF NOT EXISTS explain_point (
    id        INTEGER PRIMARY KEY,     -- number of the row
    subject   TEXT NOT NULL,           -- claim, or 'together'
    key       TEXT NOT NULL,           -- fingerprint of operators and settings
    operators TEXT NOT NULL,           -- how the matrices of a body are built and counted
    settings  TEXT NOT NULL,           -- what differs from the machine's file, as for --set; '' is the file itself
    distance  REAL NOT NULL,           -- sum of |ln(value / nominal)|
    published INTEGER NOT NULL,        -- 1: every change is within a published range
    runs      TEXT NOT NULL,           -- first 12 digits of the config_hash of each run
    UNIQUE (subject, key)
) STRICT;
-- Every variant of the claim at that point, by the claim's own query.
CREATE TABLE IF NOT EXISTS explain_judged (
    point_id INTEGER NOT NULL REFERENCES explain_point (id) ON DELETE CASCADE,  -- the point
    claim    TEXT NOT NULL,            -- its id
    variant  TEXT NOT NULL,            -- as in table claim
    value    REAL,                     -- that the test finds
    margin   REAL,                     -- from holding (< 0) or from failing (> 0)
    holds    INTEGER CHECK (holds IN (0, 1)),  -- 1: the claim holds there
    PRIMARY KEY (point_id, claim, variant)
) STRICT, WITHOUT ROWID;
-- The plane of the two parameters that matter most to a claim, the others as in its answer.
CREATE TABLE IF NOT EXISTS explain_map (
    subject  TEXT NOT NULL,            -- the claim
    i        INTEGER NOT NULL,         -- column of the map
    j        INTEGER NOT NULL,         -- row of the map
    x_key    TEXT NOT NULL,            -- parameter from left to right
    y_key    TEXT NOT NULL,            -- parameter from bottom to top
    x_label  TEXT NOT NULL,            -- the same for people
    y_label  TEXT NOT NULL,            -- the same for people
    x        REAL NOT NULL,            -- value over nominal; of shares the share; so are all that follow
    y        REAL NOT NULL,            -- likewise
    x_low    REAL,        -- published range, NULL: none
    x_high REAL,                       -- likewise
    y_low    REAL,                     -- likewise
    y_high REAL,                       -- likewise
    x_nominal REAL NOT NULL,           -- the machine file's value
    y_nominal REAL NOT NULL,           -- the machine file's value
    x_answer REAL NOT NULL,            -- where the claim holds, or is nearest to it
    y_answer REAL NOT NULL,            -- likewise
    variant  TEXT NOT NULL,            -- as in table claim
    point_id INTEGER NOT NULL REFERENCES explain_point (id) ON DELETE CASCADE,  -- the point that was judged
    PRIMARY KEY (subject, i, j)
) STRICT, WITHOUT ROWID;
-- The smallest change under which a claim holds, as a sentence.
CREATE TABLE IF NOT EXISTS explain_answer (
    subject   TEXT NOT NULL,           -- claim, or 'together'
    goal      TEXT NOT NULL,           -- 'own': the claim's own variant; 'any': any operators and serial baseline
    verdict   TEXT NOT NULL CHECK (verdict IN ('holds', 'not found', 'never')),  -- whether a change was found under which it holds
    variant   TEXT NOT NULL,           -- that holds there
    operators TEXT NOT NULL,           -- of that point
    settings  TEXT NOT NULL,           -- of the smallest change that was found, or of the point nearest to holding
    distance  REAL,                    -- each other choice counted as a factor of 2
    value     REAL,                    -- that the test finds there
    margin    REAL,                    -- from holding (< 0) or from failing (> 0)
    points    INTEGER NOT NULL,        -- that were tried for the subject
    confirmed INTEGER,                 -- 1: the study's own runs at that point say so, too; NULL: nothing to confirm
    study     INTEGER,                 -- how many they are
    sentence  TEXT NOT NULL,           -- the answer in words
    PRIMARY KEY (subject, goal)
) STRICT, WITHOUT ROWID;

-- What the ranks of a person's own program wrote, in the order in which they wrote it; of very much the beginning.
CREATE TABLE IF NOT EXISTS program_line (
    run_id INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    line   INTEGER NOT NULL,           -- order of the lines, from 0
    rank   INTEGER NOT NULL,           -- who wrote it
    stream INTEGER NOT NULL,           -- 1: standard output, 2: standard error
    text   TEXT NOT NULL,              -- without its end
    PRIMARY KEY (run_id, line)
) STRICT, WITHOUT ROWID;

-- What limits a run (mimdsim why): its critical path by stage and cause; the times add up to the run's.
CREATE TABLE IF NOT EXISTS critical_path (
    run_id  INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    stage   TEXT NOT NULL,             -- name of the stage
    cause   TEXT NOT NULL,             -- computing, send overhead, hop latency, ...
    time_ps INTEGER NOT NULL,          -- of the path
    steps   INTEGER NOT NULL,          -- of the path
    PRIMARY KEY (run_id, stage, cause)
) STRICT, WITHOUT ROWID;
-- What each parameter of the machine contributes to the critical path.
CREATE TABLE IF NOT EXISTS sensitivity (
    run_id           INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    key              TEXT NOT NULL,    -- full name of the setting
    rate             INTEGER NOT NULL CHECK (rate IN (0, 1)),  -- 1: larger is faster
    time_ps          INTEGER NOT NULL, -- of the path that is proportional to it, or to its inverse
    count            REAL,             -- how often the path pays it; NULL: by segments of message size
    factor_5_percent REAL,             -- on the time behind it, with which the run takes 5 % longer; NULL: not known
    same_path        INTEGER CHECK (same_path IN (0, 1)),  -- 1: up to there no other path takes over
    PRIMARY KEY (run_id, key)
) STRICT, WITHOUT ROWID;
-- The same run on idealised machines.
CREATE TABLE IF NOT EXISTS ideal (
    run_id      INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    machine     TEXT NOT NULL,         -- zero latency, infinite bandwidth, ...
    what        TEXT NOT NULL,         -- which settings that is
    makespan_ps INTEGER,               -- NULL: it cannot be run
    PRIMARY KEY (run_id, machine)
) STRICT, WITHOUT ROWID;
-- How far a parameter may move until another path takes over.
CREATE TABLE IF NOT EXISTS path_range (
    run_id INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    key    TEXT NOT NULL,              -- full name of the setting
    factor REAL NOT NULL,              -- on the time behind it, at which the critical path becomes another one
    PRIMARY KEY (run_id, key)
) STRICT, WITHOUT ROWID;
-- Links and ports that messages of the critical path pass or wait for; levels without links have the ports alone.
CREATE TABLE IF NOT EXISTS path_resource (
    run_id  INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    link    INTEGER NOT NULL,          -- number as in view link_load
    name    TEXT NOT NULL,             -- between which routers, or whose port
    time_ps INTEGER NOT NULL,          -- of the path
    PRIMARY KEY (run_id, link)
) STRICT, WITHOUT ROWID;
-- How much later everything may be without lengthening the run: all steps of all ranks and messages.
CREATE TABLE IF NOT EXISTS slack (
    run_id      INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    stage       TEXT NOT NULL,         -- name of the stage
    cause       TEXT NOT NULL,         -- as in table critical_path
    steps       INTEGER NOT NULL,      -- how many
    time_ps     INTEGER NOT NULL,      -- together
    critical_ps INTEGER NOT NULL,      -- of that without slack
    near_ps     INTEGER NOT NULL,      -- with a slack of at most 5 % of the run, the former too
    least_ps    INTEGER,               -- least slack above 0; NULL: there is none
    PRIMARY KEY (run_id, stage, cause)
) STRICT, WITHOUT ROWID;
-- The slack of each rank: the least of what it computes, sends and receives.
CREATE TABLE IF NOT EXISTS rank_slack (
    run_id   INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    rank     INTEGER NOT NULL,         -- number of the rank, from 0
    stage    TEXT NOT NULL,            -- where it has that
    slack_ps INTEGER NOT NULL,         -- 0: it is on a critical path
    PRIMARY KEY (run_id, rank)
) STRICT, WITHOUT ROWID;
-- Computing against communication by stage: rates of one processor in the mean over all, and the roofs above them.
CREATE TABLE IF NOT EXISTS roofline (
    run_id     INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    ordinal    INTEGER NOT NULL,       -- 0 is the whole run, the stages follow
    stage      TEXT NOT NULL,          -- name of the stage, or 'whole run'
    flops      REAL NOT NULL,          -- additions, subtractions and multiplications, all ranks
    messages   REAL NOT NULL,          -- sent, all ranks
    sent_bytes REAL NOT NULL,          -- all ranks
    attained   REAL NOT NULL,          -- flop/s with all waiting
    computing  REAL,                   -- flop/s while it computes; NULL: that takes no time, so in the next two
    bandwidth  REAL,                   -- flop/s if its port sent all the time
    software   REAL,                   -- flop/s if it handled messages all the time
    lowest     TEXT NOT NULL,          -- of the three: computing, bandwidth, message software
    PRIMARY KEY (run_id, ordinal)
) STRICT, WITHOUT ROWID;

-- A run with the uncertain parameters of its machine drawn anew (mimdsim run --uncertainty N).
CREATE TABLE IF NOT EXISTS uncertainty_sample (
    run_id      INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    sample      INTEGER NOT NULL,      -- number of the point in the design
    design      TEXT NOT NULL,         -- digest of the parameters, their ranges and the number of points
    makespan_ps INTEGER,               -- NULL: with these values it cannot be run
    serial_ps   INTEGER,               -- of the fastest serial code; NULL: there is none
    PRIMARY KEY (run_id, sample)
) STRICT, WITHOUT ROWID;
-- What the uncertain parameters of the machine leave open of a run.
CREATE TABLE IF NOT EXISTS uncertainty (
    run_id    INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    quantity  TEXT NOT NULL,           -- makespan_ps or speedup
    nominal   REAL,                    -- of the run itself
    samples   INTEGER NOT NULL,        -- that the band comes from
    failed    INTEGER NOT NULL,        -- that could not be run
    mean      REAL,                    -- of the samples
    deviation REAL,                    -- standard deviation of the samples
    low       REAL,                    -- 5 % of the samples lie below
    median    REAL,                    -- of the samples
    high      REAL,                    -- 5 % of the samples lie above
    PRIMARY KEY (run_id, quantity)
) STRICT, WITHOUT ROWID;
-- Which parameter the variance of a run comes from: Sobol' indices with their standard errors.
CREATE TABLE IF NOT EXISTS uncertainty_share (
    run_id      INTEGER NOT NULL REFERENCES run (id) ON DELETE CASCADE,  -- the run
    quantity    TEXT NOT NULL,         -- makespan_ps or speedup
    key         TEXT NOT NULL,         -- full name of the parameter
    low         REAL NOT NULL,         -- it was drawn between this
    high        REAL NOT NULL,         -- and this, in SI units
    class       TEXT NOT NULL,         -- of the evidence for it
    printed     INTEGER NOT NULL CHECK (printed IN (0, 1)),  -- 1: the machine file gives the range, 0: the class does
    first       REAL,                  -- share of the variance that it explains alone; NULL: not asked for
    first_error REAL,                  -- standard error
    total       REAL,                  -- with its interactions
    total_error REAL,                  -- standard error
    PRIMARY KEY (run_id, quantity, key)
) STRICT, WITHOUT ROWID;
-- What a search found (`optimise:` of a scenario): the best run for each point of the other axes.
CREATE TABLE IF NOT EXISTS optimum (
    scenario   TEXT NOT NULL,          -- that was searched
    ordinal    INTEGER NOT NULL,       -- order of the points of the other axes
    goal       TEXT NOT NULL,          -- least or greatest, and the formula
    within     TEXT,                   -- the condition that it has to keep; NULL: none
    run_id     INTEGER REFERENCES run (id) ON DELETE CASCADE,  -- the best run; NULL: none could be run
    value      REAL,                   -- of the goal, in SI units
    value_text TEXT,                   -- for people, with its unit
    holds      INTEGER NOT NULL CHECK (holds IN (0, 1)),  -- 0: no run keeps the condition; this one misses it least
    tried      INTEGER NOT NULL,       -- runs that were looked at
    PRIMARY KEY (scenario, ordinal)
) STRICT, WITHOUT ROWID;
-- Of each run the digest that it shares with runs alike but for their size: the errors of levels are known by it.
CREATE TABLE IF NOT EXISTS run_family (
    run_id INTEGER PRIMARY KEY REFERENCES run (id) ON DELETE CASCADE,  -- the run
    family TEXT NOT NULL               -- as in table ladder
) STRICT;

-- A network under one traffic (mimdsim load): what is known of it before it is loaded, and where it saturates.
CREATE TABLE IF NOT EXISTS load_series (
@load_series@
    PRIMARY KEY (series)
) STRICT, WITHOUT ROWID;
-- What becomes of each offered load.
CREATE TABLE IF NOT EXISTS load_point (
    series TEXT NOT NULL,              -- as in table load_series
@load_point@
    CHECK (probe IN (0, 1)),
    PRIMARY KEY (series, offered, probe)
) STRICT, WITHOUT ROWID;

-- How far the predicted time of a run is known. NULL: not known.
--   run_id: the run
--   level_error: of the network level, relative to the most detailed one: the largest of the ladder of such runs
--   level_at: the point of that error
--   machine_low: of the machine's parameters: the time that 5 % of the samples lie below, relative to the run's, less 1
--   machine_high: the time that 5 % of the samples lie above, likewise
--   machine_samples: of the band
--   arithmetic_error: of the numbers that the program computed, relative to independent references
CREATE VIEW IF NOT EXISTS v_known_error AS
SELECT r.id AS run_id, r.scenario, r.machine, r.level, r.kernel, r.n, r.P,
       (SELECT max(l.relative_error) FROM ladder l JOIN run_family f ON f.family = l.family
        WHERE f.run_id = r.id AND l.ladder = 'network' AND l.quantity = 'makespan' AND l.method = r.level) AS level_error,
       (SELECT l.at FROM ladder l JOIN run_family f ON f.family = l.family
        WHERE f.run_id = r.id AND l.ladder = 'network' AND l.quantity = 'makespan' AND l.method = r.level
        ORDER BY l.relative_error DESC LIMIT 1) AS level_at,
       u.low / u.nominal - 1 AS machine_low, u.high / u.nominal - 1 AS machine_high, u.samples AS machine_samples,
       (SELECT max(e.relative_error) FROM error_check e WHERE e.run_id = r.id) AS arithmetic_error
FROM run r LEFT JOIN uncertainty u ON u.run_id = r.id AND u.quantity = 'makespan_ps'
WHERE r.status IN ('ok', 'invalid');

-- audit.sql - the rules of `mimdsim check DB` (audit.h). Each query gives the rows that contradict others: the id of the run
-- or NULL, and what is wrong, as text; or in a third column a query that gives such rows. A
-- rule begins with its name; the file is compiled in by audit_sql.sed.

-- rule: integrity
SELECT NULL, integrity_check
FROM pragma_integrity_check(20)
WHERE integrity_check <> 'ok';

-- Rows of tables without row numbers are told by their primary key, which the pragma does not give: the third column is a
-- query that does.
-- rule: foreign keys
SELECT NULL, 'table ' || "table" || ', row ' || rowid ||
    ' belongs to no row of table ' || parent, NULL
FROM pragma_foreign_key_check
WHERE rowid IS NOT NULL
UNION ALL
SELECT NULL, NULL, format('SELECT NULL, ''table %w, row '' || %s || '' belongs to no row of table %w''
    FROM "%w" AS c WHERE %s AND NOT EXISTS (SELECT 1 FROM "%w" AS p WHERE %s)',
    k."table", (SELECT group_concat(format('''%w '' || quote(c."%w")', name, name), ' || '', '' || ')
        FROM (SELECT name FROM pragma_table_info(k."table") WHERE pk > 0 ORDER BY pk)),
    parent, k."table", (SELECT group_concat(format('c."%w" IS NOT NULL', "from"), ' AND ')
        FROM pragma_foreign_key_list(k."table") WHERE id = fkid),
    parent, (SELECT group_concat(format('p."%w" = c."%w"', "to", "from"), ' AND ')
        FROM pragma_foreign_key_list(k."table") WHERE id = fkid))
FROM (SELECT DISTINCT "table", parent, fkid FROM pragma_foreign_key_check WHERE rowid IS NULL) AS k;

-- What a column of table run repeats of the configuration. Older configurations have
-- the question in place of the level that a tolerance chose.
-- rule: columns
SELECT id, c || ' is ' || v || '; the configuration has another ' || k FROM (
    SELECT id, 'scenario' AS c, 'scenario' AS k, scenario AS v, config_text FROM run UNION ALL
    SELECT id, 'seed' AS c, 'seed' AS k, seed AS v, config_text FROM run UNION ALL
    SELECT id, 'P' AS c, 'ranks' AS k, P AS v, config_text FROM run UNION ALL
    SELECT id, 'machine' AS c, 'machine.name' AS k, machine AS v, config_text FROM run UNION ALL
    SELECT id, 'topology' AS c, 'machine.topology.family' AS k, topology AS v, config_text FROM run UNION ALL
    SELECT id, 'placement' AS c, 'machine.placement.kind' AS k, placement AS v, config_text FROM run UNION ALL
    SELECT id, 'kernel' AS c, 'kernel.name' AS k, kernel AS v, config_text FROM run UNION ALL
    SELECT id, 'formulation' AS c, 'kernel.formulation' AS k, formulation AS v, config_text FROM run UNION ALL
    SELECT id, 'solver' AS c, 'kernel.solver' AS k, solver AS v, config_text FROM run UNION ALL
    SELECT id, 'part_solver' AS c, 'kernel.part_solver' AS k, part_solver AS v, config_text FROM run UNION ALL
    SELECT id, 'operators' AS c, 'kernel.operators' AS k, operators AS v, config_text FROM run UNION ALL
    SELECT id, 'precision' AS c, 'kernel.precision' AS k, precision AS v, config_text FROM run UNION ALL
    SELECT id, 'model' AS c, 'model.generator' AS k, model AS v, config_text FROM run UNION ALL
    SELECT id, 'base' AS c, 'model.base' AS k, base AS v, config_text FROM run UNION ALL
    SELECT id, 'joint' AS c, 'model.joint' AS k, joint AS v, config_text FROM run UNION ALL
    SELECT id, 'level', 'machine.network.level', level, config_text FROM run WHERE level_asked IS NULL
        OR instr(config_text, 'machine.network.level = auto-tolerance') = 0 UNION ALL
    SELECT id, 'n', 'model.n', n, config_text FROM run
    WHERE model = 'serial-chain' AND kernel IN (SELECT kernel FROM run WHERE nu > 0))
WHERE instr(char(10) || config_text, char(10) || k || ' = ' || v || char(10)) = 0;

-- rule: noise
SELECT r.id, s.key || ' is ' || s.value || ', the run says ' || coalesce(iif(s.key =
    'machine.noise.compute', compute_noise_cv, background_load), 'nothing')
FROM run r
JOIN run_setting x ON x.run_id = r.id
JOIN setting s ON s.id = x.setting_id
WHERE s.key IN ('machine.noise.compute', 'machine.noise.background.load') AND
    coalesce(abs(CAST(s.value AS REAL) / 100 - iif(s.key = 'machine.noise.compute',
    compute_noise_cv, background_load)), 1) > 1e-9;

-- rule: settings
SELECT r.id, 'setting ' || s.key || ' = ' || s.value || ' is not in the configuration'
FROM run r
JOIN run_setting x ON x.run_id = r.id
JOIN setting s ON s.id = x.setting_id
WHERE instr(char(10) || config_text, char(10) || s.key || ' = ' || s.value || char(10)) = 0
UNION ALL
SELECT id, 'the configuration has ' || lines || ' settings, table run_setting ' || rows
FROM (SELECT r.id, length(config_text) - length(replace(config_text, char(10), '')) AS lines,
    (SELECT count(*) FROM run_setting x WHERE x.run_id = r.id) AS rows FROM run r)
WHERE lines <> rows;

-- A campaign stores repetitions in order, so an interrupted one lacks the last ones only.
-- rule: repetitions
SELECT min(id), 'of the repetitions 0 to ' || max(rep) || ' of this configuration ' || count(*) ||
    ' are stored'
FROM run
GROUP BY config_hash, seed
HAVING max(rep) + 1 <> count(*);

-- How it ended.
-- rule: status
SELECT id, 'status ' || status || ' with the text ''' || substr(text, 1, 80) || ''''
FROM run
WHERE (status = 'ok') <> (text = '')
UNION ALL
SELECT r.id, 'status ok, but ' || e.quantity || ' against ' || e.reference || ' has not passed'
FROM run r
JOIN error_check e ON e.run_id = r.id
WHERE r.status = 'ok' AND NOT e.passed
UNION ALL
SELECT id, 'status ok without any stage'
FROM run
WHERE status = 'ok' AND id NOT IN (SELECT run_id FROM stage);

-- A NaN has not passed.
-- rule: passed
SELECT run_id, quantity || ' against ' || reference || ': error ' || coalesce(relative_error,
    'not finite') || ', tolerance ' || coalesce(tolerance, 'none') || ', passed ' || passed
FROM error_check
WHERE passed <> coalesce(relative_error <= tolerance, 0) OR relative_error < 0 OR tolerance < 0;

-- Over all ranks and stages the parts add up to P times the makespan, to the picosecond.
-- rule: accounting
SELECT r.id, 'all stages take ' || sum(s.total_sum_ps) || ' ps, ' || r.P ||
    ' ranks with this makespan ' || (r.P * r.makespan_ps)
FROM run r
JOIN stage s ON s.run_id = r.id
WHERE r.accounting_error_ps = 0
GROUP BY r.id
HAVING count(s.total_sum_ps) = count(*) AND abs(sum(s.total_sum_ps) - r.P *
    r.makespan_ps) > iif(typeof(sum(s.total_sum_ps)) = 'real', 1e-12 * r.P * r.makespan_ps, 0)
UNION ALL
SELECT id, 'accounting_error_ps is ' || accounting_error_ps
FROM run
WHERE status IN ('ok', 'invalid') AND accounting_error_ps <> 0
UNION ALL
SELECT id, 'times or counts below 0'
FROM run
WHERE min(makespan_ps, messages, sent_bytes, events, ties, switches, accounting_error_ps, links,
    P, rep) < 0 OR ties > events;

-- rule: ends
SELECT id, 'the last rank ends at ' || coalesce(finish_max_ps, 'no time') || ', the first at ' ||
    coalesce(finish_min_ps, 'no time') || ', the makespan is ' || makespan_ps
FROM run
WHERE status IN ('ok', 'invalid') AND (finish_max_ps IS NOT makespan_ps OR finish_min_ps IS NULL
    OR finish_min_ps > finish_max_ps OR finish_min_ps < 0)
UNION ALL
SELECT id, 'measured_s is longer than the run'
FROM run
WHERE measured_s < 0 OR (status = 'ok' AND measured_s > makespan_ps * 1.000001e-12);

-- Sum, least and most of a part agree; the parts' sums are the total's; the stages' messages are the run's.
-- rule: stages
SELECT run_id, 'stage ' || stage || ': its parts take ' || (compute_sum_ps + send_sum_ps +
    recv_sum_ps + wait_sum_ps + contention_sum_ps) || ' ps, its total is ' || total_sum_ps
FROM stage
WHERE compute_sum_ps + send_sum_ps + recv_sum_ps + wait_sum_ps + contention_sum_ps <>
    total_sum_ps
UNION ALL
SELECT run_id, 'stage ' || stage || ': sum, least and most of a part contradict each other'
FROM stage s
JOIN run r ON r.id = s.run_id
WHERE compute_min_ps > compute_max_ps OR compute_min_ps < 0 OR compute_sum_ps < r.P *
    compute_min_ps OR compute_sum_ps > r.P * compute_max_ps OR (r.P = 1 AND compute_sum_ps <>
    compute_max_ps) OR send_min_ps > send_max_ps OR send_min_ps < 0 OR send_sum_ps < r.P *
    send_min_ps OR send_sum_ps > r.P * send_max_ps OR (r.P = 1 AND send_sum_ps <> send_max_ps)
    OR recv_min_ps > recv_max_ps OR recv_min_ps < 0 OR recv_sum_ps < r.P * recv_min_ps OR
    recv_sum_ps > r.P * recv_max_ps OR (r.P = 1 AND recv_sum_ps <> recv_max_ps) OR wait_min_ps >
    wait_max_ps OR wait_min_ps < 0 OR wait_sum_ps < r.P * wait_min_ps OR wait_sum_ps > r.P *
    wait_max_ps OR (r.P = 1 AND wait_sum_ps <> wait_max_ps) OR contention_min_ps >
    contention_max_ps OR contention_min_ps < 0 OR contention_sum_ps < r.P * contention_min_ps OR
    contention_sum_ps > r.P * contention_max_ps OR (r.P = 1 AND contention_sum_ps <>
    contention_max_ps) OR total_min_ps > total_max_ps OR total_min_ps < 0 OR total_sum_ps < r.P
    * total_min_ps OR total_sum_ps > r.P * total_max_ps OR (r.P = 1 AND total_sum_ps <>
    total_max_ps)
UNION ALL
SELECT r.id, 'stages sent ' || sum(s.messages) || ' messages of ' || sum(s.sent_bytes) ||
    ' B, the run ' || r.messages || ' of ' || r.sent_bytes
FROM run r
JOIN stage s ON s.run_id = r.id
WHERE r.status IN ('ok', 'invalid')
GROUP BY r.id
HAVING sum(s.messages) <> r.messages OR sum(s.sent_bytes) <> r.sent_bytes;

-- Rows of single ranks, which runs of few ranks have: each rank takes the whole run.
-- rule: ranks
SELECT r.id, 'rank ' || k.rank || ' takes ' || k.t || ' ps, the run ' || r.makespan_ps
FROM run r
JOIN (SELECT run_id, rank, sum(compute_ps + send_ps + recv_ps + wait_ps + contention_ps) AS t
    FROM rank_stage GROUP BY run_id, rank) k ON k.run_id = r.id
WHERE abs(k.t - r.makespan_ps) > r.accounting_error_ps
UNION ALL
SELECT r.id, n || ' of ' || P || ' ranks have rows'
FROM (SELECT r.id, P, (SELECT count(DISTINCT rank) FROM rank_stage k WHERE k.run_id = r.id AND
    rank >= 0 AND rank < P) AS n, (SELECT count(DISTINCT rank) FROM rank_stage k WHERE k.run_id
    = r.id) AS m FROM run r WHERE status IN ('ok', 'invalid') AND makespan_ps > 0 AND P <=
    (SELECT CAST(value AS INTEGER) FROM meta WHERE key = 'rank_rows_limit') AND EXISTS (SELECT 1
    FROM run_setting x WHERE x.run_id = r.id)) r
WHERE n <> P OR m <> P
UNION ALL
SELECT r.id, 'computing of the least and the most loaded rank is ' || lo || ' and ' || hi || ' ps'
FROM run r
JOIN (SELECT run_id, min(c) AS lo, max(c) AS hi FROM (SELECT run_id, sum(compute_ps) AS c FROM
    rank_stage GROUP BY run_id, rank) GROUP BY run_id) k ON k.run_id = r.id
WHERE status IN ('ok', 'invalid') AND (rank_compute_min_ps IS NOT lo OR rank_compute_max_ps IS
    NOT hi);

-- A rank that did nothing in a stage has no row: its time is 0.
-- rule: rank sums
SELECT s.run_id, 'stage ' || s.stage || ' is not what its ranks add up to'
FROM stage s
JOIN run r ON r.id = s.run_id AND r.P <= (SELECT CAST(value AS INTEGER) FROM meta WHERE key =
    'rank_rows_limit')
LEFT JOIN rank_stage k ON k.run_id = s.run_id AND k.stage = s.stage
WHERE EXISTS (SELECT 1 FROM rank_stage q WHERE q.run_id = s.run_id)
GROUP BY s.run_id, s.stage
HAVING iif(typeof(sum(k.compute_ps)) = 'real', NULL, coalesce(sum(k.compute_ps), 0)) IS NOT s.compute_sum_ps OR iif(count(k.rank) < r.P, 0,
    min(k.compute_ps)) IS NOT s.compute_min_ps OR coalesce(max(k.compute_ps), 0) IS NOT
    s.compute_max_ps OR iif(typeof(sum(k.send_ps)) = 'real', NULL, coalesce(sum(k.send_ps), 0)) IS NOT s.send_sum_ps OR iif(count(k.rank) <
    r.P, 0, min(k.send_ps)) IS NOT s.send_min_ps OR coalesce(max(k.send_ps), 0) IS NOT
    s.send_max_ps OR iif(typeof(sum(k.recv_ps)) = 'real', NULL, coalesce(sum(k.recv_ps), 0)) IS NOT s.recv_sum_ps OR iif(count(k.rank) <
    r.P, 0, min(k.recv_ps)) IS NOT s.recv_min_ps OR coalesce(max(k.recv_ps), 0) IS NOT
    s.recv_max_ps OR iif(typeof(sum(k.wait_ps)) = 'real', NULL, coalesce(sum(k.wait_ps), 0)) IS NOT s.wait_sum_ps OR iif(count(k.rank) <
    r.P, 0, min(k.wait_ps)) IS NOT s.wait_min_ps OR coalesce(max(k.wait_ps), 0) IS NOT
    s.wait_max_ps OR iif(typeof(sum(k.contention_ps)) = 'real', NULL, coalesce(sum(k.contention_ps), 0)) IS NOT s.contention_sum_ps OR
    iif(count(k.rank) < r.P, 0, min(k.contention_ps)) IS NOT s.contention_min_ps OR
    coalesce(max(k.contention_ps), 0) IS NOT s.contention_max_ps OR coalesce(sum(k.messages), 0)
    <> s.messages OR coalesce(sum(k.sent_bytes), 0) <> s.sent_bytes OR coalesce(sum(k.flops), 0)
    <> s.flops;

-- rule: rank stages
SELECT k.run_id, 'rank ' || rank || ' has a row of stage ' || k.stage || ', which the run has not'
FROM rank_stage k
LEFT JOIN stage s ON s.run_id = k.run_id AND s.stage = k.stage
WHERE s.stage IS NULL;

-- Rows that are numbered from 0: one that is missing leaves a gap, but for the last.
-- rule: numbers
SELECT run_id, 'of ' || what || ' 0 to ' || last || ' there are ' || n
FROM (
    SELECT 'stages' AS what, run_id, min(stage) AS first, max(stage) AS last, count(*) AS n
    FROM stage GROUP BY run_id
    UNION ALL
    SELECT 'serial codes', run_id, min(ordinal), max(ordinal), count(*) FROM baseline GROUP BY run_id
    UNION ALL
    SELECT 'checks', run_id, min(ordinal), max(ordinal), count(*) FROM error_check GROUP BY run_id
    UNION ALL
    SELECT 'spans', run_id, min(span), max(span), count(*) FROM span GROUP BY run_id)
WHERE last + 1 <> n OR first <> 0
UNION ALL
SELECT id, links || ' links were recorded, ' || n || ' are stored, up to number ' || last
FROM (SELECT r.id, links, count(l.link) AS n, coalesce(max(l.link), -1) AS last, min(links,
    (SELECT CAST(value AS INTEGER) FROM meta WHERE key = 'link_rows_limit')) AS kept FROM run r
    LEFT JOIN link_load l ON l.run_id = r.id GROUP BY r.id)
WHERE n <> kept OR (n = links AND last + 1 <> n);

-- rule: serial codes
SELECT f.run_id, '''fastest serial'' takes ' || f.time_ps ||
    ' ps, which is not the fastest of the serial codes'
FROM baseline f
WHERE f.name = 'fastest serial' AND (NOT EXISTS (SELECT 1 FROM baseline b WHERE b.run_id =
    f.run_id AND b.ordinal < f.ordinal AND b.time_ps = f.time_ps) OR EXISTS (SELECT 1 FROM
    baseline b WHERE b.run_id = f.run_id AND b.name LIKE '%+%' AND b.time_ps < f.time_ps))
UNION ALL
SELECT r.id, 'forward and inverse dynamics without any serial code'
FROM run r
WHERE status = 'ok' AND nu > 0 AND NOT EXISTS (SELECT 1 FROM baseline b WHERE b.run_id = r.id)
UNION ALL
SELECT r.id, 'a result that nothing was checked against'
FROM run r
WHERE status = 'ok' AND nu > 0 AND NOT EXISTS (SELECT 1 FROM error_check e WHERE e.run_id =
    r.id);

-- What enters a router leaves it. loggp knows injections only; of very many links only the busiest are stored;
-- protocols add messages, but no bytes of the ranks.
-- rule: links
WITH whole AS (SELECT id FROM run WHERE level <> 'loggp' AND status IN ('ok', 'invalid') AND links
    > 0 AND links <= (SELECT CAST(value AS INTEGER) FROM meta WHERE key = 'link_rows_limit')),
    flow AS (SELECT run_id, to_router AS router, messages AS m, sent_bytes AS b FROM link_load
    WHERE to_router IS NOT NULL
UNION ALL
SELECT run_id, from_router, -messages, -sent_bytes
FROM link_load
WHERE from_router IS NOT NULL) SELECT run_id, 'router ' || router || ' gets ' || sum(m) ||
    ' messages of ' || sum(b) || ' B more than leave it' FROM flow WHERE run_id IN (SELECT id
FROM whole) GROUP BY run_id, router HAVING sum(m) <> 0 OR sum(b) <> 0
UNION ALL
SELECT run_id, 'link ' || link || ': a time or count below 0, or busy for longer than the run'
FROM link_load l
JOIN run r ON r.id = l.run_id
WHERE min(l.messages, l.sent_bytes, busy_ps, queue_ps) < 0 OR (l.from_router IS NULL) +
    (l.to_router IS NULL) > 1 OR (l.node IS NULL) <> (l.from_router IS NOT NULL AND l.to_router
    IS NOT NULL)
UNION ALL
SELECT r.id, 'nodes put ' || sum(l.sent_bytes) || ' B on the wire, the ranks sent ' ||
    r.sent_bytes
FROM run r
JOIN link_load l ON l.run_id = r.id AND l.from_router IS NULL
WHERE r.background_load = 0 AND r.status = 'ok'
GROUP BY r.id
HAVING sum(l.sent_bytes) > r.sent_bytes;

-- rule: spans
SELECT run_id, 'span ' || span || ' ends before it begins, or outside of the run'
FROM span p
JOIN run r ON r.id = p.run_id
WHERE begin_ps < 0 OR end_ps < begin_ps OR end_ps > makespan_ps OR rank < 0 OR rank >= P OR
    bytes < 0 OR peer >= P
UNION ALL
SELECT k.run_id, 'rank ' || k.rank || ', stage ' || k.stage || ': its spans are not its times'
FROM (SELECT run_id, rank, stage, sum(iif(kind = 'compute', end_ps - begin_ps, 0)) AS c,
    sum(iif(kind = 'send', end_ps - begin_ps, 0)) AS s, sum(iif(kind = 'recv', end_ps -
    begin_ps, 0)) AS v FROM span GROUP BY run_id, rank, stage) p
JOIN rank_stage k ON k.run_id = p.run_id AND k.rank = p.rank AND k.stage = p.stage
WHERE p.c <> k.compute_ps OR p.s <> k.send_ps OR p.v <> k.recv_ps;

-- rule: omissions
SELECT id, 'left_out does not tell what table run_omission holds'
FROM (SELECT r.id, left_out, coalesce(sum(length(o.what) + length(o.why) + 2), 0) + 2 *
    max(count(o.what) - 1, 0) AS n, coalesce(min(instr('; ' || left_out || '; ', '; ' || o.what
    || ': ' || o.why || '; ')), 1) AS found FROM run r LEFT JOIN run_omission o ON o.run_id =
    r.id GROUP BY r.id)
WHERE n <> length(left_out) OR found = 0
UNION ALL
SELECT run_id, what || ': ' || class || ' with the bound ' || coalesce(bound, 'none')
FROM run_omission
WHERE (class = 'bounded') <> (bound IS NOT NULL) OR bound <= 0
UNION ALL
SELECT NULL, scenario || ', ' || what || ': ' || class || ' with the bound ' || coalesce(bound,
    'none')
FROM omission
WHERE (class = 'bounded') <> (bound IS NOT NULL) OR bound <= 0;

-- rule: refinements
SELECT id, 'refinements without the residual before them, or the other way round'
FROM run
WHERE (inner_added + outer_added + twice_added = 0) <> (residual_before IS NULL) AND status IN
    ('ok', 'invalid') OR min(inner_added, outer_added, twice_added) < 0 OR twice_added > 1 OR
    residual < 0 OR loop_rank > loop_rows OR (loop_rows IS NULL AND coalesce(loop_rank,
    drift_position, drift_velocity) IS NOT NULL)
UNION ALL
SELECT id, 'part of a choice of the level is missing'
FROM run
WHERE (level_asked IS NULL) <> (level_error IS NULL) OR (level_asked IS NULL) <> (level_error_at
    IS NULL)
UNION ALL
SELECT id, 'the digest ''' || digest || ''' is no 16 hexadecimal digits'
FROM run
WHERE length(digest) <> 16 OR digest GLOB '*[^0-9a-f]*';

-- rule: machines
SELECT r.id, 'no shipped machine is noted, as with other runs on ' || machine
FROM run r
WHERE machine_hash IS NULL AND EXISTS (SELECT 1 FROM run q WHERE q.machine = r.machine AND
    q.machine_hash IS NOT NULL)
UNION ALL
SELECT id, 'machine_changes and machine_hash: one is missing, or no JSON object, or no hash'
FROM run
WHERE (machine_changes IS NULL) <> (machine_hash IS NULL) OR (machine_changes IS NOT NULL AND
    (NOT json_valid(machine_changes) OR length(machine_hash) <> 64 OR machine_hash GLOB
    '*[^0-9a-f]*'));

-- rule: check points
SELECT NULL, suite || ', ' || subject || ', ' || quantity || ' ' || at || ': ' || coalesce(value,
    'nothing') || ' beside ' || coalesce(reference, 'nothing') || ', relative error ' ||
    coalesce(relative_error, 'none') || ', tolerance ' || coalesce(tolerance, 'none') ||
    ', verdict ' || verdict
FROM check_point
WHERE (value IS NULL) <> (relative_error IS NULL) OR reference IS NULL OR tolerance IS NULL OR
    abs(relative_error - (value - reference) / reference) > 1e-15 * (1 + abs(relative_error)) OR
    (verdict = 'fail' AND cause = '' AND coalesce(abs(relative_error) <= tolerance, 1)) OR
    (verdict = 'explained' AND coalesce(abs(relative_error) <= tolerance, 1)) OR
    (verdict IN ('explained', 'not-testable') AND cause = '' AND value IS NOT NULL) OR
    (verdict = 'pass' AND relative_error IS NULL);

-- The summary row of a claim counts its variants; a chosen rung is one of its ladder.
-- rule: verdicts
SELECT NULL, 'claim ' || id || ': of its variants ' || n || ' can be judged and ' || h ||
    ' hold, it says ' || coalesce(testable, 'nothing') || ' and ' || coalesce(holding, 'nothing')
FROM (SELECT c.id, c.testable, c.holding, count(v.id) AS n, coalesce(sum(v.verdict = 'pass'), 0)
    AS h FROM claim c LEFT JOIN claim v ON v.id = c.id AND v.variant <> '' AND v.verdict <>
    'not-testable' WHERE c.variant = '' AND c.testable IS NOT NULL GROUP BY c.id)
WHERE n IS NOT testable OR h IS NOT holding
UNION ALL
SELECT NULL, 'ladder of ' || c.scenario || ', ' || c.at || ': ' || c.method || ' ' || c.rung ||
    ' was chosen within ' || c.tolerance || ' for an error of ' || coalesce(c.relative_error,
    'nothing')
FROM ladder_choice c
WHERE c.method IS NOT NULL AND (coalesce(c.relative_error > c.tolerance, 1) OR NOT EXISTS
    (SELECT 1 FROM ladder l WHERE l.scenario = c.scenario AND l.ladder = c.ladder AND l.at =
    c.at AND l.method = c.method AND l.rung = c.rung AND l.quantity = c.quantity AND
    l.relative_error = c.relative_error));

-- Work-precision diagram of one ladder of a scenario (network, arithmetic, integration): the error of every level, method
-- or step size against the run time on this computer and against the predicted run time on the machine. Further left is
-- cheaper, further down is better. Methods that give the same bits at the same predicted cost share a curve.
-- needs: mimdsim accuracy scenarios/speedup-t3e.yaml
-- each: SELECT json_array(scenario, ladder), 'accuracy-' || scenario || '-' || ladder, 'accuracy-' || scenario FROM ladder GROUP BY scenario, ladder ORDER BY scenario, min(ladder = 'arithmetic') + 2 * min(ladder = 'integration')
WITH place AS ( -- of several points that were measured, the one that takes the machine longest
    SELECT DISTINCT ladder, first_value(at) OVER one AS at, first_value(family) OVER one AS family FROM ladder
    WHERE scenario = ?1 ->> '$[0]' AND ladder = ?1 ->> '$[1]' WINDOW one AS (PARTITION BY ladder ORDER BY ifnull(machine_ps, -1) DESC, at, family)),
rung AS (
    SELECT l.*, CASE ladder WHEN 'network' THEN 1 WHEN 'arithmetic' THEN 2 ELSE 3 END AS block,
           CASE WHEN ladder = 'network' THEN 1
                WHEN method LIKE 'paper %' THEN 2 WHEN method LIKE 'direct %' THEN 3
                WHEN method LIKE 'own %' THEN 3
                WHEN replace(method, ' fixed', '') IN ('rk1imp', 'rk2imp', 'rk4imp', 'bsimp', 'msbdf') THEN 2
                ELSE 1 END AS panel,
           CASE WHEN ladder <> 'arithmetic' THEN 0 WHEN rung LIKE 'float%' THEN 1 WHEN rung LIKE 'double%' THEN 2
                ELSE 3 END AS precision,
           CASE WHEN ladder = 'integration' THEN method LIKE '% fixed' OR method LIKE 'own %' WHEN ladder <> 'arithmetic' THEN 0
                WHEN rung LIKE '% twice' THEN 3 WHEN rung LIKE '% robust' THEN 2 WHEN rung LIKE '% inner' THEN 1
                ELSE 0 END AS refinement
    FROM ladder l JOIN place USING (ladder, at, family)
    WHERE scenario = ?1 ->> '$[0]' AND ladder = ?1 ->> '$[1]' AND quantity = CASE ladder WHEN 'network' THEN 'makespan' WHEN 'arithmetic' THEN 'qdd'
                                                   ELSE 'state' END),
method AS (
    SELECT block, panel, method, min(ordinal) AS first,
           iif(block = 2, group_concat(rung || ' ' || ifnull(relative_error, status) || ' ' || ifnull(machine_ps, ''), ';'),
               replace(method, ' fixed', '')) AS same
    FROM (SELECT * FROM rung ORDER BY ordinal) GROUP BY block, panel, method),
curve AS (
    SELECT block, panel, same, min(first) AS first, row_number() OVER (PARTITION BY block, panel ORDER BY min(first)) AS series,
           CASE WHEN block = 1 THEN same WHEN block = 3 THEN replace(same, 'own ', '')
                ELSE group_concat(substr(method, instr(method, ' ') + 1), ' = ') END AS name
    FROM (SELECT * FROM method ORDER BY first) GROUP BY block, panel, same)
SELECT r.block, r.panel, c.series, r.precision, r.refinement, c.name, r.method, r.rung, r.at, r.quantity, r.reference,
       r.relative_error, r.host_s, r.machine_ps / 1e12 AS machine_s, r.status, r.block = 3 OR m.first = c.first AS drawn,
       (SELECT f.relative_error FROM ladder f WHERE f.scenario = r.scenario AND f.at = r.at AND f.family = r.family AND f.ladder = r.ladder
               AND f.method = r.method AND f.rung = r.rung AND f.quantity = 'finish times') AS finish_error,
       EXISTS (SELECT 1 FROM ladder_choice o WHERE o.scenario = r.scenario AND o.ladder = r.ladder AND o.at = r.at
               AND o.quantity = r.quantity AND o.method = r.method AND o.rung = r.rung) AS chosen,
       ifnull((SELECT group_concat(format('%g', tolerance), ' or ') FROM ladder_choice o WHERE o.scenario = r.scenario
               AND o.ladder = r.ladder AND o.at = r.at AND o.quantity = r.quantity AND o.method IS NOT NULL), '') AS allowed,
       r.text, r.scenario
FROM rung r JOIN method m ON m.block = r.block AND m.panel = r.panel AND m.method = r.method
     JOIN curve c ON c.block = m.block AND c.panel = m.panel AND c.same = m.same
ORDER BY r.block, r.panel, c.series, drawn DESC, r.precision, r.refinement, r.ordinal;

-- table: failed
WITH place AS (
    SELECT DISTINCT ladder, first_value(at) OVER one AS at, first_value(family) OVER one AS family FROM ladder
    WHERE scenario = ?1 ->> '$[0]' AND ladder = ?1 ->> '$[1]' WINDOW one AS (PARTITION BY ladder ORDER BY ifnull(machine_ps, -1) DESC, at, family)),
failed AS (
    SELECT CASE ladder WHEN 'network' THEN 1 WHEN 'arithmetic' THEN 2 ELSE 3 END AS block, ladder, method,
           CASE WHEN ladder = 'network' THEN 1
                WHEN method LIKE 'paper %' THEN 2 WHEN method LIKE 'direct %' THEN 3
                WHEN method LIKE 'own %' THEN 3
                WHEN replace(method, ' fixed', '') IN ('rk1imp', 'rk2imp', 'rk4imp', 'bsimp', 'msbdf') THEN 2
                ELSE 1 END AS panel,
           replace(replace(rung, 'tolerance ', ''), ' steps', '') AS rung, ordinal, relative_error,
           iif(relative_error IS NULL, replace(text, ',', ' –'), 'error above 0.1') AS reason
    FROM ladder JOIN place USING (ladder, at, family)
    WHERE scenario = ?1 ->> '$[0]' AND ladder = ?1 ->> '$[1]' AND status = 'failed'
          AND quantity = CASE ladder WHEN 'network' THEN 'makespan' WHEN 'arithmetic' THEN 'qdd' ELSE 'state' END),
grouped AS (
    SELECT block, panel, min(ordinal) AS first, method || ': ' || group_concat(rung, '; ') AS which, reason
    FROM (SELECT * FROM failed ORDER BY ordinal) GROUP BY block, panel, method, reason, iif(block = 2, substr(rung, 1, 5), '')),
line AS (
    SELECT block, panel, first, 1 AS part, which || iif(reason LIKE 'error%', ' – ' || reason, '') AS text FROM grouped
    UNION ALL SELECT block, panel, first, 2, '    ' || iif(length(reason) > 55, substr(reason, 1, instr(reason || ':', ':') - 1), reason) FROM grouped WHERE reason NOT LIKE 'error%')
SELECT block, panel, row_number() OVER (PARTITION BY block, panel ORDER BY first, part) AS line, text FROM line
UNION ALL SELECT 0, 0, 0, ''
ORDER BY block, panel, line;

-- Every run of a kernel: its time (what the kernel measures of itself, where it does; else from the start to the end of the
-- last rank) against the setting that takes most values, with a curve for each combination of the others. Machines with
-- changed settings stand beside the one they come from, under their own names; six curves a panel.
-- needs: mimdsim run scenarios/speedup-t3e.yaml   (any scenario)
-- each: WITH many AS (SELECT kernel FROM run WHERE status = 'ok' GROUP BY kernel HAVING count(DISTINCT machine) > 4) SELECT DISTINCT json_array(kernel, iif(kernel IN many, '', machine)), 'runs-' || kernel || iif(kernel IN many, '', '-' || machine), 'runs-' || kernel FROM run WHERE status = 'ok' ORDER BY 2
WITH mine AS (
    SELECT r.id, l.name, r.level, r.n, r.P, ifnull(r.measured_s * 1e6, r.makespan_ps / 1e6) AS us, r.measured_s IS NOT NULL AS measured
    FROM run r JOIN v_label l ON l.run_id = r.id
    WHERE r.status = 'ok' AND r.kernel = ?1 ->> '$[0]' AND (?1 ->> '$[1]' = '' OR r.machine = ?1 ->> '$[1]')),
kept AS (
    SELECT m.id, s.key, s.value, s.number, s.unit FROM mine m JOIN v_setting s ON s.run_id = m.id
    WHERE s.key NOT LIKE 'machine.%' AND s.key NOT IN ('scenario', 'seed', 'rep') AND s.key NOT LIKE 'record.%' AND s.key <> 'program.file'),
varied AS (
    SELECT key, count(DISTINCT value) AS many, count(number) = count(*) AS numeric, max(ifnull(unit, '')) AS unit
    FROM kept GROUP BY key HAVING count(DISTINCT value) > 1),
-- ranks win unless another number takes clearly more values
axis AS (SELECT key, unit FROM varied WHERE numeric ORDER BY many * iif(key = 'ranks', 1.2, 1.0) DESC, key LIMIT 1),
x AS (
    SELECT m.*, CASE WHEN (SELECT key FROM axis) IS NULL OR (SELECT key FROM axis) = 'ranks' THEN m.P
                     ELSE (SELECT number FROM kept k WHERE k.id = m.id AND k.key = (SELECT key FROM axis)) END AS x
    FROM mine m),
facts AS (SELECT count(DISTINCT name) > 1 AS names, count(DISTINCT level) > 1 AS levels, count(DISTINCT n) > 1 AS sizes,
                 ifnull((SELECT key FROM axis), 'ranks') = 'ranks' AS by_ranks, min(n = P) AS square, ifnull((SELECT key FROM axis), '') = 'model.n' AS by_n FROM mine),
-- what differs, but for the axis; a run with as many bodies as ranks belongs to the curve n = P
named AS (
    SELECT x.*, trim(iif(f.levels, '; ' || x.level, '') || iif(f.sizes AND f.by_ranks AND NOT f.square, iif(x.n = x.P, '; n = P', '; n = ' || x.n), '') ||
           iif(f.by_n AND NOT f.square AND 'ranks' IN (SELECT key FROM varied), iif(x.n = x.P, '; n = P', '; P = ' || x.P), '') ||
           ifnull((SELECT group_concat('; ' || iif(k.number IS NULL, '', substr(k.key, instr(k.key, '.') + 1) || ' ') || k.value, '') FROM kept k
                   WHERE k.id = x.id AND k.key IN (SELECT key FROM varied) AND k.key NOT IN ('model.n', ifnull((SELECT key FROM axis), ''))
                         AND (k.key <> 'ranks' OR NOT f.by_ranks AND NOT f.by_n)), ''), '; ') AS rest
    FROM x, facts f WHERE x.x IS NOT NULL),
point AS (SELECT name, rest, x, min(us) AS us, max(us) AS most_us, count(*) AS runs, max(id) AS run_id, max(measured) AS measured
          FROM named GROUP BY name, rest, x),
curve AS (SELECT name, rest, count(*) AS points, min(run_id) AS first, count(*) OVER (PARTITION BY name) AS beside FROM point GROUP BY name, rest),
-- a machine with several curves has panels of its own; those with one share panels
grouped AS (SELECT *, iif(beside > 1 AND (SELECT names FROM facts), name, '') AS own FROM curve),
placed AS (
    SELECT *, row_number() OVER (PARTITION BY own ORDER BY points DESC, first) AS k,
           min(first) OVER (PARTITION BY own) AS oldest FROM grouped),
panels AS (SELECT *, dense_rank() OVER (ORDER BY own = '', oldest, own, (k - 1) / 6) AS panel FROM placed)
SELECT p.panel, (p.k - 1) % 6 + 1 AS series, replace(iif(p.own = '' AND ((SELECT names FROM facts) OR p.rest = ''), p.name || iif(p.rest = '', '', '; ' || p.rest), iif(p.rest = '', p.name, p.rest)), ',', '‚') AS curve,
       replace(iif(p.own = '' AND (SELECT names FROM facts), 'one curve each', iif(p.own = '', p.name, p.own)), ',', '‚') AS title,
       d.x, d.us, d.most_us, d.runs, replace(ifnull((SELECT key FROM axis), 'ranks'), 'kernel.', '') AS axis, ifnull((SELECT unit FROM axis), '') AS unit,
       (SELECT count(*) FROM panels WHERE panel > 8) AS left_out, (SELECT count(*) FROM panels) AS curves, (SELECT count(*) FROM mine) AS all_runs,
       d.measured, ?1 ->> '$[0]' AS kernel, replace(?1 ->> '$[1]', ',', '‚') AS machine, (SELECT square AND sizes FROM facts) AS square, d.run_id
FROM point d JOIN panels p ON p.name = d.name AND p.rest = d.rest
WHERE p.panel <= 8 ORDER BY p.panel, series, d.x;

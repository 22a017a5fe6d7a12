-- Speedup of a program of your own against its number of ranks, a curve for each machine and each value of its
-- parameters: over its fastest serial code, or where it declares none over itself on one processor.
-- needs: mimdsim run examples/ring-allreduce.yaml   (any scenario with `program: FILE`)
-- each: SELECT DISTINCT r.kernel, 'speedup-' || r.kernel FROM run r JOIN v_setting s ON s.run_id = r.id WHERE s.key = 'program.file' AND s.value LIKE 'sha256 %' AND r.status = 'ok' ORDER BY 1
WITH own AS (
    SELECT r.id AS run_id, l.name AS machine, r.level, r.P FROM run r JOIN v_label l ON l.run_id = r.id JOIN v_setting s ON s.run_id = r.id
    WHERE r.kernel = ?1 AND r.status = 'ok' AND s.key = 'program.file' AND s.value LIKE 'sha256 %'),
parameter AS (
    SELECT own.run_id, substr(s.key, 9) AS key, s.value FROM own JOIN v_setting s ON s.run_id = own.run_id
    WHERE s.key LIKE 'program.%' AND s.key <> 'program.file'),
-- what differs between the runs tells the curves apart
varied AS (SELECT key FROM parameter GROUP BY key HAVING count(DISTINCT value) > 1),
named AS (
    SELECT own.run_id, own.P, own.machine || ' (' || own.level || ')' ||
           ifnull((SELECT ' ' || group_concat(p.key || ' = ' || p.value, '; ') FROM parameter p
                   WHERE p.run_id = own.run_id AND p.key IN (SELECT key FROM varied)), '') AS curve FROM own),
-- of several runs of one point, such as those of an older source, the last
point AS (
    SELECT n.run_id, n.P, replace(n.curve, ',', '‚') AS curve, s.baseline, s.speedup, s.baseline_ps, s.makespan_ps,
           row_number() OVER (PARTITION BY n.curve, n.P ORDER BY n.run_id DESC, s.baseline <> 'fastest serial') AS choice
    FROM named n JOIN v_speedup s ON s.run_id = n.run_id
    WHERE s.baseline IN ('fastest serial', 'parallel code on one processor')),
size AS (SELECT curve, count(*) AS points, min(run_id) AS first FROM point WHERE choice = 1 GROUP BY curve),
place AS (SELECT curve, row_number() OVER (ORDER BY points DESC, first) AS series FROM size)
SELECT p.series, c.curve, c.P, c.speedup, c.makespan_ps, c.baseline_ps, c.baseline, ?1 AS program, c.run_id
FROM point c JOIN place p ON p.curve = c.curve
WHERE c.choice = 1 AND p.series <= 24 AND c.speedup > 0
ORDER BY p.series, c.P;

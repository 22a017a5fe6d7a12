-- How much later each rank of one run may be without lengthening it, and which parts of all ranks' time are nearly critical.
-- needs: mimdsim why speedup-t3e --set n=128
-- each: SELECT DISTINCT run_id, 'slack-' || run_id FROM rank_slack ORDER BY 1
WITH r AS (SELECT * FROM run WHERE id = CAST(?1 AS INTEGER)),
part AS (
    SELECT row_number() OVER (ORDER BY time_ps DESC, stage, cause) AS place, stage || ': ' || cause AS what, time_ps, critical_ps,
           near_ps
    FROM slack WHERE run_id = CAST(?1 AS INTEGER))
SELECT 1 AS panel, s.rank AS x, s.slack_ps / 1e6 AS y, 0 AS critical, 0 AS near, 0 AS rest, '' AS what,
       format('rank %d: %.4g µs in %s', s.rank, s.slack_ps / 1e6, replace(s.stage, ',', ' –')) AS told,
       format('Slack of %s on %s: n = %d; P = %d; level %s: %.4g µs', r.kernel,
              (SELECT replace(l.name, ',', '‚') FROM v_label l WHERE l.run_id = r.id), r.n, r.P, r.level,
              r.makespan_ps / 1e6) AS title, r.makespan_ps / 20e6 AS near_us, r.id AS run_id
FROM rank_slack s, r WHERE s.run_id = r.id
UNION ALL
SELECT 2, p.place, NULL, 100.0 * p.critical_ps / p.time_ps, 100.0 * (p.near_ps - p.critical_ps) / p.time_ps,
       100.0 * (p.time_ps - p.near_ps) / p.time_ps, replace(p.what, ',', ' –'), '', '', NULL, NULL
FROM part p WHERE p.place <= 12
ORDER BY 1, 2;

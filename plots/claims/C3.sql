-- statement: The speedup drops near the largest number of processors, because messages share routes.
-- test: with contention S(128) is below the largest S of fewer processors, without contention it is not
-- unit: S(128) / max S(P < 128)
-- designated: fastest serial, structured
-- judged: the fastest serial code, which the text names as the baseline, with structured operators, as in that code;
--   level link. Any drop counts, because the paper gives no size, but contention has to cause it.
-- points: t3e-300, dynamics, n = P = 64, 112, 128 at levels link and loggp
-- needs: mimdsim paper fig6
-- explore: sample-t3e n=64,112,128
-- Rows for a shared machine: random placement, noise, background load. There S is the mean over repetitions, and the row
-- holds if S drops, whatever the contention of its own messages; 'at 128 only': runs on fewer processors have the machine to
-- themselves. These rows do not determine the verdict, because the claim names the cause of the drop.
WITH point AS (
    SELECT v.*, v.baseline || ', ' || v.operators AS variant
    FROM v_speedup v JOIN run r ON r.id = v.run_id JOIN v_machine_state m ON m.run_id = r.id
    WHERE (m.state = 'as shipped' OR ?1 IN ('what-if', 'explored')) AND v.machine = 't3e-300' AND v.kernel = 'dynamics'
          AND v.formulation = 'paper' AND v.base = 'fixed' AND r.model = 'serial-chain' AND r.joint = 'revolute'
          AND v.solver IN ('pcr-symmetric', 'pcr') AND v.n = v.P AND v.precision = 'double' AND r.placement = 'linear'
          AND r.scenario <> 'paper-scaling' AND (?1 = 'explored' OR ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0)),
wanted(P, level) AS (VALUES (64, 'link'), (112, 'link'), (128, 'link'), (64, 'loggp'), (112, 'loggp'), (128, 'loggp')),
gap AS (
    SELECT s.variant, 'n = P = ' || group_concat(w.P || ' at level ' || w.level, ', ') AS missing
    FROM (SELECT DISTINCT variant FROM point) s CROSS JOIN wanted w
    WHERE NOT EXISTS (SELECT 1 FROM point p WHERE p.variant = s.variant AND p.P = w.P AND p.level = w.level)
    GROUP BY s.variant),
ends AS (
    SELECT variant, max(CASE WHEN level <> 'loggp' AND P = 128 THEN speedup END) AS last,
           max(CASE WHEN level <> 'loggp' AND P < 128 THEN speedup END) AS best,
           max(CASE WHEN level = 'loggp' AND P = 128 THEN speedup END) AS free_last,
           max(CASE WHEN level = 'loggp' AND P < 128 THEN speedup END) AS free_best
    FROM point GROUP BY variant),
sharing(changes, variant) AS (VALUES
    ('{"placement.kind": "random"}', 'scattered placement'), ('{"noise.compute": "20 %"}', 'computing noise 20 %'),
    ('{"noise.background.load": "30 %", "noise.background.message": "4 KiB"}', 'background load 30 %'),
    ('{"noise.background.load": "60 %", "noise.background.message": "4 KiB"}', 'background load 60 %')),
shared AS (
    SELECT v.P, h.variant, avg(v.speedup) AS speedup
    FROM v_speedup v JOIN run r ON r.id = v.run_id JOIN v_machine_state m ON m.run_id = r.id AND m.state = 'changed'
         JOIN sharing h ON h.changes = m.machine_changes
    WHERE v.machine = 't3e-300' AND v.kernel = 'dynamics' AND v.n = v.P AND v.baseline = 'fastest serial'
          AND v.operators = 'structured' AND v.solver = 'pcr-symmetric' AND v.level = 'link' AND v.base = 'fixed'
          AND r.model = 'serial-chain' AND r.joint = 'revolute'
    GROUP BY 1, 2),
shared_gap AS (
    SELECT s.variant, 'n = P = ' || group_concat(w.P, ', ') || ' (mimdsim paper paper-sharing)' AS missing
    FROM (SELECT DISTINCT variant FROM shared) s CROSS JOIN (SELECT 64 AS P UNION SELECT 96 UNION SELECT 128) w
    WHERE NOT EXISTS (SELECT 1 FROM shared p WHERE p.variant = s.variant AND p.P = w.P) GROUP BY s.variant),
shared_ends AS (
    SELECT variant, max(CASE P WHEN 128 THEN speedup END) AS last, max(CASE WHEN P < 128 THEN speedup END) AS best
    FROM shared GROUP BY variant)
SELECT variant, last / best AS value, 1.0 AS threshold, iif(last >= best, 0, free_last >= free_best) AS holds, missing,
       format('contention makes the run at 128 %.1f %% longer; a drop requires more than %.0f %%', 100 * (free_last / last - 1),
              100 * (free_last / best - 1)) AS note,
       iif(last < best AND free_last >= free_best, min(1 - last / best, free_last / free_best - 1),
           min(1 - last / best, 0) + min(free_last / free_best - 1, 0)) AS margin
FROM ends LEFT JOIN gap USING (variant)
UNION ALL
SELECT variant, last / best, 1.0, last < best, missing,
       format('S(128) = %.2f, alone on the machine %.2f', last,
              (SELECT last FROM ends WHERE ends.variant = 'fastest serial, structured')), 1 - last / best
FROM shared_ends LEFT JOIN shared_gap USING (variant)
UNION ALL
SELECT s.variant || ' at 128 only', s.last / e.best, 1.0, s.last < e.best, ifnull(h.missing, g.missing),
       format('S(128) = %.2f, best of fewer processors, alone on the machine, %.2f', s.last, e.best),
       1 - s.last / e.best
FROM shared_ends s JOIN ends e ON e.variant = 'fastest serial, structured' LEFT JOIN shared_gap h ON h.variant = s.variant
     LEFT JOIN gap g ON g.variant = e.variant
ORDER BY 1;

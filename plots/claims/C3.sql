-- statement: The speedup drops near the largest number of processors, because messages meet on common routes.
-- test: S(128) below the largest S of fewer processors with contention, and not so without
-- unit: S(128) / max S(P < 128)
-- designated: fastest serial, structured
-- Rows for a machine that is not one's own: random placement, noise, background load; there S is the mean over
-- repetitions, and holds when it drops whatever the contention of its own messages is; 'at 128 only': runs on fewer
-- processors have the machine for themselves.
WITH point AS (
    SELECT v.*, v.baseline || ', ' || v.operators AS variant
    FROM v_speedup v JOIN run r ON r.id = v.run_id
    WHERE v.machine = 't3e-300' AND v.kernel = 'dynamics' AND v.formulation = 'paper' AND v.base = 'fixed'
          AND v.solver IN ('pcr-symmetric', 'pcr') AND v.n = v.P AND v.precision = 'double' AND r.placement = 'linear'
          AND r.scenario <> 'paper-scaling' AND ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0),
ends AS (
    SELECT variant, max(CASE WHEN level <> 'loggp' AND P = 128 THEN speedup END) AS last,
           max(CASE WHEN level <> 'loggp' AND P < 128 THEN speedup END) AS best,
           max(CASE WHEN level = 'loggp' AND P = 128 THEN speedup END) AS free_last,
           max(CASE WHEN level = 'loggp' AND P < 128 THEN speedup END) AS free_best
    FROM point GROUP BY variant),
shared AS (
    SELECT v.P, CASE WHEN v.compute_noise_cv > 0 THEN format('computing noise %d %%', round(100 * v.compute_noise_cv))
                     WHEN v.background_load > 0 THEN format('background load %d %%', round(100 * v.background_load))
                     ELSE 'scattered placement' END AS variant, avg(v.speedup) AS speedup
    FROM v_speedup v JOIN run r ON r.id = v.run_id
    WHERE v.machine = 't3e-300' AND v.kernel = 'dynamics' AND v.n = v.P AND v.baseline = 'fastest serial'
          AND v.operators = 'structured' AND v.solver = 'pcr-symmetric' AND v.level = 'link' AND v.base = 'fixed'
          AND (r.placement <> 'linear' OR v.compute_noise_cv > 0 OR v.background_load > 0)
    GROUP BY 1, 2),
shared_ends AS (
    SELECT variant, max(CASE P WHEN 128 THEN speedup END) AS last, max(CASE WHEN P < 128 THEN speedup END) AS best
    FROM shared GROUP BY variant)
SELECT variant, last / best AS value, 1.0 AS threshold, iif(last >= best, 0, free_last >= free_best) AS holds,
       format('contention makes the run at 128 %.1f %% longer, a drop needs more than %.0f %%', 100 * (free_last / last - 1),
              100 * (free_last / best - 1)) AS note
FROM ends
UNION ALL
SELECT variant, last / best, 1.0, last < best,
       format('S(128) = %.2f, alone on the machine %.2f', last,
              (SELECT last FROM ends WHERE ends.variant = 'fastest serial, structured'))
FROM shared_ends
UNION ALL
SELECT s.variant || ' at 128 only', s.last / e.best, 1.0, s.last < e.best,
       format('S(128) = %.2f, best of fewer processors on a machine of their own %.2f', s.last, e.best)
FROM shared_ends s JOIN ends e ON e.variant = 'fastest serial, structured'
ORDER BY 1;

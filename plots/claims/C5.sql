-- statement: For n < 16 a serial O(n) code can be faster than the parallel one.
-- test: S < 1 for some n = P < 16
-- unit: smallest S for P < 16
-- designated: fastest serial, structured
WITH point AS (
    SELECT v.*, v.baseline || ', ' || v.operators AS variant
    FROM v_speedup v JOIN run r ON r.id = v.run_id
    WHERE v.machine = 't3e-300' AND v.kernel = 'dynamics' AND v.formulation = 'paper' AND v.base = 'fixed'
          AND v.solver IN ('pcr-symmetric', 'pcr') AND v.n = v.P AND v.precision = 'double' AND r.placement = 'linear'
          AND r.scenario <> 'paper-scaling' AND ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0)
SELECT variant, min(speedup) AS value, 1.0 AS threshold, min(speedup) < 1 AS holds,
       'S exceeds 1 from P = ' || ifnull((SELECT min(P) FROM point q WHERE q.variant = point.variant AND q.level = 'link'
                                          AND q.speedup > 1), 'more than 128') AS note
FROM point WHERE level = 'link' AND P < 16 GROUP BY variant ORDER BY variant;

-- statement: The degree of parallelism f is better than 0.97 only after about n = P = 45.
-- test: the smallest P with f >= 0.97 lies from 33 to 64
-- unit: processors
-- designated: fastest serial, structured
WITH point AS (
    SELECT v.*, v.baseline || ', ' || v.operators AS variant
    FROM v_speedup v JOIN run r ON r.id = v.run_id
    WHERE v.machine = 't3e-300' AND v.kernel = 'dynamics' AND v.formulation = 'paper' AND v.base = 'fixed'
          AND v.solver IN ('pcr-symmetric', 'pcr') AND v.n = v.P AND v.precision = 'double' AND r.placement = 'linear'
          AND r.scenario <> 'paper-scaling' AND ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0),
crossing AS (
    SELECT variant, min(CASE WHEN parallel_fraction >= 0.97 THEN P END) AS first, max(P) AS last,
           max(CASE P WHEN 48 THEN parallel_fraction END) AS f48, max(CASE P WHEN 128 THEN parallel_fraction END) AS f128
    FROM point WHERE level = 'link' GROUP BY variant HAVING count(*) > 2)
SELECT variant, first AS value, 45.0 AS threshold, ifnull(first BETWEEN 33 AND 64, 0) AS holds,
       format('f = %.3f at 48, %.3f at 128', f48, f128) || iif(first IS NULL, format('; 0.97 is not reached up to %d', last), '') ||
       iif(variant <> 'fastest serial, structured', '',
           format('; nearest to the claim: %s with f = %.3f at 48, 0.97 from P = %s',
                  (SELECT variant FROM crossing ORDER BY f48 DESC LIMIT 1), (SELECT max(f48) FROM crossing),
                  (SELECT ifnull(first, 'more than ' || last) FROM crossing ORDER BY f48 DESC LIMIT 1))) AS note
FROM crossing ORDER BY variant;

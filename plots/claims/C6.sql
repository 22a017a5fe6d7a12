-- statement: On the Paragon the modified cyclic reduction beats the best serial solver and conventional parallel reduction.
-- test: time of CFA[2] at P = 16 .. 256: less than the best serial solver and than conventional PCR, at every P
-- unit: smallest gain over the better of both
-- designated: partition + pcr, n = 1024
-- The paper's variant is not public. Candidates: one row a processor (n = P = 256) and several (n = 1024).
WITH solve AS (
    SELECT r.n, r.P, CASE r.solver WHEN 'partition' THEN 'partition + ' || r.part_solver ELSE r.solver END AS method,
           min(s.total_sum_ps / (1.0 * r.P)) AS stage_ps
    FROM run r JOIN stage s ON s.run_id = r.id AND s.name = 'CFA[2]'
    WHERE r.status = 'ok' AND r.machine = 'paragon' AND r.kernel = 'forward' AND r.formulation = 'paper'
          AND r.base = 'fixed' AND r.level = 'link' AND r.precision = 'double' AND r.operators = 'structured'
          AND r.placement = 'linear' AND ifnull(r.compute_noise_cv, 0) = 0 AND ifnull(r.background_load, 0) = 0
    GROUP BY 1, 2, 3),
serial AS (SELECT n, min(stage_ps) AS ps FROM solve WHERE P = 1 GROUP BY n),
conventional AS (SELECT n, P, stage_ps AS ps FROM solve WHERE method = 'pcr'),
gain AS (
    SELECT v.n, v.P, v.method, s.ps / v.stage_ps AS over_serial, c.ps / v.stage_ps AS over_pcr
    FROM solve v JOIN serial s ON s.n = v.n JOIN conventional c ON c.n = v.n AND c.P = v.P
    WHERE v.P >= 16 AND v.n >= 256 AND v.method NOT IN ('pcr', 'thomas'))
SELECT method || ', n = ' || n AS variant, min(min(over_serial, over_pcr)) AS value, 1.0 AS threshold,
       min(min(over_serial, over_pcr)) > 1 AS holds,
       format('over serial %.2f to %.2f, over conventional PCR %.2f to %.2f', min(over_serial), max(over_serial),
              min(over_pcr), max(over_pcr)) AS note
FROM gain GROUP BY n, method ORDER BY variant;

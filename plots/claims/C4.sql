-- statement: With few bodies the velocity stage NE[1] dominates, with many bodies cyclic reduction CFA[2] does.
-- test: of all stages NE[1] takes the most at n = P = 16 and CFA[2] at 128
-- unit: NE[1] / CFA[2] at 128 over the same at 16
-- designated: time, dense
-- Stages are compared by mean time over the ranks, by computing alone, and by the slowest rank.
WITH chosen AS (
    SELECT v.* FROM v_stage v JOIN run r ON r.id = v.run_id
    WHERE v.machine = 't3e-300' AND v.kernel = 'dynamics' AND v.formulation = 'paper' AND v.level = 'link'
          AND v.solver IN ('pcr-symmetric', 'pcr') AND v.n = v.P AND v.P IN (16, 128) AND r.base = 'fixed'
          AND r.precision = 'double' AND r.placement = 'linear' AND ifnull(r.compute_noise_cv, 0) = 0
          AND ifnull(r.background_load, 0) = 0 AND v.name <> 'end'
          AND r.id IN (SELECT max(id) FROM run WHERE status = 'ok'
                   GROUP BY machine, level, kernel, formulation, solver, operators, base, precision, placement,
                            compute_noise_cv, background_load, n, P)),
measured AS (
    SELECT 'time, ' || operators AS variant, P, name, total_mean_ps AS t FROM chosen
    UNION ALL SELECT 'computing, ' || operators, P, name, compute_mean_ps FROM chosen
    UNION ALL SELECT 'slowest rank, ' || operators, P, name, 1.0 * total_max_ps FROM chosen),
ranked AS (SELECT *, row_number() OVER (PARTITION BY variant, P ORDER BY t DESC) AS place FROM measured),
wide AS (
    SELECT variant, max(CASE WHEN P = 16 AND place = 1 THEN name END) AS few,
           max(CASE WHEN P = 128 AND place = 1 THEN name END) AS many,
           max(CASE WHEN P = 16 AND name = 'NE[1]' THEN t END) / max(CASE WHEN P = 16 AND name = 'CFA[2]' THEN t END) AS r16,
           max(CASE WHEN P = 128 AND name = 'NE[1]' THEN t END) / max(CASE WHEN P = 128 AND name = 'CFA[2]' THEN t END) AS r128
    FROM ranked GROUP BY variant)
SELECT variant, r128 / r16 AS value, 1.0 AS threshold, few = 'NE[1]' AND many = 'CFA[2]' AS holds,
       format('dearest: %s at 16, %s at 128; NE[1] / CFA[2] = %.2f, then %.2f', few, many, r16, r128) AS note
FROM wide ORDER BY variant;

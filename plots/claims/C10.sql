-- statement: A free-floating base costs almost nothing more at many bodies.
-- test: T(floating) / T(fixed) at n = P = 128 within 2 % of 1
-- unit: T(floating) / T(fixed)
-- designated: structured
WITH point AS (
    SELECT r.operators AS variant, r.P, r.base, min(r.makespan_ps) AS t
    FROM run r
    WHERE r.status = 'ok' AND r.machine = 't3e-300' AND r.kernel = 'dynamics' AND r.formulation = 'paper' AND r.n = r.P
          AND r.solver IN ('pcr-symmetric', 'pcr') AND r.level = 'link' AND r.precision = 'double'
          AND r.placement = 'linear' AND ifnull(r.compute_noise_cv, 0) = 0 AND ifnull(r.background_load, 0) = 0
    GROUP BY 1, 2, 3)
SELECT a.variant, 1.0 * b.t / a.t AS value, 1.02 AS threshold, abs(1.0 * b.t / a.t - 1) <= 0.02 AS holds,
       format('%.1f us fixed, %.1f us floating', a.t / 1e6, b.t / 1e6) AS note
FROM point a JOIN point b ON b.variant = a.variant AND b.P = a.P AND a.base = 'fixed' AND b.base = 'floating'
WHERE a.P = 128 ORDER BY a.variant;

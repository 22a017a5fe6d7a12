-- statement: More bodies a processor lift the speedup slightly and lower the degree of parallelism.
-- test: S(n/P = 16) > S(n/P = 1) and f(n/P = 16) < f(n/P = 1) at every P >= 16
-- unit: f(n/P = 16) - f(n/P = 1) at the largest P
-- designated: fastest serial, structured
-- At one P, f is an increasing function of S, so both halves exclude each other whatever the machine. Rows 'speedup
-- only' test the first half alone; rows 'same n' compare f at the same number of bodies, n on n/16 processors with n
-- on n.
WITH point AS (
    SELECT v.n, v.P, v.n / v.P AS ratio, v.baseline || ', ' || v.operators AS variant, v.speedup, v.parallel_fraction AS f
    FROM v_speedup v JOIN run r ON r.id = v.run_id
    WHERE v.machine = 't3e-300' AND v.kernel = 'dynamics' AND v.formulation = 'paper' AND v.base = 'fixed'
          AND v.solver = 'partition' AND v.n % v.P = 0 AND v.level = 'link' AND v.precision = 'double' AND v.P > 1
          AND r.placement = 'linear' AND ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0),
pair AS (
    SELECT a.variant, a.P, a.speedup AS s1, b.speedup AS s16, a.f AS f1, b.f AS f16
    FROM point a JOIN point b ON b.P = a.P AND b.variant = a.variant AND a.ratio = 1 AND b.ratio = 16 WHERE a.P >= 16),
last AS (SELECT * FROM pair GROUP BY variant HAVING P = max(P)),
every AS (SELECT variant, min(s16 > s1) AS lifted, min(f16 < f1) AS lowered FROM pair GROUP BY variant),
same AS (
    SELECT a.variant, a.n, a.f AS f1, b.f AS f16, a.P AS P1, b.P AS P16
    FROM point a JOIN point b ON b.n = a.n AND b.variant = a.variant AND a.ratio = 1 AND b.ratio = 16
    GROUP BY a.variant HAVING a.n = max(a.n))
SELECT variant, f16 - f1 AS value, 0.0 AS threshold, lifted AND lowered AS holds,
       format('S %.2f to %.2f, f %.3f to %.3f at P = %d', s1, s16, f1, f16, P) AS note
FROM last JOIN every USING (variant)
UNION ALL
SELECT 'speedup only: ' || variant, s16 / s1, 1.0, lifted, format('S %.2f to %.2f at P = %d', s1, s16, P)
FROM last JOIN every USING (variant) WHERE variant IN ('fastest serial, structured', 'fastest serial, dense')
UNION ALL
SELECT 'same n: ' || variant, f16 - f1, 0.0, lifted AND f16 < f1,
       format('n = %d: f = %.3f on %d processors, %.3f on %d', n, f1, P1, f16, P16)
FROM same JOIN every USING (variant)
ORDER BY 1;

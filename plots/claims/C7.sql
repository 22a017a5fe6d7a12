-- statement: More bodies per processor raise the speedup slightly and lower the degree of parallelism.
-- test: S(n/P = 16) > S(n/P = 1) and f(n/P = 16) < f(n/P = 1) at every P >= 16
-- unit: f(n/P = 16) - f(n/P = 1) at the largest P
-- designated: fastest serial, structured
-- judged: the fastest serial code, which the text names as the baseline, with structured operators, as in that code;
--   level link. Both parts are compared at the same P, as in figure 9 of the paper; 1 and 16 are the ends of its range.
-- points: t3e-300, dynamics with solver partition, n/P = 1 and 16 on 16 and 64 processors at level link
-- needs: mimdsim paper fig9
-- explore: sample-t3e-packing
-- explore: sample-t3e-same-n
-- never: at one number of processors f is an increasing function of S, so that what raises S raises f
-- At one P, f is an increasing function of S, so the two parts exclude each other on any machine. Rows 'speedup
-- only' test only the first part; rows 'same n' compare f at the same number of bodies, n on n/16 processors with n
-- on n. The serial code of order n^3 is not run for many bodies; fewer values of P are compared there.
WITH point AS (
    SELECT v.n, v.P, v.n / v.P AS ratio, v.operators, v.baseline || ', ' || v.operators AS variant,
           v.speedup, v.parallel_fraction AS f
    FROM v_speedup v JOIN run r ON r.id = v.run_id JOIN v_machine_state m ON m.run_id = r.id
    WHERE (m.state = 'as shipped' OR ?1 IN ('what-if', 'explored')) AND v.machine = 't3e-300' AND v.kernel = 'dynamics'
          AND v.formulation = 'paper' AND v.base = 'fixed' AND r.model = 'serial-chain' AND r.joint = 'revolute'
          AND v.solver = 'partition' AND v.n % v.P = 0 AND v.level = 'link' AND v.precision = 'double' AND v.P > 1
          AND r.placement = 'linear' AND (?1 = 'explored' OR ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0)),
wanted(ratio, P) AS (VALUES (1, 16), (1, 64), (16, 16), (16, 64)),
gap AS (
    SELECT s.variant, group_concat(format('n/P = %d on %d', w.ratio, w.P), ', ') AS missing
    FROM (SELECT DISTINCT variant, operators FROM point) s CROSS JOIN wanted w
    WHERE NOT EXISTS (SELECT 1 FROM point p WHERE p.operators = s.operators AND p.P = w.P AND p.ratio = w.ratio)
    GROUP BY s.variant),
pair AS (
    SELECT a.variant, a.P, a.speedup AS s1, b.speedup AS s16, a.f AS f1, b.f AS f16
    FROM point a JOIN point b ON b.P = a.P AND b.variant = a.variant AND a.ratio = 1 AND b.ratio = 16 WHERE a.P >= 16),
last AS (SELECT * FROM pair GROUP BY variant HAVING P = max(P)),
every AS (SELECT variant, min(s16 > s1) AS lifted, min(f16 < f1) AS lowered, min(s16 / s1 - 1) AS lift,
          min(f1 - f16) AS fall FROM pair GROUP BY variant),
same AS (
    SELECT a.variant, a.n, a.f AS f1, b.f AS f16, a.P AS P1, b.P AS P16
    FROM point a JOIN point b ON b.n = a.n AND b.variant = a.variant AND a.ratio = 1 AND b.ratio = 16
    GROUP BY a.variant HAVING a.n = max(a.n))
SELECT variant, f16 - f1 AS value, 0.0 AS threshold, lifted AND lowered AS holds, missing,
       format('from 1 to 16 bodies per processor S goes from %.2f to %.2f and f from %.3f to %.3f at P = %d',
              s1, s16, f1, f16, P) AS note, min(lift, fall) AS margin
FROM last JOIN every USING (variant) LEFT JOIN gap USING (variant)
UNION ALL
SELECT 'speedup only: ' || variant, s16 / s1, 1.0, lifted, missing, format('S %.2f to %.2f at P = %d', s1, s16, P), lift
FROM last JOIN every USING (variant) LEFT JOIN gap USING (variant)
WHERE variant IN ('fastest serial, structured', 'fastest serial, dense')
UNION ALL
SELECT 'same n: ' || variant, f16 - f1, 0.0, lifted AND f16 < f1, missing,
       format('n = %d: f = %.3f on %d processors, %.3f on %d', n, f1, P1, f16, P16), min(lift, f1 - f16)
FROM same JOIN every USING (variant) LEFT JOIN gap USING (variant)
ORDER BY 1;

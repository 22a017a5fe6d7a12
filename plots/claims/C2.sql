-- statement: The degree of parallelism f is better than 0.97 only after about n = P = 45.
-- test: the smallest P with f >= 0.97 lies from 33 to 64
-- unit: processors
-- designated: fastest serial, structured
-- judged: the fastest serial code, which the text names as the baseline, with structured operators, as in that code;
--   level link. "About 45" is interpreted as 33 to 64, a factor of 1.4 either way; if 0.97 is never reached, the claim fails.
-- points: t3e-300, dynamics, n = P = 16, 32, 48, 64, 128 at level link
-- needs: mimdsim paper fig6
-- explore: sample-t3e n=2,4,8,16,32,48,64,128 level=link
WITH point AS (
    SELECT v.*, v.baseline || ', ' || v.operators AS variant
    FROM v_speedup v JOIN run r ON r.id = v.run_id JOIN v_machine_state m ON m.run_id = r.id
    WHERE (m.state = 'as shipped' OR ?1 IN ('what-if', 'explored')) AND v.machine = 't3e-300' AND v.kernel = 'dynamics'
          AND v.formulation = 'paper' AND v.base = 'fixed' AND r.model = 'serial-chain' AND r.joint = 'revolute'
          AND v.solver IN ('pcr-symmetric', 'pcr') AND v.n = v.P AND v.precision = 'double' AND r.placement = 'linear'
          AND r.scenario <> 'paper-scaling' AND (?1 = 'explored' OR ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0)),
wanted(P) AS (VALUES (16), (32), (48), (64), (128)),
gap AS (
    SELECT s.variant, 'n = P = ' || group_concat(w.P, ', ') || ' at level link' AS missing
    FROM (SELECT DISTINCT variant FROM point) s CROSS JOIN wanted w
    WHERE NOT EXISTS (SELECT 1 FROM point p WHERE p.variant = s.variant AND p.P = w.P AND p.level = 'link')
    GROUP BY s.variant),
crossing AS (
    SELECT variant, min(CASE WHEN parallel_fraction >= 0.97 THEN P END) AS first, max(P) AS last,
           max(CASE P WHEN 48 THEN parallel_fraction END) AS f48, max(CASE P WHEN 128 THEN parallel_fraction END) AS f128,
           min(CASE WHEN P <= 32 THEN max(1 - parallel_fraction, 1e-9) END) AS serial_below,
           min(CASE WHEN P BETWEEN 33 AND 64 THEN max(1 - parallel_fraction, 1e-9) END) AS serial_within
    FROM point WHERE level = 'link' GROUP BY variant)
SELECT variant, first AS value, 45.0 AS threshold, ifnull(first BETWEEN 33 AND 64, 0) AS holds, missing,
       format('f = %.3f at 48, %.3f at 128', f48, f128) ||
       iif(first IS NULL, format('; 0.97 is not reached up to %d', last), '') ||
       iif(variant <> 'fastest serial, structured', '',
           format('; nearest to the claim: %s with f = %.3f at 48, 0.97 from P = %s',
                  (SELECT variant FROM crossing ORDER BY f48 DESC LIMIT 1), (SELECT max(f48) FROM crossing),
                  (SELECT ifnull(first, 'more than ' || last) FROM crossing ORDER BY f48 DESC LIMIT 1))) AS note,
       min(ln(0.03 / serial_within), 0) + min(ifnull(ln(serial_below / 0.03), 0), 0) AS margin
FROM crossing LEFT JOIN gap USING (variant) ORDER BY variant;

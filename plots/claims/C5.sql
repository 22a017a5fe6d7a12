-- statement: For n < 16 a serial O(n) code can be faster than the parallel one.
-- test: S < 1 for some n = P < 16
-- unit: smallest S for P < 16
-- designated: fastest serial, structured
-- judged: the fastest serial code, which the text names as the baseline, with structured operators, as in that code;
--   level link. The claim says "can be", so one size below 16 is enough.
-- points: t3e-300, dynamics, n = P = 2, 4, 8 at level link
-- needs: mimdsim paper fig6
-- explore: sample-t3e n=2,4,8 level=link
WITH point AS (
    SELECT v.*, v.baseline || ', ' || v.operators AS variant
    FROM v_speedup v JOIN run r ON r.id = v.run_id JOIN v_machine_state m ON m.run_id = r.id
    WHERE (m.state = 'as shipped' OR ?1 IN ('what-if', 'explored')) AND v.machine = 't3e-300' AND v.kernel = 'dynamics'
          AND v.formulation = 'paper' AND v.base = 'fixed' AND r.model = 'serial-chain' AND r.joint = 'revolute'
          AND v.solver IN ('pcr-symmetric', 'pcr') AND v.n = v.P AND v.precision = 'double' AND r.placement = 'linear'
          AND r.scenario <> 'paper-scaling' AND (?1 = 'explored' OR ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0)),
wanted(P) AS (VALUES (2), (4), (8)),
gap AS (
    SELECT s.variant, 'n = P = ' || group_concat(w.P, ', ') || ' at level link' AS missing
    FROM (SELECT DISTINCT variant FROM point) s CROSS JOIN wanted w
    WHERE NOT EXISTS (SELECT 1 FROM point p WHERE p.variant = s.variant AND p.P = w.P AND p.level = 'link')
    GROUP BY s.variant)
SELECT variant, min(speedup) AS value, 1.0 AS threshold, min(speedup) < 1 AS holds, max(missing) AS missing,
       'S exceeds 1 from P = ' || ifnull((SELECT min(P) FROM point q WHERE q.variant = point.variant AND q.level = 'link'
                                          AND q.speedup > 1),
              'more than ' || (SELECT max(P) FROM point q WHERE q.variant = point.variant)) AS note,
       1 - min(speedup) AS margin
FROM point LEFT JOIN gap USING (variant) WHERE level = 'link' AND P < 16 GROUP BY variant ORDER BY variant;

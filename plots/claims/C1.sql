-- statement: The speedup rises sharply after n = P = 16.
-- test: mean slope of S(P) from 16 to 32 is at least twice that from 2 to 16
-- unit: ratio of slopes
-- designated: fastest serial, structured
-- judged: the fastest serial code, which the text names as the baseline, with structured operators, as in that code;
--   level link. The paper gives no number; "sharply" is interpreted as at least twice the slope.
-- points: t3e-300, dynamics, n = P = 2, 16, 32 at level link
-- needs: mimdsim paper fig6
-- explore: sample-t3e n=2,16,32 level=link
WITH point AS (
    SELECT v.*, v.baseline || ', ' || v.operators AS variant
    FROM v_speedup v JOIN run r ON r.id = v.run_id JOIN v_machine_state m ON m.run_id = r.id
    WHERE (m.state = 'as shipped' OR ?1 IN ('what-if', 'explored')) AND v.machine = 't3e-300' AND v.kernel = 'dynamics'
          AND v.formulation = 'paper' AND v.base = 'fixed' AND r.model = 'serial-chain' AND r.joint = 'revolute'
          AND v.solver IN ('pcr-symmetric', 'pcr') AND v.n = v.P AND v.precision = 'double' AND r.placement = 'linear'
          AND r.scenario <> 'paper-scaling' AND (?1 = 'explored' OR ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0)),
wanted(P) AS (VALUES (2), (16), (32)),
gap AS (
    SELECT s.variant, 'n = P = ' || group_concat(w.P, ', ') || ' at level link' AS missing
    FROM (SELECT DISTINCT variant FROM point) s CROSS JOIN wanted w
    WHERE NOT EXISTS (SELECT 1 FROM point p WHERE p.variant = s.variant AND p.P = w.P AND p.level = 'link')
    GROUP BY s.variant),
slope AS (
    SELECT variant, max(CASE P WHEN 2 THEN speedup END) AS s2, max(CASE P WHEN 16 THEN speedup END) AS s16,
           max(CASE P WHEN 32 THEN speedup END) AS s32
    FROM point WHERE level = 'link' GROUP BY variant)
SELECT variant, ((s32 - s16) / 16) / ((s16 - s2) / 14) AS value, 2.0 AS threshold,
       ((s32 - s16) / 16) / ((s16 - s2) / 14) >= 2 AS holds, missing,
       format('S = %.2f, %.2f, %.2f at P = 2, 16, 32: the later slope is %.2f times the earlier',
              s2, s16, s32, (s32 - s16) / 16 / ((s16 - s2) / 14)) ||
       iif(variant <> 'fastest serial, structured', '',
           format('; nearest to the claim: %s with %.2f',
                  (SELECT variant FROM slope ORDER BY (s32 - s16) / (s16 - s2) DESC LIMIT 1),
                  (SELECT max((s32 - s16) / 16 / ((s16 - s2) / 14)) FROM slope))) AS note,
       ((s32 - s16) / 16) / ((s16 - s2) / 14) / 2 - 1 AS margin
FROM slope LEFT JOIN gap USING (variant) ORDER BY variant;

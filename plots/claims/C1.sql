-- statement: The speedup rises sharply after n = P = 16.
-- test: mean slope of S(P) from 16 to 32 is at least twice that from 2 to 16
-- unit: ratio of slopes
-- designated: fastest serial, structured
WITH point AS (
    SELECT v.*, v.baseline || ', ' || v.operators AS variant
    FROM v_speedup v JOIN run r ON r.id = v.run_id
    WHERE v.machine = 't3e-300' AND v.kernel = 'dynamics' AND v.formulation = 'paper' AND v.base = 'fixed'
          AND v.solver IN ('pcr-symmetric', 'pcr') AND v.n = v.P AND v.precision = 'double' AND r.placement = 'linear'
          AND r.scenario <> 'paper-scaling' AND ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0),
slope AS (
    SELECT variant, max(CASE P WHEN 2 THEN speedup END) AS s2, max(CASE P WHEN 16 THEN speedup END) AS s16,
           max(CASE P WHEN 32 THEN speedup END) AS s32
    FROM point WHERE level = 'link' GROUP BY variant)
SELECT variant, ((s32 - s16) / 16) / ((s16 - s2) / 14) AS value, 2.0 AS threshold,
       ((s32 - s16) / 16) / ((s16 - s2) / 14) >= 2 AS holds,
       format('S = %.2f, %.2f, %.2f at P = 2, 16, 32', s2, s16, s32) ||
       iif(variant <> 'fastest serial, structured', '',
           format('; nearest to the claim: %s with %.2f', (SELECT variant FROM slope ORDER BY (s32 - s16) / (s16 - s2) DESC LIMIT 1),
                  (SELECT max((s32 - s16) / 16 / ((s16 - s2) / 14)) FROM slope))) AS note
FROM slope ORDER BY variant;

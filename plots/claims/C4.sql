-- statement: With few bodies the velocity stage NE[1] dominates, with many bodies cyclic reduction CFA[2] does.
-- test: of all stages NE[1] takes longest at n = P = 16 and CFA[2] at 128
-- unit: NE[1] / CFA[2] at 128 divided by the same at 16
-- designated: time, dense
-- judged: the stages' mean times over the ranks, which add up to the run time, with dense operators, because the text attributes
--   the cost of the velocity stage to the matrices; level link. 16 and 128 are the sizes of the paper's figure 5.
-- points: t3e-300, dynamics, n = P = 16 and 128 at level link
-- needs: mimdsim paper fig5
-- explore: sample-t3e n=16,128 level=link
-- Stages are compared by mean time over the ranks, by computing alone, and by the slowest rank.
WITH latest AS (
    SELECT max(r.id) AS id FROM run r JOIN v_machine_state m ON m.run_id = r.id
    WHERE (m.state = 'as shipped' OR ?1 IN ('what-if', 'explored')) AND r.status = 'ok' AND r.machine = 't3e-300' AND r.kernel = 'dynamics'
          AND r.formulation = 'paper' AND r.level = 'link' AND r.solver IN ('pcr-symmetric', 'pcr') AND r.n = r.P
          AND r.P IN (16, 128) AND r.base = 'fixed' AND r.model = 'serial-chain' AND r.joint = 'revolute'
          AND r.precision = 'double' AND r.placement = 'linear' AND (?1 = 'explored' OR ifnull(r.compute_noise_cv, 0) = 0 AND ifnull(r.background_load, 0) = 0)
    GROUP BY r.operators, r.P),
chosen AS (SELECT * FROM v_stage WHERE run_id IN (SELECT id FROM latest) AND name <> 'end'),
gap AS (
    SELECT s.operators, 'n = P = ' || group_concat(w.P, ', ') || ' at level link' AS missing
    FROM (SELECT DISTINCT operators FROM chosen) s CROSS JOIN (SELECT 16 AS P UNION SELECT 128) w
    WHERE NOT EXISTS (SELECT 1 FROM chosen p WHERE p.operators = s.operators AND p.P = w.P) GROUP BY s.operators),
measured AS (
    SELECT 'time, ' || operators AS variant, operators, P, name, total_mean_ps AS t FROM chosen
    UNION ALL SELECT 'computing, ' || operators, operators, P, name, compute_mean_ps FROM chosen
    UNION ALL SELECT 'slowest rank, ' || operators, operators, P, name, 1.0 * total_max_ps FROM chosen),
ranked AS (SELECT *, row_number() OVER (PARTITION BY variant, P ORDER BY t DESC) AS place FROM measured),
wide AS (
    SELECT variant, operators, max(CASE WHEN P = 16 AND place = 1 THEN name END) AS few,
           max(CASE WHEN P = 128 AND place = 1 THEN name END) AS many,
           max(CASE WHEN P = 16 AND name = 'NE[1]' THEN t END) / max(CASE WHEN P = 16 AND name = 'CFA[2]' THEN t END) AS r16,
           max(CASE WHEN P = 128 AND name = 'NE[1]' THEN t END) / max(CASE WHEN P = 128 AND name = 'CFA[2]' THEN t END) AS r128,
           max(CASE WHEN P = 16 AND name = 'NE[1]' THEN t END)
               / max(CASE WHEN P = 16 AND name <> 'NE[1]' THEN t END) - 1 AS lead16,
           max(CASE WHEN P = 128 AND name = 'CFA[2]' THEN t END)
               / max(CASE WHEN P = 128 AND name <> 'CFA[2]' THEN t END) - 1 AS lead128
    FROM ranked GROUP BY variant)
SELECT variant, r128 / r16 AS value, 1.0 AS threshold, few = 'NE[1]' AND many = 'CFA[2]' AS holds, missing,
       format('%s takes longest at 16, %s at 128; NE[1] / CFA[2] = %.2f, then %.2f', few, many, r16, r128) AS note,
       iif(min(lead16, lead128) >= 0, min(lead16, lead128), min(lead16, 0) + min(lead128, 0)) AS margin
FROM wide LEFT JOIN gap USING (operators) ORDER BY variant;

-- statement: log2 n rounds of communication are visible, and for n = P the time grows as log2 n.
-- test: NE[2] sends the messages of ceil(log2 P) doubling rounds, and T(2P) - T(P) from P = 8 is constant within 5 %
-- unit: spread of T(2P) - T(P) divided by its mean
-- designated: structured
-- judged: structured operators as in the other claims, without contention (level loggp), because the claim is about the
--   algorithm, on a T3E of 16 x 8 x 8 nodes, to cover more sizes than the paper. "Constant" is
--   interpreted as within 5 % of the mean step.
-- points: t3e-300 with topology.dims [16, 8, 8], dynamics, n = P = 8, 16, 32, 64, 128 at level loggp
-- needs: mimdsim paper paper-scaling
-- explore: sample-t3e n=8,16,32,64,128 level=loggp
-- R doubling rounds of P processors are R P - (2^R - 1) pairs.
WITH fit AS (
    SELECT r.* FROM run r JOIN v_machine_state m ON m.run_id = r.id
    WHERE (m.state = 'changed' AND m.machine_changes = '{"topology.dims": "[16, 8, 8]"}' OR ?1 IN ('what-if', 'explored'))
          AND r.status = 'ok' AND r.machine = 't3e-300' AND r.level = 'loggp' AND r.kernel = 'dynamics' AND r.n = r.P
          AND r.formulation = 'paper' AND r.base = 'fixed' AND r.model = 'serial-chain' AND r.joint = 'revolute'
          AND r.solver IN ('pcr-symmetric', 'pcr') AND r.P >= 8),
one AS (SELECT scenario FROM fit GROUP BY scenario ORDER BY max(P) DESC, scenario LIMIT 1),
point AS (
    SELECT r.operators AS variant, r.P, r.makespan_ps AS t, s.messages,
           ceil(log2(r.P)) * r.P - (pow(2, ceil(log2(r.P))) - 1) AS pairs
    FROM fit r JOIN one USING (scenario) JOIN stage s ON s.run_id = r.id AND s.name = 'NE[2]'),
wanted(P) AS (VALUES (8), (16), (32), (64), (128)),
gap AS (
    SELECT s.variant, 'n = P = ' || group_concat(w.P, ', ') || ' at level loggp' AS missing
    FROM (SELECT DISTINCT variant FROM point) s CROSS JOIN wanted w
    WHERE NOT EXISTS (SELECT 1 FROM point p WHERE p.variant = s.variant AND p.P = w.P) GROUP BY s.variant),
growth AS (SELECT b.variant, b.P, b.t - a.t AS step FROM point a JOIN point b ON b.variant = a.variant AND b.P = 2 * a.P),
rounds AS (SELECT variant, max(messages / pairs) = min(messages / pairs) AND min(messages / pairs) >= 1 AS visible
           FROM point GROUP BY variant)
SELECT variant, 1.0 * (max(step) - min(step)) / avg(step) AS value, 0.05 AS threshold,
       (max(step) - min(step)) / avg(step) <= 0.05 AND visible AS holds, max(missing) AS missing,
       format('each doubling of n = P adds %.1f to %.1f us up to P = %d; the rounds are %s', min(step) / 1e6, max(step) / 1e6, max(P),
              iif(visible, 'visible', 'not visible')) AS note,
       iif(visible, 1 - (max(step) - min(step)) / avg(step) / 0.05, -1) AS margin
FROM rounds LEFT JOIN growth USING (variant) LEFT JOIN gap USING (variant) GROUP BY variant ORDER BY variant;

-- statement: Indicator load spread: largest minus smallest computing time of a processor, divided by the mean.
-- test: none: the paper gives no number for the indicator
-- unit: spread
-- designated: P = 128, structured
-- judged: nothing: there is no number to compare it with. Shown for the largest machine of the paper, structured operators.
-- points: t3e-300, dynamics, n = P = 128 at level link
-- needs: mimdsim paper fig5
WITH latest AS (
    SELECT max(r.id) AS id FROM run r JOIN v_machine_state m ON m.run_id = r.id
    WHERE (m.state = 'as shipped' OR ?1 IN ('what-if', 'explored')) AND r.status = 'ok' AND r.machine = 't3e-300' AND r.kernel = 'dynamics'
          AND r.formulation = 'paper' AND r.level = 'link' AND r.solver IN ('pcr-symmetric', 'pcr') AND r.n = r.P
          AND r.P IN (16, 128) AND r.base = 'fixed' AND r.model = 'serial-chain' AND r.joint = 'revolute'
          AND r.precision = 'double' AND r.placement = 'linear' AND (?1 = 'explored' OR ifnull(r.compute_noise_cv, 0) = 0 AND ifnull(r.background_load, 0) = 0)
    GROUP BY r.operators, r.P)
SELECT format('P = %d, %s', v.P, v.operators) AS variant, v.load_spread AS value, NULL AS threshold, NULL AS holds, NULL AS missing,
       format('computing %.0f %%, overhead %.0f %%, waiting %.0f %%, contention %.1f %% of the time', 100 * v.compute_share,
              100 * v.overhead_share, 100 * v.wait_share, 100 * v.contention_share) AS note
FROM v_indicator v WHERE v.run_id IN (SELECT id FROM latest)
ORDER BY variant;

-- statement: With many bodies a free-floating base costs almost nothing more.
-- test: T(floating) / T(fixed) at n = P = 128 within 2 % of 1
-- unit: T(floating) / T(fixed)
-- designated: structured
-- judged: structured operators as in the other claims, on the largest machine of the paper, level link. "Almost nothing" is
--   interpreted as 2 %, which averages of runs on shared machines, as in the paper, could not resolve.
-- points: t3e-300, dynamics, n = P = 128 with a fixed and with a floating base at level link
-- needs: mimdsim paper paper-floating
-- explore: sample-t3e n=128 level=link
-- explore: sample-t3e-floating
WITH point AS (
    SELECT r.operators AS variant, r.P, r.base, min(r.makespan_ps) AS t
    FROM run r JOIN v_machine_state m ON m.run_id = r.id
    WHERE (m.state = 'as shipped' OR ?1 IN ('what-if', 'explored')) AND r.status = 'ok' AND r.machine = 't3e-300' AND r.kernel = 'dynamics'
          AND r.formulation = 'paper' AND r.n = r.P AND r.model = 'serial-chain' AND r.joint = 'revolute'
          AND r.solver IN ('pcr-symmetric', 'pcr') AND r.level = 'link' AND r.precision = 'double'
          AND r.placement = 'linear' AND (?1 = 'explored' OR ifnull(r.compute_noise_cv, 0) = 0 AND ifnull(r.background_load, 0) = 0)
    GROUP BY 1, 2, 3)
SELECT a.variant, 1.0 * b.t / a.t AS value, 1.02 AS threshold, abs(1.0 * b.t / a.t - 1) <= 0.02 AS holds,
       iif(b.t IS NULL, 'n = P = 128 with a floating base at level link', NULL) AS missing,
       format('%.1f us with a fixed base, %.1f us with a floating one', a.t / 1e6, b.t / 1e6) AS note,
       1 - abs(1.0 * b.t / a.t - 1) / 0.02 AS margin
FROM point a LEFT JOIN point b ON b.variant = a.variant AND b.P = a.P AND b.base = 'floating'
WHERE a.P = 128 AND a.base = 'fixed' ORDER BY a.variant;

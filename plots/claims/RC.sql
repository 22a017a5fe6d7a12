-- statement: Indicator R/C: run time over the time of communication and synchronisation.
-- test: none: the paper names the indicator without a number
-- unit: R/C
-- designated: P = 128, structured
SELECT format('P = %d, %s', v.P, v.operators) AS variant, v.rc_ratio AS value, NULL AS threshold, NULL AS holds,
       format('computing %.0f %%, overhead %.0f %%, waiting %.0f %%, contention %.1f %% of the time', 100 * v.compute_share,
              100 * v.overhead_share, 100 * v.wait_share, 100 * v.contention_share) AS note
FROM v_indicator v JOIN run r ON r.id = v.run_id
WHERE v.machine = 't3e-300' AND v.kernel = 'dynamics' AND v.formulation = 'paper' AND v.level = 'link' AND v.n = v.P
      AND v.P IN (16, 128) AND r.solver IN ('pcr-symmetric', 'pcr') AND r.base = 'fixed' AND r.precision = 'double'
      AND r.placement = 'linear' AND ifnull(r.compute_noise_cv, 0) = 0 AND ifnull(r.background_load, 0) = 0
      AND r.id IN (SELECT max(id) FROM run WHERE status = 'ok'
                   GROUP BY machine, level, kernel, formulation, solver, operators, base, precision, placement,
                            compute_noise_cv, background_load, n, P)
ORDER BY variant;

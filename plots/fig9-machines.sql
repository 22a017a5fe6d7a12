-- Figure 9 for the paper's four machines side by side: speedup of the complete dynamics over the parallel code on one
-- processor, for n/P = 1, 2, 4, 8, 16 bodies per processor.
-- needs: mimdsim paper fig9-machines
WITH point AS (
    SELECT v.*, CASE WHEN v.machine LIKE 't3e%' THEN 1 WHEN v.machine LIKE 'paragon%' THEN 2
                     WHEN v.machine LIKE 'origin%' THEN 3 WHEN v.machine LIKE 'quad-ppro%' THEN 4 END AS panel
    FROM v_speedup v JOIN run r ON r.id = v.run_id
    WHERE v.kernel = 'dynamics' AND v.P > 1 AND v.n % v.P = 0 AND (v.n > v.P OR v.solver = 'partition') AND v.base = 'fixed'
          AND v.baseline = 'parallel code on one processor' AND r.id IN (SELECT run_id FROM v_shown) AND r.placement = 'linear'
          AND ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0),
-- one variant of each machine: the one with the paper's own message software comes first by name
chosen AS (
    SELECT *, row_number() OVER (PARTITION BY panel, n, P
                                 ORDER BY length(machine), level <> 'loggp' DESC, level = 'link' DESC,
                                          formulation = 'paper' DESC, operators = 'structured' DESC,
                                          precision = 'double' DESC, run_id DESC) AS choice
    FROM point WHERE panel IS NOT NULL AND n / P IN (1, 2, 4, 8, 16))
SELECT panel, dense_rank() OVER (ORDER BY n / P) AS series, n / P AS bodies_per_processor, n, P, makespan_ps, baseline_ps, speedup,
       parallel_fraction, machine, level, formulation, solver, operators, run_id
FROM chosen WHERE choice = 1 AND (SELECT count(DISTINCT panel) FROM point) > 1 -- one machine alone is not a comparison
ORDER BY panel, series, P;

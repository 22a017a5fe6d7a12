-- Figure 6 for the paper's four machines side by side: speedup of the complete dynamics for n = P, relative to the same
-- code on one processor, to the fastest serial code, and to each serial code.
-- needs: mimdsim paper fig6-machines
WITH point AS (
    SELECT *, CASE WHEN machine LIKE 't3e%' THEN 1 WHEN machine LIKE 'paragon%' THEN 2
                   WHEN machine LIKE 'origin%' THEN 3 WHEN machine LIKE 'quad-ppro%' THEN 4 END AS panel
    FROM v_speedup
    WHERE kernel = 'dynamics' AND n = P AND n > 1 AND base = 'fixed'
          AND solver <> 'partition' AND ifnull(compute_noise_cv, 0) = 0 AND ifnull(background_load, 0) = 0
          AND run_id IN (SELECT id FROM run JOIN v_shown ON run_id = id WHERE placement = 'linear' AND scenario <> 'paper-scaling')),
-- one variant of each machine: the one with the paper's own message software comes first by name
chosen AS (
    SELECT *, row_number() OVER (PARTITION BY panel, baseline, n
                                 ORDER BY length(machine), level <> 'loggp' DESC, level = 'link' DESC,
                                          formulation = 'paper' DESC, operators = 'structured' DESC,
                                          precision = 'double' DESC, run_id DESC) AS choice
    FROM point WHERE panel IS NOT NULL)
SELECT panel, dense_rank() OVER (ORDER BY baseline <> 'fastest serial', baseline_ordinal, baseline) AS series,
       replace(baseline, ',', ' –') AS baseline, P, makespan_ps, baseline_ps, speedup, parallel_fraction, machine, level,
       formulation, solver, operators, run_id
FROM chosen WHERE choice = 1 AND (SELECT count(DISTINCT panel) FROM point) > 1 -- one machine alone is not a comparison
ORDER BY panel, series, P;

-- Figure 9: speedup for up to 128 processors with n/P = 1, 2, 4, 8, 16, ... bodies per processor: on the Cray T3E, relative
-- to the same code on one processor, and to the fastest serial code; below, the degree of parallelism f of each point.
-- needs: mimdsim paper fig9
WITH point AS (
    SELECT *, row_number() OVER (PARTITION BY baseline, n, P
                                 ORDER BY level <> 'loggp' DESC, level = 'link' DESC, formulation = 'paper' DESC,
                                          operators = 'structured' DESC, precision = 'double' DESC, run_id DESC) AS choice
    FROM v_speedup
    WHERE run_id IN (SELECT id FROM run JOIN v_shown ON run_id = id WHERE placement = 'linear' AND scenario <> 'paper-scaling')
          AND machine LIKE 't3e%' AND kernel = 'dynamics' AND P > 1 AND (n > P OR solver = 'partition') AND n % P = 0 AND base = 'fixed'
          AND baseline IN ('parallel code on one processor', 'fastest serial')
          AND ifnull(compute_noise_cv, 0) = 0 AND ifnull(background_load, 0) = 0),
-- the eight smallest ratios of which there is a curve
ratio AS (
    SELECT n / P AS ratio, row_number() OVER (ORDER BY n / P) AS series FROM point WHERE choice = 1
    GROUP BY n / P HAVING count(DISTINCT P) >= 3 ORDER BY n / P LIMIT 8)
SELECT CASE baseline WHEN 'fastest serial' THEN 2 ELSE 1 END AS panel,
       series, ratio AS bodies_per_processor, n, P, baseline, makespan_ps,
       baseline_ps, speedup, parallel_fraction,
       (SELECT replace(l.name, ',', '‚') FROM v_label l WHERE l.run_id = point.run_id) AS machine, level, formulation, solver, operators, run_id
FROM point JOIN ratio ON n / P = ratio WHERE choice = 1
ORDER BY panel, series, P;

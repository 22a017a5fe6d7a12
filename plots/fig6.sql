-- Figure 6: speedup of the complete parallel dynamics for n = P on the Cray T3E, one curve per serial code that does the
-- same work, and the degree of parallelism f of each point by Amdahl's law, 1/S = (1 - f) + f/P; the additional time due
-- to contention (the most detailed network level stored, compared with loggp). The composite-body code (rnea+crba) takes
-- O(n^3) operations: over it the speedup grows faster than P and can exceed it, because that serial code is slow. Serial
-- inverse dynamics alone (rnea) does less than the parallel run, and has no curve.
-- needs: mimdsim paper fig6
WITH most AS ( -- the machine with most points; the T3E where several have as many
    SELECT machine FROM run
    WHERE id IN (SELECT run_id FROM v_shown) AND kernel = 'dynamics' AND n = P AND n > 1 AND scenario NOT IN ('paper-scaling', 'fig9', 'fig9-machines', 'fig6-machines')
    GROUP BY machine ORDER BY machine = 't3e-300' DESC, count(DISTINCT n) DESC, min(id) LIMIT 1),
point AS (
    SELECT *, row_number() OVER (PARTITION BY baseline, n, level = 'loggp'
                                 ORDER BY formulation = 'paper' DESC, operators = 'structured' DESC,
                                          level = 'link' DESC, precision = 'double' DESC, run_id) AS choice
    FROM v_speedup
    WHERE run_id IN (SELECT id FROM run JOIN v_shown ON run_id = id
                     WHERE placement = 'linear' AND scenario NOT IN ('paper-scaling', 'fig9', 'fig9-machines'))
          AND machine = (SELECT machine FROM most) AND kernel = 'dynamics' AND n = P AND n > 1 AND base = 'fixed' AND baseline <> 'rnea'
          AND ifnull(compute_noise_cv, 0) = 0 AND ifnull(background_load, 0) = 0),
finest AS (
    SELECT * FROM point a WHERE choice = 1
        AND (level <> 'loggp' OR NOT EXISTS (SELECT 1 FROM point WHERE n = a.n AND level <> 'loggp')))
SELECT dense_rank() OVER (ORDER BY a.baseline <> 'fastest serial', a.baseline_ordinal, a.baseline) AS series, replace(a.baseline, ',', ' –') AS baseline,
       a.P, a.makespan_ps, a.baseline_ps, a.speedup, a.parallel_fraction,
       100.0 * (a.makespan_ps - b.makespan_ps) / b.makespan_ps AS contention_percent,
       (SELECT replace(l.name, ',', '‚') FROM v_label l WHERE l.run_id = a.run_id) AS machine, a.level, a.formulation, a.solver, a.operators, a.run_id
FROM finest a LEFT JOIN point b ON b.choice = 1 AND b.level = 'loggp' AND a.level <> 'loggp' AND b.n = a.n
     AND b.baseline = a.baseline AND b.formulation = a.formulation AND b.solver = a.solver AND b.operators = a.operators
ORDER BY series, a.P;

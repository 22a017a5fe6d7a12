-- Figure 9 for several machines side by side, the paper's four first: speedup of the complete dynamics over the parallel
-- code on one processor, for n/P = 1, 2, 4, 8, 16 bodies per processor. The panels of a row have the same axes.
-- needs: mimdsim paper fig9-machines
-- shared:
WITH point AS (
    SELECT v.*, CASE WHEN v.machine LIKE 't3e%' THEN 1 WHEN v.machine LIKE 'paragon%' THEN 2
                     WHEN v.machine LIKE 'origin%' THEN 3 WHEN v.machine LIKE 'quad-ppro%' THEN 4 ELSE 5 END AS family
    FROM v_speedup v JOIN run r ON r.id = v.run_id
    WHERE v.kernel = 'dynamics' AND v.P > 1 AND v.n % v.P = 0 AND (v.n > v.P OR v.solver = 'partition') AND v.base = 'fixed'
          AND v.baseline = 'parallel code on one processor' AND r.id IN (SELECT run_id FROM v_shown) AND r.placement = 'linear'
          AND ifnull(v.compute_noise_cv, 0) = 0 AND ifnull(v.background_load, 0) = 0),
-- one variant of each machine of the paper: the one with the paper's own message software comes first by name
chosen AS (
    SELECT *, row_number() OVER (PARTITION BY family, iif(family = 5, machine, ''), n, P
                                 ORDER BY length(machine), level <> 'loggp' DESC, level = 'link' DESC,
                                          formulation = 'paper' DESC, operators = 'structured' DESC,
                                          precision = 'double' DESC, run_id DESC) AS choice,
           dense_rank() OVER (ORDER BY family, iif(family = 5, machine, '')) AS panel
    FROM point WHERE n / P IN (1, 2, 4, 8, 16)),
shown AS (SELECT *, n / P AS ratio FROM chosen WHERE choice = 1 AND panel <= 8)
-- main:
SELECT panel, dense_rank() OVER (ORDER BY ratio) AS series, ratio AS bodies_per_processor, n, P, makespan_ps, baseline_ps, speedup,
       parallel_fraction, machine, level, formulation, solver, operators, run_id
FROM shown WHERE (SELECT count(DISTINCT panel) FROM shown) > 1 -- one machine alone is not a comparison
ORDER BY panel, series, P;
-- table: coincide
, pair AS ( -- curves that lie on each other, within 4 % everywhere
    SELECT a.panel, 'n/P = ' || b.ratio || ' lies on ' || a.ratio AS text, a.ratio AS first, b.ratio AS second
    FROM shown a JOIN shown b ON b.panel = a.panel AND b.P = a.P AND b.ratio > a.ratio
    GROUP BY a.panel, a.ratio, b.ratio HAVING max(abs(a.speedup / b.speedup - 1)) < 0.04)
SELECT panel, group_concat(text, '; ') AS text FROM (SELECT * FROM pair ORDER BY panel, first, second) GROUP BY panel
UNION ALL SELECT 0, '';

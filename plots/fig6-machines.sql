-- Figure 6 for several machines side by side, the paper's four first: speedup of the complete dynamics for n = P, relative
-- to the same code on one processor, to the fastest serial code, and to each serial code that does the same work. The
-- panels of a row have the same axes. The composite-body code (rnea+crba) takes O(n^3) operations: over it the speedup
-- grows faster than P.
-- needs: mimdsim paper fig6-machines
-- shared:
WITH point AS (
    SELECT *, CASE WHEN machine LIKE 't3e%' THEN 1 WHEN machine LIKE 'paragon%' THEN 2
                   WHEN machine LIKE 'origin%' THEN 3 WHEN machine LIKE 'quad-ppro%' THEN 4 ELSE 5 END AS family
    FROM v_speedup
    WHERE kernel = 'dynamics' AND n = P AND n > 1 AND base = 'fixed' AND baseline <> 'rnea'
          AND solver <> 'partition' AND ifnull(compute_noise_cv, 0) = 0 AND ifnull(background_load, 0) = 0
          AND run_id IN (SELECT id FROM run JOIN v_shown ON run_id = id WHERE placement = 'linear' AND scenario <> 'paper-scaling')),
-- one variant of each machine of the paper: the one with the paper's own message software comes first by name
chosen AS (
    SELECT *, row_number() OVER (PARTITION BY family, iif(family = 5, machine, ''), baseline, n
                                 ORDER BY length(machine), level <> 'loggp' DESC, level = 'link' DESC,
                                          formulation = 'paper' DESC, operators = 'structured' DESC,
                                          precision = 'double' DESC, run_id DESC) AS choice,
           dense_rank() OVER (ORDER BY family, iif(family = 5, machine, '')) AS panel
    FROM point),
shown AS (SELECT * FROM chosen WHERE choice = 1 AND panel <= 8)
-- main:
SELECT panel, dense_rank() OVER (ORDER BY baseline <> 'fastest serial', baseline_ordinal, baseline) AS series,
       replace(baseline, ',', ' –') AS baseline, P, makespan_ps, baseline_ps, speedup, parallel_fraction,
       (SELECT replace(l.name, ',', '‚') FROM v_label l WHERE l.run_id = shown.run_id) AS machine, level,
       formulation, solver, operators, run_id
FROM shown WHERE (SELECT count(DISTINCT panel) FROM shown) > 1 -- one machine alone is not a comparison
ORDER BY panel, series, P;
-- table: coincide
, pair AS ( -- curves that lie on each other, within 4 % everywhere
    SELECT a.panel, replace(replace(b.baseline, 'rnea+', ''), ',', ' –') || ' lies on ' || replace(replace(a.baseline, 'rnea+', ''), ',', ' –') AS text,
           a.baseline AS first, b.baseline AS second
    FROM shown a JOIN shown b ON b.panel = a.panel AND b.P = a.P AND b.baseline_ordinal > a.baseline_ordinal
         AND a.baseline <> 'fastest serial' AND b.baseline <> 'fastest serial'
    GROUP BY a.panel, a.baseline, b.baseline HAVING max(abs(a.speedup / b.speedup - 1)) < 0.04)
SELECT panel, group_concat(text, '; ') AS text FROM (SELECT * FROM pair ORDER BY panel, first, second) GROUP BY panel
UNION ALL SELECT 0, '';

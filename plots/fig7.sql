-- Figure 7: the block tridiagonal solver of the forward dynamics (stage CFA[2]) on the Paragon for up to 256 processors
-- and several n: left its speedup over the best serial solver (the same stage on one processor), right over
-- conventional PCR on the same number of processors, by the mean time of the stage over the ranks. Each stored solver has a
-- curve, because the variant of the paper is not known.
-- needs: mimdsim paper fig7
WITH solve AS (
    SELECT r.*, CASE r.solver WHEN 'partition' THEN 'partition + ' || r.part_solver ELSE r.solver END AS method,
           s.total_sum_ps / (1.0 * r.P) AS stage_ps,
           row_number() OVER (PARTITION BY r.n, r.P, r.solver, CASE r.solver WHEN 'partition' THEN r.part_solver END,
                                           r.formulation, r.level = 'loggp'
                              ORDER BY r.operators = 'structured' DESC, r.level = 'link' DESC, r.id DESC) AS choice
    FROM run r JOIN stage s ON s.run_id = r.id AND s.name = 'CFA[2]'
    WHERE r.id IN (SELECT run_id FROM v_shown) AND r.machine LIKE 'paragon%' AND r.kernel IN ('forward', 'dynamics') AND r.scenario NOT IN ('fig6-machines', 'fig9-machines')
          AND r.base = 'fixed'
          AND ifnull(r.compute_noise_cv, 0) = 0 AND ifnull(r.background_load, 0) = 0),
one AS (SELECT * FROM solve WHERE choice = 1),
formulation AS (SELECT formulation AS name FROM one GROUP BY 1 ORDER BY count(*) DESC, 1 = 'paper' DESC LIMIT 1),
-- contention wherever it is stored
point AS (
    SELECT a.* FROM one a WHERE formulation = (SELECT name FROM formulation)
        AND (level <> 'loggp' OR NOT EXISTS (SELECT 1 FROM one b WHERE b.n = a.n AND b.P = a.P AND b.method = a.method
                                             AND b.formulation = a.formulation AND b.level <> 'loggp'))),
serial AS (SELECT n, min(stage_ps) AS serial_ps FROM point WHERE P = 1 GROUP BY n),
conventional AS (SELECT n, P, stage_ps AS conventional_ps FROM point WHERE solver = 'pcr'),
-- groups: n = P, and each n of which there is a curve over P
size AS (SELECT n, row_number() OVER (ORDER BY n) AS place FROM point WHERE P > 1 AND n > P
         GROUP BY n HAVING count(DISTINCT P) >= 3 ORDER BY n DESC LIMIT 3),
grouped AS (
    SELECT p.*, 0 AS size FROM point p WHERE p.n = p.P
    UNION ALL SELECT p.*, p.n AS size FROM point p JOIN size z ON z.n = p.n)
SELECT dense_rank() OVER (ORDER BY g.size) AS panel, iif(g.size = 0, 'n = P', 'n = ' || g.size) AS size,
       dense_rank() OVER (ORDER BY g.solver = 'pcr' DESC, g.method) AS series, g.method, g.n, g.P, g.stage_ps,
       s.serial_ps, c.conventional_ps, s.serial_ps / g.stage_ps AS over_serial,
       c.conventional_ps / g.stage_ps AS over_conventional,
       (SELECT replace(l.name, ',', '‚') FROM v_label l WHERE l.run_id = g.id) AS machine, g.level, g.formulation, g.id AS run_id
FROM grouped g LEFT JOIN serial s ON s.n = g.n LEFT JOIN conventional c ON c.n = g.n AND c.P = g.P
WHERE g.P > 1
ORDER BY panel, series, g.P;

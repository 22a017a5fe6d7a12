-- statement: On the Paragon the modified cyclic reduction beats the best serial solver and conventional parallel reduction.
-- test: time of CFA[2] at P = 16 .. 256: less than for the best serial solver and for conventional PCR, at every P
-- unit: smallest speedup over the faster of the two
-- designated: partition + pcr, n = 256
-- judged: the paper does not specify its variant. It calls it a modified distribution of the rows of parallel cyclic reduction
--   for more bodies than processors: of the solvers here only "partition + pcr" changes the distribution of the rows and
--   keeps PCR for the rest. It does not give n either: 256 puts 1 to 16 bodies on each of 256 to 16 processors, the range of the
--   paper's study of packing (figure 9). Level link, structured operators. It has to be faster at every P from 16 on.
-- points: paragon, forward, n = 256 at level link: thomas on 1 processor, pcr and partition + pcr on 16 and 256
-- needs: mimdsim paper fig7
-- explore: sample-paragon n=256
-- All other candidates are shown: five solvers, with n = 256 and n = 1024.
WITH solve AS (
    SELECT r.n, r.P, CASE r.solver WHEN 'partition' THEN 'partition + ' || r.part_solver ELSE r.solver END AS method,
           min(s.total_sum_ps / (1.0 * r.P)) AS stage_ps
    FROM run r JOIN stage s ON s.run_id = r.id AND s.name = 'CFA[2]' JOIN v_machine_state m ON m.run_id = r.id
    WHERE (m.state = 'as shipped' OR ?1 IN ('what-if', 'explored')) AND r.status = 'ok' AND r.machine = 'paragon' AND r.kernel = 'forward'
          AND r.formulation = 'paper' AND r.base = 'fixed' AND r.model = 'serial-chain' AND r.joint = 'revolute'
          AND r.level = 'link' AND r.precision = 'double' AND r.operators = 'structured'
          AND r.placement = 'linear' AND (?1 = 'explored' OR ifnull(r.compute_noise_cv, 0) = 0 AND ifnull(r.background_load, 0) = 0)
    GROUP BY 1, 2, 3),
candidate AS (SELECT DISTINCT n, method FROM solve WHERE P >= 16 AND n >= 256 AND method NOT IN ('pcr', 'thomas')),
wanted AS (
    SELECT n, method, 'thomas' AS needed, 1 AS P FROM candidate
    UNION ALL SELECT n, method, 'pcr', p.P FROM candidate, (SELECT 16 AS P UNION SELECT 256) p
    UNION ALL SELECT n, method, method, p.P FROM candidate, (SELECT 16 AS P UNION SELECT 256) p),
gap AS (
    SELECT w.n, w.method, group_concat(format('n = %d, %s on %d', w.n, w.needed, w.P), '; ') AS missing
    FROM wanted w WHERE NOT EXISTS (SELECT 1 FROM solve s WHERE s.n = w.n AND s.P = w.P AND s.method = w.needed)
    GROUP BY w.n, w.method),
serial AS (SELECT n, min(stage_ps) AS ps FROM solve WHERE P = 1 GROUP BY n),
conventional AS (SELECT n, P, stage_ps AS ps FROM solve WHERE method = 'pcr'),
gain AS (
    SELECT v.n, v.P, v.method, s.ps / v.stage_ps AS over_serial, c.ps / v.stage_ps AS over_pcr
    FROM solve v JOIN candidate USING (n, method) LEFT JOIN serial s ON s.n = v.n
         LEFT JOIN conventional c ON c.n = v.n AND c.P = v.P
    WHERE v.P >= 16)
SELECT method || ', n = ' || n AS variant, min(min(over_serial, over_pcr)) AS value, 1.0 AS threshold,
       min(min(over_serial, over_pcr)) > 1 AS holds, max(missing) AS missing,
       format('%.2f to %.2f times as fast as the best serial solver, %.2f to %.2f times as conventional PCR',
              min(over_serial), max(over_serial),
              min(over_pcr), max(over_pcr)) AS note, min(min(over_serial, over_pcr)) - 1 AS margin
FROM gain LEFT JOIN gap USING (n, method) GROUP BY n, method ORDER BY variant;

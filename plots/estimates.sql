-- What the analytic estimates predicted for the claims, and what the simulator found.
SELECT 'f > 0.97 from P of about 45 (C2) only for dense operators relative to the same code on one processor' AS estimate,
       iif((SELECT group_concat(variant, '; ') FROM claim WHERE id = 'C2' AND variant <> '' AND verdict = 'pass')
               = 'parallel code on one processor, dense', 'confirmed',
           iif((SELECT count(*) FROM claim WHERE id = 'C2' AND variant <> '' AND share > 0
                    AND variant <> 'parallel code on one processor, dense') = 0, 'confirmed in part', 'refuted')) AS verdict,
       ifnull((SELECT 'relative to the same code, dense: ' || note || iif(value IS NULL, '', format('; crossed at P = %d', value)) ||
                      iif(share IS NULL, '', format('; in %d %% of the samples from 33 to 64', round(100 * share)))
               FROM claim WHERE id = 'C2' AND variant = 'parallel code on one processor, dense'), 'not judged') ||
       ifnull('; other variants that reach it in some samples: ' ||
              (SELECT group_concat(variant, ', ') FROM claim WHERE id = 'C2' AND variant <> '' AND share > 0
                   AND variant <> 'parallel code on one processor, dense'), '; no other variant reaches it in any sample') AS found
UNION ALL
SELECT 'contention on the torus costs about 4 % at P = 128 and cannot make the drop of C3',
       CASE (SELECT max(verdict = 'pass') FROM claim WHERE id = 'C3' AND variant LIKE '%,%')
            WHEN 0 THEN 'no drop: confirmed; ' ||
                 (SELECT iif(max(excess) BETWEEN 2 AND 6, 'the cost: confirmed', format('the cost: refuted, at most %.1f %%', max(excess)))
                  FROM (SELECT 100.0 * (a.makespan_ps - b.makespan_ps) / b.makespan_ps AS excess
                        FROM run a JOIN run b ON b.machine = a.machine AND b.n = a.n AND b.P = a.P AND b.kernel = a.kernel
                             AND b.operators = a.operators AND b.solver = a.solver AND b.formulation = a.formulation
                             AND b.scenario = a.scenario AND b.level = 'loggp' AND a.level = 'link'
                        WHERE a.machine = 't3e-300' AND a.n = a.P AND a.P = 128 AND a.id IN (SELECT run_id FROM v_shown)
                              AND b.id IN (SELECT run_id FROM v_shown)))
            WHEN 1 THEN 'refuted' ELSE 'not judged' END,
       ifnull((SELECT group_concat(variant || ': ' || note, '; ') FROM claim WHERE id = 'C3'
               AND variant LIKE 'parallel code on one processor, %'), 'not judged')
UNION ALL
SELECT 'a shared machine, noise or scattered placement could make the drop of C3',
       CASE WHEN EXISTS (SELECT 1 FROM claim WHERE id = 'C3' AND variant <> '' AND variant NOT LIKE '%,%' AND verdict = 'pass'
                         AND variant NOT LIKE '%128 only') THEN 'confirmed'
            WHEN EXISTS (SELECT 1 FROM claim WHERE id = 'C3' AND variant LIKE '%128 only' AND verdict = 'pass')
            THEN 'refuted when all runs share alike; confirmed when only the largest does, for: ' ||
                 (SELECT group_concat(variant, ', ') FROM claim WHERE id = 'C3' AND variant LIKE '%128 only' AND verdict = 'pass')
            WHEN EXISTS (SELECT 1 FROM claim WHERE id = 'C3' AND variant LIKE '%128 only') THEN 'refuted' ELSE 'not judged' END,
       ifnull((SELECT group_concat(variant || format(': S(128) / best of fewer = %.2f, ', value) || note, '; ') FROM claim
               WHERE id = 'C3' AND variant <> '' AND variant NOT LIKE '%,%'), 'not judged')
UNION ALL
SELECT 'more bodies per processor increase S but do not lower f: the second half of C7 is not reproduced',
       CASE (SELECT max(verdict = 'pass') FROM claim WHERE id = 'C7' AND variant NOT LIKE '%: %' AND variant <> '')
            WHEN 0 THEN iif(EXISTS (SELECT 1 FROM claim WHERE id = 'C7' AND variant LIKE 'same n: %' AND verdict = 'pass'),
                            'confirmed at the same P; at the same n the claim holds', 'confirmed')
            WHEN 1 THEN 'refuted' ELSE 'not judged' END,
       ifnull((SELECT group_concat(variant || ': ' || note, '; ') FROM claim WHERE id = 'C7'
               AND variant IN ('fastest serial, structured', 'parallel code on one processor, dense',
                               'same n: fastest serial, structured', 'same n: parallel code on one processor, dense')), 'not judged');

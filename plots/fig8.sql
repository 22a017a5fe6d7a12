-- Figure 8: timeline of the ranks at n = P = 4 on the Origin2000, in microseconds.
-- needs: mimdsim paper fig8
WITH chosen AS (
    SELECT id FROM run
    WHERE ?1 IS NOT NULL AND id = ?1 OR ?1 IS NULL AND id IN (SELECT run_id FROM v_shown) AND machine LIKE 'origin2000%' AND kernel = 'dynamics' AND n = 4 AND P = 4
          AND EXISTS (SELECT 1 FROM span WHERE run_id = run.id)
    ORDER BY length(machine), formulation = 'paper' DESC, operators = 'structured' DESC, level <> 'loggp' DESC,
             level = 'link' DESC, id DESC LIMIT 1)
SELECT s.rank, s.stage, t.name, s.kind, s.begin_ps / 1e6 AS begin_us, s.end_ps / 1e6 AS end_us, s.peer, s.bytes,
       (SELECT replace(l.name, ',', '‚') FROM v_label l WHERE l.run_id = s.run_id) AS machine, r.level, r.formulation, r.operators, r.n, r.P, r.makespan_ps / 1e6 AS makespan_us, s.run_id
FROM span s JOIN chosen c ON c.id = s.run_id JOIN run r ON r.id = s.run_id
     LEFT JOIN stage t ON t.run_id = s.run_id AND t.stage = s.stage
ORDER BY s.rank, s.begin_ps, s.span;
-- table: messages
WITH chosen AS (
    SELECT id FROM run
    WHERE ?1 IS NOT NULL AND id = ?1 OR ?1 IS NULL AND id IN (SELECT run_id FROM v_shown) AND machine LIKE 'origin2000%' AND kernel = 'dynamics' AND n = 4 AND P = 4
          AND EXISTS (SELECT 1 FROM span WHERE run_id = run.id)
    ORDER BY length(machine), formulation = 'paper' DESC, operators = 'structured' DESC, level <> 'loggp' DESC,
             level = 'link' DESC, id DESC LIMIT 1)
SELECT a.message, a.rank AS from_rank, b.rank AS to_rank, a.end_ps / 1e6 AS sent_us, b.begin_ps / 1e6 AS received_us,
       a.bytes, a.run_id
FROM span a JOIN span b ON b.run_id = a.run_id AND b.message = a.message AND b.kind = 'recv' AND a.kind = 'send'
     JOIN chosen c ON c.id = a.run_id
ORDER BY a.begin_ps, a.rank;

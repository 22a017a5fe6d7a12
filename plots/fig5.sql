-- Figure 5: how the time of each stage is spent at n = P = 16 and 128 on the Cray T3E. Means over the ranks; their sum
-- over all stages is the makespan. With contention (the most detailed network level stored).
-- needs: mimdsim paper fig5
WITH chosen AS (
    SELECT id, row_number() OVER (PARTITION BY P ORDER BY formulation = 'paper' DESC, operators = 'structured' DESC,
                                  level = 'link' DESC, level <> 'loggp' DESC, precision = 'double' DESC, id DESC) AS choice
    FROM run
    WHERE id IN (SELECT run_id FROM v_shown) AND kernel = 'dynamics' AND n = P AND P IN (16, 128)
          AND machine = (SELECT machine FROM run WHERE id IN (SELECT run_id FROM v_shown) AND kernel = 'dynamics' AND n = P
                         GROUP BY machine ORDER BY machine = 't3e-300' DESC, count(DISTINCT n) DESC, min(id) LIMIT 1)
          AND base = 'fixed' AND ifnull(compute_noise_cv, 0) = 0 AND ifnull(background_load, 0) = 0
          AND placement = 'linear' AND solver <> 'partition')
SELECT v.P, v.stage, v.name, v.compute_mean_ps / 1e6 AS compute_us, v.send_mean_ps / 1e6 AS send_us,
       v.recv_mean_ps / 1e6 AS receive_us, v.wait_mean_ps / 1e6 AS wait_us,
       v.contention_mean_ps / 1e6 AS contention_us, v.total_mean_ps / 1e6 AS total_us,
       v.total_max_ps / 1e6 AS total_max_us, r.makespan_ps / 1e6 AS makespan_us,
       (SELECT replace(l.name, ',', '‚') FROM v_label l WHERE l.run_id = v.run_id) AS machine, v.level, v.formulation,
       v.operators, v.run_id
FROM v_stage v JOIN chosen c ON c.id = v.run_id AND c.choice = 1 JOIN run r ON r.id = v.run_id
ORDER BY v.P, v.stage;

-- statement: Inverse dynamics is finer grained; forward dynamics communicates more but overlaps more.
-- test: at n = P: flops per message inverse < forward, forward sends more bytes, and waits a smaller share of its time
-- unit: flops per message, forward / inverse
-- designated: P = 128, structured
WITH part AS (
    SELECT v.P, v.operators, v.name LIKE 'CFA%' AS forward, 1.0 * sum(v.flops) / sum(v.messages) AS grain,
           sum(v.messages) AS messages, sum(v.sent_bytes) AS bytes,
           sum(v.wait_mean_ps + v.contention_mean_ps) / sum(v.total_mean_ps) AS waiting
    FROM v_stage v JOIN run r ON r.id = v.run_id
    WHERE v.machine = 't3e-300' AND v.kernel = 'dynamics' AND v.formulation = 'paper' AND v.level = 'link'
          AND v.solver IN ('pcr-symmetric', 'pcr') AND v.n = v.P AND v.P IN (16, 128) AND r.base = 'fixed'
          AND r.precision = 'double' AND r.placement = 'linear' AND ifnull(r.compute_noise_cv, 0) = 0
          AND ifnull(r.background_load, 0) = 0 AND (v.name LIKE 'NE%' OR v.name LIKE 'CFA%')
          AND r.id IN (SELECT max(id) FROM run WHERE status = 'ok'
                   GROUP BY machine, level, kernel, formulation, solver, operators, base, precision, placement,
                            compute_noise_cv, background_load, n, P)
    GROUP BY 1, 2, 3)
SELECT format('P = %d, %s', i.P, i.operators) AS variant, f.grain / i.grain AS value, 1.0 AS threshold,
       i.grain < f.grain AND f.bytes > i.bytes AND f.waiting < i.waiting AS holds,
       format('flops per message %d and %d, messages %d and %d, kB sent %.0f and %.0f, waiting %.0f %% and %.0f %%', i.grain,
              f.grain, i.messages, f.messages, i.bytes / 1e3, f.bytes / 1e3, 100 * i.waiting, 100 * f.waiting) AS note
FROM part i JOIN part f ON f.P = i.P AND f.operators = i.operators AND i.forward = 0 AND f.forward = 1
ORDER BY variant;

-- statement: Inverse dynamics is finer grained; forward dynamics communicates more but overlaps more.
-- test: at n = P: fewer flops per message in inverse dynamics; forward dynamics sends more bytes and waits a smaller share of its time
-- unit: flops per message, forward / inverse
-- designated: P = 128, structured
-- judged: the largest machine of the paper, where messages are most important, with structured operators as in the other claims;
--   level link. All three parts have to hold; any difference counts, because the paper gives no numbers.
-- points: t3e-300, dynamics, n = P = 128 at level link
-- needs: mimdsim paper fig5
-- explore: sample-t3e n=16,128 level=link
WITH latest AS (
    SELECT max(r.id) AS id FROM run r JOIN v_machine_state m ON m.run_id = r.id
    WHERE (m.state = 'as shipped' OR ?1 IN ('what-if', 'explored')) AND r.status = 'ok' AND r.machine = 't3e-300' AND r.kernel = 'dynamics'
          AND r.formulation = 'paper' AND r.level = 'link' AND r.solver IN ('pcr-symmetric', 'pcr') AND r.n = r.P
          AND r.P IN (16, 128) AND r.base = 'fixed' AND r.model = 'serial-chain' AND r.joint = 'revolute'
          AND r.precision = 'double' AND r.placement = 'linear' AND (?1 = 'explored' OR ifnull(r.compute_noise_cv, 0) = 0 AND ifnull(r.background_load, 0) = 0)
    GROUP BY r.operators, r.P),
part AS (
    SELECT v.P, v.operators, v.name LIKE 'CFA%' AS forward, 1.0 * sum(v.flops) / sum(v.messages) AS grain,
           sum(v.messages) AS messages, sum(v.sent_bytes) AS bytes,
           sum(v.wait_mean_ps + v.contention_mean_ps) / sum(v.total_mean_ps) AS waiting
    FROM v_stage v WHERE v.run_id IN (SELECT id FROM latest) AND (v.name LIKE 'NE%' OR v.name LIKE 'CFA%')
    GROUP BY 1, 2, 3)
SELECT format('P = %d, %s', i.P, i.operators) AS variant, f.grain / i.grain AS value, 1.0 AS threshold,
       i.grain < f.grain AND f.bytes > i.bytes AND f.waiting < i.waiting AS holds, NULL AS missing,
       format('inverse and forward: flops per message %d and %d, messages %d and %d, kB sent %.0f and %.0f, waiting %.0f %% and %.0f %%', i.grain,
              f.grain, i.messages, f.messages, i.bytes / 1e3, f.bytes / 1e3, 100 * i.waiting, 100 * f.waiting) AS note,
       min(f.grain / i.grain, 1.0 * f.bytes / i.bytes, i.waiting / f.waiting) - 1 AS margin
FROM part i JOIN part f ON f.P = i.P AND f.operators = i.operators AND i.forward = 0 AND f.forward = 1
ORDER BY variant;

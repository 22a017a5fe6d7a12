-- Load of every link of one run on a mesh or torus: the share of the run during which the link leaving each router in each
-- direction was busy, and how long messages waited for it. The stored run with the longest waiting time is shown.
-- needs: mimdsim run bisection   (any scenario with record: {links: true} on a mesh or torus)
WITH RECURSIVE candidate AS (
    SELECT r.id, v.value AS dims,
           row_number() OVER (ORDER BY sum(l.queue_ps) DESC, sum(l.busy_ps) DESC, r.id DESC) AS choice
    FROM run r JOIN link_load l ON l.run_id = r.id AND l.from_router IS NOT NULL AND l.to_router IS NOT NULL
         JOIN v_setting v ON v.run_id = r.id AND v.key = 'machine.topology.dims'
    WHERE r.status = 'ok' AND r.topology IN ('torus', 'mesh') GROUP BY r.id),
chosen AS (SELECT id, dims FROM candidate WHERE choice = 1),
dimension AS (
    SELECT 0 AS d, 1 AS stride, CAST(dims ->> '$[0]' AS INTEGER) AS k, dims FROM chosen
    UNION ALL
    SELECT d + 1, stride * k, CAST(dims ->> format('$[%d]', d + 1) AS INTEGER), dims FROM dimension
    WHERE d + 1 < json_array_length(dims)),
step AS (
    SELECT l.*, i.d, i.k, (l.to_router / i.stride) % i.k - (l.from_router / i.stride) % i.k AS difference,
           count(*) OVER (PARTITION BY l.from_router, l.to_router ORDER BY l.link) AS copy
    FROM link_load l JOIN chosen c ON c.id = l.run_id
         JOIN dimension i ON (l.to_router / i.stride) % i.k <> (l.from_router / i.stride) % i.k
    WHERE l.from_router IS NOT NULL AND l.to_router IS NOT NULL),
directed AS (
    SELECT *, CASE WHEN (difference + k) % k = 1 AND copy = 1 THEN 0 ELSE 1 END AS down FROM step)
SELECT 2 * s.d + s.down + 1 AS panel, substr('xyzuvwst', s.d + 1, 1) || iif(s.down, '−', '+') AS direction,
       s.from_router % (SELECT k FROM dimension WHERE d = 0) AS x,
       s.from_router / (SELECT k FROM dimension WHERE d = 0) AS y,
       s.from_router, s.to_router, s.messages, s.sent_bytes, s.busy_ps / 1e6 AS busy_us,
       1.0 * s.busy_ps / r.makespan_ps AS busy_share, s.queue_ps / 1e6 AS queue_us,
       (SELECT replace(l.name, ',', '‚') FROM v_label l WHERE l.run_id = r.id) AS machine, r.topology,
       replace(c.dims, ',', ' x') AS dims, r.level, r.kernel, r.n, r.P, r.scenario, r.id AS run_id
FROM directed s JOIN run r ON r.id = s.run_id JOIN chosen c ON c.id = r.id
ORDER BY panel, y, x;

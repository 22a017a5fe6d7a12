-- One-way time against message size on the simulated machines, compared with published values. Published rates and round
-- trips are converted to one-way times; an empty message is drawn at 4 bytes.
-- needs: mimdsim run pingpong-machines && mimdsim validate all
WITH size AS (
    SELECT r.id, r.machine, 1.0 * r.sent_bytes / r.messages AS bytes, r.measured_s * 1e6 AS us,
           row_number() OVER (PARTITION BY r.machine, r.sent_bytes / r.messages ORDER BY r.id DESC) AS choice
    FROM run r
    WHERE r.kernel = 'pingpong' AND r.P = 2 AND r.status = 'ok' AND r.placement = 'linear'
          AND ifnull(r.background_load, 0) = 0 AND ifnull(r.compute_noise_cv, 0) = 0),
published AS (
    SELECT subject AS machine, CAST(at AS REAL) AS bytes, class,
           CASE quantity WHEN 'one-way' THEN reference WHEN 'round-trip' THEN reference / 2
                         WHEN 'bandwidth' THEN CAST(at AS REAL) / reference END
           * CASE unit WHEN 'ns' THEN 1e-3 ELSE 1 END AS us
    FROM check_point
    WHERE suite = 'machines' AND quantity IN ('one-way', 'round-trip', 'bandwidth') AND verdict <> 'not-testable'),
machine AS (
    SELECT machine, row_number() OVER (ORDER BY us DESC, machine) AS series FROM size WHERE choice = 1 AND bytes = 0)
SELECT m.series, m.machine, s.bytes, max(s.bytes, 4) AS shown_bytes, s.us, 'simulated' AS kind, '' AS class, s.id AS run_id
FROM size s JOIN machine m ON m.machine = s.machine WHERE s.choice = 1
UNION ALL
SELECT m.series, m.machine, p.bytes, max(p.bytes, 4), p.us, 'published', p.class, NULL
FROM published p JOIN machine m ON m.machine = p.machine
ORDER BY series, kind DESC, bytes;

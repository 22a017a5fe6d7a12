-- What the uncertain parameters of the machine leave open: the band in which 90 % of the predicted times lie, and the
-- parameters that it comes from, by their share of the variance (Sobol' indices with standard errors).
-- needs: mimdsim run speedup-t3e --uncertainty 64
-- each: SELECT DISTINCT r.scenario, 'uncertainty-' || r.scenario FROM run r JOIN uncertainty u ON u.run_id = r.id ORDER BY 1
WITH known AS (
    SELECT r.id AS run_id, r.label || ', ' || r.level || ', ' || r.kernel AS curve, r.P, r.n, u.nominal, u.low, u.median, u.high, u.samples
    FROM run r JOIN uncertainty u ON u.run_id = r.id WHERE r.scenario = ?1 AND u.quantity = 'makespan_ps'),
-- what differs between the runs is the axis: P, else n, else their order
axis AS (
    SELECT CASE WHEN count(DISTINCT P) > 1 THEN 'number of ranks P' WHEN count(DISTINCT n) > 1 THEN 'size n' ELSE 'run' END AS name
    FROM known),
placed AS (
    SELECT k.*, a.name AS axis, CASE a.name WHEN 'number of ranks P' THEN P WHEN 'size n' THEN n
           ELSE row_number() OVER (ORDER BY run_id) END AS x FROM known k, axis a),
size AS (SELECT curve, min(run_id) AS first FROM placed GROUP BY curve),
place AS (SELECT curve, row_number() OVER (ORDER BY first) AS series FROM size)
SELECT p.series, replace(c.curve, ',', ' –') AS curve, c.x, c.axis, c.nominal / 1e9 AS nominal_ms, c.low / 1e9 AS low_ms,
       c.median / 1e9 AS median_ms, c.high / 1e9 AS high_ms, c.samples, ?1 AS scenario, c.run_id
FROM placed c JOIN place p ON p.curve = c.curve WHERE p.series <= 4 ORDER BY p.series, c.x;
-- table: shares
WITH share AS (
    SELECT s.key, s.class, s.printed, avg(s.first) AS first, avg(s.first_error) AS first_error, avg(s.total) AS total,
           avg(s.total_error) AS total_error, min(s.total) AS least, max(s.total) AS most
    FROM uncertainty_share s JOIN run r ON r.id = s.run_id
    WHERE r.scenario = ?1 AND s.quantity = 'makespan_ps' AND s.first IS NOT NULL GROUP BY s.key)
SELECT row_number() OVER (ORDER BY total DESC, key) AS place,
       substr(key, 9) || ' (' || class || iif(printed, '', ' – range by class') || ')' AS parameter,
       100 * first AS first_percent, 100 * first_error AS first_error_percent, 100 * total AS total_percent,
       100 * total_error AS total_error_percent, 100 * least AS least_percent, 100 * most AS most_percent
FROM share ORDER BY 1 LIMIT 10;

-- Latency and accepted load of networks against offered load, a drawing for each traffic: machines, routings and levels
-- are curves. A load of 1 is one flit per node and cycle of a link.
-- needs: mimdsim load t3e-300 --level packet
-- each: SELECT DISTINCT traffic, 'load-' || traffic FROM load_series WHERE series IN (SELECT series FROM load_point) ORDER BY 1
WITH shown AS (SELECT * FROM load_series WHERE traffic = ?1),
-- a curve is called by what tells it from the others
differ AS (
    SELECT count(DISTINCT machine) > 1 AS machine, count(DISTINCT routing) > 1 AS routing, count(DISTINCT level) > 1 AS level,
           count(DISTINCT ifnull(message_bytes, 0)) > 1 AS size FROM shown),
place AS (
    SELECT s.*, row_number() OVER (ORDER BY s.machine, s.routing, s.level, s.message_bytes, s.series) AS curve,
           iif(d.machine OR NOT (d.routing OR d.level OR d.size), s.machine || ' ', '') || iif(d.routing, s.routing || ' ', '')
           || iif(d.level, s.level || ' ', '') || iif(d.size, s.message_bytes || ' B ', '') AS name
    FROM shown s, differ d)
-- gnuplot ends a quoted text at its first comma
SELECT p.curve, replace(trim(p.name), ',', '‚') AS name, x.offered, x.accepted, x.mean_ps / 1e3 AS mean_ns, x.half_ps / 1e3 AS half_ns,
       x.p99_ps / 1e3 AS p99_ns, x.status, p.empty_ps / 1e3 AS empty_ns, p.bound, p.saturation, p.saturation_low AS low,
       p.saturation_high AS high, replace(?1, ',', '‚') AS traffic
FROM place p JOIN load_point x ON x.series = p.series
WHERE p.curve <= 6
ORDER BY p.curve, x.offered, x.probe;

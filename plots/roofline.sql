-- Computing against communication of one run, by stage: rates of one processor over operations for each byte sent.
-- needs: mimdsim why speedup-t3e --set n=128
-- each: SELECT DISTINCT run_id, 'roofline-' || run_id FROM roofline ORDER BY 1
WITH r AS (SELECT * FROM run WHERE id = CAST(?1 AS INTEGER)),
x AS (SELECT * FROM roofline WHERE run_id = CAST(?1 AS INTEGER) AND sent_bytes > 0 AND ordinal > 0)
SELECT row_number() OVER (ORDER BY x.ordinal) AS series, replace(x.stage, ',', ' –') AS stage,
       x.flops / x.sent_bytes AS intensity, x.attained / 1e6 AS attained, x.software / 1e6 AS software,
       x.lowest, format('%s: %.3g Mflop/s', replace(x.stage, ',', ' –'), x.attained / 1e6) AS told,
       -- the port's line is the same for all stages but where the rate depends on the size of messages
       (SELECT min(y.bandwidth * y.sent_bytes / y.flops) FROM x y) / 1e6 AS port,
       (SELECT max(y.computing) FROM x y) / 1e6 AS peak,
       r.id AS run_id,
       format('Computing against communication of %s on %s: n = %d; P = %d; level %s', r.kernel,
              (SELECT replace(l.name, ',', '‚') FROM v_label l WHERE l.run_id = r.id), r.n, r.P, r.level) AS title
FROM x, r ORDER BY x.ordinal;

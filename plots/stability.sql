-- The stability suite: every stiff or extreme case against every algorithm: ok, degraded or failed, and how wrong.
-- needs: mimdsim stability
WITH cases AS (SELECT subject, row_number() OVER (ORDER BY min(ordinal), subject) AS y FROM stability GROUP BY subject),
algorithms AS (SELECT algorithm, precision, row_number() OVER (ORDER BY precision <> 'double', min(ordinal), algorithm) AS x
               FROM stability GROUP BY algorithm, precision)
SELECT a.x, c.y, s.subject, s.algorithm || iif(s.precision = 'double', '', ' (' || s.precision || ')') AS algorithm, s.status,
       s.relative_error, CASE s.status WHEN 'ok' THEN 0 WHEN 'degraded' THEN 1 ELSE 2 END AS grade,
       CASE WHEN s.relative_error IS NULL THEN iif(s.status = 'failed', '×', '–') WHEN s.relative_error = 0 THEN '0'
            ELSE format('%d', round(log10(s.relative_error))) END AS decade,
       s.residual, s.condition, s.growth, s.refinements, s.energy_drift, s.step_s, s.reason
FROM stability s JOIN cases c ON c.subject = s.subject
     JOIN algorithms a ON a.algorithm = s.algorithm AND a.precision = s.precision
ORDER BY c.y, a.x;

-- What would make a claim hold: the plane of the two most important parameters, with the others as in the answer. Each cell is
-- a simulated point, judged by the query of the claim.
-- needs: mimdsim claims --explain paper.db
-- each: SELECT DISTINCT subject, 'explain-' || subject FROM explain_map ORDER BY length(subject), subject
WITH answer AS (
    SELECT * FROM explain_answer WHERE subject = ?1 ORDER BY verdict <> 'holds', goal = 'any' LIMIT 1)
SELECT m.i, m.j, m.x, m.y, m.x_low, m.x_high, m.y_low, m.y_high, m.x_nominal, m.y_nominal, m.x_answer, m.y_answer,
       m.x_label, m.y_label, m.x_key LIKE 'noise.%' AS x_share, m.y_key LIKE 'noise.%' AS y_share,
       max(-1.0, min(1.0, j.margin)) AS margin, j.value, j.holds, a.verdict, m.subject,
       (SELECT replace(statement, ',', '‚') FROM claim WHERE id = m.subject AND variant = '') AS statement,
       replace(m.variant, ',', '‚') AS variant, p.settings
FROM explain_map m JOIN explain_point p ON p.id = m.point_id JOIN answer a
     LEFT JOIN explain_judged j ON j.point_id = m.point_id AND j.claim = m.subject AND j.variant = m.variant
WHERE m.subject = ?1 ORDER BY m.j, m.i;

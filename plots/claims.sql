-- The claims of the paper against serial baselines and machines: whether each holds, and in which share of the samples of
-- the uncertain machine parameters.
-- needs: mimdsim claims
WITH claims AS (SELECT id, row_number() OVER (ORDER BY length(id), id) AS y FROM claim GROUP BY id),
variants AS (SELECT variant, row_number() OVER (ORDER BY variant <> '', variant) AS x FROM claim GROUP BY variant)
SELECT v.x, y.y, c.id, replace(c.statement, ',', ' –') AS statement,
       iif(c.variant = '', 'verdict', replace(c.variant, ',', ' –')) AS variant, c.verdict,
       CASE c.verdict WHEN 'pass' THEN 0 WHEN 'not-testable' THEN 1 ELSE 2 END AS grade,
       c.value, c.unit, c.threshold, c.value_low, c.value_high, c.share, c.samples,
       CASE WHEN c.share IS NOT NULL THEN format('%d %%', round(100 * c.share)) WHEN c.verdict = 'pass' THEN 'yes'
            WHEN c.verdict = 'fail' THEN 'no' ELSE '–' END AS mark
FROM claim c JOIN claims y ON y.id = c.id JOIN variants v ON v.variant = c.variant
ORDER BY y.y, v.x;

-- Work-precision diagram: the error of every rung of a scenario's ladders against the host's seconds and against the
-- seconds that the simulated machine would take. An error of nothing is drawn at the bottom; rungs that failed have no
-- error and are listed below the figure, never dropped.
-- needs: mimdsim accuracy scenarios/speedup-t3e.yaml
WITH one AS (SELECT min(scenario) AS scenario FROM ladder),
rung AS (
    SELECT l.*, dense_rank() OVER (ORDER BY CASE l.ladder WHEN 'network' THEN 1 WHEN 'arithmetic' THEN 2
                                                          WHEN 'integration' THEN 3 ELSE 4 END, l.ladder) AS panel
    FROM ladder l JOIN one o ON o.scenario = l.scenario
    WHERE l.quantity = (SELECT quantity FROM ladder q WHERE q.scenario = l.scenario AND q.ladder = l.ladder
                        ORDER BY ordinal LIMIT 1)
          AND l.at = (SELECT at FROM ladder q WHERE q.scenario = l.scenario AND q.ladder = l.ladder
                      ORDER BY machine_ps DESC LIMIT 1))
SELECT panel, ladder, dense_rank() OVER (PARTITION BY panel ORDER BY method) AS series, replace(method, ',', ' –') AS method,
       replace(rung, ',', ' –') AS rung, at, quantity, reference, relative_error,
       iif(relative_error = 0, 1e-20, relative_error) AS shown_error, host_s, machine_ps / 1e12 AS machine_s, status, scenario,
       coalesce((SELECT group_concat(replace(method, ',', ' –') || ' (' || n || ')', '; ')
        FROM (SELECT method, count(*) AS n FROM rung f WHERE f.panel = rung.panel AND f.status = 'failed'
              GROUP BY method ORDER BY min(ordinal))) , 'none') AS failed
FROM rung
ORDER BY panel, series, ordinal;

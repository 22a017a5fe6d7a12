-- The stability suite, or the scenes of one scenario: stiff or extreme cases with every algorithm, a drawing for each group of
-- cases and one for the motions: ok, degraded or failed, and the power of ten of the error. For motions of stiff scenes each
-- cell has error, step, evaluations (if not run: the number needed) and energy drift.
-- needs: mimdsim stability
-- each: SELECT json_array(suite, d), 'stability-' || suite || '-' || d, 'stability-' || suite FROM (SELECT suite, ordinal, CASE WHEN algorithm LIKE 'own %' OR algorithm IN ('rk2', 'rk4', 'rkf45', 'rkck', 'rk8pd', 'msadams', 'rk1imp', 'rk2imp', 'rk4imp', 'bsimp', 'msbdf') THEN 'motions' WHEN suite <> 'suite' THEN 'cases' WHEN subject LIKE 'mass %' OR subject LIKE 'slender%' OR subject LIKE 'nearly points%' THEN 'masses' WHEN subject LIKE 'springs %' THEN 'springs' WHEN subject LIKE 'length %' OR subject LIKE 'molecular %' OR subject LIKE 'pose %' OR subject LIKE 'rates %' OR subject LIKE 'torques %' OR subject LIKE 'zero gravity%' OR subject LIKE 'denormal%' THEN 'loads' WHEN subject LIKE 'star %' OR subject LIKE 'comb %' OR subject LIKE 'dendrimer %' OR subject LIKE '%tree%' OR subject LIKE 'four-bar%' OR subject LIKE 'redundant%' OR subject LIKE '%loop%' THEN 'trees' ELSE 'sizes' END AS d FROM stability) GROUP BY suite, d ORDER BY suite <> 'suite', suite, min(ordinal)
-- shared:
WITH mine AS (
    SELECT * FROM (
        SELECT *, algorithm LIKE 'own %' OR algorithm IN ('rk2', 'rk4', 'rkf45', 'rkck', 'rk8pd', 'msadams', 'rk1imp', 'rk2imp',
           'rk4imp', 'bsimp', 'msbdf') AS motion,
               algorithm IN ('rk1imp', 'rk2imp', 'rk4imp', 'bsimp', 'msbdf', 'own implicit') AS implicit,
               iif(reason GLOB '[0-9]*evaluations*', CAST(reason AS REAL), NULL) AS evaluations,
               CASE WHEN suite <> 'suite' THEN 1 WHEN subject LIKE 'mass %' THEN 1
                    WHEN subject LIKE 'length %' OR subject LIKE 'molecular %' THEN 2 WHEN subject LIKE 'pose %' THEN 3
                    WHEN subject LIKE 'n %' THEN 4 WHEN subject LIKE 'rates %' THEN 5
                    WHEN subject LIKE 'slender%' OR subject LIKE 'nearly points%' THEN 6
                    WHEN subject LIKE 'torques %' OR subject LIKE 'zero gravity%' OR subject LIKE 'denormal%' THEN 7
                    WHEN subject LIKE 'four-bar%' OR subject LIKE 'redundant%' OR subject LIKE '%loop%' THEN 9
                    WHEN subject LIKE 'star %' OR subject LIKE 'comb %' OR subject LIKE 'dendrimer %' OR subject LIKE '%tree%' THEN 8
                    WHEN subject LIKE 'springs %' THEN 10 ELSE 11 END AS part
        FROM stability WHERE suite = ?1 ->> '$[0]')
    WHERE CASE ?1 ->> '$[1]' WHEN 'motions' THEN motion WHEN 'cases' THEN NOT motion WHEN 'masses' THEN NOT motion AND part IN (1, 6)
          WHEN 'loads' THEN NOT motion AND part IN (2, 3, 5, 7) WHEN 'springs' THEN NOT motion AND part = 10
          WHEN 'trees' THEN NOT motion AND part IN (8, 9) ELSE NOT motion AND part IN (4, 11) END),
cases AS (
    SELECT motion, subject, part, row_number() OVER (ORDER BY part, min(ordinal)) AS r,
           dense_rank() OVER (ORDER BY part) AS g, max(condition) AS condition, max(growth) AS growth,
           max(iif(precision = 'double', residual, NULL)) AS residual, max(iif(algorithm LIKE 'motion %', energy_drift, NULL)) AS energy,
           min(iif(implicit OR status <> 'ok', NULL, evaluations)) AS explicit_evaluations,
           min(iif(implicit AND status = 'ok', evaluations, NULL)) AS implicit_evaluations
    FROM mine GROUP BY subject)
-- main:
, algorithms AS (
    SELECT algorithm, precision, row_number() OVER (
           ORDER BY algorithm LIKE 'motion %', precision <> 'double', implicit, algorithm LIKE '%contraction',
           algorithm NOT LIKE 'own %', min(ordinal)) AS x
    FROM mine GROUP BY algorithm, precision)
SELECT m.motion, m.implicit, a.x, iif(m.motion, c.r, c.r + c.g) AS y, m.subject,
       m.algorithm || iif(m.precision = 'double', '', ' (' || m.precision || ')') AS algorithm, m.status, m.relative_error,
       CASE m.status WHEN 'ok' THEN 0 WHEN 'degraded' THEN 1 ELSE 2 END AS grade,
       CASE WHEN m.relative_error IS NULL THEN iif(m.status = 'failed', '×', '–') WHEN m.relative_error = 0 THEN '=0'
            ELSE format('%d', round(log10(m.relative_error))) END AS decade,
       CASE WHEN m.relative_error IS NULL THEN iif(m.status = 'failed', 'gave up', 'not run') WHEN m.relative_error = 0 THEN '=0'
            ELSE format('%.0e', m.relative_error) END AS error_text,
       iif(m.step_s IS NULL, '–', format('%.1e', m.step_s)) AS step_text,
       m.evaluations,
       iif(m.energy_drift IS NULL, '–', iif(m.energy_drift = 0, '=0', format('%.0e', m.energy_drift))) AS drift_text,
       m.residual, m.condition, m.growth, m.refinements, m.energy_drift, m.step_s, replace(m.reason, ',', ' –') AS reason, m.suite,
       CASE ?1 ->> '$[1]' WHEN 'masses' THEN 'masses and inertias' WHEN 'loads' THEN 'lengths; poses; rates and loads'
            WHEN 'sizes' THEN 'sizes; bases and joints' WHEN 'trees' THEN 'branches and loops' WHEN 'motions' THEN 'motions of stiff scenes' ELSE ?1 ->> '$[1]' END AS what
FROM mine m JOIN cases c ON c.subject = m.subject
     JOIN algorithms a ON a.algorithm = m.algorithm AND a.precision = m.precision
ORDER BY m.motion, y, a.x;
-- table: cases
-- a comma would end the name in gnuplot; a scene that is the only one needs no n
SELECT motion, 0 AS heading, iif(motion, r, r + g) AS y, iif((SELECT count(DISTINCT subject) FROM mine) > 1,
       replace(subject, ', ', ': '), substr(subject, 1, instr(subject || ',', ',') - 1)) AS name, condition, growth, residual, energy,
       CASE WHEN NOT motion THEN '' WHEN implicit_evaluations IS NULL AND explicit_evaluations IS NULL THEN 'neither is ok'
            WHEN implicit_evaluations IS NULL THEN 'no implicit is ok' WHEN explicit_evaluations IS NULL THEN 'no explicit is ok'
            ELSE format('%.3g', explicit_evaluations / implicit_evaluations) END AS ratio
FROM cases
UNION ALL
SELECT 0, 1, min(r + g) - 1, CASE WHEN ?1 ->> '$[0]' <> 'suite' THEN 'scenes of the scenario'
       ELSE CASE part WHEN 1 THEN 'masses' WHEN 2 THEN 'lengths' WHEN 3 THEN 'poses' WHEN 4 THEN 'sizes' WHEN 5 THEN 'rates'
                      WHEN 6 THEN 'inertias' WHEN 7 THEN 'loads' WHEN 8 THEN 'branches' WHEN 9 THEN 'loops'
                      WHEN 10 THEN 'springs' ELSE 'bases and joints' END END, NULL, NULL, NULL, NULL, ''
FROM cases WHERE NOT motion GROUP BY part
ORDER BY 1, 3;

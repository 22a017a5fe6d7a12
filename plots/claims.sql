-- The claims of the paper against the serial baselines, with structured and with dense operators: whether each holds, and in
-- which share of the samples of the uncertain machine parameters. The verdict is that of the variant nearest to the text.
-- needs: mimdsim paper
-- In a statement a low quotation mark stands for the comma, which gnuplot's strcol would take for the cell's end.
WITH wide AS (SELECT id, row_number() OVER (ORDER BY substr(id, 1, 1) <> 'C', length(id), id) AS y FROM claim GROUP BY id),
-- claims without a serial baseline are shown by their main measure
cell AS (
    SELECT *, iif(variant = '', 0, iif(variant LIKE '%structured', 1, 2)) AS style,
           CASE WHEN variant = '' THEN 'verdict'
                WHEN variant IN ('structured', 'dense', 'time, structured', 'time, dense', 'P = 128, structured', 'P = 128, dense')
                THEN 'without a baseline' ELSE replace(replace(variant, ', structured', ''), ', dense', '') END AS baseline
    FROM claim WHERE variant = '' OR variant LIKE '%structured' OR variant LIKE '%dense'),
shown AS (SELECT * FROM cell WHERE baseline IN ('verdict', 'without a baseline', 'fastest serial', 'rnea', 'rnea+aba', 'rnea+crba',
                                                'rnea+cfa-paper', 'rnea+cfa-direct', 'parallel code on one processor')),
place AS (SELECT style, baseline, row_number() OVER (ORDER BY style, baseline = 'without a baseline', baseline) AS x
          FROM shown GROUP BY style, baseline)
SELECT v.x, y.y, c.id, replace(c.statement, ',', '‚') AS statement,
       CASE c.style WHEN 0 THEN 'verdict' WHEN 1 THEN 'structured: ' || c.baseline ELSE 'dense: ' || c.baseline END AS variant, c.verdict,
       CASE c.verdict WHEN 'pass' THEN 0 WHEN 'not-testable' THEN 1 ELSE 2 END AS grade,
       c.value, c.unit, c.threshold, c.value_low, c.value_high, c.share, c.samples,
       CASE WHEN c.share IS NOT NULL THEN format('%d %%', round(100 * c.share)) WHEN c.verdict = 'pass' THEN 'yes'
            WHEN c.verdict = 'fail' THEN 'no' ELSE '–' END AS mark
FROM shown c JOIN wide y ON y.id = c.id JOIN place v ON v.style = c.style AND v.baseline = c.baseline
ORDER BY y.y, v.x;

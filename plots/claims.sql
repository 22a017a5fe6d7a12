-- The claims of the paper and all their variants: whether each holds, and in which share of the samples of the uncertain
-- machine parameters. The variant with the thick frame determines the verdict. Claims on the speedup have a cell for each
-- serial code, with structured and with dense operators; the cells of the other claims are labelled.
-- needs: mimdsim paper
WITH split AS ( -- in a text a low quotation mark stands for the comma, which gnuplot's strcol would take for the cell's end
    SELECT c.*, replace(replace(c.variant, 'same n: ', ''), 'speedup only: ', '') AS bare,
           CASE WHEN c.variant = '' THEN 0 WHEN c.variant LIKE 'speedup only: %' THEN 1 WHEN c.variant LIKE 'same n: %' THEN 2
                WHEN c.id = 'C3' AND c.variant NOT LIKE '%, structured' AND c.variant NOT LIKE '%, dense' THEN 3 ELSE 0 END AS part,
           c.variant <> '' AND EXISTS (SELECT 1 FROM claim o WHERE o.id = c.id AND o.variant = ''
               AND substr(o.note, instr(o.note, 'judged for '), length(c.variant) + 12) = 'judged for ' || c.variant || ':') AS nominal
    FROM claim c),
named AS (
    SELECT *, CASE WHEN bare LIKE '%, structured' THEN 1 WHEN bare LIKE '%, dense' THEN 2 ELSE 0 END AS style,
           replace(replace(bare, ', structured', ''), ', dense', '') AS baseline FROM split),
cell AS (
    SELECT *, CASE WHEN variant = '' THEN 'verdict' WHEN part <> 1 AND style > 0 AND baseline IN ('fastest serial', 'rnea', 'rnea+aba',
                        'rnea+crba', 'rnea+cfa-paper', 'rnea+cfa-direct', 'parallel code on one processor') THEN 'baseline'
                   ELSE 'named' END AS kind
    FROM named),
line AS (
    SELECT id, part, row_number() OVER (ORDER BY substr(id, 1, 1) <> 'C', length(id), id, part) AS y FROM cell GROUP BY id, part),
place AS (SELECT style, baseline, row_number() OVER (ORDER BY style, baseline) AS x FROM cell WHERE kind = 'baseline'
          GROUP BY style, baseline),
width AS (SELECT max(14, (SELECT count(*) FROM place)) AS w),
spread AS (
    SELECT id, variant, row_number() OVER (PARTITION BY id, part ORDER BY variant) AS k, count(*) OVER (PARTITION BY id, part) AS m
    FROM cell WHERE kind = 'named')
SELECT CASE c.kind WHEN 'verdict' THEN -0.4 WHEN 'baseline' THEN p.x ELSE 0.5 + (s.k - 0.5) * w.w / s.m END AS x, l.y,
       CASE c.kind WHEN 'verdict' THEN 0.8 WHEN 'baseline' THEN 0.47 ELSE 0.5 * w.w / s.m - 0.03 END AS half,
       c.id, c.kind, replace(c.id || CASE c.part WHEN 0 THEN ': ' || c.statement WHEN 1 THEN ', the speedup alone'
                    WHEN 2 THEN ', f compared at the same n' ELSE ', with the machine shared with others' END, ',', '‚') AS statement,
       CASE c.kind WHEN 'verdict' THEN 'verdict' WHEN 'baseline' THEN iif(c.style = 1, 'structured: ', 'dense: ') || c.baseline
                   ELSE replace(c.bare, ',', '‚') END AS variant,
       CASE WHEN c.kind <> 'named' THEN ' ' WHEN c.bare LIKE '%, %' THEN replace(substr(c.bare, 1, instr(c.bare, ', ') - 1), ' + ', '+')
            ELSE replace(replace(replace(replace(c.bare, ' at 128 only', ''), 'background ', ''), 'computing ', ''), ' placement', '') END AS upper,
       CASE WHEN c.kind <> 'named' THEN ' ' WHEN c.bare LIKE '%, %' THEN substr(c.bare, instr(c.bare, ', ') + 2)
            WHEN c.bare LIKE '% at 128 only' THEN 'at 128 only' ELSE ' ' END AS lower,
       CASE WHEN c.kind <> 'baseline' THEN '' WHEN c.baseline = 'parallel code on one processor' THEN 'same code'
            WHEN c.baseline LIKE 'rnea+cfa-%' THEN 'rnea+cfa' WHEN c.baseline LIKE 'rnea+%' THEN 'rnea' WHEN instr(c.baseline, ' ') > 0 THEN substr(c.baseline, 1, instr(c.baseline, ' ') - 1)
            ELSE c.baseline END AS head,
       CASE WHEN c.kind <> 'baseline' THEN '' WHEN c.baseline = 'parallel code on one processor' THEN 'on 1 proc.'
            WHEN c.baseline LIKE 'rnea+cfa-%' THEN substr(c.baseline, 9) WHEN c.baseline LIKE 'rnea+%' THEN substr(c.baseline, 5) WHEN instr(c.baseline, ' ') > 0 THEN substr(c.baseline, instr(c.baseline, ' ') + 1)
            ELSE '' END AS head2, c.style,
       c.verdict, CASE c.verdict WHEN 'pass' THEN 0 WHEN 'not-testable' THEN 1 ELSE 2 END AS grade, c.nominal,
       c.value, c.unit, c.threshold, c.value_low, c.value_high, c.share, c.samples, w.w AS columns,
       CASE WHEN c.kind = 'verdict' AND c.testable > 0 THEN format('%d of %d', c.holding, c.testable)
            WHEN c.kind <> 'verdict' AND c.share IS NOT NULL THEN format('%d %%', round(100 * c.share))
            WHEN c.verdict = 'pass' THEN 'yes' WHEN c.verdict = 'fail' THEN 'no' ELSE '–' END AS mark
FROM cell c JOIN line l USING (id, part) CROSS JOIN width w LEFT JOIN place p ON p.style = c.style AND p.baseline = c.baseline
     LEFT JOIN spread s ON s.id = c.id AND s.variant = c.variant
ORDER BY l.y, x;

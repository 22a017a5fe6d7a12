-- Summary of the verdicts: the table below the abstract. Why: the values of the row that determines the verdict.
SELECT c.id, c.statement AS claim, c.verdict, iif(c.testable > 0, c.holding || ' of ' || c.testable, '') AS "holds in variants",
       ifnull((SELECT v.note FROM claim v WHERE v.id = c.id AND v.variant <> ''
               AND substr(c.note, instr(c.note, 'judged for '), length(v.variant) + 12) = 'judged for ' || v.variant || ':'), c.note) AS why
FROM claim c WHERE c.variant = '' ORDER BY substr(c.id, 1, 1) <> 'C', length(c.id), c.id;

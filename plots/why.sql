-- What limits one run: its critical path by stage and cause, what each parameter of the machine contributes, idealised machines.
-- needs: mimdsim why speedup-t3e --set n=128
-- each: SELECT DISTINCT run_id, 'why-' || run_id FROM critical_path ORDER BY 1
WITH r AS (SELECT * FROM run WHERE id = CAST(?1 AS INTEGER)),
rows AS (
    SELECT 1 AS panel, row_number() OVER (ORDER BY time_ps DESC, stage, cause) AS y, stage || ': ' || cause AS what,
           time_ps, NULL AS other FROM critical_path WHERE run_id = CAST(?1 AS INTEGER)
    UNION ALL
    SELECT 2, row_number() OVER (ORDER BY abs(time_ps) DESC, key), substr(key, 9), time_ps,
           CASE WHEN factor_5_percent IS NULL THEN '' ELSE format('5 %% longer: %s%.4g', iif(rate, '1/', '×'), factor_5_percent) END
    FROM sensitivity WHERE run_id = CAST(?1 AS INTEGER)
    UNION ALL
    SELECT 3, 1, 'as it is', makespan_ps, '' FROM r
    UNION ALL
    SELECT 3, 1 + row_number() OVER (ORDER BY makespan_ps DESC, machine), machine, makespan_ps, ''
    FROM ideal WHERE run_id = CAST(?1 AS INTEGER) AND makespan_ps IS NOT NULL)
SELECT rows.panel, rows.y, replace(rows.what, ',', ' –') AS what, rows.time_ps / 1e6 AS time_us,
       CASE rows.panel WHEN 3 THEN format('%.4g µs (%.2f×)', rows.time_ps / 1e6, 1.0 * r.makespan_ps / rows.time_ps)
            ELSE format('%.4g µs (%.1f %%)', rows.time_ps / 1e6, 100.0 * rows.time_ps / r.makespan_ps) END AS label,
       rows.other, r.makespan_ps / 1e6 AS makespan_us, r.id AS run_id,
       format('What limits %s on %s: n = %d; P = %d; level %s: %.4g µs', r.kernel, (SELECT replace(l.name, ',', '‚') FROM v_label l WHERE l.run_id = r.id), r.n, r.P, r.level,
              r.makespan_ps / 1e6) AS title
FROM rows, r WHERE rows.y <= 12 ORDER BY rows.panel, rows.y;

-- Several sets of runs side by side: the rows that `mimdsim compare` put into temporary tables.
-- needs: mimdsim compare t3e-300 paragon
-- A comma would end a text for gnuplot: U+201A looks like one.
SELECT place, replace(point, ',', '‚') AS point, x, side, replace(name, ',', '‚') AS name, makespan_s, half_s, compute_s,
       overhead_s, wait_s, contention_s, ratio, bar FROM temp.compare_point ORDER BY side, x, place;
-- table: about
SELECT replace(title, ',', '‚') AS title, replace(errors, ',', '‚') AS errors, sides, shown, points, lines, replace(xlabel, ',', '‚') AS xlabel, xlog
FROM temp.compare_about;

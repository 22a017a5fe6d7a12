-- Curves of a plot by --x and --y: the points that `mimdsim plot` put into temporary tables.
-- needs: mimdsim plot DB --x n --y speedup
-- A comma would end a text for gnuplot: U+201A looks like one.
SELECT panel, replace(panel_name, ',', '‚') AS panel_name, series, replace(curve, ',', '‚') AS curve, xi, x,
       replace(x_text, ',', '‚') AS x_text, value, low, high, rows, run_id
FROM temp.plot_point ORDER BY panel, series, xi;
-- table: about
SELECT replace(title, ',', '‚') AS title, replace(subtitle, ',', '‚') AS subtitle, replace(bands, ',', '‚') AS bands,
       replace(xlabel, ',', '‚') AS xlabel, replace(vlabel, ',', '‚') AS vlabel, xscale, vscale, xlog, vlog, panels, curves, nx,
       ny, band, x_number, longest FROM temp.plot_about;
-- table: runs
SELECT run_id FROM temp.plot_run ORDER BY 1;
-- table: x
SELECT DISTINCT xi, replace(x_text, ',', '‚') AS x_text FROM temp.plot_point
WHERE NOT (SELECT x_number FROM temp.plot_about) ORDER BY 1; -- an axis of numbers has tics of its own

-- Heat map of a plot by --x, --y and --z: the cells that `mimdsim plot` put into temporary tables.
-- needs: mimdsim plot DB --x n --y hop_latency --z speedup
-- A comma would end a text for gnuplot: U+201A looks like one.
SELECT panel, replace(panel_name, ',', '‚') AS panel_name, xi, x, replace(x_text, ',', '‚') AS x_text, yi, y,
       replace(y_text, ',', '‚') AS y_text, value, low, high, rows, run_id
FROM temp.plot_point ORDER BY panel, yi, xi;
-- table: about
SELECT replace(title, ',', '‚') AS title, replace(subtitle, ',', '‚') AS subtitle, replace(bands, ',', '‚') AS bands,
       replace(xlabel, ',', '‚') AS xlabel, replace(ylabel, ',', '‚') AS ylabel, replace(vlabel, ',', '‚') AS vlabel, xscale,
       vscale, xlog, vlog, panels, curves, nx, ny, band, x_number, longest FROM temp.plot_about;
-- table: runs
SELECT run_id FROM temp.plot_run ORDER BY 1;
-- table: x
SELECT DISTINCT xi, replace(x_text, ',', '‚') AS x_text FROM temp.plot_point ORDER BY 1;
-- table: y
SELECT DISTINCT yi, replace(y_text, ',', '‚') AS y_text FROM temp.plot_point ORDER BY 1;

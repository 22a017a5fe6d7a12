-- Timeline of one run: what each rank, or each group of neighbouring ranks, does when; how many ranks do it; the critical path.
-- needs: mimdsim timeline scenarios/fig8.yaml
-- The bars are counted by `mimdsim timeline` into temporary tables. A comma would end a text for gnuplot: U+201A looks like one.
SELECT y, rank, begin_us, end_us, kind, run_id FROM temp.timeline_bar ORDER BY y, begin_us;
-- table: about
SELECT replace(a.title, ',', '‚') AS title, a.rows, a.first_rank, a.last_rank, a.begin_us, a.end_us, a.makespan_us, a.single, a.path,
       (SELECT count(*) FROM temp.timeline_message) AS messages, (SELECT count(*) FROM temp.timeline_stage) AS stages FROM temp.timeline_about a;
-- table: share
SELECT * FROM temp.timeline_share ORDER BY begin_us;
-- table: path
SELECT from_us, from_y, to_us, to_y FROM temp.timeline_path ORDER BY rowid;
-- table: messages
SELECT * FROM temp.timeline_message ORDER BY sent_us, from_y;
-- table: stages
SELECT stage, replace(name, ',', '‚') AS name FROM temp.timeline_stage
UNION ALL SELECT -1, '' ORDER BY 1;

-- A machine's network: where `mimdsim machines NAME --topology` placed its routers, and the pieces of its cables.
-- needs: mimdsim machines NAME --topology
SELECT router, x, y, kind FROM temp.topology_router ORDER BY router;
-- table: about
SELECT replace(title, ',', '‚') AS title, replace(subtitle, ',', '‚') AS subtitle, every, pairs, routers, grid, halves
FROM temp.topology_about;
-- table: lines
SELECT x, y, dx, dy, cut, far FROM temp.topology_line ORDER BY cut, rowid;

-- How much longer each of several jobs on one machine takes beside each other one, and beside all of them: its makespan
-- there over its makespan alone on the same processors. A panel for each set of jobs of the last scenario that has such runs.
-- needs: mimdsim interference neighbours   (any scenario with jobs: and combinations: [alone, pairs, all])
WITH member AS (
    SELECT r.id AS run_id, r.scenario, r.kernel, r.P, r.rep, r.level, r.machine, r.machine_key, r.placement, r.makespan_ps, s.value AS job_set,
           n.value AS job, CAST(k.number AS INTEGER) AS number, b.value AS beside, o.value AS routing
    FROM run r JOIN v_setting s ON s.run_id = r.id AND s.key = 'job.set' AND s.value <> ''
         JOIN v_setting n ON n.run_id = r.id AND n.key = 'job.name' JOIN v_setting k ON k.run_id = r.id AND k.key = 'job.number'
         JOIN v_setting b ON b.run_id = r.id AND b.key = 'job.beside'
         JOIN v_setting o ON o.run_id = r.id AND o.key = 'machine.network.routing'
    WHERE r.status = 'ok'),
-- sets of the scenario that was run last
shown AS (
    SELECT *, count(*) OVER () AS sets, dense_rank() OVER (ORDER BY first) AS panel FROM (
        SELECT job_set, min(run_id) AS first, max(number) AS jobs, min(level) AS level, min(machine) AS machine, min(routing) AS routing,
               iif(min(placement) = max(placement), min(placement), 'as listed') AS placement
        FROM member WHERE scenario = (SELECT scenario FROM member ORDER BY run_id DESC LIMIT 1) GROUP BY job_set)),
differ AS (
    SELECT count(DISTINCT machine) > 1 AS machine, count(DISTINCT level) > 1 AS level, count(DISTINCT routing) > 1 AS routing,
           count(DISTINCT placement) > 1 AS placement FROM shown),
named AS (
    SELECT s.*, iif(d.machine, s.machine || '  ', '') || iif(d.level, 'level ' || s.level || '  ', '')
                || iif(d.routing, 'routing ' || s.routing || '  ', '') || iif(d.placement, 'placement ' || s.placement, '') AS name
    FROM shown s, differ d),
lone AS (SELECT job_set, job, avg(makespan_ps) AS makespan_ps FROM member WHERE beside = '' AND makespan_ps > 0 GROUP BY job_set, job),
cell AS (
    SELECT m.job_set, m.job, m.number, m.beside, min(m.run_id) AS run_id, count(*) AS runs, m.kernel, m.P,
           avg(1.0 * m.makespan_ps / a.makespan_ps) AS slowdown, max(1.0 * m.makespan_ps / a.makespan_ps) AS most,
           avg(a.makespan_ps) / 1e6 AS alone_us, avg(m.makespan_ps) / 1e6 AS beside_us
    FROM member m JOIN lone a ON a.job_set = m.job_set AND a.job = m.job
    WHERE m.beside <> '' GROUP BY m.job_set, m.job, m.beside)
SELECT s.panel, trim(replace(s.name, ',', '‚')) AS panel_name,
       ifnull((SELECT min(o.number) FROM member o WHERE o.job_set = c.job_set AND o.job = c.beside), s.jobs + 1 + (c.beside = 'background' AND s.jobs > 2)) AS xi,
       s.jobs - c.number + 1 AS yi, replace(c.job, ',', '‚') AS job,
       iif(EXISTS (SELECT 1 FROM member o WHERE o.job_set = c.job_set AND o.job = c.beside), replace(c.beside, ',', '‚'), iif(c.beside = 'background', c.beside, 'all others'))
       AS beside, c.slowdown, c.most, c.alone_us, c.beside_us, c.kernel, c.P, c.runs, s.machine, s.level, s.jobs, s.sets, c.run_id
FROM cell c JOIN named s ON s.job_set = c.job_set WHERE s.panel <= 8 ORDER BY s.panel, yi DESC, xi;
-- table: x
WITH last AS (SELECT r.id, r.scenario FROM run r JOIN v_setting s ON s.run_id = r.id AND s.key = 'job.set' AND s.value <> ''
              WHERE r.status = 'ok' ORDER BY r.id DESC LIMIT 1),
job AS (SELECT CAST(k.number AS INTEGER) AS number, max(n.value) AS name
        FROM run r JOIN last ON last.scenario = r.scenario JOIN v_setting k ON k.run_id = r.id AND k.key = 'job.number' AND k.number > 0
             JOIN v_setting n ON n.run_id = r.id AND n.key = 'job.name' GROUP BY 1)
SELECT number AS xi, replace(name, ',', '‚') AS name FROM job
UNION ALL SELECT max(number) + 1, 'all others' FROM job HAVING count(*) > 2
UNION ALL SELECT max(number) + 1 + (count(*) > 2), 'background' FROM job ORDER BY 1;
-- table: y
WITH last AS (SELECT r.id, r.scenario FROM run r JOIN v_setting s ON s.run_id = r.id AND s.key = 'job.set' AND s.value <> ''
              WHERE r.status = 'ok' ORDER BY r.id DESC LIMIT 1),
job AS (SELECT CAST(k.number AS INTEGER) AS number, max(n.value) AS name
        FROM run r JOIN last ON last.scenario = r.scenario JOIN v_setting k ON k.run_id = r.id AND k.key = 'job.number' AND k.number > 0
             JOIN v_setting n ON n.run_id = r.id AND n.key = 'job.name' GROUP BY 1)
SELECT (SELECT max(number) FROM job) - number + 1 AS yi, replace(name, ',', '‚') AS name FROM job ORDER BY 1;

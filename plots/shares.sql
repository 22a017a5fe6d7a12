-- Which job loads which link: of jobs that shared a machine, the busiest links of the network and each job's part of the time
-- in which they were busy. A panel for each set of jobs of the scenario that was run last, with as many of them together as ran.
-- needs: mimdsim interference neighbours   (any scenario with jobs: and record: {links: true})
WITH member AS (
    SELECT r.id AS run_id, r.scenario, r.level, r.machine, r.placement, r.makespan_ps, s.value AS job_set, n.value AS job,
           CAST(k.number AS INTEGER) AS number, o.value AS routing,
           iif(b.value GLOB '[0-9]* jobs', b.value,
               (SELECT group_concat(value) FROM (SELECT value FROM json_each('["' || replace(n.value || iif(b.value = '', '', ' + ' || b.value), ' + ', '","')
                                                                             || '"]') ORDER BY value))) AS together
    FROM run r JOIN v_setting s ON s.run_id = r.id AND s.key = 'job.set' AND s.value <> ''
         JOIN v_setting n ON n.run_id = r.id AND n.key = 'job.name' JOIN v_setting k ON k.run_id = r.id AND k.key = 'job.number'
         JOIN v_setting b ON b.run_id = r.id AND b.key = 'job.beside' AND b.value <> 'background'
         JOIN v_setting o ON o.run_id = r.id AND o.key = 'machine.network.routing'
    WHERE r.status = 'ok' AND r.rep = 0 AND EXISTS (SELECT 1 FROM link_load l WHERE l.run_id = r.id)),
-- the most jobs that ran together, of each set
company AS (
    SELECT job_set, together, max(run_id) AS last, min(run_id) AS first, max(makespan_ps) AS whole_ps, min(level) AS level, min(machine) AS machine,
           min(routing) AS routing, iif(min(placement) = max(placement), min(placement), 'as listed') AS placement,
           row_number() OVER (PARTITION BY job_set ORDER BY count(*) DESC, max(run_id) DESC) AS choice
    FROM member WHERE scenario = (SELECT scenario FROM member ORDER BY run_id DESC LIMIT 1) GROUP BY job_set, together),
shown AS (SELECT *, dense_rank() OVER (ORDER BY first) AS panel, count(*) OVER () AS sets FROM company WHERE choice = 1),
differ AS (
    SELECT count(DISTINCT machine) > 1 AS machine, count(DISTINCT level) > 1 AS level, count(DISTINCT routing) > 1 AS routing,
           count(DISTINCT placement) > 1 AS placement FROM shown),
-- six colours: of more jobs the last ones are one
jobs AS (SELECT count(DISTINCT m.job) AS n FROM member m JOIN shown s ON s.job_set = m.job_set AND s.together = m.together),
part AS (
    SELECT s.panel, s.whole_ps, l.link, l.from_router, l.to_router, iif(j.n > 6 AND m.number > 5, 6, m.number) AS number,
           iif(j.n > 6 AND m.number > 5, 'others', m.job) AS job, sum(l.busy_ps) AS busy_ps, sum(l.queue_ps) AS queue_ps,
           sum(l.messages) AS messages, sum(l.sent_bytes) AS sent_bytes, min(m.run_id) AS run_id
    FROM link_load l JOIN member m ON m.run_id = l.run_id JOIN shown s ON s.job_set = m.job_set AND s.together = m.together, jobs j
    WHERE l.from_router IS NOT NULL AND l.to_router IS NOT NULL AND l.messages > 0 GROUP BY s.panel, l.link, 6),
link AS (
    SELECT panel, link, sum(busy_ps) AS busy_ps, count(*) OVER (PARTITION BY panel) AS links,
           row_number() OVER (PARTITION BY panel ORDER BY sum(busy_ps) DESC, link) AS place FROM part GROUP BY panel, link)
SELECT p.panel,
       trim(iif(d.machine, replace(s.machine, ',', '‚') || '  ', '') || iif(d.level, 'level ' || s.level || '  ', '')
            || iif(d.routing, 'routing ' || s.routing || '  ', '') || iif(d.placement, 'placement ' || s.placement, '')) AS panel_name,
       l.place, p.link, format('%d → %d', p.from_router, p.to_router) AS name, p.number, replace(p.job, ',', '‚') AS job,
       ifnull(1.0 * sum(p.busy_ps) OVER (PARTITION BY p.panel, p.link ORDER BY p.number ROWS BETWEEN UNBOUNDED PRECEDING AND 1 PRECEDING), 0)
       / s.whole_ps AS below, 1.0 * p.busy_ps / s.whole_ps AS share, 1.0 * p.busy_ps / l.busy_ps AS of_link, p.busy_ps / 1e6 AS busy_us,
       p.queue_ps / 1e6 AS queue_us, p.messages, p.sent_bytes, l.links, replace(s.machine, ',', '‚') AS machine, s.level, s.sets, p.run_id
FROM part p JOIN link l ON l.panel = p.panel AND l.link = p.link JOIN shown s ON s.panel = p.panel, differ d
WHERE l.place <= 12 AND s.whole_ps > 0 AND p.panel <= 4 ORDER BY p.panel, l.place, p.number;

-- statement: log2 n rounds of communication are visible, and for n = P the time grows as log2 n.
-- test: messages of NE[2] are those of ceil(log2 P) doubling rounds, and T(2P) - T(P) from P = 8 is constant within 5 %
-- unit: spread of T(2P) - T(P) over its mean
-- designated: structured
-- R doubling rounds of P processors are R P - (2^R - 1) pairs. Without contention, on a T3E as large as needed.
WITH one AS (
    SELECT scenario FROM run WHERE machine = 't3e-300' AND level = 'loggp' AND kernel = 'dynamics' AND n = P
    GROUP BY scenario ORDER BY max(P) DESC, scenario LIMIT 1),
point AS (
    SELECT r.operators AS variant, r.P, r.makespan_ps AS t, s.messages,
           ceil(log2(r.P)) * r.P - (pow(2, ceil(log2(r.P))) - 1) AS pairs
    FROM run r JOIN one USING (scenario) JOIN stage s ON s.run_id = r.id AND s.name = 'NE[2]'
    WHERE r.status = 'ok' AND r.machine = 't3e-300' AND r.level = 'loggp' AND r.kernel = 'dynamics' AND r.n = r.P
          AND r.formulation = 'paper' AND r.base = 'fixed' AND r.solver IN ('pcr-symmetric', 'pcr') AND r.P >= 8),
growth AS (SELECT b.variant, b.P, b.t - a.t AS step FROM point a JOIN point b ON b.variant = a.variant AND b.P = 2 * a.P),
rounds AS (SELECT variant, max(messages / pairs) = min(messages / pairs) AND min(messages / pairs) >= 1 AS visible
           FROM point GROUP BY variant)
SELECT variant, 1.0 * (max(step) - min(step)) / avg(step) AS value, 0.05 AS threshold,
       iif(count(*) < 3, NULL, (max(step) - min(step)) / avg(step) <= 0.05 AND visible) AS holds,
       format('%.1f to %.1f us more for each doubling up to P = %d; rounds %s', min(step) / 1e6, max(step) / 1e6, max(P),
              iif(visible, 'visible', 'not visible')) AS note
FROM growth JOIN rounds USING (variant) GROUP BY variant ORDER BY variant;

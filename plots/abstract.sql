-- The abstract of the report on the paper: its paragraphs, in order.
WITH verdict AS (SELECT id, verdict, ifnull(testable, 0) AS testable, ifnull(holding, 0) AS holding FROM claim WHERE variant = ''),
tally AS (
    SELECT count(*) AS n, sum(verdict = 'pass') AS pass, sum(verdict = 'fail') AS fail,
           sum(verdict = 'not-testable' AND id NOT LIKE 'C%') AS indicators,
           sum(verdict = 'not-testable' AND id LIKE 'C%') AS unmade,
           (SELECT group_concat(id, ', ') FROM (SELECT id FROM verdict WHERE verdict = 'pass' ORDER BY length(id), id)) AS passing,
           (SELECT group_concat(id, ', ') FROM (SELECT id FROM verdict WHERE verdict = 'fail' ORDER BY length(id), id)) AS failing,
           (SELECT group_concat(id, ', ') FROM (SELECT id FROM verdict WHERE verdict = 'not-testable' AND id LIKE 'C%'
                                                ORDER BY length(id), id)) AS missing
    FROM verdict),
partly AS (
    SELECT group_concat(format('%s holds in %d of %d', id, holding, testable), ', ') AS list FROM (SELECT * FROM verdict
        WHERE verdict = 'fail' AND holding > 0 OR verdict = 'pass' AND holding < testable ORDER BY length(id), id)),
-- rows of earlier versions of a machine's file may be there, too
kept AS (SELECT * FROM run WHERE id NOT IN (SELECT run_id FROM v_machine_state WHERE state = 'older')),
stored AS (SELECT count(*) AS runs, count(DISTINCT machine) AS machines, max(P) AS largest, sum(status = 'ok') AS ok FROM kept),
error AS (SELECT count(*) AS checks, count(*) - sum(passed) AS failed FROM error_check WHERE run_id IN (SELECT id FROM kept)),
sampled AS (SELECT count(DISTINCT sample) AS n FROM claim_sample)
SELECT 'The paper is: Andres Jaramillo-Botero and Alfons Crespo i Lorente, "A Unified Formulation for Massively Parallel Rigid '
    || 'Multibody Dynamics of O(log2 n) Computational Complexity", Journal of Parallel and Distributed Computing 62 (2002), '
    || 'pages 1001 to 1020. It computes the forces and the accelerations of a chain of n rigid bodies on as many processors in '
    || 'about log2 n rounds of messages, and reports measurements on a Cray T3E, an Intel Paragon, an SGI Origin2000 and a PC '
    || 'with four processors.' AS text
UNION ALL
SELECT 'The question: do the same programs, on models of the same machines, show what the paper reports? The programs were '
    || 'written from the description in the paper. They ran on simulated machines, whose parameters come from published sources '
    || 'or are marked as estimates. They computed actual numbers, which were compared with serial references.'
UNION ALL
SELECT CASE WHEN n = 0 THEN 'No claim has been judged.' ELSE
    format('The answer: of %d claims judged, %d hold%s and %d do not%s.', pass + fail, pass,
           iif(pass, ' (' || passing || ')', ''), fail, iif(fail, ' (' || failing || ')', '')) ||
    iif(unmade, format(' %d cannot be judged, because runs are missing (%s).', unmade, missing), '') ||
    iif(indicators, format(' %d indicators for which the paper gives no number are shown but not judged.', indicators), '') ||
    ifnull((SELECT ' The paper does not specify its serial code or its solver, for example. Variants of these give different verdicts: ' || list ||
                   '.' FROM partly WHERE list IS NOT NULL), '') END FROM tally
UNION ALL
SELECT format('The answer is based on %d runs on %d machines with up to %d processors, of which %d succeeded; %s. ', runs, machines, largest,
              ok, iif(failed = 0, format('all %d comparisons with a reference were within tolerance', checks),
                      format('%d of %d comparisons with a reference were not within tolerance', failed, checks))) ||
       iif(sampled.n > 0, format('Each claim was also judged for %d samples of the machine parameters that are known only as a range. ',
                                 sampled.n), '') ||
       'The variant and the tolerance that determine a verdict follow from the set-up of the paper and not from the values; '
    || 'they are stated with each claim. Nothing is tuned to make a claim hold or fail.' FROM stored, error, sampled WHERE runs > 0;

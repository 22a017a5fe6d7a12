-- What each omission saves in one scenario: time on this computer and on the simulated machine.
-- needs: mimdsim explain scenarios/speedup-t3e.yaml --measure
-- each: SELECT DISTINCT scenario, 'omissions-' || scenario FROM omission ORDER BY 1
SELECT row_number() OVER (ORDER BY ordinal) AS y, replace(what, ',', ' –') AS what, replace(why, ',', ' –') AS why, class, bound,
       class = 'bounded' AS bounded, at, host_s, host_saved_s, host_noise_s, machine_ps, machine_saved_ps, host_saved_s IS NOT NULL AS measured,
       ifnull(abs(host_saved_s) > host_noise_s, 0) AS told, host_saved_s * 1e3 AS host_saved_ms, machine_saved_ps / 1e6 AS machine_saved_us,
       CASE WHEN host_saved_s IS NULL THEN 'cannot be undone'
            WHEN abs(host_saved_s) <= host_noise_s THEN format('below the noise of %.2g ms', host_noise_s * 1e3)
            WHEN host_saved_s < 0 THEN format('costs %.2g ms more than it saves', -host_saved_s * 1e3)
            ELSE format('%.3g ms (%.2g %%)', host_saved_s * 1e3, 100 * host_saved_s / (host_s + host_saved_s)) END AS host_text,
       CASE WHEN machine_saved_ps IS NULL THEN '' WHEN machine_saved_ps = 0 THEN 'nothing'
            ELSE format('%.4g µs (%.2g %%)', machine_saved_ps / 1e6, 100.0 * machine_saved_ps / (machine_ps + machine_saved_ps)) END
            AS machine_text,
       iif(class = 'bounded', format('bounded: %.0e', bound), 'exact') || '; ' || at AS class_text, scenario
FROM omission WHERE scenario = ?1 ORDER BY ordinal;

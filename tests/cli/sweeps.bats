#!/usr/bin/env bats
# sweeps.bats - a sweep goes on: past points that cannot run, past workers that die; and no two of its runs are the same.

load helper

@test "a point that cannot run is a row with its reason, and the others run" {
    for jobs in 1 2; do
        fails_with 1 mimdsim run speedup-t3e --set n=4,2048,8 --set level=loggp -o swept$jobs.db -j $jobs --quiet
        stderr_says "2048 ranks, but machine 't3e-300' has 128 processors"
        stderr_says 'mimdsim: 1 of 3 runs failed; each is stored with its reason, and tried again next time'
        stdout_says failed
        sql_is swept$jobs.db "SELECT group_concat(n || ' ' || status, ', ') FROM (SELECT * FROM run ORDER BY id)" '4 ok, 2048 failed, 8 ok'
        sql_is swept$jobs.db "SELECT text FROM run WHERE n = 2048" \
            "--set: 2048 ranks, but machine 't3e-300' has 128 processors; reduce ranks or enlarge machine.topology.dims"
        sql_is swept$jobs.db "SELECT count(*) FROM v_speedup WHERE P = 2048" 0
    done
    # what ran is not run again, what failed is tried again
    fails_with 1 mimdsim run speedup-t3e --set n=4,2048,8 --set level=loggp -o swept1.db --quiet
    stderr_says 'mimdsim: 1 of 1 runs failed'
    sql_is swept1.db 'SELECT count(*) FROM run' 3
    # the table's speedups are those of the view, which has none of a run that failed
    fails_with 1 mimdsim run speedup-t3e --set n=4,2048,8 --set level=loggp -o swept1.db --csv \
        --columns speedup_vs_fastest_serial,speedup_vs_itself
    [ "$(tr -d '\r' <<<"$output" | awk -F, 'NR > 1 {printf "%.10g %.10g\n", $1, $2}')" = "$(sqlite3 swept1.db "SELECT
        printf('%.10g %.10g', (SELECT speedup FROM v_speedup WHERE run_id = r.id AND baseline = 'fastest serial'),
        (SELECT speedup FROM v_speedup WHERE run_id = r.id AND baseline = 'parallel code on one processor'))
        FROM run r ORDER BY CASE n WHEN 2048 THEN 6 ELSE n END")" ]
}

@test "a plan of no other points is refused as before, and nothing is made" {
    fails_with 78 mimdsim run speedup-t3e --set n=2048 -o none.db
    stderr_says "2048 ranks, but machine 't3e-300' has 128 processors"
    fails_with 78 mimdsim run speedup-t3e --set n=2048,4096 -o none.db
    nothing_left_behind
}

# worker_of PID: a process that works for PID and has used the processor for a while.
worker_of() { pgrep -P "$1" | head -n 1; }

@test "a worker that is killed costs its run alone, and the next time makes up for it" {
    for attempt in 1 2 3 4 5; do
        rm -f killed.db*
        "$MIMDSIM" run speedup-t3e --set machine.topology.dims='[32, 16, 16]' --set n=2048,4096,8192,2050,2052,2054 -j 2 \
            -o killed.db --quiet >out 2>err 3>&- &
        parent=$!
        worker=
        while [ -z "$worker" ] && kill -0 $parent; do worker=$(worker_of $parent); done
        sleep 0.2
        kill -9 "$worker" || true
        status=0
        wait $parent || status=$?
        if grep -q 'signal 9' err; then break; fi
    done
    cat err
    [ "$status" -eq 1 ]
    grep -q 'its worker process was killed by signal 9 (Killed)' err
    grep -q 'mimdsim: 1 of 12 runs failed; each is stored with its reason, and tried again next time' err
    sql_is killed.db "SELECT count(*), sum(status = 'ok'), sum(status = 'failed' AND text LIKE '%signal 9%') FROM run" '12|11|1'
    works mimdsim run speedup-t3e --set machine.topology.dims='[32, 16, 16]' --set n=2048,4096,8192,2050,2052,2054 -j 2 -o killed.db --quiet
    sql_is killed.db "SELECT count(*), sum(status = 'ok') FROM run" '12|12'
}

@test "no repetition of one seed is a run of another" {
    printf '%s\n' 'schema_version: 1' 'question: How much does noise change?' 'machine: t3e-300' \
        'model: {generator: serial-chain, n: 8}' 'kernel: dynamics' 'ranks: n' 'level: link' \
        'machine.noise.compute: 5 %' 'sweep: {seed: [0, 1, 2, 3, 4, 5, 6, 7]}' 'repetitions: 8' >noisy.yaml
    works mimdsim run noisy.yaml --quiet
    sql_is mimdsim.db 'SELECT count(*), count(DISTINCT digest), count(DISTINCT makespan_ps) FROM run' '64|64|64'
}

#!/usr/bin/env bats
# run.bats - a scenario answered through the real program: rows, resume, determinism, overrides, figures.

load helper

scenario() {
    printf '%s\n' 'schema_version: 1' 'question: Small?' 'machine: t3e-300' \
        'model: {generator: serial-chain}' 'kernel: dynamics' 'ranks: n' 'sweep:' '  level: [link, loggp]' \
        '  n: [2, 3, 8]' "$@" >small.yaml
}

digests() { sql "$1" 'SELECT level, n, digest FROM run ORDER BY level, n'; }

@test "every point is stored, verified, and printed" {
    scenario
    works mimdsim run small.yaml
    [ "${#lines[@]}" -eq 7 ]
    sql_is mimdsim.db "SELECT count(*) FROM run WHERE status = 'ok'" 6
    sql_is mimdsim.db 'SELECT count(*) > 0, max(relative_error) < 1e-9, min(relative_error) >= 0 FROM error_check' '1|1|1'
    works mimdsim run small.yaml --json
    json_is_valid
    json_is '$[#-1].status' ok
}

@test "what is stored is not run again unless forced" {
    scenario
    works mimdsim run small.yaml --quiet
    stderr_is_empty
    first=$(sql mimdsim.db 'SELECT * FROM run ORDER BY config_hash' | sha256sum)
    works mimdsim run small.yaml
    [ "$(sql mimdsim.db 'SELECT * FROM run ORDER BY config_hash' | sha256sum)" = "$first" ]
    before=$(digests mimdsim.db)
    works mimdsim run small.yaml --force
    [ "$(digests mimdsim.db)" = "$before" ]
    sql_is mimdsim.db 'SELECT count(*) FROM run' 6
}

@test "the same scenario gives the same digests twice, on one worker and on several" {
    scenario
    works mimdsim run small.yaml -o a.db --jobs 1
    works mimdsim run small.yaml -o b.db --jobs 3
    [ -n "$(digests a.db)" ]
    [ "$(digests a.db)" = "$(digests b.db)" ]
    [ "$(sql a.db 'SELECT makespan_ps FROM run ORDER BY config_hash')" = \
        "$(sql b.db 'SELECT makespan_ps FROM run ORDER BY config_hash')" ]
}

@test "a campaign that was killed goes on where it was and ends as if nothing had happened" {
    scenario
    works mimdsim run small.yaml -o whole.db --quiet
    for delay in 0.01 0.02 0.03 0.05 0.08; do
        timeout -s KILL "$delay" "$MIMDSIM" run small.yaml -o torn.db --quiet >/dev/null 2>&1 || true
    done
    works mimdsim run small.yaml -o torn.db --quiet
    [ "$(digests torn.db)" = "$(digests whole.db)" ]
    sql_is torn.db 'PRAGMA integrity_check' ok
}

@test "an override acts, and its run is another one" {
    scenario
    works mimdsim run small.yaml
    works mimdsim run small.yaml --set 'machine.network.link.bandwidth=4 MB/s'
    sql_is mimdsim.db 'SELECT count(*) FROM run' 12
    sql_is mimdsim.db "SELECT count(DISTINCT makespan_ps) FROM run WHERE n = 8 AND level = 'loggp'" 2
}

@test "another machine answers the same scenario" {
    scenario
    works mimdsim run small.yaml --machine paragon
    sql_is mimdsim.db "SELECT count(*) FROM run WHERE status = 'ok'" 6
    sql_is mimdsim.db 'SELECT count(DISTINCT machine) || min(machine) FROM run' 1paragon
}

@test "explain tells what will run and runs nothing" {
    scenario
    works mimdsim explain small.yaml
    stdout_says "6 runs"
    works mimdsim explain small.yaml --json
    json_is_valid
    rm small.yaml
    nothing_left_behind
}

@test "figures come from the database alone" {
    works mimdsim run speedup-t3e --quiet
    mkdir elsewhere
    mv mimdsim.db elsewhere/moved.db
    works mimdsim plot elsewhere/moved.db fig5 fig6 --dir pictures
    for figure in fig5 fig6; do
        for kind in png svg csv gp; do [ -s "pictures/$figure.$kind" ]; done
        [ "$(wc -l <"pictures/$figure.csv")" -gt 5 ]
    done
    first=$(sha256sum <pictures/fig6.svg)
    works mimdsim plot elsewhere/moved.db fig6 --dir again
    [ "$(sha256sum <again/fig6.svg)" = "$first" ]
}

@test "a single run makes its database when it is stored, whole, beside others that do the same" {
    scenario
    for n in 2 3 8; do
        mimdsim run small.yaml --quiet -o one.db --set n=$n --set level=loggp >out$n 2>err$n &
    done
    wait
    cat err*
    # nothing but the database: neither logs nor what was written beside it
    [ "$(ls -d one.db*)" = one.db ]
    sql_is one.db "SELECT count(*), count(DISTINCT n), count(DISTINCT status) FROM run" '3|3|1'
    sql_is one.db 'PRAGMA integrity_check' ok
    sql_is one.db 'PRAGMA foreign_key_check' ''
    # the same rows as those of a database that was there before
    works mimdsim run small.yaml --quiet -o many.db --set n=2,3
    works mimdsim run small.yaml --quiet -o many.db --set n=8
    rows='SELECT config_hash, digest, makespan_ps FROM run WHERE level = "loggp" ORDER BY 1'
    [ "$(sql one.db "$rows")" = "$(sql many.db "$rows")" ]
    for table in stage error_check baseline run_setting run_family; do
        sql_is one.db "SELECT count(*) > 0 FROM $table" 1
    done
}

@test "a single run that cannot make its database says so and leaves nothing" {
    scenario
    mkdir closed
    fails_with 73 mimdsim run small.yaml --quiet -o nowhere/one.db --set n=2 --set level=loggp
    stderr_says 'cannot make database nowhere/one.db'
    [ ! -e nowhere ]
    fails_with 73 mimdsim run small.yaml --quiet -o closed --set n=2 --set level=loggp
    stderr_says 'closed is a folder'
    [ -z "$(ls closed)" ]
}

@test "columns that are not there are told before a database is made" {
    fails_with 64 mimdsim run speedup-t3e --set n=4 --columns foo
    stderr_says "no column 'foo'"
    nothing_left_behind
}

@test "a rate without a limit is called unlimited; 0 is refused where it is typed, and told where it is read" {
    refused() { fails_with 65 mimdsim run ideal-test.yaml "$@" -o own.db; [ ! -e own.db ]; }
    printf 'schema_version: 1\nmachine: ideal\nkernel: {name: pingpong}\nranks: 2\nlevel: loggp\n' >ideal-test.yaml
    refused --set 'machine.network.link.bandwidth=0 MB/s'
    stderr_says "write 'unlimited'"
    works mimdsim run ideal-test.yaml -o own.db --quiet
    works mimdsim run ideal-test.yaml --set machine.network.link.bandwidth=unlimited -o own.db --quiet
    stderr_is_empty
    # It is the same machine, and its identity is that of before.
    sql_is own.db 'SELECT count(*) FROM run' 1
    sql_is own.db "SELECT value, number IS NULL FROM v_setting WHERE key = 'machine.network.link.bandwidth'" 'unlimited|1'
    sql_is own.db "SELECT s.number FROM setting s WHERE s.key = 'machine.network.link.bandwidth'" 0.0
    works mimdsim machines ideal
    stdout_says 'unlimited'
    works mimdsim keys copy.bandwidth
    stdout_says 'or unlimited; default unlimited'
    # An older file is read as it was meant.
    printf 'schema_version: 1\nbase: ideal\nnetwork: {link: {bandwidth: 0 B/s}}\n' >old.yaml
    works mimdsim run ideal-test.yaml -m old.yaml -o old.db
    stderr_says "old.yaml:3: network.link.bandwidth: '0 B/s' is read as 'unlimited'"
    works mimdsim run ideal-test.yaml -m t3e-300 --set machine.network.link.bandwidth=unlimited -o name.db
    stdout_says 'link.bandwidth unlimited'
}

@test "a sample at the top of a scenario is sent below its sweep" {
    printf 'schema_version: 1\nkernel: dynamics\nsample: {points: 4}\n' >s.yaml
    fails_with 65 mimdsim run s.yaml
    stderr_says "s.yaml:3: 'sample' is a part of 'sweep'"
}

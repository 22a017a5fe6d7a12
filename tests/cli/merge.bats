# merge.bats - a plan shared by several hosts: shards, single points, and their databases joined.
load helper
load campaigns

scenario() {
    printf '%s\n' 'schema_version: 1' 'question: Many?' 'machine: [t3e-300, paragon]' 'model: {generator: serial-chain}' \
        'n: [4, 8, 16]' 'ranks: 4' 'level: [loggp, link]' 'kernel: dynamics' 'record: {spans: true}' >own.yaml
}

@test "shards share a plan without overlap, and merged they are the undisturbed database, row by row" {
    scenario
    works mimdsim run own.yaml -o whole.db --quiet
    for k in 1 2 3; do works mimdsim run own.yaml --shard $k/3 -o part$k.db --quiet; done
    total=0
    for k in 1 2 3; do total=$((total + $(sql part$k.db 'SELECT count(*) FROM run'))); done
    [ $total -eq 12 ]
    works mimdsim merge all.db part1.db part2.db part3.db
    stderr_is_empty
    sql_is all.db 'SELECT count(*) FROM run' 12
    diff <(rows whole.db) <(rows all.db)
    [ "$(rows all.db | wc -l)" -gt 500 ]
    # What is merged resumes: nothing is left to do.
    works mimdsim run own.yaml -o all.db --quiet
    sql_is all.db 'SELECT max(id) FROM run' 12
    # Once more changes nothing.
    before=$(sqlite3 all.db .dump | sha256sum)
    works mimdsim merge all.db part2.db part1.db --json
    stdout_says '"added": 0'
    [ "$(sqlite3 all.db .dump | sha256sum)" = "$before" ]
}

@test "the same run with two digests is refused with both builds, and nothing of that database is merged" {
    scenario
    works mimdsim run own.yaml -o two.db --quiet
    cp two.db bad.db
    sqlite3 two.db "DELETE FROM run WHERE id > 6"
    sqlite3 bad.db "UPDATE run SET digest = 'fedcba9876543210' WHERE id = 5; UPDATE build SET git = 'another'"
    before=$(sqlite3 two.db .dump | sha256sum)
    fails_with 65 mimdsim merge two.db bad.db
    stderr_says 'has digest'
    stderr_says fedcba9876543210
    stderr_says another
    [ "$(sqlite3 two.db .dump | sha256sum)" = "$before" ]
}

@test "settings that differ between the databases are columns of v_swept after the merge" {
    for us in 1 2; do
        works mimdsim run speedup-t3e --set n=8 --set level=loggp --set machine.network.hop_latency="$us us" -o $us.db --quiet
        sql_is $us.db "SELECT count(*) FROM sqlite_schema WHERE name = 'v_swept'" 0
    done
    works mimdsim merge all.db 1.db
    sql_is all.db "SELECT count(*) FROM sqlite_schema WHERE name = 'v_swept'" 0
    works mimdsim merge all.db 2.db
    sql_is all.db "SELECT group_concat(hop_latency, ' ') FROM (SELECT hop_latency FROM v_swept ORDER BY 1)" '1.0e-06 2.0e-06'
    works mimdsim plot all.db --x hop_latency --y makespan_s
    # of several, also when a later one is refused
    rm all.db
    echo none >bad.db
    run mimdsim merge all.db 1.db 2.db bad.db
    [ "$status" -ne 0 ]
    sql_is all.db 'SELECT count(DISTINCT hop_latency) FROM v_swept' 2
}

@test "a run that failed is replaced by one that ended ok, never the other way round" {
    scenario
    works mimdsim run own.yaml -o good.db --quiet
    cp good.db broken.db
    sqlite3 broken.db "UPDATE run SET status = 'failed' WHERE id IN (2, 3)"
    cp broken.db first.db
    works mimdsim merge first.db good.db
    stdout_is 'good.db: 0 runs added, 2 replaced, 10 were there'
    sql_is first.db "SELECT count(*) FROM run WHERE status = 'ok'" 12
    sql_is first.db 'SELECT count(DISTINCT run_id) FROM stage' 12
    works mimdsim merge good.db broken.db
    sql_is good.db "SELECT count(*) FROM run WHERE status = 'ok'" 12
}

@test "plan lists every run with its shard, and --point makes one of them" {
    scenario
    works mimdsim plan own.yaml --shards 3
    [ "${#lines[@]}" -eq 13 ]
    works mimdsim plan own.yaml --json
    [ "$(grep -o '"id"' <<<"$output" | wc -l)" -eq 12 ]
    lines_of_json=$output
    works mimdsim plan own.yaml --format json
    [ "$output" = "$lines_of_json" ]
    fails_with 64 mimdsim plan own.yaml --format xml
    stderr_says 'expected lines or json'
    works mimdsim plan own.yaml
    id=$(cut -f 1 <<<"${lines[5]}")
    works mimdsim run own.yaml --point "$id" -o point.db --quiet
    sql_is point.db "SELECT config_hash || '-' || rep FROM run" "$id"
    fails_with 64 mimdsim run own.yaml --point zzz -o point.db
    stderr_says 'no run of this plan'
    fails_with 64 mimdsim run own.yaml --point '' -o point.db
    stderr_says 'several runs'
}

@test "shards and databases that are none are refused" {
    scenario
    for shard in 0/2 3/2 2 a/b 1/2x -1/2 1/99999999; do
        fails_with 64 mimdsim run own.yaml --shard $shard -o none.db
        stderr_says "expected K/N"
        [ ! -e none.db ]
    done
    fails_with 64 mimdsim plan own.yaml --shards none
    works mimdsim run own.yaml --shard 1/2 -o one.db --quiet
    fails_with 64 mimdsim merge one.db one.db
    stderr_says 'into itself'
    fails_with 66 mimdsim merge one.db nowhere.db
    echo text >text.db
    fails_with 65 mimdsim merge one.db text.db
    cp one.db strange.db
    sqlite3 strange.db "ALTER TABLE span RENAME TO span2; CREATE VIEW span AS SELECT * FROM span2"
    fails_with 65 mimdsim merge one.db strange.db
    stderr_says "view 'span' is not the one that mimdsim makes"
    sqlite3 strange.db 'PRAGMA user_version = 5'
    fails_with 65 mimdsim merge one.db strange.db
}

@test "GNU parallel runs the shards of a campaign and merges them, also after a killed shard" {
    command -v parallel >/dev/null || skip "GNU parallel is not installed"
    scenario
    works mimdsim run own.yaml -o whole.db --quiet
    # A shard that was killed at any moment leaves a database that its next start completes.
    for delay in 0.01 0.03 0.06 0.1; do
        "$MIMDSIM" run own.yaml --shard 2/2 -o all.db.shard-2 --jobs 1 --quiet >/dev/null &
        sleep $delay
        kill -9 $! 2>/dev/null || true
        wait $! || true
    done
    works sh "$MIMDSIM_SRCDIR/examples/cluster/gnu-parallel.sh" own.yaml all.db 2
    diff <(rows whole.db) <(rows all.db)
    works sh "$MIMDSIM_SRCDIR/examples/cluster/gnu-parallel.sh" own.yaml all.db 2
    stdout_says '0 runs added'
}

@test "a database that was made before a table existed is merged, and what it has arrives" {
    scenario
    works mimdsim run own.yaml -o old.db --quiet
    sqlite3 old.db "DELETE FROM run WHERE id > 3"
    # Tables that this version gained since its first databases.
    for table in program_line critical_path sensitivity ideal; do sqlite3 old.db "DROP TABLE $table"; done
    works mimdsim run own.yaml -o all.db --quiet --set n=4
    works mimdsim merge all.db old.db
    [ "$(sql all.db 'SELECT count(*) FROM run')" -gt 3 ]
    works mimdsim merge new.db old.db
    stdout_is 'old.db: 3 runs added, 0 replaced, 0 were there'
    sqlite3 old.db "DROP TABLE stage"
    fails_with 65 mimdsim merge new.db old.db
    stderr_says 'lacks 1 of the tables'
}

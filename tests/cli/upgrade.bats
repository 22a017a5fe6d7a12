# upgrade.bats - databases of older versions through the real program: read, upgraded, and their runs found again.
load helper

old_database() {
    sqlite3 old.db <"$MIMDSIM_SRCDIR/tests/data/store/version-$1.sql"
    cp "$MIMDSIM_SRCDIR/tests/data/store/small.yaml" .
}

@test "query --upgrade upgrades a database, names the old one, and says when there is nothing to do" {
    for version in 4 5; do
        rm -f old.db*
        old_database "$version"
        sha=$(sql old.db "SELECT group_concat(digest) FROM run")
        works mimdsim query --upgrade old.db
        stdout_is "database old.db was of version $version and is now of version 10; the old one is kept as old.db.v$version"
        stderr_is_empty
        sql_is old.db "SELECT group_concat(digest) FROM run" "$sha"
        sql_is "old.db.v$version" "PRAGMA user_version" "$version"
        works mimdsim query old.db --upgrade
        stdout_is "database old.db is of version 10 already"
    done
    works mimdsim query --upgrade --json old.db
    json_is '$.upgrade' "database old.db is of version 10 already"
    works mimdsim query --upgrade old.db "SELECT count(*) AS n FROM run"
    stdout_says 2
}

@test "what is no database is not upgraded, and nothing is made" {
    fails_with 66 mimdsim query --upgrade none.db
    stderr_says "there is no database none.db"
    echo text >text.db
    fails_with 65 mimdsim query --upgrade text.db
    [ "$(ls)" = text.db ]
    fails_with 64 mimdsim query --upgrade
}

@test "verbs that read an old database use a copy, say so, and leave it as it is" {
    old_database 4
    before=$(sha256sum <old.db)
    works mimdsim query old.db "SELECT count(*) AS n, count(DISTINCT config_hash) AS m FROM run"
    stdout_says "6  6"
    stderr_is "mimdsim: database old.db is of version 4: read through an upgraded copy; \`mimdsim query --upgrade old.db\` upgrades it"
    works mimdsim query old.db "SELECT 1" --quiet
    stderr_is_empty
    fails_with 66 mimdsim plot old.db fig5
    stderr_says "read through an upgraded copy"
    works mimdsim report old.db
    [ "$(sha256sum <old.db)" = "$before" ]
    [ ! -e old.db.v4 ]
}

@test "runs of a version-4 database are found again: nothing is repeated, new runs stand beside them" {
    old_database 4
    works mimdsim run small.yaml -o old.db
    stderr_says "was of version 4 and is now of version 10; the old one is kept as old.db.v4"
    sql_is old.db "SELECT count(*), count(DISTINCT build_id) FROM run" '6|1'
    works mimdsim run small.yaml -o old.db --set n=5 --quiet
    sql_is old.db "SELECT count(*), count(DISTINCT build_id) FROM run" '8|2'
    works mimdsim run small.yaml -o old.db --set level=link --set n=2 --set 'machine.noise.compute=5 %' --set seed=9
    sql_is old.db "SELECT count(*) FROM run" 8
    # Today's program predicts what that of then predicted but for the counts of operations, corrected since: within 0.5 %.
    works mimdsim run small.yaml -o new.db --quiet
    sql_is new.db "ATTACH 'old.db' AS old; SELECT count(*) FROM run n JOIN old.run o ON o.config_hash = n.config_hash
        AND o.messages = n.messages AND abs(o.makespan_ps - n.makespan_ps) < 0.005 * o.makespan_ps" 4
}

#!/usr/bin/env bats
# bad_input.bats - everything a user can get wrong: one message with its place, a documented status, nothing half-written.

load helper

# scenario [LINE...]: small.yaml, a scenario of one small run, with LINEs at its end.
scenario() {
    printf '%s\n' 'schema_version: 1' 'question: Small?' 'machine: t3e-300' \
        'model: {generator: serial-chain, n: 5}' 'kernel: dynamics' 'ranks: n' 'level: link' "$@" >small.yaml
}

# refused STATUS TEXT OPTION...: `run small.yaml OPTION...` ends with STATUS, says one line with TEXT, leaves no database.
refused() {
    local status_wanted=$1 text=$2
    shift 2
    fails_with "$status_wanted" mimdsim run small.yaml "$@"
    stderr_says "$text"
    [ "$(printf '%s\n' "$stderr" | wc -l)" -eq 1 ] || { echo "more than one line"; show; return 1; }
    stdout_is_empty
    rm small.yaml
    nothing_left_behind
}

@test "an unknown key is refused with file, line and the nearest key" {
    scenario 'levle: loggp'
    refused 65 "small.yaml:8: unknown key 'levle'; did you mean 'level'?"
}

@test "a duplicate key is refused with both lines" {
    scenario 'level: loggp'
    refused 65 "small.yaml:8: duplicate key 'level'; first given in line 7"
}

@test "a missing unit is refused with an example" {
    scenario 'machine.network.link.bandwidth: 480'
    refused 65 "small.yaml:8: machine.network.link.bandwidth: '480': no unit; expected a bandwidth such as '480 MB/s'"
}

@test "the unit of another kind is refused by name" {
    scenario
    refused 65 "'MHz' is the unit of a frequency; expected a bandwidth" --set 'machine.network.link.bandwidth=480 MHz'
}

@test "a unit in the wrong case is refused with the right one" {
    scenario
    refused 65 "unknown unit 'mb/s'; did you mean 'MB/s'?" --set 'machine.network.link.bandwidth=480 mb/s'
}

@test "infinities are no numbers" {
    scenario
    refused 65 "link.bandwidth" --set 'machine.network.link.bandwidth=inf MB/s'
    scenario
    refused 65 "too large" --set 'machine.network.link.bandwidth=1e999 MB/s'
}

@test "a value out of range is refused with the range" {
    scenario
    refused 65 "out of range; expected at least 0 B/s" --set 'machine.network.link.bandwidth=-3 MB/s'
}

@test "n below 1 is refused" {
    scenario
    refused 65 "model.n: '0': out of range" --set n=0
}

@test "a word where a number belongs is refused" {
    scenario
    refused 65 "not a whole number" --set n=many
}

@test "more ranks than the machine holds are refused with both numbers" {
    scenario
    refused 78 "500 ranks, but machine 't3e-300' has 128 processors" --set ranks=500
}

@test "an unknown key in --set is refused, and so is one without a value" {
    scenario
    refused 65 "unknown key 'machine.network.link.bandwith'; did you mean 'machine.network.link.bandwidth'?" \
        --set 'machine.network.link.bandwith=1 MB/s'
    scenario
    refused 64 "expected key=value" --set ranks
}

@test "an unknown machine is refused with the nearest" {
    scenario
    refused 66 "did you mean 't3e-300'?" --machine t3e-30
}

@test "an unknown scenario is refused with the nearest" {
    fails_with 66 mimdsim run speedup-te3
    stderr_says "no scenario 'speedup-te3'; did you mean 'speedup-t3e'?"
    stdout_is_empty
    nothing_left_behind
}

@test "what is not YAML is refused with its line: binary, unfinished, empty, a folder" {
    printf '\200\377\000\001' >small.yaml
    refused 65 "small.yaml:1: not YAML"
    printf 'a: [1, 2\nb: }' >small.yaml
    refused 65 "small.yaml:2: not YAML"
    : >small.yaml
    refused 65 "small.yaml:1: the file is empty"
    mkdir folder.yaml
    fails_with 65 mimdsim run folder.yaml
    stderr_says "folder.yaml"
}

@test "check looks at every file and ends with the status of the wrong one" {
    scenario
    mv small.yaml good.yaml
    scenario 'colour: red'
    works mimdsim check good.yaml "$MIMDSIM_DATA/machines/t3e-300.yaml"
    fails_with 65 mimdsim check small.yaml good.yaml
    stdout_says "good.yaml: ok"
    stderr_says "small.yaml:8: unknown key 'colour'"
}

@test "with --json a failure is exactly one document, too" {
    scenario
    fails_with 65 mimdsim run small.yaml --json --set n=0
    json_is_valid
    json_is '$.error.kind' bad-data
    json_is '$.error.exit_status' 65
    [ ! -e mimdsim.db ]
}

@test "a file that is no database of ours is left as it was" {
    scenario
    echo 'important notes' >notes.db
    fails_with 65 mimdsim run small.yaml -o notes.db
    stderr_is "mimdsim: notes.db is not a database of mimdsim"
    [ "$(cat notes.db)" = 'important notes' ]
    sqlite3 other.db 'CREATE TABLE mine (x); INSERT INTO mine VALUES (1)'
    cp other.db copy.db
    fails_with 65 mimdsim run small.yaml -o other.db
    cmp other.db copy.db
}

@test "a newer database is refused" {
    scenario
    works mimdsim run small.yaml -o new.db
    sqlite3 new.db 'PRAGMA user_version = 99'
    fails_with 65 mimdsim run small.yaml -o new.db
    stderr_says "new.db has schema version 99"
    fails_with 65 mimdsim plot new.db fig6
}

@test "a locked database is told from a broken one" {
    scenario
    works mimdsim run small.yaml
    mkfifo hold
    sqlite3 mimdsim.db <hold >held &
    exec 4>hold
    echo 'BEGIN EXCLUSIVE; SELECT 1;' >&4
    for _ in $(seq 100); do [ -s held ] && break; sleep 0.05; done
    fails_with 75 mimdsim run small.yaml --force
    exec 4>&-
    wait
    stderr_says "mimdsim.db"
    works mimdsim run small.yaml --force
    sql_is mimdsim.db 'SELECT count(*) FROM run' 1
}

@test "a read-only database is refused and unchanged" {
    scenario
    works mimdsim run small.yaml
    chmod a-w mimdsim.db
    before=$(sha256sum mimdsim.db)
    if [ "$(id -u)" -ne 0 ]; then fails_with 74 mimdsim run small.yaml --force
    else # root may write what is read-only; another user may not
        chmod a+rx "$BATS_RUN_TMPDIR" "$BATS_TEST_TMPDIR" . && chmod -R a+rX .
        as_nobody=(setpriv --reuid=65534 --regid=65534 --clear-groups)
        "${as_nobody[@]}" test -r small.yaml -a -x "$MIMDSIM" -a -r "$MIMDSIM_DATA/machines/t3e-300.yaml" ||
            skip "another user cannot come here"
        fails_with 74 "${as_nobody[@]}" "$MIMDSIM" run small.yaml --force
    fi
    stderr_says "mimdsim.db"
    [ "$(sha256sum mimdsim.db)" = "$before" ]
}

@test "a full disk leaves no half database and keeps the rows that were there" {
    scenario
    full() { (trap '' XFSZ; ulimit -f 8; "$MIMDSIM" run small.yaml "$@"); }
    fails_with 74 full -o fresh.db
    stderr_says "fresh.db"
    [ ! -e fresh.db ]
    works mimdsim run small.yaml
    fails_with 74 full --set n=6
    sql_is mimdsim.db 'SELECT n FROM run' 5
    sql_is mimdsim.db 'PRAGMA integrity_check' ok
    works mimdsim run small.yaml --set n=6
    sql_is mimdsim.db 'SELECT count(*) FROM run' 2
}

@test "a database that cannot be made is told" {
    scenario
    fails_with 73 mimdsim run small.yaml -o nowhere/x.db
    stderr_says "nowhere/x.db"
    fails_with 73 mimdsim run small.yaml -o .
    stdout_is_empty
}

@test "without gnuplot the data and the script are written, and the status says so" {
    works mimdsim run speedup-t3e --quiet --set model.n=4
    fails_with 69 env -u MIMDSIM_GNUPLOT PATH=/none "$MIMDSIM" plot mimdsim.db fig6
    stderr_says "gnuplot"
    [ -s figures/fig6.csv ]
    [ -s figures/fig6.gp ]
    [ ! -e figures/fig6.png ]
}

@test "an unknown figure, a missing database and wrong SQL are told apart" {
    scenario
    works mimdsim run small.yaml
    fails_with 66 mimdsim plot mimdsim.db fig55
    stderr_says "did you mean 'fig5'?"
    fails_with 66 mimdsim plot none.db fig5
    stderr_says "none.db"
    [ ! -e none.db ]
    fails_with 65 mimdsim query mimdsim.db 'SELEKT 1'
    fails_with 74 mimdsim query mimdsim.db 'DELETE FROM run'
    sql_is mimdsim.db 'SELECT count(*) FROM run' 1
}

@test "an unknown kernel is refused where it is written, with the nearest, before anything runs" {
    scenario
    refused 65 "--set: no kernel is called 'dynamcis'; did you mean 'dynamics'?" --set kernel=dynamcis
    scenario 'sweep:' '  kernel.name: [dynamics, invers]'
    sed -i '/^kernel:/d' small.yaml
    refused 65 "small.yaml:8: no kernel is called 'invers'; did you mean 'inverse'?"
}

@test "an unknown figure in a scenario is refused with its line and the nearest" {
    scenario 'figures: [fig6, fgi5]'
    refused 65 "small.yaml:8: no figure 'fgi5'; did you mean 'fig5'?"
}

@test "another version of the format, and none, are refused" {
    scenario
    sed -i '1s/1/2/' small.yaml
    refused 65 "small.yaml:1: schema_version: '2': this program reads version 1"
    scenario
    sed -i 1d small.yaml
    refused 65 "schema_version is missing"
}

@test "an empty name of a database is a wrong option" {
    scenario
    fails_with 64 mimdsim run small.yaml -o ''
    stderr_says "--output: '' is not the name of a file"
}

@test "a wrong number ends with status 1, is told, and its row says invalid" {
    scenario
    fails_with 1 mimdsim run small.yaml --quiet --set n=128 --set kernel.precision=float --set kernel.refinement=as-given
    stderr_says "differs from"
    sql_is mimdsim.db 'SELECT status, text LIKE "%differs from%" FROM run' 'invalid|1'
    sql_is mimdsim.db 'SELECT min(passed) FROM error_check' 0
}

@test "more ranks than bodies are refused with the line" {
    scenario
    sed -i 's/^ranks: n/ranks: [10, 12]/' small.yaml
    refused 78 "small.yaml:6: 10 ranks for 5 bodies: each rank needs at least one body"
}

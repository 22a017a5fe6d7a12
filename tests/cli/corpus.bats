#!/usr/bin/env bats
# corpus.bats - databases and large files that once broke the program, by every verb that reads them; a user's own views.

load helper

attacks=$MIMDSIM_SRCDIR/tests/data/attacks

# refused STATUS WHAT COMMAND...: it ends by itself with STATUS, one message and no crash.
refused() {
    local expected=$1 text=$2
    shift 2
    run --separate-stderr -- timeout 600 "$@"
    [ "$status" -eq "$expected" ] || { echo "expected $expected: $*"; show; return 1; }
    case $stderr in *"internal error"* | *Sanitizer* | *"runtime error:"*) show; return 1 ;; esac
    [[ $stderr == *"$text"* ]] || { echo "not told: $text"; show; return 1; }
}

@test "every damaged database is refused by every verb, with the file and what is wrong" {
    tar -xJf "$attacks/large.tar.xz"
    for db in level-null-method raw-1-21 raw-2-18 report-null-scenario span-view-overflow timeline-null-status; do
        case $db in
        level-null-method) why='NOT NULL constraint failed: ladder.method' ;;
        raw-1-21) why='NOT NULL constraint failed: run_setting.run_id' ;;
        raw-2-18) why='NOT NULL constraint failed: ladder.scenario' ;;
        report-null-scenario) why='cannot store BLOB value in TEXT column run.model' ;;
        span-view-overflow) why='view span already exists' ;;
        timeline-null-status) why='CHECK constraint failed: status' ;;
        esac
        cp $db.db before
        for verb in report 'plot fig5' 'plot fig6' 'timeline 1' claims 'query SELECT+1' check 'merge' 'why 1'; do
            set -- $verb
            case $1 in
            merge) refused 65 "$why" "$MIMDSIM" merge new.db $db.db ;;
            query) refused 65 "$why" "$MIMDSIM" query $db.db 'SELECT 1' ;;
            *) refused 65 "$why" "$MIMDSIM" "$1" $db.db ${2:+"$2"} ;;
            esac
            [[ $stderr == *"$db.db"* ]]
        done
        cmp $db.db before
    done
}

@test "sums beyond 64 bits are shown, and told by check" {
    tar -xJf "$attacks/large.tar.xz"
    works mimdsim report sum-overflow.db
    works mimdsim query sum-overflow.db 'SELECT * FROM v_indicator'
    fails_with 66 mimdsim timeline sum-overflow.db 1
    fails_with 1 mimdsim check sum-overflow.db
    stderr_says 'prices: '
}

@test "a file whose counts multiply beyond memory, and one that asks for a million runs, are refused" {
    tar -xJf "$attacks/large.tar.xz"
    refused 65 "of the 2147766336 numbers expected (17.2 GB of them)" "$MIMDSIM" verify M-overflow-segv.json
    for verb in check explain run plan; do refused 78 'has 1000000 runs' "$MIMDSIM" $verb million.yaml; done
}

@test "a user's own tables and views stay, and only the user's own queries run them" {
    works mimdsim run "$MIMDSIM_SRCDIR/tests/faults/small.yaml" -o a.db --quiet
    # The first would never end, the second changes the world if functions could, the third is of use.
    sqlite3 a.db "CREATE VIEW endless AS WITH RECURSIVE c(x) AS (VALUES (1) UNION ALL SELECT x + 1 FROM c) SELECT max(x) AS x FROM c;
        CREATE VIEW loader AS SELECT load_extension('/nowhere.so') AS x;
        CREATE VIEW quick AS SELECT kernel, makespan_ps FROM run;
        CREATE TABLE notes (run_id INTEGER, note TEXT); INSERT INTO notes VALUES (1, 'the first');
        CREATE INDEX by_note ON notes (note)"
    for command in 'report a.db' 'claims a.db' 'check a.db' 'why a.db 1' 'compare a.db a.db'; do
        run --separate-stderr -- timeout 600 "$MIMDSIM" $command
        case $status in 0 | 66) ;; *) echo "$command"; show; return 1 ;; esac
    done
    run --separate-stderr -- timeout 600 "$MIMDSIM" merge b.db a.db
    [ "$status" -eq 0 ]
    # writers keep them
    works mimdsim run "$MIMDSIM_SRCDIR/tests/faults/small.yaml" -o a.db --quiet --set n=5
    sql_is a.db "SELECT group_concat(name) FROM (SELECT name FROM sqlite_schema WHERE name IN ('endless', 'loader', 'quick', 'notes', 'by_note') ORDER BY 1)" \
        'by_note,endless,loader,notes,quick'
    works mimdsim query a.db 'SELECT count(*), note FROM quick, notes'
    stdout_says 'the first'
    fails_with 65 mimdsim query a.db 'SELECT * FROM loader'
    # what is called as ours must be ours; a trigger would act on our statements
    cp a.db c.db
    sqlite3 a.db 'DROP VIEW v_speedup; CREATE VIEW v_speedup AS SELECT 1 AS run_id'
    fails_with 65 mimdsim report a.db
    stderr_says "view 'v_speedup' is not the one that mimdsim makes"
    sqlite3 c.db "CREATE TRIGGER t AFTER INSERT ON run BEGIN DELETE FROM run; END"
    fails_with 65 mimdsim report c.db
    stderr_says "has a trigger 't'"
}

# check_database.bats - databases held against themselves: what runs store agrees, what was changed is told, row by row.
load helper

# make_database: four runs of a small chain.
make_database() {
    works mimdsim run speedup-t3e -o a.db -q --set n=2,4
    cp a.db whole.db
}

# changed SQL: a.db as it was, with this change.
changed() {
    cp whole.db a.db
    sqlite3 a.db "$1"
}

@test "what runs store contradicts nothing, and made again it is equal in every bit" {
    make_database
    works mimdsim check a.db
    stdout_says "a.db: ok: 4 runs, "
    stderr_is_empty
    works mimdsim check a.db --again all -q
    stdout_is_empty
    works mimdsim check --again 2 --seed 7 a.db
    stdout_says "2 runs made again, equal in every bit"
}

@test "failed and noisy runs, closed loops, robots and runs with all that is left out are held against themselves, too" {
    works mimdsim run four-bar -o a.db -q --set level=flit,auto
    works mimdsim run speedup-t3e -o a.db -q --set n=4 --set machine.noise.compute=5% --set seed=1,2
    works mimdsim run speedup-t3e -o a.db -q --set n=8 --keep-all
    # what people call a run is no answer of it
    works mimdsim run speedup-t3e -o a.db -q --set n=2 --name "Mine, links x2"
    fails_with 70 mimdsim run deadlock -o a.db -q
    # when nothing moved any more, and all ranks have waited or worked until then
    sql_is a.db "SELECT count(*), min(makespan_ps > 0), max(accounting_error_ps) FROM run WHERE status = 'deadlock'" '1|1|0'
    works mimdsim check a.db --again all
    stdout_says "equal in every bit"
}

@test "a changed row is told with its run, the rule and both values; the status is 1" {
    make_database
    while IFS='#' read -r change text; do
        changed "$change"
        fails_with 1 mimdsim check a.db
        stderr_says "a.db: run 2: $text"
        stderr_says "contradictions in 4 runs"
        stdout_is_empty
    done <<'END'
UPDATE run SET makespan_ps = makespan_ps + 1 WHERE id = 2#accounting: all stages take
UPDATE stage SET wait_sum_ps = wait_sum_ps - 1 WHERE run_id = 2 AND stage = 1#stages: stage 1: its parts take
UPDATE rank_times SET entries = json_replace(entries, '$[9][3]', 1 + json_extract(entries, '$[9][3]')) WHERE run_id = 2#ranks: rank 1 takes
UPDATE error_check SET passed = 0 WHERE run_id = 2 AND ordinal = 1#status: status ok, but qdd against aba has not passed
UPDATE error_check SET relative_error = 1 WHERE run_id = 2 AND ordinal = 1#passed: qdd against aba: error 1.0
UPDATE run SET status = 'invalid' WHERE id = 2#status: status invalid with the text ''
UPDATE run SET machine = 'paragon' WHERE id = 2#columns: machine is paragon; the configuration has another machine.name
UPDATE run SET P = 3 WHERE id = 2#columns: P is 3; the configuration has another ranks
UPDATE run SET config_text = replace(config_text, '480 MB/s', '481 MB/s') WHERE id = 2#identity: config_hash is
UPDATE run SET machine_changes = '{"node.flop_rate": "1 Mflop/s"}' WHERE id = 2#machine: machine_changes is
UPDATE baseline SET time_ps = time_ps / 2 WHERE run_id = 2 AND ordinal = 2#prices: 'rnea+aba' takes
DELETE FROM stage WHERE run_id = 2 AND stage = 3#numbers: of stages 0 to
UPDATE link_loads SET entries = json_remove(entries, '$[5]') WHERE run_id = 2#numbers: 
UPDATE link_loads SET entries = (SELECT json_set(entries, fullkey || '[5]', 8 + json_extract(value, '$[5]')) FROM json_each(entries) WHERE value ->> '$[5]' > 0 AND value ->> '$[1]' IS NOT NULL LIMIT 1) WHERE run_id = 2#links: router
DELETE FROM run_setting WHERE run_id = 2 AND setting_id IN (SELECT id FROM setting WHERE key = 'model.n')#settings: the configuration has
END
}

@test "a row that belongs to nothing is told by its number, or by its primary key where it has none" {
    make_database
    changed "UPDATE stage SET run_id = 77 WHERE run_id = 2 AND stage = 3"
    fails_with 1 mimdsim check a.db
    stderr_says "table stage, row run_id 77, stage 3 belongs to no row of table run"
    [[ $stderr != *'row ?'* ]] || { show; return 1; }
    changed "UPDATE link_loads SET run_id = 77 WHERE run_id = 2"
    fails_with 1 mimdsim check a.db
    stderr_says "table link_loads, row 77 belongs to no row of table run"
}

@test "what repeats nothing is found by making the run again" {
    make_database
    for change in "digest = '0000000000000000'" "events = events + 1" "residual = residual * 1.0000001"; do
        changed "UPDATE run SET $change WHERE id = 3"
        works mimdsim check a.db
        fails_with 1 mimdsim check a.db --again all
        stderr_says "a.db: run 3: again: table run: ${change%% =*} = "
        stderr_says "; made again: ${change%% =*} = "
    done
}

@test "the document tells every contradiction" {
    make_database
    changed "UPDATE run SET makespan_ps = 1 WHERE id = 2; DROP VIEW v_speedup"
    fails_with 1 mimdsim check --json a.db
    json_is_valid
    json_is '$[0].kind' check-failed
    json_is '$[0].exit_status' 1
    json_is '$[0].findings[0].rule' schema
    json_is '$[0].findings[0].text' 'view v_speedup is not as this program makes it'
    json_is '$[0].findings[1].run' 2
    json_is '$[0].runs' 4
}

@test "wrong numbers of runs, and files that are no databases of ours, are refused" {
    make_database
    fails_with 64 mimdsim check a.db --again some
    stderr_says "--again: 'some' is not a number of runs, nor 'all'"
    fails_with 64 mimdsim check a.db --seed -1
    sqlite3 other.db 'CREATE TABLE x (y)'
    fails_with 65 mimdsim check other.db
    stderr_says "other.db is a database of another program"
}

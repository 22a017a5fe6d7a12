# planted.bash - databases with invented runs, to see a verdict pass and fail. Load it after helper.

# template: a database with one real run, which the planted ones are copied from.
template() {
    printf '%s\n' 'schema_version: 1' 'question: One?' 'machine: t3e-300' \
        'model: {generator: serial-chain, joint: revolute, base: fixed, n: 2}' \
        'kernel: {name: dynamics, formulation: paper, solver: pcr-symmetric}' 'ranks: n' 'sweep: {level: [link]}' >one.yaml
    works mimdsim run one.yaml -o planted.db --quiet
    sqlite3 planted.db "CREATE TABLE kept AS SELECT * FROM run; CREATE TABLE kept_stage AS SELECT * FROM stage WHERE stage = 0;
                        DELETE FROM run; DELETE FROM baseline; DELETE FROM stage"
}

# plant SET BASELINES: a run with the columns of SET changed, and "name=time_ps ..." as its baselines.
plant() {
    local id
    id=$(sqlite3 planted.db "UPDATE kept SET id = ifnull((SELECT max(id) + 1 FROM run), 1), n = 2, P = 2,
        level = 'link', solver = 'pcr-symmetric', operators = 'structured', base = 'fixed', kernel = 'dynamics', machine = 't3e-300',
        makespan_ps = 1000000, scenario = 'planted', placement = 'linear';
        UPDATE kept SET config_hash = printf('%064d', id); UPDATE kept SET $1;
        INSERT INTO run SELECT * FROM kept; SELECT id FROM kept")
    local ordinal=0 b
    for b in $2; do
        sqlite3 planted.db "INSERT INTO baseline VALUES ($id, $ordinal, replace('${b%=*}', '_', ' '), ${b#*=}, 1, 0, 0, 0, 0, 0)"
        ordinal=$((ordinal + 1))
    done
    last_run=$id
}

# stage NAME TOTAL MESSAGES BYTES FLOPS WAIT: a stage of the last planted run, times summed over its ranks.
stages=0
stage() {
    stages=$((stages + 1))
    sqlite3 planted.db "UPDATE kept_stage SET run_id = $last_run, stage = $stages, name = '$1', total_sum_ps = $2, total_max_ps = $2,
        compute_sum_ps = $2 - $6, messages = $3, sent_bytes = $4, flops = $5, wait_sum_ps = $6, contention_sum_ps = 0;
        INSERT INTO stage SELECT * FROM kept_stage"
}

# fastest S: a baseline S times as slow as the run of a million picoseconds.
fastest() { echo "fastest_serial=$(($1 * 10000))"; }

# verdict ID VARIANT EXPECTED
verdict() {
    works mimdsim claims planted.db
    sql_is planted.db "SELECT verdict FROM claim WHERE id = '$1' AND variant = '$2'" "$3"
}

speedups() { # level, then P:S in hundredths ...
    local level=$1 p
    shift
    for p; do plant "level = '$level', n = ${p%:*}, P = ${p%:*}" "$(fastest "${p#*:}")"; done
}

# campaigns.bash - what the tests of campaigns share: load it after helper.

# rows DB: everything of every run that the host's clock and the order of insertion do not decide.
rows() {
    sql "$1" "SELECT config_hash, seed, rep, kernel, machine, n, P, status, digest, makespan_ps, messages, config_text FROM run
        ORDER BY config_hash, rep"
    for table in stage rank_stage baseline error_check span run_omission; do
        columns=$(sql "$1" "SELECT group_concat('t.\"' || name || '\"', ', ') FROM pragma_table_info('$table')
            WHERE name <> 'run_id'")
        sql "$1" "SELECT '$table', r.config_hash, $columns FROM $table t JOIN run r ON r.id = t.run_id" | sort
    done
    sql "$1" "SELECT r.config_hash, s.key, s.value FROM run_setting JOIN run r ON r.id = run_id
        JOIN setting s ON s.id = setting_id ORDER BY 1, 2"
}

# many N: own.yaml, a campaign of N short runs.
many() {
    printf '%s\n' 'schema_version: 1' 'question: Many?' 'machine: t3e-300' 'model: {generator: serial-chain}' \
        "n: [$(seq -s ', ' 501 $((500 + $1 / 2)))]" 'ranks: 16' 'level: [loggp, link]' 'kernel: dynamics' >own.yaml
}

# processes_of TEXT: the processes of this program whose command line has TEXT, one a line.
processes_of() {
    local pid
    for pid in $(pgrep -f -- "$1"); do
        [ "$(readlink "/proc/$pid/exe" 2>/dev/null)" = "$(readlink -f "$MIMDSIM")" ] && echo "$pid"
    done
    return 0
}

# kill_one TEXT SEED: kill -9 of one of these processes, after a moment; SEED says which and when.
kill_one() {
    local seed=$((($2 * 7919 + 104729) % 1000)) victims
    sleep "0.$(printf %03d $((150 + seed * 5 / 10)))"
    mapfile -t victims < <(processes_of "$1")
    [ ${#victims[@]} -eq 0 ] || kill -9 "${victims[$((seed % ${#victims[@]}))]}" 2>/dev/null || true
}

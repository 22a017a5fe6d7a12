# load.bats - mimdsim load: curves, rows, resuming, figures, and every wrong question.
load helper

setup_file() { :; }

@test "a curve is printed, stored and drawn" {
    small_mesh "4, 4"
    few=
    if sanitized; then few='--messages 20000'; fi
    # shellcheck disable=SC2086
    works mimdsim load small.yaml --rates 0.05,0.2:0.4:0.1,0.95 --traffic uniform -q $few
    stdout_says "small, routing deterministic, level packet, traffic uniform"
    stdout_says "16 nodes, messages of 4 flits, cycle 1 ns, empty network 15.5 ns, bound of the routes 1.0000"
    stdout_says "saturation at 0."
    sql_is mimdsim.db "SELECT group_concat(offered, ' ') FROM load_point WHERE NOT probe" "0.05 0.2 0.3 0.4 0.95"
    sql_is mimdsim.db "SELECT group_concat(status, ' ') FROM load_point WHERE NOT probe" "ok ok ok ok unstable"
    sql_is mimdsim.db "SELECT count(*) FROM load_point WHERE NOT probe AND mean_ps IS NULL" 1
    sql_is mimdsim.db "SELECT count(*) FROM load_series WHERE saturation BETWEEN saturation_low AND saturation_high AND saturation < bound" 1
    sql_is mimdsim.db "SELECT count(*) FROM load_point WHERE probe" "$(sql mimdsim.db 'SELECT probes FROM load_series')"
    # latencies rise with the load, and none is below the empty network's
    sql_is mimdsim.db "SELECT count(*) FROM load_point a JOIN load_point b USING (series) WHERE NOT a.probe AND NOT b.probe
        AND a.offered < b.offered AND a.mean_ps > b.mean_ps" 0
    [ -s figures/load-uniform.png ] && [ -s figures/load-uniform.svg ]
    grep -q "saturates at 0" figures/load-uniform.svg
}

@test "stored points are not measured again, and --force measures all" {
    small_mesh "4, 4"
    works mimdsim load small.yaml --messages 10000 --rates 0.1,0.2 -q
    first=$output
    sqlite3 mimdsim.db "UPDATE load_point SET host_s = 77; UPDATE load_point SET max_ps = 1234567 WHERE offered = 0.2 AND NOT probe"
    works mimdsim load small.yaml --messages 10000 --rates 0.1,0.2,0.3 -q
    stdout_says "1234.6"
    sql_is mimdsim.db "SELECT count(*) FROM load_point WHERE host_s <> 77" 1
    works mimdsim load small.yaml --messages 10000 --rates 0.1,0.2 -q --force
    stdout_is "$first"
    sql_is mimdsim.db "SELECT count(*) FROM load_point WHERE host_s = 77" 0
    # the saturation stays where it is not looked for again
    works mimdsim load small.yaml --messages 10000 --rates 0.1 -q --no-saturation
    sql_is mimdsim.db "SELECT count(*) FROM load_series WHERE saturation IS NOT NULL" 1
}

@test "what changes a point is another curve, what does not is the same" {
    small_mesh "4, 4"
    works mimdsim load small.yaml --rates 0.1 --no-saturation -q
    for change in "--size 32B" "--seed 2" "--within 5%" "--traffic transpose" "--level flit" "--software" \
        "--set machine.network.buffer=32" "--messages 20000" "--name other"; do
        # shellcheck disable=SC2086
        works mimdsim load small.yaml --rates 0.1 --no-saturation -q $change
    done
    sql_is mimdsim.db "SELECT count(*) FROM load_series" 10
    works mimdsim load small.yaml --rates 0.1 --no-saturation -q --set machine.node.flop_rate="2 Gflop/s" --name small
    works mimdsim load small.yaml --rates 0.1 --no-saturation -q --jobs 1
    sql_is mimdsim.db "SELECT count(*) FROM load_series" 10
    # message software with a gap of a microsecond lets no more than 4 flits through in it
    sql_is mimdsim.db "SELECT status FROM load_point JOIN load_series USING (series) WHERE machine LIKE '%software'" unstable
}

@test "several threads give the rows of one" {
    small_mesh "4, 4"
    works mimdsim load small.yaml --rates 0.1:0.5:0.2 --messages 10000 --traffic uniform,bitcomp -q -o one.db --jobs 1
    one=$output
    works mimdsim load small.yaml --rates 0.1:0.5:0.2 --messages 10000 --traffic uniform,bitcomp -q -o four.db --jobs 4
    stdout_is "$one"
    columns="series, offered, probe, status, created, accepted, mean_ps, half_ps, p99_ps, max_ps, messages, events"
    [ "$(sql one.db "SELECT $columns FROM load_point ORDER BY 1, 2, 3")" = "$(sql four.db "SELECT $columns FROM load_point ORDER BY 1, 2, 3")" ]
}

@test "machines, levels, routings and traffic are curves; a document has them all" {
    small_mesh "4, 4"
    sed 's/mesh/torus/; s/  level/  virtual_channels: 2\n  level/' small.yaml >torus.yaml
    works mimdsim load small.yaml torus.yaml --level link,auto --traffic "tornado(4,2),shift(1)" --rates 0.1 --no-saturation -q --json
    json_is '$[0].series.traffic' "tornado(4,2)"
    json_is '$[0].series.machine' small
    json_is '$[1].series.level' auto
    json_is '$[2].series.machine' torus
    json_is '$[7].series.traffic' "shift(1)"
    json_is '$[7].points[0].status' ok
    sed 's/mesh/fat-tree/; s/\[4, 4\]/[4, 2]/' small.yaml >fat.yaml
    works mimdsim load fat.yaml --rates 0.1 --no-saturation -q --routing deterministic,nca
    stdout_says "routing nca"
}

@test "a figure has a curve for each level, and a section" {
    small_mesh "4, 4"
    works mimdsim load small.yaml --level link,packet,flit --rates 0.1,0.3 --no-saturation -q
    sql_is mimdsim.db "SELECT group_concat(level, ' ') FROM (SELECT level FROM load_series ORDER BY level)" "flit link packet"
    for level in link packet flit; do grep -q ">$level<" figures/load-uniform.svg; done
    works mimdsim plot mimdsim.db load
    works mimdsim report mimdsim.db -q --dir told
    works grep -q "load-uniform" -r told
}

@test "a figure names what was changed of a machine, long names below each other" {
    small_mesh "4, 4"
    local buffer places
    for buffer in 32 64; do
        works mimdsim load small.yaml --rates 0.1 --no-saturation -q --set machine.network.buffer=$buffer \
            --set machine.network.credit_latency='3 ns' --set machine.network.hop_latency='5 ns'
        grep -q "network.buffer=$buffer" figures/load-uniform.svg
    done
    # the titles begin at one place
    places=$(grep -B1 'network.buffer=' figures/load-uniform.svg | grep -o 'translate([0-9.]*' | sort -u | wc -l)
    [ "$places" -eq 1 ]
}

@test "the messages of a stored run are traffic, at any speed and on any machine" {
    small_mesh "4, 4"
    works mimdsim run speedup-t3e --set n=32 --set ranks=16 --set record.spans=true -q -o program.db
    run=$(sql program.db "SELECT max(run_id) FROM span")
    works mimdsim load small.yaml --traffic "program.db:$run" --rates 0.01,0.05 --no-saturation -q
    stdout_says "traffic program.db:$run"
    stdout_says "16 nodes"
    stdout_says "as recorded: load "
    sql_is mimdsim.db "SELECT count(*) FROM load_point WHERE status IN ('ok', 'wide') AND abs(accepted / offered - 1) < 0.1" 2
    sql_is mimdsim.db "SELECT message_bytes IS NULL FROM load_series" 1
    ls figures | grep -q '^load-program.*svg$'
    fails_with 66 mimdsim load small.yaml --traffic nothing.db:1
    fails_with 64 mimdsim load small.yaml --traffic program.db:x
    stderr_says "expected a pattern, or DATABASE:RUN"
    fails_with 66 mimdsim load small.yaml --traffic program.db:999
    works mimdsim run pingpong -q -o plain.db
    fails_with 66 mimdsim load small.yaml --traffic plain.db:1
    # a series that has no point yet, beside one that has
    sqlite3 mimdsim.db "INSERT INTO load_series SELECT 'x', machine, routing, level, 'a', nodes, message_bytes, message_flits, cycle_ps,
        empty_ps, bound, saturation, saturation_low, saturation_high, probes, note FROM load_series"
    works mimdsim plot mimdsim.db load
    # messages that no run sends
    while IFS='#' read -r text change; do
        cp program.db damaged.db
        sqlite3 damaged.db "UPDATE span SET $change WHERE run_id = $run AND kind = 'send'"
        fails_with 65 mimdsim load small.yaml --traffic "damaged.db:$run" --rates 0.01 --no-saturation
        stderr_says "$text"
        fails_with 65 mimdsim timeline damaged.db "$run" --format text
    done <<'END'
9223372036854775807 bytes; expected#bytes = 9223372036854775807
-1 bytes; expected#bytes = -1
peer 16, kind 'send'#peer = 16
peer 2147483648, kind 'send'#peer = 2147483648
END
    sed 's/4, 4/2, 2/' small.yaml >tiny.yaml
    fails_with 78 mimdsim load tiny.yaml --traffic "program.db:$run" -q
    stderr_says "16"
}

@test "an interrupted curve goes on where it was" {
    small_mesh "8, 8"
    few=
    if sanitized; then few='--messages 40000'; fi
    # shellcheck disable=SC2086
    run timeout -s INT 1 "$MIMDSIM" load small.yaml --rates 0.02:1 --jobs 1 $few
    [ "$status" -ne 0 ]
    [[ $output == *"interrupted: what is stored stays"* ]]
    stored=$(sql mimdsim.db "SELECT count(*) FROM load_point")
    sqlite3 mimdsim.db "UPDATE load_point SET host_s = 77"
    # shellcheck disable=SC2086
    works mimdsim load small.yaml --rates 0.1,0.2 -q $few
    [ "$(sql mimdsim.db 'SELECT count(*) FROM load_point WHERE host_s = 77')" -eq "$stored" ]
}

@test "a database without the tables gets them, and merges have them" {
    small_mesh "4, 4"
    works mimdsim run pingpong -q
    sqlite3 mimdsim.db "DROP TABLE load_point; DROP TABLE load_series"
    cp mimdsim.db without.db
    works mimdsim load small.yaml --rates 0.1 --no-saturation -q
    sql_is mimdsim.db "SELECT count(*) FROM load_point" 1
    works mimdsim merge all.db without.db mimdsim.db
    sql_is all.db "SELECT count(*) FROM load_point JOIN load_series USING (series)" 1
}

@test "wrong questions are refused with the value and what was expected" {
    small_mesh "4, 4"
    while IFS='#' read -r status text arguments; do
        eval "fails_with $status mimdsim load $arguments"
        stderr_says "$text"
        stdout_is_empty
        [ ! -e mimdsim.db ] || { echo "made a database: $arguments"; return 1; }
    done <<'END'
64#an argument is missing#
64#--rates: 1.5; expected loads above 0 and up to 1#small.yaml --rates 1.5
64#--rates: 0; expected loads above 0#small.yaml --rates 0:0.5
64#'0.5:0.1'; expected LOW:HIGH#small.yaml --rates 0.5:0.1
64#'0.1:0.5:0'; expected LOW:HIGH#small.yaml --rates 0.1:0.5:0
64#--rates: more than 256 loads#small.yaml --rates 0.1:0.9:0.001
64#'x' is not a number#small.yaml --rates 0.1,x
64#has an empty entry#small.yaml --rates 0.1,,0.2
64#has an empty entry#small.yaml --traffic uniform,
65#did you mean 'uniform'#small.yaml --traffic unifrom
69#pattern 'spiral' is not supported; known: uniform#small.yaml --traffic spiral
65#needs a dragonfly#small.yaml --traffic badrandom
64#did you mean 'packet'?#small.yaml --level paket
64#there is no level 'x'; known: loggp#small.yaml --level x
65#deterministic#small.yaml --routing upwards
64#--size: '0 B'; expected 1 B to 1 GiB#small.yaml --size '0 B'
64#--size: '64'#small.yaml --size 64
64#--within: 'x'; expected an error such as 2%#small.yaml --within x
64#--within: '200%'#small.yaml --within 200%
64#--messages: '5'; expected a whole number from 10000 to#small.yaml --messages 5
64#--seed: '-1'; expected a whole number from 0 to#small.yaml --seed -1
64#name the machines as arguments#small.yaml --machine t3e-300
64#--only picks points of a scenario#small.yaml --only 'n > 2'
66#no machine 'nothing-like-it'#nothing-like-it
64#write the option in full#small.yaml --rate 0.1
64#unknown option '--trafic'; did you mean '--traffic'?#small.yaml --trafic uniform
78#buffer#small.yaml --set machine.network.buffer=1
END
}

@test "links that hold many messages are measured with larger ones, unless a size is asked for" {
    works mimdsim load what-if-torus --no-saturation --rates 0.1 --messages 10000 --level link
    [[ "$stderr" == *"messages of 16384 B"*"--size chooses others"* ]]
    sql_is mimdsim.db "SELECT message_bytes || ' ' || status FROM load_series JOIN load_point USING (series)" "16384 ok"
    fails_with 78 mimdsim load what-if-torus --no-saturation --rates 0.1 --messages 10000 --level link --size 64B
    [[ "$stderr" == *"larger ones (--size)"* ]]
}

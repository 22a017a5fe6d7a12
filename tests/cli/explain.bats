#!/usr/bin/env bats
# explain.bats - what would make a claim hold: a closed form is found, the impossible is told as such, and the search goes
# on where it was killed, with the same answers on any number of workers.

load helper

# toy TEST MARGIN HEADER...: a data folder with one machine, one scenario and one claim about runs on two processors.
toy() {
    local test=$1 margin=$2
    shift 2
    mkdir -p data/machines data/scenarios data/plots/claims
    cp "$MIMDSIM_DATA"/plots/*.sql "$MIMDSIM_DATA"/plots/*.gp data/plots/
    printf '%s\n' 'schema_version: 1' 'title: Two processors on a wire' 'topology: {family: crossbar, dims: [2]}' \
        'node: {flop_rate: {value: 10 Mflop/s, min: 5 Mflop/s, max: 20 Mflop/s}, clock: 100 MHz}' \
        'network: {link: {bandwidth: 1 GB/s}, hop_latency: 50 us, end_latency: 0 s}' 'software: {}' >data/machines/toy.yaml
    printf '%s\n' 'schema_version: 1' 'question: Toy?' 'machine: toy' \
        'model: {generator: serial-chain, joint: revolute, base: fixed, n: 4}' \
        'kernel: {name: dynamics, formulation: paper, solver: pcr-symmetric}' 'ranks: 2' 'level: link' >data/scenarios/pair.yaml
    {
        printf '%s\n' '-- statement: The toy is fast.' "-- test: $test" '-- unit: S' '-- designated: fastest serial' \
            '-- judged: the toy' '-- points: toy' '-- needs: mimdsim run pair' '-- explore: pair' "$@"
        echo "SELECT 'fastest serial' AS variant, speedup AS value, 1 AS threshold, $margin >= 0 AS holds, NULL AS missing, 'toy' AS note,"
        echo "       $margin AS margin FROM v_speedup WHERE machine = 'toy' AND baseline = 'fastest serial';"
    } >data/plots/claims/T1.sql
    export MIMDSIM_DATA=$PWD/data
    works mimdsim run pair -o toy.db --quiet
}

answer() { sqlite3 toy.db "SELECT $1 FROM explain_answer WHERE subject = 'T1' AND goal = 'own'"; }

@test "a speedup that a slower node gives is found where the closed form has it" {
    # S = W_serial / r / (W_parallel / r + L) with the rate r: two runs give all three numbers
    toy 'S is at least 0.3' 'speedup - 0.3'
    works mimdsim run pair -o two.db --set machine.node.flop_rate='10 Mflop/s,20 Mflop/s' --quiet
    sqlite3 two.db "SELECT 1.0 * b.time_ps / r.makespan_ps FROM run r JOIN baseline b ON b.run_id = r.id AND b.name = 'fastest serial'" >s.txt
    works mimdsim claims --explain toy.db --quiet
    [ "$(answer verdict)" = holds ]
    [ "$(answer confirmed)" = 1 ]
    # the serial code alone: S is inversely proportional to its rate
    sqlite3 toy.db "SELECT j.value - 0.3, abs(j.value / 0.3 - 1) < 0.03 FROM explain_answer a JOIN explain_point p ON p.settings = a.settings
        JOIN explain_judged j ON j.point_id = p.id WHERE a.goal = 'own'" >near.txt
    grep -q '|1$' near.txt
    # its distance is not longer than that of the closed form: the serial rate alone
    nominal=$(head -1 s.txt)
    [ "$(sqlite3 :memory: "SELECT $(answer distance) <= ln(0.3 / $nominal) + 0.03")" = 1 ]
    stdout_says 'T1 holds'
    [ "$(sqlite3 toy.db 'SELECT count(*) FROM explain_judged WHERE holds <> (margin >= 0)')" = 0 ]
    [ "$(sqlite3 toy.db 'SELECT count(*) FROM explain_map')" = 121 ]
    [ -s figures/explain-T1.csv ]
}

@test "a claim with two bounds is found between nothing and an end where it fails" {
    toy 'S is at least 0.3' 'speedup - 0.3'
    nominal=$(sqlite3 toy.db "SELECT speedup FROM v_speedup WHERE baseline = 'fastest serial'")
    rm -r data toy.db; unset MIMDSIM_DATA; MIMDSIM_DATA=$MIMDSIM_SRCDIR
    # 9 to 10 % above nominal: the serial code alone does it, 9 % slower, and at ten times slower it is far beyond
    toy 'S is 9 to 10 % higher' "min(speedup / $nominal - 1.09, 1.1 - speedup / $nominal)"
    works mimdsim claims --explain toy.db --quiet
    [ "$(answer verdict)" = holds ]
    [ "$(answer settings)" != '' ]
    [ "$(sqlite3 toy.db "SELECT distance < ln(1.1) + 0.005 FROM explain_answer WHERE goal = 'own'")" = 1 ]
}

@test "what cannot be is told as not found, with the points that were tried; a reason makes it never" {
    toy 'S is at least 1000000' 'speedup / 1e6 - 1'
    works mimdsim claims --explain toy.db --quiet
    [ "$(answer verdict)" = 'not found' ]
    stdout_says 'no point was found'
    [ "$(answer points)" -gt 30 ]
    rm -r data toy.db; unset MIMDSIM_DATA; MIMDSIM_DATA=$MIMDSIM_SRCDIR
    toy 'S is negative' '-speedup' '-- never: times are positive'
    works mimdsim claims --explain toy.db --quiet
    [ "$(answer verdict)" = never ]
    stdout_says 'times are positive'
}

@test "the same answers on any number of workers, and after being killed" {
    plain_build_only
    toy 'S is at least 0.3' 'speedup - 0.3'
    cp toy.db second.db; cp toy.db third.db
    works mimdsim claims --explain toy.db --quiet --jobs 1
    first=$output
    works mimdsim claims --explain second.db --quiet --jobs 4
    [ "$output" = "$first" ]
    points='SELECT key, settings, distance FROM explain_point ORDER BY id'
    [ "$(sqlite3 toy.db "$points")" = "$(sqlite3 second.db "$points")" ]
    # killed after some points: those stay, the rest follows, and the answer is the same
    "$MIMDSIM" claims --explain third.db --quiet >/dev/null 2>&1 & pid=$!
    for _ in $(seq 200); do
        [ "$(sqlite3 third.db 'SELECT count(*) > 20 FROM explain_point' 2>/dev/null)" != 1 ] || break
        sleep 0.02
    done
    kill -9 $pid 2>/dev/null || true
    wait $pid 2>/dev/null || true
    works mimdsim claims --explain third.db --quiet
    [ "$output" = "$first" ]
    # and once more nothing is run
    count=$(sqlite3 third.db 'SELECT max(id) FROM explain_point')
    works mimdsim claims --explain third.db --quiet
    [ "$(sqlite3 third.db 'SELECT max(id) FROM explain_point')" = "$count" ]
}

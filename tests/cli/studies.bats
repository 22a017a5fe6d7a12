#!/usr/bin/env bats
# studies.bats - sweeps with conditions, samples, searches and uncertainty: what is run, stored, told and refused.

load helper

# scenario LINE...: a chain of 16 bodies on the T3E at level loggp, with these lines besides, as s.yaml.
scenario() {
    printf '%s\n' 'schema_version: 1' 'question: what?' 'machine: t3e-300' 'model: {generator: serial-chain}' \
        'kernel: dynamics' 'level: loggp' "$@" >s.yaml
}

@test "conditions leave points out: on sizes, settings, and what follows from them" {
    scenario 'ranks: [2, 4, 8, 256]' 'n: [4, 8, 256]' 'when: [P <= machine.processors, "n % P == 0"]'
    works mimdsim run s.yaml -o s.db --quiet
    sql_is s.db "SELECT group_concat(n || '/' || P, ' ') FROM (SELECT n, P FROM run ORDER BY P, n)" \
        '4/2 8/2 256/2 4/4 8/4 256/4 8/8 256/8'
    # below `sweep`, and in one text
    scenario 'sweep: {ranks: [2, 4, 8], n: [4, 8], when: "n >= 2 * P and kernel.solver == pcr-symmetric"}'
    works mimdsim plan s.yaml --json
    json_is '$[#-1].n' 8
    json_is '$[#-1].P' 4
    works mimdsim run s.yaml -o t.db --quiet
    sql_is t.db "SELECT group_concat(n || '/' || P, ' ') FROM (SELECT n, P FROM run ORDER BY P, n)" '4/2 8/2 8/4'
}

@test "--only picks points of any plan, and composes with the scenario's own conditions" {
    works mimdsim run speedup-t3e --only 'n >= 96 and level == loggp' -o only.db --quiet
    sql_is only.db "SELECT group_concat(level || n, ' ') FROM (SELECT * FROM run ORDER BY n)" 'loggp96 loggp128'
    # nothing new: what is picked is stored already
    works mimdsim run speedup-t3e --only 'n == 128 and level == loggp' -o only.db --quiet
    sql_is only.db 'SELECT count(*) FROM run' 2
    [ "$(grep -c loggp <<<"$output")" -eq 1 ]
    works mimdsim explain speedup-t3e --only 'n == 128'
    fails_with 78 mimdsim run speedup-t3e --only 'n > 4096' -o none.db
    stderr_says '--only excludes all runs'
    rm only.db*
    nothing_left_behind
}

@test "conditions that make no sense are refused with their place" {
    fails_with 64 mimdsim run speedup-t3e --only 'n >= ' -o none.db
    stderr_says "--only: condition 'n >= ': expected a number or a name at its end"
    fails_with 64 mimdsim run speedup-t3e --only 'rank >= 2' -o none.db
    stderr_says "unknown name 'rank'; did you mean 'ranks'?"
    fails_with 64 mimdsim run speedup-t3e --only 'machine.network.link.bandwith > 1 GB/s' -o none.db
    stderr_says "did you mean 'machine.network.link.bandwidth'?"
    fails_with 64 mimdsim run speedup-t3e --only 'machine.network.hop_latency > 60' -o none.db
    stderr_says "a time on the left of '>', a bare number on the right"
    fails_with 64 mimdsim run speedup-t3e --only 'n' -o none.db
    stderr_says 'a value, not a condition'
    nothing_left_behind
    scenario 'n: 4' 'ranks: n' 'when: n => 4'
    fails_with 65 mimdsim run s.yaml -o none.db
    stderr_says "s.yaml:9: condition 'n => 4': a single '=' where '==' was meant"
    scenario 'n: 4' 'ranks: n' 'when: {n: 4}'
    fails_with 65 mimdsim run s.yaml -o none.db
    stderr_says 's.yaml:9: when:'
}

@test "a sample is a sweep: the same points again, with lists, and beside other axes" {
    scenario 'ranks: 4' 'sweep:' '  seed: [1, 2]' '  sample:' '    points: 8' '    method: sobol' '    of:' \
        '      machine.network.link.bandwidth: {from: 100 MB/s, to: 1 GB/s}' \
        '      n: {from: 4, to: 32, scale: linear}' '      kernel.solver: [cr, pcr-symmetric]'
    works mimdsim run s.yaml -o s.db --quiet
    sql_is s.db 'SELECT count(*), count(DISTINCT n) FROM run' '16|8'
    sql_is s.db "SELECT count(*) FROM run WHERE n BETWEEN 4 AND 32" 16
    sql_is s.db "SELECT group_concat(c) FROM (SELECT count(*) AS c FROM run GROUP BY solver)" '8,8'
    # the first point of a Sobol' sequence is the middle: of a logarithm, and of a line
    sql_is s.db "SELECT DISTINCT value FROM v_setting JOIN run ON run.id = run_id WHERE key = 'machine.network.link.bandwidth' AND n = 18" \
        '316.2 MB/s'
    cp s.db before.db
    works mimdsim run s.yaml -o s.db --quiet
    sql_is s.db 'SELECT count(*), max(id) FROM run' "$(sql before.db 'SELECT count(*), max(id) FROM run')"
    for method in latin-hypercube halton random; do
        sed "s/sobol/$method/" s.yaml >other.yaml
        works mimdsim run other.yaml -o other-$method.db --quiet
        sql_is other-$method.db 'SELECT count(*) FROM run' 16
    done
}

@test "samples that make no sense are refused with line and nearest name" {
    scenario 'ranks: 4' 'sweep: {sample: {points: 8, of: {n: {from: 4, to: 32, scal: linear}}}}'
    fails_with 65 mimdsim run s.yaml -o none.db
    stderr_says "s.yaml:8: model.n: unknown key 'scal'; did you mean 'scale'?"
    scenario 'ranks: 4' 'sweep: {sample: {points: 8, method: sobl, of: {n: {from: 4, to: 32}}}}'
    fails_with 65 mimdsim run s.yaml -o none.db
    stderr_says "did you mean 'sobol'?"
    scenario 'ranks: 4' 'sweep: {sample: {points: 8, of: {kernel.solver: {from: cr, to: pcr}}}}'
    fails_with 65 mimdsim run s.yaml -o none.db
    stderr_says 'kernel.solver: no number, so it has no range'
    scenario 'ranks: 4' 'sweep: {sample: {points: 8, of: {n: {from: 32, to: 4}}}}'
    fails_with 65 mimdsim run s.yaml -o none.db
    stderr_says "model.n: 'from' has to be below 'to'"
    scenario 'ranks: 4' 'sweep: {sample: {points: 1e9, of: {n: {from: 4, to: 32}}}}'
    fails_with 65 mimdsim run s.yaml -o none.db
    stderr_says 'sample: points:'
    scenario 'ranks: 4' 'n: 8' 'sweep: {sample: {points: 8, of: {n: {from: 4, to: 32}}}}'
    fails_with 65 mimdsim run s.yaml -o none.db
    stderr_says "'model.n' is swept here and set for all runs in line 8"
    scenario 'ranks: 4' 'sweep: {n: [4, 8], sample: {points: 8, of: {n: {from: 4, to: 32}}}}'
    fails_with 65 mimdsim run s.yaml -o none.db
    stderr_says "'model.n' is swept here and sampled in line 8"
    scenario 'ranks: 4' 'sweep: {seed: [1, 2], sample: {points: 60000, of: {n: {from: 4, to: 32}}}}'
    fails_with 78 mimdsim run s.yaml -o none.db
    stderr_says 'the sweep has 120000 runs; expected at most 100000'
    rm s.yaml
    nothing_left_behind
}

# documented PAGE: its indented blocks in order: after "Save this as `NAME`:" a file, else commands that have to work.
documented() {
    awk '/^    / { block = block substr($0, 5) "\n"; next }
         /^$/ { if (block != "") block = block "\n"; next }
         { if (block != "") finish(); kept = $0 }
         function finish() {
             sub(/\n+$/, "\n", block)
             n = split(block, part, "\n\n")
             for (i = 1; i <= n; i++)
                 if (i == 1 && match(kept, /Save this as `[^`]*`:/)) {
                     split(substr(kept, RSTART, RLENGTH), name, "`")
                     printf "cat >%s <<\"END\"\n%s\nEND\n", name[2], part[i]
                 } else print part[i]
             block = ""
         }
         END { if (block != "") finish() }' "$MIMDSIM_SRCDIR/docs/$1" | sed 's/^mimdsim \(.*\)$/works mimdsim \1/'
}

@test "the commands of docs/studies.md work in their order" {
    documented studies.md >commands
    [ "$(grep -c '^works mimdsim' commands)" -ge 4 ]
    # shellcheck disable=SC1091
    source ./commands
}

@test "uncertainty: bands around the prediction, shares that add up, and nothing is made twice" {
    works mimdsim run speedup-t3e --only 'n == 8' --uncertainty 16 -o u.db --quiet
    stdout_says 'software.recv.overhead'
    sql_is u.db "SELECT count(*), min(low < median AND median < high), min(samples), max(failed) FROM uncertainty" '4|1|32|0'
    # what the band is around is the run itself
    sql_is u.db "SELECT count(*) FROM uncertainty u JOIN run r ON r.id = u.run_id WHERE quantity = 'makespan_ps' AND nominal = makespan_ps" 2
    # nearly additive: the total shares make about one, as far as so few samples can tell
    sql_is u.db "SELECT min(s) > 0.3 AND max(s) < 2 FROM (SELECT sum(total) AS s FROM uncertainty_share WHERE quantity = 'makespan_ps' GROUP BY run_id)" 1
    # a parameter with a range by its class, and none that is a fact of the design
    sql_is u.db "SELECT DISTINCT class, printed, round(high / low, 3) FROM uncertainty_share WHERE key = 'machine.software.send.copy'" 'D|0|2.56'
    sql_is u.db "SELECT count(*) FROM uncertainty_share WHERE key IN ('machine.node.clock', 'machine.network.flit')" 0
    before=$(sql u.db 'SELECT total(makespan_ps), count(*) FROM uncertainty_sample')
    works mimdsim run speedup-t3e --only 'n == 8' --uncertainty 16 -o u.db
    stderr_is 'mimdsim: 2 of 2 runs are stored already (--force repeats them)'
    sql_is u.db 'SELECT total(makespan_ps), count(*) FROM uncertainty_sample' "$before"
    # the same samples with any number of workers
    works mimdsim run speedup-t3e --only 'n == 8' --uncertainty 16 -o one.db --quiet -j 1
    sql_is one.db 'SELECT total(makespan_ps), count(*) FROM uncertainty_sample' "$before"
}

@test "uncertainty: bands alone, what is set is not drawn, and what cannot be is refused" {
    works mimdsim run speedup-t3e --only 'n == 8' --uncertainty 16 --bands-only -o b.db --quiet
    sql_is b.db 'SELECT count(*), count(DISTINCT run_id) FROM uncertainty_sample' '64|2'
    sql_is b.db 'SELECT count(first) FROM uncertainty_share' 0
    works mimdsim run speedup-t3e --only 'n == 8' --uncertainty 8 -o b.db --quiet --set machine.software.recv.overhead='5 us'
    sql_is b.db "SELECT count(*) FROM uncertainty_share s JOIN v_setting v ON v.run_id = s.run_id AND v.key = s.key
        WHERE s.key = 'machine.software.recv.overhead' AND v.value = '5 us'" 0
    # a machine of which everything is given: not known is said
    printf '%s\n' 'schema_version: 1' 'base: ideal' 'title: mine' 'node: {flop_rate: 100 Mflop/s, div: 1 cycles, sqrt: 1 cycles, trig: 1 cycles}' >mine.yaml
    works mimdsim run speedup-t3e -m mine.yaml --only 'n == 8' --uncertainty 8 -o i.db
    stderr_says 'the uncertainty is not known'
    sql_is i.db 'SELECT count(*) FROM uncertainty' 0
    for wrong in 3 1e9 -5 x ''; do
        fails_with 64 mimdsim run speedup-t3e --uncertainty "$wrong" -o none.db
        stderr_says 'is not a number of samples from 4 to 10000'
    done
    fails_with 64 mimdsim run speedup-t3e --bands-only -o none.db
    fails_with 78 mimdsim run speedup-t3e --uncertainty 10000 -o none.db
    stderr_says 'expected at most 100000'
    rm [bi].db* mine.yaml
    nothing_left_behind
}

@test "the table of run: columns that say something, how far each time is known, chosen ones, and CSV" {
    works mimdsim run speedup-t3e --only 'n == 8' -o t.db --quiet
    stdout_says 'level_error  machine_error  arithmetic_error'
    stdout_says 'not known    not known      5.6e-13'
    [[ $output != *measured_us* && $output != *message* && $output != *digest* ]] || { show; return 1; }
    # the same table knows more once more is known: the level by a ladder of such runs, the machine by samples
    works mimdsim accuracy speedup-t3e --only 'n == 8' -o t.db --quiet
    works mimdsim run speedup-t3e --only 'n == 8' -o t.db --quiet --uncertainty 8 --bands-only
    [[ $output != *'not known'* ]] || { show; return 1; }
    sql_is t.db "SELECT count(*), min(machine_low < 0), min(machine_high > 0), min(level_error >= 0) FROM v_known_error" '2|1|1|1'
    # micro-benchmarks have other columns: no body, no speedup
    works mimdsim run pingpong --only 'kernel.message == 8 B' -o p.db --quiet
    stdout_says measured_us
    [[ $output != *speedup* && $output != *solver* ]] || { show; return 1; }
    works mimdsim run speedup-t3e --only 'n == 8' -o t.db --quiet --columns P,makespan_us,digest
    stdout_is "P  makespan_us  digest
8      609.722  $(sql t.db "SELECT digest FROM run WHERE level = 'link'")
8      609.379  $(sql t.db "SELECT digest FROM run WHERE level = 'loggp'")"
    works mimdsim run speedup-t3e --only 'n == 8' -o t.db --quiet --csv
    stdout_says 'machine,kernel,formulation,solver,message,level,n,P,makespan_us,level_error,machine_low,machine_high'
    [ "$(wc -l <<<"$output")" -eq 3 ]
    fails_with 64 mimdsim run speedup-t3e --only 'n == 8' -o t.db --quiet --columns n,makespan
    stderr_says "no column 'makespan'; did you mean 'makespan_us'?"
    fails_with 64 mimdsim run speedup-t3e -o none.db --columns
    [ ! -e none.db ]
}

@test "on a terminal the table is as wide as the terminal, and says what it left out" {
    command -v script >/dev/null || skip 'no script(1)'
    works mimdsim run speedup-t3e --only 'n >= 96' -o t.db --quiet
    for width in 130 80 50; do
        COLUMNS=$width script -qec "'$MIMDSIM' run speedup-t3e --only 'n >= 96' -o t.db --quiet" /dev/null </dev/null |
            tr -d '\r' >out
        [ "$(awk '{ if (length($0) > n) n = length($0) } END { print n }' out)" -le "$width" ] || { cat out; return 1; }
        grep -q 1269.97 out
    done
    grep -q 'in all rows: machine t3e-300' out
    grep -q 'left out for' out
}

@test "what does not suit a machine is a row with its reason, told three times at most, and the others run" {
    fails_with 1 mimdsim run speedup-t3e --set machine.placement.kind=gray,linear --only 'n <= 8 and level == link' -o g.db --quiet
    [ "$(grep -c 'placement.kind gray needs a hypercube' <<<"$stderr")" -eq 4 ]
    stderr_says 'mimdsim: and 2 more: --set: placement.kind gray needs a hypercube'
    stderr_says '5 of 10 runs failed'
    sql_is g.db "SELECT status, count(*) FROM run GROUP BY 1" $'failed|5\nok|5'
    fails_with 1 mimdsim run speedup-t3e --set machine.topology.family=fat-tree,torus --only 'n == 8' -o f.db --quiet --csv
    stdout_says 'topology.dims has 3 numbers; its family takes 2'
    # a machine that is too small refuses the points that it cannot hold alone
    fails_with 1 mimdsim run speedup-t3e -m quad-ppro --only 'n <= 6 and level == loggp' -o q.db --quiet
    sql_is q.db "SELECT group_concat(P || ' ' || status, ', ') FROM (SELECT * FROM run ORDER BY P)" '2 ok, 3 ok, 4 ok, 6 failed'
}

@test "optimise: the best listed setting for each point of the other axes, and every run is a row" {
    scenario 'ranks: n' 'sweep: {n: [16, 64]}' 'optimise: {least: makespan, over: {kernel.solver: [cr, pcr, pcr-symmetric]}}'
    works mimdsim run s.yaml -o o.db --quiet
    sql_is o.db 'SELECT count(*) FROM run' 6
    sql_is o.db 'SELECT o.ordinal, r.n, o.tried, o.value = r.makespan_ps / 1e12 FROM optimum o JOIN run r ON r.id = o.run_id' $'0|16|3|1\n1|64|3|1'
    # what it found is what a query finds
    sql_is o.db 'SELECT count(*) FROM optimum o JOIN run r ON r.id = o.run_id JOIN run q ON q.n = r.n WHERE q.makespan_ps < r.makespan_ps' 0
    # greatest is the other end; a limit that nothing keeps is said
    scenario 'ranks: n' 'n: 16' 'optimise: {greatest: makespan, over: {kernel.solver: [cr, pcr, pcr-symmetric]}}'
    works mimdsim run s.yaml -o o.db --quiet
    sql_is o.db 'SELECT r.makespan_ps = (SELECT max(makespan_ps) FROM run WHERE n = 16) FROM optimum o JOIN run r ON r.id = o.run_id' 1
    scenario 'ranks: n' 'n: 16' 'optimise: {least: makespan, within: speedup > 100, over: {kernel.solver: [cr, pcr]}}'
    works mimdsim run s.yaml -o o.db --quiet --json
    json_is '$[0].holds' no
    # points that cannot run are no candidates
    scenario 'sweep: {n: [256]}' 'optimise: {least: makespan, over: {ranks: [64, 128, 256]}}'
    fails_with 1 mimdsim run s.yaml -o o.db --quiet --json
    json_is '$[0].tried' 2
}

@test "optimise: a range is searched up to where the limit holds, resumably" {
    scenario 'n: 16' 'ranks: n' 'optimise:' '  greatest: machine.software.recv.overhead' '  within: makespan <= 700 us' \
        '  over: {machine.software.recv.overhead: {from: 1 us, to: 10 us}}' '  runs: 60'
    works mimdsim run s.yaml -o o.db --quiet --json
    json_is '$[0].holds' yes
    best=$(sql o.db 'SELECT value FROM optimum')
    # a per cent more breaks the limit
    works mimdsim run s.yaml -o other.db --quiet --set machine.software.recv.overhead="$(awk "BEGIN { print $best * 1.01e6 }") us" \
        --columns makespan_us
    awk "BEGIN { exit !($(tail -n 1 <<<"$output") > 700) }"
    count=$(sql o.db 'SELECT count(*) FROM run')
    works mimdsim run s.yaml -o o.db --quiet
    sql_is o.db 'SELECT count(*), max(id) FROM run' "$count|$count"
    sql_is o.db 'SELECT value FROM optimum' "$best"
    # without a limit a monotone goal is at its end, exactly
    scenario 'n: 16' 'ranks: n' 'optimise: {least: makespan, over: {machine.software.recv.overhead: {from: 1 us, to: 10 us}}}'
    works mimdsim run s.yaml -o end.db --quiet
    sql_is end.db 'SELECT r.makespan_ps = (SELECT min(makespan_ps) FROM run) FROM optimum o JOIN run r ON r.id = o.run_id' 1
    sql_is end.db "SELECT v.value FROM optimum o JOIN v_setting v ON v.run_id = o.run_id AND v.key = 'machine.software.recv.overhead'" '1 us'
}

@test "optimise: what makes no sense is refused before anything runs" {
    try() {
        scenario 'n: 16' 'ranks: n' "optimise: $1"
        fails_with "${3:-65}" mimdsim run s.yaml -o none.db
        stderr_says "$2"
        [ ! -e none.db ]
    }
    try '{least: makspan, over: {kernel.solver: [cr, pcr]}}' "did you mean 'makespan'?"
    try '{least: makespan, over: {kernel.solver: [cr, pxcr]}}' "did you mean 'pcr'?"
    try '{least: makespan, within: makespan <= 2, over: {kernel.solver: [cr, pcr]}}' "a time on the left of '<='"
    try '{least: makespan, within: makespan, over: {kernel.solver: [cr, pcr]}}' 'a value; expected a condition'
    try '{least: kernel.solver, over: {kernel.solver: [cr, pcr]}}' 'a text, not a number'
    try '{over: {kernel.solver: [cr, pcr]}}' 'the goal is missing'
    try '{least: makespan}' "'over' is missing"
    try '{least: makespan, greatest: speedup, over: {kernel.solver: [cr]}}' 'one goal'
    try '{least: makespan, ovr: {kernel.solver: [cr]}}' "did you mean 'over'?"
    try '{least: makespan, over: {kernel.solver: {from: cr, to: pcr}}}' 'no number, so it has no range'
    try '{least: makespan, over: {n: {from: 4, to: 8}}}' "duplicate key 'model.n'"
    try '{least: makespan, runs: 10000, over: {kernel.solver: [cr, pcr], ranks: [1, 2, 4, 8, 16, 3, 5, 6], machine.network.hop_latency: {from: 1 ns, to: 1 us}}}' \
        "'ranks' is swept"
    scenario 'n: 16' 'sweep: {ranks: [1, 2, 4, 8, 16, 3, 5, 6]}' \
        'optimise: {least: makespan, runs: 10000, over: {kernel.solver: [cr, pcr], machine.network.hop_latency: {from: 1 ns, to: 1 us}}}'
    fails_with 78 mimdsim run s.yaml -o none.db
    stderr_says '16 combinations with up to 10000 runs each are 160000 runs; expected at most 100000'
}

@test "Ctrl-C says what is stored and how to go on, and the next run says what it skipped" {
    command=(run speedup-t3e --set machine.topology.dims='[16, 16, 16]' --set n=256,512,1024,2048,2050,2052,2054,2056 -j 2 -o c.db --quiet)
    # a background job of a shell without job control ignores SIGINT, and so would this program
    for attempt in 1 2 3 4 5; do
        rm -f c.db*
        setsid env --default-signal=INT "$MIMDSIM" "${command[@]}" >out 2>err 3>&- &
        parent=$!
        while [ "$(sqlite3 -readonly c.db 'SELECT count(*) FROM run' 2>>sqlite.log || echo 0)" -lt 2 ] && kill -0 $parent; do sleep 0.02; done
        kill -INT -- -$parent
        status=0
        wait $parent || status=$?
        if grep -q interrupted err; then break; fi
    done
    cat err
    [ "$status" -eq 130 ]
    grep -Eq '^mimdsim: interrupted: what is stored stays, and the same command goes on from there \([0-9]+ of 16 runs were made, into c.db\)$' err
    stored=$(sed -nE 's/^mimdsim: interrupted: .*\(([0-9]+) of.*/\1/p' err)
    sql_is c.db "SELECT count(*) - $stored IN (0, 1), min(status = 'ok') FROM run" '1|1'
    works mimdsim "${command[@]:0:${#command[@]}-1}"
    stderr_says "of 16 runs are stored already (--force repeats them)"
    sql_is c.db "SELECT count(*), sum(status = 'ok') FROM run" '16|16'
}

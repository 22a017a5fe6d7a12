#!/usr/bin/env bats
# claims.bats - each claim's test can pass and can fail, needs all its runs, and counts no what-if (planted databases).

load helper
load planted

@test "C1 sees a knee and its absence" {
    template
    speedups link 2:100 16:200 32:1000
    verdict C1 '' pass
    sqlite3 planted.db 'DELETE FROM baseline; DELETE FROM run'
    speedups link 2:100 16:800 32:1600
    verdict C1 '' fail
}

@test "C2 wants 0.97 between 33 and 64" {
    template
    speedups link 2:100 16:150 32:200 48:3000 64:3500 128:4000
    verdict C2 '' pass
    speedups link 24:2300
    verdict C2 '' fail
}

@test "C3 wants a drop that contention makes" {
    template
    speedups link 2:100 64:500 112:1000 128:900
    speedups loggp 2:100 64:500 112:1000 128:1100
    verdict C3 '' pass
    sqlite3 planted.db "DELETE FROM baseline; DELETE FROM run"
    speedups link 2:100 64:500 112:1000 128:900
    speedups loggp 2:100 64:500 112:1000 128:950
    verdict C3 '' fail
    sqlite3 planted.db "DELETE FROM baseline; DELETE FROM run"
    speedups link 2:100 64:500 112:1000 128:1100
    speedups loggp 2:100 64:500 112:1000 128:1200
    verdict C3 '' fail
}

@test "C4 wants NE[1] first and CFA[2] last" {
    template
    plant "operators = 'dense', solver = 'pcr', n = 16, P = 16" ""
    stage 'NE[1]' 500 10 10 10 0
    stage 'CFA[2]' 400 10 10 10 0
    plant "operators = 'dense', solver = 'pcr', n = 128, P = 128" ""
    stage 'NE[1]' 500 10 10 10 0
    stage 'CFA[2]' 600 10 10 10 0
    verdict C4 '' pass
    sqlite3 planted.db "UPDATE stage SET total_sum_ps = 100 WHERE name = 'CFA[2]'"
    verdict C4 '' fail
}

@test "C5 wants a serial code that is faster below 16" {
    template
    speedups link 2:60 4:55 8:50 32:500
    verdict C5 '' pass
    sqlite3 planted.db 'UPDATE baseline SET time_ps = 2000000'
    verdict C5 '' fail
}

# solver SOLVER P STAGE [PART]: a run of the Paragon's forward dynamics, n = 256, whose CFA[2] takes STAGE on every rank.
solver() {
    plant "kernel = 'forward', machine = 'paragon', n = 256, P = $2, solver = '$1', part_solver = '${4:-pcr}'" ""
    stage 'CFA[2]' $(($2 * $3)) 0 0 10 0
}

@test "C6 wants the modified solver faster than both others, at every P, and judges no other candidate" {
    template
    solver thomas 1 1000
    solver pcr 16 500
    solver pcr 256 500
    solver partition 16 400
    solver partition 256 400
    verdict C6 '' pass
    cp planted.db whole.db
    sqlite3 planted.db "UPDATE stage SET total_sum_ps = 256 * 600 WHERE run_id = (SELECT max(id) FROM run)"
    verdict C6 '' fail
    cp whole.db planted.db
    sqlite3 planted.db "UPDATE stage SET total_sum_ps = 300 WHERE run_id = (SELECT min(id) FROM run)"
    verdict C6 '' fail
    # a candidate that wins does not save the verdict, one that loses does not spoil it; both are counted
    cp whole.db planted.db
    solver pcr-symmetric 16 600
    solver pcr-symmetric 256 600
    verdict C6 '' pass
    sql_is planted.db "SELECT testable, holding FROM claim WHERE id = 'C6' AND variant = ''" '2|1'
    stdout_says 'holds in 1 of 2 variants; fails for: pcr-symmetric, n = 256'
    sqlite3 planted.db "UPDATE stage SET total_sum_ps = total_sum_ps * 2 WHERE run_id IN (SELECT id FROM run WHERE solver = 'partition');
                        UPDATE stage SET total_sum_ps = total_sum_ps / 2 WHERE run_id IN (SELECT id FROM run WHERE solver = 'pcr-symmetric')"
    verdict C6 '' fail
    stdout_says 'holds in 1 of 2 variants; holds for: pcr-symmetric, n = 256'
}

@test "C7 cannot hold at one P, and tells the same n apart" {
    template
    local partition="solver = 'partition'"
    plant "$partition, n = 16, P = 16" "$(fastest 200)"
    plant "$partition, n = 256, P = 16" "$(fastest 400)"
    plant "$partition, n = 64, P = 64" "$(fastest 900)"
    plant "$partition, n = 1024, P = 64" "$(fastest 1000)"
    plant "$partition, n = 64, P = 4" "$(fastest 110)"
    verdict C7 '' fail
    verdict C7 'speedup only: fastest serial, structured' pass
    verdict C7 'same n: fastest serial, structured' pass
    sqlite3 planted.db "UPDATE baseline SET time_ps = 3990000 WHERE run_id = (SELECT max(id) FROM run)"
    verdict C7 'same n: fastest serial, structured' fail
    sqlite3 planted.db "UPDATE baseline SET time_ps = 1000000 WHERE run_id = 2"
    verdict C7 'speedup only: fastest serial, structured' fail
}

@test "C8 wants finer grains, fewer bytes and more waiting of the inverse" {
    template
    plant 'n = 128, P = 128' ""
    stage 'NE[1]' 1000 10 100 100 300
    stage 'CFA[2]' 1000 5 200 500 100
    verdict C8 '' pass
    local change
    for change in 'flops = 10' 'sent_bytes = 50' 'wait_sum_ps = 900'; do
        cp planted.db whole.db
        sqlite3 planted.db "UPDATE stage SET $change WHERE name = 'CFA[2]'"
        verdict C8 '' fail
        mv whole.db planted.db
    done
}

@test "C9 wants equal steps and doubling rounds" {
    template
    local p
    for p in 8 16 32 64 128; do
        plant "level = 'loggp', machine_changes = '{\"topology.dims\": \"[16, 8, 8]\"}', n = $p, P = $p, makespan_ps = 1000 * $(sqlite3 :memory: "SELECT cast(log2($p) AS INTEGER)")" ""
        stage 'NE[2]' 100 "$(sqlite3 :memory: "SELECT cast(2 * (log2($p) * $p - $p + 1) AS INTEGER)")" 0 0 0
    done
    verdict C9 '' pass
    sqlite3 planted.db "UPDATE run SET makespan_ps = makespan_ps + 100 WHERE P = 32"
    verdict C9 '' fail
    sqlite3 planted.db "UPDATE run SET makespan_ps = makespan_ps - 100 WHERE P = 32; UPDATE stage SET messages = messages + 5 WHERE run_id = 2"
    verdict C9 '' fail
}

@test "C10 wants the floating base within 2 percent" {
    template
    plant 'n = 128, P = 128' ""
    plant "n = 128, P = 128, base = 'floating', makespan_ps = 1010000" ""
    verdict C10 '' pass
    sqlite3 planted.db "UPDATE run SET makespan_ps = 1030000 WHERE base = 'floating'"
    verdict C10 '' fail
}

@test "a claim is judged only when all its runs are there; the text says which are not and what makes them" {
    template
    speedups link 4:100
    speedups loggp 4:100
    works mimdsim claims planted.db
    sql_is planted.db "SELECT count(*) FROM claim WHERE verdict <> 'not-testable'" 0
    stdout_says 'runs are missing: n = P = 16, 32, 48, 64, 128 at level link; `mimdsim paper fig6 -o planted.db` makes them'
    stdout_says 'runs are missing: t3e-300, dynamics, n = P = 128 at level link; `mimdsim paper fig5 -o planted.db` makes them'
    # each point of a claim is needed: without any one of them there is no verdict
    speedups link 2:100 8:90 16:200 32:500 48:3000 64:3500 112:3700 128:4000
    speedups loggp 64:3500 112:3700 128:4000
    cp planted.db whole.db
    local id p
    for id in C1:pass C2:pass C3:fail C5:pass; do verdict "${id%:*}" '' "${id#*:}"; done
    for p in C1:2 C1:16 C1:32 C2:16 C2:32 C2:48 C2:64 C2:128 C3:64 C3:112 C3:128 C5:2 C5:4 C5:8; do
        cp whole.db planted.db
        sqlite3 planted.db "DELETE FROM baseline WHERE run_id IN (SELECT id FROM run WHERE P = ${p#*:})"
        verdict "${p%:*}" '' not-testable
        sql_is planted.db "SELECT value IS NULL, note LIKE '%n = P = ${p#*:}%' FROM claim WHERE id = '${p%:*}' AND variant = ''" '1|1'
    done
}

@test "runs on a changed machine enter no claim unless asked" {
    template
    speedups link 2:100 16:150 32:200 48:3000 64:3500 128:4000
    verdict C2 '' pass
    # what-ifs beside them change nothing, whatever they would say
    plant "machine_changes = '{\"node.flop_rate\": \"9 Mflop/s\"}', n = 24, P = 24" "$(fastest 2300)"
    verdict C2 '' pass
    works mimdsim claims planted.db --what-if
    sql_is planted.db "SELECT verdict, note LIKE 'what-if, runs on changed machines count (t3e-300); %' FROM claim WHERE id = 'C2' AND variant = ''" 'fail|1'
    # a database of what-ifs alone cannot be judged, and says why
    sqlite3 planted.db "DELETE FROM baseline WHERE run_id = (SELECT max(id) FROM run); DELETE FROM run WHERE id = (SELECT max(id) FROM run);
                        UPDATE run SET machine_changes = '{\"node.flop_rate\": \"9 Mflop/s\"}'"
    verdict C2 '' not-testable
    stdout_says '6 runs on changed machines do not count (--what-if counts them)'
    works mimdsim claims planted.db --what-if
    sql_is planted.db "SELECT verdict FROM claim WHERE id = 'C2' AND variant = ''" pass
    # so it is with a machine that nobody ships
    sqlite3 planted.db 'UPDATE run SET machine_changes = NULL, machine_hash = NULL'
    verdict C2 '' not-testable
}

@test "runs on two versions of a machine are not mixed: the latest counts" {
    template
    speedups link 2:100 16:150 32:200 48:3000 64:3500 128:4000
    sqlite3 planted.db "UPDATE run SET machine_hash = 'before'"
    verdict C2 '' pass
    speedups link 24:2300
    verdict C2 '' not-testable
    speedups link 2:100 16:150 32:200 48:3000 64:3500 128:4000
    verdict C2 '' fail
}

@test "what makes a machine changed: --set, or a file of one's own under its name; not the level, not --machine" {
    local run='mimdsim run speedup-t3e --set n=2 -o what.db --quiet'
    works $run
    works mimdsim run speedup-t3e --set n=2 --set level=packet -o what.db --quiet
    works mimdsim run speedup-t3e --set n=2 --machine t3e-300-mpt -o what.db --quiet
    sql_is what.db "SELECT DISTINCT state, machine_changes FROM v_machine_state" 'as shipped|{}'
    works $run --set 'machine.network.link.bandwidth=960 MB/s'
    sql_is what.db "SELECT DISTINCT machine_changes FROM v_machine_state WHERE state = 'changed'" \
        '{"network.link.bandwidth": "960 MB/s"}'
    mkdir own
    printf '%s\n' 'schema_version: 1' "base: $MIMDSIM_DATA/machines/t3e-300.yaml" 'node: {flop_rate: 99 Mflop/s}' >own/t3e-300.yaml
    cp own/t3e-300.yaml own/mine.yaml
    works $run -m own/t3e-300.yaml
    sql_is what.db "SELECT DISTINCT machine, machine_changes FROM v_machine_state WHERE run_id = (SELECT max(id) FROM run)" \
        't3e-300|{"node.flop_rate": "99 Mflop/s"}'
    works $run -m own/mine.yaml
    sql_is what.db "SELECT DISTINCT machine FROM v_machine_state WHERE state = 'own'" mine
}

@test "figures show machines as shipped; what-ifs alone are shown, too" {
    local p
    works mimdsim run fig6 --set n=4,8,16 --set kernel.operators=structured --set 'machine.network.link.bandwidth=96 MB/s' -o what.db --quiet
    works mimdsim plot what.db fig6
    [ "$(grep -c . figures/fig6.csv)" -gt 3 ]
    works mimdsim run fig6 --set n=4,8 --set kernel.operators=structured -o what.db --quiet
    works mimdsim plot what.db fig6
    sqlite3 :memory: ".import --csv figures/fig6.csv t" "SELECT DISTINCT P FROM t ORDER BY P + 0" >points
    [ "$(tr '\n' ' ' <points)" = '4 8 ' ]
    sqlite3 :memory: ".import --csv figures/fig6.csv t" "SELECT DISTINCT run_id FROM t" | while read -r p; do
        sql_is what.db "SELECT state FROM v_machine_state WHERE run_id = $p" 'as shipped'
    done
}

@test "the machines that claims name as shared are those of the scenarios" {
    works mimdsim run paper-sharing --set n=64,96,128 -o paper.db --quiet
    works mimdsim claims
    sql_is paper.db "SELECT group_concat(variant, '; ') FROM claim WHERE id = 'C3' AND variant <> ''" \
        'background load 30 %; background load 60 %; computing noise 20 %; scattered placement'
    works mimdsim run paper-scaling -o paper.db --quiet
    works mimdsim claims
    sql_is paper.db "SELECT verdict FROM claim WHERE id = 'C9' AND variant = ''" pass
}

@test "every claim's file says which row is judged and why, and the table shows it" {
    template
    works mimdsim claims planted.db --json
    json_is_valid
    json_is '$[0].judged' "$(sqlite3 planted.db "SELECT judged FROM claim WHERE id = 'C1' AND variant = ''")"
    sql_is planted.db "SELECT count(*) FROM claim WHERE variant = '' AND length(judged) > 40" 12
    cp -r "$MIMDSIM_DATA/plots" "$MIMDSIM_DATA/machines" "$MIMDSIM_DATA/scenarios" .
    sed -i '/^-- judged:/,/^-- points:/{/^-- points:/!d}' plots/claims/C4.sql
    MIMDSIM_DATA=$PWD fails_with 65 mimdsim claims planted.db
    stderr_says 'C4.sql'
    stderr_says 'judged:'
}

@test "a report on claims opens with its abstract, links to every section, and explains its words" {
    template
    speedups link 2:100 16:150 32:200 48:3000 64:3500 128:4000
    verdict C2 '' pass
    works mimdsim report planted.db --quiet
    [ "$(grep '^## ' planted.md | head -2 | tr '\n' ' ')" = '## Abstract ## Contents ' ]
    grep -q 'Jaramillo-Botero' planted.md
    grep -q 'of 2 claims judged, 1 hold (C2) and 1 do not (C1)' planted.md
    # what is linked to is there, in Markdown by its name, in HTML by its id, and every section is linked to
    sed -n 's/^- \[.*(#\(.*\))$/\1/p' planted.md | sort >linked.md
    sed -n 's/^## //p' planted.md | grep -v -e Abstract -e Contents | tr 'A-Z ' 'a-z-' | tr -cd 'a-z0-9\n_-' | sort >there.md
    diff there.md linked.md
    grep -o '<a href="#[^"]*' planted.html | sed 's/.*#//' | sort >linked.html
    grep -o 'h2 id="[^"]*' planted.html | sed 's/.*"//' | grep -v -e abstract -e contents | sort >there.html
    diff there.html linked.html
    [ "$(wc -l <linked.html)" -gt 5 ]
    for word in 'f, degree of parallelism' 'NE[1], NE[2], NE[3]' 'CFA[1], CFA[2], CFA[3]' 'rnea+aba' level 'structured, dense operators'; do
        grep -q "<td[^>]*>$(printf %s "$word" | sed 's/[][+]/\\&/g; s/\\+/+/g')</td>" planted.html || { echo "no word: $word"; return 1; }
    done
    # the abstract is made of the database: another verdict, another abstract
    speedups link 24:2300
    verdict C2 '' fail
    works mimdsim report planted.db --quiet
    grep -q 'of 2 claims judged, 0 hold and 2 do not (C1, C2)' planted.md
}

@test "the figure of the claims has a cell for every variant, and a frame for the one that is judged" {
    template
    speedups link 2:100 16:150 32:200 48:3000 64:3500 128:4000
    local p
    solver thomas 1 1000
    for p in 16 256; do
        solver pcr $p 500
        solver partition $p 400
        solver pcr-symmetric $p 600
        solver cr $p 300
    done
    verdict C6 '' pass
    works mimdsim plot planted.db claims
    sqlite3 figures.db ".import --csv figures/claims.csv t"
    sql_is figures.db 'SELECT count(*) FROM t' "$(sql planted.db 'SELECT count(*) FROM claim')"
    sql_is figures.db "SELECT group_concat(variant, ' / ') FROM t WHERE id = 'C6' AND kind = 'named'" \
        'cr‚ n = 256 / partition + pcr‚ n = 256 / pcr-symmetric‚ n = 256'
    sql_is figures.db "SELECT group_concat(id || ' ' || variant, '; ') FROM t WHERE nominal = 1" \
        'C1 structured: fastest serial; C2 structured: fastest serial; C6 partition + pcr‚ n = 256'
    sql_is figures.db "SELECT mark FROM t WHERE id = 'C6' AND kind = 'verdict'" '2 of 3'
    # no two cells of a line overlap
    sql_is figures.db 'SELECT count(*) FROM t a JOIN t b ON a.y = b.y AND a.rowid < b.rowid AND abs(a.x - b.x) < a.half + b.half' 0
}

@test "without runs nothing can be told, and the table says so" {
    template
    works mimdsim claims planted.db --json
    json_is_valid
    json_is '$[#-1].verdict' not-testable
    sql_is planted.db "SELECT count(*), sum(verdict = 'not-testable') FROM claim WHERE variant = ''" '12|12'
    fails_with 66 mimdsim claims none.db
    [ ! -e none.db ]
}


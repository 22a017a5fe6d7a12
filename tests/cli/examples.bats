#!/usr/bin/env bats
# examples.bats - the programs of examples/ and their scenarios: right for any number of ranks on every machine, and drawn.

load helper
load programs.bash

examples=$MIMDSIM_SRCDIR/examples

# right NAME OPTION...: the scenario, made small; every run is compared with a serial code and ok.
right() {
    local name=$1
    shift
    works mimdsim run "$examples/$name.yaml" -o "$name.db" "$@"
    works mimdsim query "$name.db" "SELECT count(*) > 0 AND min(r.status = 'ok') AND min(EXISTS (SELECT 1 FROM error_check e
        WHERE e.run_id = r.id AND e.passed)) AND min(EXISTS (SELECT 1 FROM v_speedup s WHERE s.run_id = r.id AND
        s.baseline = 'fastest serial' AND s.speedup > 0)) AND count(DISTINCT machine) = 3 AS fine FROM run r"
    [ "${lines[1]//[ ]/}" = 1 ] || { echo "$name"; return 1; }
}

@test "every example has a scenario, and every scenario its program" {
    for file in "$examples"/*; do
        case $file in *.c) [ -e "${file%.c}.yaml" ] ;; *.yaml) [ -e "${file%.yaml}.c" ] ;; esac
    done
    works mimdsim check "$examples"/*.yaml
}

@test "a ring all-reduce is right for any number of ranks" { right ring-allreduce --set n=17 --set ranks=1,2,3,5,16; }

@test "prefix sums are right, their parts and both serial codes told apart" {
    right prefix-sum --set n=23 --set ranks=1,2,3,7,16
    works mimdsim query prefix-sum.db "SELECT count(DISTINCT name), sum(messages) > 0 AND min(name = 'doubling') AS apart FROM stage
        WHERE messages > 0"
    [[ "${lines[-1]}" =~ ^\ *1\ +1$ ]]
    works mimdsim query prefix-sum.db "SELECT count(*) AS n FROM baseline a JOIN baseline b ON a.run_id = b.run_id AND a.name =
        'one loop' AND b.name = 'parallel code on one processor' AND a.time_ps < b.time_ps"
    [ "${lines[-1]//[ ]/}" = 15 ]
}

@test "a stencil is right with and without overlap" {
    right stencil --set n=17 --set steps=5 --set ranks=1,2,3,16
    works mimdsim query stencil.db "SELECT count(DISTINCT value) FROM v_setting WHERE key = 'program.overlap'"
    [ "${lines[1]//[ ]/}" = 2 ]
}

@test "matrix multiplication is right by three algorithms" {
    right matrix-multiply --set n=12 --set ranks=1,4,9
    right matrix-multiply --set n=11 --set method=rows --set ranks=2,3,16
    run --separate-stderr -- mimdsim run "$examples/matrix-multiply.yaml" --set n=12 --set method=cannon --set ranks=3
    [ "$status" -eq 1 ]
    stderr_says "3 ranks: expected a square number whose root divides n = 12"
    works mimdsim explain "$examples/matrix-multiply.yaml"
    stdout_says "estimated: "
}

@test "sample sort is right, also for fewer numbers than ranks" { right sample-sort --set n=5,200 --set ranks=1,2,7,16; }

@test "a pipelined broadcast is right for any segment" {
    right pipelined-broadcast --set bytes='1000 B' --set segment='[1 B, 333 B, 2 KiB]' --set ranks=1,2,5
}

@test "conjugate gradients are right" { right conjugate-gradients --set n=16 --set iterations=8 --set ranks=1,2,3,16; }

@test "a factor is found, by an eureka and by asking" { right find-factor --set n=9797 --set block=1,7 --set ranks=1,2,3,16; }

@test "bodies in a ring are right" { right nbody-ring --set n=19 --set ranks=1,2,3,16; }

@test "their speedup is drawn, a curve for each machine" {
    command -v gnuplot >there || skip "no gnuplot"
    works mimdsim run "$examples/prefix-sum.yaml" --set n=1000 --set ranks=1,2,4
    works mimdsim plot mimdsim.db speedup
    [ -s figures/speedup-prefix-sum.png ]
    [ -s figures/speedup-prefix-sum.svg ]
    [ "$(cut -d, -f1 figures/speedup-prefix-sum.csv | sort -u | grep -c '[0-9]')" -eq 3 ]
}

@test "results and times are the same when compiled again, at every level" {
    works mimdsim run "$examples/sample-sort.yaml" -o one.db -m t3e-300 --set n=300 --set ranks=4 --set level=loggp,link,packet,flit,auto
    one=$output
    rm -r "$XDG_CACHE_HOME"
    works mimdsim run "$examples/sample-sort.yaml" -o two.db -m t3e-300 --set n=300 --set ranks=4 --set level=loggp,link,packet,flit,auto -j 3
    stdout_is "$one"
    [ "$(grep -c ' ok$' <<<"$output")" -eq 5 ]
}

#!/usr/bin/env bats
# threads.bats - one run on several host threads through the real program: rows, words, refusals, remarks.

load helper

scenario() {
    printf '%s\n' 'schema_version: 1' 'question: Threads?' 'machine: t3e-300' \
        'model: {generator: serial-chain}' "kernel: $1" 'ranks: n' 'level: loggp' 'sweep: {n: [3, 16, 64, 100]}' >t.yaml
}

# All that a run left but what the host had to do with it.
rows() {
    sql "$1" "SELECT config_hash, n, P, status, text, makespan_ps, messages, sent_bytes, events, digest FROM run ORDER BY level, n"
    sql "$1" 'SELECT s.* FROM rank_stage s JOIN run r ON r.id = s.run_id ORDER BY r.level, r.n, s.rank, s.stage' | cut -d'|' -f2-
    sql "$1" 'SELECT e.* FROM error_check e JOIN run r ON r.id = e.run_id ORDER BY r.level, r.n, e.ordinal' | cut -d'|' -f2-
}

@test "any number of threads gives the same rows" {
    for kernel in dynamics inverse alltoall; do
        scenario "$kernel"
        [ "$kernel" = inverse ] || sed -i 's/^level: .*/level: [loggp, link]/' t.yaml
        works mimdsim run t.yaml -q --threads 1 -o one.db
        for threads in 2 3 8 auto; do
            rm -f n.db
            works mimdsim run t.yaml -q --threads $threads -o n.db
            stderr_is_empty
            [ "$(rows n.db)" = "$(rows one.db)" ]
        done
        rm one.db
    done
}

@test "a run that fails says the same on several threads" {
    scenario dynamics
    late=(--set machine.node.flop_rate='1 flop/s' --set kernel.steps=300 --set n=64)
    fails_with 1 mimdsim run t.yaml -q --threads 1 -o one.db "${late[@]}"
    fails_with 1 mimdsim run t.yaml -q --threads 3 -o n.db "${late[@]}"
    sql_is n.db "SELECT count(*) FROM run WHERE status = 'failed' AND text LIKE 'simulated time ends%'" 1
    [ "$(rows n.db)" = "$(rows one.db)" ]
}

@test "a run that takes one thread says why, if more were asked for" {
    scenario dynamics
    works mimdsim run t.yaml --threads 2 --set level=packet --set n=8
    stderr_says 'on one thread: the network itself, at this network.level, is most of the work'
    works mimdsim run t.yaml --threads 2 --set level=link --set n=8
    ! [[ $stderr == *thread* ]]
    works mimdsim run t.yaml --set level=packet --set n=9
    ! [[ $stderr == *thread* ]]
}

@test "explain tells what runs on several threads" {
    scenario dynamics
    works mimdsim explain t.yaml --set level=link,loggp,packet
    stdout_says 'threads go by windows of simulated time: 4 of 12 runs: messages wait for each other at links'
    stdout_says 'on one thread: 4 of 12 runs: the network itself'
    works mimdsim explain t.yaml --json
    json_is '$.runs[0].host_threads' 1
}

@test "a wrong number of threads is refused" {
    scenario dynamics
    for threads in 0 -1 1025 many ''; do
        fails_with 64 mimdsim run t.yaml --threads "$threads"
        stderr_says "neither 'auto' nor a number from 1 to 1024"
    done
    [ ! -e mimdsim.db ]
}

#!/usr/bin/env bats
# scale.bats - the schedule of what a spread run does: its letters are those of a real run, and it runs on machines.

load helper

schedule() { "$MIMDSIM_SRCDIR/bench/scale/engine-schedule.sh" "$@"; }

@test "letters between hosts and their bytes are those of a run's own timeline, whatever the blocks" {
    works mimdsim run speedup-t3e --quiet -o run.db --set n=128 --set level=loggp --set kernel=inverse --set record.spans=true
    for hosts in 1 2 4 8 16 32 128; do
        across="kind = 'send' AND rank / (128 / $hosts) <> peer / (128 / $hosts)"
        wanted=$(sql run.db "SELECT count(*) || ' letters, ' || ifnull(sum(bytes + 56), 0) || ' bytes' FROM span WHERE $across")
        [ "$(schedule $hosts 128 | tail -1)" = "// $wanted" ]
    done
}

@test "it is a schedule that runs: on one host the costs add up, more hosts are faster, a slow network is slower" {
    for hosts in 1 16; do
        schedule $hosts 65536 >engine-$hosts.goal
        for machine in infiniband-ndr ethernet-10g; do
            works mimdsim run engine-$hosts.goal --quiet -o scale.db -m $machine --set level=loggp
        done
    done
    # 16 strides of 3 sweeps, one of them to both sides, and the first step, at 273 ns; a body at 2280 ns, and at 95 ns in
    # each of two sweeps
    sql_is scale.db "SELECT DISTINCT makespan_ps FROM run WHERE P = 1" $((65536 * (65 * 273 + 2280 + 2 * 95) * 1000))
    sql_is scale.db "SELECT max(makespan_ps) * 3 < (SELECT min(makespan_ps) FROM run WHERE P = 1) FROM run WHERE P = 16" 1
    sql_is scale.db "SELECT (SELECT makespan_ps FROM run WHERE P = 16 AND machine = 'infiniband-ndr') <
        (SELECT makespan_ps FROM run WHERE P = 16 AND machine = 'ethernet-10g')" 1
}

@test "what is no power of two, or no number at all, is refused" {
    for arguments in '3 128' '4 100' '8 4' 'x 8' '0 8'; do
        # shellcheck disable=SC2086
        fails_with 64 schedule $arguments
        stderr_says 'expected powers of two'
    done
    fails_with 64 schedule
    stderr_says 'engine-schedule.sh HOSTS N'
}

#!/usr/bin/env bats
# schedules.bats - schedules in the language GOAL: run, refused, and made of runs so that they repeat them.

load helper

exchange() {
    cat > exchange.goal <<'GOAL'
num_ranks 2

rank 0 {
work: calc 5000
s: send 1000b to 1 tag 7
s requires work
r: recv 8b from 1 tag 8
r requires s
}
rank 1 {
r: recv 1000b from 0 tag 7
s: send 8b to 0 tag 8
s requires r
}
GOAL
}

# makespan FILE OPTIONS...: of one run [us]
makespan() {
    works mimdsim run "$@" --json --quiet
    grep -o '"makespan_us": [0-9.]*' <<< "$output" | grep -o '[0-9.]*$'
}

@test "a schedule takes the time of its messages on the machine" {
    exchange
    # 5 us; o + L + 999 G + o; o + L + 7 G + o
    [ "$(makespan exchange.goal -m loggp-example)" = 33.06 ] || { makespan exchange.goal -m loggp-example; return 1; }
    # of the computing time alone
    [ "$(makespan exchange.goal -m loggp-example --set time_unit='2 ns')" = 38.06 ]
    sed -i '1i // mimdsim time unit: 1 us' exchange.goal
    [ "$(makespan exchange.goal -m loggp-example)" = 5028.06 ]
    [ "$(makespan exchange.goal -m loggp-example --set time_unit='1 ns')" = 33.06 ]
}

@test "a schedule is a program of a scenario, swept, stored and shown" {
    exchange
    printf '%s\n' 'schema_version: 1' 'program: exchange.goal' 'ranks: 2' 'sweep:' '  machine: [loggp-example, t3e-300]' \
        '  level: [loggp, link]' > s.yaml
    works mimdsim run s.yaml -o s.db --quiet
    sql_is s.db "SELECT count(*), count(DISTINCT machine || level), min(kernel), min(status) FROM run" '4|4|exchange|ok'
    works mimdsim timeline exchange.goal --format text
    stdout_says 'schedule'
    # another content is another run
    sed -i 's/5000/6000/' exchange.goal
    works mimdsim run s.yaml -o s.db --quiet
    sql_is s.db "SELECT count(*) FROM run" 8
}

@test "mistakes in schedules are told with file and line" {
    exchange
    sed 's/to 1 tag/to 2 tag/' exchange.goal > bad.goal
    fails_with 65 mimdsim run bad.goal
    stderr_says "bad.goal:5: '2' where a rank from 0 to 1 is expected"
    sed 's/^r requires s/&\nwork requires r/' exchange.goal > bad.goal
    fails_with 65 mimdsim run bad.goal
    stderr_says 'bad.goal:4: 3 operations of the schedule wait for each other in circles'
    sed '$d' exchange.goal > bad.goal
    fails_with 65 mimdsim run bad.goal
    stderr_says "the end of the file where an operation, a label or '}' is expected"
    head -c 100000 /dev/urandom > bad.goal
    fails_with 65 mimdsim run bad.goal
    printf '\177\020\0\0\0\0\0\0\377\377\377\377\0\0' > bad.goal # 4223: the binary form
    fails_with 65 mimdsim run bad.goal
    stderr_says 'a broken binary schedule'
    fails_with 66 mimdsim run none.goal
    fails_with 64 mimdsim timeline exchange.goal --format gaol
    stderr_says "'gaol' is none of"
}

@test "runs that do not fit or do not end have their reason" {
    exchange
    fails_with 78 mimdsim run exchange.goal -m loggp-example --set ranks=4
    stderr_says "the schedule 'exchange' has 2 ranks, the run 4; expected ranks: 2"
    fails_with 78 mimdsim run exchange.goal -m loggp-example --set time_unit='0.5 ps'
    stderr_says 'program.time_unit is no whole number of picoseconds'
    sed '/send 8b/d; /^s requires r/d' exchange.goal > stuck.goal
    fails_with 70 mimdsim run stuck.goal -m loggp-example
    stderr_says 'tag 8, from rank 1 (stuck.goal:7)'
}

@test "a run written as a schedule takes the same time again, at every level" {
    printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'kernel: dynamics' 'n: 24' 'ranks: 24' > job.yaml
    for level in loggp link packet; do
        expected=$(makespan job.yaml --set level=$level)
        works mimdsim timeline job.yaml --set level=$level --format goal --dir out
        stderr_says 'barriers of the machine are written as computing times'
        found=$(makespan out/timeline.goal -m t3e-300 --set level=$level)
        [ "$expected" = "$found" ] || { echo "$level: $expected us, again $found us"; return 1; }
    done
    # and from a database
    works mimdsim run job.yaml --set level=loggp --set record.spans=true -o job.db --quiet
    works mimdsim timeline job.db --format goal --dir stored
    works mimdsim timeline job.yaml --set level=loggp --format goal --dir out
    cmp <(grep -v '^//' stored/timeline.goal) <(grep -v '^//' out/timeline.goal)
}

@test "hand-shakes come about again" {
    for kernel in alltoall allreduce shift; do
        printf '%s\n' 'schema_version: 1' 'machine: infiniband-hdr' "kernel: $kernel" 'ranks: 16' 'kernel.message: 64 KiB' > job.yaml
        expected=$(makespan job.yaml --set level=loggp)
        works mimdsim timeline job.yaml --set level=loggp --format goal --dir out
        found=$(makespan out/timeline.goal -m infiniband-hdr --set level=loggp)
        [ "$expected" = "$found" ] || { echo "$kernel: $expected us, again $found us"; return 1; }
    done
}

@test "each receive finds the message that it found" {
    printf '%s\n' 'num_ranks 2' 'rank 0 {' 'a: send 8b to 1 tag 1' 'b: calc 50000' 'b requires a' 'c: send 9b to 1 tag 2' \
        'c requires b' '}' 'rank 1 {' 'a: recv 9b from 0 tag 2' 'b: calc 100000' 'b requires a' 'c: recv 8b from 0 tag 1' \
        'c requires b' '}' > late.goal
    expected=$(makespan late.goal -m loggp-example)
    works mimdsim timeline late.goal -m loggp-example --format goal --dir out
    found=$(makespan out/timeline.goal -m loggp-example)
    [ "$expected" = "$found" ] || { echo "$expected us, again $found us"; return 1; }
}

@test "ranks that wait for each other are told with tag and line, and no size that the schedule does not have" {
    printf '%s\n' 'num_ranks 2' 'rank 0 {' 'r: recv 8b from 1 tag 3' '}' 'rank 1 {' 'r: recv 8b from 0 tag 3' '}' >wait.goal
    fails_with 70 mimdsim run wait.goal -m t3e-300 --quiet
    stderr_says 'waits to receive a message, tag 3, from rank 1 (wait.goal:3)'
}

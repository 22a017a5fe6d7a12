#!/usr/bin/env bats
# segments.bats - message software by size: read, shown, set, swept, refused.

load helper

machine() {
    cat >my.yaml <<EOF
schema_version: 1
base: loggp-example
software:
  segments:
$1
EOF
}

@test "a machine file gives segments, each with its evidence" {
    machine '    - {from: 0 B, send.overhead: 1 us, class: P, source: "a table, section 2"}
    - {from: 8 KiB, protocol: synchronous, rendezvous.latency: 2 us, class: D, source: "its step"}'
    works mimdsim check my.yaml
    works mimdsim machines ./my.yaml
    stdout_says "{from: 0 B, send.overhead: 1 us}"
    stdout_says "{from: 8 KiB, protocol: synchronous, rendezvous.latency: 2 us}"
    stdout_says "P/D my.yaml:4  from 0 B: a table, section 2; from 8 KiB: its step"
}

@test "segments are set, swept, stored and part of a run's identity" {
    list='machine.software.segments=[{from: 0 B}, {from: 1 KiB, send.overhead: 9 us}]'
    works mimdsim run pingpong-machines -m loggp-example --set kernel.message='1023 B,1024 B' --set "$list" -o a.db --quiet
    sql_is a.db "SELECT count(DISTINCT config_hash), max(makespan_ps) > min(makespan_ps) + 10000000 FROM run" '2|1'
    works mimdsim run pingpong-machines -m loggp-example --set kernel.message='2048 B' \
        --set 'machine.software.segments=[[{from: 0 B}], [{from: 0 B, send.overhead: 9 us}]]' -o b.db --quiet
    sql_is b.db "SELECT count(*) FROM run" 2
}

@test "a step down is told" {
    machine '    - {from: 0 B, send.overhead: 9 us}
    - {from: 100 B, send.overhead: 1 us}'
    works mimdsim check my.yaml
    stderr_says "a message of 99 B takes"
    stderr_says "is this intended?"
    # of measured segments nobody meant anything
    machine '    - {from: 0 B, send.overhead: 9 us, class: measured, source: a host}
    - {from: 100 B, send.overhead: 1 us, class: measured, source: a host}'
    works mimdsim check my.yaml
    stderr_says "us, as measured"
    [[ $stderr != *intended* ]]
    machine '    - {from: 0 B, send.overhead: 1 us}
    - {from: 100 B, send.overhead: 9 us}'
    works mimdsim check my.yaml
    stderr_is_empty
}

refused() {
    machine "$1"
    fails_with 65 mimdsim check my.yaml
    stderr_says "my.yaml:4"
    stderr_says "$2"
}

@test "wrong segments are refused with what was expected" {
    refused '    - {from: 1 KiB}' "the first segment begins at 1024 B; expected one from 0 B"
    refused '    - {from: 0 B}
    - {from: 8 KiB}
    - {from: 1 KiB}' "segment 3 begins at 1024 B, after one from 8192 B; expected rising sizes"
    refused '    - {from: 0 B}
    - {from: 0 B}' "segments 1 and 2 both begin at 0 B"
    refused '    - {gap: 1 us}' "segment 1 has no 'from'"
    refused '    - {from: 0 B, gap: 1}' "segment 1: gap '1': no unit; expected a time"
    refused '    - {from: 0 B, gap: 1 MB/s}' "segment 1: gap '1 MB/s'"
    refused '    - {from: 0}' "segment 1: from '0'"
    refused '    - {from: 0 B, send.overhaed: 1 us}' "did you mean 'send.overhead'?"
    refused '    - {from: 0 B, protocol: rendevous}' "did you mean 'rendezvous'?"
    refused '    - {from: 0 B, rendezvous.latency: 1 us}' "rendezvous.latency of an eager segment"
    refused '    - 0 B' "expected a list of segments"
    refused '    - {from: {value: 0 B}}' "expected a list of mappings"
    machine '    - {from: 0 B, class: X}'
    fails_with 65 mimdsim check my.yaml
    stderr_says "my.yaml:5: software.segments: class 'X'"
}

@test "what segments say by size, plain keys cannot say" {
    works mimdsim run pingpong-machines -m loggp-example --set kernel.message='8 B' --set machine.software.eager.limit='1 KiB' \
        --set 'machine.software.segments=[{from: 0 B}]' -o a.db
    stderr_says "software.segments says it by size"
}

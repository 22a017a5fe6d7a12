#!/usr/bin/env bats
# attacks.bats - files of strangers that once broke the program: each gets one message with its place, and nothing else.

load helper

attacks=$MIMDSIM_SRCDIR/tests/data/attacks

@test "a mapping within a list is refused with its line, wherever a list may stand" {
    for verb in check explain run; do
        fails_with 65 mimdsim $verb "$attacks/sweep-null.yaml"
        stderr_says "sweep-null.yaml:6: machine.topology.dims: a mapping '{a: ...}' where a value is expected"
        fails_with 65 mimdsim $verb "$attacks/sweep-null2.yaml"
        stderr_says "sweep-null2.yaml:6: model.gravity: a mapping '{a: ...}' where a value is expected"
    done
    fails_with 65 mimdsim run speedup-t3e --set 'machine.topology.dims=[[a: 1]]'
    stderr_says "machine.topology.dims: a mapping '{a: ...}' where a value is expected"
    for key in machine.topology.links machine.placement.list model.gravity ranks n machine level kernel; do
        fails_with 65 mimdsim run speedup-t3e --set "$key=[[{a: 1}]]"
        fails_with 65 mimdsim run speedup-t3e --set "$key=[{a: [{b: 1}]}]"
    done
    nothing_left_behind
}

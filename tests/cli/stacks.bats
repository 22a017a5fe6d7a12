# stacks.bats - a built-in program whose rank needs more than its stack says so by name: in the command's own process, in a
# worker of a campaign, on several threads, and of very many ranks.
load helper

# The ranks of this one use more than a page: numbers of quadruple precision.
small() { mimdsim run speedup-t3e -o t.db --quiet --set level=loggp --set kernel.precision=quad "$@"; }

@test "in the command's own process: kernel, rank, size of the stack and what to set; nothing is half-written" {
    export MIMDSIM_STACK='4 KiB'
    fails_with 70 small --set n=8 --jobs 1
    stderr_says "mimdsim: kernel dynamics, rank "
    stderr_says " of 8: stack overflow: it has used more than its stack of 4 KiB"
    stderr_says "the environment variable MIMDSIM_STACK (such as '256 KiB') gives every rank more"
    [ ! -e t.db ] || sql_is t.db "PRAGMA integrity_check" ok
    export MIMDSIM_STACK='512 KiB'
    works small --set n=8 --jobs 1
    sql_is t.db "SELECT count(*) FROM run WHERE status = 'ok'" 1
}

@test "in a worker the run fails with the same words, and the others go on" {
    export MIMDSIM_STACK='4 KiB'
    fails_with 1 small --set n=8,16 --jobs 2
    sql_is t.db "SELECT count(*) FROM run WHERE status = 'failed' AND text LIKE
        'kernel dynamics, rank % of %: stack overflow: it has used more than its stack of 4 KiB; %MIMDSIM_STACK%'" 2
    unset MIMDSIM_STACK
    works small --set n=8,16 --jobs 2
    sql_is t.db "SELECT count(*) FROM run WHERE status = 'ok'" 2
}

@test "several threads tell it as well, and so do very many ranks" {
    export MIMDSIM_STACK='4 KiB'
    fails_with 70 small --set n=4096 --set machine.topology.dims='[16, 16, 16]' --threads 2 --jobs 1
    stderr_says " of 4096: stack overflow"
    fails_with 70 small --set n=65536 --set machine.topology.dims='[64, 32, 32]' --jobs 1
    stderr_says " of 65536: stack overflow"
}

@test "the size of a stack acts on no result" {
    works small --set n=16 --jobs 1 -o one.db
    MIMDSIM_STACK='1 MiB' works small --set n=16 --jobs 1 -o two.db
    [ "$(sql one.db 'SELECT config_hash, digest, makespan_ps FROM run')" = \
      "$(sql two.db 'SELECT config_hash, digest, makespan_ps FROM run')" ]
}

@test "a size that is none is refused with the variable's name" {
    for bad in 64 '64 MB/s' '4095 B' '2 GiB' 'much' '-1 KiB'; do
        MIMDSIM_STACK=$bad run --separate-stderr small --set n=8 --jobs 1 -o bad.db
        [ "$status" -ne 0 ] || { echo "$bad"; return 1; }
        stderr_says "MIMDSIM_STACK is '$bad'"
    done
}

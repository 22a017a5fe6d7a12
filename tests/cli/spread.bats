#!/usr/bin/env bats
# spread.bats - one run on the processes of an MPI job, with Open MPI and with MPICH.

load helper
load mpi_job

scenario() {
    printf '%s\n' 'schema_version: 1' 'question: Processes?' 'machine: t3e-300' 'model: {generator: serial-chain}' \
        'ranks: n' 'level: loggp' 'sweep: {kernel: [dynamics, alltoall], n: [2, 64, 100]}' 'record: {links: true}' >t.yaml
}

# All that a run left but what the host had to do with it.
rows() {
    sql "$1" "SELECT config_hash, kernel, n, P, status, text, makespan_ps, messages, sent_bytes, events, residual, digest
              FROM run ORDER BY config_hash"
    for table in rank_stage error_check baseline link_load stage; do
        sql "$1" "SELECT r.config_hash, t.* FROM $table t JOIN run r ON r.id = t.run_id" | cut -d'|' -f1,3- | sort
    done
}

is_spread() {
    needs "$1"
    scenario
    works mimdsim run t.yaml -o one.db --quiet
    table=$output
    for n in 1 2 3; do
        rm -f all.db
        works start "$1" $n "$MIMDSIM" run t.yaml --spread mpi -o all.db --quiet
        stdout_is "$table"
        diff <(rows one.db) <(rows all.db)
    done
    [ "$(rows all.db | wc -l)" -gt 1000 ]
    # Several threads in each process; what is stored is not made again.
    works start "$1" 2 "$MIMDSIM" run t.yaml --spread mpi --threads 2 --force -o all.db --quiet
    diff <(rows one.db) <(rows all.db)
    works start "$1" 2 "$MIMDSIM" run t.yaml --spread mpi -o all.db --quiet
    sql_is all.db 'SELECT max(id) = count(*) OR max(id) = 2 * count(*) FROM run' 1
}

@test "processes of Open MPI share a run" { is_spread openmpi; }
@test "processes of MPICH share a run" { is_spread mpich; }

stays_in_one_process() {
    needs "$1"
    scenario
    works mimdsim run t.yaml --set level=link --set n=8 -o one.db --quiet
    works start "$1" 2 "$MIMDSIM" run t.yaml --set level=link --set n=8 --spread mpi -o all.db
    stderr_says 'in one process: messages wait for each other at links'
    diff <(rows one.db) <(rows all.db)
    # a failure is told in the words of one process
    late=(--set machine.node.flop_rate='1 flop/s' --set kernel.steps=300 --set n=64 --set kernel=dynamics)
    fails_with 1 mimdsim run t.yaml -q -o one.db "${late[@]}"
    fails_with 1 start "$1" 3 "$MIMDSIM" run t.yaml -q --spread mpi -o all.db "${late[@]}"
    sql_is all.db "SELECT count(*) FROM run WHERE status = 'failed' AND text LIKE 'simulated time ends%'" 1
    diff <(rows one.db) <(rows all.db)
}

@test "what needs the order of time stays in one process, with Open MPI" { stays_in_one_process openmpi; }
@test "what needs the order of time stays in one process, with MPICH" { stays_in_one_process mpich; }

# Dynamics of a chain: each process makes its part of the scene, and checks its own answers. What is more
# than 256 ranks is stored as sums.
divides() {
    needs "$1"
    local chain=(--set level=loggp --set kernel=inverse --set machine.topology.dims='[8, 8, 8]' --quiet)
    local forward=("${chain[@]}" --set kernel=forward,dynamics --set kernel.formulation=paper,direct --set n=600 --set ranks=300
        --set machine.software.eager.limit=unlimited)
    local late=(--set machine.node.flop_rate='1 flop/s' --set n=20000 --set ranks=2)
    scenario
    works mimdsim run t.yaml "${chain[@]}" --set n=5,300 --set model.rate='0 rad/s,1 rad/s' -o one.db
    works mimdsim run t.yaml "${forward[@]}" -o one.db
    fails_with 1 mimdsim run t.yaml "${chain[@]}" "${late[@]}" --set machine.software.eager.limit=unlimited -o one.db
    for n in 2 3; do
        rm -f all.db
        works start "$1" $n "$MIMDSIM" run t.yaml "${chain[@]}" --set n=5,300 --set model.rate='0 rad/s,1 rad/s' --spread mpi -o all.db
        works start "$1" $n "$MIMDSIM" run t.yaml "${forward[@]}" --spread mpi -o all.db
        fails_with 1 start "$1" $n "$MIMDSIM" run t.yaml "${chain[@]}" "${late[@]}" --set machine.software.eager.limit=unlimited \
            --spread mpi -o all.db
        diff <(rows one.db) <(rows all.db)
    done
    sql_is all.db "SELECT group_concat(status, ' ') FROM (SELECT status FROM run ORDER BY status)" 'failed ok ok ok ok ok ok ok ok'
    sql_is all.db "SELECT text LIKE 'simulated time ends%' FROM run WHERE status = 'failed'" 1
}

@test "processes of Open MPI have parts of a chain" { divides openmpi; }
@test "processes of MPICH have parts of a chain" { divides mpich; }

# A process of the job is killed while a run of several seconds is made.
leaves_a_row() {
    needs "$1"
    scenario
    printf '%s\n' '#!/bin/sh' 'echo $$ >>pids' 'exec "$@"' >noted
    chmod +x noted
    start "$1" 2 ./noted "$MIMDSIM" run t.yaml --spread mpi -q -o all.db --set kernel=dynamics --set n=64 \
        --set kernel.steps=3000 --set kernel.refinement=as-given >/dev/null 2>&1 3>&- &
    job=$!
    for ((i = 0; i < 300; i++)); do
        [ "$(sqlite3 -readonly all.db "SELECT count(*) FROM run" 2>/dev/null)" != 1 ] || break
        sleep 0.1
    done
    kill -9 "$(tail -n 1 pids)"
    ! wait $job
    sql_is all.db "SELECT status, text LIKE '%one of them died%' FROM run" 'failed|1'
}

@test "a process that dies leaves a row that says so, with Open MPI" { leaves_a_row openmpi; }
@test "a process that dies leaves a row that says so, with MPICH" { leaves_a_row mpich; }

# One process may take less memory than its part of a run needs. Nobody waits for it, and the next run is made.
says_whose_memory() {
    needs "$1"
    sanitized && skip 'sanitizers take more address space than that'
    scenario
    printf '%s\n' '#!/bin/sh' '[ "${OMPI_COMM_WORLD_RANK:-$PMI_RANK}" != 1 ] || ulimit -v 300000' 'exec "$@"' >limited
    chmod +x limited
    large=(--set level=loggp --set kernel=inverse --set machine.topology.dims='[32, 32, 16]' --spread mpi -q -o all.db)
    fails_with 1 start "$1" 3 ./limited "$MIMDSIM" run t.yaml "${large[@]}" --set n=16384,64
    stderr_says 'process 1 of the job: cannot reserve 1140850688 bytes of address space'
    sql_is all.db "SELECT group_concat(status, ' ') FROM (SELECT status FROM run ORDER BY n)" 'ok failed'
    # a scene too large for it is refused in its words before any process makes its part
    fails_with 78 start "$1" 3 ./limited "$MIMDSIM" run t.yaml "${large[@]}" --set n=1200000 --set ranks=64
    stderr_says 'process 1 of the job: a run of 393750 bodies would take'
    # alone it ends with the status of refused memory
    fails_with 71 start "$1" 3 ./limited "$MIMDSIM" run t.yaml "${large[@]}" --set n=16384
}

@test "a process without memory for its part is told with its reason, with Open MPI" { says_whose_memory openmpi; }
@test "a process without memory for its part is told with its reason, with MPICH" { says_whose_memory mpich; }

@test "--spread and what it does not go with" {
    scenario
    fails_with 64 mimdsim run t.yaml --spread pvm
    stderr_says "--spread 'pvm': expected mpi"
    fails_with 64 mimdsim run t.yaml --spread mpi --campaign mpi
    stderr_says 'a job does one or the other'
    [ ! -e mimdsim.db ]
}

@test "a build without that MPI says so" {
    cp "$MIMDSIM" lonely
    export MIMDSIM_DATA
    scenario
    PMI_RANK=0 fails_with 69 ./lonely run t.yaml --spread mpi
    stderr_says 'built without MPICH'
}

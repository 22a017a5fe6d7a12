# campaign_mpi.bats - one campaign on the processes of an MPI job, with Open MPI and with MPICH.
load helper
load campaigns

# start FAMILY N COMMAND...: N processes of a job; as root, on fewer processors than processes.
start() {
    local family=$1 n=$2
    shift 2
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
    # What MPI's libraries keep to their end is no leak of ours.
    ASAN_OPTIONS=${ASAN_OPTIONS-}:detect_leaks=0 timeout -k 5 120 "mpirun.$family" -n "$n" "$@"
}

# needs FAMILY: skip the test where this build or this host does not have it.
needs() {
    [ -e "$(dirname "$MIMDSIM")/mimdsim-hosts-$1.so" ] || skip "built without $1"
    command -v "mpirun.$1" >/dev/null || skip "no mpirun.$1"
}

shares_a_campaign() {
    needs "$1"
    many 20
    works mimdsim run own.yaml -o whole.db --quiet
    table=$output
    works start "$1" 3 "$MIMDSIM" run own.yaml --campaign mpi -o all.db --quiet
    stdout_is "$table"
    diff <(rows whole.db) <(rows all.db)
    [ "$(rows all.db | wc -l)" -gt 500 ]
    # Nothing is left to do, and only the first process answers.
    works start "$1" 2 "$MIMDSIM" run own.yaml --campaign mpi -o all.db --quiet --json
    json_is_valid
    sql_is all.db 'SELECT max(id) FROM run' 20
}

survives_kills() {
    needs "$1"
    many 40
    works mimdsim run own.yaml -o whole.db --quiet
    # Any process: those that mpirun started, and the workers that make their runs.
    local seeds="1 2"
    if sanitized; then seeds=1; fi
    for seed in $seeds; do
        rm -f all.db*
        for attempt in 1 2; do
            start "$1" 3 "$MIMDSIM" run own.yaml --campaign mpi -o "$PWD/all.db" --quiet >/dev/null 2>&1 3>&- &
            job=$!
            kill_one "$PWD/all.db" $((seed * 10 + attempt))
            wait $job || true
        done
        works start "$1" 3 "$MIMDSIM" run own.yaml --campaign mpi -o "$PWD/all.db" --quiet
        diff <(rows whole.db) <(rows all.db)
    done
}

@test "Open MPI: a campaign over three processes gives the rows of one" { shares_a_campaign openmpi; }
@test "MPICH: a campaign over three processes gives the rows of one" { shares_a_campaign mpich; }
@test "Open MPI: kill -9 of any process, then the same command: the rows of an undisturbed campaign" { survives_kills openmpi; }
@test "MPICH: kill -9 of any process, then the same command: the rows of an undisturbed campaign" { survives_kills mpich; }

@test "a worker that is killed costs its run alone, and the run says so" {
    needs openmpi
    many 600
    start openmpi 2 "$MIMDSIM" run own.yaml --campaign mpi -o "$PWD/all.db" --quiet >/dev/null 2>&1 3>&- &
    job=$!
    # Workers are the children of the processes that mpirun started.
    worker=
    for try in $(seq 100); do
        for pid in $(processes_of "$PWD/all.db"); do
            parent=$(cut -d ' ' -f 4 "/proc/$pid/stat" 2>/dev/null) || continue
            case $(readlink "/proc/$parent/exe") in */mimdsim) worker=$pid ;; esac
        done
        [ -z "$worker" ] || break
        sleep 0.05
    done
    kill -9 "$worker"
    wait $job || status=$?
    [ "$status" -eq 1 ]
    sql_is all.db "SELECT count(*) FROM run WHERE status = 'ok'" 599
    sql_is all.db "SELECT text FROM run WHERE status = 'failed'" 'its worker process was killed by signal 9 (Killed)'
}

@test "a process that goes while the launcher lets the others live costs nothing" {
    needs openmpi
    many 200
    works mimdsim run own.yaml -o whole.db --quiet
    start openmpi 3 --enable-recovery "$MIMDSIM" run own.yaml --campaign mpi -o "$PWD/all.db" --quiet >/dev/null 2>told 3>&- &
    job=$!
    last=
    for try in $(seq 100); do
        for pid in $(processes_of "$PWD/all.db"); do
            tr '\0' '\n' <"/proc/$pid/environ" 2>/dev/null | grep -q '^OMPI_COMM_WORLD_RANK=2$' && last=${last:-$pid}
        done
        [ -z "$last" ] || break
        sleep 0.05
    done
    # the campaign has begun, and most of it is left
    for try in $(seq 200); do
        [ "$(sqlite3 "file:all.db?mode=ro" 'SELECT count(*) FROM run' 2>/dev/null || echo 0)" -lt 3 ] || break
        sleep 0.02
    done
    kill -9 "$last"
    wait $job || true
    grep 'process 2 of the job .*; other processes make its runs' told
    diff <(rows whole.db) <(rows all.db)
}

@test "processes with different plans, an MPI that is not there, another engine: refused" {
    many 4
    fails_with 64 mimdsim run own.yaml --campaign slurm -o all.db
    stderr_says "--campaign 'slurm': expected mpi"
    # A program without modules, as built without MPI.
    mkdir elsewhere
    cp "$MIMDSIM" elsewhere/mimdsim
    PMI_RANK=0 fails_with 69 elsewhere/mimdsim run own.yaml --campaign mpi -o all.db
    stderr_says 'built without MPICH'
    [ ! -e all.db ]
    needs openmpi
    fails_with 65 start openmpi 1 "$MIMDSIM" run own.yaml --campaign mpi -o all.db : \
        -n 1 "$MIMDSIM" run own.yaml --campaign mpi -o all.db --set n=501
    stderr_says 'process 1 of the job has another plan or another build of this program'
    fails_with 66 start openmpi 2 "$MIMDSIM" run nowhere.yaml --campaign mpi -o all.db
    [ "$(grep -c 'mimdsim: ' <<<"$stderr")" -eq 1 ]
    [ ! -e all.db ]
    fails_with 64 start openmpi 2 "$MIMDSIM" run own.yaml --campaign mpi --nothing
    [ "$(grep -c -- "--nothing" <<<"$stderr")" -eq 1 ]
}

@test "own programs and levels that the database decides run over MPI, too" {
    needs openmpi
    works mimdsim new heat
    works mimdsim run heat.yaml -o whole.db --quiet
    works start openmpi 3 "$MIMDSIM" run heat.yaml --campaign mpi -o all.db --quiet
    diff <(rows whole.db) <(rows all.db)
    many 4
    sed -i 's/^level:.*/level: auto-tolerance 5 %/' own.yaml
    works mimdsim run own.yaml -o whole2.db --quiet
    works start openmpi 2 "$MIMDSIM" run own.yaml --campaign mpi -o all2.db --quiet
    diff <(rows whole2.db) <(rows all2.db)
    sql_is all2.db "SELECT count(*) FROM run WHERE level = 'auto-tolerance'" 0
}

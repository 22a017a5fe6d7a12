#!/usr/bin/env bats
# reality.bats - this computer as a machine file, predictions beside measurements, programs of their own mpicc. Times are
# only looked at for being sane: the computer may be busy, and then calibration refuses, which is right, too.

load helper
load mpi_job

# calibrated FAMILY PROCESSES: quick calibration into my.yaml; skip where this computer is too busy for it.
calibrated() {
    run --separate-stderr -- start "$1" "$2" "$MIMDSIM" calibrate --quick -o my.yaml -q
    [ "$status" -ne 75 ] || { [[ $stderr == *'were undisturbed, fewer than'* ]] && [ ! -e my.yaml ] && skip "busy"; }
    [ "$status" -eq 0 ] || { show; return 1; }
}

@test "calibrate writes a machine file that is valid, with class, residual, date and host of every number" {
    needs mpich
    calibrated mpich 2
    works mimdsim check my.yaml
    grep -q "# Load meanwhile: other programs kept" my.yaml
    # Every value is measured, here and today.
    [ "$(grep -c 'value:' my.yaml)" -eq "$(grep 'value:' my.yaml | grep -c "class: measured.*$(uname -n), 20..-..-..")" ]
    for key in flop_rate div sqrt trig bandwidth; do grep -q "$key: {value" my.yaml; done
    grep -q 'residual .* median, .* largest' my.yaml
    # How fast the computer was meanwhile, where predict looks for it.
    for key in flop_rate sqrt call bandwidth; do grep -q "$key: {value: .*; probe [0-9.e-]* ns; " my.yaml; done
    [ "$(grep -c 'bandwidth: {value: .*; probe' my.yaml)" -eq 2 ] # copies, messages
    # The code of programs in one file, and the collectives; each with what it was fitted to.
    if command -v gcc >/dev/null; then
        for key in issue div root chain step load whole; do grep -q "^    $key: {value: .* cycles, .*fit to .* loops, residual" my.yaml; done
        works mimdsim plan calibrate-code --format lines
        [ "$(grep -c '^#   calibrate-code, loop = ' my.yaml)" -eq $((${#lines[@]} - 1)) ] # a heading
    fi
    grep -q 'collectives by algorithm and size on 2 processors; predicted from the segments with a residual of' my.yaml
    [ "$(grep -c '^#   allreduce ' my.yaml)" -ge 1 ]
    # Messages between two processes of a computer take between 20 ns and 5 ms, and large ones longer.
    works mimdsim run pingpong -m my.yaml --set ranks=2 --set kernel.message='[0 B, 64 KiB, 1 MiB]' -o p.db -q
    sql_is p.db "SELECT count(*), min(measured_s) > 2e-8, max(measured_s) < 5e-3, max(measured_s) > 5 * min(measured_s)
        FROM run WHERE status = 'ok'" '3|1|1|1'
    works mimdsim machines my.yaml
    stdout_says measured
}

@test "a machine file that cannot be made is told before anything is measured" {
    SECONDS=0
    ASAN_OPTIONS=${ASAN_OPTIONS-}:detect_leaks=0 fails_with 73 mimdsim calibrate -o nowhere/my.yaml # MPI leaks
    stderr_says "cannot make nowhere/my.yaml"
    [ "$SECONDS" -lt 10 ]
    ls >left
    [ "$(cat left)" = left ]
}

@test "calibrate on one process measures rates alone, with Open MPI" {
    needs openmpi
    calibrated openmpi 1
    works mimdsim check my.yaml
    ! grep -q segments my.yaml
    works start openmpi 1 "$MIMDSIM" run speedup-t3e --set ranks=1 --set n=32 --set kernel=dynamics --backend mpi \
        --samples 5 --limit 2 -q
    works mimdsim predict speedup-t3e -m my.yaml --set ranks=1 --set n=32 --set kernel=dynamics --json
    json_is_valid
    json_is '$[0].program' dynamics
    # A sane ratio: within a factor of five, on a computer that may be busy with anything.
    ratio=$(sqlite3 :memory: "SELECT json_extract('$output', '\$[0].predicted_s')
        / json_extract('$output', '\$[0].measured_s') BETWEEN 0.2 AND 5")
    [ "$ratio" = 1 ] || { show; return 1; }
}

# A measured row whose times are what the simulator predicts on the Paragon.
planted() {
    scenario=(speedup-t3e --set ranks=2 --set n=16 --set kernel=dynamics --set level=loggp -o r.db)
    works start mpich 2 "$MIMDSIM" run "${scenario[@]}" --backend mpi --samples 1 --limit 0.1 -q
    works mimdsim run "${scenario[@]}" -m paragon -q
    sqlite3 r.db "UPDATE real_run SET median_s = (SELECT makespan_ps * 1e-12 FROM run WHERE machine = 'paragon'),
        min_s = (SELECT makespan_ps * 0.8e-12 FROM run WHERE machine = 'paragon'), samples = 10, disturbed = 1, oversubscribed = 0, load_others = 0.25"
}

@test "predict compares by time and stage, and names the parameter that explains the difference" {
    needs mpich
    planted
    works mimdsim predict "${scenario[@]}" -m paragon
    stdout_says '0.0   0.25'
    stdout_says 'error of 1: median 0.0 %, largest 0.0 %; against the shortest repetitions: median 25.0 %, largest 25.0 %'
    # On a Paragon whose flops take less time the prediction is too small, and that price is told.
    works mimdsim predict "${scenario[@]}" -m paragon --set machine.node.flop_rate='8 Mflop/s' --json
    json_is '$[0].counted' 1
    json_is '$[0].explained_by' node.flop_rate
    [ "$(sqlite3 :memory: "SELECT round(x ->> 'predicted_s' / (x ->> 'shortest_s') - 1 - (x ->> 'error_of_shortest'), 9),
        round(x ->> 'error_of_shortest', 2) <> 0 FROM (SELECT '${output}' -> '\$[0]' AS x)")" = '0.0|1' ]
    works mimdsim predict "${scenario[@]}" -m paragon --stages
    [ "$(grep -c ' us$' <<<"$output")" -eq 8 ]
    # What was measured on too few processors or with too many disturbances is shown and does not count.
    sqlite3 r.db 'UPDATE real_run SET oversubscribed = 1'
    works mimdsim predict "${scenario[@]}" -m paragon
    stdout_says 'not counted: more ranks than processors'
    [[ $output != *'error of'* ]]
    sqlite3 r.db 'UPDATE real_run SET oversubscribed = 0, disturbed = 8'
    works mimdsim predict "${scenario[@]}" -m paragon
    stdout_says 'not counted: disturbed'
}

# on_mine OPTION...: predictions for the planted run by a Paragon of which a file says how fast it was when it was measured.
on_mine() { works mimdsim predict "${scenario[@]}" -m ./mine.yaml "$@"; }

@test "predict corrects predictions for the speed that the computer had at a run" {
    needs mpich
    planted
    # Five bursts of four repetitions, while operations took twice as long as at calibration; as a Paragon of half the rates.
    printf '%s\n' 'schema_version: 1' 'base: paragon' 'title: Mine' 'node:' \
        '  flop_rate: {value: 7 Mflop/s, class: measured, source: "made up; probe 1 ns; here"}' \
        '  call: {value: 0.4 us, class: measured, source: "made up; probe 1 ns; here"}' >mine.yaml
    works mimdsim run "${scenario[@]}" -m ./mine.yaml -q --set machine.node.flop_rate='3.5 Mflop/s' \
        --set machine.node.div='76 cycles' --set machine.node.trig='500 cycles' --set machine.node.call='0.8 us'
    sqlite3 r.db "UPDATE real_run SET median_s = (SELECT makespan_ps * 1e-12 FROM run WHERE machine = 'mine'), samples = 20,
            text = '{\"bursts\":[4,4,4,4,4],\"multiply_add\":[2,2,2,2,2,2,2,2,2,2],\"call\":[2,2,2,2,2,2,2,2,2,2],
                \"chain\":[1,1,1,1,1,1,1,1,1,1]}';
        DELETE FROM real_sample;
        WITH RECURSIVE i(k) AS (SELECT 0 UNION ALL SELECT k + 1 FROM i WHERE k < 19)
            INSERT INTO real_sample SELECT real_id, k, median_s, 0 FROM real_run, i"
    on_mine
    stdout_says 'slower corrected_%'
    stdout_says 'error of 1: median '
    stdout_says 'error of 1, corrected for the speed of the computer at each run (which makes predictions 1.'
    stdout_says ' times as long): median 0.0 %, largest 0.0 %'
    on_mine --json
    json_is_valid
    json_is '$[0].bursts' 5
    json_is '$[0].steady_bursts' 5
    [ "$(sqlite3 :memory: "SELECT abs(json_extract('$output', '\$[0].error_at_condition')) < 1e-6,
        json_extract('$output', '\$[0].error') < -0.3, json_extract('$output', '\$[0].slower') BETWEEN 1.4 AND 2")" = '1|1|1' ]
    # The computer became another one during three of the five bursts: shown, and not counted.
    sqlite3 r.db "UPDATE real_run SET text = replace(text, 'add\":[2,2,2,2,2,2', 'add\":[2,3,2,3,2,3')"
    on_mine
    stdout_says "not counted: the computer's speed changed"
    [[ $output != *'error of'* ]]
    # Of a row that says nothing of it the error is as before; so it is with a file that does not.
    sqlite3 r.db "UPDATE real_run SET text = '{\"bursts\": 5, \"call\": \"[\", \"chain\": [[], null, \"x\"], \"copy\": [-1e999'"
    on_mine
    stdout_says 'error of 1: median '
    [[ $output != *'corrected for'* ]]
    sqlite3 r.db "UPDATE real_run SET text = text || ']}'" # now it is JSON
    on_mine --json
    json_is '$[0].bursts' 0
    json_is '$[0].counted' 1
    sqlite3 r.db "UPDATE real_run SET text = '{\"bursts\":[20],\"multiply_add\":[2,2],\"call\":[2,2],\"chain\":[1,1]}'"
    sed -i 's/; probe 1 ns//' mine.yaml
    on_mine
    stderr_says 'the machine file does not say how fast the computer was when it was calibrated'
    [[ $output != *'corrected for'* ]]
}

@test "a real run notes how fast the computer was before and after each of its bursts" {
    needs mpich
    works start mpich 2 "$MIMDSIM" run speedup-t3e --set ranks=2 --set n=16 --set kernel=inverse --backend mpi --samples 9 \
        --limit 2 -o r.db -q
    # Three bursts, in order with the samples; a look on each side of each, in ns.
    sql_is r.db "SELECT json_array_length(text, '\$.bursts') BETWEEN 1 AND 3,
        (SELECT sum(value) FROM json_each(text, '\$.bursts')) = samples,
        (SELECT count(*) FROM json_each(text) AS j, json_each(j.value) AS l WHERE j.key <> 'bursts' AND l.value > 0)
            = 10 * json_array_length(text, '\$.bursts') FROM real_run" '1|1|1'
}

# Without an exchange beforehand nearly every message of the first hundreds meets a page fault, on MPICH.
first_messages() {
    needs "$1"
    [ "$(getconf _NPROCESSORS_ONLN)" -ge 2 ] || skip "one processor"
    cp "$MIMDSIM_BUILDDIR/tests/host/fresh_messages" .
    ln -s "$(dirname "$MIMDSIM")/mimdsim-hosts-$1.so" .
    works start "$1" 2 ./fresh_messages
    [ "$output" -le 12 ] || { show; return 1; } # of 120 messages, in both processes
}

@test "the memory of messages is there before messages are measured, with Open MPI" { first_messages openmpi; }
@test "the memory of messages is there before messages are measured, with MPICH" { first_messages mpich; }

@test "repetitions with page faults that others did without are disturbed" {
    needs mpich
    command -v gcc >/dev/null || skip "no gcc"
    # Half of the repetitions, by chance, touch 1,024 pages for the first time; the sanitizer has some of its own in each.
    cat >touch.c <<'C'
#include <mimdsim/program.h>
#include <sys/mman.h>
static void run(struct comm *c)
{
    const double one = 1;
    volatile char *fresh = mmap(0, 40 << 20, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (comm_now_ps(c) / 1000 % 2)
        for (long k = 0; k < 1024; k++) fresh[k * 4096] = 1;
    munmap((void *)fresh, 40 << 20);
    comm_publish(c, 0, 0, 1, &one);
}
PROGRAM(.title = "pages", .output = {"x"}, .run = run);
C
    works start mpich 1 "$MIMDSIM" run touch.c --set ranks=1 --backend mpi --samples 20 --limit 20 -o r.db -q
    # Where nothing else runs there would be none or two.
    sql_is r.db "SELECT status, disturbed >= 5, samples > disturbed FROM real_run" 'ok|1|1'
}

@test "predict tells which machine it is, and takes no shipped one unless it is named" {
    needs mpich
    planted
    host=$(sqlite3 r.db 'SELECT host FROM real_run')
    fails_with 64 mimdsim predict "${scenario[@]}"
    stderr_says "the runs were measured on $host, and t3e-300 is another machine: name the machine file of $host"
    stdout_is_empty
    works mimdsim predict "${scenario[@]}" -m paragon
    [ "$(head -1 <<<"$output")" = "predicted on paragon, measured on $host" ]
    works mimdsim predict "${scenario[@]}" --set machine=t3e-300 --set machine.network.hop_latency='1 us'
    [ "$(head -1 <<<"$output")" = "predicted on t3e-300, hop_latency 1 us, measured on $host" ]
    works mimdsim predict "${scenario[@]}" -m paragon --json
    json_is '$[0].machine' paragon
    # A file of one's own that the scenario names is what is meant.
    printf '%s\n' 'schema_version: 1' 'base: paragon' 'title: Mine' 'network: {hop_latency: 1 us}' >mine.yaml
    sed 's/^machine: t3e-300/machine: mine/' "$MIMDSIM_DATA/scenarios/speedup-t3e.yaml" >speedup.yaml
    works mimdsim predict speedup.yaml "${scenario[@]:1}"
    [ "$(head -1 <<<"$output")" = "predicted on mine, measured on $host" ]
}

@test "predict without measured runs says how to make them" {
    works mimdsim run pingpong -q --set ranks=2 --set kernel.message='8 B'
    fails_with 66 mimdsim predict speedup-t3e --set ranks=2 --set n=16
    stderr_says 'mimdsim.db has no measured run of this scenario; make some by mpirun -n 2 mimdsim run'
    fails_with 66 mimdsim predict speedup-t3e -o none.db
    fails_with 64 mimdsim predict
}

@test "a program in one file is predicted with the prices of its code" {
    needs mpich
    command -v gcc >/dev/null || skip "no gcc"
    calibrated mpich 1
    cp "$MIMDSIM_SRCDIR/examples/stencil.c" .
    works start mpich 1 "$MIMDSIM" run stencil.c --set ranks=1 --set n=128 --backend mpi --samples 5 --limit 2 -q
    works mimdsim predict stencil.c -m my.yaml --set ranks=1 --set n=128 --json
    json_is_valid
    # A sane ratio, on a computer that may be busy with anything; and prices that act.
    ratio=$(sqlite3 :memory: "SELECT json_extract('$output', '\$[0].predicted_s')
        / json_extract('$output', '\$[0].measured_s') BETWEEN 0.2 AND 5")
    [ "$ratio" = 1 ] || { show; return 1; }
    first=$(sqlite3 :memory: "SELECT json_extract('$output', '\$[0].predicted_s')")
    works mimdsim predict stencil.c -m my.yaml --set ranks=1 --set n=128 --set machine.node.code.issue='9 cycles' --json
    [ "$(sqlite3 :memory: "SELECT json_extract('$output', '\$[0].predicted_s') > 3 * $first")" = 1 ]
    json_is '$[0].explained_by' node.code
}

@test "calibrate without gcc has one price of an instruction, and says so" {
    needs mpich
    mkdir empty
    for tool in sh bash env cat rm mkdir uname hydra_pmi_proxy mpirun.mpich mpiexec.hydra; do
        t=$(command -v $tool) && ln -s "$t" empty/$tool
    done
    export XDG_CACHE_HOME="$PWD/empty-cache"
    run --separate-stderr -- env ASAN_OPTIONS=${ASAN_OPTIONS-}:detect_leaks=0 PATH="$PWD/empty" MIMDSIM_CC=no-such-gcc "$(command -v mpirun.mpich)" -n 1 "$MIMDSIM" calibrate --quick -o my.yaml
    [ "$status" -ne 75 ] || skip "busy"
    [ "$status" -eq 0 ] || { show; return 1; }
    stderr_says 'the code of programs in one file is not measured:'
    grep -q '^  instruction: {value: ' my.yaml
    ! grep -q '^  code:' my.yaml
}

own_mpi_program() {
    needs "$1"
    command -v "mpicc.$1" >/dev/null || skip "no mpicc.$1"
    cat >ring.c <<'C'
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
int main(int argc, char **argv)
{
    int rank, size, token = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (rank == 0) usleep(argc > 1 ? (useconds_t)atoi(argv[1]) : 0);
    MPI_Sendrecv(&rank, 1, MPI_INT, (rank + 1) % size, 0, &token, 1, MPI_INT, (rank + size - 1) % size, 0,
                 MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    printf("%d\n", token);
    MPI_Finalize();
    return argc > 2;
}
C
    "mpicc.$1" -o ring ring.c
    works mimdsim record -n 2 --samples 3 -q -- ./ring 20000
    stdout_says 'ring: P = 2'
    # Sleeping on rank 0 is waited for by all; starting mpirun is no part of the time.
    sql_is mimdsim.db "SELECT backend, program, settings, P, samples, status, min_s >= 0.02, min_s < 2, length(task_hash)
        FROM real_run" 'record|ring|./ring 20000|2|3|ok|1|1|64'
    sql_is mimdsim.db 'SELECT count(*) FROM real_sample' 3
    fails_with 1 mimdsim record -n 2 --samples 1 -q -- ./ring 1 2
    stderr_says "'./ring' on 2 processes ended with status"
    [ -z "$(find . -name 'mimdsim-record-*')" ]
}

programs_of_their_own() {
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
    ASAN_OPTIONS=${ASAN_OPTIONS-}:detect_leaks=0 own_mpi_program "$1"
}

@test "record times a program of Open MPI's mpicc" { programs_of_their_own openmpi; }
@test "record times a program of MPICH's mpicc" { programs_of_their_own mpich; }

@test "record times a Fortran program of MPICH's mpif90" {
    needs mpich
    command -v mpif90.mpich >/dev/null || skip "no mpif90.mpich"
    cat >sum.f90 <<'F'
program total
   use mpi
   implicit none
   integer :: rank, size, error, all, from
   call MPI_Init(error)
   call MPI_Comm_rank(MPI_COMM_WORLD, rank, error)
   call MPI_Comm_size(MPI_COMM_WORLD, size, error)
   all = rank
   call MPI_Allreduce(MPI_IN_PLACE, all, 1, MPI_INTEGER, MPI_SUM, MPI_COMM_WORLD, error)
   if (all /= size * (size - 1) / 2) call MPI_Abort(MPI_COMM_WORLD, 1, error)
   call MPI_Sendrecv(rank, 1, MPI_INTEGER, mod(rank + 1, size), 0, from, 1, MPI_INTEGER, mod(rank + size - 1, size), 0, &
                     MPI_COMM_WORLD, MPI_STATUS_IGNORE, error)
   if (from /= mod(rank + size - 1, size)) call MPI_Abort(MPI_COMM_WORLD, 2, error)
   call MPI_Finalize(error)
end program total
F
    # both modules, whose MPI_Init and constants are not the same
    sed 's/use mpi$/use mpi_f08/' sum.f90 >sum8.f90
    for program in sum sum8; do
        mpif90.mpich -o $program $program.f90 || skip "mpif90 does not work"
        ASAN_OPTIONS=${ASAN_OPTIONS-}:detect_leaks=0 works mimdsim record -n 2 --samples 2 -q -- ./$program
        stdout_says "$program: P = 2"
        sql_is mimdsim.db "SELECT P, samples, status, min_s > 0, min_s < 60 FROM real_run WHERE program = '$program'" '2|2|ok|1|1'
    done
}

@test "record refuses what it cannot time" {
    fails_with 64 mimdsim record -n 2
    stderr_says 'expected -- PROGRAM'
    fails_with 66 mimdsim record -- ./none
    stderr_says "there is no program './none' that can be run"
    fails_with 65 mimdsim record -- /bin/sh
    stderr_says 'is not linked with the shared library of MPICH or Open MPI'
    for n in 0 x 1025; do
        fails_with 64 mimdsim record -n $n -- /bin/sh
        stderr_says "-n '$n': expected a number from 1 to 1024"
    done
    nothing_left_behind
}

@test "a build without MPI says so, and the rest works" {
    cp "$MIMDSIM" lonely
    export MIMDSIM_DATA
    PMI_RANK=0 fails_with 69 ./lonely calibrate -o my.yaml
    stderr_says 'built without MPICH'
    fails_with 69 ./lonely calibrate
    [ ! -e my.yaml ]
    if command -v mpicc.mpich >/dev/null; then
        echo 'int MPI_Init(int *, char ***); int main(void) { return MPI_Init(0, 0); }' >one.c
        mpicc.mpich -o one one.c
        fails_with 69 ./lonely record -n 1 -- ./one
        stderr_says 'built without MPICH'
    fi
    works ./lonely machines t3e-300
}

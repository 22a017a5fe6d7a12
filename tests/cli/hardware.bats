#!/usr/bin/env bats
# hardware.bats - collectives that a machine's network does itself: published times, refusals, MPI programs and kernels with
# the same values as by messages; what `explain` says of them and of routing rules at each level.

load helper

# A collective of ranks $3 on machine $1 by algorithm $2, of size $4: its time in microseconds is in $time.
collective() {
    works mimdsim run allreduce-algorithms --machine "$1" --set kernel.algorithm="$2" --set ranks="$3" \
        --set kernel.message="$4" -o "${5-here.db}" --csv --quiet
    time=$(sqlite3 "${5-here.db}" "SELECT printf('%.2f', makespan_ps / 1e6) FROM run ORDER BY id DESC LIMIT 1")
}

@test "published times of switches that add: 8 B and 4 KiB on 128 hosts" {
    collective infiniband-hdr-sharp hardware 128 "8 B"
    [ "$time" = 2.83 ]
    collective infiniband-hdr-sharp auto 128 "4096 B"
    [ "$time" = 14.48 ]
    # a vector that is too long goes by messages, as on the machine without
    collective infiniband-hdr-sharp auto 128 "8192 B"
    long=$time
    collective infiniband-hdr auto 128 "8192 B" other.db
    [ "$time" = "$long" ]
}

@test "barrier interface and torus trees by the formula" {
    # 384 nodes of four ranks: 2.759 + 18 x 0.1 + 8 / 6800
    works mimdsim run allreduce-algorithms --machine fugaku-barrier --set 'machine.topology.dims=[2, 3, 2, 2, 2, 8]' \
        --set machine.topology.processors_per_node=4 --set ranks=1536 --set kernel.message='8 B' \
        --set kernel.algorithm=auto -o here.db --columns makespan_us --quiet
    stdout_says "4.56018"
    # 0.5 + 30 x 0.0733 + 65536 / 1680
    collective bluegene-q-tree auto 2048 "64 KiB"
    [ "$time" = 41.71 ]
}

@test "machines without it, vectors too long and sums where only bits combine are refused with the key" {
    fails_with 78 mimdsim run allreduce-algorithms --set kernel.algorithm=hardware --set ranks=16 --set kernel.message='8 B'
    stderr_says "the network of t3e-300 has no hardware for allreduce (network.collective.kinds)"
    fails_with 78 mimdsim run allreduce-algorithms --machine fugaku-barrier --set kernel.algorithm=hardware --set ranks=16 \
        --set kernel.message='32 B'
    stderr_says "takes vectors of at most 24 B (network.collective.largest), this one has 32 B"
    fails_with 78 mimdsim run allreduce-algorithms --machine t3e-300-eureka --set kernel.algorithm=hardware --set ranks=16 \
        --set kernel.message='8 B'
    stderr_says "cannot do this operation (network.collective.operations)"
    fails_with 78 mimdsim run collectives --set kernel.name=message-barrier --machine paragon --set kernel.algorithm=hardware \
        --set ranks=16
    stderr_says "no hardware for barrier (software.barrier.kind)"
}

@test "a time beyond all simulated time is told as that, not as a number" {
    works mimdsim explain allreduce-algorithms --machine infiniband-hdr-sharp --set kernel.algorithm=hardware --set ranks=16 \
        --set kernel.message='4 KiB' --set machine.network.collective.bandwidth='1e-6 B/s'
    stdout_says "more than simulated time holds after the last rank's entry"
}

@test "rules for hardware that is not there, and kinds that no network does, are refused with file and line" {
    printf 'schema_version: 1\nbase: paragon\nsoftware: {collectives: "allreduce hardware"}\n' >my.yaml
    fails_with 78 mimdsim check my.yaml
    stderr_says "software.collectives says 'allreduce hardware', but the network of my has no hardware for allreduce"
    fails_with 78 mimdsim run barrier --machine paragon --set machine.software.collectives='barrier hardware' \
        --set machine.software.barrier.kind=software
    stderr_says "(software.barrier.kind)"
    fails_with 65 mimdsim run barrier --set machine.network.collective.kinds=alreduce
    stderr_says "'alreduce' is no collective of networks; expected 'allreduce'"
    fails_with 65 mimdsim run barrier --set machine.network.collective.kinds=barrier
    stderr_says "software.barrier.kind: hardware"
    fails_with 65 mimdsim run barrier --set machine.network.collective.operations=reals
    stderr_says "real"
}

@test "settings that do not act are told" {
    works mimdsim run allreduce-algorithms --set machine.network.collective.latency='1 us' --set ranks=16 \
        --set kernel.message='8 B' --set kernel.algorithm=auto
    stderr_says "network.collective.kinds is empty"
    works mimdsim run allreduce-algorithms --machine infiniband-hdr-sharp --set machine.network.collective.latency='1 us' \
        --set ranks=16 --set kernel.message='8 B' --set kernel.algorithm=ring
    stderr_says "no collective is done by 'hardware' here"
}

@test "an MPI program has the same values by the network, in less time; non-blocking calls go by messages" {
    command -v gcc >there || skip "no gcc"
    cat >sums.c <<'END'
#include <mpi.h>
#include <stdio.h>
int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    int rank, size, found, any, all, token = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    double x[3] = {1.0 / (rank + 1), 1e9 * rank, 1e-9}, sum[3], least[3] = {0}, later[3];
    MPI_Allreduce(x, sum, 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    MPI_Reduce(x, least, 3, MPI_DOUBLE, MPI_MIN, size - 1, MPI_COMM_WORLD);
    found = rank == 2;
    MPI_Allreduce(&found, &any, 1, MPI_INT, MPI_LOR, MPI_COMM_WORLD);
    MPI_Allreduce(&found, &all, 1, MPI_INT, MPI_LAND, MPI_COMM_WORLD);
    MPI_Bcast(sum, 3, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    /* Ranks go on after a non-blocking call: the last one comes to it when rank 0 has left it. */
    MPI_Request request[2];
    for (int i = 0; i < 2; i++) {
        const int last = size > 1 && rank == size - 1;
        if (last) MPI_Recv(&token, 1, MPI_INT, 0, 5, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        if (i == 0) MPI_Ibarrier(MPI_COMM_WORLD, &request[i]);
        else MPI_Iallreduce(x, later, 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD, &request[i]);
        if (size > 1 && rank == 0) MPI_Send(&token, 1, MPI_INT, size - 1, 5, MPI_COMM_WORLD);
    }
    MPI_Waitall(2, request, MPI_STATUSES_IGNORE);
    if (rank == size - 1)
        printf("%a %a %a %a %a %d %d %a\n", sum[0], sum[1], sum[2], least[0], least[2], any, all, later[0]);
    MPI_Finalize();
    return 0;
}
END
    works mimdsim cc -O1 -o sums sums.c
    for n in 1 7 8; do
        works mimdsim mpirun -q -n $n -m bluegene-q ./sums
        messages=$output
        works mimdsim mpirun -q -n $n -m bluegene-q-tree ./sums
        # For powers of two recursive doubling adds in the same order.
        [ $n = 7 ] || [ "$output" = "$messages" ]
        works mimdsim mpirun -q -n $n -m t3e-300-eureka ./sums
        [ $n = 7 ] || [ "$output" = "$messages" ]
    done
    # One rule each way: which collectives send messages is seen in their number.
    works mimdsim mpirun -n 8 -m bluegene-q ./sums
    stderr_says "bluegene-q"
    first=$stderr
    works mimdsim mpirun -n 8 -m bluegene-q-tree ./sums
    [ "$first" != "$stderr" ]
}

@test "explain: how long the network takes, over how many links, and what is left out" {
    works mimdsim explain allreduce-algorithms --machine bluegene-q-tree --set ranks=2048 --set kernel.message='8 B' \
        --set kernel.algorithm=auto
    stdout_says "allreduce of 8 B on 2048 ranks by the network of bluegene-q-tree: 2.70376"
    stdout_says "over 30 links"
    stdout_says "left out of collectives by the network: other messages on its links"
    stdout_says "the network does a collective of all ranks"
    works mimdsim explain allreduce-algorithms --machine bluegene-q-tree --set ranks=2048 --set kernel.message='8 B' \
        --set kernel.algorithm=hardware --json
    json_is '$.collectives[0].links' 30
    json_is '$.collectives[0].collective' allreduce
    works mimdsim explain allreduce-algorithms --set ranks=16 --set kernel.message='8 B' --json
    json_is '$.collectives[0].bytes' ""
}

@test "explain: what the routing rule does at the level, and what each level leaves out of it" {
    works mimdsim explain speedup-t3e --set n=4
    stdout_says "routing deterministic, level link (1 of 2 runs): the one route that the topology gives for two nodes"
    stdout_says "left out: messages that meet on a link do not wait for each other"
    [[ $output != *"at level flit"* ]]
    works mimdsim explain speedup-t3e --set n=4 --set level=link --set machine.network.routing=adaptive
    stdout_says "routing adaptive, level link: any link that leads nearer"
    stdout_says "by the time for which links are reserved; left out: buffers, channels and credits"
    for level in loggp packet auto flit; do stdout_says "  at level $level: "; done
    works mimdsim explain speedup-t3e --set n=4 --set level=link --set machine.network.routing=adaptive --json
    json_is '$.routing[0].rule' adaptive
    json_is '$.routing[0].runs' 1
    works mimdsim explain speedup-t3e --set n=4 --set level=link --set 'machine.network.failed.links=[[0, 1]]'
    stdout_says "routes around what network.failed names: 1 of 1 runs"
    # Runs that are alike have one line.
    works mimdsim explain speedup-t3e --set n=4,8 --set level=link
    [ "$(printf '%s\n' "$output" | grep -c '^routing deterministic')" = 1 ]
    # A crossbar has no routes.
    works mimdsim explain speedup-t3e --machine ideal --set n=4
    [[ $output != *"routing deterministic"* ]]
}

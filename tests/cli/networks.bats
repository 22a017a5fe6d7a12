#!/usr/bin/env bats
# networks.bats - networks of machines before and while something runs on them: numbers, pictures, every family, bad ones.

load helper

# every_what_if: the names of the machines made for comparing networks.
every_what_if() { (cd "$MIMDSIM_DATA/machines" && ls what-if-*.yaml) | sed 's/\.yaml$//'; }

@test "a network's numbers, costs and picture" {
    works mimdsim machines what-if-hyperx --topology --dir here
    stdout_says "hyperx 8 x 8"
    stdout_says "64, nodes 512, cables between routers 448"
    stdout_says "128 cables, 3.2 TB/s each way (exact, by closed form)"
    stdout_says "1.75342 links between two different nodes"
    stdout_says "678720, 1326 a node (prices of the machine file)"
    stderr_says "here/topology-what-if-hyperx.png and .svg"
    [ -s here/topology-what-if-hyperx.png ]
    grep -q '</svg>' here/topology-what-if-hyperx.svg
}

@test "several networks side by side, for programs" {
    works mimdsim machines what-if-torus what-if-dragonfly t3e-300 --topology --json --quiet
    json_is_valid
    json_is '$[0].bisection_cables' 128
    json_is '$[0].bisection_by' "closed form"
    json_is '$[0].diameter' 12
    json_is '$[1].bisection_by' partitioning
    json_is '$[1].longest_route' 3
    json_is '$[2].price' ""
    json_is '$[2].routers' 128
    stderr_is_empty
    works mimdsim machines what-if-slim-fly --topology --json --quiet
    json_is '$.diameter' 2
    json_is '$.ports_of_router' 16
}

@test "settings change the network that is shown" {
    works mimdsim machines t3e-300 --topology --set machine.topology.family=mesh --quiet
    stdout_says "mesh 8 x 4 x 4"
    stdout_says "16 cables"
    works mimdsim machines t3e-300 --topology --set machine.price.port=100 --quiet
    stdout_says "89600, 700 a node"
}

@test "without gnuplot, or of a network too large to draw, the numbers are there" {
    MIMDSIM_GNUPLOT=/no/gnuplot works mimdsim machines what-if-clos --topology
    stdout_says "folded-clos 16 x 32"
    stderr_says "/no/gnuplot"
    works mimdsim machines t3e-300 --topology --set machine.topology.dims='[32, 32, 16]'
    stdout_says "measured from 64 routers"
    stderr_says "16384 routers are too many for a picture"
}

@test "networks that cannot be, or are not named, are refused" {
    fails_with 64 mimdsim machines --topology
    stderr_says "needs the name of a machine"
    fails_with 78 mimdsim machines what-if-slim-fly --topology --set machine.topology.dims=6 --json
    json_is '$.error.kind' config
    stderr_says "q = 6; expected a prime power"
    fails_with 78 mimdsim machines what-if-clos --topology --set machine.topology.up='[8, 8]'
    stderr_says "2 numbers in topology.up"
    fails_with 78 mimdsim machines what-if-dragonfly-plus --topology --set machine.topology.dims='[8, 8, 8, 8, 80]'
    stderr_says "80 groups"
    nothing_left_behind
}

@test "a program runs on every what-if network, with the same messages and answer" {
    local m
    for m in $(every_what_if); do
        works mimdsim run allreduce-algorithms --machine "$m" --set ranks=48 --set kernel.message='4 KiB' \
            --set kernel.algorithm=recursive-doubling --quiet
    done
    sql_is mimdsim.db "SELECT count(DISTINCT machine) = $(every_what_if | wc -l), count(DISTINCT messages), min(status), max(status)
        FROM run" "1|1|ok|ok"
}

@test "a failed link costs time at every level, and the answer stays" {
    local level
    works mimdsim machines what-if-torus --topology --quiet --set 'machine.network.failed.links=[[0, 1]]'
    stdout_says "0 of 512 routers and 1 of 1536 cables do not work"
    for level in loggp link packet auto flit; do
        works mimdsim run allreduce-algorithms --machine what-if-torus --set ranks=64 --set kernel.message='4 KiB' \
            --set kernel.algorithm=recursive-doubling --set level=$level -o "$level.db" --quiet
        works mimdsim run allreduce-algorithms --machine what-if-torus --set ranks=64 --set kernel.message='4 KiB' \
            --set kernel.algorithm=recursive-doubling --set level=$level -o "$level.db" --quiet \
            --set 'machine.network.failed.links=[[0, 1], [9, 17]]'
        sql_is "$level.db" "SELECT count(*), min(status), max(status), count(DISTINCT messages),
            max(makespan_ps) FILTER (WHERE id = 2) > max(makespan_ps) FILTER (WHERE id = 1) FROM run" "2|ok|ok|1|1"
    done
}

@test "what failed is named, and a network that falls apart is refused" {
    fails_with 78 mimdsim machines t3e-300 --topology --set 'machine.network.failed.links=[[0, 9]]'
    stderr_says "no further cable joins routers 0 and 9; 0 is joined to 1, 7, 8, 24, 32, 96"
    fails_with 78 mimdsim machines t3e-300 --topology --set 'machine.network.failed.routers=[128]'
    stderr_says "there is no router 128; expected 0 to 127"
    fails_with 78 mimdsim machines t3e-300 --topology --set 'machine.network.failed.routers=[1, 7, 8, 24, 32, 96]'
    stderr_says "network.failed cuts the network"
    works mimdsim machines t3e-300 --topology --quiet --set 'machine.network.failed.routers=[1, 7, 8]'
    stdout_says "3 of 128 routers and 18 of 384 cables do not work"
}

@test "a mesh with more shortest ways than a number holds says so" {
    works mimdsim machines t3e-300 --topology --set machine.topology.family=mesh --set machine.topology.dims='[600, 600]'
    stdout_says 'more than 1.798e+308 shortest ways between two routers, 1 at least'
}

@test "check builds the networks of machines and scenarios, and names the line of what is not there" {
    printf '%s\n' 'schema_version: 1' 'base: t3e-300' 'network:' '  failed:' '    links: [[0, 9]]' >m.yaml
    fails_with 78 mimdsim check m.yaml
    stderr_says "m.yaml:5: network.failed.links: entry 0, no further cable joins routers 0 and 9; 0 is joined to 1, 7, 8, 24, 32, 96"
    printf '%s\n' 'schema_version: 1' 'base: t3e-300' 'network: {routing: nca}' >r.yaml
    fails_with 78 mimdsim check r.yaml
    stderr_says "r.yaml:3: network.routing 'nca' is not for topology 'torus'"
    # a point of a sweep is enough
    printf '%s\n' 'schema_version: 1' 'question: none?' 'kernel: barrier' 'ranks: 4' 'machine: t3e-300' \
        'sweep: {machine.network.failed.routers: ["[]", "[3]", "[128]"]}' >s.yaml
    fails_with 78 mimdsim check s.yaml
    stderr_says "s.yaml:6: network.failed.routers: there is no router 128; expected 0 to 127"
    sed -i 's/128/127/' s.yaml && sed -i 's/0, 9/0, 8/' m.yaml
    works mimdsim check s.yaml m.yaml
}

@test "every verb that reads a scenario refuses a machine that cannot be built, with the line of what is to blame" {
    local verb what
    for what in 'machine.placement: {kind: list, list: [0, 1, 1, 2]}|placement.list: ranks 1 and 2 on processor 1' \
        'machine.network: {routing: nca}|network.routing '"'nca' is not for topology 'torus'" \
        'machine.network: {level: packet, buffer: 1}|network.buffer is 1; level packet needs at least'; do
        printf '%s\n' 'schema_version: 1' 'question: none?' 'kernel: pingpong' 'ranks: 4' 'machine: t3e-300' "${what%|*}" >s.yaml
        for verb in check explain plan 'run -o s.db' why timeline accuracy stability 'compare pingpong'; do
            # shellcheck disable=SC2086
            fails_with 78 mimdsim $verb s.yaml
            stderr_says "s.yaml:6: ${what#*|}"
        done
    done
    [ ! -e s.db ]
    # of a sweep the other points run, and this one is told beside them
    printf '%s\n' 'schema_version: 1' 'question: none?' 'kernel: pingpong' 'ranks: 2' 'machine: t3e-300' \
        'sweep: {machine.network.failed.links: ["[]", "[[0, 9]]"]}' >s.yaml
    works mimdsim explain s.yaml
    stderr_says 's.yaml:6: network.failed.links: entry 0, no further cable joins routers 0 and 9'
    mimdsim plan s.yaml | grep -c refused | grep -qx 1
    # jobs are asked about together
    printf '%s\n' 'schema_version: 1' 'question: none?' 'machine: t3e-300' 'machine.network.failed.routers: [3]' 'jobs:' \
        '  - {name: a, kernel: barrier, ranks: 2, placement: [4, 3]}' '  - {name: b, kernel: barrier, ranks: 2}' >s.yaml
    fails_with 78 mimdsim explain s.yaml
    stderr_says 'processor 3 of rank 1 hangs on router 3, which'
}

@test "ranks are placed beside failed routers, as long as there is room" {
    works mimdsim run allreduce-algorithms --machine t3e-300 --set ranks=120 --set kernel.message='1 KiB' \
        --set kernel.algorithm=ring --set 'machine.network.failed.routers=[0, 5, 6]' --quiet
    sql_is mimdsim.db "SELECT status FROM run" ok
    run --separate-stderr -- mimdsim run allreduce-algorithms --machine t3e-300 --set ranks=126 \
        --set kernel.message='1 KiB' --set kernel.algorithm=ring --set 'machine.network.failed.routers=[0, 5, 6]' -o b.db
    [ "$status" -ne 0 ]
    [[ $stderr$output == *"125 of its 128 processors work"* ]]
}

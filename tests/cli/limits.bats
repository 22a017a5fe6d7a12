#!/usr/bin/env bats
# limits.bats - few bytes that ask for much, long paths, folders that cannot be written: what it takes is small, or refused by name.

load helper

# A scenario on a machine of 2^24 processors and 10^8 links and ports.
huge() {
    printf '%s\n' 'schema_version: 1' 'question: q' 'machine: {name: paragon, topology.dims: [4096, 4096]}' 'kernel: dynamics' \
        'model: {generator: serial-chain}' 'n: 16' 'ranks: 16' 'level: loggp' "record: {links: ${1:-false}}" >huge.yaml
}

@test "a run on a few of very many processors takes no memory for the others" {
    for links in false true; do
        huge $links
        for level in link packet; do
            works mimdsim run huge.yaml -o "$links.db" --quiet --set level=$level --set machine.network.buffer=2000
        done
        sql_is "$links.db" "SELECT count(*) FROM run WHERE status = 'ok'" 2
        sanitized || sql_is "$links.db" 'SELECT max(host_peak_bytes) < 50000000 FROM run' 1
    done
    # what was used, and nothing else; each link has two ends or a node
    sql_is true.db 'SELECT count(DISTINCT links), min(links) BETWEEN 32 AND 200 FROM run WHERE level <> "loggp"' '1|1'
    sql_is true.db 'SELECT count(*) FROM link_load WHERE messages = 0 OR (node IS NULL) <> (from_router IS NOT NULL AND to_router IS NOT NULL)' 0
    sql_is true.db "SELECT run_id FROM link_load l JOIN run r ON r.id = run_id GROUP BY run_id
                    HAVING sum(l.messages) FILTER (WHERE node IS NOT NULL AND from_router IS NULL) <> max(r.messages)" ''
}

@test "bodies that cannot fit into memory are refused before any is made" {
    huge
    for verb in explain 'run -o x.db'; do
        # shellcheck disable=SC2086
        run --separate-stderr -- timeout 600 "$MIMDSIM" $verb huge.yaml --machine ideal --set n=130000000 --set machine.topology.dims='[16]'
        [ "$status" -eq 78 ] || { show; return 1; }
        stderr_says 'bodies would take'
        stderr_says 'of memory; this computer has'
    done
    sanitized || sql_is x.db 'SELECT status, host_peak_bytes < 50000000 FROM run' 'failed|1'
}

@test "messages that many ranks cannot hold are refused before any is made, alone and beside another job" {
    huge
    for job in '' 'jobs: [{name: one}, {name: two, kernel: broadcast, ranks: 8}]'; do
        printf '%s\n' "$job" >>huge.yaml
        run --separate-stderr -- timeout 600 "$MIMDSIM" run huge.yaml -o "x$job.db" --machine t3e-300 --set kernel=broadcast \
            --set kernel.message='1 GiB' --set ranks=128
        [ "$status" -eq 78 ] || { show; return 1; }
        stderr_says "what 128 ranks of 'broadcast' work in would take 275 GB of memory; this computer has"
    done
    sanitized || sql_is x.db 'SELECT status, host_peak_bytes < 50000000 FROM run' 'failed|1'
}

# deep: make and enter a folder whose path is longer than 2,000 characters.
deep() {
    local name i
    name=$(printf 'd%.0s' {1..200})
    for i in 1 2 3 4 5 6 7 8 9 10 11; do mkdir "$name" && cd "$name" || return; done
}

@test "files of a path of 2,000 characters are read and written; a database there is refused with both numbers" {
    top=$PWD
    deep
    printf '%s\n' 'schema_version: 1' 'question: q' 'machine: t3e-300' 'kernel: barrier' 'ranks: 2' >small.yaml
    far=$PWD
    cd "$top"
    works mimdsim run "$far/small.yaml" -o near.db --quiet
    works mimdsim check "$far/small.yaml"
    works mimdsim explain "$far/small.yaml"
    works mimdsim report near.db --dir "$far/figures" --quiet
    for command in 'run small.yaml' 'query x.db SELECT+1' 'report x.db' 'merge x.db'; do
        # shellcheck disable=SC2086
        set -- $command
        case $1 in
        run) fails_with 73 mimdsim run "$far/small.yaml" -o "$far/x.db" ;;
        merge) fails_with 73 mimdsim merge "$far/x.db" near.db ;;
        *) cp near.db "$far/x.db"; fails_with 66 mimdsim "$1" "$far/x.db" ${3:+"$3"}; rm "$far/x.db" ;;
        esac
        stderr_says "/x.db: its path has $((${#far} + 5)) characters from the root, SQLite takes at most 504"
        [ ! -e "$far/x.db" ]
    done
    cd "$far"
    fails_with 73 mimdsim run small.yaml -o x.db
    stderr_says "x.db: its path has $((${#far} + 5)) characters"
    cd "$top"
    # the ends of the path and the reason remain of a message
    fails_with 66 mimdsim run "$far/smal.yaml"
    stderr_says "no file '$top/ddd"
    stderr_says "ddd/smal.yaml'"
    # longer than any path of the system
    for file in "$far$far$far/x.yaml" "$far$far$far/x.json" "$far$far$far/x.db"; do
        case $file in
        *.yaml) fails_with 66 mimdsim run "$file" ;;
        *.json) fails_with 66 mimdsim netcheck "$file" ;;
        *) fails_with 66 mimdsim report "$file" ;;
        esac
        stderr_says 'File name too long'
    done
}

@test "on a file system that cannot be written every verb that writes says so" {
    unshare -rm true 2>/dev/null || skip 'no file system can be mounted here'
    printf '%s\n' 'schema_version: 1' 'question: q' 'machine: t3e-300' 'kernel: barrier' 'ranks: 2' >small.yaml
    works mimdsim run small.yaml -o a.db --quiet
    mkdir mnt
    cat >inside.sh <<'X'
set -e
mount -t tmpfs none mnt
cp a.db small.yaml mnt
mount -o remount,ro mnt
try() {
    status=0
    "$MIMDSIM" "$@" >out 2>err </dev/null || status=$?
    echo "$status $* $(head -n 1 err)"
}
try run small.yaml -o mnt/new.db
try run small.yaml -o mnt/a.db
try merge mnt/a.db a.db
try merge mnt/new.db a.db
try claims mnt/a.db
try report a.db --dir mnt/figures
try query mnt/a.db 'SELECT count(*) FROM run'
X
    run -- unshare -rm bash inside.sh
    [ "$status" -eq 0 ] || { show; return 1; }
    [ "${#lines[@]}" -eq 7 ]
    for i in 0 1 2 3 4 5; do
        [[ ${lines[i]} == 73\ *': Read-only file system' ]] || { echo "${lines[i]}"; return 1; }
    done
    [ "${lines[6]}" = '0 query mnt/a.db SELECT count(*) FROM run ' ]
}

@test "verbs that compute first look before it at the places of their database and figures" {
    printf '%s\n' 'schema_version: 1' 'question: q' 'machine: t3e-300' 'kernel: dynamics' 'n: 4' 'ranks: 2' >small.yaml
    sed 's/^ranks:.*/ranks: [1, 2]/; $a answer: {of: ranks, least: makespan}' small.yaml >asked.yaml
    cp small.yaml file
    for words in 'accuracy small.yaml' 'stability small.yaml' 'explain small.yaml --measure' 'run asked.yaml' 'timeline small.yaml' \
        'load t3e-300' 'compare t3e-300 paragon --on small.yaml' 'interference neighbours'; do
        for place in '--dir file' '--dir file/x/y' '--dir=' '-o file/x.db'; do
            case $words$place in timeline*-o*) continue ;; esac
            # shellcheck disable=SC2086
            fails_with 73 mimdsim $words $place
            case $place in
            '--dir file') [ "$stderr" = 'mimdsim: file is not a folder' ] ;;
            '--dir=') [ "$stderr" = "mimdsim: cannot make folder '': it has no name" ] ;;
            '-o file/x.db') stderr_says 'cannot make database file/x.db: Not a directory' ;;
            *) [ "$stderr" = 'mimdsim: cannot make folder file/x/y: Not a directory' ] ;;
            esac || { echo "$words $place"; show; return 1; }
            # no row of a table, and no file
            [ -z "$output" ] || { echo "$words $place"; show; return 1; }
        done
    done
    [ ! -e mimdsim.db ] && [ ! -e figures ]
}

@test "a message of more packets than a level counts ends its run with both numbers" {
    # a schedule's messages have sizes and no bytes
    printf '%s\n' 'num_ranks 2' 'rank 0 {' 's: send 3221225472b to 1' '}' 'rank 1 {' 'r: recv 3221225472b from 0' '}' >big.goal
    for level in packet flit auto; do
        fails_with 1 mimdsim run big.goal -m t3e-300 -o a.db --quiet --set level=$level --set machine.network.packet='1 B'
        stderr_says "a message of 3221225472 bytes is of 3221225472 packets; level $level takes at most 2147483647"
    done
    sql_is a.db "SELECT count(*), group_concat(DISTINCT status) FROM run" '3|failed'
    # the level that counts no packets
    works mimdsim run big.goal -m t3e-300 -o a.db --quiet --set level=link --set machine.network.packet='1 B'
}

# many LINE...: a scenario of 1,000 runs and more, as many.yaml.
many() { printf '%s\n' 'schema_version: 1' "$@" >many.yaml; }

@test "of many runs not every rank is looked at before the first" {
    plain_build_only
    many 'machine: ideal' 'machine.topology: {family: torus, dims: [1048576]}' 'kernel: {name: allreduce, algorithm: hardware, message: 8 B}' \
        'machine.network.collective: {kinds: allreduce, operations: real, latency: 1 us, per_link: 1 us}' "ranks: [$(seq -s, 1000000 1002000)]"
    works timeout 600 "$MIMDSIM" explain many.yaml
    stdout_says 'collectives by the network of further runs: not looked at'
}

@test "lists that are a part of every run are counted before they fill the memory" {
    many 'machine: ideal' 'machine.topology.dims: [300000]' "machine.placement: {kind: list, list: [$(seq -s, 0 99999)]}" \
        'kernel: barrier' 'ranks: 4' "seed: [$(seq -s, 1 1000)]"
    fails_with 78 timeout 600 "$MIMDSIM" check many.yaml
    stderr_says 'many.yaml: the lists of all runs, and the jobs beside each, take more than 64 MiB of text'
}

# told COLUMN ARGUMENTS...: what explain tells in it of the largest run [B].
told() {
    local column=$1
    shift
    works mimdsim explain "$@" --json >&2 # stdout is the answer
    python3 -c 'import json, sys; print(round(max(r[sys.argv[1]] for r in json.load(sys.stdin)["runs"])))' "$column" <<<"$output"
}

# takes_as_told ARGUMENTS...: a run with them takes what explain tells, within a factor of 1.5.
takes_as_told() {
    local told used
    rm -f told.db
    told=$(told host_bytes "$@")
    works mimdsim run "$@" -o told.db --quiet
    used=$(sql told.db 'SELECT max(host_peak_bytes) FROM run')
    echo "$*: told $told B, used $used B"
    awk -v told="$told" -v used="$used" 'BEGIN { exit !(told < 1.5 * used && used < 1.5 * told) }'
}

@test "a run takes the memory that explain tells: ranks, bodies, and a network that is hardly used, or all of it" {
    sanitized && skip 'sanitizers take memory of their own'
    local level
    for level in loggp packet; do
        takes_as_told speedup-t3e --set n=1024 --set machine.topology.dims='[8, 16, 8]' --set level=$level
    done
    takes_as_told speedup-t3e --set n=8192 --set ranks=16 --set level=loggp
    takes_as_told speedup-t3e --set n=8192 --set ranks=1024 --set machine.topology.dims='[16, 8, 8]' --set kernel=inverse
    takes_as_told speedup-t3e --set n=256 --set level=link --set machine.topology.dims='[128, 128, 64]'
    takes_as_told speedup-t3e --set n=256 --set level=link --set machine.topology.dims='[128, 128, 64]' \
        --set machine.placement.kind=random
}

@test "explain tells what another attempt takes more: as much as asking for its refinement does" {
    local first more run=(speedup-t3e --set level=loggp --set n=8192 --set ranks=64)
    first=$(told host_bytes "${run[@]}") more=$(told host_bytes_again "${run[@]}")
    [ "$more" -gt 1000000 ]
    [ "$(told host_bytes "${run[@]}" --set kernel.inner_refinements=1)" -eq $((first + more)) ]
    # inverse dynamics solves nothing that could need it
    [ "$(told host_bytes_again "${run[@]}" --set kernel=inverse)" -eq 0 ]
    works mimdsim explain "${run[@]}"
    stdout_says 'if an answer needs refinement: 118 MB'
}

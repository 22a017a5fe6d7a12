#!/usr/bin/env bats
# answers.bats - what the program answers is complete and of one form: columns, keys, lists, and nothing left beside them.

load helper

@test "every swept key is a column, by the shortest name that is its own" {
    printf '%s\n' 'schema_version: 1' 'question: q' 'machine: t3e-300' 'kernel: dynamics' 'ranks: n' 'level: loggp' \
        'repetitions: 2' 'machine.noise.compute: 1 %' 'model: {joint: revolute}' 'sweep:' '  n: [4, 8]' '  model.seed: [1, 2]' '  seed: [7]' \
        '  machine.network.link.bandwidth: [480 MB/s, 960 MB/s]' '  machine.network.injection.bandwidth: [1 GB/s]' \
        '  variant: [{kernel.operators: dense}, {kernel.operators: structured}]' >sweep.yaml
    works mimdsim run sweep.yaml --quiet
    [ "${#lines[@]}" -eq 33 ]
    for column in ' n ' ' P ' ' seed ' ' model.seed ' ' link.bandwidth ' ' injection.bandwidth ' ' operators ' ' rep '; do
        [[ ${lines[0]} == *"$column"* ]] || { echo "no column$column"; show; return 1; }
    done
    works mimdsim run sweep.yaml --quiet --json
    json_is '$[0]."link.bandwidth"' '480 MB/s'
    json_is '$[31]."link.bandwidth"' '960 MB/s'
    json_is '$[31]."model.seed"' 2
    json_is '$[31].seed' 7
    json_is '$[31].operators' structured
    json_is '$[31].rep' 1
}

@test "bodies per processor and the size of messages are columns when they are swept" {
    works mimdsim run n-over-p --quiet --json --set ranks=2 --set level=loggp
    json_is '$[1].n_over_p' 2
    works mimdsim run pingpong --quiet --json --set kernel.message='8 B,64 KiB'
    json_is '$[1].message' '64 KiB'
}

@test "several values of --set are swept, with and without brackets, in the place of the scenario's" {
    works mimdsim run speedup-t3e --quiet --set n=4,8 --set level=link,loggp
    sql_is mimdsim.db "SELECT group_concat(level || n, ' ') FROM run" 'link4 link8 loggp4 loggp8'
    works mimdsim run speedup-t3e --quiet --set 'n=[4, 8]' --set level=loggp -o two.db
    sql_is two.db "SELECT group_concat(n, ' ') FROM run" '4 8'
    works mimdsim run speedup-t3e --quiet --json --set n=4 --set level=loggp -o three.db \
        --set 'machine.network.link.bandwidth=480 MB/s, 1 GB/s'
    json_is '$[1].bandwidth' '1 GB/s'
    works mimdsim run speedup-t3e --quiet --set n=4 --set level=loggp --set machine=t3e-300,paragon -o four.db
    sql_is four.db "SELECT group_concat(machine, ' ') FROM (SELECT machine FROM run ORDER BY id)" 't3e-300 paragon'
    works mimdsim run speedup-t3e --quiet --set n=4 --set level=loggp --set machine.topology.dims=4,4,2 -o five.db
    sql_is five.db "SELECT value FROM v_setting WHERE key = 'machine.topology.dims'" '[4, 4, 2]'
    works mimdsim run speedup-t3e --quiet --set n=4 --set level=loggp --set 'machine.topology.dims=[[4, 4], [8, 2]]' -o six.db
    sql_is six.db "SELECT group_concat(value, ' ') FROM v_setting WHERE key = 'machine.topology.dims'" '[4, 4] [8, 2]'
}

# keys_are_sorted: in every object of the document on stdout.
keys_are_sorted() {
    printf '%s' "$output" >document.json
    sql_is :memory: "SELECT count(*) FROM (SELECT t.key, lag(t.key) OVER (PARTITION BY t.parent ORDER BY t.id) AS before
        FROM json_tree(readfile('document.json')) t JOIN json_tree(readfile('document.json')) p ON p.id = t.parent
        WHERE p.type = 'object') WHERE key <= before" 0 || { echo "unsorted: $1"; return 1; }
}

@test "the keys of every JSON answer are sorted, and no key comes twice" {
    local net=$MIMDSIM_SRCDIR/tests/data/net/hand_cases.json vector
    vector=$MIMDSIM_SRCDIR/tests/data/vectors/closed_fourbar.json
    mimdsim run bisection --quiet --set level=link --set ranks=16 >/dev/null
    while read -r command; do
        eval "works mimdsim $command --json --quiet"
        json_is_valid
        keys_are_sorted "$command"
    done <<END
run speedup-t3e --set n=4,8 --set level=loggp
query mimdsim.db 'SELECT * FROM run r JOIN stage s ON s.run_id = r.id JOIN stage t ON t.run_id = r.id LIMIT 3'
query mimdsim.db 'SELECT 1 AS b, 2 AS a, 3 AS b'
links mimdsim.db
claims mimdsim.db
plot
plot mimdsim.db linkmap
explain speedup-t3e --set n=4
check $vector
machines
machines t3e-300
machines --compare t3e-300 aries
machines --compare t3e-300 paragon
scenarios
kernels
verify $vector
netcheck $net
validate t3e-300
accuracy speedup-t3e --set n=4 --set level=loggp
END
    works mimdsim query mimdsim.db 'SELECT 1 AS b, 2 AS a, 3 AS b' --json
    stdout_is '[{"a": 2, "b": 1, "b:1": 3}]'
    fails_with 66 mimdsim run none --json
    keys_are_sorted failure
}

@test "links of the network come before the ports of nodes, those that were waited for longest first" {
    works mimdsim run bisection --quiet --machine paragon --set ranks=256 --set level=link
    works mimdsim links mimdsim.db --json
    json_is '$[#-1].place' 10
    printf '%s' "$output" >links.json
    sql_is :memory: "SELECT count(*), sum(value ->> 'kind' = 'network'), max(iif(value ->> 'kind' = 'network', key, NULL)),
        min(iif(value ->> 'kind' <> 'network', key, NULL)) FROM json_each(readfile('links.json'))" '20|10|9|10'
    sql_is mimdsim.db "SELECT round(max(queue_ps) / 1e6, 3) = (SELECT round(value ->> 'queue_us', 3)
        FROM json_each(readfile('links.json')) LIMIT 1) FROM link_load WHERE from_router IS NOT NULL AND to_router IS NOT NULL" 1
}

@test "verbs that read leave nothing beside the database, and the database as it was" {
    works mimdsim run bisection --quiet --set level=link --set ranks=16
    works mimdsim run fig8 --quiet
    before=$(sha256sum mimdsim.db)
    works mimdsim query mimdsim.db 'SELECT count(*) FROM run'
    works mimdsim links mimdsim.db
    works mimdsim timeline mimdsim.db --format text
    works mimdsim plot mimdsim.db
    fails_with 66 mimdsim plot mimdsim.db fig5
    fails_with 65 mimdsim query mimdsim.db 'SELEKT'
    [ "$(ls)" = mimdsim.db ] || { ls; return 1; }
    [ "$(sha256sum mimdsim.db)" = "$before" ]
}

@test "a reader does not take the log away from a writer" {
    works mimdsim run speedup-t3e --quiet --set n=4 --set level=loggp
    mkfifo hold
    sqlite3 mimdsim.db <hold >held &
    exec 4>hold
    echo "BEGIN IMMEDIATE; UPDATE run SET text = 'mine'; SELECT 1;" >&4
    for _ in $(seq 100); do [ -s held ] && break; sleep 0.05; done
    works mimdsim query mimdsim.db 'SELECT text FROM run'
    [ -e mimdsim.db-wal ]
    echo 'COMMIT;' >&4
    exec 4>&-
    wait
    sql_is mimdsim.db 'SELECT text FROM run' mine
}

@test "plot without a figure lists what each shows and the command that makes its rows" {
    works mimdsim plot
    stdout_says "fig5           Figure 5: how the time of each stage is spent"
    stdout_says "needs: mimdsim paper fig5"
    listed=$(grep -c '^[a-z]' <<<"$output")
    [ "$listed" -eq "$(find "$MIMDSIM_DATA/plots" -name '*.gp' ! -name style.gp ! -name '_*' | wc -l)" ]
    [ "$(grep -c ' needs: mimdsim ' <<<"$output")" -eq "$listed" ]
    [ "$(awk '{ if (length($0) > n) n = length($0) } END { print n }' <<<"$output")" -le 130 ]
    stdout_says "fig9           Figure 9: speedup for up to 128 processors with n/P = 1, 2, 4, 8, 16, ... bodies per processor"
    grep '^[a-z]' <<<"$output" | LC_ALL=C sort -C -k 1,1
    works mimdsim plot --json
    json_is '$[3].name' fig5
    json_is '$[3].needs' 'mimdsim paper fig5'
}

@test "a long run tells how far it is, on a terminal alone, and ends as it does unseen" {
    command -v script >/dev/null || skip "no script(1) to give a terminal"
    local n=8192 line='; [0-9.]+ million events, [0-9.]+ million/s, [0-9]+ of [0-9]+ ranks ended'
    if sanitized; then n=2048; fi # slow enough
    printf '%s\n' 'schema_version: 1' 'question: q' 'machine: t3e-300' 'model: {generator: serial-chain, n: '$n'}' \
        'kernel: dynamics' 'ranks: n' 'level: link' 'machine.topology.dims: [32, 32, 16]' >long.yaml
    script -qec "'$MIMDSIM' run long.yaml -j 2 -o seen.db --set kernel.solver=pcr,cr" seen.log >/dev/null
    grep -qE "runs: (0 of 2|50 %.*left)$line" seen.log
    works mimdsim run long.yaml -j 1 -o unseen.db --set kernel.solver=pcr,cr
    [[ $stderr != *$'\r'* ]]
    sql_is seen.db 'SELECT group_concat(digest) FROM run' "$(sql unseen.db 'SELECT group_concat(digest) FROM run')"
    script -qec "'$MIMDSIM' run long.yaml -j 1 -o alone.db --set n=$((2 * n))" seen.log >/dev/null
    grep -qE "runs: 0 of 1$line" seen.log
}

@test "the SVG of a figure names each panel and axis once, as the PNG before it does" {
    works mimdsim paper fig9 --quiet
    [ "$(grep -c 'number of processors P' figures/fig9.svg)" -eq 2 ]
    [ "$(grep -c 'over the fastest serial code' figures/fig9.svg)" -eq 1 ]
}

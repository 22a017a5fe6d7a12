#!/usr/bin/env bats
# names.bats - what runs are called: a change has a name, and no changed machine goes by the name of the shipped one.

load helper

@test "without a name, a run is called after what differs from the shipped machine" {
    works mimdsim run fig6 --set n=16 --set level=loggp --set machine.network.hop_latency='60 us' -o a.db --quiet
    stdout_says 't3e-300, hop_latency 60 us'
    works mimdsim run fig6 --set n=16 --set level=loggp -o a.db --quiet
    sql_is a.db "SELECT DISTINCT machine, label FROM run ORDER BY label" 't3e-300|t3e-300
t3e-300|t3e-300, hop_latency 60 us'
    sql_is a.db 'SELECT count(DISTINCT machine_key) FROM run' 2
    sql_is a.db "SELECT DISTINCT number, unit FROM v_setting WHERE key = 'machine.network.hop_latency' AND value = '60 us'" \
        '6.0e-05|s'
}

@test "--name names the runs, also those that are stored already; a sweep of the machine is added to it" {
    works mimdsim run fig6 --set n=16 --set level=loggp --set machine.node.call='3 us' -o a.db --quiet
    works mimdsim run fig6 --set n=16 --set level=loggp --set machine.node.call='3 us' --name 'T3E, slow calls' -o a.db --quiet
    stdout_says 'T3E, slow calls '
    sql_is a.db 'SELECT DISTINCT label FROM run' 'T3E, slow calls'
    rows=$(sql a.db 'SELECT count(*) FROM run')
    # without a name a stored one stays
    works mimdsim run fig6 --set n=16 --set level=loggp --set machine.node.call='3 us' -o a.db --quiet
    sql_is a.db 'SELECT DISTINCT label FROM run' 'T3E, slow calls'
    sql_is a.db 'SELECT count(*) FROM run' "$rows"
    works mimdsim run fig6 --set n=16 --set level=loggp --set machine.node.call='3 us,4 us' --name calls -o a.db --quiet
    sql_is a.db 'SELECT DISTINCT label FROM run ORDER BY 1' 'calls, node.call 3 us
calls, node.call 4 us'
}

@test "two machines of one name are told apart in v_label" {
    for call in 3 4; do
        works mimdsim run fig6 --set n=16 --set level=loggp --set machine.node.call="$call us" --name mine -o a.db --quiet
    done
    sql_is a.db 'SELECT count(DISTINCT label), (SELECT count(DISTINCT name) FROM v_label) FROM run' '1|2'
    sql_is a.db "SELECT count(*) FROM v_label WHERE name <> 'mine [' || substr(machine_key, 1, 4) || ']'" 0
}

@test "machine and scenario files give names; a base's name is not inherited" {
    printf '%s\n' 'schema_version: 1' 'base: t3e-300' 'name: My fat tree' 'network: {link: {bandwidth: 960 MB/s}}' >my.yaml
    printf '%s\n' 'schema_version: 1' 'base: my' 'network: {hop_latency: 1 us}' >next.yaml
    works mimdsim run fig6 --set n=16 --set level=loggp -m my.yaml -o a.db --quiet
    works mimdsim run fig6 --set n=16 --set level=loggp -m my.yaml --set machine.software.gap='1 us' -o a.db --quiet
    works mimdsim run fig6 --set n=16 --set level=loggp -m next.yaml -o a.db --quiet
    sql_is a.db 'SELECT DISTINCT label FROM run ORDER BY 1' 'My fat tree
My fat tree, software.gap 1 us
next'
    printf '%s\n' 'schema_version: 1' 'question: which' 'machine: t3e-300' 'kernel: barrier' 'level: loggp' 'ranks: 8' \
        'sweep:' '  variant:' '  - {name: "as it is"}' '  - {name: "fast, wide", machine.network.link.bandwidth: 4 GB/s}' >variants.yaml
    works mimdsim run variants.yaml -o b.db --quiet
    sql_is b.db 'SELECT DISTINCT label FROM run ORDER BY id' 'as it is
fast, wide'
}

@test "names that cannot be names are refused" {
    fails_with 64 mimdsim run fig6 --name '' -o a.db
    fails_with 65 mimdsim run fig6 --name $'two\nlines' -o a.db
    stderr_says 'control characters are not allowed in a name'
    printf '%s\n' 'schema_version: 1' 'base: t3e-300' 'name: a' 'label: b' >my.yaml
    fails_with 65 mimdsim check my.yaml
    stderr_says "my.yaml:4: duplicate key 'label'; first given in line 3"
    printf '%s\n' 'schema_version: 1' 'question: which' 'machine: t3e-300' 'kernel: barrier' 'ranks: 8' 'name: [a, b]' >s.yaml
    fails_with 65 mimdsim check s.yaml
    stderr_says 's.yaml:6: name: names alone are no sweep'
    rm -f my.yaml s.yaml
    nothing_left_behind
}

@test "a figure names the changed machine that it shows, shows one alone, and says what it leaves out" {
    for latency in 60 6; do
        works mimdsim run fig6 --set n=8,16,32 --set level=loggp --set machine.network.hop_latency="$latency us" -o a.db --quiet
    done
    works mimdsim plot a.db fig6 --quiet
    grep -q 't3e-300, hop_latency 6 us; left out: 6 runs on t3e-300, hop_latency 60 us' figures/fig6.provenance
    grep -q 't3e-300‚ hop_latency 6 us' figures/fig6.csv
    [ "$(grep -c 'hop_latency 60' figures/fig6.csv)" = 0 ]
    works mimdsim run fig6 --set n=8,16,32 --set level=loggp -o a.db --quiet
    works mimdsim plot a.db fig6 --quiet
    grep -q 't3e-300; left out: 6 runs on t3e-300, hop_latency 6 us; 6 on t3e-300, hop_latency 60 us' figures/fig6.provenance
    # chosen by name
    works mimdsim plot a.db fig6 --where 'label=t3e-300, hop_latency 60 us' --quiet
    grep -q '; t3e-300, hop_latency 60 us$' figures/fig6.provenance
    # one machine as shipped and nothing else: nothing to say
    works mimdsim run fig6 --set n=8,16,32 --set level=loggp -o b.db --quiet
    works mimdsim plot b.db fig6 --quiet
    [ "$(grep -c 'left out' figures/fig6.provenance)" = 0 ]
}

@test "a setting that differs between runs is a column of view v_swept, in base units" {
    works mimdsim run speedup-t3e --set n=4 --set level=loggp -o s.db --quiet
    sql_is s.db "SELECT count(*) FROM sqlite_schema WHERE name = 'v_swept'" 0
    works mimdsim run speedup-t3e --set n=4,8 --set level=loggp --set machine.network.hop_latency='100 ns,3 us' -o s.db --quiet
    sql_is s.db "SELECT group_concat(hop_latency, ' ') FROM (SELECT DISTINCT hop_latency FROM v_swept ORDER BY 1)" '6.0e-08 1.0e-07 3.0e-06'
    sql_is s.db 'SELECT count(*), count(DISTINCT n), min(makespan_s) > 0 FROM v_swept' '5|2|1'
    # Another sweep, another column; words stay words, and what is there already is not doubled.
    works mimdsim run speedup-t3e --set n=4 --set level=loggp --set kernel.solver=cr,pcr --set machine.network.link.bandwidth='1 GB/s' -o s.db --quiet
    sql_is s.db "SELECT group_concat(DISTINCT solver) FROM v_swept WHERE link_bandwidth = 1e9" 'cr,pcr'
    sql_is s.db "SELECT count(*) FROM pragma_table_info('v_swept') WHERE name IN ('n', 'level', 'machine')" 3
    works mimdsim query s.db "SELECT hop_latency, makespan_s FROM v_swept"
    works mimdsim plot s.db --x hop_latency --y makespan_s
    # A view of the user's own of that name stays.
    sqlite3 s.db "DROP VIEW v_swept; CREATE VIEW v_swept AS SELECT 1 AS mine"
    works mimdsim run speedup-t3e --set n=16 --set level=loggp -o s.db --quiet
    sql_is s.db 'SELECT mine FROM v_swept' 1
}

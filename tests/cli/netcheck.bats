# netcheck.bats - reference files of networks: verdicts that can fail, lists that are played, files of strangers.
load helper

NET=$MIMDSIM_SRCDIR/tests/data/net
ATTACKS=$MIMDSIM_SRCDIR/tests/data/attacks

hand='"name": "a", "topology": "mesh1x8", "vcs": 1, "messages": [{"src": 0, "dst": 3, "flits": 18, "t": 0}]'

@test "numbers of strangers are refused with the value and what was expected, at once" {
    while read -r file text; do
        fails_with 65 timeout 300 "$MIMDSIM" netcheck "$ATTACKS/$file.json"
        stderr_says "$file.json:1: $text"
        stdout_is_empty
    done <<'END'
crossbig topology 'crossbar2147483647' has 2.147e+09 nodes
crossbits topology 'crossbar2147483647' has 2.147e+09 nodes
drag2 topology 'dragonfly1_2147483647_2147483647' has 9.904e+27 nodes
load1e8 load 1 for 900000000 cycles on 16 nodes is 1.44e+10 messages; expected at most
load1e300 'offered' is 1e+300; expected flits per node and cycle, above 0 and up to 1
shiftneg 'distance' must be an integer from 0 to
tornado0 pattern 'tornado0': 2 digits to the base 0 do not number 64 nodes
tornadodim pattern 'tornado2_2000000000': 2000000000 digits to the base 2 do not number 64 nodes
END
}

@test "further values out of range are refused" {
    while IFS='#' read -r text case; do
        echo "[$case]" >x.json
        fails_with 65 timeout 300 "$MIMDSIM" netcheck x.json
        stderr_says "$text"
    done <<END
'nodes' must be an integer#{"topology": "mesh4x4", "pattern": "shift", "distance": 1, "flits": 1, "nodes": -5}
'nodes' is 15; 'mesh4x4' has 16#{"topology": "mesh4x4", "pattern": "shift", "distance": 1, "flits": 1, "nodes": 15}
'vcs' must be an integer#{"topology": "mesh4x4", "vcs": 0, "pattern": "shift", "distance": 1, "flits": 1}
'vcs' must be an integer#{"topology": "mesh4x4", "vcs": 1000000000, "pattern": "shift", "distance": 1, "flits": 1}
'buf_flits_per_vc' must be an integer#{"topology": "mesh4x4", "buf_flits_per_vc": 1e9, "pattern": "shift", "distance": 1, "flits": 1}
'topology' must be a text#{"topology": 3, "pattern": "shift", "distance": 1, "flits": 1}
unknown topology 'mehs4x4'; did you mean 'mesh'?#{"topology": "mehs4x4", "pattern": "shift", "distance": 1, "flits": 1}
has 1.1e+12 nodes#{"topology": "hcube40", "pattern": "shift", "distance": 1, "flits": 1}
size 0; expected 1 or more#{"topology": "mesh0x4", "pattern": "shift", "distance": 1, "flits": 1}
unknown pattern 'spiral' of a step; expected shift, trunc or xor#{"topology": "mesh4x4", "pattern": "spiral", "distance": 1, "flits": 1}
message 0 goes from node 0 to node 16; the network has nodes 0 to 15#{"topology": "mesh4x4", "trace": {"src": [0], "dst": [16], "flits": [1]}}
'flits' of message 0 is 1e+300#{"topology": "mesh4x4", "trace": {"src": [0], "dst": [1], "flits": [1e300]}}
'dst' must be a list of 1 numbers#{"topology": "mesh4x4", "trace": {"src": [0], "dst": [1, 2], "flits": [1]}}
message 0 depends on '0'; expected another message#{"topology": "mesh4x4", "trace": {"src": [0], "dst": [1], "flits": [1], "deps": [[0]]}}
unknown key 'delays'; did you mean 'delay'?#{"topology": "mesh4x4", "trace": {"src": [0], "dst": [1], "flits": [1], "delays": [3]}}
unknown key 'weight' of a message#{"topology": "mesh4x4", "messages": [{"src": 0, "dst": 1, "flits": 1, "weight": 2}]}
'messages' is empty#{"topology": "mesh4x4", "messages": []}
'dst' is missing#{"topology": "mesh4x4", "messages": [{"src": 0, "flits": 1}]}
'points' must be a list of loads; it is empty#{"topology": "mesh4x4", "pattern": "uniform", "packet_flits": 4, "points": []}
unknown pattern 'unifrom'; did you mean 'uniform'?#{"topology": "mesh4x4", "pattern": "unifrom", "packet_flits": 4, "points": [{"offered": 0.1, "plat": 9, "cycles": 100}]}
'shift(16)': expected a distance below the 16 nodes#{"topology": "mesh4x4", "pattern": "shift(16)", "packet_flits": 4, "points": [{"offered": 0.1, "plat": 9, "cycles": 100}]}
pattern 'uniform(5)': 1 number; expected none, as in uniform#{"topology": "mesh4x4", "pattern": "uniform(5)", "packet_flits": 4, "points": [{"offered": 0.1, "plat": 9, "cycles": 100}]}
pattern 'shift(1,2)': 2 numbers; expected 1, as in shift(1)#{"topology": "mesh4x4", "pattern": "shift(1,2)", "packet_flits": 4, "points": [{"offered": 0.1, "plat": 9, "cycles": 100}]}
0 < saturation_low < saturation_high <= 1#{"topology": "mesh4x4", "pattern": "uniform", "packet_flits": 4, "saturation_low": 0.4, "saturation_high": 0.3}
END
}

@test "a file of no known form is refused, and the forms are named" {
    for text in '[{"a": 1}]' '{"a": 1}' '[{"topology": "mesh8x8"}]' '[3]'; do
        echo "$text" >other.json
        fails_with 65 mimdsim netcheck other.json
        stderr_says "other.json:1: a case of no known form; known are: step (distance), list (trace), hand (messages), load (points), saturation (saturation_low)"
    done
    printf 'a,b\n1,2\n' >other.csv
    fails_with 65 mimdsim netcheck other.csv
    stderr_says "other.csv:1: expected a list of reference cases"
}

@test "keys that are missing or misspelt are named" {
    sed 's/"completion"/"completoin"/' "$NET/makespan.json" >x.json
    fails_with 65 mimdsim netcheck x.json --quiet
    stderr_says "unknown key 'completoin'; did you mean 'completion'?"
    echo "[{$hand, \"expected_vct\": [31]}]" >x.json
    fails_with 65 mimdsim netcheck x.json --quiet
    stderr_says "x.json:1: 'booksim' is missing"
    echo "[{$hand, \"expected_vct\": [31], \"order_free\": false, \"booksim\": {\"16\": [31]}}, {$hand}]" >x.json
    fails_with 65 mimdsim netcheck x.json --quiet
    stderr_says "the case has no results, but earlier cases have some"
    echo "[{$hand}, {$hand, \"expected_vct\": [31], \"booksim\": {\"16\": [31]}}]" >x.json
    fails_with 65 mimdsim netcheck x.json --quiet
    stderr_says "the case has reference results, but earlier cases have none"
    sed '0,/"nlat"/s/"nlat": [0-9.]*,//' "$NET/latency_load.json" >x.json
    fails_with 65 mimdsim netcheck x.json --quiet
    stderr_says "'nlat' is given here, but is missing in earlier cases"
}

@test "an answer that is not the stated one is a failure with its case, in text and in JSON" {
    echo "[{$hand, \"expected_vct\": [31], \"order_free\": false, \"booksim\": {\"16\": [31]}}]" >right.json
    works mimdsim netcheck right.json --quiet
    sed 's/31/32/g' right.json >wrong.json
    fails_with 1 mimdsim netcheck wrong.json --quiet --level flit
    stdout_says "FAIL cut-through, flit: 1 of 1 cases; a cut-through B=64: error -3.125 %, stated are +0 to +0 %"
    fails_with 1 mimdsim netcheck right.json wrong.json --quiet --json
    json_is '$[0].verdict' pass
    json_is '$[1].verdict' FAIL
    json_is '$[1].totals[3].verdict' FAIL
    json_is '$[1].cases[0].levels.flit.verdict' FAIL
    works mimdsim netcheck wrong.json --quiet --within 4 --level flit
    fails_with 1 mimdsim netcheck wrong.json --quiet --within 3% --level flit
    fails_with 64 mimdsim netcheck wrong.json --within none
    stderr_says "--within: 'none' is not a percentage of 0 or more"
}

@test "a reference that contradicts itself fails whatever the levels say" {
    echo "[{$hand, \"expected_vct\": [20], \"order_free\": false, \"booksim\": {\"16\": [20]}}]" >x.json
    fails_with 1 mimdsim netcheck x.json --quiet --within 1000
    stdout_says "message 0 arrives at 20; an empty network takes until 31"
}

@test "lists without references are played, and their times are printed" {
    echo "[{$hand}]" >x.json
    works mimdsim netcheck x.json --quiet
    stdout_says "message 0: 0 -> 3, 18 flits"
    works mimdsim netcheck x.json --quiet --json
    json_is '$.cases[0].levels.flit.arrival[0]' 31
    json_is '$.cases[0].levels.link.found' 31
    json_is '$.cases[0].counted' 0
    echo '{"topology": "ring4", "trace": {"src": [0, 2], "dst": [2, 3], "flits": [4, 4], "deps": [[], [0]], "delay": [0, 5]}}' >x.json
    works mimdsim netcheck x.json --quiet --json
    json_is '$.cases[0].levels.packet.arrival[1]' 30
    echo '[{"topology": "mesh4x4", "pattern": "shift", "distance": 1, "flits": 3}]' >x.json
    works mimdsim netcheck x.json --quiet --brief --level link
    stdout_says "mesh4x4 shift(1) S=3"
}

@test "loads at saturation are found" {
    works mimdsim netcheck "$NET/saturation.json" --quiet --json --level flit
    json_is '$.totals[0].cases' 2
    json_is '$.verdict' pass
    sed 's/0.1477/0.1177/g; s/0.15\b/0.12/g' "$NET/saturation.json" | head -3 | sed '3s/,$/]/' >x.json
    fails_with 1 mimdsim netcheck x.json --quiet --level flit
}

@test "exclusive-or loads and dragonflies are judged; routing that is not ours is told" {
    works mimdsim netcheck "$NET/latency_load.json" --quiet --json --level link
    [ "$(printf '%s' "$output" | grep -o 'dragonfly vc=2 B=32' | wc -l)" -ge 10 ]
    point='"vcs": 1, "buf_flits_per_vc": 16, "points": [{"offered": 0.1, "plat": 25.6, "cycles": 8000}]'
    echo "[{\"topology\": \"mesh8x8\", \"pattern\": \"xor(63)\", \"packet_flits\": 4, $point}]" >x.json
    fails_with 1 mimdsim netcheck x.json --quiet --level flit
    sed -i 's/25.6/34.4/' x.json
    works mimdsim netcheck x.json --quiet --level flit
    stdout_says "xor(63)"
    echo "[{\"topology\": \"mesh8x8\", \"routing_function\": \"romm\", \"pattern\": \"uniform\", \"packet_flits\": 4, $point}]" >x.json
    fails_with 65 mimdsim netcheck x.json --quiet
    stderr_says "none of its cases (1) can be run; mesh8x8 uniform S=4 vc=1 B=16 load 0.1000: routing 'romm' on 'mesh8x8' is not supported"
}

@test "ties that the reference breaks by chance are broken by chance; its random routes are not ours" {
    works mimdsim netcheck "$NET/torus_ties.json" --quiet --json
    json_is '$.totals[3].level' flit
    json_is '$.totals[3].cases' 5
    json_is '$.cases[6].counted' 1
    json_is '$.cases[6].levels.flit.ran' 0
    json_is '$.cases[6].levels.flit.why' "routing 'valiant' on 'torus4x4x4' is not supported"
    sed 's/dim_order"/min"/; s/"pipeline"/"tie": 0, "pipeline"/' "$NET/torus_ties.json" >x.json # always up
    fails_with 1 mimdsim netcheck x.json --quiet --level flit
}

@test "the table of docs/network.md is the stated accuracy" {
    works mimdsim netcheck --stated
    printf '%s\n' "$output" >found
    sed -n '/^### What is stated/,/^### Every group/p' "$MIMDSIM_SRCDIR/docs/network.md" | grep '^|' | diff - found
    works mimdsim netcheck --stated --json
    json_is_valid
}

# routing.bats - routing rules of machines: what a person sets, series of a reference, mistakes.
load helper

series="$MIMDSIM_SRCDIR/tests/data/net/series.json"

@test "the levels packet and flit follow the reference's rules" {
    works mimdsim netcheck "$series" --quiet --level flit
    [[ "$output" == *"slimfly min"* && "$output" == *"mesh adaptive_xy_yx"* ]]
    [[ "$output" != *FAIL* ]]
    works mimdsim netcheck "$series" --quiet --level packet
}

@test "traffic goes on until the last packet of the sample is there, however long that takes" {
    works mimdsim netcheck "$MIMDSIM_SRCDIR/tests/data/net/overload.json" --quiet --level flit --within 1%
}

@test "a series whose answer is wrong fails" {
    sed 's/"plat_max": [0-9.]*/"plat_max": 99/; s/"plat_min": [0-9.]*/"plat_min": 90/; s/"plat": [0-9.]*/"plat": 95/' \
        "$series" > wrong.json
    cp "$MIMDSIM_SRCDIR/tests/data/net/slimfly_q5_p2.txt" .
    fails_with 1 mimdsim netcheck wrong.json --quiet --level flit
}

@test "bad series are refused with what was expected" {
    cp "$series" x.json
    sed 's/"sample_cycles": 2400/"sample_cycles": 0/' "$series" > x.json
    fails_with 65 mimdsim netcheck x.json --quiet
    [[ "$stderr" == *sample_cycles* ]]
    sed 's/"offered": 0.1,/"offered": 7,/' "$series" > x.json
    fails_with 65 mimdsim netcheck x.json --quiet --level flit
    [[ "$stderr" == *"'offered' is 7"* ]]
    sed 's/"xr": 2/"xr": 9/' "$series" > x.json
    fails_with 65 mimdsim netcheck x.json --quiet --level flit
    [[ "$stderr" == *"are no network"* ]]
    cp "$series" x.json
    echo "router 0 nods 1" > slimfly_q5_p2.txt
    fails_with 65 mimdsim netcheck x.json --quiet --level flit
    [[ "$stderr" == *"'nods'; expected 'router' or 'node'"* ]]
}

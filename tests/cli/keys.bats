#!/usr/bin/env bats
# keys.bats - the settings there are, and what becomes of those that are written wrongly.

load helper

@test "keys lists settings with unit, range, default and meaning, also as JSON" {
    works mimdsim keys hop_latency
    stdout_says 'machine.network.hop_latency'
    stdout_says "a time (12 us)"
    works mimdsim keys
    [ "$(printf '%s\n' "$output" | grep -c '^[a-z]')" -ge 100 ]
    works mimdsim keys network.hop_latency --json
    json_is_valid
    # the first names it in its meaning
    json_is '$[1].key' machine.network.hop_latency
    json_is '$[1].value' 'a time (12 us)'
    works mimdsim keys level --json
    json_is '$[0].default' link
    # a pattern is looked for in the meaning, too
    works mimdsim keys 'payload rate'
    stdout_says machine.network.link.bandwidth
    # a pattern as of files is for keys alone
    works mimdsim keys 'link*width'
    stdout_says machine.network.link.bandwidth
    [ "$(grep -c '^machine' <<<"$output")" -eq 1 ]
    fails_with 65 mimdsim keys 'payload*rate'
    fails_with 65 mimdsim keys hop_latancy
    stderr_says "did you mean"
    stdout_is_empty
}

@test "the end of a key is answered with the whole keys" {
    fails_with 65 mimdsim run fig6 --set bandwidth='1 GB/s' -o a.db
    stderr_says "unknown key 'bandwidth'; did you mean 'machine.node.copy.bandwidth' or 'machine.network.link.bandwidth'"
    stderr_says '(`mimdsim keys bandwidth`'

    fails_with 65 mimdsim run fig6 --set link.bandwidth='1 GB/s' -o a.db
    stderr_says "unknown key 'link.bandwidth'; did you mean 'machine.network.link.bandwidth'?"
    fails_with 65 mimdsim run fig6 --set hop_latency='1 us' -o a.db
    stderr_says "did you mean 'machine.network.hop_latency'?"
    fails_with 65 mimdsim run fig6 --set bandwdth='1 GB/s' -o a.db
    nothing_left_behind
}

@test "half a list, a value twice and an error of 200 % are refused" {
    fails_with 65 mimdsim run fig6 --set machine.topology.dims=8x4x4x -o a.db
    stderr_says 'a number is missing at the end'
    fails_with 65 mimdsim run fig6 --set machine.topology.dims='[8, 4, 4, ]' -o a.db
    fails_with 65 mimdsim run fig6 --set n='[4, 4]' -o a.db
    stderr_says "n: '4' stands twice in its list"
    fails_with 65 mimdsim run fig6 --set n=8,16,8 -o a.db
    fails_with 64 mimdsim accuracy four-bar --within 2
    stderr_says "did you mean '2%'?"
    nothing_left_behind
}

@test "the keys that the documentation of the network names exist" {
    mimdsim keys --json >keys.json
    missing= named=0
    # `send.overhead`, `machine.network.`: words with dots in backquotes that are no names of files
    for key in $(grep -o '`[a-z_]*\.[a-z_.]*`' "$MIMDSIM_SRCDIR/docs/network.md" | tr -d '`' |
        grep -v -e '\.json$' -e '\.[chf]$' -e '\.sql$' -e '\.yaml$' | sort -u); do
        named=$((named + 1))
        # a key, the end of one, or a group of keys
        grep -q -e "\"key\": \"\([a-z_.]*\.\)\?${key%.}[.\"]" keys.json || missing="$missing $key"
    done
    [ "$named" -ge 8 ]
    [ -z "$missing" ] || { echo "docs/network.md names keys that do not exist:$missing"; return 1; }
}

#!/bin/bash
# listed.sh - nothing lies about unused: every source is in its room's local.am, every test is run, every file of test data
# is told of in tests/data/README.md, by its own name or with its folder ("vectors/*.json").
. "$(dirname "$0")/house.bash"
cd "$HOUSE"
{
    sources '*.[chS]' src | while read -r file; do
        grep -q -F -w -- "$file" "$(dirname "$file")/local.am" || echo "$file: not in $(dirname "$file")/local.am"
    done
    find tests -name 'test_*.c' -o -name '*.bats' | sort | while read -r file; do
        grep -q -F -w -- "${file%.c}" "$(dirname "$file")/local.am" || echo "$file: not in $(dirname "$file")/local.am"
    done
    [ ! -d tests/data ] || find tests/data -type f ! -name README.md | sort | while read -r file; do
        name=${file#tests/data/}
        grep -q -s -F -e "$name" -e "${name%/*}/*" tests/data/README.md || echo "$file: not in tests/data/README.md"
    done
} | verdict

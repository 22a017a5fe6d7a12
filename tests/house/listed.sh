#!/bin/bash
# listed.sh - nothing lies about unused: every source is in its room's local.am, every test is run, every file of test data
# is told of in tests/data/README.md, by its own name or with its folder ("vectors/*.json").
. "$(dirname "$0")/house.bash"
cd "$HOUSE"
{
    { sources '*.[chS]' src; find tests -name 'test_*.c' -o -name '*.bats' | sort; } | awk '
    {
        list = name = $0
        sub(/[^\/]*$/, "local.am", list)
        if (!(list in seen)) {
            seen[list] = 1
            while ((getline line < list) > 0) {
                n = split(line, word, /[ \t\\]+/)
                for (i = 1; i <= n; i++) named[list, word[i]] = 1
            }
            close(list)
        }
        if (name ~ /^tests/) sub(/\.c$/, "", name)
        if (!((list, name) in named)) print $0 ": not in " list
    }'
    [ ! -d tests/data ] || find tests/data -type f ! -name README.md | sort | awk '
    BEGIN { while ((getline line < "tests/data/README.md") > 0) text = text line "\n" }
    {
        name = folder = substr($0, length("tests/data/") + 1)
        sub(/\/[^\/]*$/, "", folder)
        if (!index(text, name) && !index(text, folder "/*")) print $0 ": not in tests/data/README.md"
    }'
} | verdict

#!/bin/bash
# cycles.sh - no file calls another that, over whatever way, calls it back: circles of objects by their symbols.
. "$(dirname "$0")/house.bash"
read_archives
edges=$("${NM:-nm}" -A -P "${files[@]}" | awk '
{
    object = $1 # "lib.a[file.o]:" or "file.o:"
    sub(/^.*\//, "", object); sub(/:$/, "", object)
    if ($3 ~ /^[TDBRGSVWC]$/) home[$2] = object
    else if ($3 == "U") used[object, $2] = 1
    seen++
}
END {
    if (seen == 0) exit 1
    for (key in used) {
        split(key, part, SUBSEP)
        if (part[2] in home && home[part[2]] != part[1]) print part[1], home[part[2]]
    }
}' | sort -u)
printf '%s\n' "$edges" | { tsort 2>&1 >/dev/null || true; } | sed 's/^tsort: //; s/^-: input contains a loop:/a circle of files:/' | verdict

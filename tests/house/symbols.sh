#!/bin/bash
# symbols.sh - what the archives really use: symbols of rooms below alone, each defined once, and none of the calls that
# would make a result depend on the host or jump out of a run.
. "$(dirname "$0")/house.bash"
read_archives
table=$("${NM:-nm}" -A -g "${files[@]}" | awk -v list="$list" '
    BEGIN {
        n = split(list, line, "\n")
        for (i = 1; i <= n; i++) room_of[substr(line[i], index(line[i], " ") + 1)] = substr(line[i], 1, index(line[i], " ") - 1)
    }
    NF < 2 { next }
    { kind = $(NF - 1); name = $NF; room = room_of[substr($0, 1, index($0, ":") - 1)] }
    kind ~ /^[TDBRGSVC]$/ { print "defined", room, name }
    kind ~ /^[Uvw]$/ { print "used", room, name }')
[ -n "$table" ]
printf '%s\n' "$table" | sort -u | awk -v rooms="$ROOMS" '
BEGIN {
    while ((getline line < rooms) > 0) {
        if (line ~ /^#/) continue
        sub(/;.*/, "", line)
        n = split(line, word, " ")
        for (i = 1; i <= n; i++) may[word[1], word[i]] = 1
    }
    split("rand srand random srandom drand48 rand_r longjmp _longjmp siglongjmp __longjmp_chk strtok", name, " ")
    for (i in name) banned[name[i]] = "nobody"
    split("time gettimeofday clock clock_gettime localtime gmtime", name, " ")
    for (i in name) banned[name[i]] = "base store host"   # the host clock: progress, and when a row was written
}
$1 == "defined" {
    if ($3 in home && home[$3] != $2) print $3 " is defined by rooms " home[$3] " and " $2
    home[$3] = $2
}
$1 == "used" { used[$2, $3] = 1 }
END {
    for (key in used) {
        split(key, part, SUBSEP)
        room = part[1]; symbol = part[2]
        if (symbol in home && !((room, home[symbol]) in may)) print "room " room " uses " symbol " of room " home[symbol]
        if (symbol in banned && index(banned[symbol], room) == 0)
            print "room " room " calls " symbol ", which is for " banned[symbol]
    }
}' | sort | verdict

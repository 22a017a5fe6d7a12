#!/bin/bash
# includes.sh - a room includes only the rooms below it, by "room/file.h"; headers make no cycle; SQLite stays in store.
. "$(dirname "$0")/house.bash"
mapfile -t files < <(sources '*.[ch]' src)
[ "${#files[@]}" -gt 0 ]
cd "$HOUSE"
awk -v rooms="$ROOMS" '
function visit(f,   i, next_file) { # depth first; a header met again on its own path closes a cycle
    state[f] = 1
    for (i = 1; i <= nout[f]; i++) {
        next_file = out[f, i]
        if (state[next_file] == 1) print f ": includes " next_file ", which includes it (a cycle)"
        else if (!state[next_file]) visit(next_file)
    }
    state[f] = 2
}
BEGIN {
    while ((getline line < rooms) > 0) {
        if (line ~ /^#/) continue
        sub(/;.*/, "", line)
        n = split(line, word, " ")
        for (i = 2; i <= n; i++) {
            if (!(word[i] in known)) print rooms ": " word[1] " includes " word[i] ", which is not below it"
            may[word[1], word[i]] = 1
        }
        known[word[1]] = may[word[1], word[1]] = 1
    }
    foreign["sqlite3.h"] = "store"
}
FNR == 1 {
    file = substr(FILENAME, 5)
    room = file
    sub(/\/.*/, "", room)
    if (!(room in known)) print FILENAME ": room " room " is not in rooms.txt"
    exists[file] = 1
}
/^[ \t]*#[ \t]*include[ \t]*</ {
    name = $0
    gsub(/^[^<]*<|>.*$/, "", name)
    if (name in foreign && foreign[name] != room)
        print FILENAME ":" FNR ": <" name "> is the business of room " foreign[name]
}
/^[ \t]*#[ \t]*include[ \t]*"/ {
    split($0, quoted, "\"")
    name = quoted[2]
    if (name == "config.h") next
    if (name !~ /^[a-z]+\/[a-z0-9_]+\.[hc]$/) {
        print FILENAME ":" FNR ": \"" name "\" does not read \"room/file.h\""
        next
    }
    target = name
    sub(/\/.*/, "", target)
    if (!((room, target) in may)) print FILENAME ":" FNR ": room " room " may not include room " target
    wanted[name] = FILENAME ":" FNR
    if (file ~ /\.h$/) out[file, ++nout[file]] = name
}
END {
    exists["linalg/real_names.h"] # made by the build
    for (name in wanted) if (!(name in exists)) print wanted[name] ": " name " is not there"
    delete exists["linalg/real_names.h"]
    for (file in exists) if (!state[file]) visit(file)
}' "${files[@]}" | sort | verdict

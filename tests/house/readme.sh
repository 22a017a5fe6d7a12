#!/bin/bash
# readme.sh - src/README.md has a line for every file of every room: the file's own opening sentence. What stands above the
# first room is written by hand. `tests/house/readme.sh --write` brings it up to date.
. "$(dirname "$0")/house.bash"
cd "$HOUSE"

# sentence FILE: what the opening comment says after the dash, up to its first full stop.
sentence() {
    awk '
    { line = $0; sub(/^\/\* [^ ]+ - /, "", line); sub(/^ \* ?/, "", line); sub(/^-- /, "", line) }
    NR > 1 && (line == "" || /^[^ ]/) { exit }
    { text = text (text == "" ? "" : " ") line; if (/\*\//) exit }
    END { sub(/ *\*\/.*/, "", text); sub(/\. .*/, "", text); sub(/\.$/, "", text); print text }' "$1"
}

# room_files ROOM: its files, a .c beside the .h of its name, the header of the room's own name first.
room_files() {
    find "src/$1" -maxdepth 1 -type f \( -name '*.[chS]' -o -name '*.sql' \) ! -path src/store/schema.c \
        ! -path src/store/build_id.c | sed 's|.*/||' | sort | awk -v room="$1" '
        { file[NR] = $0; there[$0] = 1 }
        END {
            if ((room ".h") in there) one(room ".h")
            for (i = 1; i <= NR; i++) if (!(file[i] in done)) one(file[i])
        }
        function one(name,   twin) {
            twin = name
            if (sub(/\.c$/, ".h", twin) && twin in there) name = twin
            twin = name
            done[name] = 1
            if (sub(/\.h$/, ".c", twin) && twin in there) { done[twin] = 1; print name, twin } else print name
        }'
}

map() {
    local room header source purpose
    for room in $(room_names); do
        purpose=$(awk -v room="$room" '$1 == room { sub(/.*; */, ""); print }' "$ROOMS")
        printf '\n## %s: %s\n\n' "$room" "$purpose"
        room_files "$room" | while read -r header source; do
            echo "- \`$header\`${source:+ \`$source\`} - $(sentence "src/$room/$header")"
        done
    done
}

head_of_readme() { awk '/^## / { exit } { line[NR] = $0; n = NR } END { while (n && line[n] == "") n--; for (i = 1; i <= n; i++) print line[i] }' src/README.md; }

if [ "${1-}" = --write ]; then
    { head_of_readme; map; } >src/README.md.new
    mv src/README.md.new src/README.md
else
    { diff <(head_of_readme; map) src/README.md || [ $? -eq 1 ]; } |
        sed -n 's|^<|src/README.md lacks:|p; s|^>|src/README.md has:|p' | verdict
fi

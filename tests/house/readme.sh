#!/bin/bash
# readme.sh - src/README.md has a line for every file of every room: the file's own opening sentence. What stands above the
# first room is written by hand. `tests/house/readme.sh --write` brings it up to date.
. "$(dirname "$0")/house.bash"
cd "$HOUSE"

# map: of each room its purpose and its files, a .c beside the .h of its name, the header of the room's own name first; of
# each file what its opening comment says after the dash, up to its first full stop.
map() {
    local -a files
    mapfile -t files < <(find src -mindepth 2 -maxdepth 2 -type f \( -name '*.[chS]' -o -name '*.sql' \) ! -path src/store/schema.c \
        ! -path src/store/build_id.c | sort)
    awk -v rooms="$ROOMS" '
    FNR == 1 { opening = 1; split(FILENAME, part, "/"); file[part[2], ++count[part[2]]] = part[3]; there[part[2], part[3]] = 1 }
    !opening { next }
    { line = $0; sub(/^\/\* [^ ]+ - /, "", line); sub(/^ \* ?/, "", line); sub(/^-- /, "", line) }
    FNR > 1 && (line == "" || /^[^ ]/) { opening = 0; next }
    { text[FILENAME] = text[FILENAME] (text[FILENAME] == "" ? "" : " ") line; if (/\*\//) opening = 0 }
    END {
        while ((getline line < rooms) > 0) {
            if (line ~ /^#/) continue
            room = purpose = line
            sub(/ .*/, "", room); sub(/.*; */, "", purpose)
            printf "\n## %s: %s\n\n", room, purpose
            if ((room, room ".h") in there) one(room, room ".h")
            for (i = 1; i <= count[room]; i++) if (!((room, file[room, i]) in done)) one(room, file[room, i])
        }
    }
    function one(room, name,   twin, said) {
        twin = name
        if (sub(/\.c$/, ".h", twin) && (room, twin) in there) name = twin
        done[room, name] = 1
        said = text["src/" room "/" name]
        sub(/ *\*\/.*/, "", said); sub(/\. .*/, "", said); sub(/\.$/, "", said)
        twin = name
        if (sub(/\.h$/, ".c", twin) && (room, twin) in there) { done[room, twin] = 1; twin = " `" twin "`" } else twin = ""
        print "- `" name "`" twin " - " said
    }' "${files[@]}"
}

head_of_readme() { awk '/^## / { exit } { line[NR] = $0; n = NR } END { while (n && line[n] == "") n--; for (i = 1; i <= n; i++) print line[i] }' src/README.md; }

if [ "${1-}" = --write ]; then
    { head_of_readme; map; } >src/README.md.new
    mv src/README.md.new src/README.md
else
    { diff <(head_of_readme; map) src/README.md || [ $? -eq 1 ]; } |
        sed -n 's|^<|src/README.md lacks:|p; s|^>|src/README.md has:|p' | verdict
fi

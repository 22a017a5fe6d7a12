#!/bin/bash
# globals.sh - no writable data outside a run: nothing of ours lies in a section that stays writable. (Constant tables of
# pointers lie in .data.rel.ro, which is read-only once the program runs.) The one exception is the note of base/check.
. "$(dirname "$0")/house.bash"
list=$(archives)
[ -n "$list" ]
printf '%s\n' "$list" | while read -r room file; do
    "${OBJDUMP:-objdump}" -t "$file" | awk -v room="$room" '
        / file format / { object = $1; sub(/:$/, "", object) }
        split($0, half, "\t") != 2 { next }
        { # address, flags, section, tab, size, name
            n = split(half[1], word, " "); section = word[n]
            split(half[2], word, " "); size = word[1]; name = word[2]
        }
        section ~ /^\.data\.rel\.ro/ || size ~ /^0+$/ { next }
        section ~ /^(\.data|\.bss|\.tdata|\.tbss|\*COM\*)/ {
            if (room == "base" && object ~ /check\.o$/ && name ~ /^check_note(\.[0-9]+)?$/) next  # clang splits it
            print "room " room ", " object ": " name " is writable (" section ")"
        }'
done | verdict

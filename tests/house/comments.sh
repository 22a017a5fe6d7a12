#!/bin/bash
# comments.sh - in each room listed here, comments stand on at least 15 % of the lines of the .c files, blank lines not
# counted. `tests/house/comments.sh --shares` prints the share of every room and of every file below 15 %.
. "$(dirname "$0")/house.bash"
least=15
commented='lab sim kernel net report study spec store machine comm base linalg measure plan run app io model dynamics mpi vp schedule guest hosts loader compile program host'
cd "$HOUSE"

# shares ROOM: "FILE LINES-WITH-COMMENT LINES" of each file of a room. Strings may hold what looks like a comment.
shares() {
    mapfile -t files < <(sources '*.c' "src/$1")
    awk '
    FNR == 1 { inside = 0 }
    {
        line = $0
        gsub(/\\./, "", line)          # escapes
        gsub(/\047"\047/, "", line)    # the character constant of a quote
        carries = inside; string = 0
        if (line !~ /[^ \t]/ && !inside) next
        for (i = 1; i <= length(line); i++) {
            c = substr(line, i, 1); pair = substr(line, i, 2)
            if (inside) { if (pair == "*/") { inside = 0; i++ } }
            else if (string) { if (c == "\"") string = 0 }
            else if (pair == "/*") { inside = carries = 1; i++ }
            else if (pair == "//") { carries = 1; break }
            else if (c == "\"") string = 1
        }
        lines[FILENAME]++
        comments[FILENAME] += carries
    }
    END { for (file in lines) print file, comments[file], lines[file] }' "${files[@]}" | sort
}

if [ "${1-}" = --shares ]; then
    for room in $(room_names); do
        compgen -G "src/$room/*.c" >/dev/null || continue
        shares "$room" | awk -v room="$room" -v least="$least" '
            { comments += $2; lines += $3; if (100 * $2 < least * $3) low = low sprintf("    %4.1f %%  %s\n", 100 * $2 / $3, $1) }
            END { printf "%-10s %4.1f %%  %d of %d lines\n%s", room, 100 * comments / lines, comments, lines, low }'
    done
    exit
fi
for room in $commented; do
    shares "$room" | awk -v room="$room" -v least="$least" '
        { comments += $2; lines += $3 }
        END {
            if (lines == 0) print "src/" room ": no line was found"
            else if (100 * comments < least * lines)
                printf "src/%s: %.1f %% of %d lines carry comments, less than %d %%\n", room, 100 * comments / lines, lines, least
        }'
done | verdict

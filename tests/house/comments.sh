#!/bin/bash
# comments.sh - in each room listed here, comments stand on at least 15 % of the lines of the .c files, blank lines not
# counted. `tests/house/comments.sh --shares` prints the share of every room and of every file below 15 %.
. "$(dirname "$0")/house.bash"
least=15
commented='lab sim kernel net report study spec store machine comm base linalg measure plan run app io model dynamics mpi vp schedule guest hosts loader compile program host'
cd "$HOUSE"

# shares: "ROOM FILE LINES-WITH-COMMENT LINES" of each file. Strings may hold what looks like a comment.
shares() {
    local -a files
    mapfile -t files < <(sources '*.c' src)
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
    END { for (file in lines) { split(file, part, "/"); print part[2], file, comments[file], lines[file] } }' "${files[@]}" | sort
}

if [ "${1-}" = --shares ]; then
    shares | awk -v rooms="$(room_names | tr '\n' ' ')" -v least="$least" '
        { comments[$1] += $3; lines[$1] += $4; if (100 * $3 < least * $4) low[$1] = low[$1] sprintf("    %4.1f %%  %s\n", 100 * $3 / $4, $2) }
        END {
            n = split(rooms, name, " ")
            for (i = 1; i <= n; i++) if ((room = name[i]) in lines)
                printf "%-10s %4.1f %%  %d of %d lines\n%s", room, 100 * comments[room] / lines[room], comments[room], lines[room], low[room]
        }'
    exit
fi
shares | awk -v commented="$commented" -v least="$least" '
    { comments[$1] += $3; lines[$1] += $4 }
    END {
        n = split(commented, room, " ")
        for (i = 1; i <= n; i++) {
            r = room[i]
            if (lines[r] == 0) print "src/" r ": no line was found"
            else if (100 * comments[r] < least * lines[r])
                printf "src/%s: %.1f %% of %d lines carry comments, less than %d %%\n", r, 100 * comments[r] / lines[r], lines[r], least
        }
    }' | verdict

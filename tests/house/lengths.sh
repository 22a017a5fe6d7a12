#!/bin/bash
# lengths.sh - functions fit on a screen: over 60 lines only under a comment "long: why"; in src half of them within 15
# lines and nine of ten within 40. Files within 540 lines, headers 170, lines 100 columns without tabs.
# `tests/house/lengths.sh --wrap` lets clang-format break the lines that are too long, and touches no others.
. "$(dirname "$0")/house.bash"
mapfile -t files < <(sources '*.[ch]' src tests; [ -z "$(find "$HOUSE/bench" -name '*.c' 2>/dev/null)" ] || sources '*.c' bench)
[ "${#files[@]}" -gt 0 ]
cd "$HOUSE"
if [ "${1-}" = --wrap ]; then # from the last line of a file to its first, so that the numbers stay true
    bash "$HERE/lengths.sh" | awk -F: '/columns$/ { print $1, $2 }' | sort -k1,1 -k2,2nr |
        while read -r file line; do clang-format -i --style=file --lines="$line:$line" "$file"; done
    exit
fi
awk '
function ended(length_) {
    if (FILENAME ~ /^src\//) { count[length_]++; total++ }
    if (length_ > 60 && !excused) print FILENAME ":" start ": function of " length_ " lines"
    start = 0; excused = 0
}
function file_ended() {
    limit = file ~ /\.h$/ ? 170 : 540
    if (lines > limit) print file ": " lines " lines, more than " limit
}
FNR == 1 { if (file) file_ended(); file = FILENAME; start = body = inside = excused = 0 }
{ lines = FNR; columns = $0; gsub(/[\200-\277]/, "", columns) }
length(columns) > 100 { print FILENAME ":" FNR ": " length(columns) " columns" }
/\t/ { print FILENAME ":" FNR ": a tab" }
body { if (/^}/) { body = 0; ended(FNR - start + 1) } next }
inside || /^\/\*/ { if (/long: /) excused = 1; inside = !/\*\//; start = 0; next }
/^[ \t]*$/ || /^#/ { start = 0; excused = /^#/ && excused; next }
/^[^ \t].*\).*\{.*\}$/ && !/=/ { start = FNR; ended(1); next }
/^\{/ || /^[a-zA-Z_].*\) *\{$/ { if (!start) start = FNR; body = 1; next }
{ if (!start) start = FNR; if (/[;}]$/) start = 0 }
END {
    file_ended()
    if (total == 0) print "no function was found"
    for (n = 1; n <= 15; n++) short += count[n]
    for (n = 1; n <= 40; n++) fitting += count[n]
    if (short < 0.5 * total) print "only " short " of " total " functions in src are within 15 lines"
    if (fitting < 0.9 * total) print "only " fitting " of " total " functions in src are within 40 lines"
}' "${files[@]}" | verdict

#!/bin/sh
# solve.sh - for teachers: put the solution into the folder of an attempt: solve.sh FOLDER
#
# NAME.gap holds the lines that stand in the place of the comment "GAP: ..." of the program NAME.c, or of all lines from
# it to "End of the gap." where there is such a line. A second gap has its lines in NAME-2.gap.
set -eu
here=$(dirname "$0")
program=$(sed -n 's/^program: //p' "$1/answers.yaml")
awk -v gap="$here/${program%.c}" '
    NR == FNR { if (/End of the gap/) to_end = 1; next }
    /\/\* GAP:/ {
        file = gap (++gaps > 1 ? "-" gaps : "") ".gap"
        while ((getline line <file) > 0) print line
        skip = 1
    }
    !skip { print }
    skip && (to_end ? /End of the gap/ : /\*\//) { skip = 0 }' "$1/$program" "$1/$program" >"$1/solved.c"
mv "$1/solved.c" "$1/$program"

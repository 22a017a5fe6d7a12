#!/bin/bash
# words.sh - committed files hold no promises left open and no paths of one computer.
. "$(dirname "$0")/house.bash"
cd "$HOUSE"
words='TO''DO|FIX''ME'  # in two pieces, so that this file passes
paths='(^|[^[:alnum:]_./-])/(wo''rk|t''mp|ho''me|ro''ot)(/|$|[^[:alnum:]_])'
list() {
    if git -C . rev-parse --show-toplevel 2>/dev/null | grep -q -x -F "$(pwd -P)"; then git ls-files
    else
        find . -type f \( -path './src/*' -o -path './tests/*' -o -path './bench/*' -o -path './machines/*' -o -path './models/*' \
            -o -path './scenarios/*' -o -path './plots/*' -o -path './docs/*' -o -path './.ci/*' -o -name '*.md' -o -name '*.ac' \
            -o -name '*.am' -o -path ./bootstrap \) ! -name '*.o' ! -name '*.log' ! -name '*.trs' ! -path '*/.deps/*' ! -path './build*'
    fi
}
files=$(list)
[ -n "$files" ]
printf '%s\n' "$files" | while read -r file; do
    [ ! -f "$file" ] || grep -H -n -I -E -e "$words" -e "$paths" -- "$file" || [ $? -eq 1 ]
done | verdict

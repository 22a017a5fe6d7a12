#!/bin/bash
# words.sh - committed files hold no promises left open and no paths of one computer; texts for people use no private words.
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
# Private words: what a text for people (documents, plots, scenarios, strings of the program) must not say, each with the
# standard term beside it in docs: most expensive, compare with, does not exist, cache, undone, per processor, omissions.
private='dea''rest|hold[s]? (it|them) ag''ainst|he''ld against|to hold .* ag''ainst|is not there aft''er|put ba''ck|des''erves? a database'
private="$private|what-if des""erves|not among o""urs|bodies a proc""essor|own step""pers|would make the paper tr""ue|good eno""ugh; the finest"
# looked ARGUMENT...: what grep finds in the files named on standard input, all by one process. Fails where it cannot look.
looked() {
    local -a file
    mapfile -t file
    [ ${#file[@]} -eq 0 ] || grep -H -n -I -E "$@" -- "${file[@]}" || [ $? -eq 1 ]
}
there() { while read -r file; do [ ! -f "$file" ] || printf '%s\n' "$file"; done; }
{
    printf '%s\n' "$files" | there | looked -e "$words" -e "$paths"
    printf '%s\n' "$files" | sed -n -E '\,^(\./)?(README\.md|(docs|plots|scenarios)/.*)$,p' | there | looked -i -e "$private"
    # strings only
    printf '%s\n' "$files" | sed -n -E '\,^(\./)?src/.*\.c$,p' | there | looked -i -e "\"[^\"]*($private)"
} | verdict

#!/bin/bash
# documented.sh - every prototype and inline function of a header has a comment: above it, above the unbroken group that
# it stands in, or on its line. Every source file opens with its name and a sentence.
. "$(dirname "$0")/house.bash"
mapfile -t headers < <(sources '*.h' src)
mapfile -t files < <(sources '*.[ch]' src tests)
[ "${#headers[@]}" -gt 0 ] && [ "${#files[@]}" -gt 0 ]
cd "$HOUSE"
{
    awk '
    FNR == 1 {
        stem = FILENAME
        sub(/.*\//, "", stem)
        if (index($0, "/* " stem " - ") != 1) print FILENAME ":1: does not open with \"/* " stem " - ...\""
        nextfile
    }' "${files[@]}"
    awk '
    FNR == 1 { covered = inside = depth = macro = 0; text = "" }
    macro || /^[ \t]*#/ { macro = /\\$/; next }
    /^[ \t]*$/ { if (!inside) covered = 0; next }
    {
        line = $0; told = 0; code = ""
        while (line != "") { # take the comments out
            if (inside) {
                told = 1
                if ((i = index(line, "*/")) == 0) break
                line = substr(line, i + 2); inside = 0
            } else if ((i = index(line, "/*")) > 0) {
                code = code substr(line, 1, i - 1); line = substr(line, i + 2); inside = 1; told = 1
            } else { code = code line; break }
        }
        if (told) covered = 1
        if (text == "") first = FNR
        for (i = 1; i <= length(code); i++) { # statements at file scope, bodies left out
            c = substr(code, i, 1)
            if (depth == 0) text = text c
            if (c == "{" && depth++ == 0) finish()
            if (c == "}" && --depth == 0) text = ""
            if (c == ";" && depth == 0) finish()
        }
        if (text !~ /[^ \t]/) text = ""
        else text = text " "
    }
    function finish() {
        sub(/^[ \t]+/, "", text)
        if (text !~ /^typedef / && text ~ /^[a-z_][A-Za-z0-9_ *]*[ *][a-z_][a-z0-9_]*\(/ && !covered)
            print FILENAME ":" first ": not documented: " text
        text = ""
    }' "${headers[@]}"
} | verdict

#!/bin/bash
# sizes.sh - no size of an array is a bare product: what wraps in an int becomes a small array (base/size.h).
. "$(dirname "$0")/house.bash"
mapfile -t files < <(cd "$HOUSE" && sources '*.c' src && sources '*.h' src)
cd "$HOUSE"
awk '
# The second argument of each TAKE of the line, and of what follows it.
{
    rest = $0
    while ((k = index(rest, "TAKE(")) > 0) {
        rest = substr(rest, k + 5); depth = 1; argument = 1; size = ""
        for (i = 1; depth > 0 && i <= length(rest); i++) {
            c = substr(rest, i, 1)
            if (c == "(" || c == "[") depth++
            if (c == ")" || c == "]") depth--
            if (c == "," && depth == 1) argument++
            else if (argument == 2) size = size c
        }
        if (index(size, " * ") > 0) print FILENAME ":" FNR ": TAKE of" size ": a bare product; size_product checks it"
    }
}
# The allocators of C: a product there is of bytes, in size_t.
/(^|[^a-z_])(malloc|realloc|arena_take)\(.*[^(] \* / && !/\(size_t\)|size_product|size_t|sizeof/ {
    print FILENAME ":" FNR ": a bare product of bytes"
}' "${files[@]}" | verdict

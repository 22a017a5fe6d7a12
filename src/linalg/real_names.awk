# real_names.awk - the public names of files that are compiled for several precisions and spaces, each with its suffix:
# a "#define name REAL_NAME(name)" for every function or table that a header declares and does not define.
#
#     awk -f real_names.awk kind=REAL HEADER... kind=SPACE HEADER... >real_names.h
BEGIN { print "/* Made by src/linalg/real_names.awk: the names that carry a precision (real.h) or a space, too (space.h). */" }
FNR == 1 { depth = inside = 0; text = "" }
/^[ \t]*#/ { next }
{
    line = $0; code = ""
    while (line != "") { # take the comments out
        if (inside) {
            if ((i = index(line, "*/")) == 0) break
            line = substr(line, i + 2); inside = 0
        } else if ((i = index(line, "/*")) > 0) {
            code = code substr(line, 1, i - 1); line = substr(line, i + 2); inside = 1
        } else { code = code line; break }
    }
    for (i = 1; i <= length(code); i++) { # one statement of file scope after the other, bodies left out
        c = substr(code, i, 1)
        if (c == "{") { depth++; if (depth == 1 && text ~ /^[ \t]*static /) body = 1; continue }
        if (c == "}") { depth--; if (depth == 0 && body) { text = ""; body = 0 } continue }
        if (depth > 0) continue
        if (c == ";") { finish(); text = ""; continue }
        text = text c
    }
    if (text !~ /[^ \t]/) text = ""
    else text = text " "
}
function finish(    name) {
    sub(/^[ \t]+/, "", text)
    if (text ~ /^(static|typedef) /) return
    if (text ~ /^extern /) { name = text; sub(/[ \t]+$/, "", name); sub(/.*[ *]/, "", name) }
    else if (match(text, /[a-z_][A-Za-z0-9_]*\(/) && text !~ /=/) name = substr(text, RSTART, RLENGTH - 1)
    else return
    if (name in seen) { # the bodies of space and of planar scenes have their functions' names in common
        if (seen[name] == kind) return
        printf "real_names.awk: %s carries two kinds of suffix\n", name >"/dev/stderr"
        exit 1
    }
    seen[name] = kind
    print "#define " name " " kind "_NAME(" name ")"
}

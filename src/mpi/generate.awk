# generate.awk - prototypes, the table of functions, the guests' stubs and the list for people, all out of functions.txt.
#
#   awk -v want=WHAT -f generate.awk functions.txt
#
#   prototypes   include/mimdsim/mpi_functions.h: what programs call
#   table        include/mimdsim/mpi_table.h: what the stubs call through, and the simulator's side of it
#   rows         the table's contents, linked into the simulator
#   stubs        the functions that are linked into programs of C and C++
#   fortran      those that Fortran calls
#   list         docs/mpi.md: every function with its state

BEGIN {
    reason["io"] = "MPI-IO: simulated machines have no files in parallel"
    reason["dynamic"] = "dynamic processes: the number of ranks of a run is fixed"
    reason["session"] = "sessions: a run has one world, begun by MPI_Init"
    reason["partitioned"] = "partitioned communication is for threads, and a rank is one thread"
    reason["tool"] = "the tools' interface: the simulator records more than it could tell"
    reason["external"] = "external32: all ranks of a machine write numbers the same way"
    reason["none"] = "not there"
    handles = "comm MPI_Comm group MPI_Group type MPI_Datatype op MPI_Op request MPI_Request info MPI_Info " \
              "errhandler MPI_Errhandler win MPI_Win file MPI_File message MPI_Message session MPI_Session"
    n = split(handles, word, " ")
    for (i = 1; i <= n; i += 2) handle[word[i]] = word[i + 1]
    plain["in"] = "const void *"; plain["out"] = "void *"; plain["n"] = "int "; plain["N"] = "int *"
    plain["n0"] = "int "; plain["i"] = "int "; plain["I"] = "int *"; plain["l"] = "int "; plain["L"] = "int *"
    plain["x"] = "MPI_Aint "; plain["X"] = "MPI_Aint *"; plain["a"] = "MPI_Aint "; plain["A"] = "MPI_Aint *"
    plain["C"] = "MPI_Count "; plain["CC"] = "MPI_Count *"; plain["o"] = "MPI_Offset "; plain["O"] = "MPI_Offset *"
    plain["s"] = "const char *"; plain["S"] = "char *"; plain["p"] = "void *"; plain["status"] = "MPI_Status *"
    plain["cstatus"] = "const MPI_Status *"; plain["statuses"] = "MPI_Status *"
    array["n"] = array["d"] = array["i"] = array["l"] = array["w"] = "const int "
    array["I"] = array["L"] = "int "; array["x"] = array["a"] = "const MPI_Aint "
    opening()
}

/^## / { chapter = substr($0, 4); if (want == "list") heading(); next }
/^#/ || /^[ \t]*$/ { next }
{ row($0) }
END { closing() }

function trimmed(s) { sub(/^[ \t]+/, "", s); sub(/[ \t]+$/, "", s); return s }
function lower_first(s) { return tolower(substr(s, 1, 1)) substr(s, 2) }

# A line into name, state, early, has[], np, kind[], len[], arr[], par[], result.
function row(line,   field, n, i, k, rest, one) {
    n = split(line, field, "|")
    name = trimmed(field[1]); state = trimmed(field[2])
    early = sub(/!$/, "", state)
    split("", has)
    k = split(field[3], one, " ")
    for (i = 1; i <= k; i++) has[one[i]] = 1
    rest = trimmed(field[4]); result = "int"
    if (has["double"]) result = "double"
    if (match(rest, / *: /)) { result = trimmed(substr(rest, RSTART + RLENGTH)); rest = substr(rest, 1, RSTART - 1) }
    parameters(rest)
    works = state ~ /^[123]$/
    emit(name, "", 0)
    if (has["c"]) emit(name "_c", "", 1)
    if (has["I"]) emit("I" lower_first(name), "I", 0)
    if (has["I"] && has["c"]) emit("I" lower_first(name) "_c", "I", 1)
    if (has["init"] || has["start"]) emit(name "_init", has["init"] ? "init" : "start", 0)
    if ((has["init"] || has["start"]) && has["c"]) emit(name "_init_c", has["init"] ? "init" : "start", 1)
    if (want == "table" || want == "rows") table_row()
}

function parameters(rest,   n, i, one, piece) {
    np = 0
    n = split(rest, one, ",")
    for (i = 1; i <= n; i++) {
        piece = trimmed(one[i])
        if (piece == "") continue
        np++
        arr[np] = len[np] = ""
        if (piece ~ /^\{/) {
            kind[np] = substr(piece, 1, index(piece, "}"))
            par[np] = trimmed(substr(piece, index(piece, "}") + 1))
            continue
        }
        kind[np] = piece; sub(/ .*/, "", kind[np])
        par[np] = piece; sub(/^[^ ]+ +/, "", par[np])
        if (match(kind[np], /\[.*\]$/)) {
            arr[np] = 1
            len[np] = substr(kind[np], RSTART + 1, RLENGTH - 2)
            kind[np] = substr(kind[np], 1, RSTART - 1)
        }
    }
}

# declared: parameter i as a program's prototype has it.
function declared(i, large,   k, base) {
    k = kind[i]
    if (k == "{...}") return "..."
    if (k ~ /^\{/) {
        k = substr(k, 2, length(k) - 2)
        sub(/@/, large ? "_c" : "", k)
        return k (k ~ /\*$/ ? "" : " ") par[i]
    }
    if (k == "w") return "const int *" par[i] # a pointer: the sign for no weights is no array
    base = k; sub(/\*$/, "", base)
    if (base in handle) {
        if (arr[i]) return (k == base ? "const " : "") handle[base] " " par[i] "[]"
        return handle[base] (k == base ? " " : " *") par[i]
    }
    if (arr[i]) {
        if (large && (k == "n" || k == "x")) return "const MPI_Count " par[i] "[]"
        if (large && k == "d") return "const MPI_Aint " par[i] "[]"
        return array[k] par[i] "[]"
    }
    if (large && (k == "n" || k == "x")) return "MPI_Count " par[i]
    if (large && (k == "N" || k == "X")) return "MPI_Count *" par[i]
    return plain[k] par[i]
}

# hosted: parameter i as the simulator's function has it; passed: what a stub hands over for it.
function hosted(i,   k) {
    k = kind[i]
    if (arr[i] && (k == "n" || k == "d")) return "struct mpi_counts " par[i]
    if (k == "n" || k == "N" || k == "x" || k == "X") return declared(i, 1)
    return declared(i, 0)
}
function passed(i, large,   k) {
    k = kind[i]
    if (arr[i] && (k == "n" || k == "d")) return "(struct mpi_counts){" par[i] ", " large "}"
    if (k == "N" && !large) return "&" par[i] "_"
    return par[i]
}

function list_of(variant, large,   s, i) {
    s = ""
    for (i = 1; i <= np; i++) s = s (i > 1 ? ", " : "") declared(i, large)
    if (variant == "init") s = s ", MPI_Info info"
    if (variant != "") s = s ", MPI_Request *request"
    return s == "" ? "void" : s
}

function emit(full, variant, large) {
    if (want == "prototypes") {
        line_broken(result " MPI_" full "(", list_of(variant, large) ");")
        line_broken(result " PMPI_" full "(", list_of(variant, large) ");")
    }
    if (want == "stubs" && !has["guest"]) stub(full, variant, large)
    if (want == "fortran" && !large && !has["none"] && !has["own"] && name != "Aint_add" && name != "Aint_diff" &&
        name !~ /(from|to)int$/) fortran_stub(full, variant)
    if (want == "list") listed(full, variant, large)
}

# line_broken: a declaration in lines of at most 100 columns.
function line_broken(head, rest,   out, one, n, i, column) {
    n = split(rest, one, ", ")
    out = head; column = length(head)
    for (i = 1; i <= n; i++) {
        if (i > 1 && column + length(one[i]) + 2 > 98) { out = out "\n    "; column = 4 }
        out = out one[i] (i < n ? ", " : ""); column += length(one[i]) + 2
    }
    gsub(/ \n/, "\n", out)
    print out
}

# --- the table ---

function table_row(   s, i, low) {
    if (!works || has["guest"]) return
    low = tolower(name)
    if (want == "rows") { print "    ." low " = mpi_" low ","; return }
    s = "struct mpi_rank *self"
    if (has["I"] || has["start"]) s = s ", struct mpi_start start"
    for (i = 1; i <= np; i++) if (kind[i] != "{...}") s = s ", " hosted(i)
    line_broken("    " result " (*" low ")(", s ");")
    hosts = hosts result " mpi_" low "(" s ");\n"
}

# --- stubs of C ---

function stub(full, variant, large,   i, s, narrow) {
    print ""
    print "#pragma weak MPI_" full " = PMPI_" full
    line_broken(result " PMPI_" full "(", list_of(variant, large) ")")
    print "{"
    if (!works) {
        for (i = 1; i <= np; i++) if (kind[i] != "{...}") printf "    (void)%s;\n", base_name(par[i])
        if (variant == "init") print "    (void)info;"
        if (variant != "") print "    (void)request;"
        printf "    return mimdsim_mpi_refuse(\"MPI_%s\", \"%s\", __builtin_return_address(0));\n}\n", full, reason[state]
        return
    }
    printf "    ENTER(\"MPI_%s\", %d);\n", full, early
    s = "at.rank"
    if (variant == "init") print "    (void)info;"
    if (has["I"] || has["start"]) {
        s = s ", (struct mpi_start){" (variant == "" ? "MPI_BLOCKING, 0" : \
            (variant == "I" ? "MPI_NON_BLOCKING" : "MPI_PERSISTENT") ", request") "}"
    }
    narrow = 0
    for (i = 1; i <= np; i++) {
        if (kind[i] == "{...}") continue
        if (kind[i] == "N" && !large) { printf "    MPI_Count %s_ = *%s;\n", par[i], par[i]; narrow = i }
        s = s ", " passed(i, large)
    }
    gsub(/\[\]\[3\]/, "", s); gsub(/\[\]/, "", s)
    printf "    %s code_ = at.mpi->%s(%s);\n    LEAVE();\n", result, tolower(name), s
    if (narrow) printf "    *%s = narrow(%s_);\n", par[narrow], par[narrow]
    print "    return code_;\n}"
}
function base_name(p) { sub(/\[.*/, "", p); return p }

# --- stubs of Fortran ---

function fortran_stub(full, variant,   i, k, base, sig, hidden, before, call, after, p) {
    sig = hidden = before = call = after = ""
    if (result == "double") {
        printf "\ndouble mpi_%s_(void)\n{\n    return MPI_%s();\n}\n", tolower(full), full
        printf "double pmpi_%s_(void) __attribute__((alias(\"mpi_%s_\")));\n", tolower(full), tolower(full)
        return
    }
    for (i = 1; i <= np; i++) {
        p = base_name(par[i]); k = kind[i]; base = k; sub(/\*$/, "", base)
        if (base in handle) {
            sig = sig "MPI_Fint *" p ", "
            if (arr[i]) {
                before = before "    HANDLES_IN(" handle[base] ", " p ", " (len[i] == "comm" ? "comm_size(*comm)" : len[i] == "" ? 0 : "*" len[i]) ");\n"
                if (k != base) after = after "    HANDLES_OUT(" p ", " (len[i] == "" ? 0 : "*" len[i]) ");\n"
                call = call ", " p "_"
            } else if (k == base) call = call ", (" handle[base] ")(intptr_t)*" p
            else {
                before = before "    " handle[base] " " p "_ = (" handle[base] ")(intptr_t)*" p ";\n"
                after = after "    *" p " = (MPI_Fint)(intptr_t)" p "_;\n"
                call = call ", &" p "_"
            }
        } else if (k ~ /^\{/) {
            if (k ~ /\*\}$/) { sig = sig "void *" p ", "; call = call ", (" substr(k, 2, length(k) - 2) ")" p }
            else { sig = sig substr(k, 2, length(k) - 2) " " par[i] ", "; call = call ", " p }
        } else if (arr[i] || k == "N" || k == "I" || k == "L" || k == "X" || k == "A" || k == "CC" || k == "O") {
            sig = sig (arr[i] ? array[k] p "[]" : plain[k] p) ", "; call = call ", " p
        } else if (k == "in" || k == "out") {
            sig = sig "void *" p ", "; call = call ", buffer_of(" p ")"
        } else if (k == "status" || k == "cstatus" || k == "statuses") {
            sig = sig "MPI_Status *" p ", "; call = call ", status_of(" p ")"
        } else if (k == "s") {
            sig = sig "const char *" p ", "; hidden = hidden ", size_t " p "_length"
            before = before "    TEXT_IN(" p ", " p "_length);\n"; call = call ", " p "_"
        } else if (k == "S") {
            sig = sig "char *" p ", "; hidden = hidden ", size_t " p "_length"
            before = before "    char " p "_[MPI_MAX_LIBRARY_VERSION_STRING];\n"
            after = after "    text_out(" p ", " p "_length, " p "_);\n"; call = call ", " p "_"
        } else { sig = sig plain[k] "*" p ", "; call = call ", *" p }
    }
    if (variant == "init") { sig = sig "MPI_Fint *info, "; call = call ", (MPI_Info)(intptr_t)*info" }
    if (variant != "") {
        sig = sig "MPI_Fint *request, "
        before = before "    MPI_Request request_ = MPI_REQUEST_NULL;\n"
        after = after "    *request = (MPI_Fint)(intptr_t)request_;\n"; call = call ", &request_"
    }
    print ""
    line_broken("void mpi_" tolower(full) "_(", sig "MPI_Fint *ierror" hidden ")")
    printf "{\n%s    *ierror = MPI_%s(%s);\n%s}\n", before, full, substr(call, 3), after
    line_broken("void pmpi_" tolower(full) "_(", sig "MPI_Fint *ierror" hidden ")")
    printf "    __attribute__((alias(\"mpi_%s_\")));\n", tolower(full)
}

# --- the list for people ---

function heading() { printf "\n## %s\n\n", chapter }
function listed(full, variant, large) {
    if (large) { count_large++; if (works) works_large++; return }
    total++
    if (works) { working[state]++; printf "- `MPI_%s`: works (%s)%s\n", full, state, has["old"] ? ", removed from the standard" : "" }
    else { refused++; printf "- `MPI_%s`: refused, %s\n", full, reason[state] }
}

function opening() {
    if (want == "prototypes")
        print "/* mpi_functions.h - the functions of MPI, as the standard declares them. Made by src/mpi/generate.awk. */"
    if (want == "table")
        print "/* mpi_table.h - how the functions of MPI are called across the border between a program and the\n" \
              " * simulator. Made by src/mpi/generate.awk. */\n#ifndef MIMDSIM_MPI_TABLE_H\n" \
              "#define MIMDSIM_MPI_TABLE_H\n\n#include \"mpi.h\"\n\nstruct mpi_rank;\n\n" \
              "/* Counts or displacements of either size. */\nstruct mpi_counts {\n    const void *at;\n" \
              "    int large; /* MPI_Count instead of int */\n};\n\n" \
              "/* How an operation is started; `request` where it is not blocking. */\n" \
              "enum mpi_start_mode { MPI_BLOCKING, MPI_NON_BLOCKING, MPI_PERSISTENT };\nstruct mpi_start {\n" \
              "    enum mpi_start_mode mode;\n    MPI_Request *request;\n};\n\nstruct mpi_functions {\n" \
              "    int size; /* of this struct: another size is another version */\n\n" \
              "    /* Before each call: its name, the program's address, whether it may come outside of Init and\n" \
              "     * Finalize; after the computing time since the last call was accounted for. */\n" \
              "    void (*enter)(struct mpi_rank *self, const char *call, const void *address, int anytime);\n\n" \
              "    /* For functions that are not there; does not return. */\n" \
              "    void (*refuse)(struct mpi_rank *self, const char *call, const char *reason);\n"
    if (want == "rows")
        print "/* mpi_rows.c - what the table of functions holds. Made by src/mpi/generate.awk. */\n" \
              "#include \"mpi/mpi_internal.h\"\n\nconst struct mpi_functions mpi_functions = {\n" \
              "    .size = sizeof(struct mpi_functions),\n    .enter = mpi_enter,\n    .refuse = mpi_refuse,"
    if (want == "stubs")
        print "/* mpi_stubs.c - MPI's functions in a program: each calls the simulator. Made by src/mpi/generate.awk. */\n" \
              "#include \"mpi_guest.h\""
    if (want == "fortran")
        print "/* mpi_fortran_stubs.c - MPI's functions as Fortran calls them. Made by src/mpi/generate.awk. */\n" \
              "#include \"mpi_fortran.h\""
}
function closing() {
    if (want == "table") {
        print "};\n\n/* The simulator's side; every function is as the standard says. */"
        print hosts "void mpi_enter(struct mpi_rank *self, const char *call, const void *address, int anytime);"
        print "void mpi_refuse(struct mpi_rank *self, const char *call, const char *reason);\n\n#endif"
    }
    if (want == "rows") print "};"
    if (want == "list") {
        printf "\n%d functions: %d work (tier 1: %d, tier 2: %d, tier 3: %d), %d are refused by name. ", total,
            working[1] + working[2] + working[3], working[1], working[2], working[3], refused
        printf "Of %d more with large counts (`_c`) %d work.\n", count_large, works_large
    }
}

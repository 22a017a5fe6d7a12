# fortran.awk - mpif.h out of mpi.h: the constants that Fortran programs name. Lines fit fixed and free form.
#
#   awk -f fortran.awk mpi.h
BEGIN {
    print "! mpif.h - MPI's constants for Fortran. Made by src/mpi/fortran.awk out of mpi.h."
    named("MPI_STATUS_SIZE", 8); named("MPI_SOURCE", 1); named("MPI_TAG", 2); named("MPI_ERROR", 3)
    named("MPI_ADDRESS_KIND", 8); named("MPI_OFFSET_KIND", 8); named("MPI_COUNT_KIND", 8); named("MPI_INTEGER_KIND", 4)
}
function named(name, value) { printf "      INTEGER %s\n      PARAMETER (%s=%d)\n", name, name, value }
function hex(s,   i, v) {
    if (s !~ /^0x/) return s + 0
    for (i = 3; i <= length(s); i++) v = 16 * v + index("0123456789abcdef", tolower(substr(s, i, 1))) - 1
    return v
}
# handles: 0x... behind a cast; MPI_X MPI_Y: another name of one
/^#define MPI_[A-Z0-9_]+ \(\(MPI_[A-Za-z]+\)0x[0-9a-f]+\)$/ {
    value = $3; sub(/.*\)0x/, "0x", value); sub(/\)$/, "", value)
    of[$2] = hex(value); named($2, of[$2]); next
}
/^#define MPI_[A-Z0-9_]+ MPI_[A-Z0-9_]+$/ { if ($3 in of) named($2, of[$3]); next }
# lengths of texts count a NUL in C only
/^#define MPI_MAX_[A-Z_]+ [0-9]+$/ { named($2, $3 - 1); next }
/^#define MPI_(VERSION|SUBVERSION|BSEND_OVERHEAD) [0-9]+$/ { named($2, $3); next }
/MPI_[A-Z0-9_]+ = -?[0-9]/ {
    line = $0
    while (match(line, /MPI_[A-Z0-9_]+ = -?[0-9a-fA-FxX]+/)) {
        split(substr(line, RSTART, RLENGTH), part, " = ")
        if (part[1] !~ /^MPI_(T_|F_)/) named(part[1], hex(part[2]))
        line = substr(line, RSTART + RLENGTH)
    }
}
function common(name, type, shape) {
    printf "      %s %s%s\n      COMMON /MIMDSIM_%s/ %s\n", type, name, shape, name, name
}
END {
    common("MPI_BOTTOM", "INTEGER", ""); common("MPI_IN_PLACE", "INTEGER", "")
    common("MPI_STATUS_IGNORE", "INTEGER", "(MPI_STATUS_SIZE)")
    common("MPI_STATUSES_IGNORE", "INTEGER", "(MPI_STATUS_SIZE,1)")
    common("MPI_UNWEIGHTED", "INTEGER", "(1)"); common("MPI_WEIGHTS_EMPTY", "INTEGER", "(1)")
    print "      DOUBLE PRECISION MPI_WTIME, MPI_WTICK"
    print "      DOUBLE PRECISION PMPI_WTIME, PMPI_WTICK"
    print "      EXTERNAL MPI_WTIME, MPI_WTICK, PMPI_WTIME, PMPI_WTICK"
    print "      INTEGER(KIND=MPI_ADDRESS_KIND) MPI_AINT_ADD, MPI_AINT_DIFF"
    print "      EXTERNAL MPI_AINT_ADD, MPI_AINT_DIFF"
    print "      EXTERNAL MPI_NULL_COPY_FN, MPI_NULL_DELETE_FN, MPI_DUP_FN"
    print "      EXTERNAL MPI_COMM_NULL_COPY_FN, MPI_COMM_DUP_FN"
    print "      EXTERNAL MPI_COMM_NULL_DELETE_FN"
    print "      EXTERNAL MPI_TYPE_NULL_COPY_FN, MPI_TYPE_DUP_FN"
    print "      EXTERNAL MPI_TYPE_NULL_DELETE_FN"
}

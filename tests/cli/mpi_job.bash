# mpi_job.bash - jobs of a real MPI for tests: load it after helper.

# start FAMILY N COMMAND...: N processes of a job; as root, on fewer processors than processes.
start() {
    local family=$1 n=$2
    shift 2
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
    # What MPI's libraries keep to their end is no leak of ours.
    ASAN_OPTIONS=${ASAN_OPTIONS-}:detect_leaks=0 timeout -k 5 240 "mpirun.$family" -n "$n" "$@"
}

# needs FAMILY: skip the test where this build or this host does not have it.
needs() {
    [ -e "$(dirname "$MIMDSIM")/mimdsim-hosts-$1.so" ] || skip "built without $1"
    command -v "mpirun.$1" >/dev/null || skip "no mpirun.$1"
}

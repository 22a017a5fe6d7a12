# helper.bash - what the tests of the real program share. Load it first: `load helper`.
#
# Every test runs in an empty folder of its own, with the program of this build and the data of this tree:
#
#     @test "an unknown verb is refused with the nearest one" {
#         fails_with 64 mimdsim rnu
#         stderr_says "did you mean 'run'?"
#         stdout_is_empty
#     }

bats_require_minimum_version 1.5.0

# MIMDSIM and MIMDSIM_DATA come from `make check`; by hand, `bats tests/cli` takes ./mimdsim of the source tree.
: "${MIMDSIM_SRCDIR:=$(cd "$BATS_TEST_DIRNAME/../.." && pwd)}"
: "${MIMDSIM:=$MIMDSIM_SRCDIR/mimdsim}"
: "${MIMDSIM_DATA:=$MIMDSIM_SRCDIR}"
export MIMDSIM MIMDSIM_DATA MIMDSIM_SRCDIR

setup() {
    mkdir "$BATS_TEST_TMPDIR/here" # bats keeps files of its own one level up
    cd "$BATS_TEST_TMPDIR/here" || return
    export HOME=$BATS_TEST_TMPDIR XDG_DATA_HOME=$BATS_TEST_TMPDIR/.local/share
    [ -x "$MIMDSIM" ] || { echo "no program at $MIMDSIM"; return 1; }
}

mimdsim() { "$MIMDSIM" "$@"; }

# sanitized: the program was built with sanitizers: it is slow, and its memory is not its own.
sanitized() { mimdsim --version | grep -q 'with sanitizers'; }

# plain_build_only: skips a long test under sanitizers, where shorter ones take the same ways through the program.
plain_build_only() { ! sanitized || skip 'long: by plain builds alone'; }

# show: what the last command said, for the log of a failed test.
show() { printf '%s\n' "status: $status" "stdout: $output" "stderr: $stderr"; }

# works COMMAND...: run it; the test fails unless it ends with 0. Then $output is stdout and $stderr is stderr.
works() { fails_with 0 "$@"; }

# fails_with STATUS COMMAND...: run it; the test fails unless it ends with STATUS.
fails_with() {
    local expected=$1
    shift
    run --separate-stderr -- "$@"
    [ "$status" -eq "$expected" ] || { echo "expected status $expected: $*"; show; return 1; }
    # A crash of ours and a sanitizer's report have no place in any test, whatever the status.
    case $stderr in *"internal error"* | *"ERROR: "*Sanitizer* | *"runtime error:"*) show; return 1 ;; esac
}

# stdout_says, stderr_says TEXT: TEXT occurs somewhere.
stdout_says() { [[ $output == *"$1"* ]] || { echo "not on stdout: $1"; show; return 1; }; }
stderr_says() { [[ $stderr == *"$1"* ]] || { echo "not on stderr: $1"; show; return 1; }; }

# stderr_is TEXT: one message and nothing else.
stderr_is() { [ "$stderr" = "$1" ] || { echo "stderr is not: $1"; show; return 1; }; }

stdout_is() { [ "$output" = "$1" ] || { echo "stdout is not: $1"; show; return 1; }; }
stdout_is_empty() { [ -z "$output" ] || { echo "stdout is not empty"; show; return 1; }; }
stderr_is_empty() { [ -z "$stderr" ] || { echo "stderr is not empty"; show; return 1; }; }

# sql DB QUERY: rows, columns separated by |.
sql() { sqlite3 -readonly "$1" "$2"; }

# sql_is DB QUERY EXPECTED: the query's answer.
sql_is() {
    local got
    got=$(sql "$1" "$2") || return 1
    [ "$got" = "$3" ] || { echo "query: $2"; echo "expected: $3"; echo "got: $got"; return 1; }
}

# json_is FILTER EXPECTED: stdout of the last command is one JSON document in which sqlite's path FILTER gives EXPECTED.
json_is() {
    local got quoted=${output//\'/\'\'}
    got=$(sqlite3 :memory: "SELECT json_extract('$quoted', '$1')") || { show; return 1; }
    [ "$got" = "$2" ] || { echo "$1 is '$got', not '$2'"; show; return 1; }
}

# json_is_valid: stdout of the last command is exactly one JSON document.
json_is_valid() {
    local quoted=${output//\'/\'\'}
    [ "$(sqlite3 :memory: "SELECT json_valid('$quoted')")" = 1 ] || { echo "not JSON"; show; return 1; }
}

# small_mesh DIMS: small.yaml, a machine whose loads are measured in milliseconds.
small_mesh() {
    cat >small.yaml <<END
schema_version: 1
title: Small mesh
topology: {family: mesh, dims: [$1]}
node: {flop_rate: 1 Gflop/s, clock: 1 GHz, div: 1 cycles, sqrt: 1 cycles, trig: 1 cycles}
network:
  level: packet
  link: {bandwidth: 16 GB/s}
  hop_latency: 3 ns
  end_latency: 2 ns
  credit_latency: 2 ns
  flit: 16 B
  packet: 256 B
  buffer: 16
software: {gap: 1 us}
END
}

# nothing_left_behind: the folder of the test is empty.
nothing_left_behind() {
    local left
    left=$(find . -mindepth 1 | sort)
    [ -z "$left" ] || { echo "left behind: $left"; return 1; }
}

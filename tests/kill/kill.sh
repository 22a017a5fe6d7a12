#!/bin/bash
# kill.sh - campaigns, merges and upgrades are killed at seeded moments; the same command then ends as if nothing had
# happened: every row of every table but the host's times and stacks equals that of a database that nobody disturbed.
#
#     kill.sh [COUNT [SEED [SCENE...]]]      default: what `make check` runs; `make kill` runs 200 moments of all scenes
#
# A moment is a scene, a signal (KILL, TERM, INT), who gets it (the process, one of its workers, all of them) and when,
# between the start and a little behind the usual end. After each: the database opens and is whole, no process is left,
# nothing but databases lies about. One in three is killed again before it may end. A failure prints COUNT and SEED.
set -euo pipefail
export LC_ALL=C
count=${1:-9} seed=${2:-20020923}
scenes=("${@:3}")
[ ${#scenes[@]} -gt 0 ] || { [ $# -gt 0 ] && scenes=(campaign spans threads merge upgrade paper mpi) || scenes=(campaign merge upgrade); }
: "${MIMDSIM_SRCDIR:=$(cd "$(dirname "$0")/../.." && pwd)}" "${MIMDSIM:=$MIMDSIM_SRCDIR/mimdsim}" "${MIMDSIM_DATA:=$MIMDSIM_SRCDIR}"
export MIMDSIM_DATA
# With sanitizers a moment takes several times as long, and strikes the same places.
if [ $# -eq 0 ] && "$MIMDSIM" --version | grep -q 'with sanitizers'; then count=4; fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# random N: the next number below N of the seeded sequence (numerical recipes' 32-bit generator, its upper bits), in $r.
random() { seed=$(((seed * 1664525 + 1013904223) & 0xffffffff)); r=$(((seed >> 8) % $1)); }

# rows DB: every row of every table but the host's times and stacks and the numbers of rows, sorted; a run is its
# identity, a setting its key and value, a build is the same for all. (Runs share what ranks did: docs/campaigns.md.)
rows() {
    local table columns
    for table in $(sqlite3 "$1" "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite_%' ORDER BY 1"); do
        columns=$(sqlite3 "$1" "SELECT group_concat(CASE
                WHEN name = 'run_id' THEN '(SELECT config_hash || seed || ''-'' || rep FROM run WHERE id = t.run_id)'
                WHEN name = 'setting_id' THEN '(SELECT key || value FROM setting s WHERE s.id = t.setting_id)'
                ELSE 'quote(t.\"' || name || '\")' END, ' || ''|'' || ')
            FROM pragma_table_info('$table')
            WHERE name NOT LIKE 'host%' AND name NOT IN ('stack_peak_bytes', 'created_utc', 'build_id', 'id')")
        [ -z "$columns" ] || sqlite3 "$1" "SELECT '$table|' || $columns FROM $table t" | sort
    done
}

# The scenes: what must be there before (prepare_), the command that is killed and repeated (run_), its database.
many() {
    printf '%s\n' 'schema_version: 1' 'question: Many?' 'machine: t3e-300' 'model: {generator: serial-chain}' \
        "n: [$1]" 'ranks: 16' 'level: [loggp, link]' 'kernel: dynamics' "record: {spans: $2}" >own.yaml
}
prepare_campaign() { many '40, 50, 60, 70, 80, 90' false; }
run_campaign() { exec "$MIMDSIM" run own.yaml -o all.db -j 2 --quiet; }
prepare_spans() { many '40, 50, 60' true; }
run_spans() { exec "$MIMDSIM" run own.yaml -o all.db -j 2 --quiet; }
prepare_threads() { many '100, 110, 120' false; }
run_threads() { exec "$MIMDSIM" run own.yaml -o all.db -j 1 --threads 2 --quiet; }
prepare_merge() {
    many '40, 50, 60, 70' true
    for k in 1 2; do [ -e part$k.db ] || "$MIMDSIM" run own.yaml --shard $k/2 -o part$k.db --quiet >out; done
}
run_merge() { exec "$MIMDSIM" merge all.db part1.db part2.db; }
prepare_upgrade() {
    [ -e v4.db ] || sqlite3 v4.db <"$MIMDSIM_SRCDIR/tests/data/store/version-4.sql"
    cp v4.db all.db
}
run_upgrade() { exec "$MIMDSIM" query --upgrade all.db; }
prepare_paper() { :; }
run_paper() { exec "$MIMDSIM" paper fig7 -o all.db -j 2 --quiet; }
# A program with main is one that calls MPI; each run is made in a process of its own.
prepare_mpi() {
    [ -e ring ] || {
        printf '%s\n' '#include <mimdsim/mpi.h>' 'int main(int argc, char **argv)' '{' '    int n, me, x = 1;' \
            '    MPI_Init(&argc, &argv);' '    MPI_Comm_rank(MPI_COMM_WORLD, &me);' '    MPI_Comm_size(MPI_COMM_WORLD, &n);' \
            '    for (int i = 0; i < 300; i++)' '        MPI_Sendrecv_replace(&x, 1, MPI_INT, (me + 1) % n, 0, (me + n - 1) % n, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);' \
            '    MPI_Finalize();' '    return 0;' '}' >ring.c
        "$MIMDSIM" cc -O1 ring.c -o ring
    }
    printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'program: ring' 'ranks: [2, 4, 8, 16, 32]' 'level: [loggp, link]' >own.yaml
}
run_mpi() { exec "$MIMDSIM" run own.yaml -o all.db -j 2 --quiet; }

fail() {
    echo "not ok - $1"
    echo "# COUNT $count, scene $scene, signal $signal to $whom after $moment ms; repeat with kill.sh 1 $begin $scene"
    cat err 2>/dev/null || true
    exit 1
}

# start SCENE: its command in a session of its own, so that its processes are known by it; its number in $job.
start() {
    export -f "run_$1"
    export MIMDSIM
    setsid env --default-signal=INT bash -c "run_$1" >out 2>err &
    job=$!
}
members() { ps -o pid= --sid "$1" 2>/dev/null || true; }

# strike: the signal to whom it is meant for. A process that has ended is no victim.
strike() {
    local victims
    case $whom in
    process) victims=$job ;;
    worker) victims=$(members "$job" | awk -v me="$job" '$1 != me' | shuf -n 1 --random-source=<(yes "$r")) ;;
    all) victims=$(members "$job") ;;
    esac
    [ -z "$victims" ] || kill -"$signal" $victims 2>/dev/null || true
}

# Whatever was struck, its family ends: soon where the parent was struck, at the usual end where a worker was.
wait_for_end() {
    local i
    for i in $(seq 600); do
        [ -n "$(members "$job")" ] || return 0
        sleep 0.05
    done
    ps -o pid,ppid,args --sid "$job"
    kill -9 $(members "$job")
    fail "a process outlived its parent"
}

whole() {
    [ ! -e all.db ] || [ "$(sqlite3 all.db 'PRAGMA integrity_check')" = ok ] || fail 'the database is damaged'
}

# left_over: nothing but what the command makes. An upgrade that was killed behind its backup makes a second one, since
# backups are never replaced.
left_over() { find . -maxdepth 1 \( -name '*.new-*' -o -name '*.db.*' ! -name '*.v[0-9]' ! -name '*.v[0-9].[0-9]' \); }

# one: a moment, then the same command to its end.
one() {
    local kills
    begin=$seed
    random ${#scenes[@]}; scene=${scenes[$r]}
    random 3; kills=$((1 + (r == 0)))
    rm -rf all.db* figures paper.*
    "prepare_$scene"
    while [ $kills -gt 0 ]; do
        random 3; signal=$(echo KILL TERM INT | cut -d ' ' -f $((r + 1)))
        random 4; whom=$(echo process process worker all | cut -d ' ' -f $((r + 1)))
        random 1000; moment=$((r * (usual[$scene] + 20) / 1000))
        start "$scene"
        sleep "$((moment / 1000)).$(printf %03d $((moment % 1000)))"
        strike
        wait $job 2>/dev/null || true
        wait_for_end
        whole
        kills=$((kills - 1))
    done
    start "$scene"
    wait $job || { [ "$scene" = upgrade ] && grep -q already out err; } || fail "the same command failed"
    whole
    [ -z "$(left_over)" ] || fail "left behind: $(left_over)"
    rows all.db >rows
    diff "rows.$scene" rows >difference || { head -5 difference; fail 'the rows differ from those of an undisturbed database'; }
}

# What an undisturbed command gives, and how long it takes.
declare -A usual
for scene in "${scenes[@]}"; do
    rm -rf all.db* figures paper.*
    "prepare_$scene"
    signal=none whom=nobody moment=0 begin=$seed
    from=$(date +%s%N)
    start "$scene"
    wait $job || fail 'the undisturbed command failed'
    usual[$scene]=$((($(date +%s%N) - from) / 1000000))
    rows all.db >"rows.$scene"
    [ "$(wc -l <"rows.$scene")" -gt 20 ] || fail 'hardly any rows'
done
for ((i = 0; i < count; i++)); do one; done
echo "ok 1 - $count moments in ${scenes[*]}: every row as if undisturbed"

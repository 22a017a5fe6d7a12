#!/bin/bash
# compare-peers.sh [P...] - the messages of the main scenario (inverse and forward dynamics, n = P, on the T3E's torus) by
# mimdsim on one thread and by the simulators that are installed here, in turn on this machine: CPU seconds of the whole
# process, the least of REPEATS (default 3) interleaved runs.
#
# The first two columns run the program itself, arithmetic, check and database included. The others get its schedule
# (`mimdsim timeline --format goal`): the same messages in the same order with computing times in place of arithmetic,
# so the number of messages is equal, and is shown. A simulator that is not installed has an empty column: nothing is
# fetched, and no figure comes from elsewhere.
#
#   SMPI        smpicc, smpirun (Debian: libsimgrid-dev): a torus with its default flow model and the flags below;
#               stopped after LIMIT seconds of processor time (default 120)
#   LogGOPSim   LogGOPSim, txt2bin: without a topology
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mimdsim=${MIMDSIM:-mimdsim}
repeats=${REPEATS:-3} limit=${LIMIT:-120}
[ $# -gt 0 ] || set -- 128 1024 4096
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

smpi_flags=(--cfg=smpi/simulate-computation:no --cfg=smpi/privatization:no --cfg=contexts/factory:raw
    --cfg=contexts/stack-size:64 --cfg=network/crosstraffic:no --log=root.thres:error)
have() { command -v "$1" >/dev/null; }
! have smpicc || smpicc -O2 "$here/mpi/play-schedule.c" -o play-schedule
${CC:-cc} -O2 -o cpu_seconds "$here/cpu_seconds.c"

# cpu COMMAND...: user and system seconds of the whole process; "-" when it fails or takes too long.
cpu() {
    if ./cpu_seconds "$limit" "$@" 3>took >said 2>noise; then cat took; else echo -; fi
}
least() { grep -v -e - "$1" | sort -g | head -n 1 | grep . || echo -; }

# torus P: three powers of two as equal as possible.
torus() { awk -v p="$1" 'BEGIN { d[0] = d[1] = d[2] = 1; for (k = 0; p > 1; p /= 2) d[k++ % 3] *= 2; print d[0] "," d[1] "," d[2] }'; }

# prepare P DIMS: the schedule, as each simulator reads it.
prepare() {
    "$mimdsim" timeline speedup-t3e --set "n=$1" --set "machine.topology.dims=[$2]" --set level=loggp --format goal \
        --dir . --quiet >/dev/null 2>noise
    awk '/^rank/ { printf "%-15d\n", at >"offsets"; next }
        /^}/ { at += 2; print "e"; next }
        $2 == "calc" { line = "c " $3 }
        $2 == "send" { line = "s " $3 + 0 " " $5 " " $7 }
        $2 == "recv" { line = "r " $3 + 0 " " $5 " " $7 }
        $2 ~ /^(calc|send|recv)$/ { at += length(line) + 1; print line }' timeline.goal >operations
    seq 0 $(($1 - 1)) | sed 's/^/n/' >hosts
    cat >platform.xml <<END
<?xml version='1.0'?>
<!DOCTYPE platform SYSTEM "https://simgrid.org/simgrid.dtd">
<platform version="4.1"><zone id="w" routing="Full">
<cluster id="c" prefix="n" suffix="" radical="0-$(($1 - 1))" speed="1000Gf" bw="480MBps" lat="100ns" topology="TORUS"
 topo_parameters="$2"/></zone></platform>
END
    ! have txt2bin || txt2bin -i timeline.goal -o timeline.bin >/dev/null
}

echo "CPU seconds of the whole process, least of $repeats; $(nproc) processors, load $(cut -d ' ' -f 1 /proc/loadavg)"
printf '%17s | %19s | %39s | %s\n' '' 'the program' 'its schedule' 'over the program at loggp'
printf '%7s %9s | %9s %9s | %9s %9s %9s %9s | %9s %9s\n' P messages loggp link loggp link SMPI LogGOPSim SMPI LogGOPSim
for ranks in "$@"; do
    dims=$(torus "$ranks")
    prepare "$ranks" "$dims"
    messages=$(grep -c ^s operations)
    rm -f times.*
    for _ in $(seq "$repeats"); do
        for level in loggp link; do
            cpu "$mimdsim" run speedup-t3e --set "n=$ranks" --set "machine.topology.dims=[$dims]" --set level=$level \
                --jobs 1 --threads 1 --force --quiet -o whole.db >>times.run.$level
            cpu "$mimdsim" run timeline.goal -m t3e-300 --set "machine.topology.dims=[$dims]" --set level=$level \
                --jobs 1 --threads 1 --force --quiet -o goal.db >>times.$level
        done
        ! have smpicc || cpu smpirun -np "$ranks" -platform platform.xml -hostfile hosts "${smpi_flags[@]}" \
            ./play-schedule operations offsets >>times.smpi
        if have smpicc && ! tail -n 1 times.smpi | grep -q -e - && ! grep -q "^messages $messages\$" said; then
            echo "compare-peers.sh: SMPI did not make $messages messages" >&2
            exit 1
        fi
        ! have LogGOPSim || cpu LogGOPSim -f timeline.bin >>times.loggopsim
    done
    touch times.smpi times.loggopsim
    smpi=$(least times.smpi) loggopsim=$(least times.loggopsim) own=$(least times.run.loggp)
    ratio() { [ "$1" = - ] && echo - || echo "$1 $2" | awk '{ printf "%.1f", $1 / $2 }'; }
    printf '%7d %9d | %9s %9s | %9s %9s %9s %9s | %9s %9s\n' "$ranks" "$messages" "$own" \
        "$(least times.run.link)" "$(least times.loggp)" "$(least times.link)" "$smpi" "$loggopsim" "$(ratio "$smpi" "$own")" \
        "$(ratio "$loggopsim" "$own")"
done

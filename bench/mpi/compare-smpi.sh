#!/bin/bash
# compare-smpi.sh [REPEATS] - the same MPI programs on mimdsim and on SimGrid's SMPI, in turn: CPU seconds of the whole
# process, the least of the repeats, and their ratio. Where smpicc is not installed it says so and ends with 69.
#
# Both simulate 512 hosts with links of 480 MB/s and 1 us: SMPI with its default flow model, mimdsim with level loggp,
# link and auto. Answers must be the same text.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mimdsim=${MIMDSIM:-mimdsim}
repeats=${1:-3}
command -v smpicc >/dev/null || { echo "compare-smpi.sh: smpicc is not installed (Debian: libsimgrid-dev)" >&2; exit 69; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

cat >platform.xml <<'END'
<?xml version='1.0'?>
<!DOCTYPE platform SYSTEM "https://simgrid.org/simgrid.dtd">
<platform version="4.1"><zone id="w" routing="Full">
<cluster id="c" prefix="n" suffix="" radical="0-511" speed="1Gf" bw="480MBps" lat="1us"/></zone></platform>
END
seq 0 511 | sed 's/^/n/' >hosts
for program in cg27 halo26; do
    smpicc -O2 "$here/$program.c" -o "$program.smpi"
    "$mimdsim" cc -O2 "$here/$program.c" -o "$program.mimdsim"
done

# cpu COMMAND...: user and system seconds of the whole process; its standard output is in the file said.
${CC:-cc} -O2 -o cpu_seconds "$here/../cpu_seconds.c"
cpu() { ./cpu_seconds unlimited "$@" 3>took >said 2>noise || true; [ -s said ] || { cat noise >&2; exit 1; }; cat took; }
least() { sort -g | head -n 1; }

printf '%-18s %5s %10s %10s %10s %10s %8s\n' program P SMPI loggp link auto 'ratio of loggp'
while read -r program ranks arguments; do
    rm -f times.*
    for _ in $(seq "$repeats"); do
        cpu smpirun -np "$ranks" -platform platform.xml -hostfile hosts --log=root.thres:error ./"$program.smpi" $arguments >>times.smpi
        grep "$program:" said >answer.smpi
        for level in loggp link auto; do
            cpu "$mimdsim" mpirun -n "$ranks" -m t3e-300 --set "machine.topology.dims=[8, 8, 8]" --level $level ./"$program.mimdsim" $arguments >>times.$level
            grep "$program:" said | diff answer.smpi - >/dev/null || { echo "compare-smpi.sh: answers differ" >&2; exit 1; }
        done
    done
    printf '%-18s %5d %10.2f %10.3f %10.3f %10.3f %7.1fx\n' "$program $arguments" "$ranks" "$(least <times.smpi)" \
        "$(least <times.loggp)" "$(least <times.link)" "$(least <times.auto)" \
        "$(echo "$(least <times.smpi) / $(least <times.loggp)" | bc -l)"
done <<'END'
cg27 256 6 30
cg27 512 6 30
halo26 216 12 10
halo26 512 12 10
END

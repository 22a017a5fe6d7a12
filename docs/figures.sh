#!/bin/sh
# figures.sh DIR: draw the figures of this folder into DIR, with $MIMDSIM (./mimdsim of the source tree).
#
# `make check` draws them likewise and compares: a figure that differs from the one here is stale, and
# `docs/figures.sh docs`, by a program that was built from committed sources, replaces it. The stamp of
# a figure names that commit; it is left out of the comparison.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
: "${MIMDSIM:=$here/../mimdsim}"
mkdir -p "$1"
into=$(cd "$1" && pwd)
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
cd "$made"

# figure AS ARGUMENT...: what plot draws of figures.db with these arguments
figure() {
    as=$1
    shift
    rm -rf drawn
    "$MIMDSIM" plot figures.db "$@" --dir drawn --quiet >/dev/null
    cp drawn/*.svg "$into/$as.svg"
}

"$MIMDSIM" run speedup-t3e -o figures.db --quiet >/dev/null
figure speedup-t3e fig6
rm figures.db
"$MIMDSIM" run speedup-t3e --only 'level == loggp and n >= 8 and log2(n / 8) % 2 == 0' --uncertainty 32 -o figures.db --quiet >/dev/null
figure uncertainty-speedup-t3e uncertainty

# those of tutorial.md, by its commands
rm figures.db
"$MIMDSIM" run speedup-t3e --set n=16,32,64,128 --set level=link -o figures.db --quiet >/dev/null
"$MIMDSIM" why speedup-t3e --set n=128 --set level=link -o figures.db --quiet >/dev/null
figure tutorial-why why
figure tutorial-slack slack
figure tutorial-roofline roofline
"$MIMDSIM" run speedup-t3e --set n=16,32,64,128 --set level=link --set machine.software.send.overhead="2 us" \
    --set machine.software.recv.overhead="2 us" --name "T3E, fast messages" -o figures.db --quiet >/dev/null
figure tutorial-what-if --x P --y speedup --by name
cat >my.yaml <<'END'
schema_version: 1
base: t3e-300
title: T3E with a fat tree and faster links
topology: {family: fat-tree, dims: [16, 2]}
network: {link: {bandwidth: 960 MB/s}}
END
"$MIMDSIM" run speedup-t3e -m my.yaml --set n=16,32,64,128 --set level=link -o figures.db --quiet >/dev/null
figure tutorial-machines --x P --y makespan_s --by name
figure tutorial-own --x P --y overhead_share --by name --title "How much of the time goes into messages"
echo "SELECT P, compute_share AS computing, name AS machine FROM v_run WHERE level = 'link' ORDER BY P" >who.sql
figure tutorial-query who.sql --kind bars --title "How much of the time is computing"
rm -rf drawn
"$MIMDSIM" compare t3e-300 paragon --on speedup-t3e --set n=16,64 --set level=loggp -o figures.db --dir drawn --quiet >/dev/null
cp drawn/compare-t3e-300-paragon.svg "$into/tutorial-compare.svg"

# the files that its section on studies has
tutorial_file() { # NAME: the indented block behind "Save this as `NAME`"
    awk -v name="\`$1\`" '/^Save this|Save this as/ && index($0, name) { found = 1; next }
        found && /^    / { print substr($0, 5); seen = 1; next }
        found && seen { exit }' "$here/tutorial.md" >"$1"
}
for study in grid sample best links; do
    tutorial_file $study.yaml
    rm -f figures.db
    "$MIMDSIM" run $study.yaml -o figures.db --quiet >/dev/null
    case $study in
    grid) figure tutorial-grid --x n --y P --z speedup ;;
    sample) figure tutorial-sample --x end_latency --y makespan_s --by solver ;;
    best) figure tutorial-best --x n --y makespan_s --by solver ;;
    links) figure tutorial-variants --x n --y makespan_s --by name ;;
    esac
done
rm figures.db
"$MIMDSIM" run speedup-t3e --set n=16,64 --set level=loggp --uncertainty 16 -o figures.db --quiet >/dev/null
figure tutorial-uncertainty uncertainty

# that of jobs.md
rm -f figures.db
"$MIMDSIM" interference neighbours -o figures.db --dir drawn --quiet >/dev/null
cp drawn/interference.svg "$into/jobs-interference.svg"
rm -f figures.db

# those of what-if.md, each by its command
for name in bandwidth-or-latency torus-or-dragonfly adaptive-routing placement oversubscription eager-limit offload ten-times \
    energy failed-link; do
    "$MIMDSIM" run what-if-$name -o figures.db --dir drawn --quiet >/dev/null
    cp drawn/what-if-$name.svg "$into/"
done

#!/bin/bash
# summary.sh - what a campaign did: executions, inputs kept, slowest, memory and what broke, a line for each harness.
#
#     summary.sh BUILD/fuzz      exit status 1 when something broke
set -euo pipefail
cd "$1"
printf '%-12s %14s %14s %9s %9s %9s %7s\n' harness guided unguided kept slowest/s peak/MB broken
total=0 all=0
for log in log/*.guided; do
    name=$(basename "$log" .guided)
    stat() { sed -n "s/^stat::$1: *//p" "$log" | tail -n 1; }
    guided=$(stat number_of_executed_units)
    unguided=$(sed -n "s/^$name: \([0-9]*\) inputs.*/\1/p" "log/$name.unguided" | awk '{ n += $1 } END { printf "%d", n }')
    # of the plain build: sanitizers and other programs on the machine make the others slow
    slowest=$(sed -n 's/.*slowest took \([0-9.]*\) s.*/\1/p' "log/$name.unguided" | sort -g | tail -n 1)
    broken=$(find broken -name "$name-*" -o -name "broken-$name-*" | wc -l)
    printf '%-12s %14d %14d %9d %9s %9s %7d\n' "$name" "${guided:-0}" "$unguided" "$(find "found/$name" -type f | wc -l)" \
        "${slowest:--}" "$(stat peak_rss_mb)" "$broken"
    total=$((total + ${guided:-0} + unguided)) all=$((all + broken))
done
printf '%d executions, %d inputs broke the program\n' "$total" "$all"
[ "$all" -eq 0 ]

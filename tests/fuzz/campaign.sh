#!/bin/bash
# campaign.sh - search for inputs that break the program: every harness of tests/fuzz under libFuzzer with sanitizers, then
# unguided changes of what it found at full speed. `make fuzz MINUTES=n` starts it.
#
#     campaign.sh BUILD MINUTES [HARNESS...]
#
# BUILD is a configured plain build; the harnesses are built in BUILD/fuzz by clang. What was found stays in
# BUILD/fuzz/found/HARNESS, what broke the program in BUILD/fuzz/broken. Exit status 1 when something did.
set -euo pipefail
build=$(cd "$1" && pwd) minutes=$2
shift 2
source=$(cd "$(dirname "$0")/../.." && pwd)
jobs=${JOBS:-1}

# The share of guided search in each harness's time; the rest repeats without a guide, many times as fast.
guided=${GUIDED:-60}

[ -e "$build/fuzz/config.status" ] || {
    mkdir -p "$build/fuzz"
    (cd "$build/fuzz" && "$source/configure" CC="${FUZZ_CC:-clang}" CFLAGS="${FUZZ_CFLAGS:--O1 -g}" \
        --enable-sanitizers --enable-fuzzers --disable-lto >configure.out 2>&1) ||
        { tail "$build/fuzz/configure.out"; echo 'the harnesses need clang with libFuzzer (Debian: clang, libclang-rt-dev)'; exit 69; }
}
harnesses=${*:-$(sed -n 's/^fuzz_tests += tests\/fuzz\/fuzz_//p' "$source/tests/fuzz/local.am")}
targets=$(printf 'tests/fuzz/fuzz_%s ' $harnesses)
make -C "$build/fuzz" -s all >/dev/null 2>&1 || make -C "$build/fuzz" -s all
make -C "$build/fuzz" -s $targets
make -C "$build" -s all
make -C "$build" -s $targets
cd "$build/fuzz"
mkdir -p broken log

# Every key of scenarios and machines, every word of the formats: what libFuzzer puts together.
{
    "$build/mimdsim" scenarios --keys 2>/dev/null | grep -oE '[a-z_]+(\.[a-z_]+)*' || true
    grep -rhoE '"[a-zA-Z_][a-zA-Z_0-9.-]{2,24}"' "$source"/src/{plan,spec,study,model,schedule,app/published.c} | tr -d '"'
} | sort -u | sed 's/.*/"&"/' >words.dict

# fuzz_one HARNESS SECONDS: guided, then unguided.
fuzz_one() {
    local name=$1 first=$(($2 * guided / 100)) second limit=2
    second=$(($2 - first))
    mkdir -p "found/$name"
    [ "$name" != scenario ] || limit=20 # the largest plan, with sanitizers
    if [ "$first" -gt 0 ]; then
        ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=0 timeout $((first + 120)) nice -n 19 \
            "tests/fuzz/fuzz_$name" -max_total_time="$first" -timeout=$((limit * 20)) -report_slow_units=$((limit * 5)) \
            -rss_limit_mb=2560 -malloc_limit_mb=1024 -max_len=8192 -dict=words.dict -print_final_stats=1 \
            -artifact_prefix="broken/$name-" "found/$name" "$source/tests/fuzz/corpus/$name" >"log/$name.guided" 2>&1 ||
            echo "$name: broken, see fuzz/log/$name.guided"
    fi
    # Without a guide: as many changes as fit into the time, a block at a time with a seed of its own.
    local end=$((SECONDS + second)) block=2000 seed=$RANDOM
    : >"log/$name.unguided"
    while [ "$SECONDS" -lt "$end" ]; do
        local begin=$SECONDS
        (cd broken && timeout 600 nice -n 19 "$build/tests/fuzz/fuzz_$name" -n "$block" -s "$seed" \
            "../found/$name" "$source/tests/fuzz/corpus/$name") >>"log/$name.unguided" 2>&1 ||
            echo "$name: broken, see fuzz/log/$name.unguided"
        [ $((SECONDS - begin)) -ge 10 ] || block=$((block * 4))
        seed=$((seed + 1))
    done
}

count=$(echo $harnesses | wc -w)
share=$((minutes * 60 * jobs / count))
for name in $harnesses; do
    while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n || true; done
    fuzz_one "$name" "$share" &
done
wait
bash "$source/tests/fuzz/summary.sh" "$build/fuzz"

#!/bin/bash
# aarch64.sh - the same bits on another architecture: the program is built for 64-bit ARM, runs under qemu, and its digests
# are those of this build. `make aarch64` starts it.
#
#     aarch64.sh BUILD       works in BUILD/aarch64
#
# Needs Debian's gcc-aarch64-linux-gnu, libc6-dev-arm64-cross and qemu-user; the libraries for ARM are fetched as packages
# and unpacked in BUILD/aarch64, nothing of them is installed. Exit status 69 when something of this is missing.
set -euo pipefail
build=$(cd "$1" && pwd)
source=$(cd "$(dirname "$0")/../.." && pwd)
root=$build/aarch64/root
for program in aarch64-linux-gnu-gcc qemu-aarch64 apt-get dpkg-deb; do
    command -v $program >/dev/null || { echo "missing: $program (Debian: gcc-aarch64-linux-gnu, qemu-user)"; exit 69; }
done

# The libraries: package lists and packages of the other architecture in a folder of their own.
[ -e "$root/done" ] || {
    mkdir -p "$build"/aarch64/{state/lists/partial,cache/archives/partial,packages} "$root"
    touch "$build/aarch64/state/status"
    apt() {
        apt-get -qq -o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o Dir::State="$build/aarch64/state" \
            -o Dir::State::status="$build/aarch64/state/status" -o Dir::Cache="$build/aarch64/cache" "$@"
    }
    apt update
    (cd "$build/aarch64/packages" && apt download libgsl-dev libgsl27 libgslcblas0 libsqlite3-0 libsqlite3-dev libyaml-0-2 \
        libyaml-dev libexpat1 libexpat1-dev libboost-context1.74-dev libboost-context1.74.0 zlib1g 2>/dev/null)
    for package in "$build"/aarch64/packages/*.deb; do dpkg-deb -x "$package" "$root"; done
    touch "$root/done"
}
cd "$build/aarch64"
[ -e Makefile ] || PKG_CONFIG_LIBDIR=$root/usr/lib/aarch64-linux-gnu/pkgconfig PKG_CONFIG_SYSROOT_DIR=$root \
    "$source/configure" --host=aarch64-linux-gnu CC="${CROSS_CC:-aarch64-linux-gnu-gcc}" CFLAGS='-O2' --disable-lto \
    CPPFLAGS="-I$root/usr/include -I$root/usr/include/aarch64-linux-gnu" LDFLAGS="-L$root/usr/lib/aarch64-linux-gnu" >configure.out 2>&1
make -s -j "$(nproc)" all >make.out 2>&1 || { tail make.out; exit 1; }
file=$(dd if=mimdsim bs=1 skip=18 count=1 2>/dev/null | od -An -tu1 | tr -d ' ')
[ "$file" = 183 ] || { echo "not a program for aarch64"; exit 1; }

# Every level, precision and kind of system: chains, trees, loops, planes, time steps, collectives, schedules.
export MIMDSIM_DATA=$source
arm() { qemu-aarch64 -L /usr/aarch64-linux-gnu ./mimdsim "$@"; }
here() { "$build/mimdsim" "$@"; }
printf '%s\n' 'num_ranks 2' 'rank 0 {' 'a: calc 5000' 'b: send 1000b to 1 tag 3' 'b requires a' '}' 'rank 1 {' \
    'recv 1000b from 0 tag 3' '}' >two.goal
runs() {
    local who=$1 db=$2
    rm -f "$db"*
    $who run speedup-t3e --set n=2,4,8,16,33 --set ranks=n -o "$db" --quiet
    for level in loggp link auto packet flit; do
        $who run speedup-t3e --set n=12 --set level=$level --set kernel.precision=float,double -o "$db" --quiet
    done
    $who run speedup-t3e --set n=4 --set level=loggp --set kernel.precision=quad -o "$db" --quiet
    for scenario in four-bar free-floating tree-humanoid stiff-polymer; do
        $who run $scenario --set level=loggp -o "$db" --quiet
    done
    $who run collectives --set ranks=8 --set level=link -o "$db" --quiet
    $who run speedup-t3e --set n=8 --set level=link --set 'machine.noise.compute=5 %' --set seed=1,2,3 -o "$db" --quiet
    $who run two.goal -m t3e-300 -o "$db" --quiet
}
status=0
runs arm arm.db >arm.out 2>&1 || status=$?
runs here here.db >here.out 2>&1 || status=$?
for db in arm here; do
    sqlite3 $db.db "SELECT scenario, kernel, n, P, level, config_hash, seed, digest, makespan_ps, status FROM run ORDER BY config_hash, seed" >$db.digests
done
count=$(wc -l <here.digests)
[ "$count" -gt 30 ] || { echo "only $count runs"; tail -n 5 arm.out here.out; exit 1; }
diff here.digests arm.digests || { echo "not ok - digests differ on aarch64"; exit 1; }
# Programs of users are refused by name.
printf 'int main(void) { return 0; }\n' >empty.c
if arm mpirun -n 1 "$build/aarch64/mimdsim" >refused.out 2>&1; then echo 'not ok - a program of a user was not refused'; exit 1; fi
grep -q 'programs of users run on x86-64 hosts only' refused.out || { cat refused.out; exit 1; }
echo "ok 1 - $count runs have the same digests and times on aarch64; programs of users are refused"
exit $status

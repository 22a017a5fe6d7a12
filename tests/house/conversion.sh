#!/bin/bash
# conversion.sh - numbers that lose digits or range by themselves do not compile: the flags of the build refuse a planted one,
# and ./bootstrap check builds with --enable-werror by both compilers, so that all of src/ is without such a warning.
. "$(dirname "$0")/house.bash"
build=$PWD
cd "$HOUSE"
status=0
flags=$(sed -n 's/^MIMDSIM_CFLAGS = //p' "$build/Makefile")
compiler=$(sed -n 's/^CC = //p' "$build/Makefile")
# shellcheck disable=SC2086
compile() { $compiler $flags -Werror -fsyntax-only -x c - 2>&1; }
refused() {
    if printf '%s\n' "$1" | compile >/dev/null; then
        echo "the flags of the build do not refuse: $1"
        status=1
    fi
}
refused 'int f(double x); int f(double x) { return x; }'
refused 'int f(long x); int f(long x) { return x; }'
refused 'float f(double x); float f(double x) { return x; }'
refused 'short f(int x); short f(int x) { return x; }'
printf '%s\n' 'int f(double x); int f(double x) { return (int)x; }' | compile ||
    { echo 'the flags of the build refuse what is right'; status=1; }
if [ "$(grep -c -- '^in_.* build-.*--enable-werror' bootstrap)" -lt 2 ]; then
    echo 'bootstrap check does not build with --enable-werror by two compilers'
    status=1
fi
if grep -rnE '(-Wno-(float-)?conversion|diagnostic +ignored +"-W(float-)?conversion)' src configure.ac Makefile.am tests/local.am; then
    echo 'the warning is switched off here'
    status=1
fi
exit $status

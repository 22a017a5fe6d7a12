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

# figure NAME AS: from figures.db
figure() {
    "$MIMDSIM" plot figures.db "$1" --dir drawn --quiet >/dev/null
    cp "drawn/$1.svg" "$into/$2.svg"
}

"$MIMDSIM" run speedup-t3e -o figures.db --quiet >/dev/null
figure fig6 speedup-t3e
rm figures.db
"$MIMDSIM" run speedup-t3e --only 'level == loggp and n >= 8 and log2(n / 8) % 2 == 0' --uncertainty 32 -o figures.db --quiet >/dev/null
figure uncertainty-speedup-t3e uncertainty-speedup-t3e

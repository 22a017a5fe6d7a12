# house.bash - what the checks of the house share. Each check prints its findings, one a line, and fails if there are any.
# HOUSE is the tree under test, HOUSE_BUILD its build tree; `make check` names them, and faults.sh names others.
set -euo pipefail
export LC_ALL=C
HERE=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
HOUSE=${HOUSE:-${MIMDSIM_SRCDIR:-$(cd "$HERE/../.." && pwd)}}
HOUSE_BUILD=${HOUSE_BUILD:-${MIMDSIM_BUILDDIR:-$HOUSE}}
ROOMS=$HERE/rooms.txt
export HERE HOUSE HOUSE_BUILD ROOMS

# verdict: pass findings from standard input on; fails when there are any.
verdict() { awk '{ print } END { exit NR > 0 }'; }

# sources PATTERN FOLDER...: files below the folders of the house, paths relative to it, sorted; at least one. What the
# build makes there is not ours.
sources() {
    local pattern=$1 found
    shift
    found=$(cd "$HOUSE" && find "$@" -type f -name "$pattern" ! -path src/store/schema.c ! -path src/store/build_id.c | sort)
    [ -n "$found" ] || { echo "no $pattern in $* of $HOUSE" >&2; return 1; }
    printf '%s\n' "$found"
}

# room_names: all rooms, in house order.
room_names() { awk '!/^#/ { print $1 }' "$ROOMS"; }

# archives: the archives of all rooms (and the objects of app, which has none), one "ROOM FILE" a line. A room of
# headers alone has none; another room without any is an error.
archives() {
    local room file found
    for room in $(room_names); do
        found=
        for file in "$HOUSE_BUILD/lib$room.a" "$HOUSE_BUILD/lib${room}"_[fp]*.a "$HOUSE_BUILD/src/app"/*.o; do
            case $file in *.o) [ "$room" = app ] || continue ;; esac
            [ -e "$file" ] || continue
            echo "$room $file"
            found=yes
        done
        [ -n "$found" ] || ! compgen -G "$HOUSE/src/$room/*.c" >/dev/null ||
            { echo "no archive of room $room in $HOUSE_BUILD" >&2; return 1; }
    done
}

# read_archives: the lines of archives into `list`, their files into the array `files`. Fails as archives.
read_archives() {
    list=$(archives)
    mapfile -t files < <(printf '%s\n' "$list" | sed 's/^[^ ]* //')
}

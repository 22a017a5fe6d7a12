#!/bin/bash
# faults.sh - every check of the house can fail: a small clean house passes them all; with one fault planted, the check
# meant for it fails and names the place.
# shellcheck disable=SC2016  # planted commands are quoted here and expanded where they are planted
. "$(dirname "$0")/house.bash"
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
failures=0

# clean_house: two rooms with all that the checks look at, compiled.
clean_house() {
    rm -rf clean
    local room
    for room in $(room_names); do
        mkdir -p "clean/src/$room"
        printf '# Room %s.\nlib_a_SOURCES = src/%s/%s.c src/%s/%s.h\n' "$room" "$room" "$room" "$room" "$room" \
            >"clean/src/$room/local.am"
        printf '/* %s.h - a room. */\n#ifndef R\n#define R\n\n/* %s_go: one more. */\nint %s_go(int n);\n\n#endif\n' \
            "$room" "$room" "$room" >"clean/src/$room/$room.h"
        printf '/* %s.c - a room. */\n#include "%s/%s.h"\n\nint %s_go(int n)\n{\n    return n + 1;\n}\n' \
            "$room" "$room" "$room" "$room" >"clean/src/$room/$room.c"
    done
    mkdir -p clean/tests/base clean/tests/data
    printf '/* check.c - the note. */\n#include "base/check.h"\n\nstatic _Thread_local int check_note;\n\n%s\n' \
        'int check_it(int n)
{
    return check_note = n;
}' >clean/src/base/check.c
    printf '/* check.h - the note. */\n\nint check_it(int n); /* n again */\n' >clean/src/base/check.h
    printf 'lib_a_SOURCES = src/base/base.c src/base/base.h src/base/check.c src/base/check.h\n' >clean/src/base/local.am
    printf '/* test_base.c - a test. */\n' >clean/tests/base/test_base.c
    printf 'TESTS = tests/base/test_base\n' >clean/tests/base/local.am
    printf '# The rooms\n' >clean/src/README.md
    HOUSE=$place/clean HOUSE_BUILD=$place/clean bash "$HERE/readme.sh" --write
}

# compile FOLDER: one archive a room. CC may be more than one word.
compile() {
    local room file changed
    for room in $(room_names); do
        changed=
        for file in "$1/src/$room"/*.c; do
            [ "$file" -nt "${file%.c}.o" ] || continue
            ${CC:-cc} -std=gnu17 -w -fno-common -I"$1/src" -c "$file" -o "${file%.c}.o"
            changed=yes
        done
        [ -z "$changed" ] || ar cr "$1/lib$room.a" "$1/src/$room"/*.o
    done
}

complain() {
    echo "$*"
    failures=$((failures + 1))
}

# planted CHECK EXPECTED COMMAND: the check fails on a clean house changed by COMMAND, and says EXPECTED.
planted() {
    local check=$1 expected=$2 said
    rm -rf house
    cp -a clean house
    (cd house && eval "$3")
    case $check in symbols | globals | cycles) compile house ;; esac
    if said=$(HOUSE=$place/house HOUSE_BUILD=$place/house bash "$HERE/$check.sh" 2>&1); then
        complain "$check.sh does not see: $3"
    elif [[ $said != *"$expected"* ]]; then
        complain "$check.sh says '$said', not '$expected', after: $3"
    fi
}

clean_house
compile clean
for check in includes symbols globals cycles documented lengths listed words readme sizes comments; do
    said=$(HOUSE=$place/clean HOUSE_BUILD=$place/clean bash "$HERE/$check.sh" 2>&1) ||
        complain "$check.sh does not pass a clean house: $said"
done

include() { printf '#include %s\n' "$1" >>"$2"; }
planted includes 'room kernel may not include room vp' 'include \"vp/vp.h\" src/kernel/kernel.c'
planted includes 'room base may not include room spec' 'include \"spec/spec.h\" src/base/base.h'
planted includes 'does not read "room/file.h"' 'include \"base.h\" src/base/base.c'
planted includes 'does not read "room/file.h"' 'include \"../vp/vp.h\" src/base/base.c'
planted includes 'src/run/run.c:8: base/none.h is not there' 'include \"base/none.h\" src/run/run.c'
planted includes '<sqlite3.h> is the business of room store' 'include \<sqlite3.h\> src/app/app.c'
planted includes '(a cycle)' 'include \"base/check.h\" src/base/base.h; include \"base/base.h\" src/base/check.h'
planted includes 'room attic is not in rooms.txt' 'mkdir src/attic; cp src/base/base.h src/attic/attic.h'

planted symbols 'room kernel uses vp_go of room vp' 'echo "int vp_go(int); int k(void) { return vp_go(1); }" >>src/kernel/kernel.c'
planted symbols 'is defined by rooms' 'echo "int base_go(int n) { return n; }" >>src/spec/spec.c'
planted symbols 'room net calls rand,' 'echo "int rand(void); int k(void) { return rand(); }" >>src/net/net.c'
planted symbols 'room sim calls time,' 'echo "long time(long *); long k(void) { return time(0); }" >>src/sim/sim.c'

rm -rf house
cp -a clean house
rm house/libnet.a
for check in symbols cycles; do
    if HOUSE=$place/house HOUSE_BUILD=$place/house bash "$HERE/$check.sh" >/dev/null 2>&1; then
        complain "$check.sh does not miss an archive"
    fi
done

planted cycles 'a circle of files' 'echo "int check_it(int); int k(int n) { return check_it(n); }" >>src/base/base.c; echo "int k(int); int c(int n) { return k(n); }" >>src/base/check.c'

planted globals 'count is writable (.bss)' 'echo "int count;" >>src/vp/vp.c'
planted globals 'count is writable (.data)' 'echo "int count = 3;" >>src/vp/vp.c'
planted globals 'is writable (.bss)' 'echo "int k(void) { static int calls; return ++calls; }" >>src/vp/vp.c'
planted globals 'mine is writable (.tbss)' 'echo "_Thread_local int mine;" >>src/base/check.c'
planted globals 'check_note is writable' 'echo "int check_note;" >>src/vp/vp.c'

planted documented 'src/vp/vp.h:10: not documented: int bare(void);' 'printf "\nint bare(void);\n" >>src/vp/vp.h'
planted documented 'not documented: static inline int bare(int n) {' 'printf "\nstatic inline int bare(int n)\n{\n    return n;\n}\n" >>src/vp/vp.h'
planted documented 'not documented: struct vp *bare(' 'printf "\nstruct vp *bare(\n    int n);\n" >>src/vp/vp.h'
planted documented 'does not open with' 'sed -i 1d src/vp/vp.c'

long_function() { printf 'int long_one(int n)\n{\n'; printf '    n++;\n%.0s' $(seq "$1"); printf '    return n;\n}\n'; }
planted lengths 'src/vp/vp.c:8: function of 61 lines' 'long_function 57 >>src/vp/vp.c'
planted lengths 'more than 540' 'printf "/* more */\n%.0s" $(seq 540) >>src/vp/vp.c'
planted lengths 'more than 170' 'printf "/* more */\n%.0s" $(seq 170) >>src/vp/vp.h'
planted lengths '121 columns' 'printf "/* %0115d */\n" 1 >>src/vp/vp.c'
planted lengths 'a tab' 'printf "\t/* tab */\n" >>src/vp/vp.c'
planted lengths 'functions in src are within 15 lines' 'for f in src/*/*.c; do long_function 12 >>$f; done; for f in src/[a-m]*/*.c; do long_function 13 >>$f; done'
planted lengths 'functions in src are within 40 lines' 'for f in src/[a-m]*/*.c; do long_function 37 >>$f; done'

planted listed 'src/vp/extra.c: not in src/vp/local.am' 'cp src/vp/vp.c src/vp/extra.c'
planted listed 'tests/base/test_more.c: not in' 'cp tests/base/test_base.c tests/base/test_more.c'
planted listed 'tests/data/a.csv: not in tests/data/README.md' 'touch tests/data/a.csv'

planted sizes 'src/vp/vp.c:8: TAKE of n * n' 'echo "double *k(int n) { return TAKE(a, n * n, double); }" >>src/vp/vp.c'
planted comments 'src/sim: 14.3 % of 7 lines carry comments' 'echo "int k;" >>src/sim/sim.c'
planted comments 'src/sim: 14.3 % of 7 lines' 'echo "const char *k = \"/*\";" >>src/sim/sim.c'
planted words 'src/vp/vp.c:8:' 'echo "/* TO""DO: later */" >>src/vp/vp.c'
planted words 'src/vp/vp.c:8:' 'echo "/* see /wo""rk/shared */" >>src/vp/vp.c'
planted words 'src/vp/vp.c:8:' 'echo "static const char text[] = \"the dear""est stage\";" >>src/vp/vp.c'
planted words 'src/README.md:' 'echo "leaves /t""mp/x" >>src/README.md'

planted readme 'src/README.md lacks: - `extra.c` - more' 'echo "/* extra.c - more. */" >src/vp/extra.c'
planted readme 'src/README.md has: - `gone.c`' 'echo "- \`gone.c\` - nothing" >>src/README.md'
planted readme 'src/README.md lacks: - `vp.h`' 'sed -i "1s/a room/another room/" src/vp/vp.h'

# An excuse counts, and so does a comment for a group.
excused() {
    printf '\n/* long: one table of cases */\n' >>src/vp/vp.c
    long_function 57 >>src/vp/vp.c
    printf '\n/* first: and second */\nint first(void);\nint second(void);\n' >>src/vp/vp.h
}
rm -rf house
cp -a clean house
(cd house && excused)
for check in lengths documented; do
    said=$(HOUSE=$place/house bash "$HERE/$check.sh" 2>&1) || complain "$check.sh does not accept the excuse: $said"
done

[ "$failures" -eq 0 ]

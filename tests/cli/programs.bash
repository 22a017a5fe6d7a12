# programs.bash - programs of people's own for tests: written to a file, and made an image where no compiler driver is
# wanted. After `load helper`.

export XDG_CACHE_HOME=$BATS_TEST_TMPDIR/.cache

# program NAME: write NAME.c: what every test program has, with the text of standard input between. The text defines
# `static void run(struct comm *c)`; result 0 is x, the serial code publishes 1.
program() {
    {
        printf '%s\n' '#include <mimdsim/program.h>' '#include <stdlib.h>' '#include <stdio.h>' \
            '#include <unistd.h>' 'static int64_t n = 10;' '#line 1'
        cat
        printf '%s\n' 'static void serial(struct comm *c) { double x = 1; comm_publish(c, 0, 0, 1, &x); }' \
            'PROGRAM(.title = "a test", .parameter = {PROGRAM_WHOLE(n, 1, 100, "numbers")}, .output = {"x"},' \
            '        .run = run, .serial = {{"one", serial}}, .tolerance = 1e-12);'
    } >"$1.c"
}

# image NAME [OPTION...]: make NAME.so of NAME.c, without counted blocks.
image() {
    local name=$1
    shift
    command -v gcc >compiler || skip "no gcc"
    gcc -O1 -g -ffixed-r15 -shared -fPIC -Wl,-Bsymbolic -I"$MIMDSIM_SRCDIR/include" "$@" -o "$name.so" "$name.c" \
        -Wl,--whole-archive "${MIMDSIM_BUILDDIR:-$MIMDSIM_SRCDIR}/libmimdsim-guest.a" -Wl,--no-whole-archive -lm
}

# sql QUERY: of mimdsim.db, values apart by bars.
sql() { mimdsim query mimdsim.db "$1" --json; }

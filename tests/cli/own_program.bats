#!/usr/bin/env bats
# own_program.bats - the guide to one's own program, command by command; new, programs; sources compiled and kept.

load helper
load programs.bash

setup_file() { command -v gcc >/dev/null || skip "no gcc"; }

# commands: those of the guide, in its order.
commands() { awk '/^```sh/ { on = 1; next } /^```/ { on = 0 } on' "$MIMDSIM_SRCDIR/docs/own-program.md"; }

@test "every command of the guide works, in its order" {
    command -v gnuplot >there || skip "no gnuplot"
    printf '%s\n' '#include <mpi.h>' '#include <stdio.h>' 'int main(int argc, char **argv)' '{' \
        '    int me; MPI_Init(&argc, &argv); MPI_Comm_rank(MPI_COMM_WORLD, &me);' \
        '    printf("hello from %d\n", me); MPI_Finalize(); return 0;' '}' >hello.c
    [ "$(commands | wc -l)" -ge 12 ]
    commands >list
    while read -r line; do
        works bash -c "mimdsim() { \"\$MIMDSIM\" \"\$@\"; }; $line" </dev/null
    done <list
    [ -s figures/speedup-heat.png ]
    # its n is known before it runs
    works mimdsim explain heat.yaml
    grep -qE '^t3e-300 +heat +- +packet +100000 +32 ' <<<"$output"
    works mimdsim query mimdsim.db "SELECT count(*) FROM run WHERE status <> 'ok'"
    [ "${lines[1]//[ ]/}" = 0 ]
}

@test "the guide and the skeleton have every word they teach" {
    for word in comm_irecv_matching comm_algorithm comm_memory comm_output comm_error comm_fail comm_compute; do
        grep -q "$word" "$MIMDSIM_SRCDIR/include/mimdsim/program.h"
    done
    for option in --limit --allow-programs; do works mimdsim run --help && stdout_says "$option"; done
}

@test "new writes a program that is right on every machine, and never overwrites" {
    works mimdsim new heat
    grep -q 'heat.yaml' heat.c
    ! grep -q '@NAME@' heat.c heat.yaml
    works mimdsim run heat.yaml --set n=100 --set ranks=1,3,32
    [ "$(grep -c ' ok$' <<<"$output")" -eq 9 ]
    cp heat.c before
    fails_with 73 mimdsim new heat
    stderr_says "is there already"
    cmp heat.c before
    rm heat.yaml
    fails_with 73 mimdsim new heat
    cmp heat.c before
    [ ! -e heat.yaml ]
    touch other.yaml
    fails_with 73 mimdsim new other
    [ ! -e other.c ]
    for name in ../up a/b '' 1st 'two words' averyveryverylongnameindeed; do
        fails_with 64 mimdsim new "$name"
        stderr_says "is not a name"
    done
}

@test "programs lists what is built in, the examples and those of this folder, without running any" {
    works mimdsim new mine
    printf 'int main(void) { return 0; }\n' >none.c
    works mimdsim programs
    stdout_says "examples/ring-allreduce.c"
    stdout_says "  mine.c "
    stdout_says "all-to-all"
    [[ $output != *none.c* ]]
    works mimdsim programs --json
    python3 -c 'import json, sys; rows = json.load(sys.stdin); assert len(rows) > 30' <<<"$output"
    [ ! -e "$XDG_CACHE_HOME" ]
}

@test "a source is compiled once; a changed header of its own, and nothing else, makes it another program" {
    works mimdsim new mine
    printf '#define FACTOR 1.0\n' >own.h
    sed -i 's|^#include <mimdsim/program.h>|&\n#include "own.h"|; s|return sum;|return FACTOR * sum;|' mine.c
    works mimdsim run mine.c --set ranks=2
    [ "$(ls "$XDG_CACHE_HOME/mimdsim/programs" | wc -l)" -eq 1 ]
    touch mine.c own.h
    works mimdsim run mine.c --set ranks=2
    [ "$(ls "$XDG_CACHE_HOME/mimdsim/programs" | wc -l)" -eq 1 ]
    mkdir copy && cp mine.c own.h copy
    works mimdsim run copy/mine.c --set ranks=2
    works mimdsim query mimdsim.db "SELECT count(*) FROM run"
    [ "${lines[1]//[ ]/}" = 1 ]
    printf '#define FACTOR 2.0\n' >own.h
    works mimdsim run mine.c --set ranks=2
    works mimdsim query mimdsim.db "SELECT count(*) FROM run"
    [ "${lines[1]//[ ]/}" = 2 ]
    # What is not ours is not taken from the cache.
    chmod o+w "$XDG_CACHE_HOME"/mimdsim/programs/*.so
    works mimdsim run mine.c --set ranks=2
    [ -z "$(find "$XDG_CACHE_HOME" -name '*.so' -perm -o+w -newer own.h)" ]
    # No half-written file is left.
    [ -z "$(find "$XDG_CACHE_HOME" -name '*.so.*')" ]
}

@test "an error of the compiler is told as it says it, with file and line" {
    works mimdsim new mine
    sed -i 's|comm_stage(c, 0);|comm_stage(c, 0)|' mine.c
    fails_with 65 mimdsim run mine.c
    stderr_says "mine.c:"
    stderr_says "error: expected"
    stderr_says "mine.c: the program does not compile"
    fails_with 65 mimdsim run mine.yaml
    [ ! -e mimdsim.db ]
    fails_with 65 mimdsim check mine.c
}

@test "a program in C++ runs, and one that throws is told" {
    command -v g++ >there || skip "no C++ compiler"
    cat >thrower.cc <<'PROGRAM'
#include <mimdsim/program.h>
#include <stdexcept>
#include <vector>
static int64_t n = 0;
static void run(struct comm *c)
{
    std::vector<double> x(1, 1.0);
    if (n > 0 && comm_rank(c) == 1) throw std::runtime_error("too much");
    if (comm_rank(c) == 0) comm_publish(c, 0, 0, 1, x.data());
}
static void serial(struct comm *c) { double x = 1; comm_publish(c, 0, 0, 1, &x); }
PROGRAM(.title = "throws", .parameter = {PROGRAM_WHOLE(n, 0, 1, "throw")}, .output = {"x"}, .run = run,
        .serial = {{"one", serial}});
PROGRAM
    works mimdsim run thrower.cc --set ranks=2
    fails_with 1 mimdsim run thrower.cc --set ranks=2 --set n=0,1
    [ "$(grep -c ' ok$' <<<"$output")" -eq 1 ]
    stderr_says "rank 1"
}

@test "the cost of computing: blocks, the author's counts, a factor" {
    works mimdsim new mine
    works mimdsim run mine.c --set ranks=1 --set program.factor=1,2
    works mimdsim query mimdsim.db "SELECT abs(2.0 * min(makespan_ps) / max(makespan_ps) - 1) < 1e-4 AS fine FROM run"
    [ "${lines[1]//[ ]/}" = 1 ]
    sed -i 's|\.tolerance = 1e-12|.tolerance = 1e-12, .cost = MIMDSIM_COST_AUTHOR|; s|double sum = 0;|&\n|' mine.c
    sed -i 's|comm_stage(c, 1);|comm_compute(c, 300e6, 0);\n    &|' mine.c
    works mimdsim run mine.c -o author.db --set ranks=1
    works mimdsim query author.db "SELECT flops FROM run r JOIN stage s ON s.run_id = r.id WHERE name = 'own share'"
    [ "${lines[1]//[ ]/}" = 300000000 ]
    fails_with 65 mimdsim run mine.c --set program.cost=block
    stderr_says "did you mean 'blocks'?"
}

@test "what an older, smaller declaration lacks is zero, whatever lies behind it" {
    cat >old.c <<'C'
#include <stddef.h>
#include <mimdsim/program.h>
static void run(struct comm *c) { (void)c; }
PROGRAM(.run = run, .size = offsetof(struct mimdsim_program, tolerance), .tolerance = -1,
        .stack_bytes = -1);
C
    works mimdsim run old.c --set ranks=2
    sed 's/\.size = [^)]*), //' old.c >new.c
    fails_with 65 mimdsim run new.c --set ranks=2
    stderr_says ".tolerance is below zero"
}

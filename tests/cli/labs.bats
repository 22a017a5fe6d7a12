#!/usr/bin/env bats
# labs.bats - the lessons: copied, filled in by name, checked exactly; every solution is right for every variant tried.

load helper
load programs.bash

setup_file() { command -v gcc >/dev/null || skip "no gcc"; }

names='broadcast deadlock prefix-sum ring stencil'

# number FOLDER KEY: what scenario.yaml of an attempt says.
number() { sed -n "s/.*\b$2: *\([0-9]*\).*/\1/p" "$1/scenario.yaml" | head -n 1; }

# answer FOLDER QUESTION VALUE: writes a prediction.
answer() { sed -i "s/^  $2:.*/  $2: $3/" "$1/answers.yaml"; }

# solve FOLDER LAB: the solution, and predictions by the shell's arithmetic alone.
solve() {
    local f=$1 P L o g G b n steps k=0
    # the stencil's is the example of that name
    if [ "$2" = stencil ]; then cp "$MIMDSIM_SRCDIR/examples/stencil.c" "$f/"; else cp "$MIMDSIM_SRCDIR/labs/solutions/$2.c" "$f/"; fi
    P=$(number "$f" ranks) L=$(number "$f" end_latency) o=$(sed -n 's/.*send: {overhead: \([0-9]*\).*/\1/p' "$f/scenario.yaml")
    g=$(number "$f" gap) G=$(number "$f" gap_per_byte) b=$(number "$f" bytes) n=$(number "$f" n) steps=$(number "$f" steps)
    while [ $((1 << k)) -lt "$P" ]; do k=$((k + 1)); done
    local one=$(((2 * o + L) * 1000000 + (${b:-8} - 1) * G * 1000))
    case $2 in
    ring)
        answer "$f" messages "$P"
        answer "$f" bytes $((P * b))
        answer "$f" one-message $one
        answer "$f" whole-round $((P * one)) ;;
    broadcast)
        answer "$f" messages $((P - 1))
        answer "$f" root-messages $k
        answer "$f" tree-time $((k * one))
        answer "$f" star-time $(((P - 2) * (g * 1000000 + (b - 1) * G * 1000) + one)) ;;
    prefix-sum)
        answer "$f" rounds $k
        answer "$f" messages $((P * k - (P - 1)))
        answer "$f" time $((k * one)) ;;
    stencil)
        answer "$f" messages $((2 * (P - 1) * steps))
        answer "$f" bytes $((2 * (P - 1) * steps * n * 8))
        answer "$f" send-overhead $((2 * (P - 1) * steps * o * 1000000)) ;;
    deadlock)
        answer "$f" waiting "$P"
        answer "$f" messages "$P"
        answer "$f" bytes $((P * 8)) ;;
    esac
}

@test "every lesson is listed, has a solution, and is right when it is solved, for several names" {
    works mimdsim lab
    for lab in $names; do stdout_says "$lab "; done
    for lab in $names; do
        for student in "Carla de la Cruz" $([ $lab != broadcast ] || echo bob); do
            rm -rf it
            works mimdsim lab "$lab" it --variant "$student"
            solve it "$lab"
            works mimdsim lab check it
            stdout_says 'program: ok'
        done
    done
    [ "$(ls "$MIMDSIM_SRCDIR/labs" | grep -vc solutions)" -eq "$(wc -w <<<"$names")" ]
}

@test "the star of the broadcast takes as long as the lesson says" {
    works mimdsim lab broadcast it --variant dora
    solve it broadcast
    works mimdsim run it/scenario.yaml --set tree=false -o star.db
    works mimdsim query star.db "SELECT makespan_ps FROM run" --json
    stdout_says "$(sed -n 's/^  star-time: //p' it/answers.yaml)"
}

@test "a program with its gap, and wrong or missing predictions, are told apart" {
    for lab in $names; do
        works mimdsim lab "$lab" "$lab" --variant eve
        fails_with 1 mimdsim lab check "$lab"
        [[ $output != *'program: ok'* ]]
        stdout_says '0 of '
    done
    solve ring ring
    answer ring bytes 7
    fails_with 1 mimdsim lab check ring
    stdout_says '3 of 4 right'
    grep -q '^bytes .* wrong$' <<<"$output"
    answer ring bytes
    fails_with 1 mimdsim lab check ring
    stdout_says 'no prediction yet'
}

@test "a program that sends more than the theory says is found, though its result is right" {
    works mimdsim lab ring --variant eve
    solve ring ring
    sed -i 's/comm_recv(c, me - 1, 0, token, bytes);/comm_recv(c, me - 1, 0, token, bytes); if (me == 1) { double x; comm_send(c, 1, 9, \&x, 8); comm_recv(c, 1, 9, \&x, 8); }/' ring/ring.c
    fails_with 1 mimdsim lab check ring
    stdout_says 'program: ok'
    stdout_says 'prediction right; the program does something else'
}

@test "the same name has the same numbers, another one has others" {
    for i in 1 2; do works mimdsim lab ring same$i --variant fay; done
    diff -r same1 same2
    works mimdsim lab ring other --variant gus
    ! diff -q same1/scenario.yaml other/scenario.yaml
    ! grep -rE '@[A-Za-z]+@' same1
}

@test "grade is a line for each attempt, and goes on after one that cannot be read" {
    works mimdsim lab ring a --variant ann
    works mimdsim lab stencil b --variant ben
    solve a ring
    fails_with 1 mimdsim lab grade a b
    [ "$(grep -c ' ok$' <<<"$output")" -eq 1 ]
    fails_with 66 mimdsim lab grade none a
    grep -q ' ok$' <<<"$output"
    fails_with 1 mimdsim lab check a b --json
    [ "$(grep -o '"right": 4' <<<"$output" | wc -l)" -eq 1 ]
}

@test "bad input is refused, and nothing is lost" {
    fails_with 66 mimdsim lab rign && stderr_says "did you mean 'ring'"
    fails_with 66 mimdsim lab ../ring
    fails_with 64 mimdsim lab ring x --variant 'a"b'
    fails_with 64 mimdsim lab ring x --variant ''
    fails_with 64 mimdsim lab ring x y
    mkdir there && echo mine >there/ring.c
    fails_with 73 mimdsim lab ring there && stderr_says 'is there already'
    [ "$(cat there/ring.c)" = mine ]
    fails_with 66 mimdsim lab check nowhere
    works mimdsim lab ring it
    answer it bytes 'twelve'
    fails_with 65 mimdsim lab check it && stderr_says "answers.yaml:8" && stderr_says "'twelve' is not a whole number"
    sed -i 's/^  bytes:.*/  bites: 3/' it/answers.yaml
    fails_with 65 mimdsim lab check it && stderr_says "'bites' is no question"
    sed -i 's/^lab: .*/lab: nothing/' it/answers.yaml
    fails_with 66 mimdsim lab check it && stderr_says "'nothing' is not a lab"
    [ ! -e x ]
}

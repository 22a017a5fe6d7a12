#!/usr/bin/env bats
# labs_solved.bats - every lesson is right when it is solved, as a kernel and as an MPI program, whatever the name.

load helper
load programs.bash
load labs.bash

setup_file() { command -v gcc >/dev/null || skip "no gcc"; }

# right FOLDER...: every answer is, and every program ends well.
right() {
    works mimdsim lab check "$@"
    [ "$(grep -c '^program: ok$' <<<"$output")" -eq $# ]
}

@test "a solution answers every question, for three names" {
    for lab in $labs; do
        for student in '' 'Carla de la Cruz' bob; do
            works mimdsim lab "$lab" "$lab-$student" ${student:+--variant "$student"}
            solve "$lab-$student" "$lab"
        done
        right "$lab-" "$lab-bob" "$lab-Carla de la Cruz"
    done
    # the names have different numbers, so that these are three tests
    ! diff -q ring-bob/answers.yaml ring-/answers.yaml
}

@test "a solution by MPI answers them as well" {
    for lab in $labs; do
        works mimdsim lab "$lab" "$lab" --variant "ann of $lab"
        works mimdsim lab "$lab" "mpi-$lab" --variant "ann of $lab" --mpi
        ! grep -rE '@[A-Za-z]+@' "mpi-$lab" "$lab"
        solve "$lab" "$lab"
        solve_mpi "mpi-$lab" "$lab"
        right "mpi-$lab"
    done
}

@test "MPI programs of the lessons compile with the mpicc of this computer" {
    command -v mpicc >/dev/null || skip "no mpicc"
    for lab in $labs; do
        works mimdsim lab "$lab" "$lab" --mpi
        solve_program "$lab"
        works mpicc -Wall -Wextra -Werror -o "$lab/real" "$lab/$lab-mpi.c" -lm
    done
}

@test "the numbers of the unknown machine are found from measured times alone" {
    for kind in '' --mpi; do
        for student in '' 'Carla de la Cruz' bob; do
            works mimdsim lab ring "it$kind$student" ${student:+--variant "$student"} $kind
            solve_program "it$kind$student"
            MIMDSIM=$MIMDSIM works sh "$MIMDSIM_SRCDIR/labs/solutions/measure-ring.sh" "it$kind$student"
            fails_with 1 mimdsim lab check "it$kind$student"
            stdout_says '4 of 8 right'
            [ "$(grep -c '^measured-.* right$' <<<"$output")" -eq 4 ]
        done
    done
}

@test "samples pay from some length on, as the lesson asks, and a baseline without time gives no speedup" {
    for student in '' 'Carla de la Cruz' bob; do
        works mimdsim lab sample-sort "it$student" ${student:+--variant "$student"}
        solve_program "it$student"
        works mimdsim run "it$student/scenario.yaml" --set m=144,2304 -o "m$student.db"
        works sqlite3 "m$student.db" "SELECT group_concat(method, ' ') FROM (SELECT v.value AS method, min(r.makespan_ps) FROM run r
            JOIN v_setting v ON v.run_id = r.id AND v.key = 'program.method' JOIN v_setting m ON m.run_id = r.id
            AND m.key = 'program.m' GROUP BY m.value ORDER BY CAST(m.value AS INTEGER))"
        stdout_is 'equal samples'
    done
    works mimdsim lab prefix-sum
    solve_program prefix-sum
    works mimdsim run prefix-sum/scenario.yaml -o sums.db
    [[ $output != *speedup_vs_itself* ]]
}

#!/usr/bin/env bats
# labs.bats - the lessons: listed, copied, filled in by name, checked exactly; labs_solved.bats has the solutions.

load helper
load programs.bash
load labs.bash

setup_file() { command -v gcc >/dev/null || skip "no gcc"; }

@test "every lesson is listed, and has a text, two programs and two solutions" {
    works mimdsim lab
    listed=$output
    for lab in $labs; do
        grep -qF -e "$lab " <<<"$listed"
        for file in README.md lab.yaml scenario.yaml "$lab.c" "$lab-mpi.c"; do [ -s "$MIMDSIM_SRCDIR/labs/$lab/$file" ]; done
        # in the student's copy every question has its row, by its name
        works mimdsim lab "$lab" "copy-$lab"
        for question in $(sed -n '/^questions:/,/^picture/s/^  \([A-Za-z-]*\):$/\1/p' "$MIMDSIM_SRCDIR/labs/$lab/lab.yaml"); do
            grep -q "^| $question |" "copy-$lab/README.md" || { echo "$lab: $question"; return 1; }
        done
        grep -q 'GAP' "$MIMDSIM_SRCDIR/labs/$lab/$lab.c"
        [ -s "$MIMDSIM_SRCDIR/labs/solutions/$lab.gap" ] && [ -s "$MIMDSIM_SRCDIR/labs/solutions/$lab-mpi.gap" ]
    done
    [ "$(ls "$MIMDSIM_SRCDIR/labs" | grep -vc solutions)" -eq "$(wc -w <<<"$labs")" ]
}

@test "the star of the broadcast takes as long as the lesson says" {
    works mimdsim lab broadcast it --variant dora
    solve it broadcast
    works mimdsim run it/scenario.yaml --set tree=false -o star.db
    works mimdsim query star.db "SELECT makespan_ps FROM run" --json
    stdout_says "$(sed -n 's/^  star-time: //p' it/answers.yaml)"
}

@test "a program with its gap, and wrong or missing predictions, are told apart" {
    for lab in $labs; do
        works mimdsim lab "$lab" "$lab" --variant eve
        fails_with 1 mimdsim lab check "$lab"
        [[ $output != *'program: ok'* ]]
        stdout_says '0 of '
    done
    solve ring ring
    cp ring/answers.yaml solved
    answer ring bytes 7
    fails_with 1 mimdsim lab check ring
    stdout_says '7 of 8 right'
    grep -q '^bytes .* wrong: too small, by more than 50 %$' <<<"$output"
    # a small term that was forgotten, a count on which every word would be the answer
    answer ring whole-round $(($(sed -n 's/^  whole-round: //p' solved) + 1000))
    answer ring messages 3
    fails_with 1 mimdsim lab check ring
    grep -q '^whole-round .* wrong: too large, by less than 0.1 %$' <<<"$output"
    grep -q '^messages .* wrong: too small$' <<<"$output"
    # of what is hidden, and of a program that did not run, JSON has null
    run mimdsim lab check ring --json
    [ "$(sqlite3 :memory: "SELECT a.value ->> 'predicted', a.value ->> 'simulated' IS NULL FROM json_each('${output//\'/\'\'}', '\$[0].answers') a
        WHERE a.value ->> 'question' = 'messages'")" = "3|1" ]
    output=$(mimdsim lab check broadcast --json 2>/dev/null) || true
    [ "$(sqlite3 :memory: "SELECT count(*) > 2, count(a.value ->> 'simulated') FROM json_each('${output//\'/\'\'}', '\$[0].answers') a")" = '1|0' ]
    cp solved ring/answers.yaml
    # a mistaken unit is told as such
    answer ring bytes "$(sed -n 's/^  bytes: //p' solved)000"
    fails_with 1 mimdsim lab check ring
    stdout_says 'wrong: too large by a power of 1000; which unit?'
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
    # the number of the wrong program is shown, as it is not the answer
    grep -qE "^messages +messages +$(number ring ranks) +$(($(number ring ranks) + 1))  prediction right; the program does something" \
        <<<"$output"
    answer ring messages 1
    fails_with 1 mimdsim lab check ring
    grep -qE "^messages +messages +1 +$(($(number ring ranks) + 1))  the program does something else" <<<"$output"
}

# answers_of FOLDER: the right numbers that are long enough to be found in a text, one a line.
answers_of() { sed -n '/^answers:/,$s/^  [A-Za-z-]*: \([0-9]\{3,\}\)$/\1/p' "$1/answers.yaml"; }

@test "an answer cannot be read off the check before it is found" {
    for lab in ring cannon dynamics; do
        works mimdsim lab "$lab" "right-$lab" --variant eve
        solve "right-$lab" "$lab"
        [ "$(answers_of "right-$lab" | wc -l)" -ge 2 ]
        works mimdsim lab "$lab" "$lab" --variant eve
        solve_program "$lab"
        # no prediction, a wrong one for each question: the right program runs, and its numbers stay hidden
        for wrong in '' ' 1'; do
            sed -i -E "/^answers:/,\$s/^  ([A-Za-z-]+):.*/  \1:$wrong/" "$lab/answers.yaml"
            fails_with 1 mimdsim lab check "$lab"
            stdout_says 'program: ok'
            stdout_says 'A simulated number is shown once its prediction is right.'
            printf '%s\n' "$output" "$stderr" >said
            fails_with 1 mimdsim lab check "$lab" --json
            printf '%s\n' "$output" "$stderr" >>said
            for number in $(answers_of "right-$lab"); do
                ! grep -qw -- "$number" said || { echo "$lab tells $number"; cat said; return 1; }
            done
        done
        # one that is right is shown beside the prediction, and the others are still hidden
        answer "$lab" messages "$(sed -n 's/^  messages: //p' "right-$lab/answers.yaml")"
        fails_with 1 mimdsim lab check "$lab"
        grep -qE '^messages +messages +([0-9]+) +\1  right$' <<<"$output"
        [ "$(grep -cE ' - +wrong' <<<"$output")" -ge 1 ]
        works mimdsim lab check "right-$lab"
        [[ $output != *'is shown once'* ]]
    done
    # the page that is handed in has the same table
    fails_with 1 mimdsim lab report ring
    [ "$(sed -n '/<h2>Predictions/,/<\/table>/p' ring/report.html | grep -c '&ndash;</td>')" -eq 7 ]
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
    [ "$(grep -o '"right": 8' <<<"$output" | wc -l)" -eq 1 ]
}

@test "bad input is refused, and nothing is lost" {
    fails_with 66 mimdsim lab rign && stderr_says "did you mean 'ring'"
    fails_with 66 mimdsim lab chek && stderr_says "did you mean 'check'"
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
    # 2^63 is no number of 64 bits, and would have been taken for the largest one
    for number in 9223372036854775808 -99999999999999999999 1e6 7.5 '0x10'; do
        answer it bytes "$number"
        fails_with 65 mimdsim lab check it && stderr_says "'$number' is not a whole number"
    done
    answer it bytes 9223372036854775807
    fails_with 1 mimdsim lab check it
    sed -i 's/^  bytes:.*/  bites: 3/' it/answers.yaml
    fails_with 65 mimdsim lab check it && stderr_says "'bites' is no question"
    sed -i 's/^lab: .*/lab: nothing/' it/answers.yaml
    fails_with 66 mimdsim lab check it && stderr_says "'nothing' is not a lab"
    [ ! -e x ]
}

@test "the picture of a lesson: a timeline, or a curve over what it varies" {
    command -v gnuplot >/dev/null || skip "no gnuplot"
    works mimdsim lab ring --variant ann
    # a program that is not complete has no picture, and says why
    fails_with 70 mimdsim lab draw ring
    [ ! -e ring/picture.png ]
    solve_program ring
    works mimdsim lab draw ring && stdout_is ring/timeline.png
    [ -s ring/timeline.png ]
    works mimdsim lab broadcast --mpi
    solve_program broadcast
    works mimdsim lab draw broadcast && stdout_is broadcast/picture.png
    [ -s broadcast/picture.svg ]
    works mimdsim query broadcast/picture.db "SELECT count(*) FROM run" --json && stdout_says 12
    # each run is one row; what only programs with bodies read is not told
    run ! grep -q ',2,[0-9]*$' broadcast/picture.csv
    run ! grep -q -e repetitions -e pcr broadcast/picture.svg
    rm -r broadcast
    works mimdsim lab broadcast
    solve_program broadcast
    works mimdsim lab draw broadcast
    grep -q 'tree true' broadcast/picture.svg
    run ! grep -q 'program\.' broadcast/picture.svg
    fails_with 66 mimdsim lab draw nowhere
    fails_with 64 mimdsim lab draw a b
}

@test "an attempt on another machine than the lesson's is not run" {
    works mimdsim lab ring
    solve ring ring
    sed -i 's/gap_per_byte: .*/gap_per_byte: 1 ns\/B/' ring/scenario.yaml
    fails_with 1 mimdsim lab check ring
    stdout_says "program: not run: scenario.yaml is not the lesson's"
    stdout_says '0 of 8 right'
    rm ring/scenario.yaml
    fails_with 66 mimdsim lab check ring
}

@test "the second scenario is the lesson's as well, and its runs are told apart" {
    works mimdsim lab broadcast it --variant eve
    [ -s it/measure.yaml ]
    solve it broadcast
    # a pipeline that is not there: the tree is right, and the questions about the long message are not
    works mimdsim lab broadcast half --variant eve
    cp it/answers.yaml half
    sed '/send_pipeline(struct comm/,/^}/s/comm_send/(void)0; if (0) comm_send/' it/broadcast.c >half/broadcast.c
    fails_with 1 mimdsim lab check half
    stdout_says '4 of 6 right'
    stdout_says 'program: measure.yaml: '
    [ "$(grep -c 'right, but the program did not end well' <<<"$output")" -eq 2 ]
    sed -i 's/^ranks: .*/ranks: 3/' it/measure.yaml
    fails_with 1 mimdsim lab check it
    stdout_says "program: not run: measure.yaml is not the lesson's"
    rm it/measure.yaml
    fails_with 66 mimdsim lab check it
    # a lesson without a second scenario has none
    works mimdsim lab deadlock && [ ! -e deadlock/measure.yaml ]
}

@test "a deadlock that is avoided by buffered sends is not what was asked for" {
    works mimdsim lab deadlock
    solve deadlock deadlock
    works mimdsim lab check deadlock
    sed -i 's/comm_issend/comm_isend/' deadlock/deadlock.c
    fails_with 1 mimdsim lab check deadlock
    stdout_says '3 of 4 right'
    grep -q '^time .*the program does something else' <<<"$output"
}

@test "how a program ended is told once, and with its place" {
    works mimdsim lab deadlock
    fails_with 1 mimdsim lab check deadlock
    stdout_says 'program: deadlock: rank 0 in program waits for rank 1'
    stderr_is_empty
    printf 'this is no C\n' >>deadlock/deadlock.c
    fails_with 1 mimdsim lab check deadlock
    stdout_says 'program: the program could not be run'
    stderr_says 'does not compile'
}

@test "the course names lessons that there are, with their minutes, and every one of them" {
    course=$MIMDSIM_SRCDIR/docs/course.md
    for lab in $labs; do
        minutes=$(sed -n 's/^minutes: //p' "$MIMDSIM_SRCDIR/labs/$lab/lab.yaml")
        grep -q "^Time: $minutes minutes" "$MIMDSIM_SRCDIR/labs/$lab/README.md"
        grep -qF "\`$lab\` ($minutes minutes)" "$course" || { echo "$lab"; return 1; }
    done
    # the documents that it sends readers to
    for document in $(grep -o '`docs/[a-z-]*\.md`' "$course" | tr -d '`' | sort -u); do [ -s "$MIMDSIM_SRCDIR/$document" ]; done
}

#!/usr/bin/env bats
# attacks.bats - files of strangers that once broke the program: each gets one message with its place, and nothing else.

load helper
load attacks

attacks=$MIMDSIM_SRCDIR/tests/data/attacks

@test "a mapping within a list is refused with its line, wherever a list may stand" {
    for verb in check explain run; do
        fails_with 65 mimdsim $verb "$attacks/sweep-null.yaml"
        stderr_says "sweep-null.yaml:6: machine.topology.dims: a mapping '{a: ...}' where a value is expected"
        fails_with 65 mimdsim $verb "$attacks/sweep-null2.yaml"
        stderr_says "sweep-null2.yaml:6: model.gravity: a mapping '{a: ...}' where a value is expected"
    done
    fails_with 65 mimdsim run speedup-t3e --set 'machine.topology.dims=[[a: 1]]'
    stderr_says "machine.topology.dims: a mapping '{a: ...}' where a value is expected"
    for key in machine.topology.links machine.placement.list model.gravity ranks n machine level kernel; do
        fails_with 65 mimdsim run speedup-t3e --set "$key=[[{a: 1}]]"
        fails_with 65 mimdsim run speedup-t3e --set "$key=[{a: [{b: 1}]}]"
    done
    nothing_left_behind
}

@test "a vector file whose counts multiply beyond an int is refused with key, numbers and bytes" {
    awk 'BEGIN {
        n = 7724
        printf "{\"format\": \"dynref-1\", \"name\": \"x\", \"group\": \"x\", \"gravity\": [0, 0, 0], \"nq\": %d, \"nv\": %d,\n\"bodies\": [", 7*n, 6*n
        for (i = 0; i < n; i++)
            printf "%s{\"parent\": %d, \"joint\": {\"type\": \"floating\"}, \"placement\": {\"p\": [0, 0, 0], \"quat\": [0, 0, 0, 1], \"R\": [1, 0, 0, 0, 1, 0, 0, 0, 1]}, \"mass\": 1, \"com\": [0, 0, 0], \"inertia_com\": [1, 0, 0, 1, 0, 1]}", i ? "," : "", i - 1
        printf "],\n\"q\": ["
        for (i = 0; i < n; i++) printf "%s0,0,0,0,0,0,1", i ? "," : ""
        printf "],\n\"qd\": ["
        for (i = 0; i < 6*n; i++) printf "%s0", i ? "," : ""
        printf "],\n\"M\": ["
        for (i = 0; i < 100000; i++) printf "%s1.5", i ? "," : ""
        print "]}"
    }' >large.json
    fails_with 65 mimdsim verify large.json
    stderr_says "large.json:5: 'M' has 100000 of the 2147766336 numbers expected (17.2 GB of them)"
}

@test "a machine whose numbers multiply beyond an int is no machine" {
    for verb in check machines; do
        fails_with 78 mimdsim $verb "$attacks/dragonfly-overflow.yaml"
        stderr_says 'gives more than 16777216 processors'
    done
    fails_with 78 mimdsim run speedup-t3e --set machine.topology.dims='[16777216, 65536, 16777216]'
    stderr_says 'gives more than 16777216 processors'
    fails_with 78 mimdsim run speedup-t3e --set machine.topology.family=fat-tree --set machine.topology.dims='[16777216, 16777216]'
    stderr_says 'gives more than 16777216 processors'
}

@test "a run that outlasts simulated time fails, with the rank and the time it had reached" {
    slow() { mimdsim run speedup-t3e --set machine.node.flop_rate='1 flop/s' --set kernel.steps=300 -o slow.db --quiet "$@"; }
    fails_with 1 slow --set n=64
    stderr_says 'simulated time ends at 1.15e+06 s: rank '
    stderr_says ' had reached 1.15'
    # the parallel run ends in time, the serial codes do not: there is no speedup to tell
    fails_with 1 slow --set n=4
    stderr_says "the parallel run took 858830 s, and 'parallel code on one processor' on one processor takes longer"
    for level in loggp link packet flit auto; do
        fails_with 1 mimdsim run speedup-t3e -o slow.db --quiet --set n=8 --set level=$level --set machine.network.link.bandwidth='1e-6 B/s'
        stderr_says 'simulated time ends at 1.15e+06 s'
    done
    sql_is slow.db "SELECT group_concat(DISTINCT status), max(makespan_ps) FROM run" 'failed|0'
    sql_is slow.db "SELECT count(*) FROM v_speedup" 0
    sql_is slow.db "SELECT (SELECT count(*) FROM baseline) + (SELECT count(*) FROM stage)" 0
    # as long as it fits, time is exact: a flop takes a million times as long
    works mimdsim run speedup-t3e --set n=1 --set ranks=1 --set level=loggp --set machine.node.flop_rate='1 flop/s' -o one.db --quiet
    sql_is one.db "SELECT status, makespan_ps > 1000000000000 FROM run" 'ok|1'
    fails_with 78 mimdsim run speedup-t3e --set machine.network.hop_latency='1 s' --set machine.topology.dims='[16777216]' -o slow.db
    stderr_says 'network.hop_latency: a route of 8388609 routers takes longer than the largest simulated time'
}

# --- texts of a database and gnuplot ----------------------------------------------------------------------------------

@test "no text of a database is a command of gnuplot, whatever it holds" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    every_figure
    # What is left of a figure when these are changed is told by attacked_rows.bats.
    chosen='run.kernel run.status run.base run.placement run.solver run.part_solver run.formulation run.operators run.level run.scenario run.machine run.topology run.precision link_loads.entries
            baseline.name stage.name check_point.suite check_point.quantity check_point.unit check_point.verdict
            setting.key span.kind claim.verdict claim.variant claim.id ladder.ladder ladder.quantity ladder.method ladder.rung
            ladder.status ladder.at ladder.scenario ladder_choice.ladder stability.precision stability.algorithm
            stability.status omission.class run_omission.class setting.value run.config_text
            explain_map.subject explain_answer.subject explain_judged.claim uncertainty.quantity uncertainty_share.quantity'
    shown=
    for column in $(text_columns); do case " $(echo $chosen) " in *" $column "*) ;; *) shown="$shown $column" ;; esac; done
    shown="$shown run.machine stage.name claim.id claim.statement ladder.method stability.algorithm"
    [ "$(echo $shown | wc -w)" -gt 30 ]
    cp all.db bad.db
    draw_all 0
    pictures=$(find drawn -name '*.svg' | wc -l)
    # Quotes and substitutions behind each other: each pair of quotes is whole within the other kind, so that a way out of
    # either is taken. gnuplot itself has no sanitizers: for them control characters and formats are enough.
    texts='quotes lines'
    if sanitized; then texts=lines; fi
    for k in $texts; do
        {
        case $k in
        quotes)
            printf '"; system("touch PWNED1"); set label 98 "<script>'
            printf "'; system('touch PWNED2'); set label 98 '; ! touch PWNED2"
            printf '`touch PWNED3` $(touch PWNED3) ${PWD} @figure @PWNED |touch PWNED3 < touch PWNED3 > PWNED3' ;;
        lines)
            printf '\n system("touch PWNED4")\n! touch PWNED4\r\n"; system("touch PWNED4")\n\t\001\033[2J'
            printf '{/Symbol %%s%%n%%d%%*d%%%%\\\\101\\" {}}{{@_^~&{\\\\\n# %% "" \x27\x27 \\' ;;
        esac
        } >text
        add_to text "$shown"
        draw_all 0
        [ "$(find drawn -name '*.svg' | wc -l)" -eq "$pictures" ]
        svg_alone # the first text has been drawn both ways
    done
}

@test "the name that a database gives a drawing leads nowhere else" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    every_figure
    svg_alone
    for name in '/../../gone' '../x' '|touch PWNED1' '<touch PWNED2' '`touch PWNED3`' '-e system("touch PWNED4")' "a'b"; do
        # a name takes one way through the program, whatever it asks the shell for
        if sanitized; then case $name in [.\<-]* | \`*) continue ;; esac; fi
        cp all.db bad.db
        sqlite3 bad.db "UPDATE omission SET scenario = '${name//\'/\'\'}'; UPDATE ladder SET scenario = '${name//\'/\'\'}'"
        rm -rf drawn
        works mimdsim plot bad.db omissions accuracy --dir drawn
        # omissions, and three ladders
        [ "$(find drawn -name '*.svg' -size +0 | wc -l)" -eq 4 ]
        [ -z "$(find "$BATS_TEST_TMPDIR" -name 'PWNED?' -o -name 'gone*' -o -path './x*')" ]
    done
    # names that a path cannot tell apart stay two drawings
    cp all.db bad.db
    sqlite3 bad.db "UPDATE omission SET scenario = iif(ordinal % 2, 'a/b', 'a|b')"
    rm -rf drawn
    works mimdsim plot bad.db omissions --dir drawn
    [ "$(find drawn -name '*.svg' | wc -l)" -eq 2 ]
}

@test "a text of a database becomes no markup of a picture or a page" {
    if ! command -v gnuplot >/dev/null; then skip; fi
    every_figure
    printf '%s' "</text><script>alert(1)</script><img src=x onerror=alert(2)>'\"&lt;" >text
    add_to text "run.label run.machine omission.what ladder.method stability.subject claim.statement critical_path.stage"
    run --separate-stderr -- mimdsim report bad.db --dir drawn
    ! grep -lE '<(script|img|foreignObject)|onmouse|onerror=.?alert.2.>' drawn/*.svg
    # the page has one script, its own, and says so to the browser
    [ "$(grep -o '<script' bad.html | wc -l)" -eq 1 ]
    grep -q '<script>// report.js' bad.html
    ! grep -q '<img' bad.html
    grep -q "Content-Security-Policy.*default-src 'none'.*script-src 'sha256-" bad.html
    # where the text is drawn, it is drawn as it is
    grep -q '&lt;script&gt;alert(1)&lt;/script&gt;' bad.html
}

@test "no script of a figure evaluates, includes or starts anything" {
    for script in "$MIMDSIM_DATA"/plots/*.gp; do
        # commands that make commands of text, in any of gnuplot's abbreviations, where a command may begin
        if grep -nE '(^|[;{])[[:space:]]*(ev[a-z]*|sys[a-z]*|lo?a?d?|cal?l?|she?l?l?|python|!)([[:space:](]|$)' "$script"; then return 1; fi
        if grep -nE 'system *\(|[`]|(^|[^"a-zA-Z_^])@[A-Za-z]|set macros|["'\''][<|]' "$script"; then return 1; fi
    done
}

@test "a few lines that ask for a million runs are refused before they take memory or time" {
    seq -s ', ' 0 999 >thousand
    printf '%s\n' 'schema_version: 1' 'machine: t3e-300' 'kernel: dynamics' 'ranks: 1' 'n: 4' \
        "seed: [$(cat thousand)]" "model.seed: [$(cat thousand)]" >million.yaml
    # sanitizers reserve more address space than that
    memory=300000
    (ulimit -v $memory; mimdsim --version) >/dev/null 2>&1 || memory=unlimited
    for verb in check explain run plan; do
        (ulimit -v $memory; mimdsim $verb million.yaml) >out 2>err && status=0 || status=$?
        [ "$status" -eq 78 ]
        grep -q 'the sweep has 1000000 runs; expected at most 100000' err
    done
    [ ! -e mimdsim.db ]
}
